"""Contour analysis: error against the exact path, circular tests, corners."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from motionfmu.contour.error import analyse
    from motionfmu.contour.path import Path
    from motionfmu.contour.planned import read_path
    from motionfmu.contour.result import ContourInput, ContourResult, Trace
    from motionfmu.errors import NoNumber

__all__ = [
    "ContourInput",
    "ContourResult",
    "NoNumber",
    "Path",
    "Trace",
    "analyse",
    "read_path",
]


def __getattr__(name: str) -> Any:
    """Import the analysis when it is first used: a scenario's checks want the names alone."""
    if name not in __all__:
        raise AttributeError(f"module 'motionfmu.contour' has no attribute {name!r}")
    from motionfmu.contour import error, planned, result

    return next(getattr(place, name) for place in (error, planned, result) if hasattr(place, name))


def __dir__() -> list[str]:
    """Names of `__all__`, though they are not imported yet."""
    return __all__
