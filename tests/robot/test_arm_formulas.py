"""Formulas of docs/theory/robot.md against what kinematics and planner do."""

import numpy as np
import pytest
from robot_batch import ARMS, RIG, forward, inverse
from wrist_lines import HALF, IRB, passing, swing


@pytest.mark.parametrize("up", [0.3, 3.0, 30.0])
def test_joint_4_beside_the_wrist_s_singular_place(up: float) -> None:
    q = passing(up, places=30_001).joints
    way = np.linspace(-HALF, HALF, len(q))
    slope = np.gradient(q[:, 3], way)
    bend = np.gradient(slope, way)
    least, g = np.abs(np.sin(q[:, 4])).min(), swing()
    near = np.abs(way) < min(0.2 * least / g, 3.0)
    wanted = g * least / ((g * way) ** 2 + least**2)
    assert np.abs(slope)[near] == pytest.approx(wanted[near], rel=2e-3)
    assert np.abs(slope).max() == pytest.approx(g / least, rel=2e-4)
    most = 3.0 * np.sqrt(3.0) / 8.0 * (g / least) ** 2
    assert np.abs(bend).max() == pytest.approx(most, rel=3e-3 * max(1.0, up))


def test_bounds_close_in_with_the_square_of_the_part() -> None:
    way = np.linspace(-HALF, HALF, 16_385)
    slope = np.abs(np.gradient(passing(10.0, places=len(way)).joints[:, 3], way))
    over = []
    for parts in (256, 512, 1024):
        n = (len(way) - 1) // parts
        largest = slope[np.arange(parts)[:, None] * n + np.arange(n + 1)].max(axis=1)
        bound = passing(10.0, parts).bounds[:, 0, 3]
        assert (bound >= largest * (1.0 - 1e-6)).all()
        over.append((bound - largest).max())
    assert over[0] / over[1] == pytest.approx(4.0, rel=0.05)
    assert over[1] / over[2] == pytest.approx(4.0, rel=0.05)


@pytest.mark.parametrize("up", [0.3, 10.0, 100.0])
def test_a_segment_has_what_its_joints_allow(up: float) -> None:
    way = np.linspace(-HALF, HALF, 60_001)
    told = passing(up, places=len(way), feed=300.0)
    slope = np.abs(np.gradient(told.joints, way, axis=0))
    bend = np.abs(np.gradient(np.gradient(told.joints, way, axis=0), way, axis=0))
    n = np.searchsorted(told.segments[:, 0], (way + HALF) / (2.0 * HALF), side="right")
    own = told.segments[np.minimum(n, len(told.segments) - 1)][2:-2]
    cap, acc = own[:, 1:2], own[:, 2:3]
    assert (cap * slope[2:-2] / RIG.speed).max() < 1.0 + 1e-3
    both = (acc * slope[2:-2] + cap**2 * bend[2:-2]) / RIG.turn
    assert 0.8 < both.max() < 1.0 + 1e-2
    assert (cap**2 * bend[2:-2] / RIG.turn).max() < 0.7  # 0.6 at the samples


def test_both_wrists_of_a_stand_and_both_stands_of_a_shoulder() -> None:
    for arm in ARMS.values():
        joints = np.random.default_rng(7).uniform(-2.0, 2.0, (2000, 6))
        every = inverse(arm, forward(arm, joints), joints)
        turned = np.array(arm.signs) * every - np.array(arm.offsets)
        there = np.isfinite(every).all(axis=(1, 2))
        assert there.sum() > 200
        for stand in range(0, 8, 2):
            plain, flipped = turned[there, stand], turned[there, stand + 1]
            assert np.abs(plain[:, :3] - flipped[:, :3]).max() == 0.0
            more = flipped[:, 3:] - plain[:, 3:] * [1.0, -1.0, 1.0]
            assert np.abs(np.exp(1j * more) - [-1.0, 1.0, -1.0]).max() < 1e-9
        # both elbows of a shoulder: what joint 3 is beside a straight arm, to either side
        lean = np.arctan2(arm.lengths[1], arm.lengths[5])
        for shoulder in (0, 4):
            bent = turned[there][:, [shoulder, shoulder + 2], 2] + lean
            assert np.abs(np.sin(bent.sum(axis=1))).max() < 1e-9


def test_the_elbow_near_the_edge_of_reach() -> None:
    a1, a2, _, c1, c2, c3, c4 = IRB.lengths
    k = np.hypot(a2, c3)
    for short in (1e-4, 1e-6):
        reach = c2 + k - short
        pose = np.array([a1 + reach + c4, 0.0, c1, 0, 0, 1, 0, 1, 0, -1, 0, 0.0])
        every = inverse(IRB, pose[None], np.zeros((1, 6)))[0]
        bent = every[0, 2] + np.pi / 2 + np.arctan2(a2, c3)
        wanted = np.sqrt(2.0 * (c2 + k) * short / (c2 * k))
        assert bent == pytest.approx(wanted, rel=1e-3)


def test_the_arm_by_denavit_and_hartenberg() -> None:
    for arm in ARMS.values():
        a1, a2, b, c1, c2, c3, c4 = arm.lengths
        joints = np.random.default_rng(8).uniform(-3.0, 3.0, (50, 6))
        turns = np.array(arm.signs) * joints - np.array(arm.offsets)
        quarter = np.pi / 2
        rows = [(0, c1, a1, -1), (-1, b, c2, 0), (1, 0, a2, 1), (0, c3, 0, -1), (0, 0, 0, 1),
                (0, c4, 0, 0)]  # fmt: skip
        for turn, pose in zip(turns, forward(arm, joints), strict=True):
            frame = np.eye(4)
            for angle, (shift, d, a, twist) in zip(turn, rows, strict=True):
                c, s = np.cos(angle + shift * quarter), np.sin(angle + shift * quarter)
                ca, sa = np.cos(twist * quarter), np.sin(twist * quarter)
                step = [[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s],
                        [0, sa, ca, d], [0, 0, 0, 1]]  # fmt: skip
                frame = frame @ np.array(step)
            assert frame[:3, 3] == pytest.approx(pose[:3], abs=1e-13)
            assert frame[:3, :3].ravel() == pytest.approx(pose[3:], abs=1e-13)
