""",C and ,R between lines and arcs against what a chamfer and a rounded corner are."""

import math
import random

import numpy as np
import pytest
from compare import first
from second import Options

from motionfmu.analysis.gcode import read

FANUC = Options(fanuc=True)
ROOT2, ROOT35 = math.sqrt(2.0), math.sqrt(35.0)


def commands(text: str, **more: object) -> np.ndarray:
    program = first(text, Options(fanuc=True, **more))  # type: ignore[arg-type]
    assert program.faults == []
    return program.commands


@pytest.mark.parametrize(
    "text, ends",
    [
        ("X10 ,C2\nY10", [(8, 0), (10, 2), (10, 10)]),
        ("X10 ,R2\nY10", [(8, 0), (10, 2), (10, 10)]),
        # 45 degrees: the arc of radius 1 + sqrt 2 touches 1 away from the corner.
        (f"X10,R{1 + ROOT2}\nG91 X10 Y10", [(9, 0), (10 + ROOT2 / 2, ROOT2 / 2), (20, 10)]),
        (f"X10 , c {ROOT2}\n(behind)\n\nG91 X10 Y10", [(10 - ROOT2, 0), (11, 1), (20, 10)]),
        # One behind the other, the second within the rest of the first.
        ("X10,R2\nY10,C3\nX0", [(8, 0), (10, 2), (10, 7), (7, 10), (0, 10)]),
        # To the upper half of a circle of 5 about (15, 0): the arc lies above the line and outside.
        (
            "X10,R1\nG2 X20 I5",
            [(15 - ROOT35, 0), (15 - 5 / 6 * ROOT35, 5 / 6), (20, 0)],
        ),
        # What is smooth stays as it is, as does ,R0.
        ("X10,R1\nG3 X15 Y5 J5", [(10, 0), (15, 5)]),
        ("X10,R0\nY5", [(10, 0), (10, 5)]),
        # In inch, scaled twice, turned by 90 degrees.
        ("G20 X1,R.1\nY1", [(22.86, 0), (25.4, 2.54), (25.4, 25.4)]),
        ("G51 X0 Y0 P2.\nX10,R2\nY10", [(16, 0), (20, 4), (20, 20)]),
        ("G68 X0 Y0 R90\nX10,C2\nY10", [(0, 8), (-2, 10), (-10, 10)]),
    ],
)
def test_by_hand(text: str, ends: list[tuple[float, float]]) -> None:
    found = commands(f"G1 F600\n{text}\n")["end"][:, :2]
    assert found == pytest.approx(np.array(ends), abs=1e-9)


def test_feed_and_line_are_those_of_the_motion_in_front() -> None:
    c = commands("G1 F600 X10,R2\nY10 F300\n")
    assert c["feed"].tolist() == [10.0, 10.0, 5.0] and c["line"].tolist() == [1, 1, 2]


def test_with_compensation_the_contour_has_the_corner() -> None:
    """Outside a square with corners of 2 a cutter of 3 turns about them with 5."""
    text = "G1 F600 X-10 Y0\nG42.1 D6 X0\nX20,R2\nY10\nG40\n"
    arcs = (c := commands(text))[c["arc"]]
    assert arcs["radius"] == pytest.approx([5.0])
    assert arcs["centre"] == pytest.approx(np.array([[18.0, 2.0]]))


def test_planes_have_theirs() -> None:
    c = commands("G18 G1 F600\nZ10,R2\nX10\n")
    assert c["end"][:, [0, 2]].tolist() == [[0.0, 8.0], [2.0, 10.0], [10.0, 10.0]]


class Chain:
    """A random way of lines and arcs whose corners have room; its words and its motions."""

    def __init__(self, seed: int) -> None:
        r = random.Random(seed)
        self.lines, self.at, heading = ["G1 F600"], complex(0, 0), r.uniform(0, math.tau)
        self.shapes: list[tuple[complex, complex, complex | None]] = []
        for i in range(6):
            heading += r.choice((-1, 1)) * r.uniform(0.35, 1.9)
            start, size = self.at, r.uniform(20.0, 40.0)
            word = f",{r.choice('CR')}{r.uniform(0.5, 2.0):.3f}" if i < 5 else ""
            if r.random() < 0.5:
                self.at = start + size * np.exp(1j * heading)
                self.to(f"G1 {self.xy()} {word}", start, None)
                continue
            ccw, sweep = r.random() < 0.5, r.uniform(0.8, 4.0)
            turn = 1.0 if ccw else -1.0
            centre = start + turn * 1j * size * np.exp(1j * heading)
            self.at = centre + (start - centre) * np.exp(1j * turn * sweep)
            ij = f"I{(centre - start).real:.12f} J{(centre - start).imag:.12f}"
            self.to(f"G{3 if ccw else 2} {self.xy()} {ij} {word}", start, centre)
            heading += turn * sweep

    def xy(self) -> str:
        return f"X{self.at.real:.12f} Y{self.at.imag:.12f}"

    def to(self, line: str, start: complex, centre: complex | None) -> None:
        self.lines.append(line.strip())
        self.shapes.append((start, self.at, centre))


def direction(c: np.void, end: bool) -> complex:
    """Unit vector along a motion at its start or end."""
    a, b = complex(*c["start"][:2]), complex(*c["end"][:2])
    if not c["arc"]:
        return (b - a) / abs(b - a)
    away = (b if end else a) - complex(*c["centre"])
    return math.copysign(1.0, c["sweep"]) * 1j * away / abs(away)


@pytest.mark.parametrize("seed", range(60))
def test_random_corners(seed: int) -> None:
    """Each lies between its motions: an arc of R touches both, a chamfer ends C from the corner."""
    chain = Chain(seed)
    c = read("\n".join(chain.lines) + "\n", fanuc=True, max_feed=1e9, speed=1e9).commands
    assert len(c) == 11
    for i in range(1, 11):
        assert c[i]["start"] == pytest.approx(c[i - 1]["end"], abs=1e-9)
    for i, (start, end, centre) in enumerate(chain.shapes):
        kept, corner = c[2 * i], c[2 * i + 1] if i < 5 else None
        for place in (complex(*kept["start"][:2]), complex(*kept["end"][:2])):
            if centre is None:
                off = ((place - start) / (end - start)).imag * abs(end - start)
            else:
                off = abs(place - centre) - abs(start - centre)
            assert off == pytest.approx(0.0, abs=1e-8)
        if centre is None:
            along = (complex(*kept["end"][:2]) - complex(*kept["start"][:2])) / (end - start)
            assert 0.0 < along.real <= 1.0
        else:
            assert bool(kept["arc"]) and 0.0 < abs(kept["sweep"]) <= 4.0 + 1e-9
        if corner is None:
            continue
        word = chain.lines[i + 1].split(",")[1]
        size = float(word[1:])
        assert corner["line"] == kept["line"]
        if word[0] == "C":
            for place in (corner["start"], corner["end"]):
                assert abs(complex(*place[:2]) - end) == pytest.approx(size, abs=1e-8)
            continue
        assert bool(corner["arc"]) and corner["radius"] == pytest.approx(size, abs=1e-8)
        assert abs(corner["sweep"]) < math.pi
        for one, other in ((kept, corner), (corner, c[2 * i + 2])):
            assert abs(direction(one, True) - direction(other, False)) < 1e-7


@pytest.mark.parametrize(
    "lines, why",
    [
        ("X10,R1\nM30", "line 2: ,C and ,R are between two lines or arcs in the plane that follow"),
        ("X10,R1 M30", "line 2: ,C and ,R are between two"),
        ("X10,R1", "line 2: ,C and ,R are between two"),
        ("X10,R1 M0\nY1", "line 2: ,C and ,R are between two"),
        ("X10,R1\nM8\nY5", "line 2: ,C and ,R are between two"),
        ("X10,R1\nM8 Y5", "line 2: ,C and ,R are between two"),
        ("X10,R1\nG4 P1\nY5", "line 2: ,C and ,R are between two"),
        ("X10,R1\nG0 Y5", "line 2: ,C and ,R are between two"),
        ("X10,R1\nZ5", "line 2: ,C and ,R are between two"),
        ("X10,R1\nG81 Z-5 R0", "line 2: ,C and ,R are between two"),
        ("X10,R1\nG28 Y1", "line 2: ,C and ,R are between two"),
        ("X10,R1\nG41.1 D2 Y5\nX0", "line 2: ,C and ,R are between two"),
        ("X10,R1\nM66 P1 L0\nY5", "line 2: ,C and ,R are between two"),
        ("Z10,R1\nY5", "line 2: ,C and ,R are between two"),
        ("X10,R11\nY20", "line 2: no room for ,C or ,R between the motions"),
        ("X10,R6\nY5", "line 2: no room"),
        ("X10,C6\nY5", "line 2: no room"),
        ("X10,R1\nX0", "line 2: no room"),
        ("X10,R3\nG3 X6 Y0 I-2", "line 2: no room"),
        ("X10,C5\nG2 X14 Y0 I2", "line 2: no room"),
        ("X10,R6\nY10,R6\nX0", "line 3: no room"),
        (",R1", 'line 2: word has no use in this line ",R1"'),
        ("X0 ,R1", 'line 2: no room for ,C or ,R between the motions ",R1"'),
        ("G0 X5 ,R1", 'line 2: word has no use in this line ",R1"'),
        ("X5 ,R1 ,C2", 'line 2: word has no use in this line ",R1"'),
        ("X5 ,R1 ,R2", 'line 2: word given twice ",R2"'),
        ("X5 ,R-1", 'line 2: value out of range ",R-1"'),
        ("X5 ,A1", 'line 2: unknown word ",A"'),
    ],
)
def test_what_is_wrong_is_told(lines: str, why: str) -> None:
    assert str(first(f"G1 F600\n{lines}\n", FANUC).faults[0]).startswith(why)


def test_without_fanuc_there_are_none() -> None:
    assert str(read("G1 X5 ,R1\nY5\n").faults[0]).startswith('line 1: unexpected character ","')
