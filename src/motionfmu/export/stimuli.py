"""The FMUs Stimulus of an exported system, which drive the inputs that a scenario drives."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from motionfmu import ssp
from motionfmu.export.ssp_values import kind, values
from motionfmu.fmu.describe import element_names
from motionfmu.scenarios import fmus
from motionfmu.scenarios.system import End, Setting, System, Values
from motionfmu.scenarios.values import start_values

FMU = "stimulus"
SIGNALS = {"Float64": "real", "Int32": "whole", "Boolean": "on"}


@dataclass
class Stimuli:
    """One instance of the FMU Stimulus: the rows of its table, and where its signals go.

    `used` counts the signals of each output.
    """

    name: str
    rows: list[tuple[float, int, float]] = field(default_factory=list)  # [s], signal, value
    used: dict[str, int] = field(default_factory=dict)
    ends: list[tuple[str, int, End, int]] = field(
        default_factory=list
    )  # output, element, to, element

    def takes(self, end: End, steps: list[tuple[float, Values]]) -> bool:
        """Add an input; False if the instance has no room for it."""
        output, ports = SIGNALS[end.port.type], fmus.ports(FMU)
        each, first = ports[output].count, self.used.get(output, 0)
        rows = len(self.rows) + len(steps) * end.port.count
        if first + end.port.count > each or rows > ports["at"].count:
            return False
        before = list(SIGNALS.values()).index(output) * each
        for k in range(end.port.count):
            signal = first + k + 1
            self.ends.append((output, signal, end, k + 1))
            self.rows += [(at, before + signal, float(values[k])) for at, values in steps]
        self.used[output] = first + end.port.count
        return True

    def settings(self) -> list[Setting]:
        """The instance's parameters."""
        ports = fmus.ports(FMU)
        columns = zip(*self.rows, strict=True)
        found = []
        for name, column in zip(("at", "signal", "value"), columns, strict=True):
            port = ports[name]
            rest = start_values(port)[len(self.rows) :]
            found.append(Setting(End(self.name, port), (*column, *rest)))
        return found

    def component(self, fmi: int, source: str) -> ssp.Component:
        """The instance as a component of an SSP: the rows in use, the outputs that are wired."""
        ports = fmus.ports(FMU)
        kinds = {name: kind(port.type, fmi) for name, port in ports.items()}
        if fmi == 3:
            outputs = dict.fromkeys(output for output, *_ in self.ends)
            connectors = [
                ssp.Connector(o, "output", kinds[o], shape=ports[o].shape) for o in outputs
            ]
        else:
            connectors = [ssp.Connector(f"{o}[{k}]", "output", kinds[o]) for o, k, *_ in self.ends]
        given = [v for s in self.settings() for v in values(s, fmi)]
        if fmi == 2:
            given = [v for v in given if int(v.name.rpartition("[")[2][:-1]) <= len(self.rows)]
        return ssp.Component(self.name, source, connectors, given)

    def driven(self) -> Iterator[End]:
        """The inputs that the instance drives."""
        yield from {end.name: end for _, _, end, _ in self.ends}.values()

    def connections(self, fmi: int) -> Iterator[ssp.Connection]:
        """The wires from the instance to these inputs."""
        for output, signal, end, element in self.ends:
            port = end.port
            if fmi == 3:
                index = (element,) if port.shape else ()
                target = (end.component, port.name)
                yield ssp.Connection((self.name, output), target, (signal,), index)
            else:
                name = element_names(port.name, port.shape)[element - 1]
                source = (self.name, f"{output}[{signal}]")
                yield ssp.Connection(source, (end.component, name))


def stimuli(system: System) -> tuple[list[Stimuli], list[str]]:
    """Instances that drive all inputs that they can, and in words what they cannot drive."""
    names = dict.fromkeys(s.end.name for s in system.stimuli)
    made: list[Stimuli] = []
    lost = []
    for name in names:
        mine = [s for s in system.stimuli if s.end.name == name]
        end, place = mine[0].end, "[record_file]" if mine[0].measured else "[[drive]]"
        if end.port.causality != "input" or end.port.type not in SIGNALS:
            lost.append(f"{place} {name}: no wire of an SSP leads to a {_what(end)}")
            continue
        steps = [(s.step * system.step_ns / 1e9, s.values) for s in mine]
        if mine[0].step > 0:
            steps.insert(0, (0.0, _first(system.settings, end)))
        if any(one.takes(end, steps) for one in made):
            continue
        fresh = Stimuli(_name(system.components, len(made)))
        if fresh.takes(end, steps):
            made.append(fresh)
        else:
            lost.append(f"{place} {name}: {len(steps)} steps are too many for the FMU {FMU}")
    return made, lost


def _what(end: End) -> str:
    return end.port.causality if end.port.causality != "input" else end.port.type


def _first(settings: Iterable[Setting], end: End) -> Values:
    """The values of an input before it is driven."""
    given = [s.values for s in settings if s.end.name == end.name]
    return given[-1] if given else start_values(end.port)


def _name(used: Iterable[str], number: int) -> str:
    """A name that no component has yet."""
    name = "stimuli" + (str(number + 1) if number else "")
    while name in used:
        name += "_"
    return name
