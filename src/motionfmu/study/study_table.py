"""The Parquet file of a study: written and read in groups of rows, never all at once."""

import json
import os
from collections.abc import Iterable, Iterator, Sequence
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError
from motionfmu.study.study_definition import Study
from motionfmu.study.worker import Row

ABOUT = b"motionfmu"  # key of the table's metadata
GROUP = 10_000  # rows in memory at a time, and in a row group of the file
OWN = ("run", "status", "message", "checks")


class TableRows(Sequence[Row]):
    """The rows of a table, read when they are asked for, a group at a time.

    The file stays open, so these are its rows even when a later study has replaced it.
    """

    def __init__(self, table: Path) -> None:
        import pyarrow.parquet as pq

        try:
            self._file: Any = pq.ParquetFile(table)
            metadata = self._file.schema_arrow.metadata or {}
            self.about: dict[str, Any] = json.loads(metadata.get(ABOUT, b"{}"))
        except (OSError, ValueError) as error:
            raise InputError(f"{table}: not a table of a study ({error})") from None
        groups = self._file.metadata
        sizes = [groups.row_group(k).num_rows for k in range(groups.num_row_groups)]
        self._first = np.cumsum([0, *sizes])  # place of the first row of each group
        self._group: tuple[int, list[Row]] = (-1, [])

    def __len__(self) -> int:
        return int(self._first[-1])

    def __getitem__(self, which: Any) -> Any:
        if isinstance(which, slice):
            return [self._row(k) for k in range(*which.indices(len(self)))]
        if not -len(self) <= which < len(self):
            raise IndexError(which)
        return self._row(which % len(self))

    def __iter__(self) -> Iterator[Row]:
        for group in range(len(self._first) - 1):
            yield from self._read(group)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Sequence) or len(self) != len(other):
            return False
        return all(mine == theirs for mine, theirs in zip(self, other, strict=True))

    def __repr__(self) -> str:
        return f"<{len(self)} rows of a study's table>"

    def _row(self, place: int) -> Row:
        group = int(np.searchsorted(self._first, place, side="right")) - 1
        if self._group[0] != group:
            self._group = group, self._read(group)
        return self._group[1][place - int(self._first[group])]

    def _read(self, group: int) -> list[Row]:
        names = self.about["results"]
        data = self._file.read_row_group(group, columns=[*OWN, *names])
        columns = [data.column(n).to_pylist() for n in OWN]
        values = [data.column(n).to_pylist() for n in names]
        numbers = zip(*values, strict=True) if values else ((),) * data.num_rows
        return [
            Row(run, status, message, checks, tuple(v))
            for run, status, message, checks, v in zip(*columns, numbers, strict=True)
        ]

    def numbers(self, name: str) -> NDArray[np.float64]:
        """A column of numbers, shape (n,); NaN where a cell is empty."""
        column = self._file.read(columns=[name]).column(name)
        return np.asarray(column.to_numpy(), dtype=np.float64)

    def own(self) -> Iterator[tuple[int, str, str, bool | None]]:
        """Run, status, message and checks of each row."""
        for group in range(len(self._first) - 1):
            data = self._file.read_row_group(group, columns=list(OWN))
            yield from zip(*(data.column(n).to_pylist() for n in OWN), strict=True)


def write(table: Path, study: Study, rows: Iterable[Row]) -> None:
    """Write the rows of a study as they come, whole or not at all.

    Columns: ``run``; one per axis; ``status``, ``message``, ``checks``; one per result. The
    metadata ``motionfmu`` says which study they belong to, that of a column its unit.
    """
    import pyarrow.parquet as pq

    schema, part = _schema(study), table.with_name(f".{table.name}.part")
    coming = iter(rows)
    try:
        with pq.ParquetWriter(part, schema) as writer:
            while some := list(islice(coming, GROUP)):
                writer.write_table(_group(study, schema, some))
        with part.open("rb") as written:
            os.fsync(written.fileno())
        part.replace(table)
    finally:
        part.unlink(missing_ok=True)


def _group(study: Study, schema: Any, rows: list[Row]) -> Any:
    import pyarrow as pa

    runs = [row.run for row in rows]
    columns: list[list[Any]] = [runs]
    columns += [study.points.column(i, runs) for i in range(len(study.axes))]
    columns += [[getattr(row, name) for row in rows] for name in OWN[1:]]
    columns += [[row.values[i] for row in rows] for i in range(len(study.columns))]
    arrays = [pa.array(c, f.type) for c, f in zip(columns, schema, strict=True)]
    return pa.Table.from_arrays(arrays, schema=schema)


def _schema(study: Study) -> Any:
    import pyarrow as pa

    types = {"Float64": pa.float64(), "Int32": pa.int64(), "Boolean": pa.bool_()}
    fields = [pa.field("run", pa.int64())]
    for axis in study.axes:
        kind = types.get(axis.end.port.type, pa.string())
        fields.append(pa.field(axis.name, kind, metadata={"unit": axis.unit}))
    fields += [pa.field("status", pa.string()), pa.field("message", pa.string())]
    fields.append(pa.field("checks", pa.bool_()))
    for column in study.columns:
        fields.append(pa.field(column.name, pa.float64(), metadata={"unit": column.unit}))
    about = {
        "study": study.digest,
        "scenario": study.name,
        "about": study.about,
        "sampling": study.sampling,
        "seed": study.seed,
        "runs": len(study.points),
        "axes": list(study.job.axes),
        "results": list(study.job.columns),
        "cost": study.cost,
    }
    return pa.schema(fields, metadata={ABOUT: json.dumps(about).encode()})
