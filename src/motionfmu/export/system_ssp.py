"""A scenario's system as a System Structure and Parameterization file."""

import tempfile
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from motionfmu import ssp
from motionfmu.base.errors import InputError
from motionfmu.base.toml_lines import is_file
from motionfmu.export.export_choice import VERSIONS, also_shown, check_version
from motionfmu.export.program_check import check_scenario
from motionfmu.export.resources import Resources
from motionfmu.export.ssp_values import kind, values
from motionfmu.export.stimuli import FMU, Stimuli, stimuli
from motionfmu.fmu.describe import element_names
from motionfmu.fmu.pack import repacked, write_whole
from motionfmu.fmu.start_values import texts
from motionfmu.run.controller_plan import bounded
from motionfmu.run.run_plan import Options, RunPlan
from motionfmu.scenarios.fmus import fmu_path, is_ours
from motionfmu.scenarios.system import End, Setting, System, Wire

SET = "scenario"  # name of the parameter sets
RESOURCES = "resources"


@dataclass(frozen=True)
class Written:
    """What a scenario has become as an SSP.

    Attributes
    ----------
    components, connections : int
        How many.
    left_out : list of str
        What of the scenario it does not say.
    """

    components: int
    connections: int
    left_out: list[str]


def as_ssp(
    scenario: RunPlan,
    target: Path,
    fmi: int,
    given: Mapping[str, Any],
    inner: Collection[str] = (),
) -> Written:
    """Write the system as an SSP.

    With FMI 2 it is an SSP 1.0, with FMI 3 an SSP 2.0.

    Parameters
    ----------
    scenario : RunPlan
        With its FMUs.
    target : Path
        The .ssp.
    fmi : int
        2 or 3.
    given : mapping
        Value by ``component.variable``, stronger than the scenario's.
    inner : collection of str
        Patterns of inputs and outputs that are connectors beside those that are wired or recorded.

    Raises
    ------
    InputError
        Of a version, a pattern that matches nothing, or a file that cannot be written.
    """
    check_version(fmi)
    system = scenario.resolved(bounded(scenario, Options(set=given)))
    check_scenario(scenario, system, given)
    _check_parts(scenario.name, system, fmi)
    shown = also_shown(scenario, inner, ("output", "input"))
    driving, left_out = stimuli(system)
    structure = _structure(scenario, system, shown, driving, fmi)
    if system.until is not None:
        names = " and ".join(s.name for s in system.until.signals)
        left_out.append(f"stop = {names}: an SSP ends by time, here by limit")
    theirs = [c for c, fmu in system.components.items() if not is_ours(fmu)]
    given_to = {s.end.component for s in system.settings}
    left_out += [
        f"{c}: values stand in its parameter set alone, which some tools pass over: it is not ours"
        for c in theirs
        if c in given_to
    ]
    parts = {name: (fmu, _own(system, name)) for name, fmu in system.components.items()}
    parts |= {one.name: (FMU, (one.settings(), {})) for one in driving}
    files: dict[str, bytes] = {}
    sets: dict[str, str] = {}
    with tempfile.TemporaryDirectory(prefix="motionfmu-") as folder:
        for c in structure.components:
            fmu = Path(folder) / f"{c.name}.fmu"
            _pack(parts[c.name], fmi, fmu)
            files[c.source] = fmu.read_bytes()
            if c.values:
                sets[c.name] = f"{RESOURCES}/{c.name}.ssv"
                files[sets[c.name]] = ssp.parameter_values(SET, c.values, structure.version)
    files[ssp.SSD] = ssp.description(structure, sets)
    readme = scenario.document.file.parent / "README.md"
    if is_file(readme):
        files["documentation/README.md"] = readme.read_bytes()
    write_whole(target, files)
    return Written(len(structure.components), len(structure.connections), left_out)


def _check_parts(name: str, system: System, fmi: int) -> None:
    """Refuse what an SSP of this version cannot hold."""
    if system.begin:
        told = "it begins in a saved state, and what drives an SSP begins at 0 s"
        raise InputError(f"{name}: {told}: export it as one FMU")
    for component in system.components:
        if system.version(component, fmi) > fmi:
            told = f"{component} is FMI 3, which no SSP {VERSIONS[fmi]} has: --fmi 3"
            raise InputError(f"{name}: {told}")
    if fmi == 3 and system.elementwise:
        raise InputError(f"{name}: wires join elements of arrays, which FMI 2 has: --fmi 2")


def _structure(
    scenario: RunPlan, system: System, shown: Collection[End], driving: list[Stimuli], fmi: int
) -> ssp.Structure:
    """The structure that the file describes."""
    components = []
    for name in system.components:
        given = [v for s in _own(system, name)[0] for v in values(s, fmi)]
        connectors = list(_connectors(system, name, shown, driving, fmi))
        components.append(ssp.Component(name, _source(name), connectors, given))
    components += [one.component(fmi, _source(one.name)) for one in driving]
    connections = [c for wire in system.wires for c in _connections(wire, fmi)]
    connections += [c for one in driving for c in one.connections(fmi)]
    return ssp.Structure(
        scenario.name,
        scenario.document.about,
        VERSIONS[fmi],
        components,
        connections,
        stop=system.steps * system.step_ns / 1e9,
        step=system.step_ns / 1e9,
    )


def _source(component: str) -> str:
    return f"{RESOURCES}/{component}.fmu"


def _own(system: System, component: str) -> tuple[list[Setting], dict[str, Path]]:
    """The settings of a component, and the files that they name, which its FMU carries."""
    resources = Resources()
    mine = [s for s in system.settings if s.end.component == component]
    if is_ours(system.components[component]):
        mine = [resources.inside(s) for s in mine]
    return mine, resources.files


def _pack(part: tuple[str, tuple[list[Setting], dict[str, Path]]], fmi: int, target: Path) -> None:
    """Write an FMU with its files inside.

    The values become its start values as well, for some tools ignore parameter sets. A foreign FMU
    is written as it is.
    """
    fmu, (settings, files) = part
    if not is_ours(fmu):
        target.write_bytes(fmu_path(fmu, fmi).read_bytes())
        return
    starts = {s.end.port.name: " ".join(texts(s.values)) for s in settings}
    repacked(fmu_path(fmu, fmi), target, files, starts)


def _connectors(
    system: System, component: str, shown: Collection[End], driving: list[Stimuli], fmi: int
) -> Iterator[ssp.Connector]:
    """The connectors of a component: variables that are wired or shown.

    An unconnected input is no connector, for some tools would wire it or set it to 0.
    """
    ends = [*(w.target for w in system.wires), *(w.source for w in system.wires)]
    ends += [*(e for one in driving for e in one.driven()), *shown]
    for end in {e.name: e for e in ends if e.component == component}.values():
        port, named = end.port, kind(end.port.type, fmi)
        if fmi == 3:
            yield ssp.Connector(port.name, port.causality, named, port.unit, port.shape)
            continue
        for name in element_names(port.name, port.shape):
            yield ssp.Connector(name, port.causality, named, port.unit)


def _connections(wire: Wire, fmi: int) -> Iterator[ssp.Connection]:
    a, b = wire.source, wire.target
    if fmi == 3:
        yield ssp.Connection((a.component, a.port.name), (b.component, b.port.name))
        return
    pairs = zip(
        element_names(a.port.name, a.port.shape),
        element_names(b.port.name, b.port.shape),
        strict=True,
    )
    for source, target in pairs:
        yield ssp.Connection((a.component, source), (b.component, target))
