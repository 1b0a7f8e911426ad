"""Calls about the axes themselves: parameters, compensation, dry run."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from motionfmu.base.binding import Struct, whole
from motionfmu.base.errors import InputError
from motionfmu.virtual.mcc.calls import Calls


class Axes(Calls):
    """Axis parameters, compensation tables, dry run.

    All are set at standstill only.
    """

    def update_param(self, **values: Any) -> None:
        """Change axis parameters and make them effective; if one is refused, none has changed.

        Members of MCC_MACH_PARAM (type, pos2encoder_dir, PPR, RPM, pitch, gear_ratio, ...), one
        value or one an axis, and cart_max_speed [mm/s].
        """
        param = Struct("param", self._pointer)
        before = {name: param[name] for name in values}
        try:
            for name, value in values.items():
                param[name] = value
            self._do("MCC_update_param")
        except Exception:
            for name, value in before.items():
                param[name] = value
            raise

    def set_comp(self, axis: int, interval: int, home: int, *rows: Sequence[int]) -> None:
        """Pitch and backlash table of an axis, 0 .. 5.

        The points are `interval` [pulses] apart, 0 for no compensation; the point `home`, from 0,
        is at position 0. Rows are the correction going forward and going backward [pulses], at most
        256 points each; the last one goes on. One row is for both.
        """
        table = Struct("comp")
        table["interval"], table["home"] = whole(interval), whole(home)
        if not rows or any(not isinstance(r, Sequence | np.ndarray) or not len(r) for r in rows):
            raise InputError(f"rows {rows!r:.80}: one or two lists of pulses wanted")
        for name, row in zip(("forward", "backward"), (rows * 2)[:2], strict=True):
            whole_row = [whole(v) for v in row]
            count = len(table[name])
            table[name] = whole_row + whole_row[-1:] * (count - len(whole_row))
        self._do("MCC_set_comp", whole(axis), table.pointer)

    def enable_dry_run(self) -> None:
        """From now on the card gets no pulses."""
        self._do("MCC_enable_dry_run")

    def disable_dry_run(self) -> None:
        """The card gets pulses again; the position is where the axes are."""
        self._do("MCC_disable_dry_run")

    def check_dry_run(self) -> int:
        """Whether the card gets pulses: 0 a dry run, 1 none: the library's answer."""
        return self._do("MCC_check_dry_run")
