"""Straightness of points: the line by least squares and the largest distance from it."""

import numpy as np

from motionfmu.analysis.iso9283.turn import Array


def fitted_line(points: Array) -> tuple[Array, Array]:
    """The line with the least sum of squared distances to points.

    Parameters
    ----------
    points : ndarray, shape (n, k)
        In a plane or in space.

    Returns
    -------
    centre, direction : ndarray, shape (k,)
        The centroid, and the unit vector of the largest singular value about it.
    """
    points = np.asarray(points, dtype=np.float64)
    centre = points.mean(axis=0)
    return centre, np.asarray(np.linalg.svd(points - centre, full_matrices=False)[2][0])


def straightness(points: Array) -> float:
    """Largest distance of points from their best line.

    Parameters
    ----------
    points : ndarray, shape (n, k)
        In a plane or in space; n >= 2.

    Returns
    -------
    float
        In the unit of the points.
    """
    centre, way = fitted_line(points)
    rest = np.asarray(points, dtype=np.float64) - centre
    return float(np.linalg.norm(rest - np.outer(rest @ way, way), axis=1).max())
