"""A recorded command as a polyline of few points."""

import numpy as np
from numpy.typing import NDArray

from motionfmu.iso9283.turn import Array

TOLERANCE = 1e-4  # [mm]


def simplified(points: Array, tolerance: float = TOLERANCE) -> NDArray[np.int64]:
    """Points (n, k) to keep so that none is farther than the tolerance from the polyline."""
    # Ramer-Douglas-Peucker: the farthest point from a chord parts it, until none is far. The
    # chord ends at its points, so a path that goes back along itself keeps its turning points.
    kept = {0, len(points) - 1}
    waiting = [(0, len(points) - 1)]
    while waiting:
        a, b = waiting.pop()
        if b - a < 2:
            continue
        chord = points[b] - points[a]
        rest = points[a + 1 : b] - points[a]
        size = float(chord @ chord)
        share = np.clip(rest @ chord / size, 0.0, 1.0) if size > 0.0 else np.zeros(len(rest))
        far = np.linalg.norm(rest - share[:, None] * chord, axis=1)
        worst = int(np.argmax(far))
        if far[worst] > tolerance:
            middle = a + 1 + worst
            kept.add(middle)
            waiting += [(a, middle), (middle, b)]
    return np.array(sorted(kept), dtype=np.int64)
