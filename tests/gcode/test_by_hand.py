"""Paths of part programs against geometry worked out by hand."""

import math

import numpy as np
import pytest

from motionfmu.gcode import Program, read

ROOT2, ROOT3 = math.sqrt(2.0), math.sqrt(3.0)
TOOLS = "T1 P1 Z10 D6\nT2 P2 Z20 D8\n"


def ends(text: str, **settings: float) -> np.ndarray:
    """X Y Z at the end of each move."""
    program = good(text, **settings)
    c = program.commands
    return c["end"][((c["type"] <= 5) | (c["type"] == 14)), :3]


def good(text: str, **settings: float) -> Program:
    """A program without faults."""
    program = read(text, TOOLS, **settings)
    assert program.faults == []
    return program


@pytest.mark.parametrize(
    "text, path",
    [
        # A square of side 2 turned by 45 degrees about its corner.
        (
            "G68 X0 Y0 R45\nG1 X2\nY2\nX0\nY0",
            [(ROOT2, ROOT2, 0), (0, 2 * ROOT2, 0), (-ROOT2, ROOT2, 0), (0, 0, 0)],
        ),
        # Twice as large about (1, 1): (3, 1) lies 2 beside it and comes to 4.
        ("G51 X1 Y1 P2\nG1 X3 Y1", [(5, 1, 0)]),
        # Six holes' angles: radius 10 every 60 degrees.
        ("G1 @10 ^60\n^120", [(5, 5 * ROOT3, 0), (-5, 5 * ROOT3, 0)]),
        # Length 10 of tool 1 lifts what the program calls Z5.
        ("T1 M6\nG43\nG1 Z5\nG49\nZ4", [(0, 0, 15), (0, 0, 4)]),
        # The origin of G55 and a local one.
        ("G10 L2 P2 X10 Y20\nG55 G1 X1 Y1\nG52 X5\nX1", [(11, 21, 0), (16, 21, 0)]),
        # Here is to be X1 in the third system: its origin is 6.
        ("G1 X7\nG10 L20 P3 X1\nG56 X0", [(7, 0, 0), (6, 0, 0)]),
        # A system turned by 90 degrees about its origin (10, 0).
        ("G10 L2 P1 X10 R90\nG1 X3 Y1", [(9, 3, 0)]),
        # Factorial of 4 by a sub that calls itself.
        (
            "o1 sub\no2 if [#1 LE 1]\no1 return [1]\no2 endif\no1 call [#1-1]\n"
            "o1 endsub [#1*#<_value>]\no1 call [4]\nG1 X#<_value>\nM2",
            [(24, 0, 0)],
        ),
        # Fibonacci's numbers: 1 1 2 3 5 8.
        (
            "#1=0 #2=1\no1 repeat [5]\n#3=[#1+#2]\n#1=#2\n#2=#3\nG1 X#2\no1 endrepeat",
            [(1, 0, 0), (2, 0, 0), (3, 0, 0), (5, 0, 0), (8, 0, 0)],
        ),
        # A hole 8 deep in steps of 3: down, out, back to 0.254 above, and so on.
        (
            "G0 Z5\nG99 G83 X0 Y0 Z-8 R0 Q3",
            [
                *((0, 0, z) for z in (5, 0, -3, 0, -2.746, -6, 0, -5.746, -8, 0)),
            ],
        ),
    ],
)
def test_ends(text: str, path: list[tuple[float, float, float]]) -> None:
    assert ends(text) == pytest.approx(np.array(path), abs=1e-12)


def test_a_rectangle_with_a_cutter_outside_has_quarter_circles_at_its_corners() -> None:
    """Its radius is 3, and three of the corners are passed."""
    text = "G1 X-10 Y0\nG42 D1 G1 X0 Y0\nX20\nY10\nX0\nY-10\nG40"
    c = good("T1 M6\n" + text).commands
    arcs = c[c["arc"]]
    assert arcs["length"] == pytest.approx([3.0 * math.pi / 2.0] * 3)
    assert arcs["centre"] == pytest.approx(np.array([[20, 0], [20, 10], [0, 10]]))
    # Beside X0, going down, the tool is to the right: at X-3.
    assert c["end"][-1, :2] == pytest.approx([-3.0, -10.0])


def test_a_cutter_inside_a_corner_goes_to_the_crossing() -> None:
    c = good("G41.1 D4 G1 X10 Y5\nX20\nY15\nG40").commands
    assert c["end"][:, :2].tolist()[-2:] == [[18.0, 7.0], [18.0, 15.0]]


def test_feed_of_inverse_time_is_that_of_the_whole_way() -> None:
    """10 mm in half a minute; a quarter of a circle of radius 10 in 6 s."""
    c = good("G93 G1 X10 F2\nG3 X20 Y10 J10 F10").commands
    assert c["feed"] == pytest.approx([10.0 / 30.0, 5.0 * math.pi / 6.0])
    c = good("S300 M3\nG95 F0.2 G1 X10").commands
    assert c["feed"][-1] == pytest.approx(1.0)


def test_a_parabola() -> None:
    """G5.1 from (-2, 4) over (0, -4) to (2, 4) is y = x^2; its length in closed form."""
    program = good("G0 X-2 Y4\nG5.1 X2 I2 J-8")
    way = program.commands[-1]
    t = 4.0
    length = 2.0 * (t * math.sqrt(1.0 + t**2) + math.asinh(t)) / 4.0
    assert way["length"] == pytest.approx(length, rel=1e-12)
    from motionfmu.gcode import strokes

    points = next(s for s in strokes(program) if not s.rapid).points
    assert points[:, 1] == pytest.approx(points[:, 0] ** 2, abs=1e-9)


def test_times_are_those_of_trapezia() -> None:
    """1000 mm/s^2 to 50 mm/s takes 50 ms each way: 100 mm in 2.05 s; two with a stop in twice."""
    for text, seconds in (("G1 X100 F3000", 2.05), ("G1 X100 F3000\nX0", 4.1)):
        assert good(text).seconds().sum() == pytest.approx(seconds, abs=2e-3)
    assert good("G4 P1.5\nG4 P2").seconds().sum() == pytest.approx(3.5, abs=2e-3)


def test_places_are_those_of_the_axes_within_their_limits() -> None:
    """A diagonal of 60 and 80 mm: the quicker axis has its 1000 mm/s^2, the path 1250."""
    text = "G64 P0.01\nG1 X60 Y80 F6000"
    program = read(text, axis_acc=[1000.0] * 6, max_feed=6000.0)
    places, times = program.places(), program.seconds()
    assert times.sum() == pytest.approx(1.0 + 100.0 / 1250.0, abs=2e-3)
    assert len(places) * 1e-3 == pytest.approx(times.sum(), abs=1.001e-3)
    assert places[-1][:2] == pytest.approx([60.0, 80.0], abs=1e-9)
    change = np.diff(places[:, :2], 2, axis=0).max(axis=0) * 1e6
    assert change == pytest.approx([750.0, 1000.0], rel=1e-6)
