"""Contour analysis: error against the exact path, circular tests, corners."""

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
