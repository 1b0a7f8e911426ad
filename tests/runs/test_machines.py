"""Machines as files: what a scenario takes from one, takes away and adds; programs on them."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT
from refusals import refusal

import motionfmu
from motionfmu.scenarios import package_files
from motionfmu.scenarios.machine_limits import AxisLimit

MACHINES = ROOT / "src/motionfmu/machines"
# The program that stands beside each machine that takes one.
EXAMPLES = [file for file in MACHINES.glob("*/example.*") if file.suffix != ".points"]
PROGRAMS = {file.parent.name: file for file in EXAMPLES}
WITHOUT = {n for n in package_files.machines() if not motionfmu.machine(n).takes_programs}


def scenario_at(folder: Path, text: str) -> Path:
    """A scenario's folder with this text behind its first line."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scenario.toml").write_text("# About.\n" + text)
    return folder


def machine_at(folder: Path, text: str) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "machine.toml").write_text("# A machine.\n" + text)
    return folder


def test_every_machine_that_takes_a_program_has_one_to_try() -> None:
    assert set(package_files.machines()) == {*PROGRAMS, *WITHOUT} and len(WITHOUT) <= 2
    assert all((place / "README.md").is_file() for place in package_files.machines().values())


@pytest.mark.parametrize("name", sorted(PROGRAMS))
def test_a_program_runs_on_a_machine_without_a_scenario(name: str) -> None:
    result = motionfmu.machine(name).run(PROGRAMS[name])
    assert result.ok and result.checks
    if result.done_at is None:  # a card says when its job begins, and how long that takes
        return
    # It ends with its program, and settles for the time that says so.
    assert "done at" in result.stopped
    row = result.time[1] - result.time[0]
    assert -1e-9 <= result.done_at + 0.1 - result.time[-1] < row


def test_a_program_that_is_given_up_ends_its_run_at_rest(tmp_path: Path) -> None:
    """A point out of reach, and a limit switch in the way: no run goes on to its limit of 600 s."""
    (tmp_path / "a.job").write_text("MOVJ P000 VJ=50\nMOVL P001 V=500\nMOVL P002 V=500\nEND\n")
    (tmp_path / "a.points").write_text(
        "P000 J1=0 J2=-10 J3=10 J4=0 J5=90 J6=0\nP001 X=900 Y=100 Z=500 A=180 B=0 C=180\n"
        "P002 X=2500 Y=0 Z=500 A=180 B=0 C=180\n"
    )
    (tmp_path / "a.ngc").write_text("G21 G17 G90\nG1 X240 F12000\nG1 X0\nM2\n")
    robot = motionfmu.machine("robot6").scenario(tmp_path / "a.job").run(every=1)
    short = {"machine.upper_limit_position": [0.1, 0.2, 0.005, 0.5, 0.5, 0.5]}
    mill = motionfmu.machine("mill3").scenario(tmp_path / "a.ngc", set=short).run(every=1)
    for result, name, way in ((robot, "soft", "joint_command"), (mill, "mcc", "position")):
        assert not result.ok and result.done_at is None
        end = float(result.stopped.removeprefix(f"{name}.failed at ").removesuffix(" s"))
        row = result.time[1] - result.time[0]
        assert end + 0.1 - result.time[-1] == pytest.approx(row, abs=1.01 * row)
        moved = result[f"{name}.{way}"]
        error = int(np.argmax(result[f"{name}.error"] != 0))
        last = np.flatnonzero(np.any(moved != moved[-1], axis=1)).max()
        assert error < last, "what moves comes to rest first"
        assert 0.0 <= end - result.time[last] < 0.01


@pytest.mark.parametrize("name", ["xy_table", "mill3"])
def test_a_drive_that_trips_is_a_fault(name: str, tmp_path: Path) -> None:
    program = tmp_path / "way.ngc"
    program.write_text("G21 G90 G1 F600 X30\nM2\n")
    result = motionfmu.machine(name).run(program, set={"drives.torque_limit": 0.1}, stop=1.6)
    (alarm,) = (verdict for verdict in result.checks if verdict.name == "drives.alarm")
    assert alarm.ok is False and alarm.value == 3  # overload


def test_a_drawing_in_svg_runs_on_a_card_and_on_a_mill() -> None:
    badge = MACHINES / "engraver/badge.svg"
    for name, most in (("engraver", 3e-5), ("mill3", 3e-5)):
        feed = {"mcc.feed": 3000} if name == "mill3" else {}
        result = motionfmu.machine(name).run(badge, set=feed)
        assert result.ok and result.warnings == ()
        place = result["machine.table_position"][:, :2].max(axis=0)
        assert place == pytest.approx([0.058, 0.038], abs=most)


def test_a_program_on_a_machine_is_the_scenario_of_both() -> None:
    scenario = motionfmu.load(ROOT / "scenarios/square")
    program = ROOT / "scenarios/square/square.ngc"
    here = motionfmu.machine("xy_table").scenario(program).run(stop=0.5)
    there = scenario.run(stop=0.5)
    assert here.signals.keys() == there.signals.keys()
    assert all(np.array_equal(here[name], there[name]) for name in here.signals)


@pytest.mark.parametrize("name", sorted(WITHOUT))
def test_a_machine_that_takes_no_program_says_so(name: str, tmp_path: Path) -> None:
    (tmp_path / "a.ngc").write_text("M2\n")
    told = refusal(motionfmu.machine(name).scenario, tmp_path / "a.ngc")
    where = MACHINES / name / "machine.toml"
    assert told == [f"{where}: [signals] program and done are missing: it takes no program"]


def test_a_file_of_the_program_s_name_beside_it_is_taken(tmp_path: Path) -> None:
    for name in ("line.job", "line.points"):
        (tmp_path / name).write_bytes((ROOT / "scenarios/robot_line" / name).read_bytes())
    scenario = motionfmu.machine("robot6").scenario(tmp_path / "line.job")
    assert scenario.document.body.set["soft.points"] == str(tmp_path / "line.points")
    other = {"soft.points": str(ROOT / "scenarios/robot_pick/points.txt")}
    scenario = motionfmu.machine("robot6").scenario(tmp_path / "line.job", set=other)
    assert scenario.document.body.set["soft.points"] == other["soft.points"]
    (tmp_path / "line.points").unlink()
    scenario = motionfmu.machine("robot6").scenario(tmp_path / "line.job")
    assert "soft.points" not in scenario.document.body.set
    machine_at(tmp_path / "m", 'extends = "robot6"\n[signals]\nbeside = { "soft.points" = "p" }\n')
    (told,) = refusal(motionfmu.machine(tmp_path / "m").plan)
    assert told.startswith(f"{tmp_path}/m/machine.toml:4: signals.beside.soft.points = 'p'")


def test_what_is_inherited_can_be_taken_away(tmp_path: Path) -> None:
    text = (
        'machine = "xy_table"\nstop = 1.0\nwithout = ["check.mcc.starved", "contour", '
        '"record.signals.card.dac", "leave.card.reg_*", "set.mcc.p_gain"]\n'
    )
    body = motionfmu.load(
        scenario_at(tmp_path / "a", text + 'leave = ["card.reg_*"]\n')
    ).document.body
    assert body.contour is None and "mcc.p_gain" not in body.set
    assert "mcc.starved" not in body.check and "mcc.error" in body.check
    assert "card.dac" not in body.record.signals and "drives.torque" in body.record.signals
    assert body.leave[-1] == "card.reg_*"  # it is the scenario's own now
    told = refusal(motionfmu.load, scenario_at(tmp_path / "b", text))
    assert len(told) == 1 and "card.reg_" in told[0] and "are open" in told[0]


@pytest.mark.parametrize(
    ("without", "what"),
    [
        ('["check.mcc.strved"]', "did you mean 'mcc.starved'?"),
        ('["chek"]', "did you mean 'check'?"),
        ('["figure"]', "nothing that is inherited has this name"),
        ('["record.signals.none"]', "nothing that is inherited has this name"),
        ('"check"', "a list of names wanted"),
        ("[1]", "a list of names wanted"),
    ],
)
def test_what_is_not_there_cannot_be_taken_away(tmp_path: Path, without: str, what: str) -> None:
    text = f'machine = "xy_table"\nstop = 1.0\nwithout = {without}\n'
    (told,) = refusal(motionfmu.load, scenario_at(tmp_path / "a", text))
    assert told.startswith(f"{tmp_path}/a/scenario.toml:4: without ") and what in told


FIGURE = '[[figure]]\ntitle = "{0}"\n[[figure.plot]]\nsignals = ["{1}"]\nlabel = "{0}"\n'


def test_figures_are_added_and_taken_away_by_their_title(tmp_path: Path) -> None:
    own = FIGURE.format("one", "mcc.queue") + FIGURE.format("two", "card.stock")
    machine_at(tmp_path / "m", 'extends = "xy_table"\n' + own)
    text = 'machine = "../m"\nstop = 1.0\n'
    three = FIGURE.format("three", "mcc.path_feed")
    both = motionfmu.load(scenario_at(tmp_path / "a", text + three)).document
    assert [f.title for f in both.body.figure] == ["one", "two", "three"]
    less = scenario_at(tmp_path / "b", text + 'without = ["figure.one"]\n' + three)
    assert [f.title for f in motionfmu.load(less).document.body.figure] == ["two", "three"]
    # a wrong row is told with the file and line in which it stands
    wrong = scenario_at(tmp_path / "c", text + 'without = ["figure.one"]\n' + three + "scal = 1\n")
    (told,) = refusal(motionfmu.load, wrong)
    assert told.startswith(f"{wrong}/scenario.toml:10: unknown key 'scal'")
    machine_at(tmp_path / "m", 'extends = "xy_table"\n' + own.replace("card.stock", "card.stok"))
    (told,) = refusal(motionfmu.load, less)
    assert told.startswith(f"{tmp_path}/m/machine.toml:11: ") and "did you mean 'stock'?" in told


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ('[[contrary]]\noff = "x"\n', "contrary is a scenario's, no machine's"),
        ("stop = 1.0\n", "stop is a scenario's, no machine's"),
        ('machine = "mill3"\n', "machine is a scenario's, no machine's"),
        ('extends = "none"\n', "extends = 'none': no such machine"),
        ('extends = "../m"\n', "extends goes in a circle: m -> m"),
    ],
)
def test_a_wrong_machine(tmp_path: Path, text: str, what: str) -> None:
    machine_at(tmp_path / "m", text)
    (told,) = refusal(motionfmu.load, scenario_at(tmp_path / "a", 'machine = "../m"\nstop = 1.0\n'))
    assert told == f"{tmp_path}/m/machine.toml:2: {what}"


def test_a_machine_that_is_not_there(tmp_path: Path) -> None:
    place = scenario_at(tmp_path / "a", 'machine = "mil3"\nstop = 1.0\n')
    (told,) = refusal(motionfmu.load, place)
    assert (
        told == f"{place}/scenario.toml:2: machine = 'mil3': no such machine; did you mean 'mill3'?"
    )
    assert refusal(motionfmu.machine, 3) == ["3: the path or name of a machine wanted"]
    (told,) = refusal(motionfmu.machine("mill3").scenario, tmp_path / "none.ngc")
    assert told == f"{tmp_path}/none.ngc: no such program"


def test_the_command_runs_a_program_and_lists_machines(tmp_path: Path) -> None:
    shutil.copy(ROOT / "scenarios/square/square.ngc", tmp_path)
    machine_at(tmp_path / "machines/mine", 'extends = "xy_table"\nwithout = ["check"]\n')

    def call(*words: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "motionfmu", *words]
        return subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)

    told = call("machines").stdout
    assert all(name in told for name in (*PROGRAMS, *WITHOUT, "mine  "))
    ran = call("run", "square.ngc", "--machine", "xy_table")
    assert ran.returncode == 0 and "square: all 5 checks hold" in ran.stdout
    kept = json.loads((tmp_path / "results/square/result.json").read_text())
    assert kept["ok"]
    # of which nothing is asked has no verdict
    ran = call("run", "square.ngc", "--machine", "mine", "--stop", "0.1")
    assert ran.returncode == 0 and "square: no checks: nothing was judged" in ran.stdout
    assert "hold" not in ran.stdout and "found" not in ran.stdout


AXES = """
[[axis]]
name = "Z"
kind = "linear"
"""
SPEED = 'speed = { signal = "drives.speed", '


def own_machine(folder: Path, text: str) -> motionfmu.Machine:
    return motionfmu.machine(machine_at(folder, 'extends = "mill3"\n' + text))


def limits_of(name: str, **values: object) -> dict[tuple[str, str], AxisLimit]:
    """The limits of a machine of the library that has these values, by axis and figure."""
    tables = {"machine": name, "stop": 1.0}
    plan = motionfmu.scenario(tables)
    return {(x.axis.name, x.figure): x for x in plan.axis_limits(values)}


@pytest.mark.parametrize("name", sorted(package_files.machines()))
def test_every_machine_says_its_axes_and_what_limits_them(name: str) -> None:
    axes = motionfmu.machine(name).axes
    found = limits_of(name)
    assert axes and {a for a, _ in found} == {a.name for a in axes}
    for axis in axes:
        travel, speed = found[axis.name, "travel"], found.get((axis.name, "speed"))
        assert (travel.low is None) or travel.low < travel.high
        assert speed is None or speed.limit > 0
        assert travel.signal.port.shape in ((), (6,))


def test_a_limit_is_the_value_of_the_run_in_the_unit_of_the_signal() -> None:
    rows = limits_of("xy_table", **{"mcc.max_rpm": [900.0, 800.0, 1.0, 1.0, 1.0, 1.0]})
    assert (rows["X", "speed"].limit, rows["Y", "speed"].limit) == (900.0, 800.0)
    assert rows["X", "speed"].unit == "rpm" and rows["Y", "speed"].element == 1
    assert rows["X", "voltage"].limit == 10.0
    # [rpm] beside a motor speed in rad/s; axes that turn in degrees
    assert limits_of("first_order")["X", "speed"].limit == pytest.approx(3000 * 2 * np.pi / 60)
    arm = limits_of("robot6")
    assert arm["J2", "travel"].low == pytest.approx(-155)
    assert (arm["J6", "acceleration"].unit, arm["J6", "acceleration"].derivative) == ("deg/s2", 1)
    assert arm["J6", "acceleration"].limit == pytest.approx(1500)
    # the library watches the following error only where its limit is not 0
    assert rows["X", "following_error"].limit is None
    watched = limits_of("xy_table", **{"mcc.track_error_limit": 500})
    assert watched["Y", "following_error"].limit == 500


def test_signals_of_limits_are_recorded_unasked(tmp_path: Path) -> None:
    line = (
        'lag = { signal = "machine.screw_force", limit = [5, 6, 7], continuous = 2.5,'
        " overload = [1, 2, 3] }\n"
    )
    made = own_machine(tmp_path / "m", "[limits]\n" + line)
    (tmp_path / "a.ngc").write_text("M2\n")
    plan = made.scenario(tmp_path / "a.ngc")
    assert "machine.screw_force" in {e.name for e in plan.ends}
    rows = [x for x in plan.axis_limits() if x.figure == "lag"]
    assert [(x.axis.name, x.limit, x.continuous, x.overload) for x in rows] == [
        ("X", 5.0, 2.5, 1.0),
        ("Y", 6.0, 2.5, 2.0),
        ("Z", 7.0, 2.5, 3.0),
    ]
    # an axis that the machine has and a scenario does not use is taken away by its name
    lone = motionfmu.load(ROOT / "scenarios/compensation")
    assert [a.name for a in lone.document.axes] == ["X"]
    # a scenario that moves other rows says so
    brake = motionfmu.load(ROOT / "scenarios/holding_brake")
    rows = [x for x in brake.axis_limits() if x.figure == "torque"]
    assert [(x.axis.name, x.element) for x in rows] == [("Z", 2), ("U", 3)]


@pytest.mark.parametrize(
    ("text", "line", "what"),
    [
        (AXES, 5, "name = 'Z': axis Z has it, too"),
        (AXES.replace("Z", "W") + "row = 1\n", 7, "row = 1: axis X has it, too"),
        (AXES.replace("Z", "W") + "row = 7\n", 7, "machine.table_position has 6 elements: axis W"),
        (AXES.replace("linear", "round"), 6, "kind = 'round': input should be 'linear' or"),
        (AXES.replace("Z", "1"), 5, "name = '1': string should match pattern"),
        (AXES.replace("Z", "W") + "raw = 4\n", 7, "unknown key 'raw'; did you mean 'row'?"),
        ("[limits]\nspeed = 3\n", 4, "limits.speed = 3: input should be a valid"),
        ("[limits]\nSpeed = {}\n", 4, "string should match pattern"),
        (f"[limits]\n{SPEED} limt = 3 }}\n", 4, "unknown key 'limt'; did you mean 'limit'?"),
        (f"[limits]\n{SPEED} limit = true }}\n", 4, "limits.speed.limit = True: a number, a list"),
        (f"[limits]\n{SPEED} overload = 0 }}\n", 4, "a time above 0, or a list of one for each"),
        (f"[limits]\n{SPEED} overload = 'mcc.feed' }}\n", 4, "a time above 0, or a list of one"),
        (f"[limits]\n{SPEED} overload = [1, 2] }}\n", 4, "overload = [1.0, 2.0]: a number for"),
        (f"[limits]\n{SPEED} limit = [1, 2] }}\n", 4, "limit = [1.0, 2.0]: a number for each of 3"),
        (f"[limits]\n{SPEED} limit = 'mcc.feed' }}\n", 4, "mcc.feed [mm/min] limits speed [rpm]"),
        (f"[limits]\n{SPEED} low = 'mcc.fed' }}\n", 4, "no variable 'fed'; did you mean 'feed'?"),
        (f"[limits]\n{SPEED} low = 'mcc.queue' }}\n", 4, "mcc.queue is no parameter (output)"),
        (
            f"[limits]\n{SPEED} when = 'mcc.program' }}\n",
            4,
            "mcc.program is String: a number wanted",
        ),
        ("[limits]\nspeed = { signal = 'mcc.feed' }\n", 4, "mcc.feed is no output (parameter)"),
        (
            "[limits]\nspeed = { signal = 'mcc.path_feed' }\n",
            4,
            "is a single value: an element for",
        ),
        (
            "[limits.speed]\nderivative = 4\n",
            4,
            "limits.speed.derivative = 4: input should be less",
        ),
        ('without = ["axis"]\n', 0, "limits of which axes? [[axis]] is missing"),
    ],
)
def test_wrong_axes_and_limits(tmp_path: Path, text: str, line: int, what: str) -> None:
    (tmp_path / "a.ngc").write_text("M2\n")
    told = refusal(lambda: own_machine(tmp_path / "m", text).scenario(tmp_path / "a.ngc"))
    where = f"{tmp_path}/m/machine.toml:{line}: " if line else f"{MACHINES}/"
    assert any(t.startswith(where) and what in t for t in told), told


def test_a_gantry_is_out_of_square_by_what_its_two_drives_lag_apart(tmp_path: Path) -> None:
    (tmp_path / "beam.ngc").write_text("G1 Y60 F6000\nM2\n")
    machine = motionfmu.machine("gantry")

    def apart(**gains: float) -> np.ndarray:
        place = machine.run(tmp_path / "beam.ngc", set=gains)["machine.table_position"]
        return place[:, 1] - place[:, 3]  # [m]

    assert np.abs(apart()).max() < 15e-6
    # both ends at v = 100 mm/s lag v / Kp behind
    found = apart(**{"drives.position_gain[4]": 45.0}).max()
    assert found == pytest.approx(0.1 / 45 - 0.1 / 47.7, rel=0.05)


def test_the_head_of_the_mill_hangs_on_its_drive_and_on_its_brake(tmp_path: Path) -> None:
    (tmp_path / "still.ngc").write_text("G4 P0.3\nM2\n")
    mill = motionfmu.machine("mill3")
    torque = mill.run(tmp_path / "still.ngc")["drives.torque"][-1, 2]
    weight, friction = 883 * 0.01 / (2 * np.pi), 0.2 + 70 * 0.01 / (2 * np.pi)
    assert abs(torque - weight) < friction  # [N·m]
    # The emergency stop takes the torque: with the brake it stays, without it falls.
    off = [{"input": "drives.enable", "at": [0.3], "value": [False]}]
    fallen = {}
    for brake in (7.8, 0.0):
        plan = mill.scenario(tmp_path / "still.ngc", drive=off, set={"drives.brake_torque": brake})
        place = plan.run(stop=0.6)["machine.table_position"][:, 2]
        fallen[brake] = place[3000] - place[-1]
    assert fallen[7.8] < 2e-6 and fallen[0.0] > 0.05
