"""Kinematics of the arm, attitudes and moves of its joints against other people's libraries."""

import ctypes

import numpy as np
import pytest
import ruckig
from robot_batch import ARMS, BRANCHES, LIBRARY, Array, forward, inverse, pointer
from scipy.spatial.transform import Rotation, Slerp

POSES = 100_000


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


@pytest.mark.parametrize("name", ARMS)
def test_poses_and_branches_are_those_of_subproblems_in_geometry(name: str) -> None:
    arm, robot = ARMS[name], ARMS[name].axes()
    joints = np.random.default_rng(2).uniform(-3.1, 3.1, (1000, 6))
    poses = forward(arm, joints)
    mine = inverse(arm, poses, joints)
    found = 0
    for q, pose, branches in zip(joints, poses, mine, strict=True):
        theirs = robot.fwdKin(arm.turned(q))
        assert np.abs(theirs[:3, 3] - pose[:3]).max() < 1e-12
        assert np.abs(theirs[:3, :3] - pose[3:].reshape(3, 3)).max() < 1e-12
        solution = robot.IK(theirs)
        exact = np.array(
            [s for s, least in zip(solution.Q, solution.is_LS, strict=True) if not least]
        )
        there = branches[np.isfinite(branches).all(axis=1)]
        if len(exact) != len(there):
            continue  # one of them at the edge of reach
        between = apart(arm.turned(there)[:, None], exact[None])
        assert between.min(axis=1).max() < 1e-6
        found += 1
    assert found > 950


def test_every_branch_leads_back_to_its_pose() -> None:
    for arm in ARMS.values():
        joints = np.random.default_rng(3).uniform(-3.1, 3.1, (POSES, 6))
        poses = forward(arm, joints)
        branches = inverse(arm, poses, joints)
        there = np.isfinite(branches).all(axis=2)
        again = forward(arm, np.ascontiguousarray(branches[there]))
        far = np.abs(again - np.repeat(poses[:, None], BRANCHES, 1)[there]).max(axis=1)
        assert far.max() < 1e-9  # [m], and 1 in the rotation
        nearest = apart(branches, joints[:, None]).min(axis=1, initial=9.0, where=there)
        assert np.quantile(nearest, 0.999) < 1e-9
        assert nearest.max() < 1e-5  # close to singular places


def test_attitudes_between_two_are_those_of_scipy() -> None:
    random = np.random.default_rng(4)
    count = 2000
    ends = random.normal(size=(2, count, 4))
    ends[1, : count // 4] = ends[0, : count // 4] + 1e-9 * ends[1, : count // 4]
    ends /= np.linalg.norm(ends, axis=2, keepdims=True)
    parts = random.uniform(size=count)
    between = np.empty((count, 4))
    a, b = np.ascontiguousarray(ends[0]), np.ascontiguousarray(ends[1])
    LIBRARY.robot_batch_slerp(
        ctypes.c_int64(count), pointer(a), pointer(b), pointer(parts), pointer(between)
    )
    for n in range(count):
        pair = Rotation.from_quat(ends[:, n], scalar_first=True)
        theirs = Slerp([0.0, 1.0], pair)(parts[n]).as_matrix()
        mine = Rotation.from_quat(between[n], scalar_first=True).as_matrix()
        assert np.abs(mine - theirs).max() < 1e-14


def test_angles_of_a_program_turn_about_fixed_axes() -> None:
    angles = np.random.default_rng(5).uniform(-180, 180, (2000, 3))
    turns = np.empty((len(angles), 4))
    LIBRARY.robot_batch_angles(ctypes.c_int64(len(angles)), pointer(angles), pointer(turns))
    theirs = Rotation.from_euler("xyz", angles, degrees=True).as_matrix()
    assert np.abs(Rotation.from_quat(turns, scalar_first=True).as_matrix() - theirs).max() < 1e-14


def least_time(way: float, speed: float, acceleration: float, jerk: float) -> float:
    """Duration of ruckig's move of one coordinate from rest to rest [s]."""
    asked, found = ruckig.InputParameter(1), ruckig.Trajectory(1)
    asked.target_position = [way]
    asked.max_velocity, asked.max_acceleration, asked.max_jerk = [speed], [acceleration], [jerk]
    assert ruckig.Ruckig(1).calculate(asked, found) == ruckig.Result.Working
    return float(found.duration)


def test_moves_of_joints_take_the_least_time() -> None:
    random = np.random.default_rng(6)
    count, smooth, share = 500, 0.05, 0.8
    limits = np.column_stack(
        [np.full(6, -7.0), np.full(6, 7.0), random.uniform(2, 8, 6), random.uniform(5, 30, 6)]
    )
    ends = random.uniform(-7, 7, (2, count, 6)) * random.choice([0.01, 0.1, 1], (1, count, 1))
    ends[1, ::2, 1:] = ends[0, ::2, 1:]  # every second one moves joint 1 alone
    a, b, time = np.ascontiguousarray(ends[0]), np.ascontiguousarray(ends[1]), np.empty(count)
    LIBRARY.robot_batch_moves(
        ARMS["KR 6"].parameters(),
        pointer(limits),
        ctypes.c_double(smooth),
        ctypes.c_double(share),
        ctypes.c_int64(count),
        pointer(a),
        pointer(b),
        pointer(time),
    )
    for n in range(count):
        ways = np.abs(b[n] - a[n])
        moved = ways > 0
        # All joints on one straight line: part of it per second by the slowest.
        speed = share * (limits[moved, 2] / ways[moved]).min()
        acceleration = (limits[moved, 3] / ways[moved]).min()
        straight = least_time(1.0, speed, acceleration, acceleration / smooth)
        assert time[n] == pytest.approx(straight, rel=1e-9)
        alone = [
            least_time(w, share * x[2], x[3], x[3] / smooth)
            for w, x in zip(ways[moved], limits[moved], strict=True)
        ]
        assert time[n] >= max(alone) * (1 - 1e-9)
        assert len(alone) > 1 or time[n] == pytest.approx(alone[0], rel=1e-9)
