"""The workers of a dask.distributed cluster: runs handed out in chunks."""

import time
from collections import deque
from collections.abc import Iterator, Sequence
from queue import Empty, SimpleQueue
from typing import Any

from motionfmu.base.errors import InputError
from motionfmu.base.extras import needed
from motionfmu.study.processes import Task
from motionfmu.study.study_definition import WorkerJob
from motionfmu.study.worker import CRASH, Row, chunk

TIMEOUT = 10  # [s] in which the scheduler must answer and a worker be there
CHUNK = 1.0  # [s] of work in a chunk: to hand one out costs a thousandth of that
CHUNK_MAX = 200
LOST = 120  # [s] without any worker, after which the study ends
LOOK = 1.0  # [s] without news, after which one looks whether there are workers
AHEAD = 2  # chunks handed out per thread of the cluster, so that none waits for its next one


def _timed(job: WorkerJob, tasks: Sequence[Task]) -> tuple[float, list[Row]]:
    """Seconds that a chunk took, and its rows."""
    start = time.perf_counter()
    found = chunk(job, tasks)
    return time.perf_counter() - start, found


def rows(job: WorkerJob, tasks: Sequence[Task], scheduler: str) -> Iterator[Row]:
    """Run points on a cluster ``tcp://host:8786``; rows as they come.

    The workers import motionfmu and read the scenario and the FMUs from their own disk, at the
    same path; a worker whose files differ ends the study, as does a missing dask.distributed.
    """
    needed("dask")
    import distributed

    try:
        client: Any = distributed.Client(scheduler, timeout=TIMEOUT, set_as_default=False)
    except (OSError, TimeoutError, ValueError) as error:
        raise InputError(f"--scheduler {scheduler}: {error or 'no answer'}") from None
    with client:
        try:
            client.wait_for_workers(1, timeout=TIMEOUT)
        except TimeoutError:
            raise InputError(f"--scheduler {scheduler}: it has no worker") from None
        try:
            yield from _chunks(client, job, tasks)
        except TimeoutError:
            raise InputError(f"--scheduler {scheduler}: it has lost all its workers") from None


def _next(client: Any, finished: "SimpleQueue[Any]") -> Any:
    """The next future that is done; a TimeoutError where no worker is left to do one."""
    last = time.monotonic()
    while True:
        try:
            return finished.get(timeout=LOOK)
        except Empty:
            if client.nthreads():
                last = time.monotonic()
            elif time.monotonic() - last > LOST:
                raise TimeoutError from None


def _chunks(client: Any, job: WorkerJob, tasks: Sequence[Task]) -> Iterator[Row]:
    import distributed

    pending, size = deque(tasks), 1
    # Tasks of chunks that lost their workers again and again. dask suspects all that a lost worker
    # had, so each of them runs with nothing beside it.
    alone: deque[Task] = deque()
    sent: dict[Any, list[Task]] = {}
    by_itself: Any = None  # the one that runs so
    finished: SimpleQueue[Any] = SimpleQueue()

    def submit(part: list[Task]) -> Any:
        future = client.submit(_timed, job, part, pure=False)
        sent[future] = part
        future.add_done_callback(finished.put)
        return future

    def send() -> None:
        nonlocal by_itself
        threads = sum(client.nthreads().values()) or 1
        while pending and len(sent) < AHEAD * threads:
            submit([pending.popleft() for _ in range(min(size, len(pending)))])
        if alone and not sent:
            by_itself = submit([alone.popleft()])

    send()
    while sent:
        future = _next(client, finished)
        part = sent.pop(future)
        error = future.exception()
        if error is None:
            seconds, found = future.result()
            size = max(1, min(CHUNK_MAX, int(CHUNK * len(part) / max(seconds, 1e-6))))
            yield from found
        elif isinstance(error, InputError):
            raise error
        elif not isinstance(error, distributed.KilledWorker):
            raise InputError(f"a worker of the cluster failed: {error}")
        elif future is not by_itself:
            alone.extend(part)
        else:
            told = "the run ended its process again and again"
            yield Row(part[0][0], CRASH, told, None, (None,) * len(job.columns))
        future.release()
        send()
