"""A scenario with the scopes that record it: what an engine runs, and the result made of it."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.errors import InputError
from motionfmu.run.engines.ending import Ran
from motionfmu.run.overrides import overrides
from motionfmu.run.prepared import Options, Prepared
from motionfmu.run.result import Result
from motionfmu.scenarios import recording
from motionfmu.scenarios.system import End, System

PLANNED = "path.csv"


def own_settings(scenario: Prepared, folder: Path) -> dict[str, Any]:
    """Where the library writes the path that it plans."""
    library = scenario.library()
    return {f"{library}.path_file": str(folder / PLANNED)} if library else {}


@dataclass(frozen=True)
class Wired:
    """One run, ready for an engine."""

    scenario: Prepared
    plain: System  # without scopes
    system: System  # with them
    traces: recording.Recording

    @classmethod
    def plan(
        cls, scenario: Prepared, options: Options, ends: Iterable[End], folder: Path
    ) -> "Wired":
        """Add the scopes that record these outputs in files of a folder."""
        plain = scenario.resolved(options)
        return cls(scenario, plain, *recording.plan(plain, ends, folder))

    def run(self, engine: Callable[[System], Ran], options: Options) -> Result:
        """Run it; an FMU's message says where its value stands."""
        planned = self.traces.folder / PLANNED
        planned.unlink(missing_ok=True)
        try:
            ran = engine(self.system)
        except InputError as error:
            raise self.scenario.located(error, self.plain, options.set) from None
        stopped, signal = self._stopped(ran)
        never: tuple[str, ...] = ()
        if (until := self.system.until) is not None and signal is None:
            limit = self._seconds(self.system.steps)
            never = (f"{until.name} never came within {limit:.9g} s",)
        return Result(
            scenario=self.scenario,
            time=np.arange(self.system.rows(ran.steps), dtype=np.float64)
            * (self.system.sample_ns * 1e-9),
            signals=self.traces.load(),
            parameters={s.end.name: s.values for s in self.plain.settings},
            geometry=planned.read_text(encoding="utf-8") if planned.is_file() else None,
            warnings=(*ran.warnings, *never),
            options=options.given(),
            overrides=overrides(self.scenario, options, self.plain),
            stopped=stopped,
            signal_at=signal,
        )

    def _stopped(self, ran: Ran) -> tuple[str, float | None]:
        """Why the run ended, and when the signal that ends it came [s]."""
        until = self.system.until
        if until is None:
            return f"stop = {self._seconds(ran.steps):.9g} s", None
        if ran.signal is None:
            return f"limit {self._seconds(ran.steps):.9g} s, {until.name} never came", None
        at = self._seconds(ran.signal)
        return f"{until.name} at {at:.9g} s", at

    def _seconds(self, steps: int) -> float:
        """How long so many steps are [s]."""
        return steps * self.system.step_ns / 1e9
