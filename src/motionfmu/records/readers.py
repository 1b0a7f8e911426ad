"""A record from whatever holds one: a file, a folder of a run's result, a run itself."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.base.columns import Columns
from motionfmu.base.errors import InputError
from motionfmu.base.toml_lines import is_file, shown
from motionfmu.records.csv_table import csv_table
from motionfmu.records.layout import Layout
from motionfmu.records.mat_table import mat_table
from motionfmu.records.parquet_table import parquet_table
from motionfmu.records.raw_table import RawTable, record_of
from motionfmu.records.signal_record import Record

TEXTS = (".csv", ".txt", ".tsv", ".dat", ".log", ".asc")
TABLES = {".parquet": parquet_table, ".mat": mat_table} | dict.fromkeys(TEXTS, csv_table)
SUFFIXES = tuple(TABLES)
_NUMBERS, _SIGNALS = "result.json", "signals"


def is_record_file(path: str | Path) -> bool:
    """Whether a path is that of a file that may hold a record.

    Parameters
    ----------
    path : str or Path
    """
    return Path(path).suffix.lower() in SUFFIXES and is_file(Path(path))


def record(source: Any, **layout: Any) -> Record:
    """Read a record: signals over time with their units.

    Parameters
    ----------
    source : str, Path, Result or Record
        A text of columns (.csv, .txt, .tsv, .dat, .log, .asc), Parquet, a MATLAB file up to version
        7; the folder of a run's result, or a result, whose signals are a record, too.
    **layout
        What a file does not say, as of `Layout`: columns, time, time_unit, rate, offset, delimiter,
        decimal, encoding, skip, names, duplicates, missing.

    Returns
    -------
    Record

    Raises
    ------
    InputError
        What is wrong, with file, line and character; of a Parquet or MATLAB file with the column.

    Examples
    --------
    >>> trace = motionfmu.record("trace.csv", columns={"position": "Enc1"})  # doctest: +SKIP
    >>> trace.values("position", "mm")  # doctest: +SKIP
    """
    asked = Layout.of(layout)
    if isinstance(source, Record):
        return _changed(source, asked)
    own = getattr(source, "record", None)  # of a result
    if callable(own):
        return _changed(own(), asked)
    if not isinstance(source, str | Path):
        raise InputError(f"{shown(source)}: the path of a record wanted")
    path = Path(source)
    if path.is_dir():
        return _changed(_of_result(path), asked)
    if not is_file(path):
        raise InputError(f"{path}: {'not a regular file' if path.exists() else 'no such file'}")
    reader = TABLES.get(path.suffix.lower())
    if reader is None:
        raise InputError(f"{path}: no record: {', '.join(SUFFIXES)} wanted")
    return record_of(reader(path, asked), asked)


def _of_result(folder: Path) -> Record:
    """The signals of a run that its folder holds."""
    file = folder / _NUMBERS
    if not is_file(file) or not (folder / _SIGNALS).is_dir():
        raise InputError(f"{folder}: no folder of a result with {_NUMBERS} and {_SIGNALS}/")
    try:
        units = dict(json.loads(file.read_text(encoding="utf-8"))["units"])
        signals = Columns.of(folder / _SIGNALS, units)
        time = signals.time
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise InputError(f"{file}: no result of this version: {error}") from None
    if time is None or len(time) < 2:
        raise InputError(f"{folder / _SIGNALS}: no times, or less than two")
    return Record(str(folder), np.rint(time * 1e9).astype(np.int64), signals, units)


def _changed(found: Record, asked: Layout) -> Record:
    """A record whose columns a caller maps, and whose times are moved."""
    if asked == Layout():
        return found
    names = [e for n, x in found.columns.items() for e in _elements(n, x.ndim and x.shape[1:])]
    table = RawTable(
        found.name,
        names,
        [found.units.get(n.rpartition("[")[0] if n not in found.columns else n) for n in names],
        [np.asarray(found[n]) for n in names],
        lambda row, column: found.name if row < 0 else found.place(row),
        found.lines,
        list(found.notes),
    )
    timed = replace(
        table,
        names=[*names, "\0"],
        units=[*table.units, "ns"],
        values=[*table.values, found.ns],
        timed=len(names),
    )
    return record_of(timed, asked)


def _elements(name: str, shape: Any) -> list[str]:
    return [f"{name}[{i + 1}]" for i in range(shape[0])] if shape else [name]
