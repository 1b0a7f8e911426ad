"""A scenario under one engine, timed: its loop and the whole run."""

import time
from pathlib import Path
from typing import Any

from medians import Medians

import motionfmu


class Clock:
    """Takes the time between the first and the last report of progress before the end."""

    def __init__(self) -> None:
        self.marks: list[tuple[float, float]] = []

    def __call__(self, share: float) -> None:
        if share < 1.0:
            self.marks.append((share, time.process_time()))

    def seconds(self) -> float:
        """Time of the whole loop, from the part that was seen."""
        (first, start), (last, end) = self.marks[0], self.marks[-1]
        return (end - start) / (last - first)


class Timed:
    """A scenario under one engine: seconds of its loop and of the whole run."""

    def __init__(self, scenario: Path, **options: Any) -> None:
        self.scenario, self.options = motionfmu.load(scenario), options
        self._rounds = Medians()
        self.result: motionfmu.Result | None = None

    def __call__(self) -> None:
        clock = Clock()
        start = time.process_time()
        self.result = self.scenario.run(progress=clock, **self.options)
        self._rounds.add("whole", time.process_time() - start)
        self._rounds.add("loop", clock.seconds())

    @property
    def loop(self) -> float:
        return self._rounds["loop"]

    @property
    def whole(self) -> float:
        return self._rounds["whole"]

    @property
    def steps(self) -> int:
        assert self.result is not None
        return len(self.result.time)

    @property
    def simulated(self) -> float:
        """Simulated time [s]."""
        return float(self.options.get("stop") or self.scenario.document.body.stop_limit)

    @property
    def fmus(self) -> int:
        """FMUs stepped, the recorder among them."""
        return len(self.scenario.document.body.component) + 1
