"""ISO 9283 performance of any tool path: poses, paths, speed, straightness, strokes."""

from motionfmu.analysis.iso9283.command_path import CommandPath, read_points
from motionfmu.analysis.iso9283.cycles import Cycle, Cycles
from motionfmu.analysis.iso9283.evaluation import Evaluation
from motionfmu.analysis.iso9283.line import fitted_line, straightness
from motionfmu.analysis.iso9283.performance import Performance, analyse
from motionfmu.analysis.iso9283.pose import PoseResult, pose_performance
from motionfmu.analysis.iso9283.strokes import Strokes, coincidence

__all__ = [
    "CommandPath",
    "Cycle",
    "Cycles",
    "Evaluation",
    "Performance",
    "PoseResult",
    "Strokes",
    "analyse",
    "coincidence",
    "fitted_line",
    "pose_performance",
    "read_points",
    "straightness",
]
