"""The reference master: a Jacobi co-simulation in a page of Python.

At each communication point all outputs are read, then all inputs written, then every FMU steps.
"""

from collections.abc import Callable
from contextlib import ExitStack

from motionfmu.run.engines import lean
from motionfmu.run.engines.ending import Ending
from motionfmu.run.engines.engine_job import EngineJob, EngineResult, Progress
from motionfmu.run.engines.scopes import ScopeSystem
from motionfmu.run.engines.slave import Slave
from motionfmu.scenarios.system import System, Wire


def _wire(slaves: dict[str, Slave], wire: Wire) -> tuple[Callable[[], None], Callable[[], None]]:
    """The two functions that read the output and write the input of a wire."""
    source, target = slaves[wire.source.component], slaves[wire.target.component]
    a, b = wire.source.port, wire.target.port
    buffer = source.buffer(a.type, a.count)
    get = source.access("Get", a.type, a.reference, buffer)
    same = a.type == b.type and (source.fmi == target.fmi or a.type != "Boolean")
    if same:
        return get, target.access("Set", b.type, b.reference, buffer)
    converted = target.buffer(b.type, b.count)  # a Boolean recorded as 0 and 1
    put = target.access("Set", b.type, b.reference, converted)

    def convert() -> None:
        converted[:] = [int(x) for x in buffer]
        put()

    return get, convert


def _exchange(wires: list[tuple[Callable[[], None], Callable[[], None]]]) -> None:
    """Read all outputs, then write all inputs."""
    for get, _ in wires:
        get()
    for _, put in wires:
        put()


def _ending(slaves: dict[str, Slave], system: System) -> Ending:
    """Where the run ends; a signal is read in the FMU that shows it."""
    read = []
    for end in system.ending:
        slave, port = slaves[end.component], end.port
        values = slave.buffer(port.type, port.count)
        read.append((slave.access("Get", port.type, port.reference, values), values))
    return Ending(system, read)


class Master:
    """FMUs of their own for each run, one Python call per value."""

    def __init__(self, job: EngineJob, engine: str, make: type[Slave]) -> None:
        self._fmi, self._scopes = job.fmi, ScopeSystem(job)
        self._engine, self._make = engine, make

    def run(self, system: System, progress: Progress) -> EngineResult:
        """Run from the start."""
        system, errors, warnings = self._scopes.of(system), list[str](), list[str]()
        with ExitStack() as stack:
            slaves: dict[str, Slave] = {}
            for name, fmu in system.components.items():
                fmi = system.version(name, self._fmi)
                slaves[name] = self._make(name, lean.unpacked(fmu, fmi), fmi, errors)
                slaves[name].share(warnings)
                stack.callback(slaves[name].free)
            for s in system.settings:
                port = s.end.port
                slaves[s.end.component].assign(port.type, port.reference, s.values)
            for slave in slaves.values():
                slave.initialize(system.begin_time)
            wires = [_wire(slaves, w) for w in system.wires]
            _exchange(wires)  # an output of a foreign FMU may follow its inputs at once
            for slave in slaves.values():
                slave.start()
            due = system.due()
            steps = [slave.stepper(system.step_ns * 1e-9) for slave in slaves.values()]
            ending = _ending(slaves, system)
            for k in ending.points(progress):
                for now in due.get(k, ()):
                    port = now.end.port
                    slaves[now.end.component].assign(port.type, port.reference, now.values)
                _exchange(wires)
                for step in steps:
                    step(k * system.step_ns * 1e-9)
            for slave in slaves.values():
                slave.end()
            return ending.ran(self._engine, self._scopes, warnings)

    def close(self) -> None:
        """Do nothing: no instance lives between two runs."""


def opened(job: EngineJob) -> Master:
    """Plan a job."""
    return Master(job, "python", Slave)
