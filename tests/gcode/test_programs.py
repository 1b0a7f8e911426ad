"""Both interpreters make the same of part programs; what was accepted once still is.

More: python tests/gcode/random_programs.py --count 20000
"""

from pathlib import Path

import pytest
from compare import difference, first, mark, of_c, of_python, programs
from conftest import ROOT
from random_lines import TOOLS
from random_programs import Writer, each, options
from second import Options, run

from motionfmu.analysis.gcode import read

SCENARIOS = sorted(ROOT.glob("scenarios/*/*.ngc"))
RANDOM = 150
# Files, commands, length of the way [mm] and `mark` before the words of the standard came in.
# One is left out: in it G52 and G92 had shifts of their own.
ACCEPTED = (Path(__file__).parent / "accepted.txt").read_text().splitlines()


@pytest.mark.parametrize(
    "file", [*SCENARIOS, *programs()], ids=lambda f: f"{f.parent.name}-{f.stem}"
)
def test_both_read_a_program_the_same(file: Path) -> None:
    given = Options(tools=dict(TOOLS))
    assert difference(file.read_text(), given) == ""
    assert bool(first(file.read_text(), given).faults) == (file.stem == "wrong_behind")


def test_both_read_random_programs_the_same() -> None:
    found = {seed: difference(text, options(seed)) for seed, text in each(RANDOM)}
    assert {seed: how for seed, how in found.items() if how} == {}


def test_random_programs_are_worth_reading() -> None:
    made = [run(text, options(seed)) for seed, text in each(RANDOM)]
    kinds = {step.kind for steps, _ in made for step in steps}
    assert kinds == {"rapid", "line", "arc", "spline", "nurbs", "dwell", "outputs", "stop", "tool"}
    assert sum(refused is not None for _, refused in made) < 0.15 * RANDOM
    assert sum(len(steps) for steps, _ in made) > 20 * RANDOM
    assert Writer(5).program() == Writer(5).program() != Writer(6).program()


@pytest.mark.parametrize(
    "one, other",
    [
        ("G1 X1 F60", "G1 X1.00001 F60"),
        ("G1 X1 F60", "G1 X1 F60.001"),
        ("G1 X1 F60", "G0 X1"),
        ("G2 X2 R2", "G2 X2 R-2"),
        ("G2 X2 I1", "G3 X2 I1"),
        ("M64 P1\nG0 X1", "M64 P2\nG0 X1"),
        ("M62 P1\nG0 X1", "G0 X1"),
        ("S5 M3\nG0 X1", "S5 M4\nG0 X1"),
        ("M7\nG0 X1", "M8\nG0 X1"),
        ("G4 P1", "G4 P1.1"),
        ("T1 M6", "T2 M6"),
        ("G5.1 X2 I1 J1", "G5.1 X2 I1 J1.1"),
        ("G5.2\nX2 Y1\nX4 Y0\nG5.3", "G5.2\nX2 Y1.001\nX4 Y0\nG5.3"),
        ("G5.2\nX2 Y1\nX4 Y0\nG5.3", "G5.2\nX2 Y1 P1.001\nX4 Y0\nG5.3"),
        ("G5.2\nX2 Y1\nX4 Y0\nG5.3", "G5.2\nX2 Y1\nX4 Y0 F61\nG5.3"),
        ("G1 X1", "G1 X1\nM0"),
    ],
)
def test_the_comparison_can_fail(one: str, other: str) -> None:
    from compare import _events

    a, b = of_c(first(one)), of_python(run(other)[0])
    assert _events(a, of_python(run(one)[0])) == ""
    assert _events(a, b) != ""


@pytest.mark.parametrize("row", ACCEPTED, ids=lambda r: r.split()[0].replace("/", "-"))
def test_what_was_accepted_is_so_still_with_the_same_commands(row: str) -> None:
    name, count, way, sum_ = row.split()
    text = (ROOT / name).read_bytes().decode(errors="replace")
    program = read(text, max_feed=1e9, speed=1e9)
    assert not program.faults
    c = program.commands
    assert len(c) == int(count)
    lasts = (c["type"] <= 6) | (c["type"] >= 13)
    assert c["length"][lasts].sum() == pytest.approx(float(way), rel=1e-9, abs=1e-9)
    assert mark(c) == pytest.approx(float(sum_), rel=1e-9)
