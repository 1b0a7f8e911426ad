"""Part programs of any length: read, driven and drawn block by block."""

import tracemalloc

import numpy as np
import pytest
from few_cases import few

from motionfmu.analysis.gcode import Program, read, strokes, summarise
from motionfmu.report.jobs import drawn_strokes
from motionfmu.report.jobs.drawn_strokes import DrawnStrokes

MIXED = """G21 G90 G64 P0.02 G1 F3000
O1 REPEAT [40]
G91 G1 X1 Y0.2 F3000
X0.01 F200
G2 X2 Y0 I1 J0 F1500
M3 S100
G4 P0.01
G0 Z1
T1 M6
G5 X3 Y1 I1 J1 P-1 Q0.5 F900
G1 X0.3
G3 X0 Y0 I0.5 F2000
O1 ENDREPEAT
M2
"""


def zigzag(lines: int, feeds: bool = False) -> str:
    """A wave of short lines, with a feed for each or without."""
    k = np.arange(lines)
    x, y = 0.01 * k, 20.0 * np.sin(1e-3 * k)
    f = [f" F{1000 + 37 * (i * i % 101)}" if feeds else "" for i in k.tolist()]
    moves = [f"X{a:.4f} Y{b:.4f}{c}" for a, b, c in zip(x, y, f, strict=True)]
    return "\n".join(["G21 G90 G64 P0.01 G1 F3000", *moves, "M2", ""])


def driven(program: Program, room: int) -> tuple[bytes, bytes]:
    """Times and places of the commands, of which the machine gets so many at a time."""
    rows = program.commands
    places = np.zeros((len(program.places()), 6))
    drive = program.drive(places)
    for first in range(0, len(rows), room):
        drive.take(rows[first : first + room], first + room >= len(rows))
    return drive.seconds.tobytes(), places.tobytes()


@pytest.mark.parametrize("jerk", few([0.0, 20_000.0], [20_000.0]))
@pytest.mark.parametrize("curve", [False, True])
def test_commands_in_blocks_are_driven_to_the_same_bits(jerk: float, curve: bool) -> None:
    """However many commands a call gets, the machine looks as far ahead as it can."""
    limits = {"axis_speed": [300.0] * 6, "axis_acc": [2000.0] * 6} if curve else {}
    program = read(MIXED, "T1 P1 Z10 D6", jerk=jerk, jerk_down=jerk, **limits)
    assert not program.faults
    whole = driven(program, len(program.commands))
    assert whole == (program.seconds().tobytes(), program.places().tobytes())
    for room in (1, 7, 255, 256, 257):
        assert driven(program, room) == whole


def test_reading_in_blocks_gives_all_commands() -> None:
    """Blocks that are read anew have the bytes of the commands read at once."""
    program = read(zigzag(10_000))
    blocks = [rows.tobytes() for rows in program.blocks()]
    again = summarise(program)
    assert len(blocks) > 2
    assert b"".join(blocks) == program.commands.tobytes()  # which later blocks are parts of
    assert b"".join(rows.tobytes() for rows in program.blocks()) == b"".join(blocks)
    assert summarise(program) == again
    assert read("\n").commands.size == sum(map(len, read("\n").blocks())) == 0
    assert list(strokes(read("\n"))) == []


def _of_a_line(text: str) -> int:
    """Memory that reading, figures and drawing take at their peak [byte]."""
    tracemalloc.start()
    try:
        program = read(text)
        DrawnStrokes(program, summarise(program))
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_a_line_takes_little_memory() -> None:
    """A command is 400 bytes, and its text is here twice; what is kept of it is far less."""
    texts = zigzag(30_000), zigzag(60_000)
    _of_a_line(texts[0])  # what is made once
    peaks = [_of_a_line(text) for text in texts]
    assert (peaks[1] - peaks[0]) / 30_000 < 150.0


def test_long_path_is_drawn_within_its_tolerance() -> None:
    """No point of the path is farther from what is drawn than the page says."""
    program = read(zigzag(20_000))
    drawn = DrawnStrokes(program, summarise(program))
    assert drawn.within == pytest.approx(0.01 * 19_999 / drawn_strokes.FINE)
    shown = np.concatenate([s.points for s in drawn.strokes])
    assert len(shown) < 2_000
    every = np.concatenate([s.points for s in strokes(program)])
    kept = np.interp(every[:, 0], shown[:, 0], shown[:, 1])  # X never falls
    assert np.abs(every[:, 1] - kept).max() < 2.0 * drawn.within  # measured along Y: |slope| < 2
    few = np.delete(shown, len(shown) // 2, axis=0)
    kept = np.interp(every[:, 0], few[:, 0], few[:, 1])
    assert np.abs(every[:, 1] - kept).max() > drawn.within  # no point is one too many


def test_feeds_of_lines_too_short_to_see_are_joined() -> None:
    """Feeds that change faster than a picture shows take no points."""
    program = read(zigzag(20_000, feeds=True))
    drawn = DrawnStrokes(program, summarise(program))
    points = sum(len(s.points) for s in drawn.strokes)
    assert points <= 2 * drawn_strokes.POINTS
    for s in drawn.strokes:
        gaps = np.linalg.norm(np.diff(s.points, axis=0), axis=1)
        assert gaps.max() < 0.2 + 40.0 * drawn.within  # it is one line
        cuts = np.diff(s.feed) != 0.0
        assert (gaps[cuts] == 0.0).all()  # both ends of a stretch of one feed are there
    assert len({float(f) for s in drawn.strokes for f in s.feed}) > 50


@pytest.mark.more
def test_many_strokes_are_drawn_in_part() -> None:
    """Of more strokes than a page can hold one of several pairs is drawn, which the page says."""
    holes = [f"G0 X{k % 160} Y{k // 160}\nG1 Z-2\nG0 Z2" for k in range(12_000)]
    program = read("\n".join(["G21 G90 F500", *holes, "M2", ""]))
    drawn = DrawnStrokes(program, summarise(program))
    assert drawn.every > 1
    assert sum(len(s.points) for s in drawn.strokes) <= 2 * drawn_strokes.POINTS
    assert {s.rapid for s in drawn.strokes} == {True, False}


def test_short_program_is_drawn_whole() -> None:
    """What fits on a page is drawn as it is."""
    program = read(MIXED, "T1 P1 Z10 D6")
    drawn = DrawnStrokes(program, summarise(program))
    assert (drawn.within, drawn.every) == (0.0, 1)
    for made, own in zip(drawn.strokes, strokes(program), strict=True):
        assert made.points.tobytes() == own.points.tobytes()
