"""The workers on this machine: one process each, which gets one group of points after the other."""

import contextlib
import os
import subprocess
import tempfile
from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from multiprocessing import Pipe
from multiprocessing.connection import Connection, wait
from typing import Any

from motionfmu.base.children import child
from motionfmu.base.errors import InputError
from motionfmu.study.open_runs import Queue, Task
from motionfmu.study.study_definition import WorkerJob
from motionfmu.study.worker import CRASH, Row

# Groups of points that a worker has: one runs, the others wait, so that it never has to wait.
AHEAD = 4
UNREADY_MAX = 3  # workers in a row that a signal ends before their first run; then the study ends
PATIENCE = 10  # [s] for a worker to remove its files when it is told to end
# Variables that give each worker one thread, for there are as many workers as cores.
THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
# [byte] Settings of glibc's malloc: what a run has freed, tens of MB, stays for the next run. Given
# back to the system, each page of it costs a fault in the next run, 14 % of a run of the demo.
MEMORY = {
    "MALLOC_TOP_PAD_": str(1 << 26),
    "MALLOC_TRIM_THRESHOLD_": str(1 << 28),
    "MALLOC_MMAP_THRESHOLD_": str(1 << 25),
}


def cores() -> int:
    """Number of processors this process may use."""
    return len(os.sched_getaffinity(0))


@dataclass
class _Process:
    """A worker's process, this end of its pipe, and its groups, of which the first one runs."""

    process: "subprocess.Popen[bytes]"
    pipe: Connection
    groups: deque[list[Task]] = field(default_factory=deque)
    lanes: int = 0  # so many points run side by side; 0: it is not ready yet


def _start(job: WorkerJob, temporary: str) -> _Process:
    ours, theirs = Pipe()
    with theirs:
        number = theirs.fileno()
        program = f"from motionfmu.study.worker import main; main({number})"
        given = MEMORY | {"TMPDIR": temporary} | dict.fromkeys(THREADS, "1")
        command, options = child(program, **given)
        process = subprocess.Popen(command, pass_fds=[number], stdin=subprocess.DEVNULL, **options)
    ours.send(job)
    return _Process(process, ours)


# CCN 19: one case for each message of a worker, and for its end.
def rows(job: WorkerJob, tasks: Sequence[Task], workers: int) -> Iterator[Row]:
    """Run points in processes of this machine; rows as they come."""
    # A run that ends its process gives a row that says so. A worker that cannot begin is an
    # InputError.
    pending = Queue(tasks)
    alone: deque[Task] = deque()  # of a group that has ended its process: whose fault is it?
    running: list[_Process] = []
    unready = 0  # processes ended by a signal before their first run, since one was heard of
    with tempfile.TemporaryDirectory(prefix="motionfmu-", ignore_cleanup_errors=True) as temporary:
        try:
            while pending or alone or any(p.groups for p in running):
                left = len(pending) + len(alone)
                while len(running) < min(workers, left + len(running)):
                    running.append(_start(job, temporary))
                _deal(running, pending, alone)
                for pipe in wait([p.pipe for p in running]):
                    one = next(p for p in running if p.pipe is pipe)
                    told = _receive(one)
                    unready = 0 if told is not None else unready + (not one.lanes)
                    if isinstance(told, InputError):
                        raise told
                    if isinstance(told, list):
                        one.groups.popleft()
                        yield from told
                    elif told is None:
                        running.remove(one)
                        lost = _crashed(one, job, unready)
                        alone.extend(lost if len(lost) > 1 else ())
                        for group in reversed(one.groups):
                            pending.give_back(group)
                        if len(lost) == 1:
                            yield _row_of(lost[0], one, job)
                    else:
                        one.lanes = told
        finally:
            for one in running:
                _end(one)


def _deal(running: list[_Process], pending: Queue, alone: deque[Task]) -> None:
    """Hand out groups of points; the last points only to workers that have none."""
    for one in running:
        ahead = AHEAD if len(pending) > AHEAD * one.lanes * len(running) else 1
        while one.lanes and (pending or alone) and len(one.groups) < ahead:
            if alone:
                group = [alone.popleft()]
            else:
                share = -(-len(pending) // len(running))
                group = pending.take(min(one.lanes, share))
            one.groups.append(group)
            with contextlib.suppress(BrokenPipeError, ConnectionResetError):
                one.pipe.send(group)  # its end is seen when we receive


def _end(one: _Process) -> None:
    one.pipe.close()
    if one.groups or not one.lanes:
        one.process.terminate()
    try:
        one.process.wait(PATIENCE)
    except subprocess.TimeoutExpired:
        one.process.kill()
        one.process.wait()


def _receive(one: _Process) -> Any:
    """The next message of a worker; None when its process has ended."""
    try:
        return one.pipe.recv()
    except (EOFError, ConnectionResetError):
        return None


def _crashed(one: _Process, job: WorkerJob, unready: int) -> list[Task]:
    """The points of the group that ended its process; the worker's other points are not lost.

    A worker that was killed before its first run is replaced, unless that happens again and again.
    """
    one.pipe.close()
    one.process.wait()
    if not one.lanes and (one.process.returncode >= 0 or unready >= UNREADY_MAX):
        raise InputError(f"{job.scenario}: a worker ended with {_how(one)} before its first run")
    return one.groups.popleft() if one.groups else []


def _how(one: _Process) -> str:
    code = one.process.wait()
    return f"signal {-code}" if code < 0 else f"status {code}"


def _row_of(task: Task, one: _Process, job: WorkerJob) -> Row:
    """The row of the run that ended its process."""
    told = f"the run ended its process ({_how(one)})"
    return Row(task[0], CRASH, told, None, (None,) * len(job.columns))
