"""A long run is analysed in files: the same bits as in memory, and nothing is left of them."""

import math
import mmap
import os
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from contour_runs import Machine, Program, run_along

import motionfmu
from motionfmu.analysis.contour import ContourInput, analyse, planned_geometry, scaled_values
from motionfmu.analysis.contour.planned_geometry import path_of_text
from motionfmu.base import columns
from motionfmu.report import error_path
from motionfmu.run import planned_text
from motionfmu.run.result_files import json_of


def crossing() -> ContourInput:
    """A path that crosses itself, has corners and arcs, and stands still on its way."""
    program = Program(0, 0).line(30, 0).line(30, 20).arc((20, 20), math.pi).line(10, -15)
    program = program.line(10, 5).line(10, -5).line(40, -5)
    return run_along(program.path(), 40.0, Machine(step=1e-3))


def mapped(run: ContourInput, folder: Path) -> ContourInput:
    """The same run with its signals in files."""
    found: dict[str, Any] = {}
    for field in fields(run):
        value = getattr(run, field.name)
        if isinstance(value, np.ndarray) and value.ndim:
            np.save(folder / f"{field.name}.npy", value)
            file = np.load(folder / f"{field.name}.npy", mmap_mode="r")
            found[field.name] = file.view(np.ndarray)
    return replace(run, **found)


def in_file(array: Any) -> bool:
    while array is not None and not isinstance(array, mmap.mmap):
        array = getattr(array, "base", None)
    return array is not None


def _alike(one: Any, other: Any) -> bool:
    if isinstance(one, np.ndarray):
        return one.dtype == other.dtype and one.tobytes() == other.tobytes()
    return bool(one == other)


def test_analysis_in_files_has_the_bits_of_that_in_memory(monkeypatch, tmp_path: Path) -> None:
    """Tracks are mapped and let go block by block, which changes no number and no drawing."""
    monkeypatch.setattr(scaled_values, "BLOCK", 64)
    plain = analyse(crossing())
    drawn = error_path.draw(plain)
    monkeypatch.setattr(columns, "LARGE", 1)
    monkeypatch.setattr(scaled_values, "FAR", 7)
    run = mapped(crossing(), tmp_path)
    there = sorted(os.listdir(tmp_path))
    found = analyse(run)
    for own, other in ((plain.track, found.track), (plain.command_track, found.command_track)):
        for name in ("segment", "along", "distance", "right"):
            assert in_file(getattr(other, name)) and not in_file(getattr(own, name))
            assert getattr(own, name).tobytes() == getattr(other, name).tobytes()
    assert plain.cutting.tobytes() == found.cutting.tobytes()
    assert plain.commands.tobytes() == found.commands.tobytes()
    assert json_of(plain.numbers()) == json_of(found.numbers())
    again = error_path.draw(found)
    for field in fields(drawn):
        one, other = getattr(drawn, field.name), getattr(again, field.name)
        assert _alike(one, other)
    assert sorted(os.listdir(tmp_path)) == there


def test_room_in_a_file_needs_one_to_stand_beside(monkeypatch, tmp_path: Path) -> None:
    """Small arrays, and those of runs in memory, stay there; a full disk is no error."""
    np.save(tmp_path / "a.npy", np.arange(100.0))
    beside = np.load(tmp_path / "a.npy", mmap_mode="r").view(np.ndarray)[3:]
    assert not in_file(columns.room(1000, float, beside))
    monkeypatch.setattr(columns, "LARGE", 4000)
    assert not in_file(columns.room(1000, float, np.arange(10)))
    assert not in_file(columns.room(10, float, beside))
    made = columns.room(1000, float, beside)
    further = columns.room(1000, float, made[5:])
    assert in_file(made) and in_file(further)
    made[:] = np.arange(1000)
    columns.forget(made)
    assert np.array_equal(made, np.arange(1000.0))

    def full(*_: Any) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "posix_fallocate", full)
    assert not in_file(columns.room(1000, float, beside))


@pytest.fixture(scope="module")
def geometry() -> str:
    """What the library wrote of a program with lines, arcs, a dwell and a curve."""
    found = motionfmu.load("scenarios/circle").run(stop=0.1).geometry
    assert found is not None
    return found


def test_geometry_in_pieces_is_that_of_the_whole(monkeypatch, geometry: str) -> None:
    """A path that is read line by line has the same columns, and faults have the same lines."""
    head, *rows = geometry.splitlines()
    number = head.split(",").index("command")
    many = []
    for k in range(7 * len(rows)):
        cells = rows[k % len(rows)].split(",")
        cells[number] = str(k + 1)
        many.append(",".join(cells))
    text = "\n".join([head, *many, ""])
    whole = path_of_text(text, "plan").segments.columns
    wrong = text.replace(many[4], many[4].replace(many[4].split(",")[-2], "x", 1))
    for piece in (1, 2, 3, 1000):
        monkeypatch.setattr(planned_geometry, "PIECE", piece)
        found = path_of_text(text, "plan").segments.columns
        for field in fields(whole):
            if field.name != "curves":
                assert np.array_equal(getattr(whole, field.name), getattr(found, field.name))
        with pytest.raises(ValueError, match=r"plan:6: .*'x' is not a number"):
            path_of_text(wrong, "plan")


def test_long_plan_stays_in_its_file(monkeypatch, geometry: str) -> None:
    """The text and the path of a plan that is not kept in memory are the same."""
    kept = motionfmu.load("scenarios/circle").run()
    monkeypatch.setattr(planned_text, "LARGE", 1)
    found = motionfmu.load("scenarios/circle").run()
    assert found.geometry == kept.geometry and found.geometry.startswith(geometry.splitlines()[0])
    assert json_of(found.contour().numbers()) == json_of(kept.contour().numbers())
    assert found.geometry == kept.geometry  # it may be read again
