"""Texts of columns as drives, oscilloscopes and spreadsheets write them, and other readers."""

import io
import tempfile
from datetime import timedelta
from pathlib import Path
from typing import Any

import numpy as np
import pandas
import pyarrow
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pyarrow import csv as arrow

import motionfmu
from motionfmu.records import Record


def read(text: str, folder: Path, encoding: str = "utf-8", **layout: Any) -> Record:
    file = folder / "trace.csv"
    file.write_bytes(text.encode(encoding))
    return motionfmu.record(file, **layout)


REAL = st.floats(-1e9, 1e9, allow_nan=False).map(lambda x: float(f"{x:.12g}"))
FULL = st.floats(allow_nan=False, allow_infinity=False)


@st.composite
def tables(draw: Any) -> tuple[str, str, str, np.ndarray, bool]:
    """A text, its delimiter and decimal sign, the numbers in it, and whether some are missing."""
    delimiter, decimal = draw(
        st.sampled_from([(",", "."), (";", "."), (";", ","), ("\t", "."), ("\t", ","), ("|", ".")])
    )
    rows, columns = draw(st.integers(2, 12)), draw(st.integers(1, 4))
    cell = st.one_of(REAL, FULL, st.integers(-(10**6), 10**6).map(float))
    holes = draw(st.booleans())
    wide = st.lists(
        st.one_of(cell, st.just(np.nan)) if holes else cell, min_size=columns, max_size=columns
    )
    data = np.array(draw(st.lists(wide, min_size=rows, max_size=rows)))
    time = np.arange(rows) * draw(st.sampled_from([1, 25, 1000, 1_000_000, 62_500])) / 1e9
    end = draw(st.sampled_from(["\n", "\r\n"]))
    head = draw(st.booleans())
    quoted = draw(st.booleans())
    table = np.column_stack([time, data])

    def text(x: float) -> str:
        shown = "" if np.isnan(x) else repr(float(x)).replace(".", decimal)
        return f'"{shown}"' if quoted and shown else shown

    names = ["time [s]", *(f"x{k} [mm]" for k in range(columns))]
    lines = [delimiter.join(map(text, row)) for row in table]
    top = [f"Drive{delimiter}A 17", "", delimiter.join(names)] if head else [delimiter.join(names)]
    return end.join([*top, *lines]) + end, delimiter, decimal, table, head


@given(tables())
@settings(max_examples=300, derandomize=True, deadline=timedelta(seconds=2))
def test_every_dialect_is_read_as_pandas_and_arrow_read_it(
    table: tuple[str, str, str, np.ndarray, bool],
) -> None:
    text, delimiter, decimal, numbers, head = table
    with tempfile.TemporaryDirectory() as folder:
        found = read(text, Path(folder))
    columns = np.column_stack([found[n] for n in found])
    np.testing.assert_array_equal(columns, numbers[:, 1:])
    np.testing.assert_array_equal(found.time, numbers[:, 0])
    skipped = 2 if head else 0
    other = pandas.read_csv(io.StringIO(text), sep=delimiter, decimal=decimal, skiprows=skipped)
    np.testing.assert_array_equal(columns, other.to_numpy(dtype=np.float64)[:, 1:])
    third = arrow.read_csv(
        io.BytesIO(text.encode()),
        read_options=arrow.ReadOptions(skip_rows=1 if head else 0),
        parse_options=arrow.ParseOptions(delimiter=delimiter),
        convert_options=arrow.ConvertOptions(
            decimal_point=decimal,
            column_types={n: pyarrow.float64() for n in other.columns},
            strings_can_be_null=True,
        ),
    )
    there = np.column_stack([c.to_numpy() for c in third.columns])
    np.testing.assert_array_equal(columns, there[:, 1:].astype(np.float64))


RIGOL = "X,CH1,Start,Increment,\nSequence,Volt,-1.0e-03,1.0e-04\n0,1.2e-1,\n1,1.4e-1,\n2,.1,\n"
PICO = "Time,Channel A,Channel B\n(ms),(V),(mV)\n\n-0.1,4.8,∞\n0.0,4.9,3\n0.1,5,4\n"
KEYSIGHT = "x-axis,1,2\nsecond,Volt,Volt\n-84.0E-06,0.0E+00,4.70E+00\n-82E-06,1,2\n-80E-6,3,4\n"
TEKTRONIX = (
    "Record Length,2.5e+03,,-0.0002,0.1,\nSample Interval,1e-04,,-0.0001,0.2,\n"
    "Trigger Point,1.25e+03,Samples,0.0,0.3,\n,,,0.0001,0.4,\n,,,0.0002,0.5,\n"
)
SPREADSHEET = "Zeit [s];Weg [mm];Kraft [N]\n0,000;1,5;2\n0,001;1,6;3\n0,002;;4\n"
COUNTED = "nr  time           ch1     ch2\n0  0   -0.16 -0.02\n1  2e-05 -.16 -.02\n2 4e-5 0 0\n"
STAMPED = (
    "Time stamp;n [1/min];Event\n2026-11-27 23:59:59.996;1;\n2026-11-28 00:00:00.000;2;\n"
    "2026-11-28 00:00:00,004;3;\n"
)
LOGGED = "# t [ms], X[1] [mm], X[2] [mm], on\n0,1,2,TRUE\n# a remark\n1,3,4,FALSE\n2,5,6,0x1\nEOF\n"
TWINCAT = "".join(
    line + "\n"
    for line in (
        "Name\tscope",
        "File\tC:\\scope.csv",
        "",
        "Name\tfast\tName\tslow\tslow2",
        "SymbolComment\t\tSymbolComment\t\t",
        "Data-Type\tREAL64\tData-Type\tREAL64\tREAL64",
        "SampleTime[ms]\t0,5\tSampleTime[ms]\t1\t1",
        "Unit\tA (Ampere)\tUnit\t(None)\tmm (Length)",
        "",
        "0\t0,25\t0\t10\t20",
        "0,5\t0,5\t1\t11\t21",
        "1\t0,75\t2\t12\t22",
        "1,5\t1",
        "2\t1,25",
    )
)


WRITTEN: list[Any] = [
    (RIGOL, {}, [-1_000_000, -900_000, -800_000], {"CH1": [0.12, 0.14, 0.1]}, {"CH1": "V"}),
    (
        PICO,
        {},
        [-100_000, 0, 100_000],
        {"Channel A": [4.8, 4.9, 5.0], "Channel B": [np.nan, 3.0, 4.0]},
        {"Channel A": "V", "Channel B": "mV"},
    ),
    (
        KEYSIGHT,
        {},
        [-84_000, -82_000, -80_000],
        {"1": [0, 1, 3], "2": [4.7, 2, 4]},
        {"1": "V", "2": "V"},
    ),
    (
        TEKTRONIX,
        {"names": ["time [s]", "CH1 [V]"]},
        [-200_000, -100_000, 0, 100_000, 200_000],
        {"CH1": [0.1, 0.2, 0.3, 0.4, 0.5]},
        {"CH1": "V"},
    ),
    (
        SPREADSHEET,
        {},
        [0, 1_000_000, 2_000_000],
        {"Weg": [1.5, 1.6, np.nan], "Kraft": [2, 3, 4]},
        {"Weg": "mm", "Kraft": "N"},
    ),
    (COUNTED, {}, [0, 20_000, 40_000], {"ch1": [-0.16, -0.16, 0]}, {"ch1": None}),
    (STAMPED, {"offset": "start"}, [0, 4_000_000, 8_000_000], {"n": [1, 2, 3]}, {"n": "rpm"}),
    (
        LOGGED,
        {},
        [0, 1_000_000, 2_000_000],
        {"X": [[1, 2], [3, 4], [5, 6]], "on": [1, 0, 1]},
        {"X": "mm"},
    ),
    (
        "0.5 1\n0.25 2\n",
        {"rate": 4000.0, "names": ["a", "b [A]"]},
        [0, 250_000],
        {"a": [0.5, 0.25], "b": [1, 2]},
        {"b": "A"},
    ),
    (
        TWINCAT,
        {"time": "slow"},
        [0, 1_000_000, 2_000_000],
        {"slow": [10, 11, 12], "slow2": [20, 21, 22]},
        {"slow": None, "slow2": "mm"},
    ),
    (
        TWINCAT,
        {"time": "fast"},
        [0, 500_000, 1_000_000, 1_500_000, 2_000_000],
        {"fast": [0.25, 0.5, 0.75, 1, 1.25]},
        {"fast": "A"},
    ),
    (
        "t,enc,u\n0,100,1\n1,110,2\n",
        {"columns": {"x": {"column": "enc", "scale": 0.5, "zero": 100, "unit": "µm"}}},
        [0, 1_000_000_000],
        {"x": [0, 5], "u": [1, 2]},
        {"x": "um", "u": None},
    ),
    (
        "time,x\n23:59:59.9,1\n00:00:00.1,2\n",
        {"offset": "start"},
        [0, 200_000_000],
        {"x": [1, 2]},
        {"x": None},
    ),
    (
        "t,x\n0,1.4\n1,2.6\n",
        {"columns": {"n": {"column": "x", "scale": 10, "round": True}}},
        [0, 1_000_000_000],
        {"n": [14, 26]},
        {"n": None},
    ),
    (
        "t,x\n0,1.4\n1,2.6\n",
        {"columns": {"n": {"column": "x", "round": True}}},
        [0, 1_000_000_000],
        {"n": [1, 3]},
        {"n": None},
    ),
    (
        "t,a [mm],b [mm]\n0,1,2\n1,3,4\n",
        {"columns": {"P": ["b", "a"]}},
        [0, 1_000_000_000],
        {"P": [[2, 1], [4, 3]]},
        {"P": "mm"},
    ),
]


@pytest.mark.parametrize(("text", "layout", "wanted"), [(a, b, c) for a, b, *c in WRITTEN])
def test_what_instruments_write(
    text: str, layout: dict[str, Any], wanted: Any, tmp_path: Path
) -> None:
    ns, columns, units = wanted
    found = read(text, tmp_path, **layout)
    assert found.ns.tolist() == ns
    for name, values in columns.items():
        np.testing.assert_array_equal(found[name], np.array(values, dtype=float))
    assert {n: found.units[n] for n in units} == units


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252", "latin-1"])
def test_encodings(encoding: str, tmp_path: Path) -> None:
    found = read("t [µs],φ [°]\n".replace("φ", "ä") + "0,1\n2,3\n", tmp_path, encoding)
    assert found.ns.tolist() == [0, 2000]
    assert found.units == {"ä": "deg"}


@pytest.mark.parametrize(
    ("way", "ns", "values"),
    [
        ("first", [0, 1, 2], [1.0, 2.0, 5.0]),
        ("last", [0, 1, 2], [1.0, 3.0, 5.0]),
        ("mean", [0, 1, 2], [1.0, 2.5, 5.0]),
    ],
)
def test_samples_of_one_time(way: str, ns: list[int], values: list[float], tmp_path: Path) -> None:
    found = read("t [ns],x\n0,1\n1,2\n1,3\n2,5\n", tmp_path, duplicates=way)
    assert (found.ns.tolist(), found["x"].tolist()) == (ns, values)
    assert "1 sample of a time that was there already" in found.notes


def test_a_sample_that_is_there_twice_is_one(tmp_path: Path) -> None:
    found = read("t [ns],x\n0,1\n1,2\n1,2\n2,5\n", tmp_path)
    assert found["x"].tolist() == [1.0, 2.0, 5.0]
    assert [found.place(k).rpartition(":")[2] for k in range(3)] == ["2", "3", "5"]


def test_gaps_and_what_is_missing(tmp_path: Path) -> None:
    found = read("t [ms],x\n0,1\n1,\n2,3\n5,4\n6,5\n", tmp_path)
    assert found.gaps == [(2, 3)]
    assert not found.even and found.rate is None
    assert found.missing("x").tolist() == [False, True, False, False, False]
