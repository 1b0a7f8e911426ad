"""Inverse dynamics of a chain of links, linear in ten standard parameters of each.

A link's parameters are, in its own frame with the joint as origin,

    m, m cx, m cy, m cz, Ixx, Ixy, Iyy, Ixz, Iyz, Izz        (about the joint)

With the speed w, its rate b and the acceleration a of the origin (free fall counts as g upwards),

    force  = m a + (b x + w x w x) m c
    moment = m c x a + I b + w x I w
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
NAMES = ("m", "mx", "my", "mz", "Ixx", "Ixy", "Iyy", "Ixz", "Iyz", "Izz")
PRODUCTS = [NAMES.index(n) for n in ("Ixy", "Iyz", "Ixz")]  # as a plant has them
UNITS = ("kg", *3 * ("kg·m",), *6 * ("kg·m²",))


def regressor(
    axes: Array, origins: Array, gravity: float, motion: tuple[Array, Array, Array]
) -> Array:
    """Torque of each joint per standard parameter, (samples, joints, 10 joints).

    `axes` and `origins` [m] are (joints, 3), in frames that are parallel where all angles are 0;
    `motion` has angles, speeds and accelerations, (samples, joints).
    """
    q, v, acc = motion
    samples, joints = q.shape
    turns, wrenches = [], []
    rate, spin, fall = np.zeros((3, samples, 3))
    fall = fall + np.array([0.0, 0.0, gravity])
    for k in range(joints):
        back = _turn(axes[k], q[:, k]).transpose(0, 2, 1)  # from the link before into this one
        turns.append(back.transpose(0, 2, 1))
        arm = np.broadcast_to(origins[k], rate.shape)
        fall = fall + np.cross(spin, arm) + np.cross(rate, np.cross(rate, arm))
        fall = _times(back, fall)
        before = _times(back, rate)
        own = axes[k] * v[:, k, None]
        spin = _times(back, spin) + np.cross(before, own) + axes[k] * acc[:, k, None]
        rate = before + own
        wrenches.append(_wrench(rate, spin, fall))
    found = np.zeros((samples, joints, 10 * joints))
    for k, (force, moment) in enumerate(wrenches):
        here = slice(10 * k, 10 * k + 10)
        for i in range(k, -1, -1):
            found[:, i, here] = np.einsum("c,ncp->np", axes[i], moment)
            force = turns[i] @ force
            moment = turns[i] @ moment + _cross(np.broadcast_to(origins[i], (1, 3))) @ force
    return found


def standard(mass: Array, center: Array, inertia: Array) -> Array:
    """Standard parameters of links, (links, 10), of their inertias (links, 3) about the centres."""
    x, y, z = center.T
    xx, yy, zz = inertia.T
    m = mass
    return np.column_stack(
        [
            *(m, m * x, m * y, m * z),
            *(xx + m * (y**2 + z**2), -m * x * y, yy + m * (z**2 + x**2)),
            *(-m * z * x, -m * y * z, zz + m * (x**2 + y**2)),
        ]
    )


def _wrench(rate: Array, spin: Array, fall: Array) -> tuple[Array, Array]:
    """Force and moment at the joint per parameter of a link, each (samples, 3, 10)."""
    force, moment = np.zeros((2, len(rate), 3, 10))
    w = _cross(rate)
    force[:, :, 0] = fall
    force[:, :, 1:4] = _cross(spin) + w @ w
    moment[:, :, 1:4] = -_cross(fall)
    moment[:, :, 4:] = _tensor(spin) + w @ _tensor(rate)
    return force, moment


def _tensor(v: Array) -> Array:
    """I v per element of I, (samples, 3, 6)."""
    x, y, z = v.T
    o = np.zeros_like(x)
    return np.stack([[x, y, o, z, o, o], [o, x, y, o, z, o], [o, o, o, x, y, z]]).transpose(2, 0, 1)


def _cross(v: Array) -> Array:
    """The matrix of a vector product from the left, (samples, 3, 3)."""
    x, y, z = v.T
    o = np.zeros_like(x)
    return np.stack([[o, -z, y], [z, o, -x], [-y, x, o]]).transpose(2, 0, 1)


def _turn(axis: Array, angle: Array) -> Array:
    """Rotation matrices about an axis, (samples, 3, 3)."""
    k = _cross(axis[None])[0]
    s, c = np.sin(angle)[:, None, None], np.cos(angle)[:, None, None]
    return np.asarray(np.eye(3) + s * k + (1.0 - c) * (k @ k))


def _times(m: Array, v: Array) -> Array:
    return np.einsum("nij,nj->ni", m, v)
