"""Positioning tests as files have them, and what is wrong with some."""

from pathlib import Path

import numpy as np
import pytest

from motionfmu import InputError
from motionfmu.calibrate import position_record

TARGETS = [-50.0, 0.0, 25.0, 100.0]
UP = np.array([[1e-3, 0.0, 2e-3, -3e-3], [2e-3, 1e-3, 3e-3, -2e-3]])
DOWN = UP + 5e-3


def readings():
    """Run, target, direction and deviation [mm] in the order of time."""
    for run in range(2):
        for way, rows in ((1, UP), (-1, DOWN)):
            order = range(4) if way > 0 else reversed(range(4))
            yield from ((run + 1, TARGETS[k], way, rows[run, k]) for k in order)


def written(tmp_path: Path, text: str, name: str = "laser.csv") -> Path:
    file = tmp_path / name
    file.write_text(text, encoding="utf-8")
    return file


def check(file: Path, axis: str = "") -> None:
    found = position_record(file)
    assert found.axis == axis
    assert found.test.targets.tolist() == TARGETS
    np.testing.assert_allclose(found.test.up, UP, atol=1e-9)
    np.testing.assert_allclose(found.test.down, DOWN, atol=1e-9)


def test_a_row_a_reading_with_directions(tmp_path: Path) -> None:
    rows = [f"{r},{t},{'up' if w > 0 else 'down'},{d * 1e3}" for r, t, w, d in readings()]
    text = (
        "# a laser at its target\nAxis: X\nRun,Target [mm],Direction,Deviation [µm]\n"
        + "\n".join(rows)
    )
    check(written(tmp_path, text), "X")


def test_positions_with_decimal_commas_in_the_order_of_time(tmp_path: Path) -> None:
    rows = [f"{t};{t + d:.6f}".replace(".", ",") for _, t, _, d in readings()]
    text = "Sollposition;Istposition\n" + "\n".join(rows) + "\n"
    file = written(tmp_path, text)
    check(file)
    assert "directions" in position_record(file).notes[0]


@pytest.mark.parametrize("places", [False, True])
def test_a_row_a_target(tmp_path: Path, places: bool) -> None:
    heads = ["Target", "1 up", "1 down", "2 up", "2 down"]
    lines = ["\t".join(heads)]
    for k, target in enumerate(TARGETS):
        cells = [rows[r, k] + (target if places else 0.0) for r in (0, 1) for rows in (UP, DOWN)]
        lines.append("\t".join(f"{c:.6f}" for c in [target, *cells]))
    check(written(tmp_path, "\n".join(lines)))


def rtl(change: tuple[str, str] = ("", "")) -> str:
    """A file as Renishaw's software for lasers writes it."""
    rows = []
    for run in range(4):
        values = (UP if run % 2 == 0 else DOWN)[run // 2]
        rows += [f"{run + 1:4d} {k + 1:4d} {values[k] * 1e3:10.3f}" for k in range(4)]
    text = (
        "HEADER::\nFile type: Linear\nVersion no: 1\nTARGET DATA::\nFiletype:ISO\n"
        "Target-count: 4\nTargets :\n  -50.0000    0.0000   25.0000\n  100.0000\nFlags:\n 0 0 0 0\n"
        "USER-TEXT::\nMachine:mill\nAxis:Y\nRUNS::\nRun-count: 4\nDEVIATIONS::\nRun Target Data:\n"
        + "\n".join(rows)
        + "\nENVIRONMENT::\nAir temperature: 20\nEOF::\n"
    )
    assert change[0] in text
    return text.replace(*change) if change[0] else text


def test_an_rtl_of_a_laser(tmp_path: Path) -> None:
    check(written(tmp_path, rtl(), "y.rtl"), "Y")


HEAD = "target,direction,deviation [um]\n"
GOOD = "".join(f"{t},{w},1\n" for t in (0, 10, 20) for w in "+-" for _ in range(2))


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (HEAD + GOOD + "10,sideways,2\n", "line 14: direction 'sideways'"),
        (HEAD + GOOD + "10,+,2,3\n", "line 14: 4 cells under 3 headings"),
        (HEAD + "0,+,x\n" + GOOD, "line 2: 'x' is no number"),
        (HEAD + "0,+,inf\n" + GOOD, "line 2: 'inf' is no finite number"),
        (HEAD + GOOD + "10,+,2\n", "target 10 mm is approached upwards 3 times, 2 as most"),
        (HEAD + GOOD.replace("20,-,1\n", "20,+,1\n"), "target 20 mm is approached"),
        (HEAD.replace("um", "furlong") + GOOD, "'furlong' is no length"),
        (HEAD.replace("[um]", "[mm]") + GOOD.replace(",1\n", ",12\n"), "line 2: 12 mm beside"),
        (HEAD + "0,+,1\n0,+,1\n0,-,1\n0,-,1\n", "1 targets, 3 at least"),
        ("place,error\n1,2\n", "or .rtl wanted; it begins with 'place,error'"),
        ("", "or .rtl wanted; nothing is in it"),
        (HEAD, "line 1: nothing below the headings"),
        ("target,first,second\n1,2,3\n", "line 1: heading 'first' says no direction"),
        (rtl(("   1    2", "   1    9")), "line 20: target 9 of 4"),
        (rtl(("   1    2      0.000", "   1    2")), "run, target, deviation wanted"),
        (rtl(("Run Target Data:", "Something else:")), "no rows below"),
    ],
)
def test_a_wrong_record_is_one_message(tmp_path: Path, text: str, told: str) -> None:
    with pytest.raises(InputError) as refused:
        position_record(written(tmp_path, text))
    assert told in str(refused.value) and "laser.csv" in str(refused.value)
    assert len(refused.value.args) == 1
