"""Axes of the mcc FMU: compensation tables from a file, inverted axes, dry run, single block."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fmi_tools import ERROR
from host_link import AXES, Case, Run, execute
from test_homing import COUNT, OFFSET, origins
from test_homing import run as homing
from test_mcc import start

AXIS = "axis,interval,home\n"
POINT = "axis,index,forward,backward\n"
TABLE = f"# X alone\n{AXIS}1,1000,2\n\n{POINT}1,2,0,-25\n1,3,10,-15\n1,4,-7,-30\n"
FAST = {"acc_time": 0.01, "dec_time": 0.01}


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("1,2,3\n", 'line 1: not the header "axis,interval,home": "1,2,3"'),
        (AXIS + "\n1,0,2", "line 3: interval 0 is not a number of pulses from 1"),
        (AXIS + "1,3000000000,2", "line 2: interval 3000000000 is not a number of pulses"),
        (AXIS + "1,100,256", "line 2: home 256 is not an index, 0 to 255"),
        (AXIS + "1,100", 'line 2: not 3 whole numbers: "100"'),
        (AXIS + "1,100,1.5", 'line 2: not 3 whole numbers: "1.5"'),
        (AXIS + "7,100,1", "line 2: axis 7 is not within 1 to 6"),
        (AXIS + "1,100,1\n1,100,1", "line 3: axis 1 has an interval already"),
        (AXIS + "1,100,1\n", "axis 1 has an interval and no points"),
        (AXIS + "4,100,1\n" + POINT + "4,0,0,0", "axis 4 is not active"),
        (POINT + "1,2,3,4", "line 2: axis 1 has no interval yet"),
        (TABLE + "1,6,0,0", "line 9: index 6 does not follow the one before"),
        (TABLE + "1,5,0,0,1", 'line 9: not 4 whole numbers: "0,1"'),
        (TABLE + "1,5,x,0", 'line 9: not 4 whole numbers: "x,0"'),
        (TABLE + "1,5,32768,0", "line 9: forward 32768 is beyond +-32767"),
        (TABLE + "1,5,0,-32768", "line 9: backward -32768 is beyond +-32767"),
        (TABLE + f"1,5,{-(2**63)},0", "line 9: forward -9223372036854775808 is beyond +-32767"),
        (AXIS + "2,100,1\n" + POINT + "2,-1,0,0", "line 4: index -1 is not within 0 to 255"),
        ("#" + 300 * "x", "line 1: more than 254 characters"),
    ],
)
def test_a_wrong_table_is_refused_by_file_line_and_value(
    text: str, said: str, tmp_path: Path
) -> None:
    table = tmp_path / "screw.csv"
    table.write_text(text)
    status, instance = start(3, "G1 X1 F600", tmp_path, comp_file=str(table))
    assert status == ERROR
    assert f"comp_file: {table}: {said}" in instance.said
    instance.free()


@pytest.mark.parametrize(
    ("name", "said"), [("none.csv", "cannot read: No such file"), (".", "cannot read: Is a dir")]
)
def test_a_table_that_cannot_be_read_is_told(name: str, said: str, tmp_path: Path) -> None:
    status, instance = start(2, "G1 X1 F600", tmp_path, comp_file=str(tmp_path / name))
    assert status == ERROR and said in instance.said
    instance.free()


def run(tmp_path: Path, program: str, **settings: Any) -> Run:
    """The program on library and card; the books balance at every step."""
    if "comp_file" in settings:
        (tmp_path / "screw.csv").write_text(settings["comp_file"])
        settings["comp_file"] = str(tmp_path / "screw.csv")
    return execute(Case(program, {**FAST, **settings}), tmp_path)


@pytest.mark.parametrize(
    ("way", "pulses"),
    [
        ("X1", 1010),  # at a point of the table, forward
        ("X1.5 \nX1.2", 1200 - 18),  # between 1 and 2 mm, backward: -15 - 0.2 * 15
        ("X9", 8993),  # beyond the last point
        ("X-3", -3025),  # before the first
        ("X1\nY2\nX0", -25),
    ],
)
def test_pulses_are_the_ideal_position_and_the_table(way: str, pulses: int, tmp_path: Path) -> None:
    done = run(tmp_path, f"G90 G1 F3000 {way}\nM2\n", comp_file=TABLE)
    assert done.value("card", "pulse_count")[0] == pulses
    ideal = round(done.value("mcc", "position")[0] * 1000)
    assert done.value("mcc", "compensation")[0] == pulses - ideal


def test_an_inverted_axis_runs_the_other_way_with_its_table(tmp_path: Path) -> None:
    done = run(tmp_path, "G1 F3000 X1 Y2\nM2\n", comp_file=TABLE, pos2encoder_dir=1)
    assert done.value("mcc", "position")[:2] == [1.0, 2.0]
    assert done.value("card", "pulse_count")[:2] == [-1010, -2000]


def test_compensation_counts_from_the_origin_that_was_found(tmp_path: Path) -> None:
    """The table at its home is added to the same place; during the search it said otherwise."""
    rows = [
        f"{a},{i},{i * i * 7},{i * i * 7 - 40 * (i != 3)}" for a in range(1, 7) for i in range(9)
    ]
    axes = [f"{a},5000,3" for a in range(1, 7)]
    table = tmp_path / "screw.csv"
    table.write_text("\n".join([AXIS.strip(), *axes, POINT.strip(), *rows]))
    result = homing(9.0, mcc__comp_file=str(table))
    shift = 63e-6  # [m] the table at its home, 3 * 3 * 7 pulses
    assert np.abs(origins(result) - shift - origins(homing(9.0))).max() < 2 * COUNT


def test_an_inverted_axis_finds_the_same_origin() -> None:
    """All directions turned, the offset too: the same switch, index and place of the machine."""
    turned = homing(9.0, mcc__pos2encoder_dir=1, mcc__home_dir=6, mcc__home_offset=-OFFSET)
    assert np.abs(origins(turned) - origins(homing(9.0))).max() < 2 * COUNT


def test_a_dry_run_reports_everything_and_moves_nothing(tmp_path: Path) -> None:
    text = "G64 G1 F3000 X5\nG3 X5 Y0 I-5\nM2\n"
    wet = run(tmp_path, text)
    dry = run(tmp_path, text, dry_run=True, comp_file=TABLE)
    assert dry.value("card", "pulse_count") == [0] * 6
    assert len(dry.taken) == len(wet.taken)
    assert dry.value("mcc", "position") == wet.value("mcc", "position") == [5.0] + [0.0] * 5


def test_single_block_waits_for_cycle_start_before_each_line(tmp_path: Path) -> None:
    times = [(0.3 * k, "cycle_start", True) for k in (1, 2)]
    times += [(t + 0.1, name, False) for t, name, _ in times]
    case = Case("G91 G1 F3000 X1\nX1 Y1\nX1\nM2\n", {**FAST, "single_block": True}, times)
    link = Run(case, tmp_path)
    seen: list[tuple[int, int, bool]] = []
    book = link.book

    def watch() -> None:
        book()
        row = [link.value("mcc", n) for n in ("status", "line", "done")]
        if not seen or list(seen[-1]) != row:
            seen.append((row[0], row[1], row[2]))

    link.book = watch  # type: ignore[method-assign]
    try:
        link.go()
        link.balance()
    finally:
        link.close()
    assert [(line, done) for status, line, done in seen if status == 4] == [
        (1, False),
        (2, False),
    ]
    assert seen[-1][0] == 1 and seen[-1][2]
    assert link.value("card", "pulse_count")[:AXES] == [3000, 1000, 0]
