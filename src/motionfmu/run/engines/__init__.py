"""Engines that run a System; all give the same bits.

Each is a module with ``run(system, fmi, progress)``; ENGINES finds them by name.
"""

from collections.abc import Callable

from motionfmu.run.engines import fmpy_container, native, reference
from motionfmu.run.engines.ending import Ran
from motionfmu.scenarios.system import System

Progress = Callable[[float], None]
Engine = Callable[[System, int, Progress], Ran]

ENGINES: dict[str, Engine] = {
    "native": native.run,
    "python": reference.run,
    "fmpy": fmpy_container.run,
}
