"""Drawings of other programs: HP-GL, SVG and DXF, as the contours that a machine follows."""

from motionfmu.drawings.drawing import Drawing, Note, Polyline
from motionfmu.drawings.drawing_options import DrawingOptions

__all__ = ["Drawing", "DrawingOptions", "Note", "Polyline"]
