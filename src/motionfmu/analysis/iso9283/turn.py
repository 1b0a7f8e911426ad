"""Orientations as quaternions (w, x, y, z), and the angles between them."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def unit(q: Array) -> Array:
    """Quaternions (..., 4) of length one; a ValueError if one has none."""
    size = np.linalg.norm(q, axis=-1, keepdims=True)
    if not (np.isfinite(size).all() and (size > 0.0).all()):
        raise ValueError("a quaternion has no length")
    return np.asarray(q / size)


def between(a: Array, b: Array, share: Array) -> Array:
    """Orientation a share of the way from a to b (n, 4), by the shorter arc."""
    b = np.where((a * b).sum(axis=-1, keepdims=True) < 0.0, -b, b)
    return unit(a + share[..., None] * (b - a))


def deviation(actual: Array, command: Array) -> Array:
    """Angles a, b, c (..., 3) about x, y, z that lead from command to actual [deg]."""
    # Of R = actual command^-1 = Rz(c) Ry(b) Rx(a) in the base frame: no singular place is near 0.
    w, x, y, z = np.moveaxis(_product(actual, command * np.array([1.0, -1.0, -1.0, -1.0])), -1, 0)
    a = np.arctan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))
    b = np.arcsin(np.clip(2.0 * (w * y - z * x), -1.0, 1.0))
    c = np.arctan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
    return np.degrees(np.stack([a, b, c], axis=-1))


def _product(p: Array, q: Array) -> Array:
    pw, px, py, pz = np.moveaxis(p, -1, 0)
    qw, qx, qy, qz = np.moveaxis(q, -1, 0)
    return np.stack(
        [
            pw * qw - px * qx - py * qy - pz * qz,
            pw * qx + px * qw + py * qz - pz * qy,
            pw * qy - px * qz + py * qw + pz * qx,
            pw * qz + px * qy - py * qx + pz * qw,
        ],
        axis=-1,
    )
