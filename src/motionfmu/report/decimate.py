"""Fewer points with every peak kept."""

import numpy as np
from numpy.typing import NDArray

from motionfmu.contour.geometry import Array

Index = NDArray[np.int64]


def keep_steps(values: Array, buckets: int) -> Index:
    """Samples at which a staircase changes, or its peaks."""
    # Peaks where there are more than twice as many changes as buckets; both ends are among them.
    changed = np.flatnonzero(np.diff(values) != 0) + 1
    if len(changed) > 2 * buckets:
        return keep_peaks(values, buckets)
    return np.union1d(changed, np.array([0, len(values) - 1]))


def keep_peaks(values: Array, buckets: int) -> Index:
    """Samples with the least and the largest value of each bucket."""
    # Of (n,) or (n, k): one or several signals with common samples; both ends are among them.
    columns = values.reshape(len(values), -1)
    count = len(columns)
    if count <= 2 * buckets:
        return np.arange(count)
    edges = np.linspace(0, count, buckets + 1).astype(np.int64)
    width = int(np.diff(edges).max())
    # rows of equal length: the last samples of a shorter bucket are repeated
    rows = np.minimum(edges[:-1, None] + np.arange(width), edges[1:, None] - 1)
    kept = [np.array([0, count - 1])]
    for column in columns.T:
        block = column[rows]
        for best in (block.argmin(axis=1), block.argmax(axis=1)):
            kept.append(rows[np.arange(buckets), best])
    return np.unique(np.concatenate(kept))
