"""The workers of a dask.distributed cluster: runs handed out in chunks."""

import time
from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from queue import Empty, SimpleQueue
from typing import Any

from motionfmu.base import heap
from motionfmu.base.errors import InputError
from motionfmu.base.extras import needed
from motionfmu.study.open_runs import Queue, Task
from motionfmu.study.study_definition import WorkerJob
from motionfmu.study.worker import CRASH, Row, serving

TIMEOUT = 10  # [s] in which the scheduler must answer and a worker be there
CHUNK = 1.0  # [s] of a processor in a chunk: to hand one out costs some thousandths of that
CHUNK_MAX = 2000  # runs in a chunk
LOST = 120  # [s] without any worker, after which the study ends; rows not there are made anew
LOOK = 1.0  # [s] without news, after which one looks whether there are workers
AHEAD = 2  # chunks handed out per thread of the cluster, so that none waits for its next one


@dataclass(frozen=True)
class Ran:
    """What a worker gives back for a chunk."""

    seconds: float  # of a processor; a busy machine does not change it
    lanes: int  # points that the worker runs side by side
    rows: list[Row]


def _ran(job: WorkerJob, tasks: Sequence[Task]) -> Ran:
    """Run a chunk in a process of the cluster, which keeps the memory that its runs free."""
    heap.keep_freed()
    worker = serving(job)  # made once, so it is no part of what a run takes
    start = time.thread_time()
    found = worker.rows(tasks)
    return Ran(time.thread_time() - start, worker.lanes, found)


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


def _threads(client: Any) -> int:
    """Threads of all workers; 0 as well where the scheduler is too busy to say."""
    try:
        return sum(client.nthreads().values())
    except TimeoutError:
        return 0


def _next(client: Any, finished: "SimpleQueue[Any]") -> Any:
    """The next future that is done; a TimeoutError where no worker is left to do one."""
    last = time.monotonic()
    while True:
        try:
            return finished.get(timeout=LOOK)
        except Empty:
            if _threads(client):
                last = time.monotonic()
            elif time.monotonic() - last > LOST:
                raise TimeoutError from None


def _size(ran: Ran) -> int:
    """Runs of the next chunks: a second of work, in whole groups that go side by side."""
    size = int(CHUNK * len(ran.rows) / max(ran.seconds, 1e-6))
    return max(1, min(CHUNK_MAX, size - size % ran.lanes or size))


def _found(future: Any) -> Any:
    """What a chunk gave, or its error; a TimeoutError where its rows were lost with its worker."""
    import distributed

    try:
        return future.exception(LOST) or future.result(LOST)
    except (distributed.KilledWorker, TimeoutError) as error:
        # It had ended well, then its worker was lost with the rows.
        return error


def _chunks(client: Any, job: WorkerJob, tasks: Sequence[Task]) -> Iterator[Row]:
    import distributed

    pending, size, lanes = Queue(tasks), 1, 1
    # Chunks that lost their workers again and again. dask suspects all that a lost worker had, so
    # each of them runs with nothing beside it, and the one whose fault it is run by run.
    alone: deque[list[Task]] = deque()
    sent: dict[Any, list[Task]] = {}
    by_itself: Any = None  # the one that runs so
    finished: SimpleQueue[Any] = SimpleQueue()

    def submit(part: list[Task]) -> Any:
        future = client.submit(_ran, job, part, pure=False)
        sent[future] = part
        future.add_done_callback(finished.put)
        return future

    def send() -> None:
        nonlocal by_itself
        places = AHEAD * (_threads(client) or 1)
        while pending and len(sent) < places:
            share = -(-len(pending) // places)  # the last chunks are small, so that all end at once
            submit(pending.take(min(size, max(lanes, share))))
        if alone and not sent:
            by_itself = submit(alone.popleft())

    send()
    while sent:
        future = _next(client, finished)
        part = sent.pop(future)
        found = _found(future)
        if isinstance(found, Ran):
            size, lanes = _size(found), found.lanes
            yield from found.rows
        elif isinstance(found, InputError):
            raise found
        elif isinstance(found, TimeoutError):
            pending.give_back(part)
        elif not isinstance(found, distributed.KilledWorker):
            raise InputError(f"a worker of the cluster failed: {found}")
        elif future is not by_itself:
            alone.append(part)
        elif len(part) > 1:
            alone.extendleft([task] for task in reversed(part))
        else:
            told = "the run ended its process again and again"
            yield Row(part[0][0], CRASH, told, None, (None,) * len(job.columns))
        future.release()
        send()
