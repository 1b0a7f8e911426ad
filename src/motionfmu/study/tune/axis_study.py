"""One axis with one plant: motion and margins as functions of the gains."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
from scipy.linalg import eig

from motionfmu.analysis.linear.axis import AxisModel
from motionfmu.analysis.linear.linear_form import Gain
from motionfmu.analysis.linear.loops import feedbacks
from motionfmu.analysis.linear.pointwise import Quick
from motionfmu.analysis.linear.residual import Residual, with_residuals
from motionfmu.analysis.linear.tuning_parts import listed, matrices
from motionfmu.analysis.linear.wiring import PeriodMap
from motionfmu.base.memo import Memo
from motionfmu.study.tune.curve import Loop
from motionfmu.study.tune.steps import Array, ArrayWithSlopes, DifferenceEquations, lifted, system

# Points between two samples at which a residual is evaluated, for friction changes its sign within
# a small part of that interval.
_FINE = 64
# If a residual changes by this share of its size between two samples, it is evaluated at these
# points.
_TURNS = 0.02
# Results that are kept of one point, because its axes and plants ask for them in turn.
_KEPT = 12


class _Matrices:
    """Matrices A, B, C, D and their derivatives, from expressions of the gains."""

    def __init__(self, found: PeriodMap, gains: ca.SX) -> None:
        parts = [_matrix(m) for m in (found.a, found.b, found.c, found.d)]
        self.shapes = [p.shape for p in parts]
        every = ca.vertcat(*(ca.vec(p) for p in parts))
        slopes = ca.jacobian(every, gains)
        self._function = Quick("m", [gains], [every, slopes])
        self.period = found.period_ns * 1e-9

    def at(self, gains: Array) -> tuple[ArrayWithSlopes, ...]:
        """The four matrices."""
        values, slopes = self._function(gains)
        found, place = [], 0
        for rows, columns in self.shapes:
            part = slice(place, place + rows * columns)
            value = values[part, 0].reshape(columns, rows).T
            change = slopes[part].T.reshape(-1, columns, rows).transpose(0, 2, 1)
            found.append(ArrayWithSlopes(value, change))
            place = part.stop
        return tuple(found)


def _matrix(m: Array) -> ca.SX:
    return (
        ca.SX(ca.vertcat(*(ca.horzcat(*row) for row in m.tolist()))) if m.size else ca.SX(*m.shape)
    )


@dataclass(frozen=True)
class Motion:
    """The motion of an axis on the scenario's path."""

    position: ArrayWithSlopes  # (count,) in the unit of the position output
    peaks: list[ArrayWithSlopes]  # largest magnitudes of each output with a limit


@dataclass(frozen=True)
class Signals:
    """Names of the signals that a tuning evaluates."""

    command: str  # input of the model that takes the pulses
    position: str  # output of which the cost is computed
    peaks: tuple[str, ...]  # outputs with a limit


class AxisStudy:
    """One axis with one plant, whose gains are variables.

    With `bent` its motion includes the nonlinear part of the plant's equation.
    """

    def __init__(
        self, axis: AxisModel, gains: Sequence[str], signals: Signals, bent: bool = True
    ) -> None:
        symbols = {name: ca.SX.sym(name) for name in gains}
        self.axis = axis
        values = {name: axis.value(name) for name in gains}
        self.opened = axis.changed({n: Gain(float(v), symbols[n], v) for n, v in values.items()})
        self._gains = ca.vertcat(*symbols.values())
        self.loops = feedbacks(axis)
        self._loops = {name: self._loop(name, cut) for name, cut in self.loops.items()}
        wide, self._rests = with_residuals(self.opened) if bent else (self.opened, ())
        inputs = [signals.command, *(n for r in self._rests for n in r.inputs)]
        shown = [signals.position, *signals.peaks]
        states = [n for r in self._rests for n in r.states]
        self._count = len(shown)
        still = dict.fromkeys(listed(axis, "feed_forward"), 0.0)
        alone = matrices(self.opened.changed(still), [signals.command], [signals.position])
        self._answer = _Matrices(alone, self._gains)
        self._motion = _Matrices(matrices(wide, inputs, [*shown, *states]), self._gains)
        self.period = self._motion.period
        self._made: Memo[Any] = Memo(_KEPT)

    def _loop(self, name: str, cut: tuple[str, ...]) -> _Matrices:
        component, _, port = name.partition(".")
        source = ".".join(self.axis.wires[component, port])
        return _Matrices(matrices(self.opened, [name], [source], [name, *cut]), self._gains)

    def loop(self, name: str, gains: Array) -> Loop:
        """The open loop at a key of `loops`."""
        a, b, c, d = self._loops[name].at(gains)
        matrices = a.value, b.value, -c.value, -d.value
        slopes = a.slopes, b.slopes, -c.slopes, -d.slopes
        return Loop(*matrices, *slopes, self._loops[name].period)

    def lag(self, gains: Array) -> float:
        """Following error over speed in slow motion [s]."""
        # It is 1/Kp plus the delays, less the effect of feed-forward.
        a, b, c, d = (m.value for m in self._motion.at(gains))
        once = np.linalg.solve(np.eye(len(a)) - a, b[:, :1])
        twice = np.linalg.solve(np.eye(len(a)) - a, once)
        return self.period * float(((c[:1] @ twice) / (c[:1] @ once + d[:1, :1]))[0, 0])

    def end(self, gains: Array) -> float:
        """Position at rest, in its unit, per unit of the command."""
        a, b, c, d = (m.value for m in self._answer.at(gains))
        return float((c @ np.linalg.solve(np.eye(len(a)) - a, b) + d)[0, 0])

    def slowest(self, gains: Array) -> tuple[float, Array]:
        """Slowest time constant [s] of the closed loop, and its slopes."""
        # The time constant of an unstable loop is infinite or negative.
        return self._made(("slowest", gains.tobytes()), lambda: self._slowest(gains))

    def _slowest(self, gains: Array) -> tuple[float, Array]:
        a = self._motion.at(gains)[0]
        poles, left, right = eig(a.value, left=True, right=True)
        k = int(np.argmax(np.abs(poles)))
        size = float(abs(poles[k]))
        if size >= 1.0:
            return np.inf, np.zeros(len(a.slopes))
        w, v = left[:, k].conj(), right[:, k]
        turned = np.conj(poles[k]) * (w @ (a.slopes @ v).T) / (w @ v) / size
        rate = np.log(size)
        return -self.period / rate, self.period / rate**2 * turned.real / size

    def step(self, gains: Array, periods: int, count: int, slopes: bool = True) -> ArrayWithSlopes:
        """The position (1, count) after a step of one pulse, as share of its end.

        Without friction, and without feed-forward, which no step can follow. Samples are so many
        periods apart.
        """
        a, b, c, d = (m if slopes else m.alone for m in self._answer.at(gains))
        whole, begin, end = lifted(a, b, periods)
        y = system(whole, begin + end, c, d).driven(np.ones((1, count))).outputs(slice(None))
        inverse = np.linalg.inv(np.eye(len(a.value)) - a.value)
        most = c @ ArrayWithSlopes(inverse, inverse @ a.slopes @ inverse) @ b + d
        share = y.value / most.value
        return ArrayWithSlopes(share, (y.slopes - share * most.slopes) / most.value)

    def motion(self, gains: Array, pulses: Array, periods: int, slopes: bool = True) -> Motion:
        """The motion along a sequence of pulse counts from 0 on, one every so many periods."""
        key = "motion", gains.tobytes(), periods, slopes
        ahead, whole = self._made(key, lambda: self._systems(gains, periods, slopes))
        u, du = pulses[None], None
        if self._rests:
            rest = self._rest(ahead.driven(u).outputs(slice(None)))
            u = np.concatenate([u, rest.value])
            du = np.concatenate([np.zeros((len(rest.slopes), 1, len(pulses))), rest.slopes], axis=1)
        driven = whole.driven(u, du)
        position = driven.outputs(slice(1))
        high = np.abs(driven.outputs(slice(1, None), False).value)
        return Motion(
            ArrayWithSlopes(position.value[0], position.slopes[:, 0]),
            [driven.at(row, int(np.argmax(y))) for row, y in enumerate(high, 1)],
        )

    def _systems(
        self, gains: Array, periods: int, slopes: bool
    ) -> tuple[DifferenceEquations, DifferenceEquations]:
        """Equations from pulses to the states of residuals, and from both to the outputs."""
        a, b, c, d = (m if slopes else m.alone for m in self._motion.at(gains))
        whole, begin, end = lifted(a, b, periods)
        first, rests = slice(1), slice(1, None)
        end, held = end.columns(first), (begin + end).columns(rests)
        # The states less what u[k] at the end of a period adds to them know of u[k] alone.
        ahead = whole @ end + begin.columns(first)
        direct = c @ end + d.columns(first)
        shown, seen = slice(self._count), slice(self._count, None)
        both = ahead.beside(held), direct.beside(d.columns(rests))
        return (
            system(whole, ahead, c[seen], direct[seen]),
            system(whole, both[0], c[shown], both[1][shown]),
        )

    def _rest(self, x: ArrayWithSlopes) -> ArrayWithSlopes:
        """Mean residuals between samples, computed from the states at the samples."""
        found, place = [], 0
        for rest in self._rests:
            n = len(rest.states)
            found.append(_mean(rest, x[place : place + n]))
            place += n
        return ArrayWithSlopes(
            np.concatenate([w.value for w in found]),
            np.concatenate([w.slopes for w in found], axis=1),
        )


def _mean(rest: Residual, x: ArrayWithSlopes) -> ArrayWithSlopes:
    """Mean of a residual between each sample and the next, with the states on a straight line."""
    called = rest.slopes if len(x.slopes) else rest.values
    at, dat = x.value, x.slopes
    w, *changes = called(at)
    after = np.roll(w, -1, axis=1)
    mean = 0.5 * (w + after)
    scale = np.abs(w).max(axis=1, keepdims=True)
    turning = np.flatnonzero((np.abs(after - w) > _TURNS * scale).any(axis=0))
    turning = turning[turning < at.shape[1] - 1]
    share = (np.arange(_FINE) + 0.5) / _FINE
    begin, end = at[:, turning], at[:, turning + 1]
    between = begin[:, :, None] + (end - begin)[:, :, None] * share
    fine, *finer = called(between.reshape(len(at), -1))
    mean[:, turning] = fine.reshape(len(w), len(turning), _FINE).mean(axis=2)
    change = np.zeros((len(dat), *w.shape))
    if not len(dat):
        return ArrayWithSlopes(mean, change)
    within = np.zeros((len(dat), len(w), len(turning)))
    sides = dat[:, :, turning], dat[:, :, turning + 1]
    for (row, column), slope, steep in zip(rest.places, changes[0], finer[0], strict=True):
        change[:, row] += slope * dat[:, column]
        steep = steep.reshape(len(turning), _FINE) / _FINE
        first, last = steep @ (1.0 - share), steep @ share
        within[:, row] += first * sides[0][:, column] + last * sides[1][:, column]
    change = 0.5 * (change + np.roll(change, -1, axis=2))
    change[:, :, turning] = within
    return ArrayWithSlopes(mean, change)
