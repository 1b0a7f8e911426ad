"""The scope FMU: what it writes, when, and what it says when it cannot."""

import resource
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fmi_tools import ERROR, OK, Instance, random_inputs

PERIOD = 1e-4
ENDINGS = (".real.npy", ".int.npy", ".csv")
both = pytest.mark.parametrize("fmi", (2, 3))


def columns(row: dict[str, list[Any]], kind: str, groups: int, singles: int) -> list[Any]:
    """One row of a file, from the inputs of the FMU."""
    found = [x for i in range(1, groups + 1) for x in row[f"axes_{kind}_{i}"]]
    return found + [row[f"{kind}_{i}"][0] for i in range(1, singles + 1)]


def record(instance: Instance, rows: list[dict[str, list[Any]]], size: float) -> None:
    for row in rows:
        for name, values in row.items():
            assert instance.set(name, values) == OK
        assert instance.step(size) == OK, instance.said


def started(fmi: int, **values: Any) -> Instance:
    return Instance("scope", fmi).initialize(values)


@both
def test_all_channels_come_back(fmi: int, tmp_path: Path) -> None:
    file = tmp_path / "all"
    scope = started(fmi, file=str(file), csv=True)
    rows = random_inputs(scope, 1, 3000)  # more than the first buffer holds
    record(scope, rows, PERIOD)
    assert scope.get("rows") == [3000]
    assert list(tmp_path.iterdir()) == []
    assert scope.call("Terminate") == OK, scope.said
    scope.free()
    assert sorted(p.name for p in tmp_path.iterdir()) == ["all.csv", "all.int.npy", "all.real.npy"]
    real, ints = np.load(f"{file}.real.npy"), np.load(f"{file}.int.npy")
    assert (real.dtype, ints.dtype) == (np.float64, np.int32)
    assert np.array_equal(real, np.array([columns(r, "real", 10, 4) for r in rows]))
    assert np.array_equal(ints, np.array([columns(r, "int", 9, 10) for r in rows]))
    table = np.genfromtxt(f"{file}.csv", delimiter=",", names=True)
    assert table.dtype.names is not None
    assert table.dtype.names[:3] == ("time", "r1", "r2")
    assert table.dtype.names[-1] == "i64"
    assert np.array_equal(table["time"], np.arange(3000) / 10000)
    assert np.array_equal(table["r64"], real[:, 63])
    assert np.array_equal(table["i1"], ints[:, 0])


@both
def test_only_used_columns_are_written(fmi: int, tmp_path: Path) -> None:
    file = tmp_path / "few"
    few = {"axes_real_used": 2, "real_used": 1, "axes_int_used": 0, "int_used": 3}
    scope = started(fmi, file=str(file), **few)
    rows = random_inputs(scope, 2, 5)
    record(scope, rows, PERIOD)
    assert scope.call("Terminate") == OK
    scope.free()
    assert np.load(f"{file}.real.npy").tolist() == [columns(r, "real", 2, 1) for r in rows]
    assert np.load(f"{file}.int.npy").tolist() == [columns(r, "int", 0, 3) for r in rows]


def test_no_column_and_no_row_are_files_too(tmp_path: Path) -> None:
    file = tmp_path / "none"
    none = {"axes_real_used": 0, "real_used": 0, "axes_int_used": 0, "int_used": 0}
    scope = started(3, file=str(file), **none)
    record(scope, [{}, {}], PERIOD)
    assert scope.call("Terminate") == OK
    assert np.load(f"{file}.real.npy").shape == (2, 0)
    assert scope.call("Reset") == OK
    scope.initialize({"file": str(file)})
    assert scope.call("Terminate") == OK
    assert np.load(f"{file}.real.npy").shape == (0, 64)
    assert np.load(f"{file}.int.npy").shape == (0, 64)
    scope.free()


@pytest.mark.parametrize("ratio", (0.25, 0.5, 1.5, 3.0))
def test_rows_stand_on_the_grid_of_the_period(ratio: float, tmp_path: Path) -> None:
    scope = started(3, file=str(tmp_path / "grid"), period=ratio * PERIOD)
    held = np.arange(60.0)
    record(scope, [{"real_1": [x]} for x in held], PERIOD)
    assert scope.call("Terminate") == OK
    scope.free()
    data = np.load(tmp_path / "grid.real.npy")[:, 60]
    instants = np.arange(round(60 / ratio)) * ratio  # row k is at k periods [communication steps]
    assert data.tolist() == held[np.floor(instants).astype(int)].tolist()


def test_nothing_is_recorded_without_a_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    scope = started(3, csv=True)
    record(scope, [{"real_1": [1.0]}] * 3, PERIOD)
    assert scope.get("rows") == [0]
    assert scope.call("Terminate") == OK
    scope.free()
    assert list(tmp_path.iterdir()) == []


def test_a_run_that_is_not_terminated_leaves_nothing(tmp_path: Path) -> None:
    scope = started(3, file=str(tmp_path / "broken"))
    record(scope, [{"real_1": [1.0]}] * 3, PERIOD)
    scope.free()
    assert list(tmp_path.iterdir()) == []


# Columns with which the file is the first that is larger than 1000 bytes.
LARGE = {
    ".real.npy": {"axes_real_used": 10, "axes_int_used": 0},
    ".int.npy": {"axes_real_used": 0, "real_used": 0, "axes_int_used": 9},
    ".csv": {"axes_real_used": 0, "real_used": 1, "axes_int_used": 0, "int_used": 1},
}


@pytest.mark.parametrize("rows", (20, 80))  # the disk is full when the file is closed, or before
@pytest.mark.parametrize("ending", ENDINGS)
def test_a_full_disk_is_told_and_leaves_nothing(rows: int, ending: str, tmp_path: Path) -> None:
    scope = started(3, file=str(tmp_path / "full"), csv=True, **LARGE[ending])
    record(scope, [{"real_1": [1.0 / 3.0]}] * rows, PERIOD)
    count = len(scope.messages)
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (600 if rows == 20 else 1000, before[1]))
    try:
        assert scope.call("Terminate") == ERROR
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert len(scope.messages) == count + 1
    assert f"cannot write {tmp_path}/full{ending}: File too large" in scope.said
    assert list(tmp_path.iterdir()) == []
    scope.free()


@both
def test_a_wrong_path_is_told_before_the_run(fmi: int, tmp_path: Path) -> None:
    (tmp_path / "plain").write_text("a file, not a folder")
    for folder, reason in (("missing", "No such file or directory"), ("plain", "Not a directory")):
        scope = Instance("scope", fmi)
        assert scope.set("file", f"{tmp_path}/{folder}/trace") == OK
        assert scope.enter() == OK
        assert scope.call("ExitInitializationMode") == ERROR
        assert f"cannot write {tmp_path}/{folder}/trace.real.npy: {reason}" in scope.said
        scope.free()


def test_files_appear_together_or_not_at_all(tmp_path: Path) -> None:
    scope = started(3, file=str(tmp_path / "half"), csv=True)
    record(scope, [{"real_1": [1.0]}], PERIOD)
    (tmp_path / "half.csv").mkdir()  # cannot be replaced by a file
    assert scope.call("Terminate") == ERROR
    assert f"cannot write {tmp_path}/half.csv: " in scope.said
    assert [p.name for p in tmp_path.iterdir()] == ["half.csv"]
    scope.free()


@pytest.mark.parametrize("period", (26e-9, 1.00001e-4, 1e-4 + 1e-9))
def test_a_period_off_the_clock_is_refused(period: float) -> None:
    scope = Instance("scope", 3)
    assert scope.set("period", period) == OK
    assert scope.enter() == OK
    assert scope.call("ExitInitializationMode") == ERROR
    assert f"period = {period:.15g} s is not a whole number of 25 ns" in scope.said
    scope.free()


def test_restoring_a_state_rolls_the_recording_back(tmp_path: Path) -> None:
    scope = started(3, file=str(tmp_path / "back"))
    record(scope, [{"real_1": [float(k)]} for k in range(10)], PERIOD)
    state, time = scope.save(), scope.time
    data = scope.serialize(state)
    record(scope, [{"real_1": [-1.0]}] * 30, PERIOD)
    assert scope.restore(state, time) == OK
    assert scope.get("rows") == [10]
    record(scope, [{"real_1": [100.0]}] * 2, PERIOD)
    assert scope.call("Terminate") == OK
    scope.free_state(state)
    scope.free()
    expected = [*map(float, range(10)), 100.0, 100.0]
    assert np.load(tmp_path / "back.real.npy")[:, 60].tolist() == expected
    other = Instance("scope", 3)  # it never saw the first ten rows
    _, state = other.deserialize(data)
    assert other.restore(state, time) == OK, other.said
    record(other, [{"real_1": [7.0]}], PERIOD)
    assert other.call("Terminate") == OK, other.said
    other.free_state(state)
    other.free()
    column = np.load(tmp_path / "back.real.npy")[:, 60]
    assert np.isnan(column[:10]).all()
    assert column[10:].tolist() == [7.0]
    assert (np.load(tmp_path / "back.int.npy")[:10] == 0).all()
