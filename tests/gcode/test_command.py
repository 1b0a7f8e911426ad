"""The command that checks part programs."""

import json
from pathlib import Path

import pytest
from conftest import ROOT
from typer.testing import CliRunner

from motionfmu.analysis.gcode import read, strokes, summarise
from motionfmu.cli import app

GOOD = ROOT / "tests/gcode/programs/post_mill.ngc"


def command(*arguments: object) -> tuple[int, str]:
    """Exit status and output."""
    done = CliRunner().invoke(app, ["gcode", *map(str, arguments)])
    return done.exit_code, done.output


def test_a_good_program_gets_a_report(tmp_path: Path) -> None:
    code, text = command(GOOD, "--out", tmp_path)
    assert code == 0, text
    assert "T1" in text and "T2" in text
    folder = tmp_path / "post_mill.gcode"
    assert {f.name for f in folder.iterdir()} == {
        *("report.html", "path.png", "path.svg", "result.json")
    }
    found = json.loads((folder / "result.json").read_text())
    assert found["faults"] == [] and len(found["tools"]) == 2
    assert "Feed along the path" in (folder / "report.html").read_text()


def test_faults_are_told_all_with_a_mark_below(tmp_path: Path) -> None:
    file = tmp_path / "bad.ngc"
    file.write_text("G1 X5 Q7\nG1 Y[1/0]\nG1 X6\nG999\n")
    code, text = command(file)
    assert code == 1
    lines = text.splitlines()
    assert next(x for x in lines if x.startswith(str(file))).startswith(f"{file}:1:7: ")
    assert len([x for x in lines if x.startswith(str(file))]) == 3
    assert lines[lines.index("    G1 X5 Q7") + 1] == " " * 10 + "^~"
    code, text = command(file, "--json")
    assert code == 1
    assert [f["line"] for f in json.loads(text)[str(file)]["faults"]] == [1, 2, 4]


def test_columns_are_characters_and_more_faults_are_told(tmp_path: Path) -> None:
    file = tmp_path / "grosse.ngc"
    file.write_text("\ufeff(Größe) G1 X5 Q7\n" + "G999\n" * 25, encoding="utf-8")
    code, text = command(file)
    lines = text.splitlines()
    assert code == 1 and lines[0] == f'{file}:1:15: word has no use in this line "Q7"'
    assert lines[1] == "    (Größe) G1 X5 Q7" and lines[2] == " " * 18 + "^~"
    assert lines[-1] == f"{file}: 20 faults are told, there are more"
    assert json.loads(command(file, "--json")[1])[str(file)]["more"]


def test_notes_are_told_and_on_the_page(tmp_path: Path) -> None:
    file = tmp_path / "part.ngc"
    file.write_text("G1 X5 F60 (PRINT, <b>)\nM19\nM2\n")
    code, text = command(file, "--out", tmp_path)
    assert code == 0 and f"{file}:2:1: note: the spindle stops, it has no angle M19" in text
    page = (tmp_path / "part.gcode" / "report.html").read_text()
    assert "(PRINT, &lt;b&gt;)" in page and "Accepted, and without effect" in page


def test_limits_and_feeds_are_those_given(tmp_path: Path) -> None:
    file = tmp_path / "part.ngc"
    file.write_text("G1 X50 F3000\nM2\n")
    assert command(file, "--json", "--limit", "X=-1:50")[0] == 0
    assert command(file, "--json", "--limit", "X=-1:49")[0] == 1
    assert command(file, "--json", "--max-feed", 2999, "--strict-feed")[0] == 1
    code, text = command(file, "--json", "--max-feed", 1500)
    found = json.loads(text)[str(file)]
    assert code == 0 and [n["text"] for n in found["notes"]] == ["F3000"]
    assert found["time"] == pytest.approx(2.025, abs=2e-3)
    quick, slow = (
        json.loads(command(file, "--json", "--acceleration", a)[1])[str(file)]["time"]
        for a in (1000, 100)
    )
    assert (quick, slow) == pytest.approx((1.05, 1.5), abs=2e-3)


def test_figures_of_a_program() -> None:
    """A line of 3-4-5, a half circle of radius 5 up to Y5, a rapid back."""
    program = read("G1 X3 Y4 F600\nT7 M6\nG0 X-5 Y0\nG2 X5 R5 F300\nG0 X0 Z2")
    s = summarise(program)
    assert s.feed_way == pytest.approx(5.0 + 5.0 * 3.141592653589793)
    assert s.rapid_way == pytest.approx(80**0.5 + 29**0.5)
    assert s.high[:3] == pytest.approx((5.0, 5.0, 2.0)) and s.low[:3] == pytest.approx((-5, 0, 0))
    assert s.feeds == pytest.approx((300.0, 600.0))
    assert [u.tool for u in s.tools] == [0, 7] and s.stops == 1
    assert sum(u.time for u in s.tools) == pytest.approx(s.time)
    drawn = list(strokes(program))
    assert [(x.rapid, x.tool) for x in drawn] == [(False, 0), (True, 7), (False, 7), (True, 7)]
    assert drawn[2].points[:, 0] ** 2 + drawn[2].points[:, 1] ** 2 == pytest.approx(25.0)


def test_a_program_that_runs_for_ever_is_read_to_an_end() -> None:
    program = read("G91 G1 X1\nX-1\nM99\n", check_again=3000)
    assert program.faults == [] and len(program.commands) == pytest.approx(2000, abs=10)
