"""Moves by calls that would bring the arm too near itself or its cell."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from motionfmu.analysis.collisions import Approach, ArmParts, Cell, approaches
from motionfmu.base.binding import CLOCK_HZ, Struct, library

_STEP = round(0.002 * CLOCK_HZ)
_MOST = 50_000  # steps that are looked ahead
_SAMPLE = np.dtype(
    [
        ("time", "f8"),
        ("joint", "f8", 6),
        ("place", "f8", 3),
        ("base", "f8", 3),
        ("line", "i8"),
        ("rate", "f8", 6),
    ]
)


class CellGuard:
    """Looks where the moves that have been given lead, and goes back."""

    def __init__(self, settings: Mapping[str, Any], cell: Cell) -> None:
        self._cell, self._parts = cell, ArmParts.of(settings, cell.radii)

    def nearest(self, state: Struct) -> Approach | None:
        """The first approach that is too near on the way to rest, in the present state."""
        kept, reading = state.saved(), Struct("robot_reading")
        rows = np.zeros(_MOST, _SAMPLE)
        rows["rate"], number, rests = 1.0, 0, False
        while not rests and number < _MOST:
            library().binding_robot_run(state.pointer, state["clock"] + _STEP, None)
            library().robot_station_read(state.pointer, reading.pointer)
            row, rests = rows[number], reading["rests"]
            row["time"], row["joint"] = state["clock"] / CLOCK_HZ, reading["joint_command"]
            row["place"] = reading["pose_command"][:3]
            row["base"] = reading["base_command"]
            number += 1
        state.restore(kept)
        found = approaches(rows[:number], self._parts, self._cell)
        return min((a for a in found if a.near), key=lambda a: a.time, default=None)
