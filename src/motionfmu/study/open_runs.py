"""The runs of a study that are not done, handed out to workers and taken back from lost ones."""

from collections import deque
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from motionfmu.study.study_axes import Point, StudyPoints

Task = tuple[int, Point]


class OpenRuns(Sequence[Task]):
    """Runs that are not done, each with its point, made when it is asked for."""

    def __init__(self, points: StudyPoints, done: bytearray) -> None:
        self._points = points
        self._runs: Any = range(len(points))
        if any(done):
            self._runs = np.flatnonzero(np.frombuffer(done, dtype=np.uint8) == 0)

    def __len__(self) -> int:
        return len(self._runs)

    def __getitem__(self, which: Any) -> Any:
        if isinstance(which, slice):
            runs = [int(run) for run in self._runs[which]]
            axes = range(self._points.width)
            values = zip(*(self._points.column(i, runs) for i in axes), strict=True)
            return list(zip(runs, values, strict=True))
        run = int(self._runs[which])
        return run, self._points[run]


class Queue:
    """What is still to be handed out: first what a lost worker gave back, then the rest."""

    def __init__(self, tasks: Sequence[Task]) -> None:
        self._tasks, self._next = tasks, 0
        self._back: deque[Task] = deque()

    def __len__(self) -> int:
        return len(self._back) + len(self._tasks) - self._next

    def take(self, most: int) -> list[Task]:
        """So many tasks, or as many as there are."""
        found = [self._back.popleft() for _ in range(min(most, len(self._back)))]
        first = self._next
        self._next = min(first + most - len(found), len(self._tasks))
        return found + list(self._tasks[first : self._next])

    def give_back(self, tasks: Iterable[Task]) -> None:
        """Tasks to be handed out before all others."""
        self._back.extendleft(reversed([*tasks]))
