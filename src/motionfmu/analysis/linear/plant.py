"""A plant's equation, linearised about an operating point and discretised by its micro step."""

import itertools
import math
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, field

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.linear.block import Matrix, Plant
from motionfmu.analysis.linear.pointwise import Quick
from motionfmu.base.memo import Memo
from motionfmu.fmu.modelica.ode import Ode
from motionfmu.scenarios.system import nanoseconds

# As src/plant/plant_model.c chooses its sub-steps: (h/n) |lambda| <= 2.
H_LAMBDA = 2.0
# A uniform motion is found when the residual of the balance, relative to its terms, is below this.
_UNIFORM = 1e-9
_EXACT = 1e-15
# Size of a position on which nothing depends [m, rad], small so that it stays off end stops.
_FAR = 1e-3
# Share of a position that rounding may have lost after a second.
_LASTING = 1e-6
# Times at which a motion is tested [s]; one that ends before the first is no uniform motion.
_LOOKS = [float(t) for t in np.geomspace(1e-3, 1.0, 61)]
_SHORTEST_MOTION = _LOOKS[0]
# Relative distance of the two points about a point at which its matrices are taken.
_HAIR = 1e-13
# Most of Newton's steps, and the shortest share of one; fewer steps if many starts are tried.
_PATIENCE, _GLANCE = (60, 1e-6), (15, 1e-2)
# Newton's method has failed if so many successive steps were cut to less than this share.
_CREEPING, _SHORT = 5, 1e-3
# Distances at which a gap may be closed, and the factor by which it is stiffer then.
_GAPS, _CLOSED = (1e-6, 1e-5, 1e-4, 1e-3, 1e-2), 1e3
# Steps of an input that is followed: the first, the least, the one at which Newton takes over, and
# the farthest input looked at, in its unit and as a share.
_FIRST_INPUT, _LEAST_INPUT, _NEAR_INPUT, _LAST_INPUT = 1e-3, 1e-7, 1e-4, 1e4

# Number of operating points that are kept.
_POINTS_MAX = 100


def _norm(v: Matrix) -> float:
    return float(np.linalg.norm(v))


@dataclass(frozen=True)
class Point:
    """Where a plant is linearised: a uniform motion."""

    x: Matrix  # states
    u: Matrix  # inputs
    values: dict[str, float]  # both by name, and the outputs, in the units of the class
    stated: dict[str, float]  # the values that the user stated
    rates: dict[str, float]  # of the outputs, per second: nonzero where the motion goes on
    held: dict[str, float] = field(default_factory=dict)  # values that are kept, though not stated
    # How long the motion goes on so [s]: to an end stop, or where a gap closes. Infinite from a
    # second on.
    lasts: float = math.inf


_Function = Callable[[Matrix], Matrix]


def _newton(
    rest: _Function,
    slope: _Function,
    start: Matrix,
    sizes: Matrix,
    patience: tuple[int, float] = _PATIENCE,
) -> Matrix:
    """Solve equations by Newton's shortest steps, relative to `sizes`; unknowns of size 0 stay."""
    z, found, slow = start, rest(start), 0
    steps, shortest = patience
    for _ in range(steps):
        way = -sizes * (np.linalg.pinv(slope(z) * sizes, rcond=1e-13) @ found)
        length, there = 1.0, rest(z + way)
        while length > shortest and not _norm(there) < _norm(found):
            length /= 2.0
            there = rest(z + length * way)
        slow = slow + 1 if length < _SHORT else 0
        if length <= shortest or slow > _CREEPING:
            break
        z, found = z + length * way, there
        if _norm(found) < _EXACT:
            break
    return z


def _beside(x: Matrix, which: NDArray[np.intp]) -> Iterator[Matrix]:
    """Starts in which some states are moved a little and more, both ways, to close gaps."""
    for size in (1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1.0):
        for k in which:
            for sign in (1.0, -1.0):
                moved = x.copy()
                moved[k] += sign * size
                yield moved


def _bracketed(
    equations: tuple[_Function, _Function, int], start: Matrix, sizes: Matrix, input_: int
) -> Matrix:
    """The input between two, one after the other, whose motions are too slow and too fast.

    If a valve is shut, the input moves nothing and Newton's method has no direction. So motions are
    found for one input after the other, from its start both ways, each begun at the one before.
    """
    rest, slope, aimed = equations
    rows = np.delete(np.arange(len(rest(start))), aimed)
    others = sizes.copy()
    others[input_] = 0.0

    def motion(value: float, near: Matrix) -> Matrix | None:
        z = near.copy()
        z[input_] = value
        z = _newton(lambda z: rest(z)[rows], lambda z: slope(z)[rows], z, others)
        return z if _norm(rest(z)[rows]) < _UNIFORM else None

    for sign in (1.0, -1.0):
        low, step = motion(start[input_], start), _FIRST_INPUT
        while low is not None and step > _LEAST_INPUT * (1.0 + abs(low[input_])):
            high = motion(low[input_] + sign * step, low)
            if high is None or rest(low)[aimed] * rest(high)[aimed] <= 0.0:
                if high is not None and step <= _NEAR_INPUT * (1.0 + abs(low[input_])):
                    return high
                step *= 0.5
            elif abs(high[input_]) > _LAST_INPUT:
                break
            else:
                low, step = high, 1.5 * step
    return start


class Linearised:
    """The functions of a plant's equation and of its derivatives."""

    def __init__(self, ode: Ode) -> None:
        self.ode = ode
        a, b, c, d = (ca.jacobian(e, v) for e in (ode.xdot, ode.y) for v in (ode.x, ode.u))
        arguments = [ode.x, ode.u, ode.p]
        # In a uniform motion all rates are constant: d(xdot)/dt = A xdot = 0.
        change = ca.mtimes(a, ode.xdot)
        self._matrices = Quick("abcd", arguments, [a, b, c, d])
        self._values = Quick("values", arguments, [ode.xdot, ode.y, change])
        z = ca.vertcat(ode.x, ode.u)
        slopes = [ca.jacobian(change, z), ca.jacobian(ode.y, z)]
        self._slopes = Quick("slopes", arguments, slopes)
        self._start = Quick("start", [ode.p], [ode.start])
        self._points: Memo[Point] = Memo(_POINTS_MAX)  # axes are often alike

    def parameters(self, values: Mapping[str, float]) -> Matrix:
        """Parameter vector of values by name."""
        return np.array([float(values[d.name]) for d in self.ode.parameters])

    def matrices(self, x: Matrix, u: Matrix, p: Matrix) -> tuple[Matrix, Matrix, Matrix, Matrix]:
        """Matrices A, B, C, D at a point.

        They are means of two points very near on either side: where branches meet smoothly, as at a
        gap of width 0 without force, CasADi gives no derivative at the point itself.
        """
        sides = []
        for hair in (_HAIR, -_HAIR):
            # the shifts are unequal, so that no difference of two states stays 0
            away = [v + hair * np.arange(1, v.size + 1) * (1.0 + np.abs(v)) for v in (x, u)]
            sides.append(self._matrices(*away, p))
        a, b, c, d = (0.5 * (one + other) for one, other in zip(*sides, strict=True))
        return a, b, c, d

    def start(self, p: Matrix) -> Matrix:
        """State at the start."""
        return self._start(p)[0].ravel()

    def point(
        self, p: Matrix, stated: Mapping[str, float], left: Mapping[str, float] | None = None
    ) -> Point:
        """Find the uniform motion that has the stated values.

        Nothing stated: the state and inputs at the start. Else the balance of forces is kept by
        the first input of the class with which that can be done; all others that are not stated
        have their start values, or those of `left`. A ValueError if there is no such motion.
        """
        asked = p.tobytes(), *(tuple(sorted(d.items())) for d in (stated, left or {}))
        return self._points(asked, lambda: self._point(p, stated, left))

    # CCN 16: most of it sorts names into inputs and outputs, by comprehensions.
    def _point(
        self, p: Matrix, stated: Mapping[str, float], left: Mapping[str, float] | None
    ) -> Point:
        ode = self.ode
        inputs, outputs = [d.name for d in ode.inputs], [d.name for d in ode.outputs]
        for name in stated:
            if name not in (*inputs, *outputs):
                raise ValueError(f"{name} is neither an input nor an output of {ode.name}")
        x, u = self.start(p), np.array(ode.u0)
        left = {n: v for n, v in (left or {}).items() if n not in stated} if stated else {}
        for name, value in {**left, **stated}.items():
            if name in inputs:
                u[inputs.index(name)] = value
        wanted = {outputs.index(n): v for n, v in stated.items() if n in outputs}
        lasts = math.inf
        if wanted:
            x, u, lasts = self._settle((x, u, p), wanted, {**left, **stated})
        y = self._values(x, u, p)[1].ravel()
        values = dict(zip((d.name for d in ode.states), x.tolist(), strict=True))
        values |= dict(zip(inputs, u.tolist(), strict=True))
        values |= dict(zip(outputs, y.tolist(), strict=True))
        moving, shows = self._moving(x, u, p), self.matrices(x, u, p)[2]
        rates = shows @ moving if stated else np.zeros(len(outputs))
        # A rate that is only rounding is 0: that of a force between two masses that move alike.
        rates[np.abs(rates) <= _LASTING * (np.abs(shows) @ np.abs(moving))] = 0.0
        told = dict(zip(outputs, rates.tolist(), strict=True))
        return Point(x, u, values, dict(stated), told, left, lasts)

    def _moving(self, x: Matrix, u: Matrix, p: Matrix) -> Matrix:
        """Rates of the states, where those that are only rounding of a sum of forces are 0."""
        xdot = self._values(x, u, p)[0].ravel()
        a, b, _, _ = self.matrices(x, u, p)
        balance = np.abs(a) @ np.abs(x) + np.abs(b) @ np.abs(u)
        xdot[np.abs(xdot) <= _LASTING * balance] = 0.0
        return xdot

    def _settle(
        self,
        begin: tuple[Matrix, Matrix, Matrix],
        wanted: dict[int, float],
        stated: Mapping[str, float],
    ) -> tuple[Matrix, Matrix, float]:
        """The motion that lasts longest, by the first input with which there is one."""
        inputs = [d.name for d in self.ode.inputs]
        free = [k for k, name in enumerate(inputs) if name not in stated]
        for movable in [[k] for k in free] or [[]]:
            x, u, lasts = self._lasting(begin, wanted, movable)
            if lasts >= _SHORTEST_MOTION:
                return x, u, lasts
        names = [f"{self.ode.outputs[k].name} = {v:g}" for k, v in wanted.items()]
        kept = [f"{name} = {stated[name]:g}" for name in inputs if name in stated]
        told = f", while {', '.join(kept)}" if kept else ""
        raise ValueError(f"{self.ode.name} has no uniform motion with {', '.join(names)}{told}")

    def _lasting(
        self, begin: tuple[Matrix, Matrix, Matrix], wanted: dict[int, float], free: list[int]
    ) -> tuple[Matrix, Matrix, float]:
        """States and inputs of the motion that lasts longest, and how long; 0 if there is none."""
        x0, u0, p = begin
        places, targets = list(wanted), np.array(list(wanted.values()))
        n = len(x0)
        sizes = np.concatenate([np.maximum(np.abs(x0), 1.0), np.zeros(len(u0))])
        slopes = np.abs(self.matrices(x0, u0, p)[0]) * sizes[:n]
        nothing = slopes <= _UNIFORM * slopes.max(axis=1, initial=0.0)[:, None]
        sizes[:n][nothing.all(axis=0)] = _FAR
        sizes[[n + k for k in free]] = 1.0
        rates = 1.0 + np.abs(self.matrices(x0, u0, p)[0]).sum(axis=1)
        weights = 1.0 / np.concatenate([rates, np.maximum(np.abs(targets), 1.0)])

        def rest(z: Matrix) -> Matrix:
            _, y, change = (v.ravel() for v in self._values(z[:n], z[n:], p))
            return weights * np.concatenate([change, y[places] - targets])

        def slope(z: Matrix) -> Matrix:
            of_change, of_y = self._slopes(z[:n], z[n:], p)
            found: Matrix = weights[:, None] * np.vstack([of_change, of_y[places]])
            return found

        best = x0, u0, 0.0

        def looked_at(z: Matrix) -> float:
            nonlocal best
            if not _norm(rest(z)) < _UNIFORM:
                return 0.0
            z = self._back(z, x0, rest)
            lasts = self._lasts(z[:n], z[n:], p, weights[:n])
            if lasts > best[2]:
                best = z[:n], z[n:], lasts
            return lasts

        def tried(guess: Matrix, patience: tuple[int, float] = _PATIENCE) -> bool:
            found = _newton(rest, slope, np.concatenate([guess, u0]), sizes, patience)
            return looked_at(found) == math.inf

        c = self.matrices(x0, u0, p)[2]
        speeds = x0 + np.linalg.pinv(c[places]) @ targets
        if tried(x0) or tried(speeds):
            return best
        across = self._across((x0, u0, p), speeds)
        for k, begun in itertools.product(range(len(places)), (speeds, x0, *across)):
            if free and best[2] == 0.0:
                near = np.concatenate([begun, u0])
                z = _bracketed((rest, slope, n + k), near, sizes, n + free[0])
                looked_at(_newton(rest, slope, z, sizes))
        # what moves, if something was found that ends: a gap is closed by it; else all
        which = np.flatnonzero(self._moving(best[0], best[1], p)) if best[2] > 0.0 else np.arange(n)
        if best[2] < math.inf:
            any(tried(guess, _GLANCE) for guess in _beside(speeds, which))
        return best

    def _across(self, begin: tuple[Matrix, Matrix, Matrix], x: Matrix) -> Iterator[Matrix]:
        """States moved just beyond a gap on either side, where the force is different."""
        x0, u0, p = begin
        before = np.abs(self.matrices(x0, u0, p)[0]).max(axis=1)
        for k, sign in itertools.product(range(len(x0)), (1.0, -1.0)):
            for size in _GAPS:
                moved = x0.copy()
                moved[k] += sign * size
                after = np.abs(self.matrices(moved, u0, p)[0]).max(axis=1)
                if (np.maximum(before, after) > _CLOSED * np.minimum(before, after)).any():
                    moved = x.copy()
                    moved[k] += sign * size
                    yield moved
                    break

    def _back(self, z: Matrix, begin: Matrix, rest: _Function) -> Matrix:
        """Put back positions on which the motion does not depend."""
        for k in range(len(self.ode.states)):
            moved = z.copy()
            moved[k] = begin[k]
            if _norm(rest(moved)) < _UNIFORM:
                z = moved
        return z

    def _lasts(self, x: Matrix, u: Matrix, p: Matrix, weights: Matrix) -> float:
        """Duration of the uniform motion [s]; in a gap it ends where the sides meet."""
        xdot = self._values(x, u, p)[0].ravel()

        def goes_on(seconds: float) -> bool:
            change = self._values(x + seconds * xdot, u, p)[2].ravel()
            return _norm(weights * change) < _LASTING

        good = 0.0
        for seconds in _LOOKS:
            if not goes_on(seconds):
                return good
            good = seconds
        return math.inf

    def rest(
        self,
        p: Matrix,
        ends: tuple[Collection[str], Collection[str]],
        stated: Mapping[str, float],
        left: Mapping[str, float],
    ) -> Point:
        """The state of rest in which the plant is held at its start position.

        `ends` are outputs that keep their start values, and the inputs by which they are held: the
        measured and the acting variables of loops with integrals. Other inputs have the values of
        `stated` or `left`. A ValueError if nothing holds the plant.
        """
        ode = self.ode
        inputs, outputs = [d.name for d in ode.inputs], [d.name for d in ode.outputs]
        held, free = ([k for k, n in enumerate(names) if n in end]
                      for names, end in zip((outputs, inputs), ends, strict=True))  # fmt: skip
        x0, u0, n = self.start(p), np.array(ode.u0), len(ode.states)
        for name, value in {**left, **stated}.items():
            u0[inputs.index(name)] = value
        targets = self._values(x0, u0, p)[1].ravel()[held]
        weights = np.append(
            1.0 + np.abs(self.matrices(x0, u0, p)[0]).sum(axis=1), [1.0] * len(held)
        )

        def balance(z: Matrix) -> Matrix:
            rates, y, _ = (v.ravel() for v in self._values(z[:n], z[n:], p))
            return np.append(rates, y[held] - targets) / weights

        def slope(z: Matrix) -> Matrix:
            a, b, c, d = self.matrices(z[:n], z[n:], p)
            found: Matrix = np.block([[a, b], [c[held], d[held]]]) / weights[:, None]
            return found

        sizes = np.concatenate([np.ones(n), np.zeros(len(u0))])
        sizes[[n + k for k in free]] = 1.0
        z = _newton(balance, slope, np.concatenate([x0, u0]), sizes)
        if not _norm(balance(z)) < _UNIFORM:
            raise ValueError(f"{ode.name} does not come to rest where it starts")
        values = dict(zip((d.name for d in ode.states), z[:n].tolist(), strict=True))
        values |= dict(zip(inputs, z[n:].tolist(), strict=True))
        y = self._values(z[:n], z[n:], p)[1].ravel()
        values |= dict(zip(outputs, y.tolist(), strict=True))
        return Point(z[:n], z[n:], values, dict(stated), dict.fromkeys(outputs, 0.0), dict(left))

    def block(self, p: Matrix, at: Point, micro_step: float) -> Plant:
        """The plant's block over a micro step, as the FMU integrates it.

        The classic Runge-Kutta step of a linear equation is R(hA) x + h S(hA) B u with
        R = 1 + z + z^2/2 + z^3/6 + z^4/24 and S = (R - 1)/z.
        """
        a, b, c, d = self.matrices(at.x, at.u, p)
        first = self.matrices(self.start(p), np.array(self.ode.u0), p)[0]
        fastest = max(np.abs(np.linalg.eigvals(m)).max(initial=0.0) for m in (a, first))
        parts = max(1, math.ceil(micro_step * fastest / H_LAMBDA))
        h = micro_step / parts
        z, one = h * a, np.eye(len(a))
        s = one + z / 2.0 @ (one + z / 3.0 @ (one + z / 4.0))
        f1, g1 = one + z @ s, h * s @ b
        f, g = one, np.zeros_like(g1)
        for _ in range(parts):
            f, g = f1 @ f, f1 @ g + g1
        ode = self.ode
        return Plant(
            inputs=tuple(q.name for q in ode.inputs),
            states=tuple(q.name for q in ode.states),
            outputs=tuple(q.name for q in ode.outputs),
            grid_ns=nanoseconds("micro_step", micro_step),
            step=(f, g),
            show=(c, d),
        )
