"""Runs points of a study, one after another, in a process of its own.

Every run gives a `Row`, even one that failed. `motionfmu.study.processes` starts `main`,
`motionfmu.study.cluster` calls `serving`.
"""

import signal
import sys
import threading
from collections.abc import Sequence
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Any

from motionfmu.base import heap
from motionfmu.base.errors import InputError, NoNumber
from motionfmu.run import load, machine
from motionfmu.run.result import Result
from motionfmu.run.session import Session
from motionfmu.scenarios.body import CHECK
from motionfmu.study.study_axes import Point
from motionfmu.study.study_columns import column, signals
from motionfmu.study.study_definition import WorkerJob, digest

OK, ERROR, CRASH = "ok", "error", "crash"


@dataclass(frozen=True)
class Row:
    """The row of one run."""

    run: int  # number of the point, from 0
    # ``ok``; ``error``: a value was refused; ``crash``: the run ended its process, and is tried
    # again when the study is resumed.
    status: str
    message: str  # what went wrong, or why a number is missing; else empty
    # Whether what must hold for any setting does; None if that is nothing, or the run gave none.
    checks: bool | None
    values: tuple[float | None, ...]  # one per column; None where the run has no number


class Worker:
    """A session of a study's scenario."""

    # Raises an InputError if the scenario or the FMUs on this machine are not those of the study.

    def __init__(self, job: WorkerJob) -> None:
        self.job = job
        scenario = (
            machine(job.machine).scenario(job.scenario) if job.machine else load(job.scenario)
        )
        if digest(scenario, job.named) != job.digest:
            raise InputError(f"{job.scenario}: a worker has other files or FMUs than the study")
        self._columns = [column(scenario, name) for name in job.columns]
        recorded = signals(scenario, self._columns)
        options: dict[str, Any] = {"set": job.set, "stop": job.stop, "step": job.step}
        self._session = Session(scenario, job.axes, recorded, **options)

    @property
    def lanes(self) -> int:
        """How many points run side by side."""
        return self._session.lanes

    def rows(self, tasks: Sequence[tuple[int, Point]]) -> list[Row]:
        """Run some points, which have a number and a value per axis, side by side if they can."""
        given = [dict(zip(self.job.axes, point, strict=True)) for _, point in tasks]
        found: list[Row] = []
        for first in range(0, len(given), self.lanes):
            runs, some = tasks[first : first + self.lanes], given[first : first + self.lanes]
            ran = self._ran(some)
            while ran:  # signals of a run that has its row are let go
                found.append(self._row(runs[len(runs) - len(ran)][0], ran.pop(0)))
        return found

    def _ran(self, given: Sequence[dict[str, Any]]) -> list[Result | Exception]:
        try:
            return [*self._session.run_together(given)]
        except Exception:  # the study goes on: one by one it shows whose it is
            return [self._alone(values) for values in given]

    def _alone(self, values: dict[str, Any]) -> Result | Exception:
        try:
            return self._session.run(values)
        except Exception as error:
            return error

    def _row(self, run: int, result: Result | Exception) -> Row:
        if isinstance(result, Exception):
            return Row(run, ERROR, _told(result), None, (None,) * len(self._columns))
        values: list[float | None] = []
        missing: dict[str, None] = {}
        wrong = ""
        for wanted in self._columns:
            value = None
            try:
                value = wanted.of(result)
            except NoNumber as reason:
                missing[str(reason)] = None
            except Exception as error:
                wrong = wrong or _told(error)
            values.append(value)
        must = [v.within for v in result.checks if v.table == CHECK]  # no point is as written
        checks = all(must) if must else None
        if wrong:
            return Row(run, ERROR, wrong, checks, tuple(values))
        return Row(run, OK, "; ".join(missing), checks, tuple(values))

    def close(self) -> None:
        """Free the FMUs and their files."""
        self._session.close()


def _told(error: Exception) -> str:
    """The message of an error; that of a mistake in the program begins with the error's type."""
    return str(error) if isinstance(error, InputError) else f"{type(error).__name__}: {error}"


_kept = threading.local()  # one session per thread: a process of a cluster may have several


def serving(job: WorkerJob) -> Worker:
    """This thread's worker for a study; it stays for the next call."""
    worker: Worker | None = getattr(_kept, "worker", None)
    if worker is None or worker.job != job:
        if worker is not None:
            _kept.worker = None
            worker.close()
        worker = _kept.worker = Worker(job)
    return worker


def chunk(job: WorkerJob, points: Sequence[tuple[int, Point]]) -> list[Row]:
    """Run some points in this thread."""
    return serving(job).rows(points)


def main(pipe: int) -> None:
    """Serve the process that started this one until it is gone.

    The pipe, a file descriptor, brings the job and then lists of points. It takes back how many run
    side by side, or an error, then lists of rows.
    """
    signal.signal(signal.SIGTERM, lambda *_: sys.exit())  # files are removed on the way out
    heap.keep_freed()
    with Connection(pipe) as connection:
        try:
            worker = Worker(connection.recv())
        except InputError as error:
            connection.send(error)
            return
        try:
            connection.send(worker.lanes)
            while True:
                connection.send(worker.rows(connection.recv()))
        except (EOFError, BrokenPipeError, ConnectionResetError):
            pass  # the study has ended, or its process
        finally:
            worker.close()
