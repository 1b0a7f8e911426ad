"""A recorded command as a polyline of few points."""

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.iso9283.turn import Array

TOLERANCE = 1e-4  # [mm]


def simplified(points: Array, tolerance: float = TOLERANCE) -> NDArray[np.int64]:
    """Points (n, k) to keep so that none is farther than the tolerance from the polyline."""
    # Ramer-Douglas-Peucker: the farthest point from a chord parts it, until none is far. The
    # chord ends at its points, so a path that goes back along itself keeps its turning points.
    columns = np.ascontiguousarray(points.T)
    kept = {0, len(points) - 1}
    waiting = [(0, len(points) - 1)]
    while waiting:
        a, b = waiting.pop()
        if b - a < 2:
            continue
        chord = columns[:, b] - columns[:, a]
        rest = columns[:, a + 1 : b] - columns[:, a, None]
        size = float(chord @ chord)
        if size > 0.0:
            rest -= chord[:, None] * np.clip(chord @ rest / size, 0.0, 1.0)
        far = np.einsum("ij,ij->j", rest, rest)
        worst = int(np.argmax(far))
        if far[worst] > tolerance**2:
            middle = a + 1 + worst
            kept.add(middle)
            waiting += [(a, middle), (middle, b)]
    return np.array(sorted(kept), dtype=np.int64)
