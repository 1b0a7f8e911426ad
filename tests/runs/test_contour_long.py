"""What a long run leaves does not grow with it: tables, the drawing, what makes them."""

import tracemalloc
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from contour_runs import Machine, Program, run_along

from motionfmu.analysis.contour import ContourResult, analyse, contour_result, scaled_values
from motionfmu.report import error_path
from motionfmu.run import decimate
from motionfmu.run.result_files import json_of


def zigzag(moves: int, step: float = 1e-3) -> ContourResult:
    """The contour of a saw of so many moves of 1 mm, every fifth with a larger corner."""
    program, x = Program(0, 0), 0.0
    for k in range(moves):
        x += 0.8
        program = program.line(x, (0.6 if k % 5 else 0.3) * (k % 2))
    return analyse(run_along(program.path(), 50.0, Machine(step=step)))


def peak(work: Callable[[], object]) -> int:
    """Bytes that it needs at most beside what was there."""
    tracemalloc.start()
    work()
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return most


def test_json_lists_the_worst_commands_and_corners_in_their_order(monkeypatch) -> None:
    found = zigzag(60)
    whole = found.numbers()
    assert "left_out" not in whole
    assert len(whole["commands"]) == len(found.commands) == 60 and len(whole["corners"]) == 59
    monkeypatch.setattr(contour_result, "LISTED", 7)
    few = found.numbers()
    assert few["left_out"] == {"commands": 53, "corners": 52}
    for name, size in (("commands", "max"), ("corners", "error")):
        assert len(few[name]) == 7
        assert [row for row in whole[name] if row in few[name]] == few[name]
        least = min(row[size] for row in few[name])
        assert all(row in few[name] or row[size] <= least for row in whole[name])
    # a name means the same command as ever
    assert found.number("commands.40.max") == whole["commands"][40]["max"]
    assert json_of({k: v for k, v in few.items() if k != "left_out"}) != json_of(whole)


def test_the_drawing_needs_no_memory_for_each_sample(monkeypatch) -> None:
    monkeypatch.setattr(scaled_values, "BLOCK", 1 << 10)
    monkeypatch.setattr(error_path, "WAYS", 1 << 10)
    monkeypatch.setattr(decimate, "ROWS", 1 << 10)
    coarse, fine = zigzag(40, 1e-4), zigzag(40, 1.25e-5)
    one, eight = (peak(lambda r=r: error_path.draw(r)) for r in (coarse, fine))
    more = len(fine.run.time) - len(coarse.run.time)
    assert more > 60_000
    # numbers of the cutting samples, 4 bytes each, and what a block needs; a float each is 8
    assert (eight - one) / more < 6.0


def test_a_path_of_many_segments_is_drawn_by_those_that_show(monkeypatch) -> None:
    turns = np.linspace(0.0, 20.0, 3001)
    program = Program(50, 0)
    for a in turns[1:]:
        program = program.line(50 * np.cos(a), 50 * np.sin(a))
    path = program.line(0, 0).path()
    basis = np.eye(3)[:2]
    every = error_path._outlined(path, np.arange(len(path.segments)), basis)
    monkeypatch.setattr(error_path, "SEGMENTS_MAX", 100)
    few = error_path._outlined(path, np.arange(len(path.segments)), basis)
    assert len(every) == 2 * len(path.segments) and len(few) < 0.2 * len(every)
    assert few[0] == pytest.approx(every[0]) and few[-1] == pytest.approx(every[-1])
    # no point of the path is farther from what is drawn than the part that no picture shows
    drawn = Program(*few[0])
    for x, y in few[1:]:
        drawn = drawn.line(x, y)
    lines = drawn.path().segments
    points = np.column_stack([every, np.zeros(len(every))])
    near = np.min([line.foot(points).distance for line in lines], axis=0)
    assert near.max() <= 100.0 / error_path.FINE + 1e-9
    assert near.max() > 0.02 * 100.0 / error_path.FINE  # something was left out


def test_arrays_that_are_made_in_parts_are_the_whole() -> None:
    from motionfmu.run.result_files import track

    found = zigzag(30)
    whole = track(found)
    small = track(replace(found))
    for name in ("error", "foot", "gap"):
        parts = [small[name][slice(k, k + 97)] for k in range(0, len(small[name]), 97)]
        assert np.array_equal(np.concatenate(parts), np.asarray(whole[name]), equal_nan=True)
    assert np.asarray(whole["gap"]).shape == (len(found.run.time), 3)
    size = np.linalg.norm(np.asarray(whole["gap"], dtype=float), axis=1)
    error = np.abs(np.asarray(whole["error"]))
    assert np.nanmax(np.abs(size - error)) < 1e-6
