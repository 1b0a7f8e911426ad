"""The answer of a loop to a step of its command, of the running FMUs and of their linear model."""

import math
from dataclasses import dataclass

import control
import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.freq.bench import Bench, Setup
from motionfmu.analysis.freq.limit import usual_kick
from motionfmu.analysis.freq.response import fastest, gentle, ramp, room
from motionfmu.analysis.freq.shape import limits
from motionfmu.analysis.linear import AxisModel
from motionfmu.analysis.linear.axis_values import element
from motionfmu.analysis.linear.block import Plant
from motionfmu.analysis.linear.stability import response

Array = NDArray[np.float64]
# Shares of a limit, and of the speed at the operating point, that a step may use.
_ROOM, _SPEED = 0.5, 0.5
# Before the step comes the axis gets to speed, and settles, for so many lengths of the answer; a
# ramp takes less than two thirds of that.
_LEAD = 3.0
_WHOLE = 200.0  # units of an input of whole numbers, which rounds what is added
# A run of more communication steps would take longer than anybody waits.
LONGEST = 60_000
# An input is a command of the position if this slow [rad/s] its effect on it is no more than so
# much larger than at twice the frequency: it does not integrate, and is not nothing.
_SLOW, _FLAT = 1e-3, 1.5


@dataclass(frozen=True)
class LoopStep:
    """A step for a loop: where it is added, and what it is to become.

    A position loop gets a step of its command. Where the command arises inside an FMU, the step is
    added to what the loop is fed back, the other way round, which is the same. A velocity loop gets
    a step of the speed of that input.
    """

    axis: AxisModel
    at: str  # input at which the loop is opened
    cut: tuple[str, ...]
    command: str  # input to which the step is added
    gain: float  # what the fed-back output becomes for 1 added
    inner: bool  # a step of speed

    @property
    def source(self) -> str:
        """The plant's output that is fed back."""
        component, _, variable = self.at.partition(".")
        return ".".join(self.axis.wires[component, variable])

    @property
    def period(self) -> float:
        """Of the loop [s]."""
        return float(self.axis.loop(self.at, self.cut).dt)

    def by_model(self, length: float) -> tuple[Array, Array]:
        """Times since the step [s], and the answer of the linear model as a share of it."""
        samples = max(2, math.ceil(length / self.period))
        answer = _answer(self.axis.system(self.command, self.source, self.cut), samples)
        return np.asarray(np.arange(samples) * self.period), np.asarray(answer / self.gain)

    def by_fmus(self, length: float, bandwidth: float) -> tuple[Array, Array]:
        """The same of the running FMUs, along the operating point.

        The step is so small that no limit acts and nothing turns back. That of a velocity loop is
        the usual step of its input in the time of its `bandwidth` [rad/s].
        """
        bench = Bench(Setup(self.axis, (self.command,), (self.source,), self.cut))
        step = bench.step_ns * 1e-9
        grid = round(self.period / step)
        after = math.ceil(length / self.period) * grid
        lead = math.ceil(_LEAD * length / self.period) * grid
        size = self._size(after // grid, bandwidth)
        rate = ramp(bench, self.at) / -self.gain
        way = gentle(rate * step, lead, lead + after)
        added = way[:, None].copy()
        added[lead:, 0] += size * self._shape(size, step, after)
        shown, _ = bench.run(added)
        moved = shown[:, 0] - self.gain * way
        answer = (moved[lead:] - moved[lead - 1]) / (self.gain * size)
        if self.inner:  # the speed, as the difference over a sample of the loop
            before = np.concatenate([np.zeros(grid), answer[:-grid]])
            answer = (answer - before) / (grid * step)
        return np.asarray(np.arange(after) * step), np.asarray(answer)

    def _shape(self, size: float, step: float, after: int) -> Array:
        """A step of 1 at each communication step; a ramp of 1 a second for a step of speed.

        An input that follows no faster than some speed gets a ramp of that speed.
        """
        number = np.arange(1, after + 1)
        if self.inner:
            return np.asarray(number * step)
        most = fastest(self.axis, self.command)
        if not most < math.inf:
            return np.ones(after)
        free = max(room(self.axis, self.command), 0.1 * most)
        return np.asarray(np.minimum(number / math.ceil(size / (free * step)), 1.0))

    def _size(self, samples: int, bandwidth: float) -> float:
        """A step, in the unit of the input, that reaches no limit and turns nothing back."""
        kick = abs(usual_kick(self.axis, self.at, self.cut) / self.gain)
        component, _, name = self.command.partition(".")
        ports = self.axis.scenario.resolver.ports[component]
        if element(ports, name, self.axis.axis)[0].type == "Int32":
            kick = max(kick, _WHOLE)
        size = kick * bandwidth if self.inner else kick
        loop = self.at, self.cut
        caps = [(name, _ROOM * most, False) for name, most in limits(self.axis, loop).items()]
        plant, _, variable = self.source.partition(".")
        rate = self.axis.points[plant].rates.get(variable, 0.0)
        if rate != 0.0:
            caps.append((self.source, _SPEED * abs(rate), True))
        for name, cap, is_rate in caps:
            answer = _answer(self.axis.system(self.command, name, self.cut), samples)
            if self.inner:
                answer = np.cumsum(answer) * self.period
            if is_rate:
                answer = np.diff(answer, prepend=0.0) / self.period
            if (top := float(np.abs(answer).max())) > 0.0:
                size = min(size, cap / top)
        return size


def step_of(axis: AxisModel, at: str, cut: tuple[str, ...], inner: bool) -> LoopStep:
    """The step of a loop; an inner loop is one whose outer loops are cut."""
    fed = LoopStep(axis, at, cut, at, -1.0, inner)
    component = at.partition(".")[0]
    if inner:
        return fed
    block = axis.blocks[component]
    for name in block.inputs:
        source = axis.wires.get((component, name))
        if source is not None and isinstance(axis.blocks[source[0]], Plant):
            continue
        command = f"{component}.{name}"
        system = axis.system(command, fed.source, cut)
        if not system.nstates and not system.D.any():
            continue
        slow, twice = response(system, np.array([_SLOW, 2.0 * _SLOW]))
        if 0.0 < abs(slow) < _FLAT * abs(twice):
            return LoopStep(axis, at, cut, command, float(slow.real), inner)
    return fed


def _answer(system: control.StateSpace, samples: int) -> Array:
    """What a step of 1 makes of an output."""
    x, values = np.zeros(system.nstates), np.empty(samples)
    for n in range(samples):
        values[n] = system.C[0] @ x + system.D[0, 0]
        x = system.A @ x + system.B[:, 0]
    return values
