"""Calls about limits of travel, of acceleration, and the position reached."""

import ctypes
from collections.abc import Sequence

from motionfmu.base.binding import whole
from motionfmu.virtual.mcc.calls import Calls, Numbers, doubles, integers


class Protection(Calls):
    """Limits of commands, and the condition under which a command counts as done."""

    def set_check_OT(self, on: Sequence[int]) -> None:
        """Put the software limits in force (1) or out of force (0), for each axis."""
        self._do("MCC_set_check_OT", integers(on))

    def get_check_OT(self) -> list[int]:
        """Whether the software limits are in force: 1 they are, 0 not."""
        return self._get("MCC_get_check_OT")

    def set_max_dda_acc(self, values: Sequence[int]) -> None:
        """Largest change of pulses from DDA time to DDA time [pulses]."""
        self._do("MCC_set_max_dda_acc", integers(values))

    def get_max_dda_acc(self) -> list[int]:
        """Largest change of pulses from DDA time to DDA time [pulses]."""
        return self._get("MCC_get_max_dda_acc")

    def enable_in_pos(self, axes: int) -> None:
        """Commands wait until axes are in position; bits: X 1, Y 2, .. W 0x20."""
        self._do("MCC_enable_in_pos", whole(axes))

    def disable_in_pos(self, axes: int) -> None:
        """Commands no longer wait for axes; bits: X 1, Y 2, .. W 0x20."""
        self._do("MCC_disable_in_pos", whole(axes))

    def check_in_pos(self) -> list[int]:
        """Whether the error counters are within the tolerance: 1 they are, 0 not."""
        return self._get("MCC_check_in_pos")

    def set_inpos_tol(self, mm: Numbers) -> None:
        """Tolerance of the axes in position [mm]."""
        self._do("MCC_set_inpos_tol", doubles(mm))

    def get_inpos_tol(self) -> list[float]:
        """Tolerance of the axes in position [mm]."""
        return self._get("MCC_get_inpos_tol", ctypes.c_double)
