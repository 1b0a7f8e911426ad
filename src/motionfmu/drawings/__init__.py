"""Drawings of other programs: HP-GL, SVG and DXF, as the contours that a machine follows."""

from typing import TYPE_CHECKING, Any

from motionfmu.drawings.drawing_options import DrawingOptions

if TYPE_CHECKING:
    from motionfmu.drawings.drawing import Drawing, Note, Polyline

__all__ = ["Drawing", "DrawingOptions", "Note", "Polyline"]


def __getattr__(name: str) -> Any:
    """Import what needs arrays when it is first used: commands ask for the options alone."""
    if name not in __all__:
        raise AttributeError(f"module 'motionfmu.drawings' has no attribute {name!r}")
    from motionfmu.drawings import drawing

    return getattr(drawing, name)


def __dir__() -> list[str]:
    """Names of `__all__`, though some are not imported yet, and what is there."""
    return sorted({*globals(), *__all__})
