"""FMPy's own container as an engine: a third opinion for tests.

It has no type conversion, so a Boolean is not recorded (it reads as false), and it carries FMI 3
only.
"""

import tempfile
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

from fmpy import read_model_description
from fmpy.container_fmu.cli import create_container_fmu
from fmpy.container_fmu.config import Component, Configuration, Connection
from fmpy.model_description import (
    CoSimulation,
    DefaultExperiment,
    Dimension,
    ModelDescription,
    ModelVariable,
)

from motionfmu import fmus
from motionfmu.engines.slave import Slave
from motionfmu.errors import InputError
from motionfmu.system import End, System

TOKEN = "{6d6f7469-6f6e-666d-7500-636f6e746169}"


def _outer(end: End, reference: int) -> ModelVariable:
    """The container's variable for an exposed port."""
    start = {"Float64": "0", "Int32": "0", "Boolean": "false", "String": ""}[end.port.type]
    return ModelVariable(
        type=end.port.type,
        name=end.name,
        valueReference=reference,
        causality="input",
        variability="discrete",
        start=start if not end.port.shape else [start] * end.port.count,
        dimensions=[Dimension(start=n, valueReference=None) for n in end.port.shape],
        shape=end.port.shape,
    )


def _configuration(system: System, folder: Path) -> Configuration:
    components: dict[str, Component] = {}
    variables: dict[str, dict[str, ModelVariable]] = {}
    for name, fmu in system.components.items():
        link = folder / f"{name}.fmu"
        link.symlink_to(fmus.fmu_path(fmu, 3).resolve())
        components[name] = Component(name, link, read_model_description(str(link)))
        variables[name] = {v.name: v for v in components[name].modelDescription.modelVariables}
    ends = [*(s.end for s in system.settings), *(s.end for s in system.stimuli)]
    given = {e.name: e for e in ends}
    outer = {_outer(e, i): e for i, e in enumerate(given.values())}
    step = system.step_ns * 1e-9
    description = ModelDescription(
        fmiVersion="3.0",
        modelName="Container",
        instantiationToken=TOKEN,
        coSimulation=CoSimulation(modelIdentifier="container_fmu", fixedInternalStepSize=step),
        defaultExperiment=DefaultExperiment(startTime="0", stepSize=str(step)),
        modelVariables=list(outer),
    )
    return Configuration(
        parallelDoStep=False,
        modelDescription=description,
        components=list(components.values()),
        connections=[
            Connection(
                components[w.source.component],
                [variables[w.source.component][w.source.port.name]],
                components[w.target.component],
                [variables[w.target.component][w.target.port.name]],
            )
            for w in system.wires
            if w.source.port.type == w.target.port.type
        ],
        variableMappings={
            v: [(components[e.component], variables[e.component][e.port.name])]
            for v, e in outer.items()
        },
    )


def run(system: System, fmi: int, progress: Callable[[float], None]) -> None:
    """Run a system inside FMPy's container FMU.

    Parameters
    ----------
    system : System
    fmi : int
        Must be 3.
    progress : callable
        Called with the share done, 0 to 1.

    Raises
    ------
    InputError
        `fmi` is not 3, or an FMU refused something.
    """
    if fmi != 3:
        raise InputError(f"engine fmpy runs FMI 3 only, not FMI {fmi}")
    with ExitStack() as stack:
        name = stack.enter_context(tempfile.TemporaryDirectory(prefix="motionfmu-"))
        folder = Path(name)
        (folder / "unzipped").mkdir()
        configuration = _configuration(system, folder)
        create_container_fmu(configuration, folder / "unzipped", folder / "container.fmu")
        slave = Slave("container_fmu", folder / "container.fmu", 3, [])
        stack.callback(slave.free)
        for s in system.settings:
            slave.assign(s.end.port.type, slave.references[s.end.name], s.values)
        slave.initialize()
        slave.start()
        pending = list(system.stimuli)
        step = system.step_ns * 1e-9
        for k in range(system.steps):
            while pending and pending[0].step == k:
                now = pending.pop(0)
                slave.assign(now.end.port.type, slave.references[now.end.name], now.values)
            slave.step(k * system.step_ns * 1e-9, step)
            if k % max(1, system.steps // 100) == 0:
                progress(k / system.steps)
        slave.end()
        progress(1.0)
