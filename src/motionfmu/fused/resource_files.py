"""Files in the resources of a system's FMUs, and their places in the resources of its program."""

import functools
from collections.abc import Mapping
from dataclasses import replace

from motionfmu.fmu import start_values
from motionfmu.fmu.pack import RESOURCES
from motionfmu.fmu.places import RESOURCE
from motionfmu.scenarios import fmus
from motionfmu.scenarios.system import End, Setting, System
from motionfmu.scenarios.values import start_values as usual


def files(fmu: str) -> dict[str, bytes]:
    """The files that parameters of an FMU may name as ``resource:NAME``, by this name."""
    return _files(fmu, fmus.state(fmu))


@functools.cache
def _files(fmu: str, state: fmus.FileState) -> dict[str, bytes]:
    with fmus.opened(fmu) as archive:
        found = [n for n in archive.namelist() if n.startswith(f"{RESOURCES}/") and n[-1] != "/"]
        places = {n.removeprefix(f"{RESOURCES}/"): n for n in found}
        return {own: archive.read(n) for own, n in places.items() if own != start_values.FILE}


def carrying(system: System) -> Mapping[str, dict[str, bytes]]:
    """Files of each component that has some; a program has them as ``COMPONENT/NAME``."""
    return {c: found for c, fmu in system.components.items() if (found := files(fmu))}


def placed(system: System, components: Mapping[str, object]) -> System:
    """The system whose parameters name the files of these components where the program has them."""
    given = {s.end.name: s for s in system.settings}
    for component in components:
        for port in fmus.ports(system.components[component]).values():
            end = End(component, port)
            values = given[end.name].values if end.name in given else usual(port)
            if port.file == "read" and str(values[0]).lower().startswith(RESOURCE):
                own = str(values[0])[len(RESOURCE) :]
                given[end.name] = Setting(end, (f"{RESOURCE}{component}/{own}",))
    return replace(system, settings=tuple(given.values()))
