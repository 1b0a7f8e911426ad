"""Least time along a chain of segments, found by the toppra package on a fine grid."""

from typing import Any

import numpy as np
import toppra
from speed_rides import LIBRARY, look
from toppra import algorithm, constraint, interpolator

toppra.setup_logging("ERROR")


class ChainPath(interpolator.AbstractGeometricPath):
    """The path of a chain in X Y, as toppra looks at it."""

    dof = 2
    waypoints = None

    def __init__(self, told: np.ndarray) -> None:
        self.told = told
        self.length = LIBRARY.speed_batch_segments(len(told), told)

    @property
    def path_interval(self) -> np.ndarray:
        """Interval of the path parameter."""
        return np.array([0.0, self.length])

    def __call__(self, ways: Any, order: int = 0) -> np.ndarray:
        """Points, r' or r''."""
        states = look(self.told, np.atleast_1d(ways))[("point", "slope", "bend")[order]]
        return states[:, : self.dof] if np.ndim(ways) else states[0, : self.dof]


class FeedConstraint(constraint.LinearConstraint):
    """Speed |r'| du/dt at most the feed."""

    def __init__(self, feed: float) -> None:
        super().__init__()
        self.feed, self._dof = feed, ChainPath.dof
        self.discretization_type = constraint.DiscretizationType.Collocation

    def compute_constraint_params(self, path: ChainPath, grid: np.ndarray, *_: Any) -> tuple:
        """Bounds of (du/dt)^2 at the points of the grid only."""
        most = (self.feed / np.linalg.norm(path(grid, 1), axis=1)) ** 2
        return None, None, None, None, None, None, np.stack([np.zeros_like(most), most], 1)


def bound(told: np.ndarray, acc: float, feed: float, count: int = 4000) -> float:
    """Time from rest to rest with both axes within acc. [s]"""
    path = ChainPath(told)
    grid = np.linspace(*path.path_interval, count + 1)
    axes = constraint.JointAccelerationConstraint(
        np.array([[-acc, acc]] * path.dof), constraint.DiscretizationType.Interpolation
    )
    solver = algorithm.TOPPRA([axes, FeedConstraint(feed)], path, grid, solver_wrapper="seidel")
    speed = solver.compute_parameterization(0, 0)[1]
    return float((2 * np.diff(grid) / (speed[1:] + speed[:-1])).sum())
