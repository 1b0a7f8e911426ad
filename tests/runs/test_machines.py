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

MACHINES = ROOT / "src/motionfmu/machines"
# A program for each machine of the library that takes one, and what it needs beside it.
PROGRAMS = {
    "first_order": ("circle_theory/circle.ngc", {}),
    "mill3": ("pocket/plate.ngc", {"mcc.tool_table": "pocket/tools.tbl"}),
    "robot6": ("robot_line/line.job", {"soft.points": "robot_line/line.points"}),
    "xy_table": ("square/square.ngc", {}),
}
# These play what a network card or a field bus gives them.
WITHOUT = {
    "engraver",
    "hydraulic_slide",
    "fifo_card",
    "lone_card",
    "networked_card",
    "pulse_robot",
    "single_buffer",
}


def scenario_at(folder: Path, text: str) -> Path:
    """A scenario's folder with this text behind its first line."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scenario.toml").write_text("# About.\n" + text)
    return folder


def machine_at(folder: Path, text: str) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "machine.toml").write_text("# A machine.\n" + text)
    return folder


def test_the_library_is_what_is_tried_here() -> None:
    assert set(package_files.machines()) == {*PROGRAMS, *WITHOUT}
    assert all((place / "README.md").is_file() for place in package_files.machines().values())


@pytest.mark.parametrize("name", sorted(PROGRAMS))
def test_a_program_runs_on_a_machine_without_a_scenario(name: str) -> None:
    program, beside = PROGRAMS[name]
    values = {key: str(ROOT / "scenarios" / file) for key, file in beside.items()}
    result = motionfmu.machine(name).run(ROOT / "scenarios" / program, set=values)
    assert result.ok and result.checks and result.done_at and "done at" in result.stopped
    # It ends with its program, and settles for the time that says so.
    row = result.time[1] - result.time[0]
    assert -1e-9 <= result.done_at + 0.1 - result.time[-1] < row


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
    assert ran.returncode == 0 and "square: all 4 checks hold" in ran.stdout
    kept = json.loads((tmp_path / "results/square/result.json").read_text())
    assert kept["ok"]
    # of which nothing is asked has no verdict
    ran = call("run", "square.ngc", "--machine", "mine", "--stop", "0.1")
    assert ran.returncode == 0 and "square: no checks: nothing was judged" in ran.stdout
    assert "hold" not in ran.stdout and "found" not in ran.stdout
