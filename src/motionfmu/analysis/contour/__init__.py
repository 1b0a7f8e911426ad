"""Contour analysis: error against the exact path, circular tests, corners."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from motionfmu.analysis.contour.contour_result import ContourInput, ContourResult, Trace
    from motionfmu.analysis.contour.error import analyse
    from motionfmu.analysis.contour.path import Path
    from motionfmu.analysis.contour.planned_geometry import read_path
    from motionfmu.analysis.contour.tool_record import ToolRecord, analyse_record
    from motionfmu.base.errors import NoNumber

__all__ = [
    "ContourInput",
    "ContourResult",
    "NoNumber",
    "Path",
    "ToolRecord",
    "Trace",
    "analyse",
    "analyse_record",
    "read_path",
]


def __getattr__(name: str) -> Any:
    """Import the analysis when it is first used: a scenario's checks want the names alone."""
    if name not in __all__:
        raise AttributeError(f"module 'motionfmu.analysis.contour' has no attribute {name!r}")
    from motionfmu.analysis.contour import contour_result, error, planned_geometry, tool_record

    places = (error, planned_geometry, contour_result, tool_record)
    return next(getattr(place, name) for place in places if hasattr(place, name))


def __dir__() -> list[str]:
    """Names of `__all__`, though they are not imported yet."""
    return __all__
