"""The tests of records, run on the machine with its FMUs."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.contour.circles import CircularTest
from motionfmu.analysis.data_sheet.sheet_axes import SheetAxis, sheet_axes
from motionfmu.analysis.data_sheet.sheet_programs import FEED, FREE, PLANES, circle_program
from motionfmu.analysis.data_sheet.sheet_runs import READ, SheetMachine, circle, positioning
from motionfmu.analysis.positioning import PositioningTest
from motionfmu.base.errors import InputError
from motionfmu.run.machine_program import Machine

Array = NDArray[np.float64]
# A simulated machine repeats: two approaches show that it does.
APPROACHES = 2
DWELL = 1.05 + READ  # [s] at a target
LEAST_TURN = 0.5  # [mm] by which it passes the last target before it turns back


@dataclass(frozen=True)
class MachineTests:
    """A machine that is measured as records were."""

    machine: Machine
    folder: Path  # of the programs
    axes: Mapping[str, SheetAxis]

    @classmethod
    def of(cls, machine: Machine, folder: Path, given: Mapping[str, Any]) -> "MachineTests":
        """With values stronger than the machine's."""
        axes = sheet_axes(machine, machine.plan().axis_limits(dict(given)))
        return cls(machine, folder, {a.name: a for a in axes})

    def _tested(self, given: Mapping[str, Any]) -> SheetMachine:
        return SheetMachine(self.machine, self.folder, dict(given))

    def positioning(self, name: str, targets: Array, given: Mapping[str, Any]) -> PositioningTest:
        """Approach targets [mm] of an axis from both sides; an InputError says why it cannot."""
        axis = self.axes[name]
        places = np.unique(np.round(targets, 2))
        turn = 0.5 * FREE * (axis.high - axis.low)
        turn = min(turn, float(places[0]) - axis.low, axis.high - float(places[-1]))
        if turn < LEAST_TURN:
            told = f"targets {places[0]:g} to {places[-1]:g} mm, travel {axis.low:g} to"
            raise InputError(f"{name}: {told} {axis.high:g} mm: no room to turn behind them")
        middle, half = 0.5 * (axis.low + axis.high), turn / FREE
        moved = replace(axis, low=middle - half, high=middle + half)
        return positioning(self._tested(given), [moved], DWELL, places, APPROACHES)[0].test

    def circle(
        self,
        plane: str,
        radius: float,
        feed: float | None,
        centre: tuple[float, float] | None,
        given: Mapping[str, Any],
    ) -> CircularTest:
        """Run a circle in a plane, radius [mm], feed [mm/s]; InputError without such axes."""
        found = next(p for p in PLANES if "".join(p[1:]) == plane)
        known = {n: a for n, a in self.axes.items() if n in plane}
        if len(known) < 2:
            raise InputError(f"{plane}: the machine has no such two axes")
        text = circle_program(known, found, radius, 60.0 * feed if feed else FEED, centre)
        return circle(self._tested(given), f"circle_{plane}.ngc", text)[0]
