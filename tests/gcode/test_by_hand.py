"""Paths of part programs against geometry worked out by hand."""

import math
from pathlib import Path

import numpy as np
import pytest
from compare import difference, first
from second import Options

from motionfmu.analysis.gcode import Program, read

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
        # Numbers as programs print them: 0.1 + 0.2, and 0.1 as it is in a double.
        (
            "G1 X0.30000000000000004 Y0.1000000000000000055511151231257827021181583404541015625",
            [(0.1 + 0.2, 0.1, 0)],
        ),
        # G28 beside the motion that holds from the next line on; what a dwell leaves; K in XY.
        ("G0 Z5\nG1 X2\nG0 G91 G28 Z0\nX3", [(0, 0, 5), (2, 0, 5), (2, 0, 0), (5, 0, 0)]),
        ("G4 P.1 G0 X1 Y1\nG4 P.1 X2", [(1, 1, 0), (2, 1, 0)]),
        ("G2 X10 I5 J0 K0.000\nX0 R5 K0.", [(10, 0, 0), (0, 0, 0)]),
        # The return of an if, and a comment between the values of a call.
        (
            "o1 sub\no2 if [#1 GT 0]\nG1 X#1\no2 return\no2 endif\nG1 Y#2\no1 endsub\n"
            "o1 call [4] (a comment) [5]\no1 call [-4] (one)[6]\nM2",
            [(4, 0, 0), (4, 6, 0)],
        ),
        # Halves are rounded away from 0.
        ("G1 X[ROUND[-2.5]] Y[ROUND[2.5]] Z[ROUND[-2.4]]", [(-3, 3, -2)]),
        ("G1 X[ROUND[0.5]] Y[ROUND[-0.5]] Z[ROUND[-3.5]]", [(1, -1, -4)]),
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
        # Modes that a sub changes come back with it, motion and place do not.
        (
            "o1 sub\nM73\nG20 G91 G1 F5\nX0.1\no1 endsub\nG90 G1 X1\no1 call\nY1\n"
            "M70\nG20 G91 X1\nM72\nX2",
            [(1, 0, 0), (3.54, 0, 0), (3.54, 1, 0), (28.94, 1, 0), (2, 1, 0)],
        ),
        # The spindle's thread, and back to where it began.
        ("S60 M3\nG0 X1 Z2\nG33.1 Z-5 K0.5\nG0 Z4", [(1, 0, 2), (1, 0, -5), (1, 0, 2), (1, 0, 4)]),
        # What prepares a loop of probing is set like any parameter.
        (
            "#5070 = 3\n#5061 = 2.5\nG1 X[#5070 + #5061]\n#5599 = -2\nX#5599",
            [(5.5, 0, 0), (-2, 0, 0)],
        ),
        # A hole 8 deep in steps of 3: down, out, back to 0.254 above, and so on.
        (
            "G0 Z5\nG99 G83 X0 Y0 Z-8 R0 Q3",
            [
                *((0, 0, z) for z in (5, 0, -3, 0, -2.746, -6, 0, -5.746, -8, 0)),
            ],
        ),
        # With G91 R lies 18 below where the series began, at 2, for each of its holes.
        (
            "G0 Z20\nG91 G99 G81 X10 R-18 Z-12\nX10\nX10",
            [
                *((0, 0, 20), (10, 0, 20), (10, 0, 2), (10, 0, -10), (10, 0, 2)),
                *((20, 0, 2), (20, 0, -10), (20, 0, 2), (30, 0, 2), (30, 0, -10), (30, 0, 2)),
            ],
        ),
        # Three holes on a circle of 10, each 60 degrees on, by ^ and by G16.
        *(
            (
                f"G0 X10 Z1\n{words}",
                [
                    (10, 0, 1),
                    *((5, 5 * ROOT3, 1), (5, 5 * ROOT3, -1), (5, 5 * ROOT3, 1)),
                    *((-5, 5 * ROOT3, 1), (-5, 5 * ROOT3, -1), (-5, 5 * ROOT3, 1)),
                    *((-10, 0, 1), (-10, 0, -1), (-10, 0, 1)),
                ],
            )
            for words in ("G91 G99 G81 ^60 Z-2 R0 L3", "G16 G91 G99 G81 Y60 Z-2 R0 L3")
        ),
        # Radius 1 at 90 degrees from each hole to the next.
        (
            "G0 X10 Z1\nG16 G91 G99 G81 X1 Y90 Z-2 R0 L2",
            [(10, 0, 1), (10, 1, 1), (10, 1, -1), (10, 1, 1), (9, 1, 1), (9, 1, -1), (9, 1, 1)],
        ),
    ],
)
def test_ends(text: str, path: list[tuple[float, float, float]]) -> None:
    assert ends(text) == pytest.approx(np.array(path), abs=1e-12)


@pytest.mark.parametrize(
    "text, end",
    [
        # The contour ends at (40, 0) and the cutter stands at (40, 3): rs274 has these ends.
        ("G92 Y0\nG1 Y7", (40, 7)),
        ("G92 X0 Y0\nG92.1\nG1 X5", (5, 0)),
        ("G10 L20 P1 X0 Y0\nG1 X5 Y7", (45, 7)),
        ("G28.1\nG0 X5 Y5\nG28", (40, 0)),
        ("#1=#5420 #2=#5421\nG1 X50 Y20\nX#1 Y#2", (40, 0)),
        ("#1=#<_x> #2=#<_abs_y>\nG1 X50 Y20\nX#1 Y#2", (40, 0)),
        ("G68 R90\nG1 X45", (40, 5)),
        ("G51 P2\nG1 X45", (50, 0)),
        ("G16 Y90", (0, 40)),
        # Not behind a motion in the plane, by which the tool has left the contour.
        ("G1 X45\n#1=#5421\nG1 Y5\nY[#1+1]", (45, 1)),
        ("G91 G1 Z1\nG92 Y0\nG90 G1 Y7", (40, 7)),
    ],
)
def test_behind_g40_all_counts_from_the_end_of_the_contour(
    text: str, end: tuple[float, float]
) -> None:
    text = f"T1 M6\nG1 X0 Y0 F600\nG41 X20\nX40\nG40\n{text}\n"
    assert difference(text, Options(tools={1: (0.0, 6.0)})) == ""
    assert good(text).commands["end"][-1, :2] == pytest.approx(end, abs=1e-9)


def test_a_tool_is_measured_at_the_end_of_the_contour() -> None:
    """There, at Y0, its tip is to be Y1: it is 1 shorter, and Y1 is where the contour ended."""
    c = good("T1 M6\nG1 F600\nG41 X20\nX40\nG40\nG10 L10 P1 Y1\nG43 H1\nG1 Y1").commands
    assert c["end"][-1, :2] == pytest.approx([40.0, 0.0], abs=1e-9)


@pytest.mark.parametrize(
    "text, why",
    [
        ("M72", "line 1: no M70 or M73 in this call before"),
        ("M70\nM71\nM72", "line 3: no M70 or M73 in this call before"),
        ("o1 sub\nM72\no1 endsub\nM70\no1 call", "line 2: no M70 or M73 in this call"),
        ("M70\nG41 D1\nM72", "line 3: cutter compensation, G51 or G68 allow no change"),
        ("M70\nG18\nG68 R5\nM72", "line 4: cutter compensation, G51 or G68"),
        ("S9 M3\nG33.1 Z1", "line 2: G33.1 without K, the way of a turn"),
        ("G33.1 Z1 K1", "line 1: the spindle does not turn as this cycle needs"),
        ("S9 M3\nG33.1 K1", "line 2: no axis word"),
        ("S9 M3\nG33.1 Z1 K-1", 'line 2: value out of range "K-1"'),
        ("S9 M3\nG33.1 Z1 K1 J1", 'line 2: word has no use in this line "J1"'),
        ("M70 M72", "line 1: second word of one modal group"),
    ],
)
def test_wrong_words_are_told(text: str, why: str) -> None:
    assert str(read(text + "\n", TOOLS).faults[0]).startswith(why)


def test_a_thread_is_cut_by_the_spindle() -> None:
    """0.5 mm a turn at 60 rpm, and back twice as fast with the spindle the other way."""
    c = good("S60 M3\nG33.1 Z-5 K0.5 I2").commands
    outputs, moves = c[c["type"] == 11], c[c["type"] == 1]
    assert outputs["spindle"].tolist() == [60.0, 60.0, -120.0, 60.0]
    assert outputs["overrides"].tolist() == [0, 3, 3, 0]
    assert moves["feed"].tolist() == [0.5, 1.0] and moves["length"].tolist() == [5.0, 5.0]


def test_saved_modes_bring_back_speeds_and_switches() -> None:
    text = "F300 S400 M4 M8 M49\nM70\nG95 F0.1 S9 M5 M9 M48\nM72\nG1 X10"
    c = good(text).commands
    assert c["feed"][-1] == 5.0
    last = c[c["type"] == 11][-1]
    assert (last["spindle"], last["coolant"], last["overrides"]) == (-400.0, 2, 3)


def test_a_debug_comment_is_no_note_when_it_is_switched_off() -> None:
    assert len(read("(DEBUG, one)\n").notes) == 1
    assert read("#5599 = 0\n(DEBUG, none)\n").notes == []


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
    from motionfmu.analysis.gcode import strokes

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


def test_a_file_is_read_whatever_its_length(tmp_path: Path) -> None:
    """More than a mebibyte, which is the limit of the TOML files of this project."""
    file = tmp_path / "long.ngc"
    file.write_text("G1 X1 F600\nX0\n" * 90_000 + "X7\n(Gr\xf6\xdfe)\n", encoding="latin-1")
    assert file.stat().st_size > 1 << 20
    assert read(file).commands["end"][-1, 0] == 7.0


@pytest.mark.parametrize("move", ["G0 X120 Y30", "G1 X120 Y30 F9000", "G0 X-2 Y40", "G0 X0.2 Y0.1"])
def test_axes_keep_their_limits_in_single_motions(move: str) -> None:
    """Without `jerk`, too: differences of places over 1 ms, which can exceed no derivative."""
    acc, jerk = np.array([900.0, 700.0]), np.array([20_000.0, 8_000.0])
    limits = {"axis_acc": [*acc, 0, 0, 0, 0], "axis_jerk": [*jerk, 0, 0, 0, 0]}
    places = read(f"{move}\nG4 P0.1\nG0 X0 Y0", **limits).places()[:, :2]
    places = np.vstack([np.zeros((4, 2)), places])
    second, third = (np.abs(np.diff(places, n, axis=0)).max(axis=0) * 1e3**n for n in (2, 3))
    assert (second <= acc * (1.0 + 1e-6)).all() and (third <= jerk * (1.0 + 1e-6)).all()
    assert (third / jerk).max() > 0.99


def test_programs_have_a_colon_before_their_numbers_with_fanuc() -> None:
    text = ":97\nG1 X1 F600\nM98 P100\nM30\n:100\nG1 Y2\nM99\n"
    options = Options(fanuc=True)
    assert difference(text, options) == ""
    assert first(text, options).commands["end"][:, :2].tolist() == [[1.0, 0.0], [1.0, 2.0]]
    assert str(read(text).faults[0]) == 'line 1: unexpected character ":", column 1'


@pytest.mark.parametrize("angles, others", [(False, "ABC"), (True, "UVW")])
def test_nine_letters_at_once(angles: bool, others: str) -> None:
    """The machine has six axes; the other three stand at 0."""
    own = "ABC" if angles else "UVW"
    text = f"G1 X1 Y2 Z3 {own[0]}4 {own[1]}5 {own[2]}6 {others[0]}0 {others[1]}0 {others[2]}0 F60\n"
    options = Options(angles=angles)
    assert difference(text, options) == ""
    assert first(text, options).commands["end"].tolist() == [[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]]
    moved = text.replace(f"{others[2]}0", f"{others[2]}1")
    assert difference(moved, options) == "" and first(moved, options).faults
