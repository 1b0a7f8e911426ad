"""The parts of an arm as round bars between its joints."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
NAMES = ("base", *(f"link {k}" for k in range(1, 7)), "tool")
# Radii as shares of the way from axis 1 to the flange along the links, as on arms that are sold.
_SHARES = (0.09, 0.085, 0.065, 0.055, 0.045, 0.04, 0.035, 0.015)
_Y, _Z = np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0])
_SHORT = 1e-6  # [mm] a part without length


@dataclass(frozen=True)
class ArmParts:
    """Base, links and tool as bars with round ends between joints.

    Attributes
    ----------
    origins, axes : (6, 3) ndarray
        Of the joints with all inner angles 0, in the base [mm], unit vectors.
    flange : (3,) ndarray
        There [mm].
    signs, offsets : (6,) ndarray
        Inner angle = sign * joint - offset [deg].
    radii : (8,) ndarray
        Of base, links and tool [mm].
    slides : (6,) ndarray of bool
        Joints that slide along their axes.
    levels : (6,) ndarray of int
        So many joints before each do not tilt its link.
    hand : (3,) ndarray
        Joint 4 from its pivot, on the hand that is level [mm].
    """

    origins: Array
    axes: Array
    flange: Array
    signs: Array
    offsets: Array
    radii: Array
    slides: NDArray[np.bool_]
    levels: NDArray[np.int64] = field(default_factory=lambda: np.zeros(6, np.int64))
    hand: Array = field(default_factory=lambda: np.zeros(3))

    @classmethod
    def of(
        cls, settings: Mapping[str, Any], radii: Mapping[str, float] | None = None
    ) -> "ArmParts":
        """The parts of a soft controller's arm.

        Parameters
        ----------
        settings : mapping
            As of `VirtualRobot`, whole.
        radii : mapping, optional
            [mm] by the names of parts; others are shares of the arm's length.

        Returns
        -------
        ArmParts
        """
        if settings["arm_by"] == 1:
            levels = np.asarray(settings["joint_level"], np.int64)
            hand = 1e3 * np.asarray(settings["hand_offset"], float)
            origins = 1e3 * np.cumsum(np.reshape(settings["axis_origin"], (6, 3)), axis=0)
            origins[3:] += hand
            axes = np.reshape(settings["axis_direction"], (6, 3)).astype(float)
            flange = origins[5] + np.asarray(settings["flange"], float)[:3]
            signs, offsets = np.ones(6), np.zeros(6)
            slides = np.asarray(settings["joint_slides"]) == 1
        else:
            a1, a2, b, c1, c2, c3, c4 = (
                1e3 * float(settings[n]) for n in ("a1", "a2", "b", "c1", "c2", "c3", "c4")
            )
            shoulder = np.array([a1, b, c1])
            elbow = shoulder + np.array([0.0, 0.0, c2])
            wrist = elbow + np.array([a2, 0.0, c3])
            origins = np.array([[0.0, 0.0, c1], shoulder, elbow, wrist, wrist, wrist])
            axes = np.array([_Z, _Y, _Y, _Z, _Y, _Z])
            flange = wrist + np.array([0.0, 0.0, c4])
            signs = np.asarray(settings["joint_sign"], float)
            offsets = np.asarray(settings["joint_offset"], float)
            slides, levels, hand = np.zeros(6, bool), np.zeros(6, np.int64), np.zeros(3)
        axes = axes / np.linalg.norm(axes, axis=1, keepdims=True)
        length = float(np.linalg.norm(np.diff([*origins, flange], axis=0), axis=1).sum())
        given = radii or {}
        sizes = [given.get(n, s * length) for n, s in zip(NAMES, _SHARES, strict=True)]
        radius = np.array(sizes)
        return cls(origins, axes, flange, signs, offsets, radius, slides, levels, hand)

    def points(self, joints: Array, tip: Array) -> Array:
        """Ends of the parts, (n, 9, 3) [mm].

        Parameters
        ----------
        joints : (n, 6) ndarray
            [deg], of joints that slide [mm].
        tip : (n, 3) ndarray
            Of the tool, in the base [mm].

        Returns
        -------
        (n, 9, 3) ndarray
            The base's foot, the six joints, the flange, the tip; a part is from one to the next.
        """
        angles = np.radians(self.signs * joints - self.offsets)
        turn = np.broadcast_to(np.eye(3), (len(joints), 3, 3))
        place = np.broadcast_to(self.origins[0], (len(joints), 3))
        found = [np.zeros((len(joints), 3))]
        ways = np.diff([*self.origins, self.flange], axis=0)
        turns = [turn]
        for k in range(6):
            if self.levels[k]:  # its way so far went along the link before, the hand's does not
                level = turns[k - self.levels[k]]
                hand = self.hand if k == 3 else np.zeros(3)
                place, turn = place + (level - turn) @ hand, level
            if self.slides[k]:
                place = place + joints[:, k, None] * (turn @ self.axes[k])
            else:
                turn = turn @ _about(self.axes[k], angles[:, k])
            turns.append(turn)
            found.append(place)
            place = place + turn @ ways[k]
        return np.stack([*found, place, tip], axis=1)

    @property
    def pairs(self) -> list[tuple[int, int]]:
        """Parts that can come apart and together, by number.

        Two that the parts between them hold nearer than their radii touch in every position.
        """
        ends = np.array([np.zeros(3), *self.origins, self.flange])
        lengths = np.linalg.norm(np.diff(ends, axis=0), axis=1)
        there = [k for k in range(7) if lengths[k] > _SHORT]
        return [
            (a, b)
            for a, b in combinations([*there, 7], 2)
            if lengths[a + 1 : b].sum() > self.radii[a] + self.radii[b]
        ]


def _about(axis: Array, angle: Array) -> Array:
    """Turns (n, 3, 3) about an axis, by Rodrigues' formula."""
    x, y, z = axis
    k = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    s, c = np.sin(angle)[:, None, None], np.cos(angle)[:, None, None]
    return np.asarray(np.eye(3) + s * k + (1.0 - c) * (k @ k))
