"""Grbl's settings by number, as the machine has them."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from motionfmu.live.grbl.grbl_codes import GrblError

AXES = 3
REPORT, TOLERANCE, INCHES, SOFT_LIMITS, HARD_LIMITS, HOMING = 10, 11, 13, 20, 21, 22
SPEED_MAX, SPEED_MIN, LASER = 30, 31, 32
STEPS, RATE, ACCELERATION, TRAVEL = 100, 110, 120, 130
# What a session keeps; all others are the machine's and stay as they are.
KEPT = {REPORT: 1.0, TOLERANCE: 0.0, INCHES: 0.0, SPEED_MAX: 1000.0, SPEED_MIN: 0.0}
_REALS = {11, 12, 24, 25, 27}
_SAME = 5e-4  # half of the last place that is printed


@dataclass
class GrblSettings:
    """Settings of a machine."""

    machine: Mapping[str, list[Any]]  # values of the library's parameters by name
    kept: dict[int, float] = field(default_factory=lambda: dict(KEPT))

    def __getitem__(self, number: int) -> float:
        """A setting."""
        return self.values()[number]

    def values(self) -> dict[int, float]:
        """All settings, in the order of their numbers."""
        m = self.machine
        fixed = {
            0: 10.0,
            1: 255.0,
            2: 0.0,
            3: float(_mask(m["pos2encoder_dir"])),
            4: 0.0,
            5: 0.0,
            6: 0.0,
            12: 0.002,
            SOFT_LIMITS: float(any(self._of_axes("check_over_travel"))),
            HARD_LIMITS: float(m["limit_mode"][0] >= 0),
            HOMING: float(self.homes),
            23: float(_mask([d & 1 for d in m["home_dir"]])),
            24: 60 * m["home_low_speed"][0],
            25: 60 * m["home_high_speed"][0],
            26: min(255.0, round(1e3 * m["home_settle"][0])),
            27: abs(m["home_offset"][0]),
            LASER: 0.0,
        }
        return dict(sorted((fixed | self.kept | dict(self._axis_values())).items()))

    def _of_axes(self, name: str) -> list[Any]:
        given = self.machine[name]
        return [v for v, active in zip(given, self.machine["active"], strict=True) if active]

    def _axis_values(self) -> Iterator[tuple[int, float]]:
        m = self.machine
        for k in range(AXES):
            lead, gear = m["lead"][k], m["gear_ratio"][k]
            rate = m["max_rpm"][k] / gear * lead
            yield STEPS + k, m["ppr"][k] * gear / lead
            yield RATE + k, rate
            yield ACCELERATION + k, m["axis_acc"][k] or rate / 60 / m["acc_time"][0]
            yield TRAVEL + k, m["high_limit"][k] - m["low_limit"][k]

    @property
    def homes(self) -> bool:
        """Whether any axis has a search of its origin."""
        return any(self._of_axes("home_order"))

    @property
    def inches(self) -> bool:
        """Whether reports are in inches."""
        return bool(self.kept[INCHES])

    def beyond(self, target: tuple[float, ...]) -> bool:
        """Whether a place [mm] lies beyond the software limits that are in force."""
        m = self.machine
        return any(
            m["active"][k] and m["check_over_travel"][k] and not self._low(k) <= at <= self._high(k)
            for k, at in enumerate(target)
        )

    def _low(self, axis: int) -> float:
        return float(self.machine["low_limit"][axis] + abs(self.machine["lot_offset"][axis]))

    def _high(self, axis: int) -> float:
        return float(self.machine["high_limit"][axis] - abs(self.machine["hot_offset"][axis]))

    def change(self, number: float, value: float) -> GrblError:
        """Change a setting; one that is the machine's own is refused unless it stays."""
        key = math.trunc(number)
        now = self.values()
        if value < 0:
            return GrblError.NEGATIVE
        wrong = {
            0: GrblError.STEP_PULSE if value < 3 else None,
            SOFT_LIMITS: GrblError.SOFT_LIMIT_NEEDS_HOMING if value and not self.homes else None,
            LASER: GrblError.LASER if value else None,
        }.get(key)
        if wrong is not None:
            return wrong
        if key in self.kept:
            whole = key in (REPORT, INCHES)
            self.kept[key] = float(int(value) & 255) if whole else value
            if key == INCHES:
                self.kept[key] = float(bool(self.kept[key]))
            return GrblError.OK
        same = key in now and abs(now[key] - value) <= _SAME + 1e-9 * abs(value)
        return GrblError.OK if same else GrblError.STATEMENT

    def restore(self) -> None:
        """As they were at first."""
        self.kept = dict(KEPT)

    def lines(self) -> Iterator[str]:
        """What ``$$`` shows."""
        for number, value in self.values().items():
            real = number in _REALS or number >= STEPS
            yield f"${number}={value:.3f}\r\n" if real else f"${number}={value:.0f}\r\n"


def _mask(bits: list[Any]) -> int:
    return sum(1 << k for k, bit in enumerate(bits[:AXES]) if bit)
