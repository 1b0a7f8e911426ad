"""A record as a file that is read back to the bit."""

import csv
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.base.errors import InputError
from motionfmu.base.extras import needed

BLOCK = 1 << 14  # rows that are made text at once


@dataclass(frozen=True)
class RecordColumns:
    """What of a record a file holds."""

    ns: Any  # (n,) times
    columns: Mapping[str, Any]  # (n,) or (n, k)
    units: Mapping[str, str | None]


def write(record: RecordColumns, file: Path) -> Path:
    """Write a record, whole or not at all, as the ending of the file's name says."""
    kinds = {".csv": _write_csv, ".parquet": _write_parquet}
    if file.suffix.lower() not in kinds:
        raise InputError(f"{file}: a record is written as {' or '.join(kinds)}")
    part = file.with_name(f".{file.name}.part{os.getpid()}")
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        kinds[file.suffix.lower()](record, part)
        part.replace(file)
    except OSError as error:
        raise InputError(f"cannot write {file}: {error.strerror or error}") from None
    finally:
        part.unlink(missing_ok=True)
    return file.resolve()


def _seconds(ns: int) -> str:
    """A time [s] with all its digits."""
    whole, part = divmod(abs(ns), 10**9)
    return f"{'-' * (ns < 0)}{whole}.{part:09d}"


def _head(name: str, unit: str | None) -> str:
    return name if unit is None else f"{name} [{unit}]"


def _write_csv(record: RecordColumns, file: Path) -> None:
    heads = ["time [s]"]
    for name, data in record.columns.items():
        parts = [name] if data.ndim == 1 else [f"{name}[{i + 1}]" for i in range(data.shape[1])]
        heads += [_head(part, record.units.get(name)) for part in parts]
    with file.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(heads)
        for first in range(0, len(record.ns), BLOCK):
            rows = slice(first, first + BLOCK)
            texts = [[_seconds(int(t)) for t in record.ns[rows]]]
            for data in record.columns.values():
                block = np.asarray(data[rows])
                texts += [_texts(c) for c in block.reshape(len(block), -1).T]
            writer.writerows(zip(*texts, strict=True))


def _texts(column: Any) -> list[str]:
    """Numbers with all their digits; an empty text for what is none."""
    if column.dtype.kind == "f":
        return ["" if np.isnan(x) else repr(float(x)) for x in column]
    return [str(int(x)) for x in column]


def _write_parquet(record: RecordColumns, file: Path) -> None:
    needed("study")
    import pyarrow
    from pyarrow import parquet

    fields = [pyarrow.field("time", pyarrow.int64(), metadata={"unit": "ns"})]
    columns = [pyarrow.array(np.asarray(record.ns))]
    for name, data in record.columns.items():
        whole = np.ascontiguousarray(data)
        flat = pyarrow.array(whole.reshape(-1))
        if whole.ndim == 2:
            flat = pyarrow.FixedSizeListArray.from_arrays(flat, whole.shape[1])
        unit = record.units.get(name)
        fields.append(pyarrow.field(name, flat.type, metadata={"unit": unit or ""}))
        columns.append(flat)
    table = pyarrow.table(columns, schema=pyarrow.schema(fields))
    parquet.write_table(table, file)
