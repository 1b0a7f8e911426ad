"""One axis with one plant: its motion and its margins as functions of the gains."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import casadi as ca
import numpy as np
from scipy.linalg import eig

from motionfmu.linear.axis import AxisModel
from motionfmu.linear.form import Gain
from motionfmu.linear.loops import feedbacks
from motionfmu.linear.opened import listed, matrices
from motionfmu.linear.pointwise import Quick
from motionfmu.linear.residual import Residual, with_residuals
from motionfmu.linear.wiring import PeriodMap
from motionfmu.tune.curve import Loop
from motionfmu.tune.steps import Array, Lifted, forgotten, lifted, scan

T = TypeVar("T")
# Between two samples the friction turns within a small part of the way: points that show it.
_FINE = 64
# A residual that changes by this share of its size between two samples is looked at finely.
_TURNS = 0.02


class _Matrices:
    """A, B, C, D and their derivatives, from expressions of the gains."""

    def __init__(self, found: PeriodMap, gains: ca.SX) -> None:
        parts = [_matrix(m) for m in (found.a, found.b, found.c, found.d)]
        self.shapes = [p.shape for p in parts]
        every = ca.vertcat(*(ca.vec(p) for p in parts))
        slopes = ca.jacobian(every, gains)
        self._function = Quick("m", [gains], [every, slopes])
        self.period = found.period_ns * 1e-9

    def at(self, gains: Array) -> tuple[list[Array], list[Array]]:
        """Matrices, and derivatives with the gain as the first axis."""
        values, slopes = self._function(gains)
        matrices, changes, place = [], [], 0
        for rows, columns in self.shapes:
            size = rows * columns
            part = slice(place, place + size)
            matrices.append(values[part, 0].reshape(columns, rows).T)
            changes.append(slopes[part].T.reshape(-1, columns, rows).transpose(0, 2, 1))
            place += size
        return matrices, changes


def _matrix(m: Array) -> ca.SX:
    return (
        ca.SX(ca.vertcat(*(ca.horzcat(*row) for row in m.tolist()))) if m.size else ca.SX(*m.shape)
    )


@dataclass(frozen=True)
class Motion:
    """What an axis does on the scenario's path."""

    outputs: Array  # (1 + p, count): position, then what has a peak limit, in the units declared
    slopes: Array | None  # (g, 1 + p, count): derivatives to the gains


@dataclass(frozen=True)
class Signals:
    """Names of what a study looks at."""

    command: str  # input of the model that takes the pulses
    position: str  # output that is judged
    peaks: tuple[str, ...]  # outputs with a limit


class AxisStudy:
    """One axis with one plant, its gains left open.

    `bent`: its motion has what the plant's equation has beyond the linear part.
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
        self._made: dict[str, tuple[bytes, Any]] = {}

    def _loop(self, name: str, cut: tuple[str, ...]) -> _Matrices:
        component, _, port = name.partition(".")
        source = ".".join(self.axis.wires[component, port])
        return _Matrices(matrices(self.opened, [name], [source], [name, *cut]), self._gains)

    def _once(self, what: str, gains: Array, make: Callable[[], T]) -> T:
        """What was made for the same gains just before: axes alike ask one after the other."""
        place = gains.tobytes()
        if self._made.get(what, (b"", None))[0] != place:
            self._made[what] = place, make()
        found: T = self._made[what][1]
        return found

    def loop(self, name: str, gains: Array) -> Loop:
        """The open loop at a key of `loops`."""
        (a, b, c, d), (da, db, dc, dd) = self._loops[name].at(gains)
        return Loop(a, b, -c, -d, da, db, -dc, -dd, self._loops[name].period)

    def lag(self, gains: Array) -> float:
        """Following error over speed in slow motion [s]."""
        # 1/Kp, the delays, less what is fed forward.
        (a, b, c, d), _ = self._motion.at(gains)
        once = np.linalg.solve(np.eye(len(a)) - a, b[:, :1])
        twice = np.linalg.solve(np.eye(len(a)) - a, once)
        return self.period * float(((c[:1] @ twice) / (c[:1] @ once + d[:1, :1]))[0, 0])

    def end(self, gains: Array) -> float:
        """Position, in its unit, for one of the command, at rest."""
        (a, b, c, d), _ = self._answer.at(gains)
        return float((c @ np.linalg.solve(np.eye(len(a)) - a, b) + d)[0, 0])

    def slowest(self, gains: Array) -> tuple[float, Array]:
        """Slowest time constant [s] of the closed loop, and its slopes."""
        # Infinite or negative for an unstable loop.
        return self._once("slowest", gains, lambda: self._slowest(gains))

    def _slowest(self, gains: Array) -> tuple[float, Array]:
        (a, *_), (da, *_) = self._motion.at(gains)
        poles, left, right = eig(a, left=True, right=True)
        k = int(np.argmax(np.abs(poles)))
        size = float(abs(poles[k]))
        if size >= 1.0:
            return np.inf, np.zeros(len(da))
        w, v = left[:, k].conj(), right[:, k]
        turned = np.conj(poles[k]) * (w @ (da @ v).T) / (w @ v) / size
        rate = np.log(size)
        return -self.period / rate, self.period / rate**2 * turned.real / size

    def step(self, gains: Array, periods: int, count: int, slopes: bool = True) -> Motion:
        """The position after a step of one pulse, as share of its end.

        Without friction, and without feed-forward, which no step can follow. Samples are so many
        periods apart.
        """
        (a, b, c, d), (da, db, dc, dd) = self._answer.at(gains)
        lift = lifted(a, b, da, db, periods)
        u = np.ones((1, count))
        x = lift.states(u)
        y = c @ x + d
        rest = np.linalg.solve(np.eye(len(a)) - a, b)
        end = c @ rest + d
        if not slopes:
            return Motion(y / end, None)
        dy = c @ lift.slopes(x, u) + dc @ x + dd
        drest = np.linalg.solve(np.eye(len(a)) - a, da @ rest + db)
        dend = c @ drest + dc @ rest + dd
        return Motion(y / end, dy / end - y * dend / end**2)

    def motion(self, gains: Array, pulses: Array, periods: int, slopes: bool = True) -> Motion:
        """Move along pulses put out so far, every so many periods."""
        (_, _, c, d), (_, _, dc, dd) = self._motion.at(gains)
        both, to = self._once(f"{periods} periods", gains, lambda: self._turned(gains, periods))
        c, dc = c @ to, dc @ to
        lift, side = both.inputs(slice(1)), both.inputs(slice(1, None))
        u = pulses[None, :].astype(float)
        x = lift.states(u)
        dx = lift.slopes(x, u) if slopes else None
        if self._rests:
            seen = c[self._count :] @ x
            dseen = None
            if dx is not None:
                dseen = c[self._count :] @ dx + dc[:, self._count :] @ x
            w, dw = self._rest(seen, dseen)
            extra = _held(side, w)
            if dx is not None:
                assert dw is not None
                dx = dx + _held_slopes(side, (extra, w, dw))
            x = x + extra
        shown, direct = c[: self._count], d[: self._count, :1]
        y = shown @ x + direct * u
        if dx is None:
            return Motion(y, None)
        dy = shown @ dx + dc[:, : self._count] @ x + dd[:, : self._count, :1] * u
        return Motion(y, dy)

    def _turned(self, gains: Array, periods: int) -> tuple[Lifted, Array]:
        """Several periods at once, in states of which some are forgotten; and those states."""
        (a, b, _, _), (da, db, _, _) = self._motion.at(gains)
        whole = lifted(a, b, da, db, periods)
        to, back = forgotten(whole.a)
        return whole.turned(to, back), to

    def _rest(self, x: Array, dx: Array | None) -> tuple[Array, Array | None]:
        """Mean residuals between samples, from the states there, and their derivatives."""
        values, changes, place = [], [], 0
        for rest in self._rests:
            n = len(rest.states)
            part = slice(place, place + n)
            w, dw = _mean(rest, x[part], None if dx is None else dx[:, part])
            values.append(w)
            changes.append(dw)
            place += n
        if dx is None:
            return np.vstack(values), None
        return np.vstack(values), np.concatenate(changes, axis=1)  # type: ignore[arg-type]


def _held(lift: Lifted, w: Array) -> Array:
    return scan(lift.a, (lift.begin + lift.end) @ w)


def _held_slopes(lift: Lifted, moved: tuple[Array, Array, Array]) -> Array:
    x, w, dw = moved
    v = lift.da @ x + (lift.dbegin + lift.dend) @ w + (lift.begin + lift.end) @ dw
    return scan(lift.a, v)


def _mean(rest: Residual, x: Array, dx: Array | None) -> tuple[Array, Array | None]:
    """Mean over the way from each sample to the next, taken as straight."""
    called = rest.values if dx is None else rest.slopes
    w, *changes = called(x)
    after = np.roll(w, -1, axis=1)
    mean = 0.5 * (w + after)
    scale = np.abs(w).max(axis=1, keepdims=True)
    turning = np.flatnonzero((np.abs(after - w) > _TURNS * scale).any(axis=0))
    turning = turning[turning < x.shape[1] - 1]
    share = (np.arange(_FINE) + 0.5) / _FINE
    begin, end = x[:, turning], x[:, turning + 1]
    between = begin[:, :, None] + (end - begin)[:, :, None] * share
    fine, *finer = called(between.reshape(len(x), -1))
    mean[:, turning] = fine.reshape(len(w), len(turning), _FINE).mean(axis=2)
    if dx is None:
        return mean, None
    at = np.zeros((len(dx), *w.shape))
    within = np.zeros((len(dx), len(w), len(turning)))
    sides = dx[:, :, turning], dx[:, :, turning + 1]
    for (row, column), slope, steep in zip(rest.places, changes[0], finer[0], strict=True):
        at[:, row] += slope * dx[:, column]
        steep = steep.reshape(len(turning), _FINE) / _FINE
        first, last = steep @ (1.0 - share), steep @ share
        within[:, row] += first * sides[0][:, column] + last * sides[1][:, column]
    dmean = 0.5 * (at + np.roll(at, -1, axis=2))
    dmean[:, :, turning] = within
    return mean, dmean
