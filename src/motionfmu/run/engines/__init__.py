"""Engines that run a System; all engines give the same bits.

Each is a module with ``opened(job)``, which gives an `Engine`; it is imported when it is used.
"""

import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from motionfmu.base.compiler import NotCompiled, there
from motionfmu.base.errors import InputError, suggestion
from motionfmu.run.engines.engine_job import Engine, EngineJob, EngineResult, Progress
from motionfmu.scenarios.fmus import is_ours
from motionfmu.scenarios.system import System

VARIABLE = "MOTIONFMU_ENGINE"


def unfused(system: System) -> str:
    """Why a system cannot be one program, as far as FMUs and wires show it; empty if it can."""
    foreign = next((fmu for fmu in system.components.values() if not is_ours(fmu)), None)
    if foreign is not None:
        return f"{Path(foreign).name} has no C text of ours"
    return "a wire joins an element of an array" if system.elementwise else ""


def _fused(job: EngineJob) -> Engine:
    from motionfmu.fused import NotFused
    from motionfmu.run.engines import fused_engine

    try:
        if why := unfused(job.system):
            raise NotFused(why)
        return fused_engine.opened(job)
    except NotFused as told:
        raise InputError(f"engine fused: {told}; --engine native runs it") from None


def _native(job: EngineJob) -> Engine:
    from motionfmu.run.engines import native

    return native.opened(job)


def _python(job: EngineJob) -> Engine:
    from motionfmu.run.engines import reference

    return reference.opened(job)


def _fmpy(job: EngineJob) -> Engine:
    from motionfmu.run.engines import fmpy_slave

    return fmpy_slave.opened(job)


ENGINES: dict[str, Callable[[EngineJob], Engine]] = {
    "fused": _fused,
    "native": _native,
    "python": _python,
    "fmpy": _fmpy,
}


def named(engine: str | None) -> str | None:
    """The engine of this name; for None that of ``$MOTIONFMU_ENGINE``, if it is set."""
    given = os.environ.get(VARIABLE) if engine is None else engine
    if given and given not in ENGINES:
        place = f"{VARIABLE}: " if engine is None else ""
        known = f"(there are: {', '.join(ENGINES)}){suggestion(str(given), ENGINES)}"
        raise InputError(f"{place}no engine {given!r} {known}")
    return given or None


def opened(engine: str | None, job: EngineJob) -> Engine:
    """An engine ready to run a job; None is fused where that can be, else native."""
    if engine is not None:
        return ENGINES[engine](job)
    if unfused(job.system):
        return _native(job)
    from motionfmu.fused import NoCompiler, NotFused
    from motionfmu.run.engines import fused_engine

    try:
        return fused_engine.opened(job)
    except (NoCompiler, NotCompiled) as error:
        return _Instead(_native(job), f"engine native instead of fused: {error}")
    except NotFused:
        return _native(job)


def usual(system: System) -> tuple[str, str]:
    """The engine that runs a system if the user names none, and why; no reason for fused."""
    if given := named(None):
        return given, VARIABLE
    from motionfmu.fused.fmu_parts import NotFused, carried

    if why := unfused(system):
        return "native", why
    if not there():
        return "native", "there is no C compiler"
    try:
        for fmu in dict.fromkeys(system.components.values()):
            carried(fmu)
    except NotFused as why:
        return "native", str(why)
    return "fused", ""


class _Instead:
    """The native engine in the place of the fused one; each run has a warning that says why."""

    def __init__(self, engine: Engine, told: str) -> None:
        self._engine, self._told = engine, told
        self.close = engine.close

    def run(self, system: System, progress: Progress) -> EngineResult:
        """Run from the start."""
        ran = self._engine.run(system, progress)
        return replace(ran, warnings=[self._told, *ran.warnings])
