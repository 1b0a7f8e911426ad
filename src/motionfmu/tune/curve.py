"""Margins of a loop, with their derivatives to the gains."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
_POINTS = 240
# Points about each frequency at which the open or the closed loop rings.
_ABOUT = np.array([-2.0, -1.0, -0.5, -0.2, 0.0, 0.2, 0.5, 1.0, 2.0])
# No crossing: the loop may be 1000 times as large or as small.
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

    def value(self, omega: Array) -> Complex:
        """The loop alone, over omega [rad/s]."""
        z = np.exp(1j * omega * self.period)
        system = z[:, None, None] * np.eye(len(self.a)) - self.a
        x = np.linalg.solve(system, np.broadcast_to(self.b, (len(z), *self.b.shape)))
        found: Complex = (self.c @ x)[:, 0, 0] + self.d[0, 0]
        return found

    def grid(self) -> Array:
        """Frequencies [rad/s] up to half the rate, denser where it rings."""
        closed = self.a - self.b @ self.c / (1.0 + self.d[0, 0])
        poles = np.concatenate([np.linalg.eigvals(self.a), np.linalg.eigvals(closed)])
        roots = np.log(poles[np.abs(poles) > 1e-6].astype(complex)) / self.period
        top = np.pi / self.period
        roots = roots[(roots.imag > 0.0) & (roots.imag < 0.99 * top)]
        near = np.abs(roots)[:, None] + np.abs(roots.real)[:, None] * _ABOUT
        omega = np.concatenate([np.geomspace(1e-4 * top, top, _POINTS), near.ravel()])
        return np.unique(omega[(omega > 0.0) & (omega <= top)])


@dataclass(frozen=True)
class Margin:
    """Margins of a loop and their derivatives to the gains."""

    values: Array  # (4,)
    slopes: Array  # (4, g)
    # Distance of the curve to -1, logarithm of the gain up and down to the limit, phase [rad].
    names: tuple[str, ...] = ("distance", "up", "down", "phase")


def margin(loop: Loop) -> Margin:
    """Margins as `motionfmu.linear.margins`, differentiable.

    At the crossing w(g) of a condition h(w, g) = 0 a value v has the slope
    v_g - v_w h_g / h_w.
    """
    omega = loop.grid()
    values = loop.value(omega)
    count = len(loop.da)
    found, slopes = np.array([0.0, FREE, FREE, np.pi]), np.zeros((4, count))
    w = _nearest(loop, omega, values)
    at, _, change = loop.at(np.array([w]))
    away = 1.0 + at[0]
    found[0] = abs(away)
    slopes[0] = (np.conj(away) * change[:, 0]).real / max(abs(away), 1e-12)
    for w in _turns(loop, omega, values):
        at, slope, change = (v[..., 0] for v in loop.at(np.array([w])))
        size = np.log(abs(at))
        place = 1 if size < 0.0 else 2
        if abs(size) < found[place]:
            rate, per_gain = slope / at, change / at
            moved = 0.0 if rate.imag == 0.0 else rate.real / rate.imag
            if w >= omega[-1]:
                moved = 0.0  # half the sampling rate stays where it is
            found[place] = abs(size)
            slopes[place] = np.sign(size) * (per_gain.real - per_gain.imag * moved)
    size = np.log(np.abs(values))
    for k in np.flatnonzero(np.signbit(size[:-1]) != np.signbit(size[1:])):
        w = brentq(lambda w: _log(loop, w), omega[k], omega[k + 1], rtol=1e-10)
        at, slope, change = (v[..., 0] for v in loop.at(np.array([w])))
        angle = float(np.angle(-at))
        if abs(angle) < found[3]:
            rate, per_gain = slope / at, change / at
            found[3] = abs(angle)
            turned = per_gain.imag - per_gain.real * (rate.imag / rate.real)
            slopes[3] = np.sign(angle) * turned
    return Margin(found, slopes)


def _log(loop: Loop, w: float) -> float:
    return float(np.log(abs(loop.value(np.array([w]))[0])))


def _nearest(loop: Loop, omega: Array, values: Complex) -> float:
    """Frequency at which the curve is nearest to -1, refined on ever finer grids."""
    size = np.abs(1.0 + values)
    k = int(np.argmin(size))
    low, high = omega[max(k - 1, 0)], omega[min(k + 1, len(omega) - 1)]
    for _ in range(4):
        fine = np.linspace(low, high, 13)
        k = int(np.argmin(np.abs(1.0 + loop.value(fine))))
        low, high = fine[max(k - 1, 0)], fine[min(k + 1, 12)]
    return float(0.5 * (low + high) if 0 < k < 12 else fine[k])


def _turns(loop: Loop, omega: Array, values: Complex) -> list[float]:
    """Frequencies at which the curve crosses the negative real axis."""
    found = []
    sides = np.signbit(values.imag[:-1]) != np.signbit(values.imag[1:])
    left = (values.real[:-1] < 0.0) | (values.real[1:] < 0.0)
    for k in np.flatnonzero(sides & left):
        ends = omega[k], omega[k + 1]
        w = brentq(lambda w: float(loop.value(np.array([w]))[0].imag), *ends, rtol=1e-10)
        at = loop.value(np.array([w]))[0]
        if at.real < 0.0 and abs(at.imag) < 1e-3 * abs(at):
            found.append(float(w))
    if values[-1].real < 0.0 and (not found or found[-1] < omega[-1] * (1.0 - 1e-9)):
        found.append(float(omega[-1]))
    return found
