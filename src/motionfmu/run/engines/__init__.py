"""Engines that run a System; all give the same bits.

Each is a module with ``opened(job)``, which gives an `Engine`; it is imported when it is used.
"""

import os
from collections.abc import Callable

from motionfmu.errors import InputError, suggestion
from motionfmu.run.engines.job import Engine, Job

VARIABLE = "MOTIONFMU_ENGINE"


def _native(job: Job) -> Engine:
    from motionfmu.run.engines import native

    return native.opened(job)


def _python(job: Job) -> Engine:
    from motionfmu.run.engines import reference

    return reference.opened(job)


def _fmpy(job: Job) -> Engine:
    from motionfmu.run.engines import fmpy_container

    return fmpy_container.opened(job)


ENGINES: dict[str, Callable[[Job], Engine]] = {
    "native": _native,
    "python": _python,
    "fmpy": _fmpy,
}


def named(engine: str | None) -> str:
    """The engine of this name; for None that of ``$MOTIONFMU_ENGINE``, else the usual one."""
    given = os.environ.get(VARIABLE) if engine is None else engine
    if given and given not in ENGINES:
        place = f"{VARIABLE}: " if engine is None else ""
        known = f"(there are: {', '.join(ENGINES)}){suggestion(str(given), ENGINES)}"
        raise InputError(f"{place}no engine {given!r} {known}")
    return given or "native"


def version(engine: str, fmi: int | None) -> int:
    """FMI version of the FMUs; FMPy's container runs those of FMI 2 only."""
    return fmi if fmi is not None else 2 if engine == "fmpy" else 3
