"""The workers of a dask.distributed cluster: runs handed out in chunks."""

import time
from collections import deque
from collections.abc import Iterator, Sequence
from typing import Any

from motionfmu.base.errors import InputError
from motionfmu.base.extras import needed
from motionfmu.study.processes import Task
from motionfmu.study.study_definition import WorkerJob
from motionfmu.study.worker import CRASH, Row, chunk

TIMEOUT = 10  # [s] in which the scheduler must answer and a worker be there
CHUNK = 1.0  # [s] of work in a chunk: to hand one out costs a thousandth of that
CHUNK_MAX = 200
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
        yield from _chunks(client, job, tasks)


def _chunks(client: Any, job: WorkerJob, tasks: Sequence[Task]) -> Iterator[Row]:
    import distributed

    pending, size = deque(tasks), 1
    alone: deque[Task] = deque()  # tasks of a chunk whose worker was lost, run one by one
    sent: dict[Any, list[Task]] = {}
    done = distributed.as_completed(loop=client.loop)

    def send() -> None:
        threads = sum(client.nthreads().values()) or 1
        while (pending or alone) and len(sent) < AHEAD * threads:
            if alone:
                part = [alone.popleft()]
            else:
                part = [pending.popleft() for _ in range(min(size, len(pending)))]
            future = client.submit(_timed, job, part, pure=False)
            sent[future] = part
            done.add(future)

    send()
    for future in done:
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
        elif len(part) > 1:
            alone.extend(part)
        else:
            told = "the run ended its process again and again"
            yield Row(part[0][0], CRASH, told, None, (None,) * len(job.columns))
        future.release()
        send()
