"""The fused engine: a system is one compiled program with a recorder, loaded once.

A run is an instance of the program: its values are set by one call for each type, then it makes few
long steps, and driven inputs are set between them.
"""

import ctypes
import functools
import json
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu import fused
from motionfmu.base.columns import Columns
from motionfmu.fmu.describe import STRICT
from motionfmu.fused.resource_files import carrying, placed
from motionfmu.run.engines import fmu_messages
from motionfmu.run.engines.ending import shares
from motionfmu.run.engines.engine_job import EngineJob, EngineResult, Progress
from motionfmu.run.engines.fmu_library import FmuRefusal, Library, ValuePlace
from motionfmu.scenarios import recording
from motionfmu.scenarios.system import System

NAME = "system"
# A call makes so many steps at most; Ctrl-C ends the run between two calls.
STEPS_MAX = 20_000
KINDS = {"Float64": np.float64, "Int32": np.int32, "Boolean": np.bool_}
STEP, FOLDER, EVERY = "system.step", "recorder.folder", "recorder.every"
SETTLE, SIGNAL = "until.settle", "until.step"
# The program's own call refuses a component's value.
_SET = re.compile(r"^(fmi[23]\w+: )(\w+)\.(?=\w)")


@dataclass(frozen=True)
class _About:
    """What a program's JSON says of it."""

    library: str  # its file
    token: str
    variables: dict[str, ValuePlace]


@functools.lru_cache(maxsize=8)
def _about(folder: Path) -> _About:
    # The folder's name is a hash of all that the program is made of.
    about = json.loads((folder / "program.json").read_bytes())
    variables = {name: ValuePlace(*row) for name, row in about["variables"].items()}
    return _About(about["library"], about["token"], variables)


class Fused:
    """A program, and an instance of it for each run."""

    def __init__(self, job: EngineJob) -> None:
        self._job, self._signals = job, job.folder / "signals"
        self._carrying = carrying(job.system)
        self._folder = fused.program(job.system, job.recorded, job.fmi).folder
        about = _about(self._folder)
        self._token, self._variables = about.token, about.variables
        self._library = Library(self._folder / about.library, job.fmi)
        self._errors: list[str] = []
        self._warnings: list[str] = []

    def run(self, system: System, progress: Progress) -> EngineResult:
        """Run from the start."""
        library = self._library
        recorded = self._job.recorded
        held = bool(recorded) and recording.size(system, recorded) <= self._job.memory
        rows: list[NDArray[Any]] = []
        self._errors.clear()
        self._warnings.clear()
        try:
            library.instantiate(NAME, self._token, self._folder / "resources", self._tell)
            library.warn()
            self._set(system, held)
            library.enter(system.begin_time)
            library.leave()
            if held:
                rows = self._record(system)
            steps, signal = self._advance(system, progress)
            library.terminate()
        except FmuRefusal as refused:
            raise fmu_messages.failure(NAME, str(refused), self._errors) from None
        finally:
            library.release()
        progress(1.0)
        names = [end.name for end in recorded]
        if held:
            time, *found = (column[: system.rows(steps)] for column in rows)
            signals = dict(zip(names, found, strict=True))
            return EngineResult("fused", signals, [*self._warnings], steps, signal, time)
        files = Columns.taken(self._signals, names) if names else Columns({})
        return EngineResult("fused", files, [*self._warnings], steps, signal, files.time)

    def _record(self, system: System) -> list[NDArray[Any]]:
        """Let the program record into arrays: times, then each signal."""
        rows = system.rows(system.steps)
        shapes = [
            ((), np.float64),
            *((e.port.shape, KINDS[e.port.type]) for e in self._job.recorded),
        ]
        columns: list[NDArray[Any]] = [np.empty((rows + 1, *s), kind) for s, kind in shapes]
        places = (ctypes.c_void_p * len(columns))(*(c.ctypes.data for c in columns))
        record = self._library.own("motionfmu_record")
        if record(self._library.instance, places, ctypes.c_int64(rows)) != 0:
            raise MemoryError
        return columns

    def _set(self, system: System, held: bool) -> None:
        settings = placed(system, self._carrying).settings
        given: dict[str, tuple[Any, ...]] = {
            s.end.name: s.values for s in settings if s.end.port.name != STRICT
        }
        given[STEP] = (system.step_ns * 1e-9,)
        given[FOLDER] = (str(self._signals) if self._job.recorded and not held else "",)
        given[EVERY] = (system.every,)
        if system.until is not None:
            given[SETTLE] = (system.until.settle,)
        self._library.set((self._variables[name], values) for name, values in given.items())

    def _advance(self, system: System, progress: Progress) -> tuple[int, int | None]:
        """Number of steps made, and the communication point at which the signal came."""
        due, step, steps = system.due(), system.step_ns * 1e-9, system.steps
        signal = None
        for k, following in shares(system, due, STEPS_MAX):
            self._library.set((self._variables[s.end.name], s.values) for s in due.get(k, ()))
            self._library.step(k * system.step_ns * 1e-9, (following - k) * step)
            progress(system.share(following))
            if system.until is not None and signal is None:
                (at,) = self._library.get(self._variables[SIGNAL])
                if at >= 0:
                    signal, steps = at, min(steps, at + 1 + system.until.settle)
            if following >= steps:
                break
        return steps, signal

    def _tell(self, status: int, text: str) -> None:
        told = text.strip().removeprefix(f"{NAME}: ")
        told = _SET.sub(r"\2: \1", told)
        if fmu_messages.unnamed(told) or told.startswith("fmi"):
            told = f"{NAME}: {told}"
        fmu_messages.keep(status, told, self._errors, self._warnings)

    def close(self) -> None:
        """Free the program; its files stay on the disk."""
        self._library.close()


def opened(job: EngineJob) -> Fused:
    """Make or find the program of a job, and load it."""
    return Fused(job)
