"""Contour analysis: error against the exact path, circular tests, corners."""

from motionfmu.contour.error import analyse
from motionfmu.contour.path import Path, read_path
from motionfmu.contour.result import ContourInput, ContourResult, Trace

__all__ = ["ContourInput", "ContourResult", "Path", "Trace", "analyse", "read_path"]
