"""The native engine: the system becomes one container FMU whose master is C.

The container is made by fmucontainer of the FMU manipulation toolbox in its parallel mode, which
exchanges all values and then steps all FMUs (Jacobi). It is run by FMPy in few long steps, or step
by step if a signal ends the run.
"""

import logging
import tempfile
from pathlib import Path
from typing import Any

from fmu_manipulation_toolbox.container import FMUContainer

from motionfmu.base.errors import InputError
from motionfmu.base.platforms import here
from motionfmu.run.engines import lean
from motionfmu.run.engines.ending import shares
from motionfmu.run.engines.engine_job import EngineJob, EngineResult, Progress
from motionfmu.run.engines.scopes import ScopeSystem
from motionfmu.run.engines.slave import Slave, ending_of, exposed
from motionfmu.scenarios.system import End, Setting, Stimulus, System

IDENTIFIER = "system"


class _Folder(FMUContainer):
    """A container that stays a folder; it runs on this machine only, so no archive is made."""

    def make_fmu_package(self, base_directory: Path, fmu_filename: Path) -> None:
        """Do nothing, where the base class would compress everything."""


def build(system: System, fmi: int, folder: Path) -> Path:
    """Make the container FMU, unpacked in an empty folder; returns its own folder.

    Settings and stimuli become inputs of the container, ``component.variable``, because its own
    start values cannot carry arrays of Boolean nor text with spaces.
    """
    log = logging.getLogger("fmu_manipulation_toolbox")
    before, log.disabled = log.disabled, True  # the log warns of every output that nothing reads
    try:
        container = _Folder(IDENTIFIER, folder, fmi_version=outer(system, fmi))
        container.start_time = system.begin_time
        container.stop_time = system.steps * system.step_ns * 1e-9
        for name, fmu in system.components.items():
            container.get_fmu(str(lean.packed(fmu, fmi)), name=f"{name}.fmu")
        for wire in system.wires:
            container.add_link(
                f"{wire.source.component}.fmu",
                wire.source.port.name,
                f"{wire.target.component}.fmu",
                wire.target.port.name,
            )
        wired = {w.target.name for w in system.wires if w.target.port.whole}
        ends = [*(s.end for s in system.settings), *(s.end for s in system.stimuli)]
        for end in {e.name: e for e in ends}.values():
            for name in exposed(end, system.version(end.component, fmi)):
                if f"{end.component}.{name}" not in wired:
                    container.add_input(f"{end.component}.{name}", f"{end.component}.fmu", name)
        for end in {e.name: e for e in system.ending}.values():
            for name in exposed(end, system.version(end.component, fmi)):
                container.add_output(f"{end.component}.fmu", name, f"{end.component}.{name}")
        container.make_fmu(f"{IDENTIFIER}.fmu", step_size=system.step_ns * 1e-9, debug=True)
    finally:
        log.disabled = before
    return folder / IDENTIFIER


def outer(system: System, fmi: int) -> int:
    """FMI version of a container; FMI 2 lacks some types of FMI 3."""
    return max(system.version(component, fmi) for component in system.components)


def _has_a_master(built: Path, fmi: int) -> None:
    """An InputError if the container brings no library for this machine."""
    machine = here()
    if not (built / f"binaries/{machine.folder(fmi)}/{IDENTIFIER}{machine.suffix}").is_file():
        raise InputError(
            f"engine native: fmu-manipulation-toolbox has no master for {machine.name}; "
            "--engine fused needs a C compiler, --engine python nothing"
        )


def _give(slave: Slave, end: End, values: tuple[Any, ...], fmi: int) -> None:
    names = exposed(end, fmi)
    parts = [values] if len(names) == 1 else [(v,) for v in values]
    for name, part in zip(names, parts, strict=True):
        reference = slave.references.get(f"{end.component}.{name}")
        if reference is not None:  # else a wire feeds this element
            slave.assign(end.port.type, reference, part)


class Container:
    """A system as a container FMU, built once, run many times.

    A run can set the variables that the system's settings name.
    """

    def __init__(self, job: EngineJob) -> None:
        self._scopes, self._fmi = ScopeSystem(job), job.fmi
        self._folder = tempfile.TemporaryDirectory(prefix="motionfmu-")
        try:
            built = build(self._scopes.system, job.fmi, Path(self._folder.name))
            _has_a_master(built, outer(self._scopes.system, job.fmi))
            self._slave = Slave(IDENTIFIER, built, outer(self._scopes.system, job.fmi), [])
        except BaseException:
            self._folder.cleanup()
            raise
        self._used = False

    def run(self, system: System, progress: Progress) -> EngineResult:
        """Run from the start."""
        slave, system = self._slave, self._scopes.of(system)
        if self._used:
            slave.renew()
        self._used = True
        for s in system.settings:
            self._give(system, s)
        slave.initialize(system.begin_time)
        slave.start()
        ending = ending_of(slave, system, self._fmi)
        if system.until is None:
            self._in_parts(system, progress)
        else:
            due, step = system.due(), system.step_ns * 1e-9
            advance = slave.stepper(step)
            for k in ending.points(progress):
                for now in due.get(k, ()):
                    self._give(system, now)
                advance(k * system.step_ns * 1e-9)
        slave.end()
        warnings = [w for w in slave.warnings if not w.startswith(f"{IDENTIFIER}: ")]
        return ending.ran("native", self._scopes, warnings)

    def _give(self, system: System, given: Setting | Stimulus) -> None:
        end = given.end
        _give(self._slave, end, given.values, system.version(end.component, self._fmi))

    def _in_parts(self, system: System, progress: Progress) -> None:
        """Run in few long steps."""
        slave, due = self._slave, system.due()
        for k, following in shares(system, due, system.steps):
            for now in due.get(k, ()):
                self._give(system, now)
            slave.step(k * system.step_ns * 1e-9, (following - k) * system.step_ns * 1e-9)
            progress(system.share(following))

    def close(self) -> None:
        """Free the instance, the library and its files."""
        try:
            self._slave.free()
        finally:
            self._folder.cleanup()


def opened(job: EngineJob) -> Container:
    """Build the container of a job."""
    return Container(job)
