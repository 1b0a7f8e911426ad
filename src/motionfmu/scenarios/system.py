"""A scenario resolved against the FMUs it names: every wire and value checked."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from motionfmu.base import units
from motionfmu.base.errors import Faults, InputError, suggestion
from motionfmu.scenarios import fmus, former_names
from motionfmu.scenarios.body import LONGEST
from motionfmu.scenarios.document import Document
from motionfmu.scenarios.fmus import Port
from motionfmu.scenarios.patterns import is_pattern, matches

Values = tuple[float | int | bool | str, ...]
# A time in decimal seconds differs from a whole number of ns by rounding only.
NS_TOLERANCE = 1e-3
# Limits of a run: more than a day of machine time, hours of computing.
TIME_MAX = LONGEST  # [s]
STEPS_MAX = 100_000_000
# Period of the clock of card and recorder [ns]; no FMU of ours makes smaller steps.
CLOCK_NS = 25
# Types of FMI 3 whose values have a length of their own.
_NO_WIRE = ("Binary",)


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
    """Values that a variable gets before initialization, one for each element."""

    end: End
    values: Values


@dataclass(frozen=True)
class Stimulus:
    """An input that takes `values` when step number `step` begins."""

    end: End
    step: int
    values: Values
    measured: bool = False  # by a record


@dataclass(frozen=True)
class EndSignal:
    """An output that ends a run when it is not 0."""

    end: End
    element: int | None  # of an array, from 0

    @property
    def name(self) -> str:
        """The output, or the element of it."""
        return self.end.name + (f"[{self.element + 1}]" if self.element is not None else "")


@dataclass(frozen=True)
class Until:
    """What ends a run before its time: the signal that it waits for, or a fault."""

    done: EndSignal
    fault: EndSignal | None
    settle: int  # steps that follow the communication point at which one of them is not 0

    @property
    def signals(self) -> tuple[EndSignal, ...]:
        """Both; of two that come at once the later one in this order counts."""
        return (self.done,) if self.fault is None else (self.done, self.fault)


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
    until: Until | None = None  # ends the run before
    begin: int = 0  # steps that had been made when the saved state was in which it begins

    @property
    def ending(self) -> tuple[End, ...]:
        """Outputs that may end the run, arrays whole."""
        return () if self.until is None else tuple(s.end for s in self.until.signals)

    @property
    def sample_ns(self) -> int:
        """Time between two rows of the recording [ns]."""
        return self.step_ns * self.every

    def rows(self, steps: int) -> int:
        """Rows of the recording of a run that ends after so many steps, counted from time 0."""
        return -(-steps // self.every) - self.begin // self.every

    def share(self, steps: int) -> float:
        """Share of the run that is done after so many steps, counted from time 0."""
        return (steps - self.begin) / (self.steps - self.begin)

    @property
    def begin_time(self) -> float:
        """When the run begins [s]."""
        return self.begin * self.step_ns * 1e-9

    @property
    def elementwise(self) -> bool:
        """Whether a wire joins one element of an array, in FMI 2 only a variable of its own."""
        return any(e.port.whole for w in self.wires for e in (w.source, w.target))

    def version(self, component: str, fmi: int) -> int:
        """FMI version in which a component runs if our FMUs run in version `fmi`."""
        return fmus.version(self.components[component], fmi)

    def due(self) -> dict[int, list[Stimulus]]:
        """The stimuli by the number of the step before which they act, none of before the begin."""
        found: dict[int, list[Stimulus]] = {}
        for stimulus in (s for s in self.stimuli if s.step >= self.begin):
            found.setdefault(stimulus.step, []).append(stimulus)
        return found


def nanoseconds(key: str, seconds: float) -> int:
    """Whole nanoseconds of a time [s], positive, up to `TIME_MAX`; a ValueError names the key."""
    if seconds > TIME_MAX:
        raise ValueError(f"{key} = {seconds!r} s: {TIME_MAX:g} s are the most")
    if seconds <= 0:
        raise ValueError(f"{key} = {seconds!r} s: more than 0 wanted")
    ns = seconds * 1e9
    if not (math.isfinite(ns) and ns >= 1 and abs(ns - round(ns)) <= NS_TOLERANCE):
        raise ValueError(f"{key} = {seconds!r} s is not a whole number of ns")
    return round(ns)


class Resolver:
    """Looks names up in the FMUs a scenario uses."""

    def __init__(self, document: Document, faults: Faults | None = None) -> None:
        self.document = document
        self.known: dict[Any, Any] = {}  # what was found of the file for the last keys
        self.ports: dict[str, Mapping[str, Port]] = {}
        kept = Faults() if faults is None else faults
        for name, fmu in document.body.component.items():
            with kept.each():
                try:
                    self.ports[name] = fmus.ports(fmu)
                except InputError as error:
                    raise document.error(str(error), "component", name) from None
        # Components whose FMU cannot be used; a fault says so already.
        self.lost = set(document.tables.get("component", {})) - set(self.ports)
        if faults is None:
            kept.tell()

    def end(self, name: str, table: str, key: str) -> End:
        """Find ``component.variable``, written at table and key, or suggest the nearest."""
        component, _, variable = name.partition(".")
        if component in self.lost:
            raise InputError()
        if component not in self.ports:
            text = f"{name}: no component {component!r}{suggestion(component, self.ports)}"
            if is_pattern(name):
                text = f"{name}: no component that fits has this variable"
                if any(matches(c, component) and variable in p for c, p in self.ports.items()):
                    text = f"{name}: a pattern goes in [set], [check] and [expect] only"
            raise self.document.error(text, table, key, name)
        if variable not in self.ports[component]:
            fmu = self.document.body.component[component]
            whole = variable.partition("[")[0]
            hint = (
                f"; {whole!r} is {_extent(self.ports[component][whole])}"
                if whole in self.ports[component]
                else former_names.hint(fmu, whole) or suggestion(variable, self.ports[component])
            )
            text = f"{name}: {fmu} has no variable {variable!r}{hint}"
            raise self.document.error(text, table, key, name)
        return End(component, self.ports[component][variable])

    def split(self, name: str) -> tuple[str, int | None]:
        """Part ``component.variable[i]``, i from 1, into variable and element, from 0 or None.

        The names of foreign FMUs may end with brackets of their own.
        """
        component, _, variable = name.partition(".")
        whole, bracket, rest = name.rpartition("[")
        index = rest.removesuffix("]")
        single = variable in self.ports.get(component, {})
        if not single and bracket and rest.endswith("]") and index.isdecimal():
            return whole, int(index) - 1
        return name, None

    def wired(self, name: str, key: str) -> End:
        """Find what a line of [connect] names: a variable, or an element of one."""
        component, _, variable = name.partition(".")
        found = self.ports.get(component, {})
        whole, bracket, rest = variable.rpartition("[")
        if variable not in found and bracket and rest.endswith("]") and whole in found:
            one = found[whole].element(rest.removesuffix("]"))
            if one is None:
                text = f"{name}: {component}.{whole} is {_kind(found[whole])}"
                raise self.document.error(text, "connect", key)
            return End(component, one)
        return self.end(name, "connect", key)

    def matching(self, pattern: str, causality: str) -> list[End]:
        """All variables of one causality whose name matches a pattern with ``*`` and ``?``."""
        # A line names a component as a rule; to look at all of them for each line costs the
        # square of their number.
        named = pattern.partition(".")[0]
        only = () if is_pattern(pattern) else (named,)
        return [
            End(component, port)
            for component in only or self.ports
            for port in self.ports.get(component, {}).values()
            if port.causality == causality and matches(f"{component}.{port.name}", pattern)
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
    if a.port.type in _NO_WIRE:
        text = f"{b.name} is {a.port.type}, which no wire here carries"
        raise document.error(text, "connect", key)
    if not _same_quantity(document, a, b):
        raise document.error(
            f"{b.name} [{b.port.unit or '1'}] = {a.name} [{a.port.unit or '1'}]: units differ",
            "connect",
            key,
        )


def _same_quantity(document: Document, a: End, b: End) -> bool:
    """Whether two units fit; a foreign FMU may state no unit, or one that only it knows."""
    found = [e.port.unit for e in (a, b)]
    foreign = [fmus.is_foreign(document.body.component[e.component]) for e in (a, b)]
    if any(said and unit is None for said, unit in zip(foreign, found, strict=True)):
        return True
    try:
        return units.convertible(*found)
    except ValueError:
        return found[0] == found[1]


def _extent(port: Port) -> str:
    size = " x ".join(map(str, port.shape))
    return f"an array of {size}" if size else "a single value"


def _kind(port: Port) -> str:
    return port.type + "".join(f"[{n}]" for n in port.shape)


def wires(resolver: Resolver) -> list[Wire]:
    """All wires of the scenario, wildcards expanded; types, shapes, units, directions checked."""
    document, faults = resolver.document, Faults()
    found: dict[str, Wire] = {}
    parts: set[str] = set()  # arrays of which an element is a target
    for left, right in document.body.connect.items():
        with faults.each():
            for wire in _joined(resolver, left, right):
                _check_wire(document, wire, left)
                target = wire.target
                whole = f"{target.component}.{target.port.whole}"
                if target.name in found or whole in found or target.name in parts:
                    raise document.error(f"{target.name} has two sources", "connect", left)
                found[target.name] = wire
                parts.add(whole)
    faults.tell()
    return list(found.values())


def _joined(resolver: Resolver, left: str, right: str) -> list[Wire]:
    """The wires of one line of [connect]."""
    document = resolver.document
    if left.endswith("*") != right.endswith("*"):
        raise document.error(f"{left} = {right}: a group needs * on both sides", "connect", left)
    if not left.endswith("*"):
        faults = Faults()
        source = faults.of(lambda: resolver.wired(right, left))
        target = faults.of(lambda: resolver.wired(left, left))
        if source is None or target is None:
            raise InputError(*faults.lines)
        return [Wire(source, target)]
    targets = resolver.matching(left, "input")
    sources = {e.name: e for e in resolver.matching(right, "output")}
    pairs = [
        Wire(sources[name], target)
        for target in targets
        if (name := right[:-1] + target.name[len(left) - 1 :]) in sources
    ]
    if not pairs:
        if resolver.lost & {left.partition(".")[0], right.partition(".")[0]}:
            raise InputError()
        raise document.error(f"{left} = {right} joins nothing", "connect", left)
    return pairs


# Open inputs named in a message.
NAMED_MAX = 8


def _whole(resolver: Resolver, system: System) -> set[str]:
    """Names of the arrays of which every element has a wire."""
    counts: dict[tuple[str, str], int] = {}
    for target in (w.target for w in system.wires if w.target.port.whole):
        key = target.component, target.port.whole
        counts[key] = counts.get(key, 0) + 1
    full = [k for k, n in counts.items() if n == resolver.ports[k[0]][k[1]].count]
    return {f"{component}.{whole}" for component, whole in full}


def check_inputs(resolver: Resolver, system: System) -> None:
    """Refuse inputs that have no source or two sources; the message names them."""
    document, faults = resolver.document, Faults()
    wired = {w.target.name for w in system.wires} | _whole(resolver, system)
    driven = {s.end.name for s in system.stimuli}
    for name in sorted(wired & driven):
        with faults.each():
            raise document.error(f"{name} is connected and driven", "connect", name)
    given = wired | driven | {s.end.name for s in system.settings}
    left = set()
    for pattern in document.body.leave:
        matched = {e.name for e in resolver.matching(pattern, "input")}
        with faults.each():
            if not matched:
                hint = suggestion(pattern, (e.name for e in resolver.matching("*", "input")))
                text = f"leave: {pattern!r} matches no input{hint}"
                raise document.error(text, "", "leave", pattern)
        left |= matched
    names = [e.name for e in resolver.matching("*", "input") if e.name not in given | left]
    if names:
        some = ", ".join(names[:NAMED_MAX])
        some += f" and {len(names) - NAMED_MAX} more" if len(names) > NAMED_MAX else ""
        text = f"input {some} is open: connect, drive or set it, or name it in leave"
        if len(names) > 1:
            text = f"inputs {some} are open: connect, drive or set them, or name them in leave"
        with faults.each():
            raise document.error(text, "connect")
    faults.tell()


def until(resolver: Resolver, step_ns: int) -> Until | None:
    """The signals that end a run; None if a time does."""
    body, document = resolver.document.body, resolver.document
    if not isinstance(body.stop, str):
        return None
    done = _end_signal(resolver, "stop", body.stop)
    fault = None if body.fault is None else _end_signal(resolver, "fault", body.fault)
    settle = body.settle or 0.0
    steps = round(settle * 1e9 / step_ns)
    if abs(settle * 1e9 - steps * step_ns) > NS_TOLERANCE * max(1.0, settle):
        raise document.error(f"settle = {settle!r} s is no whole number of steps", "", "settle")
    return Until(done, fault, steps)


def _end_signal(resolver: Resolver, key: str, given: str) -> EndSignal:
    """The output that a key of the scenario names."""
    document, name = resolver.document, given
    if "." not in name:
        name = _only(resolver, key, name)
    whole, element = resolver.split(name)
    end = resolver.end(whole, "", key)
    text, kind = f"{key} = {given!r}", end.port.type
    if end.port.causality != "output":
        raise document.error(f"{text}: {end.name} is no output", "", key)
    if kind not in ("Boolean", "Int32"):
        wanted = "a Boolean or a whole number wanted"
        raise document.error(f"{text}: {end.name} is {kind}; {wanted}", "", key)
    if end.port.shape and element is None:
        raise document.error(f"{text}: which element, {end.name}[1]?", "", key)
    if element is not None and not 0 <= element < end.port.count * bool(end.port.shape):
        raise document.error(f"{text}: {end.name} has no element {element + 1}", "", key)
    return EndSignal(end, element)


def _only(resolver: Resolver, key: str, name: str) -> str:
    """The one output of this name that a component has."""
    whole, bracket, rest = name.partition("[")
    ends = resolver.matching("*", "output")
    having = [e.component for e in ends if e.port.name == whole]
    if len(having) == 1:
        return f"{having[0]}.{whole}{bracket}{rest}"
    if having:
        told = f"{' and '.join(having)} have such an output: which, {having[0]}.{name}?"
    elif resolver.lost:
        raise InputError()
    else:
        told = f"no component has such an output{suggestion(whole, {e.port.name for e in ends})}"
    raise resolver.document.error(f"{key} = {name!r}: {told}", "", key)
