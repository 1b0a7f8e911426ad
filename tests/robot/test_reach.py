"""Slices of a workspace: Jacobian by its geometry, branches one after the other."""

import numpy as np
import pytest
from conftest import ROOT

import motionfmu
from motionfmu.analysis.collisions import ArmParts
from motionfmu.analysis.dry_run import dry_run
from motionfmu.analysis.reach import least_singular, reach_slice
from motionfmu.report.jobs.dry_run_page import page_text
from motionfmu.virtual.robot import Kinematics

LENGTH = 1500.0  # [mm]


@pytest.fixture(scope="module")
def settings() -> dict:
    """As a dry run has them, whole."""
    return dict(dry_run(motionfmu.load(ROOT / "scenarios/robot_pick")).settings)


def by_geometry(settings: dict, joints: np.ndarray) -> float:
    """The least singular value of columns z x (tip - origin), z, tip at the flange."""
    parts = ArmParts.of(settings)
    points = [parts.origins[0]]
    turn, place = np.eye(3), parts.origins[0]
    ways = np.diff([*parts.origins, parts.flange], axis=0)
    axes = []
    for k in range(6):
        angle = np.radians(parts.signs[k] * joints[k] - parts.offsets[k])
        u = parts.axes[k]
        cross = np.array([[0, -u[2], u[1]], [u[2], 0, -u[0]], [-u[1], u[0], 0]])
        axes.append(parts.signs[k] * turn @ u)
        turn = turn @ (np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross)
        place = place + turn @ ways[k]
        points.append(place)
    columns = [
        np.concatenate([np.cross(z, place - o) / LENGTH, z])
        for z, o in zip(axes, points[:6], strict=True)
    ]
    return float(np.linalg.svd(np.stack(columns, axis=1), compute_uv=False)[-1])


def test_the_least_singular_value_is_that_of_the_geometry(settings: dict) -> None:
    arm = Kinematics(**{**settings, "tool": [0.0] * 6})
    joints = np.random.default_rng(4).uniform(-100.0, 60.0, (200, 6))
    found = least_singular(arm, joints, LENGTH)
    wanted = [by_geometry(settings, q) for q in joints]
    assert np.allclose(found, wanted, rtol=0.0, atol=1e-6)
    straight = joints.copy()
    straight[:, 4] = 0.0
    assert (least_singular(arm, straight, LENGTH) < 1e-6).all()
    joints[3, 2] = np.nan
    assert np.isnan(least_singular(arm, joints, LENGTH)).nonzero()[0].tolist() == [3]


def test_branches_are_those_that_stand_in_the_ranges(settings: dict) -> None:
    """The frame of each branch is the asked one; whole turns are tried one after the other."""
    arm = Kinematics(**{**settings, "tool": [0.0] * 6})
    pose = arm.forward([10.0, 20.0, -30.0, 40.0, 70.0, 60.0])
    x, y = np.meshgrid(np.linspace(-1600, 1600, 13), np.linspace(-1600, 1600, 11))
    place = np.stack([x, y, np.full_like(x, 600.0)], axis=-1)
    low, high = (np.asarray(settings[f"joint_{n}"], float) for n in ("low", "high"))
    found = reach_slice(settings, place, pose[:3, :3], 0, LENGTH)
    known = 0
    for at in np.ndindex(x.shape):
        frame = pose.copy()
        frame[:3, 3] = place[at]
        count, own = 0, np.nan
        for branch, q in enumerate(arm.inverse(frame)):
            if np.isnan(q).any():
                continue
            assert np.allclose(arm.forward(q), frame, atol=1e-6)
            turns = [
                any(a <= x + 360.0 * k <= b for k in range(-3, 4))
                for x, a, b in zip(q, low, high, strict=True)
            ]
            count += all(turns)
            if branch == 0 and all(turns):
                own = by_geometry(settings, q)
        assert found.branches[at] == count
        assert found.least[at] == pytest.approx(own, abs=1e-6, nan_ok=True)
        known += count > 0
    assert 30 < known < x.size - 30


def test_the_page_has_both_slices() -> None:
    page = page_text(dry_run(motionfmu.load(ROOT / "scenarios/robot_pick")))
    assert page.count("<h2>Reach and branches</h2>") == 1
    assert 'id="reach1"' in page and 'id="reach2"' in page
    assert "of line 39" in page
