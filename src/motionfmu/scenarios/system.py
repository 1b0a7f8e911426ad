"""A scenario resolved against the FMUs it names: every wire and value checked."""

import fnmatch
import math
from dataclasses import dataclass

from motionfmu import units
from motionfmu.errors import InputError, suggestion
from motionfmu.scenarios import fmus
from motionfmu.scenarios.document import Document
from motionfmu.scenarios.fmus import Port

Values = tuple[float | int | bool | str, ...]
# A time in decimal seconds is off a whole number of ns by rounding only.
NS_TOLERANCE = 1e-3
# Limits of a run: more than a day of machine time, hours of computing.
TIME_MAX = 1e5  # [s]
STEPS_MAX = 100_000_000
# Clock of card and recorder; no FMU here steps by a part of it.
CLOCK_NS = 25


@dataclass(frozen=True)
class End:
    """A variable of a component."""

    component: str
    port: Port

    @property
    def name(self) -> str:
        """As written in a scenario: ``component.variable``."""
        return f"{self.component}.{self.port.name}"


@dataclass(frozen=True)
class Wire:
    """An output and the input it feeds."""

    source: End
    target: End


@dataclass(frozen=True)
class Setting:
    """A value given before initialization; one per element."""

    end: End
    values: Values


@dataclass(frozen=True)
class Stimulus:
    """An input that takes `values` when step number `step` begins."""

    end: End
    step: int
    values: Values


@dataclass(frozen=True)
class System:
    """All that an engine needs."""

    components: dict[str, str]  # FMU by component
    wires: tuple[Wire, ...]
    settings: tuple[Setting, ...]
    stimuli: tuple[Stimulus, ...]  # ordered by step
    step_ns: int  # communication step [ns]
    steps: int  # how many
    every: int = 1  # of them is recorded

    @property
    def sample_ns(self) -> int:
        """Between two rows of the recording."""
        return self.step_ns * self.every

    @property
    def samples(self) -> int:
        """Rows of the recording."""
        return -(-self.steps // self.every)

    def due(self) -> dict[int, list[Stimulus]]:
        """Stimuli by the step before which they act."""
        found: dict[int, list[Stimulus]] = {}
        for stimulus in self.stimuli:
            found.setdefault(stimulus.step, []).append(stimulus)
        return found


def nanoseconds(key: str, seconds: float) -> int:
    """Whole nanoseconds of a time [s], positive, up to `TIME_MAX`; a ValueError names the key."""
    if seconds > TIME_MAX:
        raise ValueError(f"{key} = {seconds!r} s: {TIME_MAX:g} s are the most")
    ns = seconds * 1e9
    if not (math.isfinite(ns) and ns >= 1 and abs(ns - round(ns)) <= NS_TOLERANCE):
        raise ValueError(f"{key} = {seconds!r} s is not a whole number of ns")
    return round(ns)


def split(name: str) -> tuple[str, int | None]:
    """Part ``component.variable[i]``, i from 1, into variable and element, from 0 or None."""
    whole, bracket, rest = name.partition("[")
    index = rest.removesuffix("]")
    if bracket and rest.endswith("]") and index.isdecimal():
        return whole, int(index) - 1
    return name, None


class Resolver:
    """Looks names up in the FMUs a scenario uses."""

    def __init__(self, document: Document) -> None:
        self.document = document
        self.ports: dict[str, dict[str, Port]] = {}
        for name, fmu in document.body.component.items():
            try:
                self.ports[name] = fmus.ports(fmu)
            except InputError as error:
                raise document.error(str(error), "component", name) from None

    def end(self, name: str, table: str, key: str) -> End:
        """Find ``component.variable``, written at table and key, or suggest the nearest."""
        component, _, variable = name.partition(".")
        if component not in self.ports:
            raise self.document.error(
                f"{name}: no component {component!r}{suggestion(component, self.ports)}", table, key
            )
        if variable not in self.ports[component]:
            fmu = self.document.body.component[component]
            whole = variable.partition("[")[0]
            hint = (
                f"; wires and values take whole arrays: {component}.{whole}"
                if whole in self.ports[component]
                else suggestion(variable, self.ports[component])
            )
            raise self.document.error(
                f"{name}: {fmu} has no variable {variable!r}{hint}", table, key
            )
        return End(component, self.ports[component][variable])

    def matching(self, pattern: str, causality: str) -> list[End]:
        """All variables of one causality whose name matches a pattern with ``*`` and ``?``."""
        return [
            End(component, port)
            for component, ports in self.ports.items()
            for port in ports.values()
            if port.causality == causality
            and fnmatch.fnmatchcase(f"{component}.{port.name}", pattern)
        ]


def _check_wire(document: Document, wire: Wire, key: str) -> None:
    a, b = wire.source, wire.target
    if a.port.causality != "output":
        raise document.error(f"{a.name} is no output ({a.port.causality})", "connect", key)
    if b.port.causality != "input":
        raise document.error(f"{b.name} is no input ({b.port.causality})", "connect", key)
    if (a.port.type, a.port.shape) != (b.port.type, b.port.shape):
        raise document.error(
            f"{b.name} is {_kind(b.port)}, {a.name} is {_kind(a.port)}", "connect", key
        )
    if not units.convertible(a.port.unit, b.port.unit):
        raise document.error(
            f"{b.name} [{b.port.unit or '1'}] = {a.name} [{a.port.unit or '1'}]: units differ",
            "connect",
            key,
        )


def _kind(port: Port) -> str:
    return port.type + "".join(f"[{n}]" for n in port.shape)


def wires(resolver: Resolver) -> list[Wire]:
    """All wires of the scenario, wildcards expanded; types, shapes, units, directions checked."""
    document, found = resolver.document, {}
    for left, right in document.body.connect.items():
        if left.endswith("*") != right.endswith("*"):
            raise document.error(
                f"{left} = {right}: a group needs * on both sides", "connect", left
            )
        if left.endswith("*"):
            targets = resolver.matching(left, "input")
            sources = {e.name: e for e in resolver.matching(right, "output")}
            pairs = [
                Wire(sources[name], target)
                for target in targets
                if (name := right[:-1] + target.name[len(left) - 1 :]) in sources
            ]
            if not pairs:
                raise document.error(f"{left} = {right} joins nothing", "connect", left)
        else:
            pairs = [
                Wire(resolver.end(right, "connect", left), resolver.end(left, "connect", left))
            ]
        for wire in pairs:
            _check_wire(document, wire, left)
            if wire.target.name in found:
                raise document.error(f"{wire.target.name} has two sources", "connect", left)
            found[wire.target.name] = wire
    return list(found.values())


def check_inputs(resolver: Resolver, system: System) -> None:
    """Refuse an input that nothing or two things feed; the message names it."""
    document = resolver.document
    wired = {w.target.name for w in system.wires}
    driven = {s.end.name for s in system.stimuli}
    if both := sorted(wired & driven):
        raise document.error(f"{both[0]} is connected and driven", "connect", both[0])
    given = wired | driven | {s.end.name for s in system.settings}
    left = set()
    for pattern in document.body.leave:
        matched = {e.name for e in resolver.matching(pattern, "input")}
        if not matched:
            raise document.error(f"leave: {pattern!r} matches no input", "", "leave")
        left |= matched
    for end in resolver.matching("*", "input"):
        if end.name not in given | left:
            raise document.error(
                f"input {end.name} is open: connect, drive or set it, or name it in leave",
                "connect",
            )
