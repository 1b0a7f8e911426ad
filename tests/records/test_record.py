"""A record: units, values between samples and their error, lag, what is read back to the bit."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io
import scipy.signal
from hypothesis import given, settings
from hypothesis import strategies as st

import motionfmu
from motionfmu.base.errors import InputError
from motionfmu.records import Record, lag_of, match
from motionfmu.records.matching import correlation
from motionfmu.records.quantities import quantity, si_name


def made(ns: Any, units: dict[str, str | None] | None = None, **columns: Any) -> Record:
    arrays = {n: np.asarray(x) for n, x in columns.items()}
    return Record("made", np.asarray(ns, dtype=np.int64), arrays, units or dict.fromkeys(columns))


EVERY = np.arange(0, 1_000_000_000, 1_000_000)


@pytest.mark.parametrize(
    ("written", "factor", "si"),
    [
        ("µm", 1e-6, "m"),
        ("°/s", math.pi / 180, "rad/s"),
        ("1/min", 2 * math.pi / 60, "rad/s"),
        ("U/min", 2 * math.pi / 60, "rad/s"),
        ("mm/s²", 1e-3, "m/s2"),
        ("mm/s^2", 1e-3, "m/s2"),
        ("Nm", 1.0, "N.m"),
        ("mNm", 1e-3, "N.m"),
        ("N m", 1.0, "N.m"),
        ("kN", 1e3, "N"),
        ("mV", 1e-3, "V"),
        ("%", 0.01, "1"),
        ("V (Voltage)", 1.0, "V"),
        ("Volt", 1.0, "V"),
        ("nm", 1e-9, "m"),
        ("kg*m²", 1.0, "kg.m2"),
        ("N/A", 1.0, "kg.m/s2/A"),
    ],
)
def test_units_as_they_are_written(written: str, factor: float, si: str) -> None:
    found = quantity(written)
    assert found.factor == pytest.approx(factor, rel=1e-15)
    assert si_name(found.exponents) == si
    assert quantity(si).exponents == found.exponents and quantity(si).factor == 1.0


def test_a_column_in_other_units() -> None:
    units = {"x": "mm", "n": "inc", "u": None}
    record = made([0, 10, 20], units, x=[1.0, 2.0, np.nan], n=[1, 2, 3], u=[0.0, 0.0, 0.0])
    assert record.in_unit("x").tolist()[:2] == [1e-3, 2e-3]
    assert record.in_unit("x", "µm").tolist()[:2] == pytest.approx([1000.0, 2000.0])
    for name, unit, told in (
        ("x", "s", r"x is in \[mm\], \[s\] wanted"),
        ("n", "mm", "x|n is in 'inc', which is no unit; .mm. wanted"),
        ("u", None, "u has no unit; a unit is wanted"),
        ("x", "ell", "unknown symbol"),
        ("y", None, "no column 'y'"),
        ("x[1]", None, "x has a single value"),
    ):
        with pytest.raises(InputError, match=told):
            record.in_unit(name, unit)


def test_a_sample_has_its_own_value_and_others_lie_between() -> None:
    record = made([0, 10, 30], x=[1.0, 3.0, 7.0], n=[1, 2, 3])
    assert record.at(np.array([0, 5, 10, 20, 30]), "x").tolist() == [1.0, 2.0, 3.0, 5.0, 7.0]
    assert record.at(np.array([0, 9, 29, 30]), "x", "hold").tolist() == [1.0, 1.0, 3.0, 7.0]
    assert record.at(np.array([0, 9, 29, 30]), "n").tolist() == [1, 1, 2, 3]
    holed = made([0, 10, 20], x=[1.0, np.nan, 3.0])
    assert holed.at(np.array([0, 20]), "x").tolist() == [1.0, 3.0]  # whatever stands beside it
    with pytest.raises(InputError, match=r"0 .. 3.1e-08 s wanted, the record has 0 .. 3e-08 s"):
        record.at(np.array([0, 31]), "x")
    with pytest.raises(InputError, match="linear or hold wanted"):
        record.at(np.array([0]), "x", "spline")


@pytest.mark.parametrize("hertz", [3.0, 10.0, 40.0])
@pytest.mark.parametrize("rate", [4000.0, 1700.0, 333.0])
def test_the_error_of_resampling_is_that_against_the_function(hertz: float, rate: float) -> None:
    turn = 2 * math.pi * hertz
    record = made(EVERY, {"x": "mm"}, x=np.sin(turn * EVERY / 1e9))
    found = record.uniform(rate)
    true = np.sin(turn * found.time) * 1e-3
    off = float(np.abs(found["x"] - true).max())
    told = found.resampled["x"].between
    bound = 1e-3 * (turn * 1e-3) ** 2 / 8  # h^2/8 max|x''|, h = 1 ms
    # The second difference is less than h^2 x'' by (turn h)^2/12 of it.
    assert off <= told * (1 + (turn * 1e-3) ** 2 / 10)
    assert bound * (1 - (turn * 1e-3) ** 2) <= told <= bound
    held = record.uniform(rate, "hold")
    off = float(np.abs(held["x"] - true).max())
    assert off <= held.resampled["x"].between <= 1e-3 * turn * 1e-3
    assert off > 0.5 * held.resampled["x"].between


def test_what_a_coarser_grid_does_not_show_is_told() -> None:
    data = np.zeros(len(EVERY))
    data[555] = 2.0
    record = made(EVERY, {"x": "mm"}, x=data)
    coarse = record.uniform(100.0)
    assert coarse["x"].max() == 0.0
    assert coarse.resampled["x"].lost == pytest.approx(2e-3)
    assert coarse.resampled["x"].between == 0.0  # every instant is a sample
    same = record.uniform()
    assert same.resampled["x"].lost == 0.0 and np.array_equal(same.ns, record.ns)


def test_uneven_samples_become_even() -> None:
    ns = np.array([0, 900, 2100, 3000, 4000]) * 1000
    found = made(ns, {"x": "m"}, x=ns * 1e-3).uniform()
    assert found.rate == pytest.approx(1e6 / 950, rel=1e-3)
    np.testing.assert_allclose(found["x"], found.ns * 1e-3, rtol=1e-12)


@pytest.mark.parametrize("delay", [0.0, 0.25, 0.5, 3.0, 7.4, -12.3])
def test_a_lag_is_found_between_samples(delay: float) -> None:
    time = EVERY / 1e9
    late = time - delay * 1e-3

    def chirp(t: Any) -> Any:
        return np.sin(2 * math.pi * (2 * t + 8 * t * t)) + 0.3 * t

    found = lag_of(EVERY, 2.0 * chirp(late) + 5.0, chirp(time))
    assert found.seconds == pytest.approx(delay * 1e-3, abs=2e-6)
    assert found.correlation > 0.999


def test_correlation_is_that_of_the_overlaps() -> None:
    random = np.random.default_rng(1)
    x, y = random.normal(size=(2, 97)).cumsum(axis=1)
    found = correlation(x, y, 20)
    for k in range(-20, 21):
        a, b = (x[k:], y[: 97 - k]) if k >= 0 else (x[: 97 + k], y[-k:])
        assert found[k + 20] == pytest.approx(np.corrcoef(a, b)[0, 1], abs=1e-10)


@pytest.mark.parametrize("seed", range(5))
def test_the_lag_of_noise_is_that_of_scipy(seed: int) -> None:
    random = np.random.default_rng(seed)
    base = random.normal(size=5000)
    shift = int(random.integers(-200, 200))
    x, y = np.roll(base, shift), base
    x = x + 0.1 * random.normal(size=5000)
    full = scipy.signal.correlate(x - x.mean(), y - y.mean())
    lags = scipy.signal.correlation_lags(5000, 5000)
    best = lags[np.argmax(full)]
    found = lag_of(np.arange(5000) * 1_000_000, x, y)
    assert best == shift
    assert found.seconds == pytest.approx(best * 1e-3, abs=0.5e-3)


@pytest.mark.parametrize(
    ("x", "told"),
    [
        (EVERY * 1.0, "a straight line tells none"),
        (np.zeros(len(EVERY)), "nothing moves"),
        (np.r_[np.zeros(600), np.ones(400)], "more than"),
    ],
)
def test_where_there_is_no_lag(x: Any, told: str) -> None:
    y = EVERY * 1.0 if told != "more than 250 ms" else x
    y = np.r_[np.zeros(100), np.ones(900)] if told == "more than" else y
    found = lag_of(EVERY, x + 0.0, y)
    assert told in found.reason and math.isnan(found.seconds)


def test_a_match_has_the_numbers_of_its_difference() -> None:
    time = EVERY / 1e9
    run = (EVERY[::2], 3.0 + np.sin(9 * time[::2]))
    found = match(run, (EVERY, 3.0 + 0.99 * np.sin(9 * time))).numbers()
    true, off = 3.0 + 0.99 * np.sin(9 * time[::2]), 0.01 * np.sin(9 * time[::2])
    assert found["samples"] == 500
    assert found["nrmse"] == pytest.approx(np.linalg.norm(off) / np.linalg.norm(true))
    centred = np.linalg.norm(true - true.mean())
    assert found["nrmse_centred"] == pytest.approx(np.linalg.norm(off) / centred)
    assert found["max"] == pytest.approx(off[np.argmax(np.abs(off))])
    assert found["rms"] == pytest.approx(np.sqrt(np.mean(off**2)))
    assert found["lag"] == pytest.approx(0.0, abs=1e-5)
    with pytest.raises(InputError, match="do not overlap"):
        match(run, (EVERY + 10**10, time))


def test_what_is_no_number_is_left_out_of_a_match() -> None:
    x = np.sin(np.arange(1000) * 0.01)
    y = x.copy()
    y[100:200] = np.nan
    found = match((EVERY, x), (EVERY, y))
    assert np.abs(found.difference).max() < 1e-2 and found.numbers()["max"] is not None


BITS = st.one_of(st.floats(allow_nan=False, allow_infinity=False), st.just(np.nan))


@given(
    st.lists(st.integers(1, 10**12), min_size=2, max_size=8),
    st.data(),
    st.sampled_from([".csv", ".parquet"]),
)
@settings(max_examples=60, derandomize=True, deadline=None)
def test_a_record_is_read_back_to_the_bit(
    tmp_path_factory: Any, steps: list[int], data: Any, suffix: str
) -> None:
    ns = np.cumsum(steps) - 5 * 10**11
    rows = len(ns)
    wide = st.lists(st.lists(BITS, min_size=3, max_size=3), min_size=rows, max_size=rows)
    x = np.array(data.draw(wide))
    k = np.array(
        data.draw(st.lists(st.integers(-(2**31), 2**31 - 1), min_size=rows, max_size=rows))
    )
    units = {"a.X": "mm", 'b, "q" [1]': None, "on": "1"}
    columns = {"a.X": x, 'b, "q" [1]': k.astype(np.int32), "on": k > 0}
    record = Record("made", ns, columns, units)
    file = tmp_path_factory.mktemp("bits") / f"record{suffix}"
    record.save(file)
    found = motionfmu.record(file)
    assert np.array_equal(found.ns, ns)
    assert found["a.X"].tobytes() == np.where(np.isnan(x), np.nan, x).tobytes()
    assert np.array_equal(found["on"], columns["on"])
    assert found.units["a.X"] == "mm"
    if suffix == ".parquet":
        assert {n: v.dtype for n, v in found.items()} == {n: v.dtype for n, v in record.items()}
        assert dict(found.units) == units


def test_matlab(tmp_path: Path) -> None:
    time = np.arange(5) * 0.001
    scipy.io.savemat(
        tmp_path / "a.mat",
        {"t": time, "q": time * 2, "wide": np.ones((3, 5)), "kv": 243.45, "name": "EMPS"},
    )
    found = motionfmu.record(tmp_path / "a.mat", columns={"x": {"column": "q", "unit": "mm"}})
    assert found.ns.tolist() == [0, 1_000_000, 2_000_000, 3_000_000, 4_000_000]
    assert found["x"].tolist() == (time * 2).tolist()
    assert found["wide"].shape == (5, 3)
    scipy.io.savemat(
        tmp_path / "b.mat", {"out": {"time": time, "signals": {"values": np.c_[time, time]}}}
    )
    found = motionfmu.record(tmp_path / "b.mat")
    assert found["out.signals.values"].shape == (5, 2)


def test_part_and_shift(tmp_path: Path) -> None:
    record = made(EVERY, x=EVERY * 1.0)
    part = record.part(0.1, 0.2)
    assert (len(part.ns), part.time[0]) == (101, 0.1)
    assert record.shifted(-0.1).time[0] == -0.1
    with pytest.raises(InputError, match="less than two samples"):
        record.part(2.0, 3.0)
    with pytest.raises(InputError, match=r"written as .csv or .parquet"):
        record.save(tmp_path / "a.txt")


def test_a_column_of_a_signal_of_a_result_is_mapped(tmp_path: Path) -> None:
    """A result's signal with several values has a column for each, by its number."""
    (tmp_path / "signals").mkdir()
    (tmp_path / "result.json").write_text('{"units": {"a.place": "m", "a.on": "1"}}')
    time = EVERY * 1e-9
    signals = {"time": time, "a.place": np.outer(time, [1.0, 2.0, 3.0]), "a.on": time > 0.5}
    for name, values in signals.items():
        np.save(tmp_path / f"signals/{name}.npy", values)
    second = {"Y": {"column": "a.place[2]", "unit": "mm"}}
    found = motionfmu.record(tmp_path, columns=second)
    assert np.allclose(found["Y"], 2.0 * time) and found.units["Y"] == "mm"
