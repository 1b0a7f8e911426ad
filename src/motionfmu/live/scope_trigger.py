"""The trigger of an oscilloscope: it finds an event in the samples of a ring and cuts them out."""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError
from motionfmu.live.sample_ring import ROWS, SampleRing

LONGEST = (
    ROWS // 2
)  # steps of a recording: half a ring, so that none is written over before it ends

Kind = Literal["rise", "fall", "either", "level", "window", "change"]
Mode = Literal["single", "normal", "auto"]


@dataclass(frozen=True)
class TriggerSetting:
    """What is waited for, and what is recorded then.

    ``rise``, ``fall``, ``either``: the level is crossed; ``level``: the signal is there or above;
    ``window``: it leaves the values from `level` to `high`; ``change``: it has another value.
    """

    channel: str
    kind: Kind
    level: float = 0.0
    high: float = 0.0
    pre: float = 0.5  # share of the recording that is before the event
    length: int = 4096  # steps
    mode: Mode = "single"


@dataclass(frozen=True)
class TriggeredRecording:
    """Samples around an event, the one at step `at`."""

    begin: int
    at: int
    channels: tuple[str, ...]
    rows: NDArray[Any]  # (steps, channels)
    forced: bool = False  # no event came: the mode is auto

    def about(self, step: float) -> dict[str, Any]:
        """What goes before the samples; the step is in [s]."""
        return {
            "begin": self.begin,
            "at": self.at,
            "rows": len(self.rows),
            "channels": list(self.channels),
            "step": step,
            "forced": self.forced,
        }


class ScopeTrigger:
    """Waits for an event in a ring from now on."""

    def __init__(self, setting: TriggerSetting, ring: SampleRing) -> None:
        if setting.channel not in ring.channels:
            told = ", ".join(ring.channels) or "none"
            raise InputError(f"trigger on {setting.channel}: the scope's channels are {told}")
        if setting.kind == "window" and setting.high <= setting.level:
            raise InputError(f"trigger: the window from {setting.level:g} to {setting.high:g}")
        self.setting, self.ring = setting, ring
        self._column = ring.channels.index(setting.channel)
        self._armed = self._looked = ring.end
        self._at: int | None = None
        self._forced = False

    @property
    def state(self) -> str:
        """``armed`` until the event, then ``recording`` until all is there."""
        return "armed" if self._at is None else "recording"

    def look(self) -> TriggeredRecording | None:
        """Look at the samples that are new; the recording, if it is complete."""
        if self._at is None:
            self._at = self._event()
        if self._at is None and self.setting.mode == "auto":
            if self.ring.end - self._armed >= self.setting.length:
                self._at, self._forced = self._armed + self.setting.length - 1, True
        if self._at is None or self.ring.end < self._end(self._at):
            return None
        return self._cut(self._at)

    def last(self) -> TriggeredRecording | None:
        """What there is of a recording that has begun and will not be completed."""
        if self._at is None or self._at >= self.ring.end:
            return None
        return self._cut(self._at)

    def back(self) -> None:
        """The ring's latest samples were taken back."""
        self._armed = min(self._armed, self.ring.end)
        self._looked = min(self._looked, self.ring.end)
        self._at, self._forced = None, False

    def _event(self) -> int | None:
        """The first step at which it is there, of those not looked at yet."""
        first = max(self._looked, self.ring.begin)
        before = max(first - 1, self.ring.begin)
        self._looked = self.ring.end
        x = self.ring.between(before, self.ring.end)[:, self._column]
        found = np.flatnonzero(_happens(self.setting, x))
        found = found[found >= first - before]
        return before + int(found[0]) if len(found) else None

    def _end(self, at: int) -> int:
        """The end of its recording, in which the event itself is."""
        return at + max(1, self.setting.length - round(self.setting.pre * self.setting.length))

    def _cut(self, at: int) -> TriggeredRecording:
        end = self._end(at)
        begin = max(end - self.setting.length, self.ring.begin)
        rows = self.ring.between(begin, min(end, self.ring.end))
        self._armed = self._looked = min(end, self.ring.end)
        self._at, forced, self._forced = None, self._forced, False
        return TriggeredRecording(begin, at, self.ring.channels, rows, forced)


def _happens(setting: TriggerSetting, x: NDArray[Any]) -> NDArray[np.bool_]:
    """At which samples the event is; at the first one no edge can be seen."""
    level, high = setting.level, setting.high
    if setting.kind == "level":
        return x >= level
    before, now = x[:-1], x[1:]
    up, down = (before < level) & (now >= level), (before > level) & (now <= level)
    inside = (x >= level) & (x <= high)
    edges = {
        "rise": up,
        "fall": down,
        "either": up | down,
        "window": inside[:-1] & ~inside[1:],
        "change": before != now,
    }
    return np.concatenate([[False], edges[setting.kind]]) if len(x) else np.zeros(0, bool)
