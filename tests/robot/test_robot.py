"""Kinematics of the arm against py-opw-kinematics: poses, and the set of branches."""

import ctypes
from dataclasses import dataclass

import numpy as np
import py_opw_kinematics as opw
import pytest
from conftest import ROOT
from numpy.typing import NDArray

Array = NDArray[np.float64]
LIBRARY = ctypes.CDLL(str(ROOT / "build/lib/robot_batch.so"))
POSES = 20_000
BRANCHES = 8


@dataclass(frozen=True)
class Arm:
    """An arm; lengths in m, angles in rad."""

    lengths: tuple[float, ...]
    offsets: tuple[float, ...]
    signs: tuple[int, ...]

    def parameters(self) -> ctypes.Array[ctypes.c_double]:
        """What struct opw holds."""
        return (ctypes.c_double * 19)(*self.lengths, *self.offsets, *self.signs)

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


def apart(a: Array, b: Array) -> Array:
    """Largest difference of joints, whole turns left out [rad]."""
    return np.abs(np.remainder(a - b + np.pi, 2 * np.pi) - np.pi).max(axis=-1)


@pytest.mark.parametrize("name", ARMS)
def test_poses_and_branches_are_those_of_the_other_library(name: str) -> None:
    arm, robot = ARMS[name], ARMS[name].other()
    joints = np.random.default_rng(1).uniform(-3.1, 3.1, (POSES, 6))
    poses = forward(arm, joints)
    theirs = robot.batch_forward(joints)
    matrices = np.asarray(theirs.as_matrix())
    assert np.abs(poses[:, :3] - matrices[:, :3, 3]).max() < 1e-12
    assert np.abs(poses[:, 3:].reshape(-1, 3, 3) - matrices[:, :3, :3]).max() < 1e-12
    mine = inverse(arm, poses, joints)
    # Its slots count 4 for the wrist, 2 for the shoulder, 1 for the elbow.
    slots = [4 * (k & 1) + 2 * (k >> 2) + (k >> 1 & 1) for k in range(BRANCHES)]
    reached = np.asarray(robot.reach(theirs).joints)[:, slots]
    both = np.isfinite(mine).all(axis=2) & np.isfinite(reached).all(axis=2)
    either = np.isfinite(mine).any(axis=2) | np.isfinite(reached).any(axis=2)
    assert both.sum() > 5 * POSES
    assert (either & ~both).sum() < 1e-4 * both.sum()  # at the edge of reach, by rounding
    between = apart(mine, reached)[both]
    assert np.quantile(between, 0.999) < 1e-9
    assert between.max() < 1e-5  # close to singular places
