"""Rows of a study on the disk: a journal while it runs, one Parquet file of all rows that are done.

Each row is written to the journal (JSON, one line for each row) as soon as its run has ended. When
a study ends, and when it is resumed, the journal is merged into the Parquet file, which is written
under another name and renamed. So a study that is killed loses only the runs that were not done.

No row stays in memory. Of each run it is known whether it is done and where its line is, 9 bytes,
so that the merge reads lines in the order of runs.
"""

import contextlib
import heapq
import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from motionfmu.base.errors import InputError
from motionfmu.base.locking import lock
from motionfmu.study.study_definition import Study
from motionfmu.study.study_table import TableRows, write
from motionfmu.study.worker import ERROR, OK, Row

TABLE, JOURNAL = "sweep.parquet", "sweep.jsonl"
DONE = {OK: 1, ERROR: 2}  # a run that crashed is not done when a study is resumed


class Book:
    """The rows of one study in a folder: use it in `with`, or `close`.

    The folder is new, empty, or has rows of this study, and no other process writes there; else
    there is an InputError. A fresh book removes all rows in the folder, also of another study.
    """

    def __init__(self, folder: Path, study: Study, fresh: bool = False) -> None:
        self.folder, self.study = _usable(folder), study
        self.table, self.journal = self.folder / TABLE, self.folder / JOURNAL
        self.done = bytearray(len(study.points))  # 1: has a row, 2: one with an error; else 0
        self._lines = np.full(len(study.points), -1, dtype=np.int64)  # places in the journal [byte]
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
        if self.table.exists():
            rows = TableRows(self.table)
            self._same(rows.about.get("study"), self.table)
            for run, status, _, _ in rows.own():
                self.done[run] = DONE.get(status, 0)
        self._end = 0
        with self.journal.open("rb") as journal:
            for place, line in _whole_lines(journal):
                if not place:
                    self._same(line.get("study"), self.journal)
                else:
                    self._lines[line["run"]] = place
                    self.done[line["run"]] = DONE.get(line["status"], 0)
        if (self._lines >= 0).any():
            self._lines[np.frombuffer(self.done, np.uint8) == 0] = -1  # to be run again
            self._fold()
        os.ftruncate(self._file, 0)
        self._lines.fill(-1)
        self._line({"study": self.study.digest})

    @property
    def count(self) -> int:
        """Runs that have a row."""
        return len(self.done) - self.done.count(0)

    @property
    def errors(self) -> int:
        """Runs whose row is an error."""
        return self.done.count(DONE[ERROR])

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
        self._end += len(data)

    def add(self, row: Row) -> None:
        """Add a row to the journal."""
        place = self._end
        self._line(vars(row))
        self._lines[row.run] = place
        self.done[row.run] = DONE.get(row.status, DONE[ERROR])

    def finish(self) -> TableRows:
        """Merge the journal into the table and remove it."""
        self._fold()
        self.journal.unlink()
        return TableRows(self.table)

    def _fold(self) -> None:
        """Write the table anew from its rows and those of the journal, which count more."""
        try:
            with self.journal.open("rb") as journal:
                both = heapq.merge(self._kept(), self._new_rows(journal), key=lambda row: row.run)
                write(self.table, self.study, both)
        except OSError as error:
            raise InputError(f"cannot write {self.table}: {error.strerror or error}") from None

    def _kept(self) -> Iterator[Row]:
        """Rows of the table that stay: a run that crashed is no row, a line replaces one."""
        if self.table.exists():
            for row in TableRows(self.table):
                if row.status in DONE and self._lines[row.run] < 0:
                    yield row

    def _new_rows(self, journal: BinaryIO) -> Iterator[Row]:
        """Rows of the journal in the order of runs."""
        for run in np.flatnonzero(self._lines >= 0):
            journal.seek(int(self._lines[run]))
            line = json.loads(journal.readline())
            yield Row(**line | {"values": tuple(line["values"])})

    def close(self) -> None:
        """Release the folder for other processes; an empty journal or folder is removed."""
        if not self.count and not self.table.exists() and self.journal.exists():
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


def _whole_lines(journal: BinaryIO) -> Iterator[tuple[int, dict[str, Any]]]:
    """Places and contents of a journal's lines up to an incomplete one, which a kill has left."""
    place = 0
    for line in journal:
        try:
            if not line.endswith(b"\n"):
                return
            yield place, json.loads(line)
        except ValueError:
            return
        place += len(line)
