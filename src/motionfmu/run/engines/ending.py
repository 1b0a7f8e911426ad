"""Where a run is divided, and where it ends: at its last step, or behind a signal."""

from collections.abc import Callable, Iterable, Iterator
from itertools import pairwise
from typing import Any

from motionfmu.run.engines.engine_job import EngineResult
from motionfmu.run.engines.scopes import ScopeSystem
from motionfmu.scenarios.system import System

# A run calls its progress so many times at most, and a call drives so many steps at least.
SHARES, STEPS_MIN = 100, 50


def shares(system: System, due: Iterable[int], most: int) -> Iterator[tuple[int, int]]:
    """Parts of a run, each driven by one call: from and to which step; inputs are due between."""
    part = min(max(STEPS_MIN, (system.steps - system.begin) // SHARES), most)
    cuts = {*range(system.begin, system.steps, part), *(k for k in due if k < system.steps)}
    return pairwise([*sorted(cuts), system.steps])


class Ending:
    """Ends a run behind the first communication point at which a signal is not 0.

    The engine's `read` fills its array `values` with the signal's elements.
    """

    def __init__(
        self, system: System, read: Callable[[], None] = lambda: None, values: Any = ()
    ) -> None:
        self._system, self._read, self._values = system, read, values
        self._until = system.until
        self.steps = system.steps
        self.signal: int | None = None

    def ran(self, engine: str, scopes: ScopeSystem, warnings: list[str]) -> EngineResult:
        """The result of a run that has ended."""
        return EngineResult(engine, scopes.signals(), warnings, self.steps, self.signal)

    def points(self, progress: Callable[[float], None]) -> Iterator[int]:
        """The communication points of the run, one after the other, each before its step."""
        begin = k = self._system.begin
        part, element = max(1, (self.steps - begin) // SHARES), 0
        if self._until is not None and self._until.element is not None:
            element = self._until.element
        while k < self.steps:
            if self._until is not None and self.signal is None:
                self._read()
                if self._values[element]:
                    self.signal = k
                    self.steps = min(self.steps, k + 1 + self._until.settle)
            yield k
            if k % part == 0:
                progress(self._system.share(k))
            k += 1
        progress(1.0)
