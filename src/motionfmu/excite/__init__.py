"""Excitations for a measurement of an axis, within its limits."""

from types import ModuleType
from typing import TYPE_CHECKING

from motionfmu.base.extras import at_first_use

if TYPE_CHECKING:
    from motionfmu.excite.axis_excitation import (
        AxisExcitation,
        ExciteOptions,
        LimitedMove,
        excitation_of,
    )
    from motionfmu.excite.excite_files import write_scenario
    from motionfmu.excite.position_program import PositionProgram, part_program

__all__ = [
    "AxisExcitation",
    "ExciteOptions",
    "LimitedMove",
    "PositionProgram",
    "excitation_of",
    "part_program",
    "write_scenario",
]


def _modules() -> tuple[ModuleType, ...]:
    """Where the names are."""
    from motionfmu.excite import axis_excitation, excite_files, position_program

    return axis_excitation, excite_files, position_program


__getattr__ = at_first_use(__name__, __all__, _modules)


def __dir__() -> list[str]:
    """Names of `__all__`, though they are not imported yet."""
    return __all__
