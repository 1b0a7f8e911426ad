"""A plant's equation about an operating point, on its micro-grid."""

import itertools
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
from scipy.optimize import least_squares

from motionfmu.linear.block import Matrix, Plant
from motionfmu.modelica.ode import Ode
from motionfmu.system import nanoseconds

# As src/plant/plant_model.c chooses its sub-steps: (h/n) |lambda| <= 2.
H_LAMBDA = 2.0
# A uniform motion is found when what is left of the balance is below this, relative.
_UNIFORM = 1e-9
# Positions after a second have lost digits to rounding.
_LASTING = 1e-6
# Relative distance at which both sides of a point are looked at.
_HAIR = 1e-13
_NEWTON_STEPS, _SHORTEST, _LEVENBERG_STEPS = 60, 1e-6, 200
# It leads nowhere when so many steps, one after the other, were cut to less than this share.
_CREEPING, _SHORT = 5, 1e-3


def _norm(v: Matrix) -> float:
    return float(np.linalg.norm(v))


@dataclass(frozen=True)
class Point:
    """Where a plant is linearised: a uniform motion.

    Attributes
    ----------
    x, u : ndarray
        States and inputs.
    values : dict
        The same by name, and the outputs, in the units of the class.
    stated : dict
        What the user asked for.
    rates : dict
        Rates of the outputs by name, per second: nonzero where the motion goes on.
    """

    x: Matrix
    u: Matrix
    values: dict[str, float]
    stated: dict[str, float]
    rates: dict[str, float]


_Function = Callable[[Matrix], Matrix]


def _newton(rest: _Function, slope: _Function, start: Matrix, columns: Matrix) -> Matrix:
    """The shortest step, halved until it leads nearer."""
    z, found, slow = start, rest(start), 0
    for _ in range(_NEWTON_STEPS):
        way = np.zeros(len(z))
        way[columns] = -np.linalg.pinv(slope(z), rcond=1e-13) @ found
        length = 1.0
        while length > _SHORTEST and not _norm(rest(z + length * way)) < _norm(found):
            length /= 2.0
        slow = slow + 1 if length < _SHORT else 0
        if length <= _SHORTEST or slow > _CREEPING:
            break
        z = z + length * way
        found = rest(z)
    return z


def _levenberg(rest: _Function, slope: _Function, start: Matrix, columns: Matrix) -> Matrix:
    """Each unknown in its own measure: pressures beside strokes, fast states beside slow ones."""

    def whole(part: Matrix) -> Matrix:
        z = start.copy()
        z[columns] = part
        return z

    tight: Any = dict.fromkeys(("xtol", "ftol", "gtol"), 1e-15)
    square = len(rest(start)) >= len(columns)
    found = least_squares(
        lambda part: rest(whole(part)),
        start[columns],
        lambda part: slope(whole(part)),
        x_scale="jac",
        method="lm" if square else "trf",
        max_nfev=_LEVENBERG_STEPS,
        **tight,
    )
    return whole(found.x)


class Linearised:
    """The functions of an equation, made once.

    Parameters
    ----------
    ode : Ode
    """

    def __init__(self, ode: Ode) -> None:
        self.ode = ode
        a, b, c, d = (ca.jacobian(e, v) for e in (ode.xdot, ode.y) for v in (ode.x, ode.u))
        arguments = [ode.x, ode.u, ode.p]
        # In a uniform motion every slope is constant: d(xdot)/dt = A xdot = 0.
        change = ca.mtimes(a, ode.xdot)
        self._matrices = ca.Function("abcd", arguments, [a, b, c, d])
        self._values = ca.Function("values", arguments, [ode.xdot, ode.y, change])
        z = ca.vertcat(ode.x, ode.u)
        slopes = [ca.jacobian(change, z), ca.jacobian(ode.y, z)]
        self._slopes = ca.Function("slopes", arguments, slopes)
        self._start = ca.Function("start", [ode.p], [ode.start])

    def parameters(self, values: Mapping[str, float]) -> Matrix:
        """Parameter vector.

        Parameters
        ----------
        values : mapping
            By name.

        Returns
        -------
        ndarray, shape (n_p,)
        """
        return np.array([float(values[d.name]) for d in self.ode.parameters])

    def matrices(self, x: Matrix, u: Matrix, p: Matrix) -> tuple[Matrix, Matrix, Matrix, Matrix]:
        """Matrices A, B, C, D at a point.

        The mean of both sides of the point, a hair away: where branches meet without a bend (a gap
        of width 0 at force 0) the point itself has no derivative that CasADi could tell.

        Parameters
        ----------
        x, u, p : ndarray

        Returns
        -------
        tuple of ndarray
        """
        sides = []
        for hair in (_HAIR, -_HAIR):
            # unequal, so that no difference of two states stays 0
            away = [v + hair * np.arange(1, v.size + 1) * (1.0 + np.abs(v)) for v in (x, u)]
            sides.append([np.array(m.full()) for m in self._matrices(*away, p)])
        a, b, c, d = (0.5 * (one + other) for one, other in zip(*sides, strict=True))
        return a, b, c, d

    def start(self, p: Matrix) -> Matrix:
        """State at the start.

        Parameters
        ----------
        p : ndarray

        Returns
        -------
        ndarray
        """
        return np.array(self._start(p).full()).ravel()

    def point(self, p: Matrix, stated: Mapping[str, float]) -> Point:
        """Find the uniform motion that has the stated values.

        Nothing stated: the state and inputs at the start. Inputs that are not stated and not
        needed keep their start values; the others follow from the balance of forces.

        Parameters
        ----------
        p : ndarray
        stated : mapping
            Values of outputs and inputs by name, in their units.

        Returns
        -------
        Point

        Raises
        ------
        ValueError
            A name is unknown, or there is no such motion.
        """
        ode = self.ode
        inputs, outputs = [d.name for d in ode.inputs], [d.name for d in ode.outputs]
        for name in stated:
            if name not in (*inputs, *outputs):
                raise ValueError(f"{name} is neither an input nor an output of {ode.name}")
        x, u = self.start(p), np.array(ode.u0)
        for name in set(stated) & set(inputs):
            u[inputs.index(name)] = stated[name]
        wanted = {outputs.index(n): v for n, v in stated.items() if n in outputs}
        if wanted:
            free = [k for k, n in enumerate(inputs) if n not in stated]
            x, u = self._settle((x, u, p), wanted, free)
        xdot, y, _ = (np.array(v.full()).ravel() for v in self._values(x, u, p))
        values = dict(zip((d.name for d in ode.states), x.tolist(), strict=True))
        values |= dict(zip(inputs, u.tolist(), strict=True))
        values |= dict(zip(outputs, y.tolist(), strict=True))
        a, b, c, _ = self.matrices(x, u, p)
        balance = np.abs(a) @ np.abs(x) + np.abs(b) @ np.abs(u)
        xdot[np.abs(xdot) <= _UNIFORM * balance] = 0.0  # what rounding leaves of a sum of forces
        rates = c @ xdot if stated else np.zeros(len(outputs))
        return Point(x, u, values, dict(stated), dict(zip(outputs, rates.tolist(), strict=True)))

    def _settle(
        self, begin: tuple[Matrix, Matrix, Matrix], wanted: dict[int, float], free: list[int]
    ) -> tuple[Matrix, Matrix]:
        """Newton with the shortest step, then Levenberg and Marquardt, from or near the start."""
        x0, u0, p = begin
        places, targets = list(wanted), np.array(list(wanted.values()))
        n = len(x0)
        columns = np.array([*range(n), *(n + k for k in free)])
        rates = 1.0 + np.abs(self.matrices(x0, u0, p)[0]).sum(axis=1)
        weights = 1.0 / np.concatenate([rates, np.maximum(np.abs(targets), 1.0)])

        def rest(z: Matrix) -> Matrix:
            _, y, change = (np.array(v.full()).ravel() for v in self._values(z[:n], z[n:], p))
            return weights * np.concatenate([change, y[places] - targets])

        def slope(z: Matrix) -> Matrix:
            of_change, of_y = (np.array(m.full()) for m in self._slopes(z[:n], z[n:], p))
            found: Matrix = (weights[:, None] * np.vstack([of_change, of_y[places]]))[:, columns]
            return found

        guesses = self._guesses((x0, u0, p), places, targets)
        for way, guess in itertools.product((_newton, _levenberg), guesses):
            z = way(rest, slope, np.concatenate([guess, u0]), columns)
            if not _norm(rest(z)) < _UNIFORM:
                continue
            z = self._back(z, x0, rest)
            if self._lasts(z[:n], z[n:], p, weights[:n]):
                return z[:n], z[n:]
        names = [f"{self.ode.outputs[k].name} = {v:g}" for k, v in wanted.items()]
        raise ValueError(f"{self.ode.name} has no uniform motion with {', '.join(names)}")

    def _back(self, z: Matrix, begin: Matrix, rest: _Function) -> Matrix:
        """A position on which the motion does not depend returns to where it was."""
        for k in range(len(self.ode.states)):
            moved = z.copy()
            moved[k] = begin[k]
            if _norm(rest(moved)) < _UNIFORM:
                z = moved
        return z

    def _lasts(self, x: Matrix, u: Matrix, p: Matrix, weights: Matrix) -> bool:
        """Whether the motion goes on so: in a gap it ends where the sides meet."""
        xdot = np.array(self._values(x, u, p)[0].full()).ravel()
        later = (x + seconds * xdot for seconds in (1e-3, 1e-2, 0.1, 1.0))
        changes = (np.array(self._values(at, u, p)[2].full()).ravel() for at in later)
        return all(_norm(weights * change) < _LASTING for change in changes)

    def _guesses(
        self, begin: tuple[Matrix, Matrix, Matrix], places: list[int], targets: Matrix
    ) -> list[Matrix]:
        """States near which the motion may be found.

        The start; then the start moved by small and larger steps of each state both ways, so that
        a gap is closed on the side on which the force is carried.
        """
        x0, u0, p = begin
        found = [x0]
        c = self.matrices(x0, u0, p)[2]
        speeds = x0 + np.linalg.pinv(c[places]) @ targets
        found.append(speeds)
        for size in (1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1.0):
            for k in range(len(x0)):
                for sign in (1.0, -1.0):
                    moved = speeds.copy()
                    moved[k] += sign * size
                    found.append(moved)
        return found

    def block(self, p: Matrix, at: Point, micro_step: float) -> Plant:
        """The plant between two instants, as the FMU integrates it.

        The classic Runge-Kutta step of a linear equation is R(hA) x + h S(hA) B u with
        R = 1 + z + z^2/2 + z^3/6 + z^4/24 and S = (R - 1)/z.

        Parameters
        ----------
        p : ndarray
        at : Point
        micro_step : float
            [s].

        Returns
        -------
        Plant

        Raises
        ------
        ValueError
            The micro step is no whole number of ns.
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
