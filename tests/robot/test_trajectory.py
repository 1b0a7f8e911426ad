"""Joint trajectories of ROS as programs of a robot, and a run's joints as one."""

from pathlib import Path

import numpy as np
import pytest

import motionfmu
from motionfmu.base.errors import InputError
from motionfmu.report.result_folder import Kept, save
from motionfmu.run.joint_trajectory import read_trajectory, thinned, trajectory_text
from motionfmu.run.machine_program import Machine
from motionfmu.run.recorded_trajectory import recorded_trajectory, refuse_unrecorded

NAMES = [f"J{i}" for i in range(1, 7)]
SPEEDS = np.array([175.0, 175.0, 175.0, 300.0, 300.0, 375.0])  # [deg/s] of robot6
HOME = np.radians([0.0, -20.0, 10.0, 0.0, 90.0, 0.0])
WAY = np.radians([40.0, 20.0, -10.0, 30.0, -20.0, 60.0])

ROS1 = """header:
  seq: 0
joint_names: ['a', 'b']
points:
- positions: [0, 0.5]
  velocities: [0, 0]
  accelerations: [0, 0]
  time_from_start: {secs: 1, nsecs: 250000000}
- positions:
  - 1.0e-1
  - -0.5
  velocities: [0.1, 0]
  time_from_start:
    secs: 2
    nsecs: 0
"""
ROS2 = """trajectory:
  joint_trajectory:
    joint_names: [a, b]
    points:
    - {positions: [0, 0.5], velocities: [], time_from_start: {sec: 1, nanosec: 250000000}}
    - {positions: [0.1, -0.5], time_from_start: 2.0}
---
"""
COLUMNS = "time_from_start, a, b.velocity, b, a.velocity\n1.25,0,0,0.5,0\n\n2,0.1,0,-0.5,0.1\n"


def written(folder: Path, name: str, text: str) -> Path:
    file = folder / name
    file.write_text(text, encoding="utf-8")
    return file


def rows(time: np.ndarray, joints: np.ndarray, names: list[str] = NAMES) -> str:
    return trajectory_text(names, time, joints)


@pytest.mark.parametrize(
    ("name", "text", "lines", "velocity"),
    [
        ("t.yaml", ROS1, [5, 9], True),
        ("t.YML", ROS2, [5, 6], False),
        ("t.csv", COLUMNS, [2, 4], True),
    ],
)
def test_the_same_trajectory_in_each_form(
    tmp_path: Path, name: str, text: str, lines: list[int], velocity: bool
) -> None:
    found = read_trajectory(written(tmp_path, name, text))
    assert found.joints == ["a", "b"] and found.lines == lines
    np.testing.assert_allclose(found.time, [1.25, 2.0], atol=1e-12)
    np.testing.assert_array_equal(found.position, [[0.0, 0.5], [0.1, -0.5]])
    if velocity:
        assert found.velocity is not None
        np.testing.assert_array_equal(found.velocity, [[0.0, 0.0], [0.1, 0.0]])
    else:
        assert found.velocity is None


POINT = "joint_names: [a]\npoints:\n- {positions: [0], time_from_start: 0}\n"


@pytest.mark.parametrize(
    ("name", "text", "told"),
    [
        ("t.csv", "", "no header: time_from_start and the names of the joints wanted"),
        ("t.csv", "time,a\n0,0\n", "line 1: 'time': time_from_start [s] wanted first"),
        ("t.csv", "time_from_start,a,a\n", "line 1: 'a': a name for each column wanted"),
        ("t.csv", "time_from_start,a,c.velocity\n", "line 1: 'c.velocity': no such joint"),
        ("t.csv", "time_from_start,a,b,a.velocity\n", "line 1: 'b.velocity' is missing"),
        ("t.csv", "time_from_start,a\n0,0\n1\n", "line 3: 1 values, not 2"),
        ("t.csv", "time_from_start,a\n0,x\n", "line 2: a = 'x': a number wanted"),
        ("t.csv", "time_from_start,a\n0,nan\n", "line 2: a = 'nan': a number wanted"),
        ("t.csv", "time_from_start,a\n-1,0\n", "line 2: time_from_start = -1: 0 or more wanted"),
        ("t.csv", "time_from_start,a\n1,0\n1,0\n", "line 3: time_from_start = 1: more than 1"),
        ("t.csv", "time_from_start,a\n", "no points"),
        ("t.yaml", "", "empty"),
        ("t.yaml", "a: [1\nb: 2\n", "line 2: no YAML: "),
        ("t.yaml", "points: []\n", "line 1: joint_names is missing"),
        ("t.yaml", "joint_names: [a]\npoints: 3\n", "line 2: points: a list wanted"),
        ("t.yaml", "joint_names: [a]\npoints: [3]\n", "line 2: names with values wanted"),
        ("t.yaml", POINT + "---\n" + POINT, "line 5: a second message"),
        ("t.yaml", POINT.replace("[0]", "[0, 1]"), "line 3: positions: 2 values, not 1"),
        ("t.yaml", POINT.replace("[0]", "[x]"), "line 3: positions = 'x': a number wanted"),
        ("t.yaml", POINT.replace("start: 0", "start: {s: 1}"), "line 3: time_from_start: secs"),
        ("t.yaml", POINT + "- {positions: [1], velocities: [0], time_from_start: 1}\n",
         "line 1: velocities of all points or of none wanted"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_told_with_its_line(
    tmp_path: Path, name: str, text: str, told: str
) -> None:
    file = written(tmp_path, name, text)
    with pytest.raises(InputError) as wrong:
        read_trajectory(file)
    assert str(wrong.value).startswith(f"{file}: {told}")


def test_points_left_out_are_on_the_lines_between_the_others() -> None:
    time = np.linspace(0.0, 2.0, 501)
    joints = np.column_stack([np.sin(3.0 * time), np.where(time < 1.0, 0.0, time - 1.0)])
    kept = thinned(time, joints, 1e-3)
    # A sine of 3 rad/s leaves a chord of h by 9 h^2 / 8: 67 chords, halved once at most.
    assert len(kept) < 2 * 67
    for i in range(2):
        between = np.interp(time, time[kept], joints[kept, i])
        assert np.abs(between - joints[:, i]).max() <= 1e-3
    assert list(thinned(time[:2], joints[:2], 1e-3)) == [0, 1]
    assert len(thinned(time, np.zeros((501, 1)), 0.0)) == 2


def job(folder: Path, text: str, **values: object) -> str:
    file = written(folder, "t.csv", text)
    given = {f"soft.{name}": value for name, value in values.items()}
    return Machine("robot6").translated(file, {}, given).file.read_text(encoding="utf-8")


def test_speeds_are_those_that_take_the_time(tmp_path: Path) -> None:
    joints = np.degrees(HOME) + np.array(
        [[0] * 6, [17.5, 0, 0, 0, 0, -15], [17.5, 0, 0, 0, 0, -15]]
    )
    text = rows(np.array([0.5, 1.0, 3.0]), np.radians(joints))
    made = job(tmp_path, text).splitlines()
    assert made[-4:] == [
        "MOVJ C00000", "MOVJ C00001 VJ=20.000000 PL=1", "TIMER T=2.000000000", "END"
    ]  # fmt: skip
    slow = job(tmp_path, text, joint_speed=[50.0, *SPEEDS[1:]]).splitlines()
    assert slow[-3] == "MOVJ C00001 VJ=70.000000 PL=1"
    with pytest.raises(InputError, match=r"t.csv: line 3: point 1: J1 at 35 °/s, its limit is 30"):
        job(tmp_path, text, joint_speed=30.0)


def test_joints_by_name_or_as_they_stand(tmp_path: Path) -> None:
    joints = np.arange(12.0).reshape(2, 6) * 1e-3
    order = [3, 0, 1, 2, 5, 4]
    text = rows(np.array([0.0, 1.0]), joints[:, order], [NAMES[i] for i in order])
    assert job(tmp_path, text) == job(tmp_path, rows(np.array([0.0, 1.0]), joints))
    file = written(tmp_path, "other.csv", rows(np.array([0.0, 1.0]), joints, list("abcdef")))
    made = Machine("robot6").translated(file, {})
    assert made.notes[0] == (
        "joints as they stand: a is J1, b is J2, c is J3, d is J4, e is J5, f is J6"
    )
    for names, told in (
        ([*NAMES[:5], "x"], "joint 'x': J1, J2, J3, J4, J5, J6 wanted, or other names"),
        (["a", "b"], "2 joints (a, b), the machine has 6: J1, J2, J3, J4, J5, J6"),
    ):
        wrong = rows(np.array([0.0, 1.0]), joints[:, : len(names)], names)
        with pytest.raises(InputError) as refused:
            job(tmp_path, wrong)
        assert str(refused.value) == f"{tmp_path / 't.csv'}: {told}"


def test_a_run_without_joints_has_no_trajectory() -> None:
    scenario = motionfmu.load("circle")
    with pytest.raises(InputError, match="no commanded joints"):
        refuse_unrecorded(scenario)


@pytest.mark.more
def test_a_trajectory_is_run_and_its_run_is_one_again(tmp_path: Path) -> None:
    time = np.linspace(0.0, 2.0, 21)
    share = (time / 2.0) ** 3 * (10.0 - 15.0 * time / 2.0 + 6.0 * (time / 2.0) ** 2)
    way = HOME + share[:, np.newaxis] * WAY
    file = written(tmp_path, "way.csv", rows(time, way))
    result = Machine("robot6").run(file)
    assert result.ok, result.warnings
    q = result["soft.joint_command"]
    # Every point is passed within the corner of PL=1, half a millimetre of a metre or so.
    off = [np.abs(q - point).max(axis=1).min() for point in way]
    assert max(off) < 1.5e-3 and off[-1] < 1e-9
    begin = int(np.flatnonzero(np.abs(q - way[0]).max(axis=1) < 1e-6)[0])
    end = int(np.flatnonzero(np.abs(q - way[-1]).max(axis=1) > 1e-9)[-1])
    # No part is faster than its mean speed, and each change of speed is in the faster part.
    assert 2.0 <= result.time[end] - result.time[begin] < 1.2 * 2.0
    shown = save(result, tmp_path / "out", Kept(signals=False, trajectory=True))
    text = (shown.parent / "trajectory.csv").read_text(encoding="utf-8")
    assert text == recorded_trajectory(result)
    again = read_trajectory(shown.parent / "trajectory.csv")
    assert again.joints == NAMES
    for i in range(6):
        between = np.interp(result.time, again.time, again.position[:, i])
        assert np.abs(between - q[:, i]).max() <= 1e-4 + 1e-9
    second = Machine("robot6").run(shown.parent / "trajectory.csv")
    assert second.ok, second.warnings
    np.testing.assert_allclose(second["soft.joint_command"][-1], q[-1], atol=1e-8)
    assert second.done_at == pytest.approx(result.done_at, abs=0.25)


@pytest.mark.more
def test_a_joint_out_of_its_range_is_told_by_the_line_of_its_point(tmp_path: Path) -> None:
    way = np.vstack([HOME, HOME + np.radians([0, 0, 0, 0, 40.0, 0])])
    file = written(tmp_path, "far.csv", rows(np.array([0.0, 1.0]), way))
    result = Machine("robot6").run(file)
    told = [w for w in result.warnings if "outside" in w or "joint 5" in w]
    assert not result.ok and told and f"{file}: line 3" in told[0]
