"""Distances of line segments from each other and from boxes, on arrays, exact to rounding."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_NOTHING = 1e-300


def between_segments(a: tuple[Array, Array], b: tuple[Array, Array]) -> Array:
    """Least distances (n,) of segments, each by its two ends (n, 3).

    Of two lines that are not parallel the nearest points, clamped to the segments one after the
    other (Lumelsky 1985); of parallel ones some nearest points.
    """
    along, other, from_b = a[1] - a[0], b[1] - b[0], a[0] - b[0]
    aa, bb, ab = _dot(along, along), _dot(other, other), _dot(along, other)
    fa, fb = _dot(along, from_b), _dot(other, from_b)
    crossed = aa * bb - ab * ab
    free = crossed > 1e-12 * aa * bb
    s = np.where(free, _share(ab * fb - bb * fa, np.where(free, crossed, 1.0)), 0.0)
    t = _share(ab * s + fb, bb)
    s = _share(ab * t - fa, aa)
    apart = from_b + s[:, None] * along - t[:, None] * other
    return np.asarray(np.linalg.norm(apart, axis=1))


def from_box(a: tuple[Array, Array], half: Array) -> Array:
    """Least distances (n,) of segments from a box about 0 of half lengths (3,); 0 inside.

    The square of a point's distance is convex along a segment, its derivative is straight between
    the places where the segment crosses a plane of a face.
    """
    begin, along = a[0], a[1] - a[0]
    step = np.where(along == 0.0, 1.0, along)
    planes = np.concatenate([(half - begin) / step, (-half - begin) / step], axis=1)
    n = len(begin)
    places = np.concatenate([np.zeros((n, 1)), np.clip(planes, 0.0, 1.0), np.ones((n, 1))], axis=1)
    places.sort(axis=1)
    slopes = _dot(
        _outside(begin[:, None] + places[:, :, None] * along[:, None], half), along[:, None]
    )
    after = np.argmax(slopes >= 0.0, axis=1)  # the first place from which it rises
    after = np.where((slopes < 0.0).all(axis=1), places.shape[1] - 1, after)
    before, rows = np.maximum(after - 1, 0), np.arange(n)
    t0, t1 = places[rows, before], places[rows, after]
    g0, g1 = slopes[rows, before], slopes[rows, after]
    falls = (g0 < 0.0) & (g1 > 0.0)
    t = np.where(falls, t0 - g0 * (t1 - t0) / np.where(falls, g1 - g0, 1.0), t1)
    return np.asarray(np.linalg.norm(_outside(begin + t[:, None] * along, half), axis=1))


def _outside(points: Array, half: Array) -> Array:
    """From the nearest point of a box to each."""
    return np.asarray(points - np.clip(points, -half, half))


def _dot(a: Array, b: Array) -> Array:
    return np.asarray((a * b).sum(axis=-1))


def _share(part: Array, whole: Array) -> Array:
    """A share of a segment; 0 of a segment without length."""
    return np.asarray(
        np.clip(np.where(whole > 0.0, part / np.maximum(whole, _NOTHING), 0.0), 0.0, 1.0)
    )
