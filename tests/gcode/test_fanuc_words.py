"""Words of Fanuc's and Haas' controls: G9, dwells in cycles, G54.1, modal macros."""

import numpy as np
import pytest
from compare import difference, first
from second import Options

from motionfmu.analysis.gcode import read

FANUC = Options(fanuc=True)


def ends(text: str) -> list[list[float]]:
    """X Y Z of all ends; both interpreters agree."""
    assert difference(text, FANUC) == ""
    program = first(text, FANUC)
    assert program.faults == []
    c = program.commands
    return c["end"][c["type"] < 6, :3].tolist()


def test_g9_rests_at_the_end_of_its_line_alone() -> None:
    """The way from one corner to the next is passed at speed, with G9 at rest."""
    text = "G64 P0.05\nG1 X10 F3000\n{}Y10\nX20\n"
    for words, corners in (("", 0), ("G9 ", 1)):
        assert difference(text.format(words), FANUC) == ""
        program = read(text.format(words), fanuc=True)
        places = program.places()[:, :2]
        speed = np.linalg.norm(np.diff(places, axis=0), axis=1) * 1e3
        near = np.linalg.norm(places[:-1] - [10.0, 10.0], axis=1) < 1.0
        assert bool(speed[near].min() < 1.0) == bool(corners)
        first_corner = np.linalg.norm(places[:-1] - [10.0, 0.0], axis=1) < 1.0
        assert speed[first_corner].min() > 1.0


@pytest.mark.parametrize(
    "line, seconds",
    [
        ("G83 X0 Y0 Z-8 R1 Q3 P500", [0.5]),
        ("G73 X0 Y0 Z-8 R1 Q3 P0.25", [0.25]),
        ("G83 X0 Y0 Z-8 R1 Q3", []),
        ("G82 X0 Y0 Z-8 R1 P1500\nG83 X1 Z-8 R1 Q3\nX2\nG83 X3 P100\nX4", [1.5, 0.1, 0.1]),
        ("G89 X0 Y0 Z-8 R1 P2.", [2.0]),
    ],
)
def test_dwells_at_the_bottom(line: str, seconds: list[float]) -> None:
    """A whole P counts milliseconds, and pecks have one, too: behind the last, at the bottom."""
    text = f"G0 Z5\nG99 F600 {line}\n"
    assert difference(text, FANUC) == ""
    program = first(text, FANUC)
    assert not program.faults
    c = program.commands
    at = np.flatnonzero(c["type"] == 6)
    assert c["dwell"][at].tolist() == pytest.approx(seconds)
    assert (c["end"][at - 1, 2] == -8.0).all()


def test_without_fanuc_pecks_have_no_dwell_and_p_counts_seconds() -> None:
    assert "no use" in str(first("G0 Z5\nG83 X0 Y0 Z-8 R1 Q3 P5 F60\n").faults[0])
    c = first("G0 Z5\nG82 X1 Y0 Z-8 R1 P5 F60\n").commands
    assert c["dwell"][c["type"] == 6].tolist() == [5.0]
    for word in ("G9 G1 X1", "G54.1 P1", "G154 P1", "G67"):
        assert str(first(f"{word}\n").faults[0]).startswith("line 1: unknown word")


def test_further_origins() -> None:
    """G10 L20 sets one, G54.1 or Haas' G154 takes it; its numbers tell it."""
    text = (
        "G1 F600\nG10 L20 P1 X10 Y20 Z1\nG10 L20 P48 X100\nG20\nG10 L20 P99 Y1\n"
        "G21\nG54.1 P1 X1 Y1\nG54.1 P48 X2\nG154 P99 Y3\nG54.1 P7 X5 Y5\n"
        "G54 X0 Y0\nX[#7001+#7022] Y#7002\nX#7941 Y#15962\nX#14941 Z#14003\n"
    )
    assert ends(text) == [
        [11.0, 21.0, 0.0],
        [102.0, 21.0, 0.0],
        [102.0, 28.4, 0.0],
        [5.0, 5.0, 0.0],
        [0.0, 0.0, 0.0],
        [10.0, 20.0, 0.0],
        [100.0, 25.4, 0.0],
        [100.0, 25.4, 1.0],
    ]


def test_where_the_axes_stand_is_known_by_fanucs_numbers() -> None:
    text = "G1 F600\nG10 L2 P1 X10\nG54 X1 Y2 Z3\nX[#5001+1] Y#5042 Z[#5003*2]\n"
    assert ends(text) == [[11.0, 2.0, 3.0], [12.0, 2.0, 6.0]]


def test_a_modal_macro_is_called_behind_each_line_that_moves() -> None:
    """Two depths at each of three places, none behind what does not move, none behind G67."""
    text = (
        "G1 F600\nG66 P100 Z-2 R1\nX10\nM8\nG91 X10\nG90\nG4 P5\nG52 X0\n#20=3\nY5\nG67\nX0\nM30\n"
        "O100\nG90 Z#18\nM98 P200\n#26=9\nM99\nO200\nZ#26\nZ1\nM99\n"
    )
    way = [[10.0, 0.0, 0.0], [10.0, 0.0, 1.0], [10.0, 0.0, -2.0], [10.0, 0.0, 1.0]]
    for x, y in ((20.0, 0.0), (20.0, 5.0)):
        way += [[x, y, 1.0], [x, y, -2.0], [x, y, 1.0]]
    assert ends(text) == [*way, [0.0, 5.0, 1.0]]


@pytest.mark.parametrize(
    "lines, why",
    [
        ("G54.1 X1", 'line 2: a word is missing that goes with "G54.1"'),
        ("G54.1 P0", 'line 2: value out of range "P0"'),
        ("G154 P100", 'line 2: value out of range "P100"'),
        ("G10 L20 P0 X1", 'line 2: value out of range "P0"'),
        ("G10 L20 P1 X1 R5", 'line 2: word has no use in this line "R5"'),
        ("X#14941 Y#15988", "line 2: no such parameter"),
        ("G66 P7", "line 2: no such subprogram"),
        ("G66 X1", 'line 2: no such subprogram "G66"'),
        ("G66 P5\nG66 P5", "line 3: not while G66 is in force"),
        ("G66 P5\nG81 X1 Z-1 R1", "line 3: not while G66 is in force"),
        ("G9 G9", "line 2: second word of one modal group"),
        ("G81 X0 Z-1 R1 P100", 'line 2: word has no use in this line "P100"'),
    ],
)
def test_what_is_wrong_is_told(lines: str, why: str) -> None:
    text = f"G1 F600 Z5\n{lines}\nM30\nO5\nM99\n"
    assert str(first(text, FANUC).faults[0]).startswith(why)
