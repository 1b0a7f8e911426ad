"""Stability margins of a loop: gain, phase, delay, disk, sensitivity, bandwidth."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError
from motionfmu.base.shown_by import drawn

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
System: TypeAlias = Any  # control.StateSpace or control.TransferFunction
# Points of the first grid; crossings and peaks are then refined.
_POINTS = 2000
# A pole this near to 1 counts as 1, for it moves in 10^6 samples only.
AT_ONE = 1e-6
_BANDWIDTH = 1.0 / np.sqrt(2.0)


@dataclass(frozen=True)
class Crossing:
    """Where the loop crosses -180 degrees or magnitude 1."""

    omega: float  # [rad/s]
    value: float  # factor that brings the loop to -1, or phase lag that does [deg]
    delay: float = float("nan")  # dead time that does [s]; NaN for a gain


@dataclass(frozen=True)
class Margins:
    """Margins of a loop under negative feedback.

    Attributes
    ----------
    stable : bool
        The closed loop is.
    gain : float
        Smallest factor above 1 that makes it ring; infinite if none does.
    gain_down : float
        Largest factor below 1 that does; 0 if none does.
    phase : float
        Smallest lag that does [deg]; infinite if the magnitude never crosses 1.
    delay : float
        Smallest dead time that does [s].
    disk : float
        Disk margin: the balanced one, 1/max|S - 1/2|; 2 is unlimited.
    disk_gain, disk_phase : float
        Gain factor and lag [deg] that it allows together with each other's sign.
    sensitivity, complementary : float
        Peaks of |1/(1 + L)| and |L/(1 + L)|.
    bandwidth : float
        Frequency from which on |L/(1 + L)| stays below -3 dB [rad/s].
    gain_crossings, phase_crossings : tuple of Crossing
        All crossings of -180 degrees and of magnitude 1.
    omega_gain, omega_phase, omega_sensitivity : float
        Where these margins are [rad/s].
    loop : StateSpace or TransferFunction
        The open loop; a notebook shows its Bode diagram.
    """

    stable: bool
    gain: float
    gain_down: float
    phase: float
    delay: float
    disk: float
    disk_gain: float
    disk_phase: float
    sensitivity: float
    complementary: float
    bandwidth: float
    gain_crossings: tuple[Crossing, ...]
    phase_crossings: tuple[Crossing, ...]
    omega_gain: float
    omega_phase: float
    omega_sensitivity: float
    loop: System = field(compare=False)

    def __repr__(self) -> str:
        gain = "unlimited" if math.isinf(self.gain) else f"{20.0 * math.log10(self.gain):.4g} dB"
        gain += f" (x {self.gain:.4g}){_at(self.omega_gain)}" if math.isfinite(self.gain) else ""
        gain += f", down to x {self.gain_down:.4g}" if self.gain_down else ""
        phase, delay = f"{self.phase:.4g}°", f"{self.delay * 1e3:.4g} ms"
        if math.isinf(self.phase):
            phase = delay = "unlimited"
        lines = (
            f"gain        {gain}",
            f"phase       {phase}{_at(self.omega_phase)}",
            f"delay       {delay}",
            f"disk        {self.disk:.4g}: gain x {self.disk_gain:.4g},"
            f" phase {self.disk_phase:.4g}°",
            f"peaks       |S| {self.sensitivity:.4g}{_at(self.omega_sensitivity)},"
            f" |T| {self.complementary:.4g}",
            f"bandwidth   {self.bandwidth / (2.0 * math.pi):.4g} Hz",
        )
        word = "stable" if self.stable else "UNSTABLE"
        return f"Margins of a loop, {word} when closed\n" + "\n".join(f"  {t}" for t in lines)

    def _repr_html_(self) -> str:
        return str(drawn("loop_pages.loop_views").margins_html(self))


def _at(omega: float) -> str:
    """Where a margin is, if it is anywhere."""
    return f" at {omega / (2.0 * math.pi):.4g} Hz" if math.isfinite(omega) else ""


def response(system: System, omega: Array) -> Complex:
    """Frequency response, at omega [rad/s], of one input and output."""
    s = np.exp(1j * omega * system.dt) if system.isdtime(strict=True) else 1j * omega
    if hasattr(system, "num"):
        found: Complex = np.asarray(system(s), dtype=complex).reshape(len(omega))
        return found
    n = system.nstates
    d: Complex = np.full(len(omega), system.D[0, 0], dtype=complex)
    if n:
        resolvent = s[:, None, None] * np.eye(n) - system.A
        x = np.linalg.solve(resolvent, np.broadcast_to(system.B, (len(omega), n, 1)))
        d += (system.C @ x)[:, 0, 0]
    return d


def grid(loop: System, points: int = _POINTS) -> Array:
    """Frequencies [rad/s], logarithmic, denser at resonances."""
    # Up to half the sampling rate.
    roots = np.concatenate([loop.poles(), loop.zeros()]).astype(complex)
    discrete = loop.isdtime(strict=True)
    if discrete:
        roots = np.log(roots[np.abs(roots) > 1e-9]) / loop.dt
    size = np.abs(roots)
    size = size[(size > 1e-9 * max(1.0, size.max(initial=0.0))) & np.isfinite(size)]
    top = np.pi / loop.dt if discrete else 1e3 * max(size.max(initial=1.0), 1.0)
    low = 1e-3 * min(size.min(initial=top), top)
    low = max(low, 1e-9 * top)
    parts = [np.geomspace(low, top, points), np.linspace(low, top, points // 4)]
    for root in roots[np.abs(roots.imag) > 0]:
        width = max(abs(root.real), 1e-4 * abs(root))
        parts.append(abs(root.imag) + width * np.linspace(-5.0, 5.0, 41))
    omega = np.unique(np.concatenate(parts))
    return omega[(omega >= low) & (omega <= top)]


# CCN 16: a figure for each field of the result, and what it is if there is no crossing.
def margins(loop: System) -> Margins:
    """All margins of a loop.

    Parameters
    ----------
    loop : StateSpace or TransferFunction
        Open loop L of one input and output, continuous or discrete; the feedback is negative.

    Returns
    -------
    Margins

    Raises
    ------
    InputError
        This is no loop.
    """
    if not hasattr(loop, "poles"):
        raise InputError(f"{loop!r:.80}: an open loop wanted, such as model(...).loop(at)")
    omega = grid(loop)
    values = response(loop, omega)

    def at(w: float) -> complex:
        return complex(response(loop, np.array([w]))[0])

    gains = _gain_crossings(omega, values, at)
    if loop.isdtime(strict=True) and values[-1].real < 0.0:
        # half the sampling rate: real there, so the end of the curve is a crossing
        if not gains or gains[-1].omega < omega[-1] * (1.0 - 1e-9):
            gains.append(Crossing(float(omega[-1]), float(1.0 / abs(values[-1]))))
    phases = _phase_crossings(omega, values, at)
    up = min((c for c in gains if c.value > 1.0), key=lambda c: c.value, default=None)
    down = max((c.value for c in gains if c.value < 1.0), default=0.0)
    least = min(phases, key=lambda c: abs(c.value), default=None)
    m_s, w_s = _peak(omega, lambda w: np.abs(1.0 / (1.0 + response(loop, w))))
    m_t, _ = _peak(omega, lambda w: _closed(response(loop, w)))
    balanced, _ = _peak(omega, lambda w: np.abs(1.0 / (1.0 + response(loop, w)) - 0.5))
    disk = 1.0 / balanced
    half = min(disk / 2.0, 1.0)
    return Margins(
        stable=_stable(loop),
        gain=up.value if up else float("inf"),
        gain_down=down,
        phase=abs(least.value) if least else float("inf"),
        delay=min((c.delay for c in phases), default=float("inf")),
        disk=disk,
        disk_gain=(1.0 + half) / (1.0 - half) if half < 1.0 else float("inf"),
        disk_phase=float(np.degrees(2.0 * np.arctan(disk / 2.0))),
        sensitivity=m_s,
        complementary=m_t,
        bandwidth=_bandwidth(omega, values, at),
        gain_crossings=tuple(gains),
        phase_crossings=tuple(phases),
        omega_gain=up.omega if up else float("nan"),
        omega_phase=least.omega if least else float("nan"),
        omega_sensitivity=w_s,
        loop=loop,
    )


def _root(of: Callable[[float], float], ends: Sequence[float] | Array, **options: float) -> float:
    """Root of a function between two ends."""
    from scipy.optimize import brentq  # takes longer to import than most commands

    return float(brentq(of, ends[0], ends[1], **options))


def _closed(values: Complex) -> Array:
    found: Array = np.abs(values / (1.0 + values))
    return found


def _gain_crossings(
    omega: Array, values: Complex, at: Callable[[float], complex]
) -> list[Crossing]:
    found = []
    turns = np.flatnonzero(np.signbit(values.imag[:-1]) != np.signbit(values.imag[1:]))
    for k in turns:
        if values[k].real >= 0.0 and values[k + 1].real >= 0.0:
            continue
        w = _root(lambda w: at(w).imag, omega[k : k + 2], xtol=1e-12 * omega[k + 1])
        value = at(w)
        if value.real < 0.0 and abs(value.imag) < 1e-3 * abs(value):
            found.append(Crossing(w, float(1.0 / abs(value))))
    return found


def _phase_crossings(
    omega: Array, values: Complex, at: Callable[[float], complex]
) -> list[Crossing]:
    found = []
    size = np.log(np.abs(values))
    for k in np.flatnonzero(np.signbit(size[:-1]) != np.signbit(size[1:])):
        w = _root(lambda w: np.log(abs(at(w))), omega[k : k + 2], xtol=1e-12 * omega[k + 1])
        angle = float(np.degrees(np.angle(-at(w))))  # lag to -180 degrees, -180 .. 180
        lag = angle if angle > 0.0 else angle + 360.0
        found.append(Crossing(w, angle, float(np.radians(lag) / w)))
    return found


def _peak(omega: Array, size: Callable[[Array], Array]) -> tuple[float, float]:
    """Largest value, refined between the neighbours of the largest sample."""
    values = size(omega)
    k = int(np.argmax(values))
    low, high = omega[max(k - 1, 0)], omega[min(k + 1, len(omega) - 1)]
    from scipy.optimize import minimize_scalar  # as in `_root`

    found = minimize_scalar(
        lambda w: -float(size(np.array([w]))[0]), bounds=(low, high), method="bounded"
    )
    best = -float(found.fun)
    return (best, float(found.x)) if best > values[k] else (float(values[k]), float(omega[k]))


def _bandwidth(omega: Array, values: Complex, at: Callable[[float], complex]) -> float:
    above = _closed(values) >= _BANDWIDTH
    last = np.flatnonzero(above)
    if not last.size:
        return 0.0
    k = int(last[-1])
    if k + 1 == len(omega):
        return float(omega[-1])
    return _root(lambda w: abs(at(w) / (1.0 + at(w))) - _BANDWIDTH, omega[k : k + 2])


def closed_poles(loop: System, gain: float = 1.0) -> Complex:
    """Poles of the loop closed with a gain."""
    if hasattr(loop, "num"):
        num, den = loop.num[0][0], loop.den[0][0]
        roots: Complex = np.roots(np.polyadd(den, gain * np.asarray(num))).astype(complex)
        return roots
    a = loop.A - gain * loop.B @ loop.C / (1.0 + gain * loop.D[0, 0])
    found: Complex = np.linalg.eigvals(a).astype(complex)
    return found


def moving(poles: Complex) -> Complex:
    """Discrete poles without those at 1, which belong to positions that nothing holds."""
    # A velocity loop leaves the position of its axis where it is: no instability.
    found: Complex = poles[np.abs(poles - 1.0) > AT_ONE]
    return found


def _stable(loop: System) -> bool:
    poles = closed_poles(loop)
    if loop.isdtime(strict=True):
        return bool(np.abs(moving(poles)).max(initial=0.0) < 1.0)
    return bool(poles.real.max(initial=-1.0) < 0.0)
