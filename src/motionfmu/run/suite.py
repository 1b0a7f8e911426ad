"""Many scenarios judged, one after the other or in processes of this machine."""

import contextlib
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from motionfmu.base.children import child
from motionfmu.base.errors import InputError
from motionfmu.base.toml_lines import is_file
from motionfmu.run import contrary
from motionfmu.run.checks import Verdict
from motionfmu.run.machine_program import machine
from motionfmu.run.runner import Scenario, load
from motionfmu.scenarios import package_files

FILE = "scenario.toml"
PATIENCE = 10  # [s] for a process to remove its files when it is told to end
Run = Callable[..., Any]


@dataclass(frozen=True)
class SuiteWays:
    """What is judged of each path."""

    contraries: bool = False  # each [[contrary]] instead of the scenario
    machine: str | None = None  # the paths are programs on this machine
    drawing: Mapping[str, Any] = field(default_factory=dict)  # what is asked of those that draw


@dataclass(frozen=True)
class Case:
    """A run of a scenario and its verdict, or the reason why there is none."""

    scenario: str
    path: str
    off: str = ""  # what a contrary switched off; empty for the scenario as written
    seconds: float = 0.0  # [s] duration
    checks: tuple[Verdict, ...] = ()
    holding: tuple[str, ...] = ()  # checks that hold although something is off
    warnings: tuple[str, ...] = ()
    error: str = ""

    @property
    def silent(self) -> bool:
        """Whether it ran and nothing was asked of it."""
        return not (self.checks or self.off or self.error)

    @property
    def ok(self) -> bool:
        """Whether all checks hold or, of a contrary, whether the checks that it names fail."""
        good = not self.holding if self.off else all(v.ok is not False for v in self.checks)
        return good and not self.error


def found(paths: Sequence[Path]) -> list[Path]:
    """Scenarios that paths or names mean; a folder of scenarios means all that are in it."""
    chosen: list[Path] = []
    for given in paths:
        path = package_files.scenario(given) or given
        if is_file(path) or is_file(path / FILE):
            chosen.append(path)
        elif not path.is_dir():
            hint = package_files.no_scenario(path)
            raise InputError(f"{path}: no such scenario, nor a folder of scenarios{hint}")
        elif inside := sorted(file.parent for file in path.glob(f"*/{FILE}")):
            chosen += inside
        else:
            raise InputError(f"{path}: neither {FILE} nor a folder with one in it")
    return chosen


def _run(scenario: Any, **options: Any) -> Any:
    return scenario.run(**options)


def _put_on(name: str, program: Path, drawing: Mapping[str, Any]) -> Scenario:
    tables: dict[str, Any] = {"drawing": drawing} if drawing else {}
    return machine(name).scenario(program, **tables)


def judged(
    path: Path, options: Mapping[str, Any], ways: SuiteWays = SuiteWays(), run: Run = _run
) -> list[Case]:
    """Run a scenario, or each of its contraries; `run` runs one with options."""
    folder = path.parent if path.name == FILE else path
    bare = Case(path.stem, str(path)) if ways.machine else Case(folder.resolve().name, str(folder))
    start = time.perf_counter()
    try:
        scenario = _put_on(ways.machine, path, ways.drawing) if ways.machine else load(path)
        bare = replace(bare, scenario=scenario.name)
        if not ways.contraries:
            result = run(scenario, **options)
            used = time.perf_counter() - start
            told = tuple(result.checks), tuple(result.warnings)
            return [replace(bare, seconds=used, checks=told[0], warnings=told[1])]
        cases = []
        for case in scenario.document.body.contrary:
            own = contrary.options(scenario.document, case)
            result = run(scenario, **{**options, **own})
            found = [replace(v, judged=True) for v in result.checks]  # it is to fail on purpose
            named = tuple(v for v in found if v.name in case.fails)
            hold = tuple(contrary.survivors(case, found))
            used = time.perf_counter() - start
            cases.append(replace(bare, off=case.off, seconds=used, checks=named, holding=hold))
            start = time.perf_counter()
        return cases or [replace(bare, off="nothing", holding=("all, there is no [[contrary]]",))]
    except InputError as error:
        return [replace(bare, seconds=time.perf_counter() - start, error=str(error))]


class _SuiteWorker:
    """A process that judges one scenario after the other."""

    def __init__(self, temporary: str) -> None:
        self.pipe, theirs = Pipe()
        with theirs:
            program = f"from motionfmu.run.suite import serve; serve({theirs.fileno()})"
            command, options = child(program, TMPDIR=temporary)
            self.process = subprocess.Popen(
                command, pass_fds=[theirs.fileno()], stdin=subprocess.DEVNULL, **options
            )

    def judged(self, *task: Any) -> list[Case] | None:
        """Cases of a scenario; None if the process has ended over it."""
        try:
            self.pipe.send(task)
            return list(self.pipe.recv())
        except (EOFError, OSError):
            return None

    def end(self) -> int:
        """End the process; its status."""
        self.process.terminate()
        self.pipe.close()
        try:
            return self.process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self.process.kill()
            return self.process.wait()


def serve(pipe: int) -> None:
    """Judge the scenarios that the parent process sends, until it is gone."""
    import signal

    signal.signal(signal.SIGTERM, lambda *_: sys.exit())  # files are removed on the way out
    with Connection(pipe) as connection, contextlib.suppress(EOFError, OSError):
        while True:
            connection.send(judged(*connection.recv()))


def together(
    paths: Sequence[Path], options: Mapping[str, Any], ways: SuiteWays, workers: int
) -> Iterator[list[Case]]:
    """Cases of each scenario, in the order of the paths, whatever the number of processes."""
    running: list[_SuiteWorker] = []
    own, lock, ended = threading.local(), threading.Lock(), threading.Event()

    def one(path: Path) -> list[Case]:
        worker: _SuiteWorker | None = getattr(own, "worker", None)
        if worker is None:
            with lock:  # a pipe's other end is open in no other child
                if ended.is_set():
                    return []
                worker = own.worker = _SuiteWorker(temporary)
                running.append(worker)
        cases = worker.judged(path, options, ways)
        if cases is not None:
            return cases
        own.worker = None
        code = worker.process.wait()
        how = f"signal {-code}" if code < 0 else f"status {code}"
        return [Case(path.resolve().name, str(path), error=f"{path}: it ended its process ({how})")]

    with (
        tempfile.TemporaryDirectory(prefix="motionfmu-", ignore_cleanup_errors=True) as temporary,
        ThreadPoolExecutor(workers) as pool,
    ):
        futures = [pool.submit(one, path) for path in paths]
        try:
            for future in futures:
                yield future.result()
        finally:
            for future in futures:
                future.cancel()
            with lock:  # none is being started
                ended.set()
            for worker in running:
                worker.end()
