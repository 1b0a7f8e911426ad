"""Rows of a study on the disk: a journal while it runs, one Parquet file of all rows that are done.

Each row is written to the journal (JSON, one line for each row) as soon as its run has ended. When
a study ends, and when it is resumed, the journal is merged into the Parquet file, which is written
under another name and renamed. So a study that is killed loses only the runs that were not done.
"""

import contextlib
import json
import os
from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path
from typing import Any

from motionfmu.base.errors import InputError
from motionfmu.base.locking import lock
from motionfmu.study.study_definition import Study
from motionfmu.study.worker import CRASH, Row

TABLE, JOURNAL = "sweep.parquet", "sweep.jsonl"
ABOUT = b"motionfmu"  # key of the table's metadata


class Book:
    """The rows of one study in a folder: use it in `with`, or `close`.

    The folder is new, empty, or has rows of this study, and no other process writes there; else
    there is an InputError. A fresh book removes all rows in the folder, also of another study.
    """

    def __init__(self, folder: Path, study: Study, fresh: bool = False) -> None:
        self.folder, self.study = _usable(folder), study
        self.table, self.journal = self.folder / TABLE, self.folder / JOURNAL
        self.done: dict[int, Row] = {}  # by number of the run; a crashed run is not done
        self._new = [f for f in (self.folder, *self.folder.parents) if not f.exists()]
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            self._file = _locked(self.journal)
        except OSError as error:
            raise InputError(f"cannot write {self.folder}: {error.strerror or error}") from None
        try:
            if fresh:
                self.table.unlink(missing_ok=True)
                os.ftruncate(self._file, 0)
            self._resume()
        except BaseException:
            os.close(self._file)
            raise

    def _resume(self) -> None:
        found = {}
        if self.table.exists():
            self._same(_about(self.table).get("study"), self.table)
            found = {row.run: row for row in read(self.table)}
        lines = _whole_lines(self._file)
        if lines:
            self._same(lines[0].get("study"), self.journal)
        for line in lines[1:]:
            row = Row(**line | {"values": tuple(line["values"])})
            found[row.run] = row
        self.done = {run: row for run, row in found.items() if row.status != CRASH}
        if len(lines) > 1:
            self._write_table(self.done.values())
        os.ftruncate(self._file, 0)
        self._line({"study": self.study.digest})

    def _same(self, digest: Any, file: Path) -> None:
        if digest != self.study.digest:
            raise InputError(
                f"{file} holds another study, or one of other files or FMUs: --new to begin"
                " again, --out for another place"
            )

    def _line(self, content: dict[str, Any]) -> None:
        """Write a line at once, so that only the last line of a journal can be incomplete."""
        data = (json.dumps(content, allow_nan=False) + "\n").encode()
        try:
            if os.write(self._file, data) != len(data):
                raise OSError(28, "No space left on device")
        except OSError as error:
            raise InputError(f"cannot write {self.journal}: {error.strerror}") from None

    def add(self, row: Row) -> None:
        """Add a row to the journal."""
        self._line(asdict(row))
        self.done[row.run] = row

    def finish(self) -> list[Row]:
        """Merge the journal into the table and remove it."""
        rows = [self.done[run] for run in sorted(self.done)]
        self._write_table(rows)
        self.journal.unlink()
        return rows

    def _write_table(self, rows: Iterable[Row]) -> None:
        try:
            write(self.table, self.study, sorted(rows, key=lambda row: row.run))
        except OSError as error:
            raise InputError(f"cannot write {self.table}: {error.strerror or error}") from None

    def close(self) -> None:
        """Release the folder for other processes; an empty journal or folder is removed."""
        if not self.done and not self.table.exists() and self.journal.exists():
            self.journal.unlink()
            for folder in self._new:
                with contextlib.suppress(OSError):
                    folder.rmdir()
        os.close(self._file)

    def __enter__(self) -> "Book":
        return self

    def __exit__(self, *error: object) -> None:
        self.close()


def _usable(folder: Path) -> Path:
    folder = folder.resolve()
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{folder} is a file, not a folder")
    if folder.exists() and any(folder.iterdir()):
        if not any((folder / name).exists() for name in (TABLE, JOURNAL)):
            raise InputError(f"{folder} holds no earlier study; it is left as it is")
    return folder


def _locked(journal: Path) -> int:
    """Open the journal for this process alone."""
    while True:
        file = os.open(journal, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o666)
        try:
            lock(file, journal, "another sweep is running here")
        except InputError:
            os.close(file)
            raise
        if _is_same(file, journal):
            return file
        os.close(file)  # the process that had locked it has removed it since


def _is_same(file: int, path: Path) -> bool:
    try:
        return os.path.samestat(os.fstat(file), path.stat())
    except FileNotFoundError:
        return False


def _whole_lines(file: int) -> list[dict[str, Any]]:
    """Lines of a journal up to an incomplete one, which a killed process left."""
    data = os.pread(file, os.fstat(file).st_size, 0)
    found = []
    for line in data.split(b"\n")[:-1]:
        try:
            found.append(json.loads(line))
        except ValueError:
            break
    return found


def _about(table: Path) -> dict[str, Any]:
    """Metadata of a table about its study."""
    import pyarrow.parquet as pq

    try:
        metadata = pq.read_schema(table).metadata or {}
        return dict(json.loads(metadata.get(ABOUT, b"{}")))
    except (OSError, ValueError) as error:
        raise InputError(f"{table}: not a table of a study ({error})") from None


def read(table: Path) -> list[Row]:
    """Read the rows of a sweep.parquet, in its order."""
    import pyarrow.parquet as pq

    names = _about(table)["results"]
    data = pq.read_table(table)
    columns = [data.column(n).to_pylist() for n in ("run", "status", "message", "checks")]
    values = [data.column(n).to_pylist() for n in names]
    numbers = zip(*values, strict=True) if values else ((),) * data.num_rows
    return [
        Row(run, status, message, checks, tuple(v))
        for run, status, message, checks, v in zip(*columns, numbers, strict=True)
    ]


def write(table: Path, study: Study, rows: list[Row]) -> None:
    """Write the rows of a study, whole or not at all.

    Columns: ``run``; one per axis; ``status``, ``message``, ``checks``; one per result. The
    metadata ``motionfmu`` says which study they belong to, that of a column its unit.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    types = {"Float64": pa.float64(), "Int32": pa.int64(), "Boolean": pa.bool_()}
    columns: list[list[Any]] = [[row.run for row in rows]]
    fields = [pa.field("run", pa.int64())]
    for i, axis in enumerate(study.axes):
        kind = types.get(axis.end.port.type, pa.string())
        fields.append(pa.field(axis.name, kind, metadata={"unit": axis.unit}))
        columns.append([study.points[row.run][i] for row in rows])
    fields += [pa.field("status", pa.string()), pa.field("message", pa.string())]
    fields.append(pa.field("checks", pa.bool_()))
    columns += [[row.status for row in rows], [row.message for row in rows]]
    columns.append([row.checks for row in rows])
    for i, column in enumerate(study.columns):
        fields.append(pa.field(column.name, pa.float64(), metadata={"unit": column.unit}))
        columns.append([row.values[i] for row in rows])
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
    schema = pa.schema(fields, metadata={ABOUT: json.dumps(about).encode()})
    arrays = [pa.array(c, f.type) for c, f in zip(columns, fields, strict=True)]
    part = table.with_name(f".{table.name}.part")
    try:
        pq.write_table(pa.Table.from_arrays(arrays, schema=schema), part)
        with part.open("rb") as written:
            os.fsync(written.fileno())
        part.replace(table)
    finally:
        part.unlink(missing_ok=True)
