"""One run of a scenario: the job for an engine, and the result made of what the engine gives."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.columns import ROWS, forget, room
from motionfmu.base.errors import InputError
from motionfmu.run.engines.engine_job import EngineJob, EngineResult
from motionfmu.run.overrides import overrides
from motionfmu.run.planned_text import PlannedText
from motionfmu.run.result import Result
from motionfmu.run.run_plan import Options, RunPlan
from motionfmu.scenarios import recording
from motionfmu.scenarios.system import End, System

PLANNED = "path.csv"
# [byte] Signals of a run that take no more stay in memory; a session keeps no run but the latest.
HELD, HELD_IN_SESSION = 1 << 22, 1 << 26


def own_settings(scenario: RunPlan, folder: Path) -> dict[str, Any]:
    """The setting that says where the motion library writes the path that it plans."""
    library = scenario.library()
    return {f"{library}.path_file": str(folder / PLANNED)} if library else {}


@dataclass(frozen=True)
class Execution:
    """One run, ready for an engine."""

    scenario: RunPlan
    system: System
    recorded: tuple[End, ...]
    folder: Path  # holds the files of the run

    @classmethod
    def plan(
        cls, scenario: RunPlan, options: Options, ends: Iterable[End], folder: Path
    ) -> "Execution":
        """Make the execution of a scenario that records these outputs, with files in a folder."""
        planned = cls(scenario, scenario.resolved(options), tuple(ends), folder)
        scenario.check_scopes(planned.system, options)
        if told := recording.no_room(planned.system, planned.recorded, folder):
            raise InputError(told)
        return planned

    def job(self, fmi: int, memory: int) -> EngineJob:
        """The job for an engine; a system with wires of elements needs FMI 2."""
        given = 2 if self.system.elementwise else fmi
        return EngineJob(self.system, self.recorded, self.folder, given, memory=memory)

    def run(self, engine: Callable[[System], EngineResult], options: Options) -> Result:
        """Run it in an engine; an FMU's error message says where the refused value stands."""
        self.clear()
        try:
            ran = engine(self.system)
        except InputError as error:
            raise self.located(error, options) from None
        return self.result(ran, options)

    def clear(self) -> None:
        """Remove what an earlier run has written."""
        (self.folder / PLANNED).unlink(missing_ok=True)

    def located(self, error: InputError, options: Options) -> InputError:
        """The error of an engine, with the place of a value that an FMU refused."""
        return self.scenario.located(error, self.system, options.set)

    def result(self, ran: EngineResult, options: Options) -> Result:
        """The result of what an engine gave."""
        planned = self.folder / PLANNED
        stopped, signal = self._stopped(ran)
        never: tuple[str, ...] = ()
        if (until := self.system.until) is not None and signal is None:
            done, limit = until.done.name, self._seconds(self.system.steps)
            never = (f"{done} never came within {limit:.9g} s",)
            if ran.signal is not None:
                never = (f"the run ended by its fault, {stopped}: {done} never came",)
        return Result(
            scenario=self.scenario,
            time=self._time(ran.steps, ran.signals) if ran.time is None else ran.time,
            signals=ran.signals,
            parameters={s.end.name: s.values for s in self.system.settings},
            planned=PlannedText(planned) if planned.is_file() else None,
            warnings=(*ran.warnings, *never),
            options=options.given() | {"engine": ran.engine},
            overrides=overrides(self.scenario, options, self.system),
            stopped=stopped,
            signal_at=signal,
        )

    def _stopped(self, ran: EngineResult) -> tuple[str, float | None]:
        """Why the run ended, and when the signal that it waits for came [s]."""
        until = self.system.until
        if until is None:
            return f"stop = {self._seconds(ran.steps):.9g} s", None
        if ran.signal is None:
            return f"limit {self._seconds(ran.steps):.9g} s, {until.done.name} never came", None
        at = self._seconds(ran.signal)
        told = f"{until.signals[ran.which].name} at {at:.9g} s"
        return told, at if ran.which == 0 else None

    def _time(self, steps: int, signals: Mapping[str, NDArray[Any]]) -> NDArray[np.float64]:
        """Times of the rows of so many steps [s], beside the signals where these have files."""
        first, count = self.system.begin // self.system.every, self.system.rows(steps)
        found = room(count, np.float64, next(iter(signals.values()), None))
        for begin in range(0, count, ROWS):
            rows = np.arange(first + begin, first + min(begin + ROWS, count), dtype=np.float64)
            found[begin : begin + len(rows)] = rows * (self.system.sample_ns * 1e-9)
            forget(found)
        return found

    def _seconds(self, steps: int) -> float:
        """Duration of so many steps [s]."""
        return steps * self.system.step_ns / 1e9
