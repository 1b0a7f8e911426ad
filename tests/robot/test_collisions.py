"""Distances of an arm from itself and its cell against coal, kinematics, dense points; verdicts."""

from pathlib import Path
from typing import Any

import coal
import numpy as np
import pytest
from conftest import ROOT
from public_arms import Array, universal
from robot_settings import settings
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner

import motionfmu
from motionfmu import InputError
from motionfmu.analysis.collisions import ArmParts, Cell, CellBody, clearance, read_cell
from motionfmu.analysis.collisions.arm_parts import NAMES
from motionfmu.analysis.collisions.clearance import FLOOR, distances
from motionfmu.analysis.collisions.distances import between_segments, from_box
from motionfmu.analysis.dry_run import dry_run
from motionfmu.cli import app
from motionfmu.virtual.robot import Kinematics, RobotError, VirtualRobot

POSES = 1000
CELL = """
clearance = 10
floor = -200

[radius]
"link 2" = 90
tool = 20

[[body]]
name = "table"
box = [600, 900, 300]
at = [1100, 0, 150, 0, 0, 30]

[[body]]
name = "post"
bar = [[0, 800, 0], [300, 900, 2000]]
radius = 60
"""


def axes_of_ur5e() -> dict[str, Any]:
    arm = universal((0.1625, 0.1333, 0.0997, 0.0996), (-0.425, -0.3922))
    origins, axes, place, turn = arm.straight()
    pose = [*(1e3 * place), *Rotation.from_matrix(turn).as_euler("xyz", degrees=True)]
    more = {"axis_origin": origins.ravel(), "axis_direction": axes.ravel(), "flange": pose}
    ranges = {"joint_low": [-360.0] * 6, "joint_high": [360.0] * 6}
    return {"arm_by": 1, "joint_acc": 100.0, "joint_speed": 50.0, **more, **ranges}


@pytest.mark.parametrize("kind", ["lengths", "signs", "axes"])
def test_parts_end_where_kinematics_have_the_flange(kind: str) -> None:
    more = {
        "lengths": {},
        "signs": {
            "b": 0.05,
            "joint_sign": [1, -1, 1, -1, 1, -1],
            "joint_offset": [10.0, -20.0, 30.0, 5.0, 7.0, -50.0],
        },
        "axes": axes_of_ur5e(),
    }[kind]
    rng = np.random.default_rng(1)
    joints = rng.uniform(-70.0, 70.0, (POSES, 6))
    want = Kinematics(**more).forward(joints)[:, :3, 3]
    points = ArmParts.of(settings(**more)).points(joints, want)
    assert points[:, 7] == pytest.approx(want, abs=1e-9)
    # Bars keep their lengths, and each joint leaves what is before it where it was.
    lengths = np.linalg.norm(np.diff(points, axis=1), axis=2)
    assert np.ptp(lengths, axis=0).max() < 1e-9
    turned = ArmParts.of(settings(**more)).points(joints + np.eye(6)[3] * 20.0, want)
    assert turned[:, :5] == pytest.approx(points[:, :5], abs=1e-9)


def placed_bar(ends: Array, radius: float) -> tuple[Any, Any]:
    """A capsule of coal, along z about its middle."""
    way = ends[1] - ends[0]
    length = float(np.linalg.norm(way))
    turn = np.eye(3)
    if length > 1e-9:
        turn = Rotation.align_vectors([way / length], [[0, 0, 1]])[0].as_matrix()
    return coal.Capsule(radius, length), coal.Transform3s(turn, ends.mean(axis=0))


def by_coal(a: tuple[Any, Any], b: tuple[Any, Any]) -> float:
    result = coal.DistanceResult()
    return float(coal.distance(a[0], a[1], b[0], b[1], coal.DistanceRequest(True), result))


@pytest.mark.more
def test_a_thousand_poses_are_as_far_from_everything_as_coal_says(tmp_path: Path) -> None:
    """Each pair of parts, each body, the floor; where two are inside each other both say so."""
    (tmp_path / "cell.toml").write_text(CELL)
    cell = read_cell(tmp_path / "cell.toml")
    tool = {"tool": [30.0, 0.0, 150.0, 0.0, 20.0, 0.0]}
    parts = ArmParts.of(settings(**tool), cell.radii)
    assert parts.radii[[2, 7]].tolist() == [90.0, 20.0]
    rng = np.random.default_rng(2)
    low, high = (np.asarray(settings()[n]) for n in ("joint_low", "joint_high"))
    joints = rng.uniform(low, high, (POSES, 6))
    tip = Kinematics(**tool).forward(joints)[:, :3, 3]
    points = parts.points(joints, tip)
    table, post = cell.bodies
    bodies = {
        "table": (coal.Box(600, 900, 300), coal.Transform3s(table.turn, table.center)),
        "post": placed_bar(np.asarray(post.bar), post.radius),
        FLOOR: (coal.Halfspace(np.array([0.0, 0.0, 1.0]), -200.0), coal.Transform3s()),
    }
    seen = {"apart": 0, "inside": 0}
    for first, second, ours in distances(parts, cell, joints, tip):
        k = NAMES.index(first)
        for row in range(POSES):
            own = placed_bar(points[row, k : k + 2], parts.radii[k])
            if second in NAMES:
                m = NAMES.index(second)
                other = placed_bar(points[row, m : m + 2], parts.radii[m])
            else:
                other = bodies[second]
            theirs = by_coal(own, other)
            if ours[row] > 1e-3:
                assert theirs == pytest.approx(ours[row], abs=1e-3), (first, second, row)
                seen["apart"] += 1
            elif ours[row] < -1e-3:
                assert theirs < 1e-3, (first, second, row)
                seen["inside"] += 1
    assert seen["apart"] > 20 * POSES and seen["inside"] > POSES // 2


@pytest.mark.parametrize("piece", [37, 20_000])
def test_least_distances_stand_by_the_line_that_moves(monkeypatch, piece: int) -> None:
    """Row by row: lines of one row, lines that come again, and rows in which the arm rests."""
    monkeypatch.setattr(clearance, "_PIECE", piece)
    rng = np.random.default_rng(5)
    rows = [("time", "f8"), ("joint", "f8", 6), ("place", "f8", 3), ("base", "f8", 3)]
    samples = np.zeros(400, [*rows, ("line", "i8"), ("rate", "f8", 6)])
    samples["time"] = np.arange(400) * 1e-3
    samples["joint"] = np.cumsum(rng.normal(0.0, 1.0, (400, 6)), axis=0)
    samples["joint"][:, 4] += 90.0
    samples["place"] = Kinematics().forward(samples["joint"])[:, :3, 3]
    samples["line"] = np.repeat(rng.integers(1, 30, 400), rng.integers(1, 9, 400))[:400]
    samples["rate"] = rng.normal(0.0, 1.0, (400, 6)) * (rng.random((400, 1)) > 0.2)
    parts, cell = ArmParts.of(settings(), {}), Cell(floor=-50.0)
    least: dict[tuple[int, str, str], tuple[float, float]] = {}
    for k, row in enumerate(samples):
        line = int(row["line"]) if row["rate"].any() else 0
        if line or k == 0:
            for first, second, apart in distances(
                parts, cell, row["joint"][None], row["place"][None]
            ):
                now = float(apart[0]), float(row["time"])
                least[line, first, second] = min(least.get((line, first, second), now), now)
    found = clearance.approaches(samples, parts, cell)
    assert {(a.line, a.first, a.second): pytest.approx(a.distance, abs=1e-9) for a in found} == {
        key: distance for key, (distance, _) in least.items()
    }
    times = {(a.line, a.first, a.second): a.time for a in found if not a.near}
    assert len(times) > 100 and all(least[key][1] == time for key, time in times.items())


def test_segments_and_boxes_by_dense_points() -> None:
    """Also of no length, parallel, crossing, inside a box, along a face."""
    rng = np.random.default_rng(3)
    n, share = 400, np.linspace(0.0, 1.0, 401)
    ends = rng.integers(-3, 4, (4, n, 3)).astype(float) * rng.choice([0.0, 1.0, 1.0], (1, n, 3))
    a, b, half = (ends[0], ends[1]), (ends[2], ends[3]), np.array([1.0, 2.0, 0.5])
    on_a = a[0][:, None] + share[:, None] * (a[1] - a[0])[:, None]
    on_b = b[0][:, None] + share[:, None] * (b[1] - b[0])[:, None]
    step = np.linalg.norm(a[1] - a[0], axis=1) / 400 + np.linalg.norm(b[1] - b[0], axis=1) / 400
    lines, boxes = between_segments(a, b), from_box(a, half)
    for k in range(n):
        dense = np.linalg.norm(on_a[k][:, None] - on_b[k][None], axis=2).min()
        assert dense - step[k] - 1e-9 <= lines[k] <= dense + 1e-9
        outside = np.abs(on_a[k]) - half
        dense = np.linalg.norm(np.maximum(outside, 0.0), axis=1).min()
        assert dense - step[k] - 1e-9 <= boxes[k] <= dense + 1e-9
    assert (lines == 0.0).any() and (boxes == 0.0).any() and (boxes > 1.0).any()


def fold(folder: Path) -> Path:
    """A job that folds the arm onto its own base."""
    (folder / "fold.job").write_text("NOP\nMOVJ P000 VJ=50.00\nMOVJ P001 VJ=50.00\nEND\n")
    rows = ("P000 J1=0 J2=0 J3=0 J4=0 J5=60 J6=0", "P001 J1=0 J2=-155 J3=75 J4=0 J5=0 J6=0")
    (folder / "fold.points").write_text("\n".join([*rows, ""]))
    return folder / "fold.job"


def test_a_fold_onto_the_base_is_refused_with_its_links(tmp_path: Path) -> None:
    file = fold(tmp_path)
    run = dry_run(motionfmu.machine("robot6").scenario(file))
    assert not run.fault  # no joint leaves its range
    pairs = {(a.first, a.second) for a in run.collisions}
    assert ("base", "link 3") in pairs and {a.line for a in run.collisions} == {3}
    first = run.collisions[0]
    assert first.time == min(a.time for a in run.collisions)
    at = int(np.argmin(np.abs(run.samples["time"] - first.time)))
    assert first.joint == pytest.approx(run.samples["joint"][at])
    shown = CliRunner().invoke(app, ["job", str(file), "--machine", "robot6", "--json"])
    assert shown.exit_code == 1 and '"collisions": [' in shown.output
    page = ["job", str(file), "--machine", "robot6", "--out", str(tmp_path / "out")]
    shown = CliRunner().invoke(app, page)
    assert shown.exit_code == 1
    assert f"fold.job: line 3: base runs into link 3 at {first.time:.3f} s" in shown.output
    assert "base runs into link 3" in (tmp_path / "out/report.html").read_text()


def test_what_runs_is_not_refused_and_a_body_in_the_way_is(tmp_path: Path) -> None:
    """The pick and place touches nothing; a box put over a place of its own path is told."""
    scenario = motionfmu.load(ROOT / "scenarios/robot_pick")
    free = dry_run(scenario)
    tip = Kinematics(tool=[0.0, 0.0, 150.0, 0.0, 0.0, 0.0]).forward(free.samples["joint"][50::50])
    assert free.samples["place"][50::50] == pytest.approx(tip[:, :3, 3], abs=1e-6)
    assert free.faults == [] and min(a.distance for a in free.approaches) > 100.0
    line = free.moves[4]
    s = free.samples
    middle = s[int(np.searchsorted(s["time"], 0.5 * (line.begin + line.end)))]
    box = CellBody("box", np.full(3, 5.0), center=middle["place"].astype(float))
    hit = dry_run(scenario, cell=Cell((box,)))
    assert line.line in {a.line for a in hit.collisions}
    assert {a.second for a in hit.collisions} == {"box"}
    # A clearance is wanted beside that: twice the room to a body that nothing touches.
    aside = CellBody("aside", np.full(3, 5.0), center=middle["place"] - [0.0, 0.0, 2000.0])
    far = dry_run(scenario, cell=Cell((aside,)))
    room = min(a.distance for a in far.approaches if a.second == "aside")
    assert far.faults == [] and room > 0.0
    near = dry_run(scenario, cell=Cell((aside,), clearance=2.0 * room))
    told = [a for a in near.collisions if a.second == "aside"]
    assert min(a.distance for a in told) == pytest.approx(room)
    assert "comes within" in told[0].words and "of the aside" in told[0].words
    start = CellBody("start", np.full(3, 5.0), center=s["place"][0] + [0.0, 0.0, -20.0])
    told = dry_run(scenario, cell=Cell((start,))).collisions
    assert (told[0].line, told[0].second) == (0, "start") and told[0].time == s["time"][0]
    floor = float(min(s["place"][:, 2]))
    assert dry_run(scenario, cell=Cell(floor=floor + 1.0)).collisions[0].second == FLOOR


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("clearance = -1\n", "cell.toml:1: clearance = -1: "),
        ("floor = nan\n", "cell.toml:1: floor = nan: "),
        ("\n[radius]\n'link 7' = 3\n", "cell.toml:3: radius.link 7 = 'link 7': "),
        ("[radius]\ntool = 0\n", "cell.toml:2: radius.tool = 0: "),
        ("[[body]]\nname = 'a'\n", "cell.toml:1: body.0: a box or a bar is wanted"),
        ("[[body]]\nname = 'a'\nbox = [1, 2]\n", "cell.toml:3: body.0.box"),
        ("[[body]]\nname = 'a'\nbox = [1, 2, 0]\n", "cell.toml:1: body.0: lengths of a box"),
        ("[[body]]\nname = 'a'\nbar = [[0,0,0],[0,0,1]]\n", "bar and radius belong together"),
        ("[[body]]\nname = 'a'\nbox = [1, 1, 1]\nhight = 3\n", "cell.toml:4: body.0.hight = 3: "),
        ("[wall]\n", "cell.toml:1: wall: "),
    ],
)
def test_a_wrong_cell_is_told_with_its_line(tmp_path: Path, text: str, told: str) -> None:
    file = tmp_path / "cell.toml"
    file.write_text(text)
    with pytest.raises(InputError) as error:
        read_cell(file)
    assert told in str(error.value)
    assert len(str(error.value).splitlines()) == 1


def test_the_fold_is_refused_by_the_call_itself() -> None:
    """With a cell moves by calls are looked at: the message names the links, nothing has moved."""
    robot = VirtualRobot(cell=Cell())
    with pytest.raises(RobotError, match="move_joints: base runs into link 3 at ") as told:
        robot.move_joints([0, -155, 75, 0, 0, 0])
    assert told.value.status == "COLLISION"
    assert robot.read().move == 0
    assert robot.move_joints([30, 10, -10, 0, 60, 0]) == 1
    assert np.allclose(robot.run_until_stop().joint, [30, 10, -10, 0, 60, 0], atol=1e-2)
    assert VirtualRobot().move_joints([0, -155, 75, 0, 0, 0]) == 1  # nobody looks


def test_a_way_through_a_body_is_refused_though_both_ends_are_free() -> None:
    """A post between two poses, with and without a clearance; the moves before it count."""
    post = CellBody("post", bar=np.array([[1100.0, 0, 0], [1100, 0, 2000]]), radius=30.0)
    robot = VirtualRobot(cell=Cell((post,)))
    robot.move_joints([-40, 20, -20, 0, 80, 0])
    with pytest.raises(RobotError, match="the post"):
        robot.move_joints([40, 20, -20, 0, 80, 0])
    robot.move_joints([-40, -40, 20, 0, 80, 0])
    robot.move_joints([40, -40, 20, 0, 80, 0])
    assert robot.run_until_stop().error == 0


def test_a_guarded_robot_is_where_it_was_after_a_look_ahead() -> None:
    """A move that is free begins only then, and takes the time that it takes without a guard."""
    aside = Cell((CellBody("aside", np.full(3, 5.0), center=np.array([0.0, 0.0, -5000.0])),))
    found = []
    for cell in (None, aside):
        robot = VirtualRobot(cell=cell)
        robot.run(0.01)
        robot.move_joints([10.0, 0.0, 0.0, 0.0, 90.0, 0.0])
        begun, under_way = robot.read(), robot.run(0.2)
        assert begun.time == 0.01 and 0.0 < under_way.joint_command[0] < 10.0
        found.append(under_way.pulses)
    assert np.array_equal(*found)
