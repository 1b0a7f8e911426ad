"""Signals in files: how long they live; blocks of them give what the whole gives."""

import gc
import itertools
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT

import motionfmu
from motionfmu.base import columns
from motionfmu.base.columns import Columns
from motionfmu.base.errors import InputError
from motionfmu.run import Result, checks, decimate, runner, session
from motionfmu.run.run_plan import Options
from motionfmu.run.session import Session
from motionfmu.scenarios import rates, recording
from motionfmu.scenarios.body import Bounds

THEORY = ROOT / "scenarios/circle_theory"
ROWS = 97  # of a block here: it divides nothing


@pytest.fixture
def short_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in (columns, checks, decimate):
        monkeypatch.setattr(module, "ROWS", ROWS)


@pytest.fixture
def scratch(tmp_path: Path) -> Path:
    folder = tmp_path / "scratch"
    folder.mkdir()
    return folder


@pytest.fixture
def in_files(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runner, "HELD", 0)
    monkeypatch.setattr(session, "HELD_IN_SESSION", 0)


def run(scratch: Path) -> Result:
    return motionfmu.load(THEORY).run(stop=0.1, scratch=scratch)


def test_small_runs_have_no_files_and_the_same_bits(
    scratch: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = motionfmu.load(THEORY)
    till = whole.changed(stop="mcc.done", limit=9.0, settle=3, record={"every": 7})
    for plan, options in ((whole, {"stop": 0.1}), (whole, {"stop": 0.0333}), (till, {})):
        monkeypatch.setattr(runner, "HELD", 1 << 30)
        held = plan.run(scratch=scratch, **options)
        assert list(scratch.iterdir()) == [] and not isinstance(held.signals, Columns)
        monkeypatch.setattr(runner, "HELD", 0)
        filed = plan.run(scratch=scratch, **options)
        assert isinstance(filed.signals, Columns) and list(held.signals) == list(filed.signals)
        assert (held.signal_at is not None) == (plan is till)
        assert held.time.tobytes() == filed.time.tobytes() and not held.time.flags.writeable
        for name, data in filed.signals.items():
            mine = held.signals[name]
            assert (mine.dtype, mine.shape) == (data.dtype, data.shape), name
            assert mine.tobytes() == data.tobytes() and not mine.flags.writeable, name
        del filed, data
        gc.collect()


def test_a_run_is_held_up_to_the_bytes_that_it_may_take(
    scratch: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plan = motionfmu.load(THEORY)
    wanted = recording.size(plan.resolved(Options(stop=0.1)), plan.ends)
    for room, files in ((wanted, 0), (wanted - 1, 1)):
        monkeypatch.setattr(runner, "HELD", room)
        result = run(scratch)
        assert len(list(scratch.iterdir())) == files
        del result
        gc.collect()


@pytest.mark.usefixtures("in_files")
def test_what_is_recorded_goes_with_its_result(scratch: Path) -> None:
    result = run(scratch)
    held = result["card.stock"]
    assert len(list(scratch.iterdir())) == 1 and not held.flags.writeable
    assert isinstance(result.signals, Columns)
    assert result["card.stock"].base is held.base  # mapped once, as long as somebody has it
    before = held.copy()
    del result
    gc.collect()
    assert list(scratch.iterdir()) == []
    assert np.array_equal(held, before)


@pytest.mark.usefixtures("in_files")
def test_a_saved_result_is_read_by_numpy_and_stays(scratch: Path, tmp_path: Path) -> None:
    result = run(scratch)
    wanted = {name: data.copy() for name, data in result.items()} | {"time": result.time.copy()}
    for name in ("a", "b"):
        result.save(tmp_path / name)
    del result
    gc.collect()
    for name in ("a", "b"):
        found = {f.stem: np.load(f, mmap_mode="r") for f in (tmp_path / name / "signals").iterdir()}
        assert found.keys() == wanted.keys()
        for signal, data in wanted.items():
            assert found[signal].dtype == data.dtype and found[signal].flags.c_contiguous
            np.testing.assert_array_equal(found[signal], data, err_msg=signal)


def test_whole_files_get_a_second_name_or_a_copy(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    signals = {"a.x": np.arange(12.0).reshape(6, 2), "a.y": np.arange(6) > 3}
    columns.write(tmp_path / "first", signals, np.arange(6.0))
    kept = Columns.of(tmp_path / "first", ["a.y"])
    assert list(kept) == ["a.y", "a.x"] and "time" not in kept
    assert kept.time is not None
    columns.write(tmp_path / "second", kept, kept.time)
    assert os.path.samefile(tmp_path / "first/a.x.npy", tmp_path / "second/a.x.npy")

    def refused(*_: object) -> None:
        raise OSError(18, "Invalid cross-device link")

    monkeypatch.setattr("motionfmu.base.columns.os.link", refused)
    columns.write(tmp_path / "third", kept, kept.time)
    for file in (tmp_path / "first").iterdir():
        copy = tmp_path / "third" / file.name
        assert copy.read_bytes() == file.read_bytes() and not os.path.samefile(file, copy)


@pytest.mark.parametrize("memory", [0, 1 << 26])
def test_runs_of_a_session_do_not_take_each_others_rows(
    scratch: Path, memory: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(session, "HELD_IN_SESSION", memory)
    scenario = motionfmu.load(THEORY)
    with Session(scenario, ["mcc.p_gain"], stop=0.1, scratch=scratch) as ready:
        found = [ready.run({"mcc.p_gain": gain}) for gain in (50, 150, 50)]
    a, b, c = (r["card.err_count"] for r in found)
    assert not np.array_equal(a, b) and np.array_equal(a, c)


def test_a_disk_without_room_is_told_before_the_run(
    scratch: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    free = type("", (), {"free": 100_000})
    monkeypatch.setattr(recording.shutil, "disk_usage", lambda folder: free)
    with pytest.raises(InputError, match=r"1000 rows of all signals take .* GB; .* has 0.0001 GB"):
        run(scratch)
    with pytest.raises(InputError, match=r"cannot write .*/none: No such file"):
        run(scratch / "none")
    assert list(scratch.iterdir()) == []


@pytest.mark.parametrize(
    "bounds",
    [
        {"min": 0, "max": 0, "absmax": 0, "rms": (0, 0), "final": 0, "changes": 0, "peak": (0, 0)},
        {"order": (0.0, 1.0, 0.0, 2.0)},
        {"windows": ((0.02, 0.0213), (0.05, 0.09)), "rms": (0, 0), "final": 0, "changes": 0},
        {"rate": 3e-3, "absmax": 0, "rms": (0, 0)},
        {"rate": 3e-3, "windows": ((0.0, 0.0301),), "min": 0, "max": 0},
        {"at": 0.0456, "min": 0, "final": 0},
    ],
)
def test_verdicts_of_blocks_are_those_of_the_whole(
    bounds: dict, short_blocks: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    random = np.random.default_rng(7)
    time = np.arange(1000) * 1e-4
    steps = np.repeat(random.integers(0, 3, (40, 2)), 25, axis=0)
    for data in (random.normal(size=(1000, 2)), random.normal(size=1000), steps, steps[:, 0] > 1):
        check = Bounds(**bounds)
        found = checks.judge("x", check, time, data)
        monkeypatch.setattr(checks, "ROWS", 10_000)
        whole = checks.judge("x", check, time, data)
        monkeypatch.setattr(checks, "ROWS", ROWS)
        x, t = data.astype(float), time
        if check.rate is not None:
            t, x = rates.change(time, x, check.rate)
        if check.windows is not None:
            x = x[np.any([(t >= a - 1e-12) & (t <= b + 1e-12) for a, b in check.windows], axis=0)]
        if check.at is not None:
            x = x[456:457]
        theory = {
            "min": x.min(), "max": x.max(), "absmax": np.abs(x).max(), "peak": np.abs(x).max(),
            "rms": np.sqrt((x**2).mean()), "final": np.abs(x[-1]).max(),
            "changes": (np.diff(x, axis=0) != 0).sum(axis=0).max(),
        }  # fmt: skip
        wanted = [theory[b] for b in checks.BOUNDS if b in bounds and b != "order"]
        values = [v.value for v in found]
        if wanted:
            assert [abs(v) for v in values] == pytest.approx(np.abs(wanted), rel=1e-12)
        for one, other in zip(found, whole, strict=True):
            assert (one.ok, one.bounds) == (other.ok, other.bounds)
            assert one.value == pytest.approx(other.value, rel=1e-12, nan_ok=True)


def test_peaks_and_steps_of_blocks_are_those_of_the_whole(short_blocks: None) -> None:
    random = np.random.default_rng(3)
    noise = random.normal(size=1501)
    stairs = np.repeat(random.integers(0, 9, 30), 51)[:1501]
    kept = decimate.keep_peaks(noise, 40)
    edges = np.linspace(0, 1501, 41).astype(int)
    for a, b in itertools.pairwise(edges):
        inside = kept[(kept >= a) & (kept < b)]
        assert {a + noise[a:b].argmin(), a + noise[a:b].argmax()} <= set(inside)
        assert len(inside) <= 2 + (a == 0) + (b == 1501)
    changed = np.flatnonzero(np.diff(stairs)) + 1
    assert np.array_equal(decimate.keep_steps(stairs, 20), np.r_[0, changed, 1500])
    assert np.array_equal(decimate.keep_steps(noise, 40), kept)
    assert np.array_equal(decimate.at(decimate.reader(noise), kept), noise[kept])


PASS = """
import resource, sys
from motionfmu.base.columns import Columns
from motionfmu.run import checks, figures, decimate
from motionfmu.scenarios.body import Bounds
kept = Columns.of(__import__("pathlib").Path(sys.argv[1]))
peak = lambda: resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
x, time = kept["a.x"], kept.time
small = lambda n: (checks.judge("a.x", Bounds(rms=(0, 1), changes=0), time[:n], x[:n]),
    figures.curve("", time[:n], decimate.reader(x[:n, 3]), (0.0, 1e9), False))
small(200_000)
before = peak()
small(len(time))
print(peak() - before, x.nbytes)
"""


def test_a_long_signal_is_passed_in_little_memory(tmp_path: Path) -> None:
    """Three million rows of six numbers, holes of a file: 144 MB, of which a block is held."""
    rows = 3_000_000
    for name, shape in (("a.x", (rows, 6)), ("time", (rows,))):
        with (tmp_path / f"{name}.npy").open("wb") as file:
            head = {"descr": "<f8", "fortran_order": False, "shape": shape}
            np.lib.format.write_array_header_1_0(file, head)
            file.truncate(file.tell() + 8 * int(np.prod(shape)))
    done = subprocess.run(
        [sys.executable, "-c", PASS, tmp_path], capture_output=True, text=True, check=True
    )
    more, size = map(int, done.stdout.split())
    print(f"{more / 1e6:.1f} MB more for a signal of {size / 1e6:.0f} MB")
    assert more < 0.4 * size
