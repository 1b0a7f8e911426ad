"""An arm with a spherical wrist: where its joints are."""

import numpy as np
from numpy.typing import NDArray

from motionfmu.scenarios.arm_lengths import Arm

Array = NDArray[np.float64]


def chain(arm: Arm, joints: Array) -> dict[str, Array]:
    """Points (n, 3) [mm] of the arm, by name, for joint angles (n, 6) [rad]."""
    a1, a2, b, c1, c2, c3, c4 = arm.lengths
    th = np.asarray(arm.signs) * joints - np.asarray(arm.offsets)
    turned = _about_z(th[:, 0])
    upper = turned @ _about_y(th[:, 1])
    fore = turned @ _about_y(th[:, 1] + th[:, 2])
    hand = fore @ _about_z(th[:, 3]) @ _about_y(th[:, 4]) @ _about_z(th[:, 5])
    column = np.broadcast_to([0.0, 0.0, c1], (len(th), 3))
    shoulder = column + turned @ np.array([a1, b, 0.0])
    elbow = shoulder + upper @ np.array([0.0, 0.0, c2])
    wrist = elbow + fore @ np.array([a2, 0.0, c3])
    flange = wrist + hand @ np.array([0.0, 0.0, c4])
    tip = flange + hand @ np.array([0.0, 0.0, arm.pen])
    names = ("column", "shoulder", "elbow", "wrist", "flange", "tip")
    return dict(zip(names, (column, shoulder, elbow, wrist, flange, tip), strict=True))


def _about_z(angle: Array) -> Array:
    c, s, o, i = np.cos(angle), np.sin(angle), np.zeros_like(angle), np.ones_like(angle)
    return np.stack([c, -s, o, s, c, o, o, o, i], axis=-1).reshape(-1, 3, 3)


def _about_y(angle: Array) -> Array:
    c, s, o, i = np.cos(angle), np.sin(angle), np.zeros_like(angle), np.ones_like(angle)
    return np.stack([c, o, s, o, i, o, -s, o, c], axis=-1).reshape(-1, 3, 3)
