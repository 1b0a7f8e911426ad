"""Excitations for a measurement of an axis, within its limits."""

from typing import TYPE_CHECKING, Any

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


def __getattr__(name: str) -> Any:
    """Import what makes them when it is first used, as it needs the extra `tune`."""
    if name not in __all__:
        raise AttributeError(f"module 'motionfmu.excite' has no attribute {name!r}")
    from motionfmu.base.extras import needed

    needed("tune")
    from motionfmu.excite import axis_excitation, excite_files, position_program

    places = (axis_excitation, excite_files, position_program)
    return next(getattr(place, name) for place in places if hasattr(place, name))


def __dir__() -> list[str]:
    """Names of `__all__`, though they are not imported yet."""
    return __all__
