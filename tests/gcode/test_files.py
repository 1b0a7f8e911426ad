"""Files that a part program calls stand beside it, also inside an FMU."""

import shutil
import zipfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from compare import difference, first
from conftest import ROOT
from fmi_tools import ERROR, OK, Instance
from second import Options
from typer.testing import CliRunner

import motionfmu
from motionfmu.analysis.gcode import Program, read
from motionfmu.analysis.gcode.program import Texts, _reader
from motionfmu.analysis.gcode.subprogram_files import called
from motionfmu.base.errors import InputError
from motionfmu.cli import app
from motionfmu.export.resources import Resources
from motionfmu.export.single_fmu import packed
from motionfmu.fmu.places import RESOURCE
from motionfmu.virtual.mcc import Mcc, VirtualCard
from motionfmu.virtual.robot import RobotError, VirtualRobot

CALLS = ROOT / "tests/gcode/programs/calls"
OPTIONS = Options(folder=CALLS)
# What LinuxCNC's rs274 2.9 makes of files.ngc.
PLACES = [
    *((20, 0, 0), (20, 10, 0), (0, 10, 0), (0, 0, 0), (0, 0, -1), (0, 0, 1), (0, 0, 5)),
    *((0, 0.5, 5), (0, 1, 5), (0, 1.5, 5), (6, 1.5, 5)),
    *((6, 2, 5), (6, 2.5, 5), (6, 3, 5), (6, 3.5, 5), (6, 3.5, -1), (6, 3.5, 8)),
]


def written(folder: Path, **files: str) -> Program:
    """A program and the files beside it, read."""
    for name, text in files.items():
        (folder / f"{name}.ngc").write_text(text)
    return read(folder / "main.ngc")


def test_files_are_called_by_name_and_by_number() -> None:
    file = CALLS / "files.ngc"
    assert difference(file.read_text(), OPTIONS) == ""
    program = read(file)
    assert program.commands["end"][:, :3].tolist() == [list(map(float, p)) for p in PLACES]
    assert set(program.files) == {"outline", "12"}
    # Commands have the line of the program, that of the call where a file makes them.
    assert program.commands["line"][[0, 4, 6, 7]].tolist() == [7, 4, 8, 9]
    assert first(file.read_text(), replace(OPTIONS, folder=None)).faults[0].line == 7


def test_user_commands_are_subprograms() -> None:
    """M101 in a file, M150 in the program, each before the rest of its line."""
    file = CALLS / "user.ngc"
    assert difference(file.read_text(), OPTIONS) == ""
    c = read(file).commands
    moves = c[c["length"] > 0.0]["end"][:, :3].tolist()
    assert moves == [
        *([0, 0, 1], [11, 0, 1], [11, 0, 2], [11, 0, 3], [11, 5, 3]),
        *([23.7, 5, 3], [23.7, -1, 3], [23.7, 2, 3], [0, 0, 3]),
    ]
    switched = c[(c["type"] == 11) & (c["set"] != 0)]
    assert switched["set"].tolist() == [8, 4, 16] and switched["line"].tolist() == [14, 15, 16]
    assert read(file.read_text()).faults[0].why.startswith("no subprogram of its name")
    assert [f.name for f in called(file)] == ["m101.ngc"]


def test_a_fault_in_a_file_is_told_with_its_file_and_line(tmp_path: Path) -> None:
    main, sub = "o<a> call [1]\nG999\n", "(one)\no<a> sub\nG1 X1 Q7\no<a> endsub\n"
    program = written(tmp_path, main=main, a=sub)
    assert list(map(str, program.faults)) == [
        'a.ngc: line 3: word has no use in this line "Q7", column 7',
        'line 2: unknown word "G999", column 1',
    ]
    told = CliRunner().invoke(app, ["gcode", str(tmp_path / "main.ngc")])
    lines = told.output.splitlines()
    assert told.exit_code == 1, told.exception
    assert lines[0] == f'{tmp_path}/a.ngc:3:7: word has no use in this line "Q7"'
    assert lines[1:3] == ["    G1 X1 Q7", " " * 10 + "^~"]


@pytest.mark.parametrize(
    "files, why",
    [
        ({"main": "o<b> call\n"}, 'line 1: no such subprogram "o<b> call"'),
        ({"main": "o<a> call\n", "a": "G0 X1\n"}, 'line 1: no such subprogram "o<a> call"'),
        ({"main": "o<../a> call\n", "a": "o<../a> sub\n"}, "line 1: no such subprogram"),
        ({"main": "M98 P5\n", "5": "o5\nM99\n"}, "line 1: no such subprogram"),
        ({"main": "o<a> call\n", "a": "o<a> sub\n"}, "line 1: O word without its end"),
        ({"main": "o<a> call\n", "a": "o<a> sub\no<a> call\n"}, "a.ngc: line 2: more than 10"),
    ],
)
def test_a_wrong_call_is_told(files: dict[str, str], why: str, tmp_path: Path) -> None:
    assert str(written(tmp_path, **files).faults[0]).startswith(why)


def test_no_more_than_32_files_are_called(tmp_path: Path) -> None:
    for count in (32, 33):
        files = {f"f{i}": f"o<f{i}> sub\nG1 X{i + 1}\no<f{i}> endsub\n" for i in range(count)}
        main = "".join(f"o<{name}> call\n" for name in files) * 2
        program = written(tmp_path, main=main, **files)
        assert [str(f) for f in program.faults] == [
            f'line {k}: more than 32 files are called "o<f32> call", column 1'
            for k in (33, 66)
            if count == 33
        ]
        assert len(program.commands) == (64 if count == 32 else 32)


def test_what_is_in_the_program_comes_before_a_file(tmp_path: Path) -> None:
    main = "o<a> sub\nG1 X1\no<a> endsub\no<b> call\nM2\n"
    files = {"a": "o<a> sub\nG1 X2\no<a> endsub\n", "b": "o<b> sub\no<a> call\no<b> endsub\n"}
    assert written(tmp_path, main=main, **files).commands["end"][:, 0].tolist() == [1.0]


def test_the_files_that_travel_with_a_program_are_found(tmp_path: Path) -> None:
    assert [f.name for f in called(CALLS / "files.ngc")] == ["12.ngc", "outline.ngc"]
    files = ("My_Sub", "my_sub", "7", "8", "other", "far")
    for name in files:
        (tmp_path / f"{name}.ngc").write_text("o<far> call\n" if name == "7" else "")
    for text, names in (
        ("/N10 O < My _ Sub > C ALL [1]\n", ["my_sub"]),
        ("o007 call\n", ["7", "far"]),
        ("\ufeffo<other> call\n", ["other"]),
        ("o[#1 + 1] call\n", ["7", "8", "far"]),
        ("(o<other> call)\n; o7 call\no<gone> call\no8 sub\n", []),
    ):
        (tmp_path / "main.ngc").write_text(text, encoding="utf-8")
        assert [f.stem for f in called(tmp_path / "main.ngc")] == names


def test_a_reader_that_begins_anew_asks_for_its_files_anew(tmp_path: Path) -> None:
    reader = _reader({})
    for x in (1.0, 2.0):
        folder = tmp_path / str(x)
        folder.mkdir()
        (folder / "a.ngc").write_text(f"o<a> sub\nG1 X{x}\no<a> endsub\n")
        assert Program(Texts("o<a> call\n", folder), reader).commands["end"][0, 0] == x


def begun(fmi: int, program: Path) -> tuple[int, Instance]:
    """An FMU of the library with a program, and whether it takes it."""
    instance = Instance("mcc", fmi)
    assert instance.set("program", str(program)) == OK
    assert instance.enter() == OK
    return instance.call("ExitInitializationMode"), instance


@pytest.mark.parametrize("fmi", (2, 3))
def test_an_fmu_tells_the_file_of_a_fault(fmi: int, tmp_path: Path) -> None:
    for file in CALLS.iterdir():
        shutil.copy(file, tmp_path)
    status, instance = begun(fmi, tmp_path / "files.ngc")
    assert status == OK, instance.said
    (tmp_path / "outline.ngc").write_text("o<outline> sub\nG1 Q\no<outline> endsub\n")
    status, instance = begun(fmi, tmp_path / "files.ngc")
    assert status == ERROR
    assert 'files.ngc: outline.ngc: line 2: number expected after "Q"' in instance.said


@pytest.mark.parametrize("fmi", (2, 3))
def test_an_fmu_refuses_high_feeds_if_it_is_strict(fmi: int, tmp_path: Path) -> None:
    """Else it drives what is possible."""
    (tmp_path / "part.ngc").write_text("G1 X1 F9000\n")
    for strict, wanted in ((False, OK), (True, ERROR)):
        instance = Instance("mcc", fmi)
        assert instance.set("program", str(tmp_path / "part.ngc")) == OK
        assert instance.set("max_feed", 6000.0) == OK
        assert instance.set("strict_feed", strict) == OK
        assert instance.enter() == OK
        assert instance.call("ExitInitializationMode") == wanted
    assert 'line 1: feed above max_feed [mm/min] "F9000"' in instance.said


@pytest.mark.parametrize("engine", ("fused", "native"))
def test_a_run_calls_them(engine: str) -> None:
    """The axes stand in the end where rs274 ends."""
    given = {"mcc.program": str(CALLS / "files.ngc"), "mcc.active": [True] * 3 + [False] * 3}
    given |= {f"{n}.active": given["mcc.active"] for n in ("card", "drives", "machine")}
    result = motionfmu.load(ROOT / "scenarios/square").run(set=given, engine=engine)
    assert result["mcc.command"][-1] == len(PLACES)
    assert result["machine.table_position"][-1, :3] * 1e3 == pytest.approx(PLACES[-1], abs=0.02)


@pytest.mark.parametrize("fmi", (2, 3))
def test_they_travel_inside_an_fmu(fmi: int, tmp_path: Path) -> None:
    made, why = packed("mcc", tmp_path / "m.fmu", fmi, {"program": str(CALLS / "files.ngc")})
    assert made == ["12.ngc", "files.ngc", "outline.ngc"] and why == ""
    with zipfile.ZipFile(tmp_path / "m.fmu") as archive:
        assert archive.read("resources/outline.ngc") == (CALLS / "outline.ngc").read_bytes()


@pytest.mark.parametrize("calling", (0, 3))
def test_files_of_one_name_of_one_fmu_all_travel(calling: int, tmp_path: Path) -> None:
    """Three groups of axes with a program each, alike by name, alone or with a file they call."""
    resources = Resources()
    for group in range(1, 4):
        program = tmp_path / str(group) / "part.ngc"
        program.parent.mkdir()
        program.write_text("o<own> call\n" if group <= calling else f"G0 X{group}\n")
        if group <= calling:
            (tmp_path / str(group) / "own.ngc").write_text(f"(of group {group})\n")
        for _ in range(2):  # once more: no other name
            said = Path(resources.added(program, "mcc").removeprefix(RESOURCE))
            for file in (program, *called(program)):
                assert resources.files[str(said.with_name(file.name))] == file
    assert sorted(resources.files.values()) == sorted(tmp_path.glob("*/*.ngc"))


def test_a_called_file_that_cannot_be_read_is_told(tmp_path: Path, capfd: Any) -> None:
    (tmp_path / "a.ngc").symlink_to("/proc/self/mem")  # a regular file whose first byte is an error
    with pytest.raises(InputError, match=r"cannot read .*a\.ngc: Input/output error"):
        written(tmp_path, main="o<a> call\n")
    with pytest.raises(InputError, match=r"cannot read .*a\.ngc: Input/output error"):
        VirtualCard().mcc.task_check("o<a> call\n", folder=tmp_path)
    with pytest.raises(InputError, match=r"cannot read .*a\.ngc: Input/output error"):
        VirtualRobot().start("o<a> call\n", language="gcode", folder=tmp_path)
    assert capfd.readouterr().err == ""


def test_virtual_cards_and_robots_find_the_files_of_a_program(tmp_path: Path) -> None:
    """From a text with a folder, or from a file; a fault in one is told with its name."""
    (tmp_path / "part.ngc").write_text("o<part> sub\nG1 X#1 Y5\no<part> endsub\n")
    (tmp_path / "main.ngc").write_text("G1 F600\no<part> call [20]\nM2\n")
    (tmp_path / "bad.ngc").write_text("o<bad> sub\nG1 X1 Q7\no<bad> endsub\n")
    file, text = tmp_path / "main.ngc", (tmp_path / "main.ngc").read_text()
    for given, folder in ((file, None), (text, tmp_path)):
        card = VirtualCard()
        card.mcc.task_start(given, folder=folder)
        assert card.run_until_stop().position[:2] == pytest.approx([20.0, 5.0])
    with pytest.raises(InputError, match="line 2: no such subprogram"):
        VirtualCard().mcc.task_check(text)
    with pytest.raises(InputError, match=r'bad.ngc: line 2: word has no use in this line "Q7"'):
        VirtualCard().mcc.task_check("o<bad> call\n", folder=tmp_path)
    robot = VirtualRobot()
    (tmp_path / "part.ngc").write_text("o<part> sub\nG91 G1 X#1\no<part> endsub\n")
    before = robot.read().pose[0]
    robot.start(file, language="gcode")
    assert robot.run_until_stop().pose[0] == pytest.approx(before + 20.0, abs=0.01)
    with pytest.raises(RobotError, match=r'bad.ngc: line 2: word has no use in this line "Q7"'):
        robot.start("o<bad> call\n", language="gcode", folder=tmp_path)
    with pytest.raises(RobotError, match="line 2: no such subprogram"):
        robot.start(text, language="gcode")


def test_a_library_takes_points_of_files(tmp_path: Path) -> None:
    """The library alone, with both files for as long as it reads them."""
    (tmp_path / "part.ngc").write_text("o<part> sub\nG1 X#1\no<part> endsub\n")
    mcc = Mcc()
    mcc.task_start("G1 F600\no<part> call [3]\n" + "o<part> call [1]\n" * 20, folder=tmp_path)
    (tmp_path / "part.ngc").unlink()
    assert mcc.take(100_000)[:, 0].sum() == 1000 and mcc.get_ppos()[0] == 1000
