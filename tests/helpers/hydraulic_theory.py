"""The positioner on a hydraulic axis, worked out without its code: creep and processor."""

from itertools import pairwise

import numpy as np
from scipy.optimize import brentq

AREA, SUPPLY, TANK = 9.46e-4, 140e5, 2e5
LEAK_VALVE, LEAK_PISTON = 3e-13, 1e-12
ROUNDING, RATED_FLOW, RATED_DROP, LAMINAR = 2e-3, 1.667e-4, 35e5, 1e5
STRIBECK, VISCOUS, REST = 1e-2, 1000.0, 2e-4
COUNT = 5e-6  # [m]
BULK = 1.2e9  # [Pa]


def creep(stroke: float, overlap: float, coulomb: float, static: float) -> float:
    """Steady speed of a table on a spool that stands at a share of its stroke [m/s].

    Oil: A v = q(ps - pa) - q(pa - pt) - C p, p = pa - pb = friction(v)/A, pa + pb = ps + pt.
    """
    gain = RATED_FLOW / (1.0 - overlap) / np.sqrt(RATED_DROP)

    def opening(x: float) -> float:
        return 0.5 * (x + np.hypot(x, ROUNDING))

    def flow(opened: float, drop: float) -> float:
        return gain * opened * drop / (drop**2 + LAMINAR**2) ** 0.25 + LEAK_VALVE * drop

    def rest(v: float) -> float:
        level = coulomb + (static - coulomb) / (1.0 + (v / STRIBECK) ** 2)
        p = (v / np.hypot(v, REST) * level + VISCOUS * v) / AREA
        a = 0.5 * (SUPPLY + TANK + p)
        into = flow(opening(stroke - overlap), SUPPLY - a)
        out = flow(opening(-stroke - overlap), a - TANK)
        return float(into - out - LEAK_PISTON * p - AREA * v)

    return float(brentq(rest, -0.3, 0.3, xtol=1e-12))


def speed_under(stroke: float, overlap: float, force: float) -> float:
    """Speed of a table without friction and leakage, a force pushing it on [m/s]."""
    gain = RATED_FLOW / (1.0 - overlap) / np.sqrt(RATED_DROP)
    drops = AREA * (SUPPLY - TANK) + force
    return float(gain * (stroke - overlap) * np.sqrt(drops / (2.0 * AREA**3)))


def oil_and_mass(
    volumes: tuple[float, float], mass: float, leak: float, edges: float, viscous: float
) -> tuple[float, float]:
    """Natural frequency [rad/s] and damping ratio of a mass between two chambers of oil.

    Exact for equal volumes, else to the first order of the damping.

    Parameters
    ----------
    volumes : tuple of float
        Oil in the chambers [m3], whose pistons have `AREA`.
    mass, viscous : float
        [kg], [N.s/m]
    leak, edges : float
        Slopes of the flow past the piston and out of each chamber [m3/s/Pa].
    """
    each = [BULK / v for v in volumes]
    both = sum(each)
    omega = np.sqrt(both * (AREA**2 + viscous * (leak + edges / 2.0)) / mass)
    decay = viscous / mass + both * leak + sum(x * x for x in each) / both * edges
    return float(omega), float(decay / (2.0 * omega))


def largest_gain(
    oil: tuple[float, float], valve: tuple[float, float], lags: tuple[float, ...], dead: float
) -> tuple[float, float]:
    """Velocity gain at which the loop rings, and at which frequency [1/s], [rad/s].

    K e^(-s dead)/s behind oil and mass, the valve's spool (frequency and damping ratio each) and
    first-order lags [s].
    """

    def behind(omega: float) -> complex:
        value = np.exp(1j * omega * dead)
        for frequency, damping in (oil, valve):
            x = omega / frequency
            value *= 1.0 - x * x + 2j * damping * x
        return complex(value * np.prod([1.0 + 1j * omega * lag for lag in lags]))

    def phase(omega: float) -> float:
        grid = np.linspace(0.0, omega, 200)
        return float(np.unwrap(np.angle([behind(w) for w in grid]))[-1] - 0.5 * np.pi)

    omega = float(brentq(phase, 1.0, 1.5 * oil[0]))
    return omega * abs(behind(omega)), omega


def left_by_p(kc: float, friction: tuple[float, float, float]) -> int:
    """Error that P leaves, every command giving its steady speed at once [counts].

    TRACK goes to 5000 counts at 4000 counts/s and 40000 counts/s2 from 0.12 s on; looked at at
    3.2 s. A count is the place to the nearest; the timer has 1 ms.

    Parameters
    ----------
    kc : float
        [PWM counts/count], 2000 of them for 20 V.
    friction : tuple of float
        Overlap [1], coulomb and static friction [N].
    """
    speed: dict[int, float] = {}
    place = 0.0  # [counts]
    error = 0
    for tick in range(120, 3200):
        track = 5000.0 - travel(1.47 - 1e-3 * tick) if tick > 795 else travel(1e-3 * tick - 0.12)
        error = int(np.floor(track)) - int(np.floor(place + 0.5))
        pwm = int(np.floor(kc * error + 0.5))
        if pwm not in speed:
            speed[pwm] = creep(pwm / 1000.0, *friction) / COUNT
        place += speed[pwm] * 1e-3
    return error


def travel(time: float) -> float:
    """Distance that TRACK covers from rest [counts]."""
    time = max(time, 0.0)
    return 20000.0 * time**2 if time < 0.1 else 4000.0 * (time - 0.05)


# The listing forwards, as written and repaired: flags in the order of its tests; clocks from
# acceptance to what is done, with a low and a high level where they differ.
TEST = (10, 16, 23, 30)
DROP = (16, 22, 30, 37)  # repaired: the flag that is served
LEVEL = {False: (17, 23, 29, 36), True: (21, 27, 34, 41)}
CLEAR = ((31, 33), (37, 39), (43, 45), (50, 50))  # as written: all flags
END = {
    False: ((36, 38), (42, 44), (48, 50), (55, 55)),
    True: ((36, 38), (42, 44), (49, 51), (56, 56)),
}
FORWARDS = (0, 1, 1, 0)  # level at the pin
ENTERED = {2: 0, 0: 1, 3: 2, 1: 3}  # flag of the edge into a quarter; the pins are inverted
PINS = ((1, 0, 0, 1), (0, 0, 1, 1))  # PGB where A changed, PGA where B did, over the quarters


def edges(phase: np.ndarray, clocks: int) -> list[tuple[int, int]]:
    """Clock and quarter entered of each edge of a rising phase, straight between instants."""
    found = []
    for k, (p, q) in enumerate(pairwise(4.0 * phase)):
        for edge in range(int(np.floor(p)) + 1, int(np.floor(q)) + 1):
            after = max(1, int(np.ceil((edge - p) / (q - p) * clocks)))
            found.append((clocks * k + after, edge))
    return found


def uniform(speed: float, clock: float, seconds: float) -> list[tuple[int, int]]:
    """The edges of a uniform motion at a speed [counts/s], for a processor's clock [Hz]."""
    return [(int(np.ceil(k / speed * clock)), k) for k in range(1, int(seconds * speed))]


def served(
    steps: list[tuple[int, int]], period: int, cycles: int, repaired: bool
) -> tuple[int, int]:
    """Edges lost and turned by the port's routine, which the timer's keeps waiting.

    Parameters
    ----------
    steps : list of (int, int)
        Clock and quarter of each edge.
    period, cycles : int
        [clocks] timer, its routine.
    repaired : bool
        The routine clears the flag that it serves, else all of them in the end.
    """
    clocks = [clock for clock, _ in steps]
    flags = set[int]()
    lost = turned = timers = now = seen = 0

    def advance(to: int) -> None:
        nonlocal seen, lost
        while seen < len(steps) and clocks[seen] <= to:
            flag = ENTERED[steps[seen][1] % 4]
            lost += flag in flags
            flags.add(flag)
            seen += 1

    while seen < len(steps):
        timer = period * (timers + 1)
        if not flags and timer > now:
            now = min(clocks[seen], timer)
        advance(now)
        if timer <= now:
            timers += 1
            now += 6 + cycles
            advance(now)
            continue
        for flag in range(4):
            advance(now + TEST[flag])
            if flag in flags:
                break
        if repaired:
            advance(now + DROP[flag])
            flags.remove(flag)
        advance(now + LEVEL[repaired][flag])
        level = PINS[flag // 2][steps[seen - 1][1] % 4]
        turned += level != FORWARDS[flag]
        if not repaired:
            advance(now + CLEAR[flag][level])
            lost += len(flags) - 1
            flags.clear()
        now += END[repaired][flag][level]
        advance(now)
    return lost, turned
