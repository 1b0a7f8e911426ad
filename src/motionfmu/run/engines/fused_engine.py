"""The fused engine: a system is one compiled program with a recorder, loaded once.

A run is an instance of the program: its values are set by one call for each type, then it makes few
long steps, and driven inputs are set between them. Of several runs one call steps all.
"""

import ctypes
import functools
import json
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu import fused
from motionfmu.base.columns import Columns
from motionfmu.base.errors import InputError
from motionfmu.fmu.describe import STRICT
from motionfmu.fused.resource_files import carrying, placed
from motionfmu.run.engines import fmu_messages
from motionfmu.run.engines.ending import shares
from motionfmu.run.engines.engine_job import EngineJob, EngineResult, Progress
from motionfmu.run.engines.fmu_library import FmuRefusal, Library, ValuePlace
from motionfmu.scenarios import recording
from motionfmu.scenarios.system import Stimulus, System

NAME = "system"
# A call makes so many steps at most; Ctrl-C ends the run between two calls.
STEPS_MAX = 20_000
# So many runs go side by side, of FMU_PART_RUNS that may: more wait for memory longer than they
# gain. [byte] Their signals take no more.
LANES, LANES_HELD = 4, 1 << 28
KINDS = {"Float64": np.float64, "Int32": np.int32, "Boolean": np.bool_}
STEP, FOLDER, EVERY = "system.step", "recorder.folder", "recorder.every"
SETTLE, SIGNAL, WHICH = "until.settle", "until.step", "until.which"
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


class _Instance:
    """An instance of a program: one run from its start to its end."""

    def __init__(self, program: "Fused", library: Library, system: System) -> None:
        self._program, self._library, self._system = program, library, system
        self._job = program.job
        self._rows: list[NDArray[Any]] = []
        self._errors: list[str] = []
        self._warnings: list[str] = []
        self.held = bool(self._job.recorded) and program.size(system) <= self._job.memory
        self.steps, self._signal, self._which = system.steps, None, 0
        self._whole = False

    def begin(self) -> None:
        """Make the instance, with its values, up to its first step."""
        library, about = self._library, self._program.about
        if library.instance:
            library.listen(self._tell)
        else:
            resources = self._program.folder / "resources"
            library.instantiate(NAME, about.token, resources, self._tell)
            library.warn()
        self._set()
        library.enter(self._system.begin_time)
        library.leave()
        if self.held:
            self._rows = self._record()

    def _record(self) -> list[NDArray[Any]]:
        """Let the program record into arrays: times, then each signal."""
        rows = self._system.rows(self._system.steps)
        shapes = [
            ((), np.float64),
            *((e.port.shape, KINDS[e.port.type]) for e in self._job.recorded),
        ]
        columns: list[NDArray[Any]] = [np.empty((rows + 1, *s), kind) for s, kind in shapes]
        places = (ctypes.c_void_p * len(columns))(
            *(c.__array_interface__["data"][0] for c in columns)  # `.ctypes` makes an object first
        )
        record = self._library.own("motionfmu_record")
        if record(self._library.instance, places, ctypes.c_int64(rows)) != 0:
            raise MemoryError
        return columns

    def _set(self) -> None:
        system, recorded = self._system, self._job.recorded
        settings = placed(system, self._program.carrying).settings
        given: dict[str, tuple[Any, ...]] = {
            s.end.name: s.values for s in settings if s.end.port.name != STRICT
        }
        given[STEP] = (system.step_ns * 1e-9,)
        given[FOLDER] = (str(self._program.signals) if recorded and not self.held else "",)
        given[EVERY] = (system.every,)
        if system.until is not None:
            given[SETTLE] = (system.until.settle,)
        variables = self._program.about.variables
        self._library.set((variables[name], values) for name, values in given.items())

    def give(self, stimuli: Iterable[Stimulus]) -> None:
        """Set what is due at a communication point."""
        variables = self._program.about.variables
        self._library.set((variables[s.end.name], s.values) for s in stimuli)

    def step(self, first: int, following: int) -> None:
        """Make steps from one communication point to another."""
        step_ns = self._system.step_ns
        self._library.step(first * step_ns * 1e-9, (following - first) * (step_ns * 1e-9))

    def ended(self, following: int) -> bool:
        """Whether the run ends with the steps up to a communication point."""
        until = self._system.until
        if until is not None and self._signal is None:
            (at,) = self._library.get(self._program.about.variables[SIGNAL])
            if at >= 0:
                self._signal, self.steps = at, min(self.steps, at + 1 + until.settle)
                (self._which,) = self._library.get(self._program.about.variables[WHICH])
        return following >= self.steps

    def result(self) -> EngineResult:
        """End the run."""
        self._library.terminate()
        self._whole = True
        names = [end.name for end in self._job.recorded]
        told, steps, ended = [*self._warnings], self.steps, (self._signal, self._which)
        if self.held:
            time, *found = (column[: self._system.rows(steps)] for column in self._rows)
            signals = dict(zip(names, found, strict=True))
            return EngineResult("fused", signals, told, steps, *ended, time)
        files = Columns.taken(self._program.signals, names) if names else Columns({})
        return EngineResult("fused", files, told, steps, *ended, files.time)

    def _tell(self, status: int, text: str) -> None:
        told = text.strip().removeprefix(f"{NAME}: ")
        told = _SET.sub(r"\2: \1", told)
        if fmu_messages.unnamed(told) or told.startswith("fmi"):
            told = f"{NAME}: {told}"
        fmu_messages.keep(status, told, self._errors, self._warnings)

    def failure(self, refused: FmuRefusal) -> InputError:
        """The error of a call that was refused."""
        return fmu_messages.failure(NAME, str(refused), self._errors)

    def release(self) -> None:
        """Reset the instance for the next run if this one ended well, else free it.

        A new instance costs the page faults of its memory, 1.7 MB for the demo.
        """
        if self._whole:
            self._library.reset()
        else:
            self._library.release()
        self._rows = []  # the library's log goes on to refer to this object

    @property
    def handle(self) -> ctypes.c_void_p:
        """The instance's address."""
        return self._library.instance


class Fused:
    """A program, and an instance of it for each run."""

    def __init__(self, job: EngineJob) -> None:
        self.job, self.signals = job, job.folder / "signals"
        self.carrying = carrying(job.system)
        self.folder = fused.program(job.system, job.recorded, job.fmi).folder
        self.about = _about(self.folder)
        # A library for each of the runs that go side by side.
        self._libraries = [Library(self.folder / self.about.library, job.fmi)]

    def size(self, system: System) -> int:
        """Size of what a run records [byte]."""
        return recording.size(system, self.job.recorded)

    def run(self, system: System, progress: Progress) -> EngineResult:
        """Run from the start."""
        one = _Instance(self, self._libraries[0], system)
        due = system.due()
        try:
            one.begin()
            for k, following in shares(system, due, STEPS_MAX):
                one.give(due.get(k, ()))
                one.step(k, following)
                progress(system.share(following))
                if one.ended(following):
                    break
            ran = one.result()
        except FmuRefusal as refused:
            raise one.failure(refused) from None
        finally:
            one.release()
        progress(1.0)
        return ran

    def lanes(self, system: System) -> int:
        """How many runs may go side by side: their signals are held in memory."""
        size = self.size(system)
        if size > self.job.memory or system.begin > 0:
            return 1
        return max(1, min(LANES, LANES_HELD // max(size, 1)))

    def run_together(self, systems: Sequence[System]) -> list[EngineResult | InputError]:
        """Run systems that differ in values side by side; each has the bits it has alone.

        There may be as many as `lanes` says. Who fails gives an error, the others go on.
        """
        while len(self._libraries) < len(systems):
            self._libraries.append(Library(self.folder / self.about.library, self.job.fmi))
        runs = [_Instance(self, *of) for of in zip(self._libraries, systems, strict=False)]
        found: list[EngineResult | InputError | None] = [None] * len(runs)

        def attempt(i: int, act: Callable[[], Any]) -> Any:
            if found[i] is None:
                try:
                    return act()
                except FmuRefusal as refused:
                    found[i] = runs[i].failure(refused)
            return None

        try:
            for i, one in enumerate(runs):
                attempt(i, one.begin)
            self._side_by_side(systems, runs, found, attempt)
            for i, one in enumerate(runs):
                ran = attempt(i, one.result)
                found[i] = found[i] or ran
        finally:
            for one in runs:
                one.release()
        return [ran for ran in found if ran is not None]

    # CCN 17: who has begun, failed and ended is asked between the parts of a run.
    def _side_by_side(
        self,
        systems: Sequence[System],
        runs: Sequence[_Instance],
        found: list[EngineResult | InputError | None],
        attempt: Callable[[int, Callable[[], Any]], Any],
    ) -> None:
        """Make the steps of all runs that have begun; `attempt` notes who fails in `found`."""
        due = [system.due() for system in systems]
        step = self._libraries[0].own("motionfmu_together")
        for k, following in shares(systems[0], {t for one in due for t in one}, STEPS_MAX):
            for i, one in enumerate(runs):
                attempt(i, functools.partial(one.give, due[i].get(k, ())))
            left = [i for i, ran in enumerate(found) if ran is None]
            if not left:
                return
            several = (ctypes.c_void_p * len(left))(*(runs[i].handle.value for i in left))
            failed = (ctypes.c_bool * len(left))()
            step(several, len(left), ctypes.c_int64(following - k), failed)
            for i in (i for i, bad in zip(left, failed, strict=True) if bad):
                found[i] = runs[i].failure(FmuRefusal("doStep"))
            # each is asked, for it notes when its signal came
            ended = [attempt(i, functools.partial(runs[i].ended, following)) for i in left]
            if all(done or found[i] is not None for i, done in zip(left, ended, strict=True)):
                return

    def close(self) -> None:
        """Free the program; its files stay on the disk."""
        for library in self._libraries:
            library.close()


def opened(job: EngineJob) -> Fused:
    """Make or find the program of a job, and load it."""
    return Fused(job)
