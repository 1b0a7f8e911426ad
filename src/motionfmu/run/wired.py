"""A scenario with the scopes that record it: what an engine runs, and the result made of it."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.errors import InputError
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

    def run(self, engine: Callable[[System], Iterable[str]], options: Options) -> Result:
        """Run it; an FMU's message says where its value stands."""
        planned = self.traces.folder / PLANNED
        planned.unlink(missing_ok=True)
        try:
            warnings = engine(self.system)
        except InputError as error:
            raise self.scenario.located(error, self.plain, options.set) from None
        return Result(
            self.scenario,
            np.arange(self.system.samples, dtype=np.float64) * (self.system.sample_ns * 1e-9),
            self.traces.load(),
            {s.end.name: s.values for s in self.plain.settings},
            planned.read_text(encoding="utf-8") if planned.is_file() else None,
            tuple(warnings),
            options.given(),
            overrides(self.scenario, options, self.plain),
            f"stop = {self.system.steps * self.system.step_ns * 1e-9:.9g} s",
        )
