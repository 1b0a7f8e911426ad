"""IF, GOTO, WHILE, DO and END as Fanuc's and Haas' controls have them, with `fanuc`."""

import pytest
from compare import difference, first
from second import Options

from motionfmu.analysis.gcode import read

FANUC = Options(fanuc=True)


def ways(text: str) -> list[float]:
    """X of all ends; both interpreters agree."""
    assert difference(text, FANUC) == ""
    return list(first(text, FANUC).commands["end"][:, 0])


def test_a_row_of_holes() -> None:
    """Holes at 10, 20, .. until the counter is beyond #2: a loop by GOTO and one by WHILE."""
    head = "O0001 (ROW)\nG90 G1 F600\n#1=0\n#2=5\n"
    jump = "N10 IF [#1 GE #2] GOTO 90\n#1=#1+1\nX[#1*10]\nGOTO 10\nN90 M30\n"
    loop = "WHILE [#1 LT #2] DO1\n#1=#1+1\nX[#1*10]\nEND1\nM30\n"
    assert ways(head + jump) == ways(head + loop) == [10.0, 20.0, 30.0, 40.0, 50.0]


def test_a_jump_stays_in_its_program() -> None:
    """The same N is in the main program and in the one it calls; forward comes before the start."""
    text = "O1\nG1 F600\nN5 X1\nM98 P2\nGOTO 5\nX8\nN5 X9\nM30\nO2\nGOTO 5\nX7\nN5 X2\nM99\n"
    assert ways(text) == [1.0, 2.0, 9.0]


def test_a_jump_back_leaves_loops() -> None:
    """The loop that it left begins anew, as one and not within itself."""
    text = "G1 F600\n#1=0\nN1 #1=#1+1\nIF [#1 GT 4] GOTO 9\nDO1\nX#1\nGOTO 1\nEND1\nN9 X20\nM30\n"
    assert ways(text) == [1.0, 2.0, 3.0, 4.0, 20.0]


def test_a_switched_block_has_its_number() -> None:
    """Skipped only if blocks are; its switch may have a digit, which is none of N."""
    for switch in ("/", "/1", "/9"):
        assert ways(f"G1 F600\nGOTO 5\nX1\n{switch}N5 X2\nM30\n") == [2.0]


def test_a_jump_leaves_loops() -> None:
    """Behind it the loop of the same number may begin anew."""
    text = "G1 F600\nDO1\nDO2\nX1\nGOTO 7\nEND2\nEND1\nN7 #1=0\nWHILE[#1LT2]DO1\n#1=#1+1\n"
    assert ways(text + "X[10+#1]\nEND1\nM30\n") == [1.0, 11.0, 12.0]


def test_arithmetic_without_brackets() -> None:
    text = "G1 F600\n#1=2+3*4 (twelve more)\n#2=-#1+ATAN[1]/[1] #3=#1 MOD 4\nX[#1+#2+#3]\nM30\n"
    assert ways(text) == [14.0 - 14.0 + 45.0 + 2.0]


def test_behind_then_parameters_are_set() -> None:
    text = "G1 F600\n#1=1\nIF [#1 EQ 1] THEN #2=#1+4\nIF [#1 EQ 2] THEN #2=9\nX#2\nM30\n"
    assert ways(text) == [5.0]


@pytest.mark.parametrize(
    "lines, why",
    [
        ("GOTO 99", 'line 2: no line of this program has this N "GOTO 99"'),
        ("GOTO 5\nM30\nO2\nN5 M99", 'line 2: no line of this program has this N "GOTO 5"'),
        ("GOTO 5\nM30\n:2\nN5 M99", 'line 2: no line of this program has this N "GOTO 5"'),
        ("/N5\nGOTO 5", 'line 3: no line of this program has this N "GOTO 5"'),
        ("GOTO 0", 'line 2: value out of range "0"'),
        ("GOTO 1.5", 'line 2: value out of range "1.5"'),
        ("N5 GOTO 5", "line 2: "),
        ("WHILE [0] DO2\nEND1", 'line 2: DO without the END of its number "WHILE [0] DO2"'),
        ("DO4\nEND4", 'line 2: value out of range "4"'),
        ("DO1\nDO1\nEND1\nEND1", "line 3: "),
        ("END1", "line 2: "),
        ("DO1\nDO2\nEND1\nEND2", "line 4: "),
        ("IF [1] X1", "line 2: IF [ ] goes on with GOTO or THEN, WHILE [ ] with DO"),
        ("WHILE [1] X1", "line 2: IF [ ] goes on with GOTO or THEN, WHILE [ ] with DO"),
        ("IF 1 GOTO 2", "line 2: "),
        ("IF [1] THEN X1", "line 2: "),
        ("GOTO 2 X1\nN2", "line 2: "),
        ("o1 if [1]\nGOTO 2\no1 endif\nN2", "line 3: "),
    ],
)
def test_wrong_jumps_are_told(lines: str, why: str) -> None:
    options = Options(fanuc=True, block_delete=True)
    found = first(f"G1 F600\n{lines}\n", options).faults
    assert found and str(found[0]).startswith(why)


def test_without_fanuc_they_are_no_words() -> None:
    assert read("GOTO 5\nN5 M30\n").faults and read("IF [1] GOTO 5\nN5\n").faults
