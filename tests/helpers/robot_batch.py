"""Kinematics of an arm with a spherical wrist, of many poses in one call."""

import ctypes
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import py_opw_kinematics as opw
from eaik.IK_HP import HPRobot
from numpy.typing import NDArray

Array = NDArray[np.float64]
LIBRARY = ctypes.CDLL(str(Path(__file__).resolve().parents[2] / "build/lib/robot_batch.so"))
BRANCHES = 8
SEGMENTS = 640  # more than a path can have


@dataclass(frozen=True)
class Arm:
    """An arm; lengths in m, angles in rad."""

    lengths: tuple[float, ...]
    offsets: tuple[float, ...]
    signs: tuple[int, ...]

    def parameters(self) -> ctypes.Array[ctypes.c_double]:
        """What struct opw holds."""
        return (ctypes.c_double * 19)(*self.lengths, *self.offsets, *self.signs)

    def axes(self) -> HPRobot:
        """The same arm by its axes and the places between them, at inner zeros."""
        a1, a2, b, c1, c2, c3, c4 = self.lengths
        x, y, z = np.eye(3)
        turns = np.array([z, y, y, z, y, z]) * np.array(self.signs)[:, None]
        ways = [c1 * z, a1 * x + b * y, c2 * z, a2 * x + c3 * z, 0 * x, 0 * x, c4 * z]
        return HPRobot(turns, np.array(ways))

    def turned(self, joints: Array) -> Array:
        """Joints from inner zeros on, in the maker's directions [rad]."""
        return joints - np.array(self.offsets) * np.array(self.signs)

    def other(self) -> opw.Robot:
        """The same arm of the other library."""
        names = ("a1", "a2", "b", "c1", "c2", "c3", "c4")
        lengths = dict(zip(names, self.lengths, strict=True))
        flips = tuple(s < 0 for s in self.signs)
        model = opw.KinematicModel(**lengths, offsets=self.offsets, flip_axes=flips)
        return opw.Robot(model, degrees=False)


ARMS = {
    "IRB 2600": Arm(
        (0.150, -0.115, 0, 0.445, 0.7, 0.795, 0.085), (0, 0, -np.pi / 2, 0, 0, 0), (1,) * 6
    ),
    "KR 6": Arm(
        (0.025, -0.035, 0, 0.4, 0.315, 0.365, 0.08),
        (0, -np.pi / 2, 0, 0, 0, 0),
        (-1, 1, 1, -1, 1, -1),
    ),
    "lateral": Arm((0.1, 0.05, 0.035, 0.3, 0.4, 0.35, 0.06), (0.1, 0.2, 0.3, 0, 0.1, 0), (1,) * 6),
}


def pointer(values: NDArray[np.generic]) -> ctypes.c_void_p:
    return values.ctypes.data_as(ctypes.c_void_p)


def forward(arm: Arm, joints: Array) -> Array:
    """Poses (n, 12): place, rows of the rotation."""
    poses = np.empty((len(joints), 12))
    count = ctypes.c_int64(len(joints))
    LIBRARY.robot_batch_forward(arm.parameters(), count, pointer(joints), pointer(poses))
    return poses


def inverse(arm: Arm, poses: Array, near: Array) -> Array:
    """Joints of all branches (n, 8, 6), NaN where there is none."""
    joints = np.full((len(poses), BRANCHES, 6), np.nan)
    there = np.zeros(len(poses), np.uint32)
    count = ctypes.c_int64(len(poses))
    places = (pointer(poses), pointer(near), pointer(joints), pointer(there))
    LIBRARY.robot_batch_inverse(arm.parameters(), count, *places)
    joints[(there[:, None] >> np.arange(BRANCHES) & 1) == 0] = np.nan
    return joints


@dataclass(frozen=True)
class Limits:
    """Of a line and of the joints [rad], [rad/s], [rad/s²]."""

    low: Array
    high: Array
    speed: Array
    turn: Array
    feed: float  # [mm/s]
    acc: float  # [mm/s²]


# Those of the IRB 2600 in tests/core/robot/robot_rig.h.
RIG = Limits(
    np.radians([-180.0, -155, -155, -400, -120, -400]),
    np.radians([180.0, 95, 75, 400, 120, 400]),
    np.radians([175.0, 175, 175, 360, 360, 500]),
    np.radians([400.0, 400, 400, 1500, 1500, 2000]),
    100.0,
    4000.0,
)


@dataclass(frozen=True)
class Line:
    """A line of the flange as the robot plans it."""

    segments: Array  # (n, 3) part of the path at the end, speed [mm/s], acceleration [mm/s²]
    bounds: Array  # (parts, 2, 6) of |q'| [rad/mm] and |q''| [rad/mm²]; 0 where there are none
    joints: Array  # (places, 6) [rad]


def line(
    arm: Arm, limits: Limits, ends: tuple[Array, Array], parts: int = 0, places: int = 0
) -> Line:
    """Plan a line from joints [rad] to a place [mm] with the same attitude."""
    rows = np.column_stack([limits.low, limits.high, limits.speed, limits.turn])
    segments, bounds = np.zeros((SEGMENTS, 3)), np.zeros((parts, 2, 6))
    joints, start, to = np.zeros((places, 6)), *(np.array(e, np.float64) for e in ends)
    count = LIBRARY.robot_batch_line(
        arm.parameters(),
        pointer(rows),
        pointer(start),
        pointer(to),
        ctypes.c_double(limits.feed),
        ctypes.c_double(limits.acc),
        pointer(segments),
        ctypes.c_int64(parts),
        pointer(bounds),
        ctypes.c_int64(places),
        pointer(joints),
    )
    assert count, "the line is refused"
    return Line(segments[:count], bounds, joints)
