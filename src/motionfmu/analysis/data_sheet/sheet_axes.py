"""Axes of a machine as its tests move them: word, travel, where their position is seen."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base import units
from motionfmu.base.errors import InputError
from motionfmu.run.machine_program import Machine
from motionfmu.run.result import Result
from motionfmu.scenarios.body import MachineAxis
from motionfmu.scenarios.machine_limits import AxisLimit

Array = NDArray[np.float64]
# Words of a part program that move an axis. A further letter or number is a second drive of one:
# Y2 goes where Y goes.
WORDS = "XYZUVWABC"
# An axis without limits is moved so far to either side, and none farther [mm], [°].
FREE, FARTHEST, TURN = 100.0, 1000.0, 180.0
PLACES = {"X": 0, "Y": 1, "Z": 2, "U": 3, "V": 4, "W": 5, "A": 3, "B": 4, "C": 5}


@dataclass(frozen=True)
class SheetAxis:
    """An axis, and how a run shows where it is."""

    axis: MachineAxis
    row: int  # of arrays, from 1
    travel: AxisLimit | None  # the figure travel of [limits]
    low: float  # ends between which it is moved, in its unit
    high: float

    @property
    def name(self) -> str:
        """Name in the machine's file."""
        return self.axis.name

    @property
    def rotary(self) -> bool:
        """Whether it turns."""
        return self.axis.kind == "rotary"

    @property
    def unit(self) -> str:
        """Of positions: mm or °."""
        return "°" if self.rotary else "mm"

    @property
    def fine(self) -> tuple[float, str]:
        """Factor from its unit to that of deviations, and the name of this: µm or arc seconds."""
        return (3600.0, "″") if self.rotary else (1e3, "µm")

    @property
    def word(self) -> str:
        """The word of a part program that moves it; empty if none does."""
        first = self.name[0]
        return first if first in WORDS and not self.name[1:].isalpha() else ""

    @property
    def follows(self) -> bool:
        """Whether it is a further drive of an axis that has the word."""
        return bool(self.word) and len(self.name) > 1

    def place(self, result: Result) -> Array:
        """Where the axis is, a value each sample, in its unit."""
        assert self.travel is not None
        values = result[self.travel.signal.name]
        own = values if self.travel.element is None else values[:, self.travel.element]
        unit = self.travel.signal.port.unit or "1"
        return np.asarray(own, float) * _factor(self.travel, unit, self.rotary)


def _factor(travel: AxisLimit, name: str, rotary: bool) -> float:
    """From a unit of the position to mm, or to degrees."""
    unit = units.parse(name)
    if unit.exponents == units.parse("m").exponents:  # 1 mm stands for 1° where a row has lengths
        return float(unit.factor / units.parse("mm").factor)
    if rotary:
        return math.degrees(unit.factor)
    raise InputError(f"{travel.signal.name} [{name}] is no position")


def sheet_axes(machine: Machine, limits: list[AxisLimit]) -> list[SheetAxis]:
    """The axes of a machine with the travel that its file and its controller leave them."""
    own = {x.axis.name: x for x in limits if x.figure == "travel"}
    bounds = _of_controller(machine)
    found = []
    for number, axis in enumerate(machine.axes, 1):
        travel = own.get(axis.name)
        rotary = axis.kind == "rotary"
        low, high = -math.inf, math.inf
        if travel is not None:
            factor = _factor(travel, travel.unit, rotary)
            low = low if travel.low is None else travel.low * factor
            high = high if travel.high is None else travel.high * factor
        more = bounds.get(axis.name[0], (-math.inf, math.inf))
        low, high = max(low, more[0]), min(high, more[1])
        found.append(SheetAxis(axis, axis.row or number, travel, *_usual(low, high, rotary)))
    return found


def _usual(low: float, high: float, rotary: bool) -> tuple[float, float]:
    """Ends of the motion: of a large travel, or none, a part about its middle, or about 0."""
    if not math.isfinite(low) and not math.isfinite(high):
        return (-TURN, TURN) if rotary else (-FREE, FREE)
    reach = TURN if rotary else FARTHEST
    if not math.isfinite(low):
        return high - 2.0 * reach, high
    if not math.isfinite(high):
        return low, low + 2.0 * reach
    middle = 0.5 * (low + high)
    return max(low, middle - reach), min(high, middle + reach)


def _of_controller(machine: Machine) -> dict[str, tuple[float, float]]:
    """Travel that the controller lets a program have, by word: its software limits."""
    if machine.config is not None:
        from motionfmu.base.extras import needed

        needed("card")
        from motionfmu.cards import load

        return {a.name: (a.minimum, a.maximum) for a in load(machine.config).axes}
    from motionfmu.run.program_reading import reading_on

    try:
        settings: dict[str, Any] = reading_on(str(machine.file), {})[0]
    except InputError:  # it reads no part programs
        return {}
    return {
        word: (float(settings["low"][k]), float(settings["high"][k]))
        for word, k in PLACES.items()
        if k < len(settings["bounded"]) and settings["bounded"][k]
    }
