"""The variables of a system's FMU, by the names that they have in its scenario."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from motionfmu.base.platforms import Platform
from motionfmu.fmu import terminals
from motionfmu.fmu.describe import STRICT, Description, Terminal, Variable, strict_step
from motionfmu.fmu.head import TICK_MAX
from motionfmu.fused.fmu_parts import NotFused
from motionfmu.scenarios import fmus
from motionfmu.scenarios.fmus import Port
from motionfmu.scenarios.system import End, System, Values
from motionfmu.scenarios.values import start_values

TYPES = {"Float64": "f64", "Int32": "i32", "Boolean": "bool", "String": "string"}
_STEPS_MAX = 2**31 - 1
_STEP_MAX = 1e6  # [s]


@dataclass(frozen=True)
class ProgramPlan:
    """What a program is made of: its system, what it records, its version of FMI, its values."""

    system: System
    recorded: Sequence[End]
    fmi: int
    name: str
    key: str
    given: Mapping[str, Values] | None  # start values of an exported system; None for a run here
    platforms: Sequence[Platform] = ()  # compiled for, from C text it carries; none: this machine


@dataclass(frozen=True)
class Roles:
    """Which variables of the components a system shows."""

    # Set before a run: all parameters but `strict_step`, and all inputs but those that only a wire
    # feeds.
    given: tuple[End, ...]
    # Read at every step: of these the tunable ones, and the inputs that no wire feeds.
    taken: tuple[End, ...]
    # Outputs: what is recorded, and the signal that ends the run.
    shown: tuple[End, ...]


def roles(system: System, recorded: Sequence[End]) -> Roles:
    """Sort the variables of a system."""
    wired = {w.target.name for w in system.wires}
    asked = {s.end.name for s in system.settings}
    given, taken = [], []
    for component, fmu in system.components.items():
        for port in fmus.ports(fmu).values():
            if port.name == STRICT:  # the system has its own
                continue
            end = End(component, port)
            free = port.causality == "input" and end.name not in wired
            if port.causality == "parameter" or free or end.name in asked:
                given.append(end)
            if free or port.tunable:
                taken.append(end)
    shown = {e.name: e for e in recorded}
    shown |= {e.name: e for e in system.ending}
    return Roles(tuple(given), tuple(taken), tuple(shown.values()))


def _limit(kind: str, value: float) -> float | int | None:
    if math.isinf(value):
        return None
    return int(value) if kind == "i32" else value


def _declared(end: End) -> tuple[str, str] | None:
    """The declared type of a component's variable; all variables that name files have one type."""
    declared = end.port.declared
    if declared is None or end.port.file:
        return declared
    return f"{end.component}.{declared[0]}", declared[1]


def _terminals(system: System, variables: Sequence[Variable]) -> Iterator[Terminal]:
    """The components' terminals, as far as the system shows their inputs and outputs."""
    there = {v.name for v in variables if v.causality in ("input", "output")}
    for component, fmu in system.components.items():
        yield from terminals.within(component, fmus.terminals_of(fmu), there)


def _variable(end: End, causality: str, values: Values | None) -> Variable:
    port: Port = end.port
    kind = TYPES[port.type]
    return Variable(
        end.name,
        causality,
        kind,
        port.doc,
        dims=port.shape,
        unit=port.unit,
        start=None if values is None else list(values),
        min=_limit(kind, port.low),
        max=_limit(kind, port.high),
        nominal=port.nominal,
        declared=_declared(end),
        tunable=port.tunable,
        continuous=port.continuous,
    )


def _own(system: System, step: float, tick_ns: int) -> Iterator[Variable]:
    """The variables of the system itself; `step` is the step of its components [s]."""
    text = "Step of the components"
    low = tick_ns * 1e-9
    yield Variable(
        "system.step", "parameter", "f64", text, unit="s", start=[step], min=low, max=_STEP_MAX
    )
    otherwise = "outputs are those of the latest step that is over"
    yield strict_step("system.step", otherwise, f"system.{STRICT}")
    text = "Folder in which a file a signal is written (NumPy); nothing is recorded without it"
    yield Variable("recorder.folder", "parameter", "string", text, start=[""])
    text = "Of so many communication steps one is recorded"
    yield Variable("recorder.every", "parameter", "i32", text, start=[1], min=1, max=_STEPS_MAX)
    text = "Steps behind the signal that ends the run, then the system stands still; -1: it goes on"
    yield Variable("until.settle", "parameter", "i32", text, start=[-1], min=-1, max=_STEPS_MAX)
    if system.until is not None:
        names = [s.name for s in system.until.signals]
        text = f"Communication step at which {' or '.join(names)} came; -1: not yet"
        yield Variable("until.step", "output", "i32", text)
        which = " or ".join(f"{k} {name}" for k, name in enumerate(names))
        yield Variable("until.which", "output", "i32", f"Which came: {which}")


# CCN 16: each field of one description, which a system with given values fills in another way.
def described(job: ProgramPlan, used: Roles, tick_ns: int) -> Description:
    """Describe a system as an FMU; its step must be a whole multiple of `tick_ns`."""
    system, given = job.system, job.given or {}
    if tick_ns > TICK_MAX or system.step_ns % tick_ns:
        raise NotFused(f"steps of {system.step_ns} ns are not of {tick_ns} ns, as the FMUs' are")
    wired = {w.target.name for w in system.wires}
    step, stop = tick_ns * 1e-9, 1.0
    if job.given is not None:
        step = system.step_ns * 1e-9
        stop = system.steps * step
    variables = list(_own(system, step, tick_ns))
    for end in used.given:
        kind = "input" if end.port.causality == "input" and end.name not in wired else "parameter"
        variables.append(_variable(end, kind, given.get(end.name, start_values(end.port))))
    variables += [_variable(end, "output", None) for end in used.shown]
    names = [v.name for v in variables]
    if len(set(names)) != len(names):
        raise NotFused(f"{next(n for n in names if names.count(n) > 1)} names two things")
    parts = ", ".join(f"{c} ({Path(fmu).name})" for c, fmu in system.components.items())
    return Description(
        name=job.name,
        description=f"{parts} as one program {job.key[:12]}",
        tick_ns=tick_ns,
        experiment={"stop": stop, "step": step},
        grid="system.step",
        variables=tuple(variables),
        terminals=() if job.given is None else tuple(_terminals(system, variables)),
    )
