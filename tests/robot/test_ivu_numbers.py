"""What the README of robot_ivu says in numbers is what its runs give, to the last digit there."""

import hashlib
import re
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT

import motionfmu

FOLDER = ROOT / "scenarios/robot_ivu"
README = (FOLDER / "README.md").read_text(encoding="utf-8")
pytestmark = pytest.mark.more


def table(head: str) -> list[list[str]]:
    """Rows of the table whose head begins so."""
    rows = README[README.index(head) :].split("\n\n")[0].splitlines()[2:]
    return [[cell.strip() for cell in row.strip("|").split("|")] for row in rows]


def numbers(cell: str) -> list[str]:
    return re.findall(r"\d+\.\d+", cell)


def told(value: float, number: str) -> bool:
    """Whether a value is this number, which has fewer digits; ten.py prints one more."""
    return abs(value - float(number)) <= 0.551 * 10.0 ** -len(number.partition(".")[2])


@pytest.mark.long
def test_ten_times(tmp_path: Path) -> None:
    """By ten.py as it is first typed: its picture does not take the place of the tracked one."""
    before = hashlib.sha256((FOLDER / "ivu.png").read_bytes()).hexdigest()
    ran = subprocess.run(
        [sys.executable, FOLDER / "ten.py"], cwd=tmp_path, capture_output=True, text=True
    )
    assert ran.returncode == 0, ran.stderr
    assert (tmp_path / "results/robot_ivu.ten/ivu.png").stat().st_size > 10_000
    assert (tmp_path / "results/robot_ivu.ten/report.html").is_file()
    assert hashlib.sha256((FOLDER / "ivu.png").read_bytes()).hexdigest() == before
    # Of each stroke and side: AT_P, RT_P, centre lines, band, common, speed, FV.
    rows = (line.split() for line in ran.stdout.splitlines())
    found = {
        (r[0], r[1]): [float(x) for x in r[2:]] for r in rows if len(r) == 9 and r[1] != "side"
    }
    strokes = {"I": "I1", "V, first": "V2", "V, second": "V3", "U": "U4"}
    for stroke, runs, *cells in table("| stroke | runs"):
        sides = ["both"] if runs == "all ten" else ["one", "other"]
        for cell, place in zip(cells, (1, 2, 3, 4), strict=True):
            now = [found[strokes[stroke], side][place] for side in sides]
            said = numbers(cell)
            assert all(map(told, now, said)) and len(now) == len(said), (stroke, now, said)


@pytest.mark.parametrize(
    ("row", "given"),
    [
        ("from two sides", {}),
        ("twice from the same side", {"soft.job": "SAME"}),
        ("without lost motion", {"arm.lost_motion": 0.0}),
    ],
)
def test_twice(row: str, given: dict[str, object]) -> None:
    ((_, *cells),) = [cells for cells in table("| | RT_P | centre") if cells[0] == row]
    figures = motionfmu.load(FOLDER).run(set=given).iso9283().numbers()
    now = (figures["RT_P"], figures["coincidence"]["lines"])
    assert all(told(x, numbers(cell)[0]) for x, cell in zip(now, cells, strict=True)), now
