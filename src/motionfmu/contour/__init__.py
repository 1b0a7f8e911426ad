"""Contour analysis: error against the exact path, circular tests, corners."""

from motionfmu.contour.error import ContourInput, ContourResult, Trace, analyse
from motionfmu.contour.path import Path, read_path

__all__ = ["ContourInput", "ContourResult", "Path", "Trace", "analyse", "read_path"]
