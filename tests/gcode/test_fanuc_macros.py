"""Macros of Fanuc's and Haas' controls: vacant parameters, bits, alarms, calls with values."""

import pytest
from compare import difference, first
from second import Options

FANUC = Options(fanuc=True)


def ways(text: str) -> list[float]:
    """X of all ends; both interpreters agree."""
    assert difference(text, FANUC) == ""
    program = first(text, FANUC)
    assert program.faults == []
    return list(program.commands["end"][:, 0])


@pytest.mark.parametrize(
    "value, is_",
    [
        # FIX drops what is behind the point, FUP makes the next whole number away from 0.
        ("FIX[1.8]", 1),
        ("FIX[-1.8]", -1),
        ("FUP[1.2]", 2),
        ("FUP[-1.2]", -2),
        ("FUP[-2]", -2),
        ("ROUND[-1.5]", -2),
        # Bits: 12 is 1100, 10 is 1010; -1 has all of them.
        ("12 AND 10", 8),
        ("12 OR 10", 14),
        ("12 XOR 10", 6),
        ("-1 AND 6", 6),
        ("2.6 OR 0", 3),
        # AND stands with *, OR and XOR with +, comparisons behind them.
        ("1 + 6 AND 3", 3),
        ("8 OR 4 * 1", 12),
        ("[1 EQ 1] AND [2 EQ 2]", 1),
        ("3 EQ 1 OR 2", 1),
    ],
)
def test_values(value: str, is_: float) -> None:
    assert ways(f"G1 F600\nX[100+[{value}]]\n") == [100.0 + is_]


@pytest.mark.parametrize(
    "condition, holds",
    [
        # #1 is vacant, #2 is 0, as the manual's table of comparisons has it.
        ("#1 EQ #0", True),
        ("#1 NE 0", True),
        ("#1 EQ 0", False),
        ("#1 NE #0", False),
        ("#1 GE #0", True),
        ("#1 GT 0", False),
        ("#1 GE 0", True),
        ("#2 EQ #0", False),
        ("#2 NE 0", False),
        ("#2 NE #0", True),
        ("#2 EQ 0", True),
        ("#2 GE #0", True),
        ("#2 GT 0", False),
        # What is reckoned with it is a number; what only copies it is not.
        ("#1*5 EQ 0", True),
        ("[#1+#1] EQ #0", False),
        ("[-#1] EQ 0", True),
        ("ABS[#1] EQ 0", True),
        ("#3 EQ #0", True),
        ("#4 EQ #0", False),
        ("#5 EQ #0", True),
        ("#[#1] EQ #0", True),
        ("#33 EQ #0", True),
        ("#150 EQ #0", True),
        ("#4999 EQ #0", True),
    ],
)
def test_what_was_never_set_is_vacant(condition: str, holds: bool) -> None:
    sets = "#2=0\n#3=#1\n#4=#1*1\n#5=7\n#5=#0\n"
    assert ways(f"G1 F600\n{sets}IF [{condition}] GOTO 9\nX2\nN9 X1\n") == [2.0, 1.0][holds:]


def test_a_vacant_word_is_not_there() -> None:
    """Neither its axis moves nor is it missing; a condition of it does not hold."""
    text = (
        "G1 X5 Y5 F600\nX7 Y#1\nF#1 X#1 Y6\nG#1 X8\nIF [#1] GOTO 9\nWHILE [#1] DO1\nEND1\nX9\nN9\n"
    )
    assert ways(text) == [5.0, 7.0, 7.0, 8.0, 9.0]
    assert list(first(text, FANUC).commands["end"][:, 1]) == [5.0, 5.0, 6.0, 6.0, 6.0]


def test_a_macro_knows_which_values_it_was_given() -> None:
    """One with X, one without, one with 0; #33 belongs to the call, #150 to all."""
    text = (
        "G1 F600\n#24=50\n#33=40\nG65 P100 X3\nG65 P100\nG65 P100 X0\nX#24\nX#33\nX#150\nM30\n"
        "O100\n#150=#150+1\nIF [#33 NE #0] GOTO 9\n#33=9\nIF [#24 EQ #0] GOTO 5\nX[10+#24]\n"
        "GOTO 9\nN5 X20\nN9 M99\n"
    )
    assert ways(text) == [13.0, 20.0, 10.0, 50.0, 40.0, 3.0]


def test_i_j_k_may_come_ten_times() -> None:
    """A letter in front of the one before begins the next three: #4 #5 #6, #7 #8 #9, .. #33."""
    text = (
        "G1 F600\nG65 P1 A1 I2 K3 J4 I5 J6 K7\nG65 P1 B1 I1 I2 I3 I4 I5 I6 I7 I8 I9 I10 J11 K12\n"
    )
    text += "M30\nO1\nIF [#2 EQ 1] GOTO 2\nX[#1+#4*10+#6*100]\nX[#8+#10*10+#11*100+#12*1000]\nM99\n"
    text += "N2 X#28\nX[#31+#32+#33]\nM99\n"
    assert ways(text) == [321.0, 7654.0, 9.0, 33.0]


@pytest.mark.parametrize(
    "line, why",
    [
        ("#3000=1 (TOOL NOT FOUND)", 'line 2: alarm of the program "#3000=1 (TOOL NOT FOUND)"'),
        ("IF [1 EQ 1] THEN #3000=12(NO)", 'line 2: alarm of the program "#3000=12(NO)"'),
        ("#0=1", 'line 2: parameter cannot be set "#0=1"'),
        ("X[4000000000 AND 1]", "line 2: no value for this argument"),
        ("G65 P1 A1 A2", 'line 2: word given twice "A2"'),
        ("G65 P1 P1", 'line 2: word given twice "P1"'),
        ("G65 P1 I1 I1 I1 I1 I1 I1 I1 I1 I1 I1 I1", 'line 2: word has no use in this line "I1"'),
        ("X#<name>", "line 2: parameter has not been set"),
    ],
)
def test_what_is_wrong_is_told(line: str, why: str) -> None:
    text = f"G1 F600\n{line}\nX1 Q\nM30\nO1\nM99\n"
    assert difference(text, FANUC) == ""
    assert str(first(text, FANUC).faults[0]).startswith(why)


def test_an_alarm_ends_the_program() -> None:
    """What comes behind it is not read; one that is jumped over is none."""
    text = "G1 F600\nX1\nIF [#1 EQ #0] GOTO 5\n#3000=1 (FIRST)\nN5 X2\n#3000=2 (SECOND)\nX Y\n"
    faults = first(text, FANUC).faults
    assert [str(f) for f in faults] == ['line 6: alarm of the program "#3000=2 (SECOND)", column 1']
    assert first(text, FANUC).commands["end"][:, 0].tolist() == [1.0, 2.0]


def test_without_fanuc_all_is_as_it_was() -> None:
    text = "G1 F600\n#3000=[12 AND 10]\nX[FIX[-1.8] + #3000 + #7]\nX[1 EQ 1 AND 2 EQ 2]\n"
    assert difference(text) == ""
    assert first(text).commands["end"][:, 0].tolist() == [-1.0, 1.0]
