"""Commands that take a program and a machine; machines copied, programs kept as scenarios."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT
from console import within
from refusals import refusal

import motionfmu
from motionfmu.cli.common import loaded
from motionfmu.run.controller_plan import bounded
from motionfmu.run.machine_copy import copy_machine
from motionfmu.run.run_plan import Options
from motionfmu.run.saved_scenario import save_scenario
from motionfmu.scenarios import package_files

CIRCLE = "G0 X5\nG2 I-5 F3000\nG1 X0 F3000\nM2\n"


@pytest.fixture
def here(tmp_path: Path) -> Path:
    """A folder with a program that takes a second."""
    (tmp_path / "ring.ngc").write_text(CIRCLE)
    return tmp_path


@pytest.mark.parametrize("name", sorted(package_files.machines()))
def test_a_copied_machine_stands_alone_and_is_the_same(name: str, tmp_path: Path) -> None:
    like = motionfmu.machine(name)
    copy_machine(like, tmp_path / "mine")
    assert "extends" not in (tmp_path / "mine/machine.toml").read_text()
    sheet = (tmp_path / "mine/README.md").read_text()
    assert all(f"| {axis.name} " in sheet for axis in like.axes)
    mine, theirs = motionfmu.machine(tmp_path / "mine").plan(), like.plan()
    a, b = (plan.resolved(Options()) for plan in (mine, theirs))
    assert (a.components, a.wires, a.step_ns, a.every) == (
        b.components,
        b.wires,
        b.step_ns,
        b.every,
    )
    files = {"mcc.tool_table", "soft.points"}  # beside each machine
    values = [{s.end.name: s.values for s in x.settings if s.end.name not in files} for x in (a, b)]
    assert values[0] == values[1]
    assert [e.name for e in mine.ends] == [e.name for e in theirs.ends]
    assert mine.axis_limits() == theirs.axis_limits()
    assert mine.document.body.check == theirs.document.body.check
    assert mine.document.body.figure == theirs.document.body.figure


def test_new_machine_makes_one_whose_values_are_edited_in_one_file(here: Path) -> None:
    made = within("new", "machine", "mine", "--like", "xy_table", folder=here)
    assert made.returncode == 0 and "machines/mine" in made.stdout
    file = here / "machines/mine/machine.toml"
    text = file.read_text()
    line = next(x for x in text.split("\n") if "machine.table_mass" in x)
    assert line == '# "machine.table_mass" = 100.0  # [kg] Mass of the table with its load'
    file.write_text(text.replace(line, line.removeprefix("# ").replace("100.0", "40.0")))
    ran = within("run", "ring.ngc", "--machine", "mine", folder=here)
    assert ran.returncode == 0, ran.stderr
    again = within("new", "machine", "mine", "--like", "xy_table", folder=here)
    assert again.returncode == 2 and again.stderr == "motionfmu: machines/mine is there already\n"
    strange = within("new", "machine", "other", "--like", "mil3", folder=here)
    assert strange.returncode == 2 and "did you mean 'mill3'?" in strange.stderr
    assert sorted(p.name for p in (here / "machines").iterdir()) == ["mine"]


def test_a_program_on_a_machine_is_kept_as_a_scenario(here: Path) -> None:
    shutil.copy(ROOT / "scenarios/pocket/tools.tbl", here)
    (here / "ring.ngc").write_text("o<inner> call\n" + CIRCLE)
    (here / "inner.ngc").write_text("o<inner> sub\nG0 Z-1\no<inner> endsub\n")
    words = ("--set", "mcc.tool_table=tools.tbl", "--set", "mcc.p_gain=210", "--every", "2")
    ran = within("run", "ring.ngc", "--machine", "mill3", "--save-as", "kept", *words, folder=here)
    assert ran.returncode == 0 and "scenario: kept\n" in ran.stdout, ran.stderr
    kept = sorted(p.name for p in (here / "kept").iterdir())
    assert kept == ["inner.ngc", "ring.ngc", "scenario.toml", "tools.tbl"]
    assert (here / "kept/scenario.toml").read_text().startswith("# ring.ngc on mill3.\nmachine = ")
    of_scenario = motionfmu.load(here / "kept").run()
    values = {"mcc.tool_table": str(here / "tools.tbl"), "mcc.p_gain": 210}
    direct = motionfmu.machine("mill3").run(here / "ring.ngc", set=values, every=2)
    assert of_scenario.ok and of_scenario.signals.keys() == direct.signals.keys()
    assert all(np.array_equal(of_scenario[n], direct[n]) for n in direct.signals)
    ran = within("run", "ring.ngc", "--machine", "mill3", "--save-as", "kept", folder=here)
    assert ran.returncode == 2 and "kept is there already" in ran.stderr
    ran = within("run", "kept", "--save-as", "more", folder=here)
    assert ran.returncode == 2 and "--save-as more: it goes with --machine" in ran.stderr


def test_a_machine_of_ones_own_is_named_by_its_path(here: Path) -> None:
    copy_machine(motionfmu.machine("first_order"), here / "own/mine")
    plan = motionfmu.machine(here / "own/mine").scenario(here / "ring.ngc")
    save_scenario(plan, here / "kept/a", Options(stop=0.5))
    text = (here / "kept/a/scenario.toml").read_text()
    assert 'machine = "../../own/mine"\nstop = 0.5\n\n[set]' in text
    assert motionfmu.load(here / "kept/a").run().time[-1] == pytest.approx(0.4999)
    # Two files of one name have no room in one folder.
    (here / "other").mkdir()
    (here / "other/ring.ngc").write_text("M2\n")
    again = Options(set={"mcc.comp_file": str(here / "other/ring.ngc")})
    (told,) = refusal(save_scenario, plan, here / "kept/b", again)
    assert told == f"{here}/kept/b: two files ring.ngc would stand there"
    assert not (here / "kept/b").exists()


@pytest.mark.parametrize(
    ("words", "shown"),
    [
        ("check ring.ngc -j 2", "ok      ring  4 bounds"),
        ("margins ring.ngc --no-simulate", "results/ring.margins/report.html"),
        ("tune ring.ngc", "results/ring.tune/gains.toml"),
        ("contour ring.ngc --figures", "error.max"),
        ("contour ring.ngc", "results/ring.contour/report.html"),
        ("sweep ring.ngc --vary mcc.p_gain=100,200 --workers 2", "ring: 2 runs, 0 with an error"),
        ("export ring.ngc", "ring.fmu: FMI 3"),
        ("export ring.ngc --ssp", "ring.ssp: SSP 1.0"),
        ("compare ring.ngc ring.ngc --set mcc.p_gain=300", "results/ring.compare/report"),
    ],
)
def test_every_verb_takes_a_program_and_a_machine(here: Path, words: str, shown: str) -> None:
    machine = "xy_table" if "tune" in words else "first_order"  # whose gains have no bound
    ran = within(*words.split(), "--machine", machine, folder=here)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert shown in ran.stdout
    missing = within(
        *words.replace("ring", "rang").split(), "--machine", "first_order", folder=here
    )
    assert missing.returncode == 2 and "rang.ngc: no such program" in missing.stderr


def test_a_study_names_a_program_and_its_machine(here: Path) -> None:
    text = (
        '# A study.\nmachine = "first_order"\nprogram = "ring.ngc"\n[axis]\n"mcc.p_gain" = [1, 2]\n'
    )
    (here / "study.toml").write_text(text)
    ran = within("sweep", "study.toml", "--workers", "1", folder=here)
    assert ran.returncode == 0 and "2 runs, 0 with an error" in ran.stdout, ran.stderr
    (here / "study.toml").write_text(text.replace('program = "ring.ngc"\n', ""))
    ran = within("sweep", "study.toml", folder=here)
    assert ran.returncode == 2 and "program is missing" in ran.stderr
    (here / "study.toml").write_text(text.replace("first_order", "first_ordr"))
    ran = within("sweep", "study.toml", folder=here)
    assert ran.returncode == 2 and "study.toml:2: " in ran.stderr
    assert "did you mean 'first_order'?" in ran.stderr


def test_check_of_programs(here: Path) -> None:
    (here / "bad.ngc").write_text("G1 X\n")
    ran = within("check", "ring.ngc", "bad.ngc", "--machine", "first_order", "--json", folder=here)
    cases = json.loads(ran.stdout)["cases"]
    assert ran.returncode == 2 and [c["ok"] for c in cases] == [True, False]
    assert "bad.ngc: line 1" in cases[1]["error"]
    ran = within("check", "--machine", "first_order", folder=here)
    assert ran.returncode == 2 and "--machine first_order: which programs?" in ran.stderr
    ran = within("check", "ring.ngc", "--machine", "first_order", "--contrary", folder=here)
    assert ran.returncode == 2 and "--contrary is for scenarios" in ran.stderr


def test_gcode_reads_as_the_machine_does(here: Path) -> None:
    result = motionfmu.machine("mill3").run(here / "ring.ngc")
    ran = within("gcode", "ring.ngc", "--machine", "mill3", "--json", folder=here)
    found = json.loads(ran.stdout)["ring.ngc"]
    # The machine begins after 0.2 s, and says that it is done with the last frames in the card.
    assert abs(found["time"] - (result.done_at - 0.2)) < 0.02
    assert found["feeds"] == [3000.0, 3000.0]
    ran = within("gcode", "ring.ngc", "--machine", "robot6", folder=here)
    assert ran.returncode == 2 and "machine.toml: it reads no part programs" in ran.stderr
    # an option is stronger than the machine
    ran = within("gcode", "ring.ngc", "--machine", "mill3", "--max-feed", "600", folder=here)
    assert "(3000, limit 600)" in ran.stdout


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (
            "G0 X10\nG1 X300 F600\n",
            'line 2: path leaves the software limits "G1 X300 F600" (X to 300',
        ),
        ("G0 Z5\n", 'line 1: path leaves the software limits "G0 Z5" (Z to 5 mm, limit 0 mm)'),
        ("T9 M6\nG0 X1\n", 'line 1: no such tool in the tool table "T9"'),
        ("G1 A5 F600\n", "line 1: "),
    ],
)
def test_a_program_beyond_the_machine_is_refused_before_the_run(
    here: Path, text: str, told: str
) -> None:
    (here / "bad.ngc").write_text(text)
    (here / "t.tbl").write_text("T1 P1 Z10 D6\n")
    words = ("bad.ngc", "--machine", "mill3")
    ran = within("run", *words, "--set", "mcc.tool_table=t.tbl", folder=here)
    assert ran.returncode == 2 and f"bad.ngc: {told}" in ran.stderr
    assert not (here / "results").exists()
    ran = within("gcode", *words, "--tools", "t.tbl", folder=here)
    assert ran.returncode == 1 and f"bad.ngc:{told[5]}:" in ran.stdout
    if "Z to 5" in told:
        assert "(Z to 5, limit 0)" in ran.stdout


def test_a_feed_above_the_machines_is_driven_at_its_limit_and_noted_once(here: Path) -> None:
    (here / "fast.ngc").write_text("G1 X5 F90000\nX10 F91000\nX0\nM2\n")
    (note,) = motionfmu.machine("mill3").run(here / "fast.ngc").warnings
    assert "line 1: note: feed above" in note and '"F90000" (90000, limit 15000), column' in note
    ran = within("gcode", "fast.ngc", "--machine", "mill3", folder=here)
    assert ran.stdout.count("(90000, limit 15000)") == 1
    strict = {"mcc.strict_feed": True}
    (told, *_) = refusal(motionfmu.machine("mill3").run, here / "fast.ngc", set=strict)
    assert "line 1: feed above max_feed" in told and "(90000, limit 15000)" in told
    # an axis that is slower than the feed along the path
    slow = {"mcc.max_rpm": [600.0, 3000.0, 3000.0, 3000.0, 3000.0, 3000.0]}
    (here / "slow.ngc").write_text("G1 X5 F9000\nM2\n")
    (note,) = motionfmu.machine("mill3").run(here / "slow.ngc", set=slow).warnings
    assert "(9000, limit 6000)" in note


def test_a_program_longer_than_the_usual_limit_has_time_enough(here: Path) -> None:
    (here / "long.ngc").write_text("G4 P700\nM2\n")
    for name, limit in (("ring", 600.0), ("long", 1401.0)):
        scenario = loaded(here / f"{name}.ngc", "xy_table")
        assert bounded(scenario, Options()).limit == limit
