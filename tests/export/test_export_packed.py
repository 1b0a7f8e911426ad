"""motionfmu export of an FMU with its program inside, and of systems by the same words."""

import re
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT
from console import within
from few_cases import few
from fmpy import read_model_description, simulate_fmu

import motionfmu
from motionfmu.analysis.gcode import read
from motionfmu.base.errors import InputError
from motionfmu.export.single_fmu import packed
from motionfmu.export.system_fmu import as_fmu as export

both = pytest.mark.parametrize("fmi", (2, 3))
TEXT = "G91 G0 X0 Y0\nG1 X5 Y3 F3000\nM2\n"


@both
def test_a_program_with_any_name_is_packed_and_run(fmi: int, tmp_path: Path) -> None:
    (tmp_path / "pärt.ngc").write_text(TEXT)
    done = within(
        *("export", "mcc", "--program", "pärt.ngc", "-o", "m.fmu", "--fmi", fmi),
        *("--set", "p_gain=70", "--set", "mcc.dry_run=true"),
        folder=tmp_path,
    )
    assert done.returncode == 0, done.stderr
    told = f"m.fmu: FMI {fmi}, mcc with pärt.ngc in its resources, values set: 3\n"
    assert done.stdout.replace("\n", "") == told.strip()
    (tmp_path / "pärt.ngc").unlink()
    starts = {
        v.name: str(v.start) for v in read_model_description(str(tmp_path / "m.fmu")).modelVariables
    }
    assert starts["program"] == "resource:pärt.ngc" and starts["dry_run"] == "true"
    assert starts["p_gain[6]" if fmi == 2 else "p_gain"].split() == ["70"] * (1 if fmi == 2 else 6)
    found = simulate_fmu(str(tmp_path / "m.fmu"), stop_time=0.05, step_size=1e-3, output=["queue"])
    assert found["queue"].max() > 10


def test_any_fmu_with_files_is_packed(tmp_path: Path) -> None:
    for name in ("a.ngc", "b/a.ngc"):
        file = tmp_path / name
        file.parent.mkdir(exist_ok=True)
        file.write_text(TEXT)
    given = {
        "group1_program": str(tmp_path / "a.ngc"),
        "group2_program": (tmp_path / "b/a.ngc").as_uri(),
        "group2_card": 2,
        "group2_channel": [1, 2, 3, 0, 0, 0],
        "group3_program": "resource:there already",
    }
    target = tmp_path / "g.fmu"
    assert packed("mcc_groups", target, 3, given) == (["a.ngc", "group2_program/a.ngc"], "")
    with zipfile.ZipFile(target) as archive:
        xml = archive.read("modelDescription.xml").decode()
        assert archive.read("resources/group2_program/a.ngc").decode() == TEXT
    assert '"resource:group2_program/a.ngc"' in xml and '"resource:there already"' in xml


PROGRAMS = {
    "wrong.ngc": "G1 X10 F600\nG1 X5 Q3\nY[1/0]\nM2\n",
    "uvw.ngc": "G1 X10 U5 F600\nM2\n",
    "far.ngc": "G1 X50 F600\nM2\n",
    "abc.ngc": "G1 X10 C5 F600\nM2\n",
    "goto.ngc": "#1=5\nIF [#1 EQ 5] GOTO 3\nN3 G1 X#1 F600\nM30\n",
    "both.ngc": "G1 X10 U5 F600\nG1 X1 Q3\nM2\n",
    "slash.ngc": "/G1 X1 Q3\nG1 X1 F600\nM2\n",
    "tools.ngc": "T5 M6\nG1 X1 F600\nM2\n",
    "wrong.job": "NOP\nMOVY P1 VJ=50\nEND\n",
    "point.job": "NOP\nMOVJ P1 VJ=50\nEND\n",
    "points.txt": "",
    "tools.tbl": "T1 P1 Z10\n",
}
# What is wrong for any machine that has the values given: the lines of the faults.
REFUSED: dict[tuple[str, ...], list[int]] = {
    ("mcc", "--program", "wrong.ngc"): [2, 3],
    ("mcc", "--program", "both.ngc"): [2],
    ("mcc", "--program", "uvw.ngc", "--set", "active=[true,true,true,false,false,true]"): [1],
    ("mcc", "--program", "abc.ngc", "--set", "rotary_names=false"): [1],
    ("mcc", "--program", "goto.ngc", "--set", "fanuc=false"): [2],
    ("mcc", "--program", "slash.ngc", "--set", "block_delete=false"): [1],
    ("mcc", "--program", "tools.ngc", "--set", "tool_table=tools.tbl"): [1],
    ("mcc", "--program", "far.ngc", "--set", "high_limit=40", "--set", "check_over_travel=true"): [
        1
    ],
    ("mcc_groups", "--set", "group1_program=wrong.ngc"): [2, 3],
    ("mcc_groups", "--set", "group1_program=goto.ngc"): [2],
    ("soft_controller", "--program", "wrong.ngc"): [2, 3],
    ("soft_controller", "--program", "wrong.job", "--set", "points=points.txt"): [2],
}
# What other values make good: as it is the FMU tells this line.
WARNED: dict[tuple[str, ...], int] = {
    ("mcc", "--program", "uvw.ngc"): 1,
    ("mcc", "--program", "abc.ngc"): 1,
    ("mcc", "--program", "goto.ngc"): 2,
    ("mcc_groups", "--set", "group1_program=uvw.ngc"): 1,
    ("soft_controller", "--program", "point.job"): 2,
}
GOOD = (
    ("mcc", "--program", "far.ngc"),
    ("mcc", "--program", "far.ngc", "--set", "high_limit=40"),
    ("mcc", "--program", "slash.ngc"),
    ("mcc", "--program", "tools.ngc"),
    ("mcc", "--program", "uvw.ngc", "--set", "active=true", "--set", "path_file=written.txt"),
    ("mcc", "--program", "goto.ngc", "--set", "fanuc=true"),
)


def export_of(line: tuple[str, ...], folder: Path) -> Any:
    """The command in a folder with all programs, and the lines that its messages name."""
    for name, text in PROGRAMS.items():
        (folder / name).write_text(text)
    done = within("export", *line, "-o", "x.fmu", folder=folder)
    told = (done.stdout + done.stderr).replace("\n", " ")
    return done, [int(n) for n in re.findall(r"\.(?:ngc|job): line (\d+): ", told)]


@pytest.mark.parametrize("line", REFUSED)
def test_a_program_that_no_machine_takes_is_not_packed(
    line: tuple[str, ...], tmp_path: Path
) -> None:
    done, lines = export_of(line, tmp_path)
    assert (done.returncode, lines) == (2, REFUSED[line]), done.stderr
    assert not (tmp_path / "x.fmu").exists()
    text = PROGRAMS["wrong.ngc"]
    if "wrong.ngc" in line:  # in the words of `motionfmu gcode`
        assert all(str(fault).partition(": ")[2] in done.stderr for fault in read(text).faults)


@pytest.mark.parametrize("line", WARNED)
def test_a_program_that_other_values_make_good_is_packed_with_a_warning(
    line: tuple[str, ...], tmp_path: Path
) -> None:
    done, lines = export_of(line, tmp_path)
    assert (done.returncode, lines) == (0, [WARNED[line]]), done.stderr
    assert "warning until other values are set: " in done.stdout.replace("\n", " ")
    assert (tmp_path / "x.fmu").exists()


@pytest.mark.parametrize("line", GOOD)
def test_a_good_program_is_packed_without_a_word(line: tuple[str, ...], tmp_path: Path) -> None:
    done, lines = export_of(line, tmp_path)
    assert (done.returncode, lines) == (0, []) and "warning" not in done.stdout
    assert (tmp_path / "x.fmu").exists() and not (tmp_path / "written.txt").exists()


@pytest.mark.parametrize("kind", few(["--fmu", "--ssp"], 1))
def test_a_scenario_whose_program_is_wrong_is_not_exported(kind: str, tmp_path: Path) -> None:
    """Its machine is known: an axis that it has not is a fault, too."""
    for program, wanted in (("wrong.ngc", [2, 3]), ("uvw.ngc", [1]), ("far.ngc", [])):
        file = tmp_path / "x.fmu"
        line = (str(ROOT / "scenarios/circle"), kind, "--set", f"mcc.program={tmp_path / program}")
        done, lines = export_of(line, tmp_path)
        assert (done.returncode, lines) == (2 if wanted else 0, wanted), done.stderr
        assert file.exists() == (not wanted)
        file.unlink(missing_ok=True)


WRONG = {
    ("mcc", "--program", "gone.ngc"): "program: there is no file gone.ngc",
    ("mcc_groups", "--program", "x"): "no parameter program: --set group1_program=FILE",
    ("epcio", "--program", "x"): "no parameter program: it reads no file",
    ("mcc", "--set", "progam=x"): "mcc has no variable 'progam'; did you mean 'program'?",
    ("mcc", "--set", "p_gain=-1"): "mcc.p_gain = -1: outside 0 .. 65535",
    ("mcc", "--set", "status=1"): "status: cannot be set",
    ("mcc", "--fmi", "4"): "FMI 4: 2 or 3",
    ("scenarios/circle", "--program", "x"): "--program is for an FMU alone",
}


@pytest.mark.parametrize("line", WRONG)
def test_what_cannot_be_packed_is_told(line: tuple[str, ...], tmp_path: Path) -> None:
    name = str(ROOT / line[0]) if "/" in line[0] else line[0]
    done = within("export", name, *line[1:], "-o", "x.fmu", folder=tmp_path)
    assert done.returncode == 2
    assert WRONG[line] in done.stderr.replace("\n", " ")
    assert not list(tmp_path.iterdir())


@pytest.mark.more
@pytest.mark.parametrize("fmi", few([2, 3], [3]))
def test_a_system_takes_its_program_by_uri_and_from_its_resources(fmi: int, tmp_path: Path) -> None:
    """The same bits as a run here; and as with a program by path, set in the importer."""
    program = tmp_path / "eïn.ngc"
    program.write_text((ROOT / "scenarios/circle/circle.ngc").read_text())
    demo = motionfmu.load(ROOT / "scenarios/circle")
    shown: dict[str, Any] = {"stop_time": 0.2, "step_size": 1e-4, "output_interval": 1e-4}
    name = "machine.table_position[1]" if fmi == 2 else "machine.table_position"
    found = []
    file = tmp_path / "c.fmu"
    for given, start in (
        ({"mcc.program": program.as_uri()}, {}),
        ({}, {"mcc.program": str(program)}),
        ({}, {"mcc.program": program.as_uri()}),
    ):
        export(demo, file, fmi, given)
        with zipfile.ZipFile(file) as archive:
            inside = [n for n in archive.namelist() if n.startswith("resources/")]
        assert inside == [f"resources/{program.name if given else 'circle.ngc'}"]
        found.append(simulate_fmu(str(file), output=[name], start_values=start, **shown)[name])
    run = demo.run(stop=0.2)["machine.table_position"]
    wanted = run[:, 0] if fmi == 2 else run
    assert np.ptp(wanted) > 1e-4
    for x in found:
        assert x[:-1].tobytes() == np.ascontiguousarray(wanted).tobytes()
    told: list[Any] = []
    # FMPy's own logger is one for the process, and whoever gave another before has taken it along.
    shown |= {"logger": lambda *told_of: told.append(told_of[-1])}
    with pytest.raises(Exception, match=r"initial|Initialization"):
        simulate_fmu(str(file), output=[name], start_values={"mcc.program": "resource:no"}, **shown)
    assert "no such file in the FMU's resources" in str(told)


def test_an_engine_takes_a_uri_and_tells_of_a_missing_resource() -> None:
    demo = motionfmu.load(ROOT / "scenarios/circle")
    plain = demo.run(stop=0.05)["card.pulse_count"]
    uri = (ROOT / "scenarios/circle/circle.ngc").as_uri()
    for engine in ("fused", "native"):
        other = demo.run(stop=0.05, set={"mcc.program": uri}, engine=engine)["card.pulse_count"]
        assert other.tobytes() == plain.tobytes()
        with pytest.raises(InputError, match=r"no such file in the FMU's resources|has named no"):
            demo.run(stop=0.05, set={"mcc.program": "resource:no.ngc"}, engine=engine)


@both
def test_packed_fmus_are_one_program_with_their_files(fmi: int, tmp_path: Path) -> None:
    """Two of one model, with files of one name: as a system here, and as an exported one."""
    for owner, way in (("one", "X5 Y3"), ("two", "X0.01 Y0")):
        (tmp_path / owner).mkdir()
        program = tmp_path / owner / "pärt.ngc"
        program.write_text(TEXT.replace("X5 Y3", way))
        given = {"program": str(program), "dry_run": True}
        packed("mcc", tmp_path / owner / "m.fmu", 3, given)
        program.unlink()
    tables = {
        "stop": 0.1,
        "step": 1e-3,
        "component": {"one": "one/m.fmu", "two": "two/m.fmu"},
        "leave": ["*"],
        "record": {"signals": ["*.queue", "*.card_cmd_seq"]},
    }
    scenario = motionfmu.scenario(tables, folder=tmp_path)
    runs = [scenario.run(engine=engine, fmi=fmi) for engine in ("fused", "native")]
    assert scenario.run().options["engine"] == "fused"
    for name in runs[0].signals:
        assert runs[0][name].tobytes() == runs[1][name].tobytes(), name
    assert runs[0]["one.queue"][-1] == 64 > runs[0]["two.queue"][-1] > 5
    export(scenario, tmp_path / "s.fmu", fmi, {})
    with zipfile.ZipFile(tmp_path / "s.fmu") as archive:
        inside = [n for n in archive.namelist() if n.startswith("resources/")]
        xml = archive.read("modelDescription.xml").decode()
    assert inside == ["resources/one/pärt.ngc", "resources/two/pärt.ngc"]
    assert '"resource:two/pärt.ngc"' in xml and str(tmp_path) not in xml
    shown: dict[str, Any] = {"stop_time": 0.1, "step_size": 1e-3, "output_interval": 1e-3}
    found = simulate_fmu(str(tmp_path / "s.fmu"), output=["two.queue"], **shown)["two.queue"][:-1]
    assert found.tolist() == runs[0]["two.queue"].tolist()
