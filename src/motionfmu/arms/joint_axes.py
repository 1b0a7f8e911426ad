"""Axes of the joints of an arm as lines, with all angles 0."""

import math
from dataclasses import dataclass

import numpy as np

from motionfmu.arms.arm_description import ArmDescription, Array

# Directions are parallel or at right angles up to this [rad], for files have angles such as 1.57,
# and lines meet up to this [m]. How far an arm's numbers then are from the file is measured and
# told.
ANGLE, MEET = 2e-3, 1e-4


@dataclass(frozen=True)
class JointAxes:
    """Points and directions in the base, (joints, 3)."""

    points: Array
    along: Array

    def angle(self, i: int, j: int) -> float:
        """Between two axes, numbered from 1, 0 to 90 deg [rad]."""
        cross = np.linalg.norm(np.cross(self.along[i - 1], self.along[j - 1]))
        return math.atan2(float(cross), abs(float(self.along[i - 1] @ self.along[j - 1])))

    def apart(self, i: int, j: int) -> float:
        """Distance of two axes [m]."""
        p, q = self.points[i - 1], self.points[j - 1]
        u, v = self.along[i - 1], self.along[j - 1]
        if self.angle(i, j) < ANGLE:
            return float(np.linalg.norm(np.cross(q - p, u)))
        n = np.cross(u, v)
        return abs(float((q - p) @ n)) / float(np.linalg.norm(n))

    def parallel(self, i: int, j: int) -> bool:
        """Whether two axes are in parallel."""
        return self.angle(i, j) < ANGLE

    def upright(self, i: int, j: int) -> bool:
        """Whether two axes are at right angles."""
        return self.angle(i, j) > math.pi / 2 - ANGLE


def joint_axes(arm: ArmDescription) -> JointAxes:
    """Of all joints, those that follow others too."""
    frames = arm.frames(np.zeros(len(arm.driven)))
    return JointAxes(
        np.array([f[:3, 3] for f in frames]),
        np.array([f[:3, :3] @ j.axis for f, j in zip(frames, arm.joints, strict=True)]),
    )
