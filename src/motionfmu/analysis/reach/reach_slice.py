"""A plane of an arm's workspace: branches within the joints' ranges, distance from singular."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.virtual.robot import Kinematics

Array = NDArray[np.float64]
_STEP = 1e-3  # [deg] of a difference, whose error is 1e-10 of the slope
_TURN = 360.0


@dataclass(frozen=True)
class ReachSlice:
    """Points of a plane, with one orientation of the tool.

    Attributes
    ----------
    place : (m, n, 3) ndarray
        Of the tip [mm].
    branches : (m, n) ndarray of int
        Within the ranges of the joints.
    least : (m, n) ndarray
        The least singular value of the Jacobian in the asked branch (`least_singular`); NaN where
        that does not reach, or not within the ranges.
    """

    place: Array
    branches: NDArray[np.int64]
    least: Array


def least_singular(arm: Kinematics, joints: Any, length: float) -> Array:
    """How far an arm is from singular.

    Parameters
    ----------
    arm : Kinematics
    joints : (..., 6) array_like
        [deg]; where one is NaN the result is.
    length : float
        By which lengths are divided, so that they count as angles do [mm].

    Returns
    -------
    (...) ndarray
        The least speed of the tip for one of the joints' speed, in the direction that is worst: 0
        where it is singular.
    """
    q = np.asarray(joints, float)
    known = np.isfinite(q).all(axis=-1)
    q = np.where(known[..., None], q, 0.0)
    steps = _STEP * np.eye(6)
    ahead = arm.forward(q[..., None, :] + steps)
    behind = arm.forward(q[..., None, :] - steps)
    change = 2.0 * np.radians(_STEP)
    moved = (ahead[..., :3, 3] - behind[..., :3, 3]) / (change * length)
    turned = ahead[..., :3, :3] @ np.swapaxes(behind[..., :3, :3], -1, -2)
    skew = 0.5 * (turned - np.swapaxes(turned, -1, -2)) / change
    spin = np.stack([skew[..., 2, 1], skew[..., 0, 2], skew[..., 1, 0]], axis=-1)
    rows = np.concatenate([moved, spin], axis=-1)
    least = np.linalg.svd(rows, compute_uv=False)[..., -1]
    return np.asarray(np.where(known, least, np.nan))


def reach_slice(
    settings: Mapping[str, Any], place: Array, attitude: Array, branch: int, length: float
) -> ReachSlice:
    """Where an arm reaches in a plane.

    Parameters
    ----------
    settings : mapping
        As of `VirtualRobot`, whole.
    place : (m, n, 3) ndarray
        Points of the flange [mm].
    attitude : (3, 3) ndarray
        Of the flange.
    branch : int
        As of `Kinematics`, of which `ReachSlice.least` is.
    length : float
        As of `least_singular`.

    Returns
    -------
    ReachSlice
    """
    arm = Kinematics(**{**settings, "tool": [0.0] * 6})
    frames = np.zeros((*place.shape[:-1], 4, 4))
    frames[..., :3, :3], frames[..., :3, 3], frames[..., 3, 3] = attitude, place, 1.0
    joints = arm.inverse(frames)
    low, high = (np.asarray(settings[f"joint_{n}"], float) for n in ("low", "high"))
    # The first place within the range, whole turns above its lower end.
    turned = low + (joints - low) % _TURN
    fits = (turned <= high).all(axis=-1)  # NaN does not
    own = np.where(fits[..., branch, None], joints[..., branch, :], np.nan)
    return ReachSlice(place, fits.sum(axis=-1), least_singular(arm, own, length))
