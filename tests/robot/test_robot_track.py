"""A robot on a track, by kinematics of others: places in the world, steps, limits, pulses."""

from pathlib import Path

import numpy as np
import py_opw_kinematics as opw
import pytest
from numpy.typing import NDArray

import motionfmu
from motionfmu.analysis.collisions import ArmParts, read_cell
from motionfmu.analysis.dry_run import dry_run
from motionfmu.live.live_machine import LiveMachine
from motionfmu.live.live_scene import scene
from motionfmu.report.run_summary import summary_of
from motionfmu.report.view.scene import scene_of
from motionfmu.run.tool_gap import tool_gaps

ROOT = Path(__file__).parents[2]
SPEED = np.radians([175, 175, 175, 300, 300, 375])
TRACK_SPEED, TRACK_ACC, SCALE = 0.9, 1.5, 62500


@pytest.fixture(scope="module")
def ridden() -> motionfmu.Result:
    return motionfmu.load(ROOT / "scenarios/robot_track").run()


def tip(joints: NDArray[np.float64], track: NDArray[np.float64]) -> NDArray[np.float64]:
    """Of a pen of 150 mm on an arm that a track carries along y [mm]."""
    lengths = {"a1": 0.15, "a2": -0.115, "b": 0, "c1": 0.445, "c2": 0.7, "c3": 0.795, "c4": 0.085}
    model = opw.KinematicModel(**lengths, offsets=(0, 0, -np.pi / 2, 0, 0, 0))
    robot = opw.Robot(model, degrees=False)
    poses = [robot.forward(q) for q in joints]
    tips = np.array([p.translation + p.rotation.as_matrix()[:, 2] * 0.15 for p in poses])
    return (tips + np.outer(track, [0.0, 1.0, 0.0])) * 1e3


def test_the_tool_keeps_its_line_in_the_world(ridden: motionfmu.Result) -> None:
    on = np.flatnonzero(ridden["soft.line"] == 22)
    place = tip(ridden["soft.joint_command"][on], ridden["soft.external_command"][on])
    assert np.abs(place[:, [0, 2]] - [1000.0, 600.0]).max() < 1e-6
    assert np.ptp(place[:, 1]) > 3390.0
    part = (place[:, 1] + 1700.0) / 3400.0
    way = (ridden["soft.external_command"][on] + 1.2) / 2.4
    assert np.abs(part - way).max() < 1e-9


def test_the_tool_stands_while_the_track_passes(ridden: motionfmu.Result) -> None:
    on = np.flatnonzero(ridden["soft.line"] == 24)
    track = ridden["soft.external_command"][on]
    place = tip(ridden["soft.joint_command"][on], track)
    assert np.ptp(track) > 0.59
    assert np.abs(place - [1000.0, 1700.0, 600.0]).max() < 1e-6


def test_joints_and_track_arrive_together(ridden: motionfmu.Result) -> None:
    for line in (20, 25):
        on = np.flatnonzero(ridden["soft.line"] == line)
        every = np.column_stack(
            (ridden["soft.joint_command"][on], ridden["soft.external_command"][on])
        )
        last = every[-1] if line == 25 else every[np.argmin(every[:, 6])]
        first = every[0] if line == 25 else np.append(np.radians([0, 0, 0, 0, 90, 0]), 0.0)
        moves = np.abs(last - first) > 1e-3
        part = (every - first)[:, moves] / (last - first)[moves]
        assert moves[6] and moves.sum() >= 4
        assert np.ptp(part, axis=1).max() < 2e-6


def test_limits_and_pulses(ridden: motionfmu.Result) -> None:
    rate = ridden["soft.external_command_rate"]
    dt = np.diff(ridden.time)[0]
    assert 0.99 * TRACK_SPEED < np.abs(rate).max() <= TRACK_SPEED * (1 + 1e-9)
    assert 0.9 * TRACK_ACC < np.abs(np.diff(rate)).max() / dt <= TRACK_ACC * (1 + 1e-6)
    assert (np.abs(ridden["soft.joint_rate"]).max(axis=0) <= SPEED * (1 + 1e-9)).all()
    ahead = np.abs(ridden["card.external_count"] - SCALE * ridden["soft.external_command"])
    assert ahead.max() < 0.5 + TRACK_SPEED * SCALE * 1e-4 * 2
    rests = np.abs(rate) == 0.0
    assert rests[1:-1].any() and (ahead[-500:] <= 0.5).all()


def test_the_pen_follows_as_the_drives_do(ridden: motionfmu.Result) -> None:
    on = np.flatnonzero(ridden["soft.line"] == 24)[50:]
    pen = ridden["arm.tool_position"][on, 1] + ridden["track.table_position"][on, 0]
    assert np.abs(pen - 1.7).max() < 2e-3
    carried = ridden["arm.tool_position"][on, 1]
    assert np.ptp(carried) > 0.55


def test_tool_and_command_are_compared_in_one_frame(ridden: motionfmu.Result) -> None:
    (tool,) = tool_gaps(ridden)
    carried = np.outer(ridden["soft.external_command"], [0.0, 1.0, 0.0])
    assert np.abs(ridden["soft.base_place"] - carried).max() < 1e-15
    gap = 1e3 * (ridden["arm.tool_position"] + carried - ridden["soft.tool_position"])
    distance = np.linalg.norm(gap, axis=1)
    assert tool.distance(0, len(ridden.time)) == pytest.approx(distance, abs=1e-9)
    assert tool.sizes[0].largest < 15.0  # 11 ms behind, at 1 m/s


def test_pictures_and_the_way_are_in_the_world(ridden: motionfmu.Result) -> None:
    scene = scene_of(ridden)
    assert scene is not None and scene.base is not None and scene.joints is not None
    command = 1e3 * ridden["soft.tool_position"]
    shown = np.searchsorted(ridden.time, scene.time)
    assert np.linalg.norm(scene.tool - command[shown], axis=1).max() < 15.0
    assert scene.base == pytest.approx(1e3 * ridden["soft.base_place"][shown], abs=1e-9)
    # The arm's tip stands on its base where the tool is.
    place = tip(scene.joints, scene.base[:, 1] * 1e-3)
    assert np.linalg.norm(place - scene.tool, axis=1).max() < 2.0
    world = 1e3 * (ridden["arm.tool_position"] + ridden["soft.base_place"])
    way = np.linalg.norm(np.diff(world, axis=0), axis=1).sum()
    distance = summary_of(ridden, None).distance
    assert way > 6800.0 and distance == pytest.approx(way, rel=1e-9)


def test_a_live_picture_stands_on_its_track() -> None:
    with LiveMachine(motionfmu.load(ROOT / "scenarios/robot_track")) as machine:
        shown = scene(machine)
        assert shown is not None and shown["base"] == ["soft.base_place", 1e3]
    with LiveMachine(motionfmu.load(ROOT / "scenarios/robot_line")) as machine:
        shown = scene(machine)
        assert shown is not None and shown["base"] == ["soft.base_place", 1e3]


def test_a_job_for_a_track_needs_one() -> None:
    scenario = motionfmu.load(ROOT / "scenarios/robot_track")
    with pytest.raises(motionfmu.InputError, match=r"line 20: base or station axes, which the arm"):
        scenario.run(set={"soft.external": 0})
    with pytest.raises(motionfmu.InputError, match=r'which the arm has not "BC00000"'):
        scenario.run(set={"soft.external": 2})


def test_a_dry_run_holds_the_carried_arm_against_its_cell(tmp_path: Path) -> None:
    """A post of 10 mm ends 150 mm below where the pen stands while the track passes."""
    (tmp_path / "cell.toml").write_text(
        '[[body]]\nname = "post"\nbar = [[1000, 1700, 0], [1000, 1700, 440]]\nradius = 10\n'
    )
    cell = read_cell(tmp_path / "cell.toml")
    run = dry_run(motionfmu.load(ROOT / "scenarios/robot_track"), cell=cell)
    assert not run.fault and run.time == pytest.approx(13.0, abs=0.1)
    radius = ArmParts.of(run.settings).radii[-1]
    near = {(a.line, a.first): a.distance for a in run.approaches if a.second == "post"}
    assert near[22, "tool"] == pytest.approx(150.0 - radius, abs=0.5)
    assert near[24, "tool"] == pytest.approx(150.0 - radius, abs=1e-6)
