"""Choices of a tuning for which the user gives nothing: gains, signals, bounds, speed."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from motionfmu.analysis.linear import law
from motionfmu.analysis.linear.axis import AxisModel
from motionfmu.analysis.linear.block import Plant, Sampled, nonzero, reaches
from motionfmu.analysis.linear.linear_form import Gain
from motionfmu.analysis.linear.tuning_parts import limit, linearised, listed, matrices
from motionfmu.base.errors import InputError
from motionfmu.base.units import parse
from motionfmu.run import Result, Scenario
from motionfmu.study.tune.axis_study import Signals
from motionfmu.study.tune.problem import Problem

# Without bounds a gain may become this many times as large or as small.
SPAN = 20.0
# An output that shows a command is so many periods late at most.
_LATE_MAX = 8
# A motion is judged for its speed in so many pieces; one of this share of the quickest stands.
_STRETCHES, _STANDS = 1000, 0.05


@dataclass(frozen=True)
class DecisionVariable:
    """A number that the tuning searches: a parameter of one axis, or of several alike."""

    name: str  # component.variable
    axes: tuple[int, ...]  # the axes that have it, from 1
    low: float
    high: float
    start: float  # present value
    whole: bool  # a register of whole numbers
    own: tuple[bool, bool] = (False, False)  # whether each bound is the parameter's own limit

    @property
    def title(self) -> str:
        """Name with its axes."""
        return f"{self.name}[{','.join(map(str, self.axes))}]"

    def value(self, z: float) -> float:
        """Value at a share, 0 to 1, of the range; logarithmic if both bounds are above 0."""
        if self.low > 0.0:
            return float(self.low * (self.high / self.low) ** z)
        return self.low + (self.high - self.low) * z

    def share(self, value: float) -> float:
        """Inverse of `value`."""
        if self.low > 0.0:
            return float(np.log(value / self.low) / np.log(self.high / self.low))
        return (value - self.low) / (self.high - self.low)

    def slope(self, value: float) -> float:
        """Derivative of the value to the share."""
        if self.low > 0.0:
            return float(value * np.log(self.high / self.low))
        return self.high - self.low


def _moves(axis: AxisModel, name: str) -> bool:
    """Whether the linear model depends on a parameter."""
    value = axis.value(name)
    if isinstance(value, bool | str):
        return False
    opened = axis.changed({name: Gain(float(value), ca.SX.sym("g"), value)})
    for block in opened.blocks.values():
        if isinstance(block, Sampled):
            elements: list[Any] = [e for m in block.laws for e in m.ravel().tolist()]
            symbolic = [e for e in elements if isinstance(e, ca.SX)]
            if any(not e.is_constant() for e in symbolic):
                return True
    return False


def gains(axis: AxisModel, problem: Problem) -> list[str]:
    """Gains that the tuning searches; one on which the model does not depend is refused."""
    if problem.gains is not None:
        for name in problem.gains:
            if not _moves(axis, name):
                raise InputError(f"gains: {name} changes nothing in the linear model")
        return list(dict.fromkeys(problem.gains))
    wanted = ["position"]
    wanted += ["velocity"] if problem.velocity else []
    wanted += ["feed_forward"] if problem.feed_forward else []
    found: list[str] = []
    for kind in wanted:
        names = [n for n in listed(axis, kind) if _moves(axis, n)]
        if not names:
            text = kind.replace("_", "-")
            raise InputError(f"{axis.scenario.document.file}: no {text} gain acts on the axes")
        found += names
    return found


def signals(axis: AxisModel, problem: Problem) -> tuple[Signals, dict[str, float]]:
    """The signals that are commanded, judged and limited, and the limits by output."""
    # The problem's limits are stronger than those of the FMUs.
    document = axis.scenario.document
    if problem.command is not None and problem.position is not None:
        command, position = _followed(axis, problem.command), problem.position
        if position not in axis.outputs:
            raise InputError(f"position = {position!r}: no output of the linear model")
    else:
        command, position = _of_contour(axis)
    peaks: dict[str, float] = {}
    for component, found in axis.blocks.items():
        own = law.carried(document.body.component[component])
        if isinstance(found, Sampled) and isinstance(own, law.Law):
            for name in own.limit:
                if f"{component}.{name}" in axis.outputs and _acts(axis, component, name):
                    peaks[f"{component}.{name}"] = limit(axis, f"{component}.{name}")
    for name, value in problem.limits.peak.items():
        if name not in axis.outputs:
            raise InputError(f"limits.peak.{name} = {value!r}: no output of the linear model")
        peaks[name] = value
    return Signals(command, position, tuple(peaks)), peaks


def _of_contour(axis: AxisModel) -> tuple[str, str]:
    document = axis.scenario.document
    contour = document.body.contour
    if contour is None:
        raise InputError(
            f"{document.file}: a tuning needs the signals of a [contour] table, or command and"
            " position in its tune.toml"
        )
    card, _, output = contour.pulses.partition(".")
    block = axis.blocks.get(card)
    if not isinstance(block, Sampled) or output not in block.direct:
        raise document.error(f"{contour.pulses} has no linear law", "contour", "pulses")
    row = nonzero(block.now)[block.direct.index(output)]
    if contour.position not in axis.outputs:
        raise document.error(f"{contour.position} has no linear model", "contour", "position")
    return f"{card}.{block.commands[int(np.argmax(row))]}", contour.position


def _followed(axis: AxisModel, name: str) -> str:
    """The command that an output shows, or that is driven itself."""
    component, _, output = name.partition(".")
    block = axis.blocks.get(component)
    if name in axis.scenario.document.body.driven and name in axis.inputs:
        return name
    if isinstance(block, Sampled) and output in block.ports:
        own = reaches(block)[block.ports.index(output)]
        first = len(block.inputs)
        found = np.flatnonzero(own[first:])
        if len(found) == 1 and not own[:first].any():
            return f"{component}.{block.commands[int(found[0])]}"
    raise InputError(
        f"command = {name!r}: it shows no command of the linear model, and drives no input of it"
    )


def shown(axis: AxisModel, problem: Problem, command: str) -> int:
    """Periods after which an output shows the command it must follow; 0 for a driven input."""
    assert problem.command is not None
    if problem.command == command:
        return 0
    system = matrices(axis, [command], [problem.command])
    for periods in range(_LATE_MAX):
        gain = system.d if not periods else system.c @ _power(system.a, periods - 1) @ system.b
        if abs(float(gain[0, 0]) - 1.0) < 1e-9:
            return periods
        if abs(float(gain[0, 0])) > 1e-9:
            break
    raise InputError(f"command = {problem.command!r}: it is not the command itself")


def _power(a: Any, count: int) -> Any:
    return np.linalg.matrix_power(a, count)


def _acts(axis: AxisModel, component: str, name: str) -> bool:
    """Whether an output moves when the axis is commanded."""
    block = axis.blocks[component]
    assert isinstance(block, Sampled)
    if name not in block.outputs:
        return name in block.ports
    return bool(block.pattern[len(block.states) + block.outputs.index(name)].any())


def operating_point(axis: AxisModel, base: Result) -> dict[str, float]:
    """Mean feed of a run, as a speed output of the plant."""
    # It is empty if the plant has no speed output, for a linear plant needs no operating point.
    contour = axis.scenario.document.body.contour
    assert contour is not None
    if not (speed := speed_output(axis, contour.position)):
        return {}
    found = base.contour()
    way = np.linalg.norm(np.diff(found.run.commanded[:, :3], axis=0), axis=1)
    moving = found.cutting[1:] & (way > 0.0)
    feed = float(way[moving].sum() / (moving.sum() * np.diff(found.run.time).mean()))  # [mm/s]
    unit = base.scenario.resolver.end(contour.position, "contour", "position").port.unit or "1"
    factor = parse("mm").factor / parse(unit).factor
    return {speed: feed * factor}


def mean_speed(axis: AxisModel, base: Result, position: str) -> dict[str, float]:
    """Mean speed of a run's own motion, as a speed output of the plant; empty if it has none."""
    if not (speed := speed_output(axis, position)):
        return {}
    place = np.asarray(base[position], dtype=np.float64).reshape(len(base.time), -1)
    place = place[:, axis.axis - 1 if place.shape[1] > 1 else 0]
    # longer than the rounding of an encoder, shorter than a ramp
    stride = max(1, len(place) // _STRETCHES)
    rates = np.abs(np.diff(place[::stride])) / (stride * (base.time[1] - base.time[0]))
    moving = rates > _STANDS * rates.max()
    per = base.scenario.resolver.end(position, "position", position).port.unit or "1"
    own = base.scenario.resolver.end(speed, "position", speed).port.unit or "1"
    return {speed: float(rates[moving].mean()) * parse(per).factor / parse(own).factor}


def speed_output(axis: AxisModel, position: str) -> str:
    """The plant's output that is the speed of another; empty if none."""
    component, _, name = position.partition(".")
    if not isinstance(axis.blocks[component], Plant):
        return ""
    ode = linearised(axis, component)[0].ode
    outputs = [d.name for d in ode.outputs]
    rate = ca.mtimes(ca.jacobian(ode.y[outputs.index(name)], ode.x), ode.xdot)
    function = ca.Function("r", [ode.x, ode.u, ode.p], [rate, ode.y])
    draw = np.random.default_rng(1)
    x, u = draw.normal(size=len(ode.states)), draw.normal(size=len(ode.inputs))
    wanted, shown = (np.asarray(v.full()).ravel() for v in function(x, u, np.array(ode.p0)))
    speeds = [k for k, y in enumerate(shown) if abs(y - wanted[0]) < 1e-9 * abs(wanted[0])]
    return f"{component}.{outputs[speeds[0]]}" if speeds else ""


def variables(
    axes: Mapping[int, AxisModel], names: list[str], problem: Problem
) -> list[DecisionVariable]:
    """The numbers that the tuning searches, with their bounds, which are checked."""
    scenario = next(iter(axes.values())).scenario
    for name in problem.bounds:
        if name not in names:
            raise InputError(f"bounds.{name}: it is not among the gains: {', '.join(names)}")
    found = []
    for name in names:
        shared = problem.axes == "equal" or not _port(scenario, name).shape
        groups = [tuple(axes)] if shared else [(k,) for k in axes]
        found += [_variable(axes, name, group, problem) for group in groups]
    return found


def _port(scenario: Scenario, name: str) -> Any:
    return scenario.resolver.end(name, "set", name).port


def _variable(
    axes: Mapping[int, AxisModel], name: str, group: tuple[int, ...], problem: Problem
) -> DecisionVariable:
    port = _port(axes[group[0]].scenario, name)
    start = float(axes[group[0]].value(name))
    whole = port.type == "Int32"
    if name in problem.bounds:
        low, high = problem.bounds[name]
        if low < port.low or high > port.high:
            text = f"[{low!r}, {high!r}]: outside {port.low:g} .. {port.high:g}"
            raise InputError(f"bounds.{name} = {text}")
    elif np.isfinite(port.high) and not whole and port.high <= 1.0:
        low, high = port.low, port.high
    elif start > 0.0:
        least = max(port.low, 1.0) if whole else port.low
        low, high = max(start / SPAN, least), min(start * SPAN, port.high)
    else:
        raise InputError(f"bounds: {name} = {start:g} at present, so give its bounds")
    own = low == port.low, high == port.high
    return DecisionVariable(
        name, group, float(low), float(high), min(max(start, low), high), whole, own
    )
