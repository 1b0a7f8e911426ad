"""FMPy's container FMU as an engine, of tests alone: a master in C of which nothing is ours.

It has no type conversion, so a Boolean is not recorded (it reads as false), and tells no warnings.
It cannot set an array, so it runs FMUs of FMI 2, whose elements are variables of their own.
"""

import tempfile
from collections.abc import Iterable
from contextlib import ExitStack
from pathlib import Path
from typing import Any
from unittest.mock import patch

from fmpy import read_model_description
from fmpy.container_fmu.cli import create_container_fmu
from fmpy.container_fmu.config import Component, Configuration, Connection
from fmpy.model_description import (
    CoSimulation,
    DefaultExperiment,
    ModelDescription,
    ModelVariable,
)

import motionfmu
from motionfmu.run import engines
from motionfmu.run.engines import lean
from motionfmu.run.engines.engine_job import EngineJob, EngineResult, Progress
from motionfmu.run.engines.scopes import ScopeSystem
from motionfmu.run.engines.slave import Slave, element_names, ending_of
from motionfmu.scenarios.system import End, System

NAME = "container"
TOKEN = "{6d6f7469-6f6e-666d-7500-636f6e746169}"


def _outer(
    name: str, kind: str, reference: int, start: str | None, causality: str = "input"
) -> ModelVariable:
    """The container's variable for one element; text can be given by its start value only."""
    return ModelVariable(
        type=kind,
        name=name,
        valueReference=reference,
        causality=causality,
        variability="discrete",
        start=start,
    )


def _elements(variables: dict[str, ModelVariable], end: End) -> list[ModelVariable]:
    """The FMI 2 scalars of a port."""
    first = end.port.reference
    by_reference = {v.valueReference: v for v in variables.values()}
    return [by_reference[first + i] for i in range(end.port.count)]


def _configuration(system: System, folder: Path) -> Configuration:
    components: dict[str, Component] = {}
    variables: dict[str, dict[str, ModelVariable]] = {}
    for name, fmu in system.components.items():
        link = folder / f"{name}.fmu"
        link.symlink_to(lean.packed(fmu, 2))
        components[name] = Component(name, link, read_model_description(str(link)))
        variables[name] = {v.name: v for v in components[name].modelDescription.modelVariables}
        for v in variables[name].values():  # the container knows the type names of FMI 3 only
            v.type = {"Real": "Float64", "Integer": "Int32"}.get(v.type, v.type)
    ends = [*(s.end for s in system.settings), *(s.end for s in system.stimuli)]
    texts = {s.end.name: str(s.values[0]) for s in system.settings if s.end.port.type == "String"}
    # The container counts its variables from the one after time.
    time = ModelVariable(
        type="Float64",
        name="time",
        valueReference=0,
        causality="independent",
        variability="continuous",
    )
    outer: dict[ModelVariable, list[tuple[Component, ModelVariable]]] = {}
    for end in {e.name: e for e in ends}.values():
        for inner in _elements(variables[end.component], end):
            name = f"{end.component}.{inner.name}"
            shown = _outer(name, end.port.type, len(outer) + 1, texts.get(end.name))
            outer[shown] = [(components[end.component], inner)]
    for end in {e.name: e for e in system.ending}.values():
        for inner in _elements(variables[end.component], end):
            name = f"{end.component}.{inner.name}"
            shown = _outer(name, end.port.type, len(outer) + 1, None, "output")
            outer[shown] = [(components[end.component], inner)]
    step = system.step_ns * 1e-9
    description = ModelDescription(
        fmiVersion="3.0",
        modelName="Container",
        instantiationToken=TOKEN,
        coSimulation=CoSimulation(modelIdentifier="container_fmu", fixedInternalStepSize=step),
        defaultExperiment=DefaultExperiment(startTime="0", stepSize=str(step)),
        modelVariables=[time, *outer],
    )
    return Configuration(
        parallelDoStep=False,
        modelDescription=description,
        components=list(components.values()),
        connections=[
            Connection(
                components[w.source.component],
                _elements(variables[w.source.component], w.source),
                components[w.target.component],
                _elements(variables[w.target.component], w.target),
            )
            for w in system.wires
            if w.source.port.type == w.target.port.type
        ],
        variableMappings=outer,
    )


def _give(slave: Slave, end: End, values: Iterable[Any]) -> None:
    for name, value in zip(element_names(end), values, strict=True):
        slave.assign(end.port.type, slave.references[f"{end.component}.{name}"], [value])


class Container:
    """A container of its own for each run."""

    def __init__(self, job: EngineJob) -> None:
        assert {job.system.version(c, job.fmi) for c in job.system.components} == {2}
        self._scopes = ScopeSystem(job)

    def run(self, system: System, progress: Progress) -> EngineResult:
        """Run from the start."""
        system = self._scopes.of(system)
        with ExitStack() as stack:
            name = stack.enter_context(tempfile.TemporaryDirectory(prefix="motionfmu-"))
            folder = Path(name)
            (folder / "unzipped").mkdir()
            configuration = _configuration(system, folder)
            create_container_fmu(configuration, folder / "unzipped", folder / "container.fmu")
            # With logging it would tell each of its calls.
            slave = Slave("container_fmu", folder / "unzipped", 3, [], logging=False)
            stack.callback(slave.free)
            for s in (s for s in system.settings if s.end.port.type != "String"):
                _give(slave, s.end, s.values)
            slave.initialize()
            slave.start()
            due = system.due()
            step = system.step_ns * 1e-9
            ending = ending_of(slave, system, 2)
            for k in ending.points(progress):
                for now in due.get(k, ()):
                    _give(slave, now.end, now.values)
                slave.step(k * system.step_ns * 1e-9, step)
            slave.end()
            return ending.ran(NAME, self._scopes, [])

    def close(self) -> None:
        """Nothing to release: each run has its own container."""


def run(scenario: motionfmu.Scenario, **options: Any) -> motionfmu.Result:
    """Run a scenario in it; options as of `Scenario.run`."""
    with patch.dict(engines.ENGINES, {NAME: Container}):
        return scenario.run(engine=NAME, fmi=2, **options)
