"""Where a run is divided, and where it ends: at its last step, or behind a signal."""

from collections.abc import Callable, Iterable, Iterator, Sequence
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
    """Ends a run behind the first communication point at which one of its signals is not 0.

    For each signal the engine gives a function that fills an array with the signal's elements,
    and the array.
    """

    def __init__(self, system: System, read: Sequence[tuple[Callable[[], None], Any]] = ()) -> None:
        self._system = system
        signals = system.until.signals if system.until is not None else ()
        self._read = [(*r, s.element or 0) for r, s in zip(read, signals, strict=True)]
        self._settle = 0 if system.until is None else system.until.settle
        self.steps = system.steps
        self.signal: int | None = None
        self.which = 0

    def _look(self, k: int) -> None:
        for which, (read, values, element) in enumerate(self._read):
            read()
            if values[element]:
                self.signal, self.which = k, which
                self.steps = min(self.steps, k + 1 + self._settle)

    def ran(self, engine: str, scopes: ScopeSystem, warnings: list[str]) -> EngineResult:
        """The result of a run that has ended."""
        signals = scopes.signals()
        return EngineResult(engine, signals, warnings, self.steps, self.signal, self.which)

    def points(self, progress: Callable[[float], None]) -> Iterator[int]:
        """The communication points of the run, one after the other, each before its step."""
        begin = k = self._system.begin
        part = max(1, (self.steps - begin) // SHARES)
        while k < self.steps:
            if self.signal is None:
                self._look(k)
            yield k
            if k % part == 0:
                progress(self._system.share(k))
            k += 1
        progress(1.0)
