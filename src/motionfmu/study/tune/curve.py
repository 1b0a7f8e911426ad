"""Stability margins of a loop, with their derivatives to the gains."""

import functools
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import matrix_balance, schur

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
# Frequencies as shares of half the sampling rate, and points of a finer grid between two of them.
_GRID, _BETWEEN = np.geomspace(1e-4, 1.0, 240), np.linspace(0.0, 1.0, 13)
# Additional points about each frequency at which the open or the closed loop rings.
_ABOUT = np.array([-2.0, -1.0, -0.5, -0.2, 0.0, 0.2, 0.5, 1.0, 2.0])
# Most steps of the search of a crossing, and the relative width at which it ends.
_STEPS, _DONE = 100, 1e-6
# A loop without a crossing has these margins: a factor of 1000 up and down.
FREE = np.log(1e3)


@dataclass(frozen=True)
class Loop:
    """An open loop in discrete time and its derivatives to the gains."""

    # State space with one input and one output; the feedback is negative.
    a: Array
    b: Array
    c: Array
    d: Array
    # Derivatives, the first axis is the gain.
    da: Array
    db: Array
    dc: Array
    dd: Array
    period: float  # [s]

    def at(self, omega: Array) -> tuple[Complex, Complex, Complex]:
        """The loop (f,), its slope over omega [rad/s], over gains (g, f)."""
        z = np.exp(1j * omega * self.period)
        n = len(self.a)
        inverse = np.linalg.inv(z[:, None, None] * np.eye(n) - self.a)
        right, left = inverse @ self.b, self.c @ inverse
        value = (self.c @ right)[:, 0, 0] + self.d[0, 0]
        slope = -1j * self.period * z * (left @ right)[:, 0, 0]
        change = np.empty((len(self.da), len(omega)), dtype=complex)
        for k in range(len(self.da)):
            part = self.dc[k] @ right + left @ self.db[k] + left @ self.da[k] @ right
            change[k] = part[:, 0, 0] + self.dd[k, 0, 0]
        return value, slope, change

    @functools.cached_property
    def _triangular(self) -> tuple[Complex, Complex, Complex]:
        """A, b and c in balanced states in which A is triangular."""
        balanced, (scale, _) = matrix_balance(self.a, permute=False, separate=True)
        a, turn = schur(balanced, output="complex")
        b = turn.conj().T @ (self.b[:, 0] / scale)
        return a, b, (self.c[0] * scale) @ turn

    def value(self, omega: Array) -> Complex:
        """The loop without slopes, at many frequencies [rad/s]."""
        a, b, c = self._triangular
        z = np.exp(1j * omega * self.period)
        x = np.empty((len(a), len(z)), dtype=complex)
        for k in range(len(a) - 1, -1, -1):  # (z - A) x = b, from the last row up
            x[k] = (b[k] + a[k, k + 1 :] @ x[k + 1 :]) / (z - a[k, k])
        found: Complex = c @ x + self.d[0, 0]
        return found

    def steep(self, omega: Array) -> tuple[Complex, Complex]:
        """The loop and its slope at a few frequencies [rad/s]."""
        z = np.exp(1j * omega * self.period)
        inverse = np.linalg.inv(z[:, None, None] * np.eye(len(self.a)) - self.a)
        once = inverse @ self.b
        slope = -1j * self.period * z * (self.c @ (inverse @ once))[:, 0, 0]
        return (self.c @ once)[:, 0, 0] + self.d[0, 0], slope

    def grid(self) -> Array:
        """Frequencies [rad/s] up to half the sampling rate, denser where the loop rings."""
        closed = self.a - self.b @ self.c / (1.0 + self.d[0, 0])
        poles = np.concatenate([np.diagonal(self._triangular[0]), np.linalg.eigvals(closed)])
        roots = np.log(poles[np.abs(poles) > 1e-6].astype(complex)) / self.period
        top = np.pi / self.period
        roots = roots[(roots.imag > 0.0) & (roots.imag < 0.99 * top)]
        near = np.abs(roots)[:, None] + np.abs(roots.real)[:, None] * _ABOUT
        omega = np.concatenate([top * _GRID, near.ravel()])
        return np.unique(omega[(omega > 0.0) & (omega <= top)])


@dataclass(frozen=True)
class Margin:
    """Margins of a loop and their derivatives to the gains."""

    values: Array  # (4,)
    slopes: Array  # (4, g)
    # Distance of the curve to -1, logarithm of the gain up and down to the limit, phase [rad].
    names: tuple[str, ...] = ("distance", "up", "down", "phase")


def margin(loop: Loop) -> Margin:
    """Margins as `motionfmu.analysis.linear.margins`, differentiable.

    At the crossing w(g) of a condition h(w, g) = 0 a value v has the slope
    v_g - v_w h_g / h_w.
    """
    omega = loop.grid()
    values = loop.value(omega)
    turns, crossings = _special(loop, omega, values)
    places = np.array([_nearest(loop, omega, values), *turns, *crossings])
    at, slope, change = loop.at(places)
    rate, per_gain = slope / at, change / at
    found, slopes = np.array([0.0, FREE, FREE, np.pi]), np.zeros((4, len(loop.da)))
    away = 1.0 + at[0]
    found[0] = abs(away)
    slopes[0] = (np.conj(away) * change[:, 0]).real / max(abs(away), 1e-12)
    for k in range(1, 1 + len(turns)):
        size = np.log(abs(at[k]))
        place = 1 if size < 0.0 else 2
        if abs(size) < found[place]:
            moved = 0.0 if rate[k].imag == 0.0 else rate[k].real / rate[k].imag
            if places[k] >= omega[-1]:
                moved = 0.0  # half the sampling rate stays where it is
            found[place] = abs(size)
            slopes[place] = np.sign(size) * (per_gain[:, k].real - per_gain[:, k].imag * moved)
    for k in range(1 + len(turns), len(places)):
        angle = float(np.angle(-at[k]))
        if abs(angle) < found[3]:
            found[3] = abs(angle)
            turned = per_gain[:, k].imag - per_gain[:, k].real * (rate[k].imag / rate[k].real)
            slopes[3] = np.sign(angle) * turned
    return Margin(found, slopes)


def _roots(
    value: Callable[[Array], tuple[Array, Array]],
    ends: tuple[Array, Array],
    at: tuple[Array, Array],
) -> Array:
    """Roots of a function with its slope, each between two ends with the values there.

    A step is Newton's if it stays between the ends and halves their distance; else the interval is
    halved.
    """
    low, high = (end.copy() for end in ends)
    w = np.clip(low - at[0] * (high - low) / (at[1] - at[0]), low, high)
    before = high - low
    for _ in range(_STEPS):
        f, rate = value(w)
        above = np.signbit(f) != np.signbit(at[0])
        high[above], low[~above] = w[above], w[~above]
        with np.errstate(divide="ignore", invalid="ignore"):
            there = w - f / rate
        near = np.abs(there - w) <= _DONE * w  # the error that is left is the square of this
        good = near | (there > low) & (there < high) & (np.abs(there - w) <= 0.5 * before)
        there = np.where(good, there, 0.5 * (low + high))
        before = np.abs(there - w)
        w = there
        if near.all():
            break
    return w


def _changes(function: Array) -> NDArray[np.intp]:
    """Positions after which the sign changes."""
    return np.flatnonzero(np.signbit(function[:-1]) != np.signbit(function[1:]))


def _special(loop: Loop, omega: Array, values: Complex) -> tuple[list[float], Array]:
    """Frequencies [rad/s] where the curve crosses the negative real axis, and the unit circle."""
    size, height = np.log(np.abs(values)), values.imag
    real = _changes(height)
    real = real[(values.real[real] < 0.0) | (values.real[real + 1] < 0.0)]
    unit = _changes(size)
    k, count = np.append(real, unit), len(real)
    roots = np.empty(0)
    if len(k):

        def value(w: Array) -> tuple[Array, Array]:
            at, slope = loop.steep(w)
            logs = np.log(np.abs(at[count:])), (slope[count:] / at[count:]).real
            return np.append(at.imag[:count], logs[0]), np.append(slope.imag[:count], logs[1])

        first, last = (np.append(height[real + n], size[unit + n]) for n in (0, 1))
        roots = _roots(value, (omega[k], omega[k + 1]), (first, last))
    turns = roots[:count]
    at = loop.value(turns)
    found = turns[(at.real < 0.0) & (np.abs(at.imag) < 1e-3 * np.abs(at))].tolist()
    if values[-1].real < 0.0 and (not found or found[-1] < omega[-1] * (1.0 - 1e-9)):
        found.append(float(omega[-1]))
    return found, roots[count:]


def _nearest(loop: Loop, omega: Array, values: Complex) -> float:
    """Frequency at which the curve is nearest to -1, refined on ever finer grids."""
    size = np.abs(1.0 + values)
    k = int(np.argmin(size))
    low, high = omega[max(k - 1, 0)], omega[min(k + 1, len(omega) - 1)]
    for _ in range(4):
        fine = low + (high - low) * _BETWEEN
        k = int(np.argmin(np.abs(1.0 + loop.value(fine))))
        low, high = fine[max(k - 1, 0)], fine[min(k + 1, 12)]
    return float(0.5 * (low + high) if 0 < k < 12 else fine[k])
