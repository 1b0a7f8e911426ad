"""Overrides and switches of Grbl's real-time bytes."""

from dataclasses import dataclass

FEED_MIN, SPINDLE_MIN, MOST = 10, 10, 200  # [%]
_STEPS = {0: None, 1: 10, 2: -10, 3: 1, 4: -1}
_RAPIDS = {0x95: 100, 0x96: 50, 0x97: 25}
_FEED, _SPINDLE = 0x90, 0x99


@dataclass
class GrblOverrides:
    """Feed, rapid, spindle [%]."""

    feed: int = 100
    rapid: int = 100
    spindle: int = 100
    low: int = SPINDLE_MIN  # of the spindle, that the machine takes [%]

    @property
    def all(self) -> tuple[int, int, int]:
        """All three."""
        return self.feed, self.rapid, self.spindle

    def reset(self) -> None:
        """Back to what is programmed."""
        self.feed = self.rapid = self.spindle = 100

    def byte(self, byte: int) -> bool:
        """Do what a byte says; whether it is one of an override."""
        if byte in _RAPIDS:
            self.rapid = _RAPIDS[byte]
        elif byte - _FEED in _STEPS:
            self.feed = _turned(self.feed, byte - _FEED, FEED_MIN)
        elif byte - _SPINDLE in _STEPS:
            self.spindle = _turned(self.spindle, byte - _SPINDLE, self.low)
        else:
            return False
        return True


def _turned(now: int, key: int, low: int) -> int:
    step = _STEPS[key]
    return 100 if step is None else max(low, min(MOST, now + step))
