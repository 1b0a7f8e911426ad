"""Distance of lines in a plane, chord by chord."""

import numpy as np
from scipy.spatial import cKDTree

Lines = list[np.ndarray]


def apart(a: Lines, b: Lines, near: int = 0) -> float:
    """Largest distance of the vertices of one polyline from the lines of the other.

    near: only the chords whose middles are nearest, so many; enough where all are short.
    """
    begin = np.vstack([p[:-1] for p in b])
    way = np.vstack([np.diff(p, axis=0) for p in b])
    square = np.maximum((way**2).sum(axis=1), 1e-300)
    worst, every = 0.0, np.vstack(a)
    if near:
        found = cKDTree(begin + 0.5 * way).query(every, near)[1]
        to, along = every[:, None] - begin[found], way[found]
        share = np.clip((to * along).sum(axis=2) / square[found], 0.0, 1.0)
        off = ((to - share[..., None] * along) ** 2).sum(axis=2).min(axis=1)
        return float(off.max()) ** 0.5
    for p in every:
        share = np.clip(((p - begin) * way).sum(axis=1) / square, 0.0, 1.0)
        worst = max(worst, float(((p - begin - share[:, None] * way) ** 2).sum(axis=1).min()))
    return worst**0.5


def length(lines: Lines) -> float:
    return sum(float(np.linalg.norm(np.diff(p, axis=0), axis=1).sum()) for p in lines)
