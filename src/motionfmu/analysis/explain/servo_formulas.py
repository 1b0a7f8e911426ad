"""Closed formulas of servo contouring: frequency responses and what follows from them.

V feed [mm/s], R radius [mm], w = V/R [rad/s], Kp position gain [1/s], T sampling time [s].
Other lengths are in mm, times in s, angles in rad.
A circle comes out with the radius R |H(jw)|, whatever H is: servo, interpolation or filter.
"""

import cmath
import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

Array = NDArray[np.float64]

# Terms of the Fourier series of a chord's sag, which fall with the square of their number, and
# places of a chord at which their sum is looked at.
CHORD_TERMS, CHORD_PLACES = 50, 401
# Steps over which a step response is searched for its peak; its length in slowest time constants.
PEAK_STEPS, PEAK_LENGTH = 2000, 8.0


@dataclass(frozen=True)
class ServoAxis:
    """The parameters of one axis that theory needs."""

    gain: float  # position gain Kp [1/s]
    period: float = 0.0  # sampling time of the position loop [s]
    delay: float = 0.0  # computation delay in it [s]
    lag: float = 0.0  # first-order lag of the speed [s]
    velocity_gain: float = 0.0  # of the velocity loop [N.m.s/rad]; 0 for an ideal one
    velocity_time: float = 0.0  # its integral time [s]; 0 for none
    inertia: float = 0.0  # motor, screw and table [kg.m2]
    friction: float = 0.0  # Coulomb friction at the motor [N.m]
    viscous: float = 0.0  # viscous friction at the motor [N.m.s/rad]
    travel: float = 0.0  # per turn [mm]

    @staticmethod
    def of(quantities: Mapping[str, Array], axis: int) -> "ServoAxis":
        """The axis, from 0, that an FMU's quantities (six axes by name) describe."""
        names = ServoAxis.__dataclass_fields__
        return ServoAxis(**{n: float(quantities[n][axis]) for n in names if n in quantities})

    def response(self, speed: float) -> complex:
        """Position over command at an angular frequency [rad/s].

        The sampled loop ``K T g / (z^d (z - 1) + K T g)`` with g of the velocity loop.
        """
        s = 1j * speed
        inner = self._velocity(s)
        if self.period <= 0.0:
            return self.gain * inner / (s * cmath.exp(s * self.delay) + self.gain * inner)
        z = cmath.exp(s * self.period)
        loop = self.gain * self.period * inner
        return loop / (z ** (self.delay / self.period) * (z - 1.0) + loop)

    def _velocity(self, s: complex) -> complex:
        lagging = 1.0 / (1.0 + self.lag * s)
        if self.velocity_gain <= 0.0 or self.inertia <= 0.0:
            return lagging
        integral = 1.0 / self.velocity_time if self.velocity_time > 0.0 else 0.0
        pi = self.velocity_gain * (s + integral)
        return lagging * pi / (self.inertia * s * s + pi)


def radius_change(radius: float, response: complex) -> float:
    """Radius that comes out, minus the nominal one: R (|H| - 1) [mm], H of all in series at V/R."""
    return radius * (abs(response) - 1.0)


def lag_response(speed: float, time: float) -> complex:
    """First-order lag, or exponential acceleration: 1/(1 + jw T), w in rad/s.

    T [s] is 1/Kp of an ideal position loop.
    """
    return 1.0 / (1.0 + 1j * speed * time)


def average_response(speed: float, time: float, times: int = 1) -> complex:
    """Moving average over a time [s], repeated, without its delay, at a frequency [rad/s].

    Once it is linear acceleration after interpolation; twice the linear interpolation of points T
    apart; four times the cubic B-spline through them.
    """
    return complex(np.sinc(speed * time / (2.0 * math.pi)) ** times)


def following_radius(radius: float, following: float) -> float:
    """Radius that a loop runs which follows the command at a distance L: sqrt(R^2 - L^2) [mm]."""
    return math.sqrt(radius * radius - following * following)


def chord(radius: float, feed: float, time: float) -> float:
    """Sag [mm] of a chord run in a time [s]: R (1 - cos(V T/(2 R))), about ``V^2 T^2/(8 R)``."""
    return radius * (1.0 - math.cos(min(feed * time / (2.0 * radius), math.pi)))


def chord_behind_servo(sag: float, time: float, axis: ServoAxis) -> float:
    """Largest distance inwards [mm] that a table shows of the sag of chords, each a time [s] long.

    The sag is a parabola of time: its mean, 2/3, passes the servo, of its ripple
    ``-4/(pi k)^2 cos(2 pi k t/T)`` the table shows what the response makes of it.
    """
    terms = np.arange(1, CHORD_TERMS + 1)
    passed = np.array([axis.response(2.0 * math.pi * k / time) for k in terms.tolist()])
    # Ripple frequencies beyond half the sampling rate do not exist for a sampled servo.
    passed[terms / time > (0.5 / axis.period if axis.period > 0.0 else math.inf)] = 0.0
    turned = np.exp(2j * math.pi * np.outer(np.linspace(0.0, 1.0, CHORD_PLACES), terms))
    ripple = (turned @ (passed * 4.0 / (math.pi * terms) ** 2)).real
    return sag * (2.0 / 3.0 - float(ripple.min()))


def line_mismatch(feed: float, angle: float, gains: tuple[float, float]) -> float:
    """Steady contour error of a line: ``V sin(a) cos(a) (1/Kx - 1/Ky)`` [mm].

    The angle [rad] is its direction from the first axis.
    """
    return feed * math.sin(angle) * math.cos(angle) * (1.0 / gains[0] - 1.0 / gains[1])


def ellipse(radius: float, responses: tuple[complex, complex]) -> tuple[float, float]:
    """Larger and smaller semi-axis [mm] of what two responses at w = V/R make of a circle."""
    x, y = responses
    # x = R Re(Hx e^jt), y = R Im(Hy e^jt): columns for cos t and sin t.
    matrix = radius * np.array([[x.real, -x.imag], [y.imag, y.real]])
    large, small = np.linalg.svd(matrix, compute_uv=False)
    return float(large), float(small)


def corner(feed: float, angle: float, gain: float, acceleration: float = 0.0) -> float:
    """Contour error [mm] of a corner that the command runs into at a feed [mm/s].

    At constant feed sin(th) V/(e Kp), reached at Kp t = 1 behind the corner. Else the command
    brakes to the feed and speeds up again [mm/s2]; let u = Kp t, v = V/Kp and w = a/Kp^2. On the
    first move the tool is ``(v + w) e^-u`` before the corner, on the second
    ``v (u - 1 + e^-u) + w (u^2/2 - u + 1 - e^-u)`` behind it. The error is largest where both are
    equal. From rest that is 0.2725 sin(th) a/Kp^2, at u = 1.30.
    """
    v, w = feed / gain, acceleration / gain**2
    if v + w <= 0.0:
        return 0.0

    def ahead(u: float) -> float:
        gone = math.exp(-u)
        return v * (u - 1.0 + gone) + w * (0.5 * u * u - u + 1.0 - gone) - (v + w) * gone

    return abs(math.sin(angle)) * (v + w) * math.exp(-float(brentq(ahead, 0.0, 5.0)))


def blended_corner(feed: float, angle: float, gain: float, acceleration: float) -> float:
    """Contour error [mm] of a corner whose two moves, at a feed [mm/s], overlap.

    One brakes while the next speeds up [mm/s2]. Both distances, ``a (T - t)^2/2 + a (T - t)/Kp``
    and ``a t^2/2 - a t/Kp``, each with ``a/Kp^2 (1 - e^(-Kp t))`` more, are equal at t = T/2 +
    1/Kp, with T = V/a. If the ramp is over by then (Kp T < 2), both are
    ``V/(e Kp) sinh(Kp T/2)/(Kp T/2)`` there, which a short ramp makes the error of a sharp corner.
    """
    ramp = feed / acceleration
    half = 0.5 * gain * ramp
    if half < 1.0:
        own = math.sinh(half) / half if half > 0.0 else 1.0
        return abs(math.sin(angle)) * feed / (math.e * gain) * own
    time = 0.5 * ramp + 1.0 / gain
    own = 0.5 * time * time - time / gain - math.expm1(-gain * time) / gain**2
    return abs(math.sin(angle)) * acceleration * own


def reversal(axis: ServoAxis) -> tuple[float, float]:
    """Position error by Coulomb friction [mm]: step, and peak.

    At a reversal the torque changes by 2 Fc. A proportional velocity loop keeps 2 Fc/(Kp Kv), half
    of it to either side; an integral takes it away again, and what is left is the peak of
    ``2 Fc/(J s^3 + Kv (s + 1/Ti) (s + Kp))``, delays left out.
    """
    if min(axis.velocity_gain, axis.inertia, axis.gain) <= 0.0:
        return 0.0, 0.0
    scale = 2.0 * axis.friction * axis.travel / (2.0 * math.pi)
    if axis.velocity_time <= 0.0:
        step = scale / (axis.gain * axis.velocity_gain)
        return step, 0.5 * step
    kv, ti = axis.velocity_gain, axis.velocity_time
    poles = np.roots([axis.inertia, kv, kv * (axis.gain + 1.0 / ti), kv * axis.gain / ti])
    time = np.linspace(0.0, PEAK_LENGTH / float(-poles.real.max()), PEAK_STEPS)
    answer = np.zeros(PEAK_STEPS, dtype=complex)
    for i, p in enumerate(poles):
        rest = np.prod([p - q for j, q in enumerate(poles) if j != i])
        answer += np.exp(p * time) / (axis.inertia * rest)
    peak = scale * float(np.abs(answer.real).max())
    return peak, peak


def lost_motion_arc(radius: float, backlash: float) -> float:
    """Angle [rad] behind a quadrant at which a table behind a backlash stands: acos(1 - B/R)."""
    return math.acos(max(-1.0, 1.0 - backlash / radius))


def limited(command: Array, time: Array, axis: ServoAxis, torque: float) -> Array:
    """Position [mm] of a rigid axis without delays whose torque [N.m] is limited.

    ``J dv/dt = T - Fc sign(v) - Fv v`` with T of a PI velocity loop, within the limit, which asks
    for the speed ``Kp (c - x)``; its integral stands still while the torque is limited. Times are
    evenly spaced [s]; an infinite torque is no limit; of the axis all but period, delay and lag
    count.
    """
    step = float(time[1] - time[0])
    turn = 2.0 * math.pi / axis.travel
    rate = step / axis.velocity_time if axis.velocity_time > 0.0 else 0.0
    position, speed, integral = float(command[0]), 0.0, 0.0  # [mm], [rad/s], [N.m]
    out = []
    for goal in command.tolist():
        out.append(position)
        ask = axis.velocity_gain * (axis.gain * (goal - position) * turn - speed)
        if abs(ask + integral) <= torque:
            integral += rate * ask
        given = min(max(ask + integral, -torque), torque)
        free = speed + step / axis.inertia * (given - axis.viscous * speed)
        hold = step / axis.inertia * axis.friction
        speed = math.copysign(max(abs(free) - hold, 0.0), free)
        position += speed / turn * step
    return np.array(out)
