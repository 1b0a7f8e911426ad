"""A circle run both ways round, read as a ballbar is read.

The radial deviation at the angle a, in direction d = +1 counter-clockwise and -1 clockwise, is
fitted by least squares with

    m + x cos a + y sin a                       mean radius, centre
      + s cos 2a + q sin 2a                     scale along the axes, squareness: both ways alike
      + d g sin 2a                              mismatch of the gains: changes its sign
      + d (bx sign(sin a) cos a - by sign(cos a) sin a)/2        backlash: steps at the quadrants

on the samples that are not just behind a quadrant. There a table behind a backlash stands still
over acos(1 - B/R); what sticks out of that is a reversal spike.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.contour.arcs import TURN, Array
from motionfmu.analysis.contour.circles import CirclePass, CircularTest

# Angles behind each quadrant, in the direction of travel, and just before it that are left out of
# the fit and searched for spikes [rad].
SPIKE_BEHIND, SPIKE_BEFORE = math.radians(20.0), math.radians(2.0)
# A finding is named if it has this size at least [mm], and this share of the largest one.
NAMED_MIN, NAMED_SHARE = 0.5e-3, 0.1
# A spike must also be this many times the scatter of what the fit leaves.
SPIKE_SCATTER = 3.0
AXES = "XYZ"


@dataclass(frozen=True)
class Finding:
    """One part of the signature."""

    name: str  # mismatch, squareness, scale, backlash, spikes or centre
    size: float  # largest radial deviation it makes [mm]
    words: str  # what it is, how large, and its likely cause
    named: bool  # above the thresholds


@dataclass(frozen=True)
class Signature:
    """What a circle run both ways round tells.

    Attributes
    ----------
    test : CircularTest
    mean : float
        Mean radius minus nominal radius, of both ways [mm].
    findings : tuple of Finding
        The largest first.
    rest : float
        Root mean square of what the fit leaves [mm].
    """

    test: CircularTest
    mean: float
    findings: tuple[Finding, ...]
    rest: float

    def finding(self, name: str) -> Finding:
        """One finding by its name.

        Parameters
        ----------
        name : str
        """
        return next(f for f in self.findings if f.name == name)

    def words(self) -> list[str]:
        """The diagnosis, a sentence each, the largest first."""
        said = [f.words for f in self.findings if f.named]
        return said or [f"Nothing above {NAMED_MIN * 1e3:g} µm but the mean radius."]

    def numbers(self) -> dict[str, Any]:
        """Its numbers, ready for JSON; mm."""
        return {
            "radius": self.test.radius,
            "mean": self.mean,
            "rest": self.rest,
            "findings": [vars(f) for f in self.findings],
        }


@dataclass(frozen=True)
class FittedCircle:
    """The parts of the signature, fitted to a circle."""

    angle: Array  # (n,) [rad]
    way: Array  # (n,) 1 counter-clockwise, -1 clockwise
    deviation: Array  # (n,) [mm]
    used: NDArray[np.bool_]  # (n,) whether a sample is fitted: not just behind a quadrant
    columns: Array  # (n, 8) of the basis, with the backlash taken up behind the quadrants
    parts: Array  # (8,) m, x, y, s, q, g, bx, by [mm]

    @property
    def rest(self) -> Array:
        """What the parts leave of the deviation [mm]."""
        return self.deviation - self.columns @ self.parts


def fitted(test: CircularTest) -> FittedCircle:
    """Fit the parts of the signature; a ValueError if one way is missing."""
    if test.ccw is None or test.cw is None:
        raise ValueError("the signature needs a circle run both ways round")
    parts = [_samples(test.ccw, 1.0, test.radius), _samples(test.cw, -1.0, test.radius)]
    angle, way, deviation = (np.concatenate(p) for p in zip(*parts, strict=True))
    used = ~_behind_quadrant(angle, way)
    basis = _basis(angle, way)
    c = np.linalg.lstsq(basis[used], deviation[used], rcond=None)[0]
    for i, start in ((6, 0.0), (7, 0.25 * TURN)):
        since = np.mod(way * (angle - start), 0.5 * TURN)
        basis[:, i] *= _taken_up(since, test.radius, float(c[i]))
    return FittedCircle(angle, way, deviation, used, basis, c)


def signature(test: CircularTest, lag: float = 0.0) -> Signature:
    """Read the signature of a circle run both ways round.

    Parameters
    ----------
    test : CircularTest
        With both ways.
    lag : float
        Servo lag 1/Kp [s]. Axes that lag by different times also get different radii, which would
        look like a scale; with the lag known that part is counted to the mismatch.

    Raises
    ------
    ValueError
        One way is missing.
    """
    whole = fitted(test)
    angle, way, c, rest = whole.angle, whole.way, whole.parts, whole.rest
    scatter = float(np.sqrt(np.mean(rest[whole.used] ** 2)))
    assert test.ccw is not None
    turn = lag * test.ccw.speed / test.radius
    mean, x, y, scale, square, mismatch, bx, by = (float(v) for v in c)
    scale += mismatch * turn
    first, second = (AXES[int(np.argmax(np.abs(a)))] for a in test.axes)
    spikes = _spikes(angle, way, rest)
    found = [
        _mismatch(mismatch, test, (first, second)),
        _squareness(square, test.radius, (first, second)),
        _scale(scale, test.radius, (first, second)),
        _backlash((bx, by), (first, second)),
        _centre((x, y), (first, second)),
    ]
    found.append(_spike_words(spikes, (first, second)))
    largest = max(f[1] for f in found)
    least = max(NAMED_MIN, NAMED_SHARE * largest)
    findings = []
    for name, size, words in found:
        floor = max(least, SPIKE_SCATTER * scatter) if name == "spikes" else least
        findings.append(Finding(name, size, words, size >= floor))
    return Signature(test, mean, tuple(sorted(findings, key=lambda f: -f.size)), scatter)


def _samples(way: CirclePass, direction: float, radius: float) -> tuple[Array, Array, Array]:
    angle = np.arctan2(way.points[:, 1], way.points[:, 0])
    deviation = np.hypot(way.points[:, 0], way.points[:, 1]) - radius
    return angle, np.full(len(angle), direction), deviation


def _basis(angle: Array, way: Array) -> Array:
    cos, sin = np.cos(angle), np.sin(angle)
    columns = [
        np.ones_like(angle),
        cos,
        sin,
        np.cos(2.0 * angle),
        np.sin(2.0 * angle),
        way * np.sin(2.0 * angle),
        0.5 * way * np.sign(sin) * cos,
        -0.5 * way * np.sign(cos) * sin,
    ]
    return np.column_stack(columns)


def _taken_up(since: Array, radius: float, width: float) -> Array:
    """Goes from -1 to 1 while an axis takes up its backlash; `since` is the angle from reversal."""
    if width == 0.0:
        return np.ones_like(since)
    return np.clip(2.0 * radius * (1.0 - np.cos(since)) / abs(width) - 1.0, -1.0, 1.0)


def _since_quadrant(angle: Array, way: Array) -> Array:
    """Angle since the last quadrant in the direction of travel, 0 to pi/2 [rad]."""
    return np.mod(way * angle, 0.25 * TURN)


def _behind_quadrant(angle: Array, way: Array) -> NDArray[np.bool_]:
    since = _since_quadrant(angle, way)
    return (since < SPIKE_BEHIND) | (since > 0.25 * TURN - SPIKE_BEFORE)


def _spikes(angle: Array, way: Array, rest: Array) -> dict[tuple[int, int], float]:
    """Largest deviation behind each quadrant (0 to 3), by direction [mm]."""
    since = _since_quadrant(angle, way)
    found = {}
    for direction in (1, -1):
        for quadrant in range(4):
            start = np.mod(angle - way * since, TURN)  # where the quadrant was crossed
            there = np.round(start / (0.25 * TURN)).astype(int) % 4 == quadrant
            own = there & (way == direction) & (since < SPIKE_BEHIND)
            if own.any():
                values = rest[own]
                found[quadrant, direction] = float(values[np.argmax(np.abs(values))])
    return found


def _um(value: float) -> str:
    return f"{abs(value) * 1e3:.3g} µm"


def _mismatch(size: float, test: CircularTest, names: tuple[str, str]) -> tuple[str, float, str]:
    assert test.ccw is not None
    slow, fast = names if size > 0.0 else names[::-1]
    by = ""  # of a ballbar's record the speed may be unknown
    if test.ccw.speed > 0.0:
        by = f" by {2e3 * abs(size) / test.ccw.speed:.3g} ms"
    words = (
        f"Mismatch of the axes, {_um(size)}: an oval at 45° that turns with the direction of"
        f" travel. {slow} lags {fast}{by}: a lower position gain, or more"
        " delay; make both lags equal."
    )
    return "mismatch", abs(size), words


def _figures(x: float) -> str:
    """A number with three significant digits, without a power of ten."""
    return f"{float(f'{x:.3g}'):.10g}"


def _squareness(size: float, radius: float, names: tuple[str, str]) -> tuple[str, float, str]:
    angle = 2.0 * size / radius
    shown = _figures(abs(angle) * 1e6)
    more = "less" if angle > 0.0 else "more"
    words = (
        f"Squareness, {_um(size)}: an oval at 45° that is the same both ways round. {names[0]} and"
        f" {names[1]} stand at {more} than 90° by {shown} µrad: align the axes, or"
        " compensate."
    )
    return "squareness", abs(size), words


def _scale(size: float, radius: float, names: tuple[str, str]) -> tuple[str, float, str]:
    long, short = names if size > 0.0 else names[::-1]
    share = _figures(2e6 * abs(size) / radius)
    words = (
        f"Scale, {_um(size)}: an oval along the axes, the same both ways round. {long} travels"
        f" {_um(2.0 * size)} more over the radius than {short}, {share}"
        " µm/m: pitch of a screw, temperature, or pulses per mm."
    )
    return "scale", abs(size), words


def _backlash(widths: tuple[float, float], names: tuple[str, str]) -> tuple[str, float, str]:
    size = 0.5 * max(abs(w) for w in widths)
    each = ", ".join(f"{n} {_um(w)}" for n, w in zip(names, widths, strict=True))
    cause = (
        "play between encoder and table, wind-up, or friction with a velocity loop without integral"
        if max(widths, key=abs) > 0.0
        else "compensation of backlash that is too large"
    )
    sides = "inwards before, outwards behind" if max(widths, key=abs) > 0.0 else "the other way"
    words = f"Backlash, {each}: a step at the quadrants, {sides}. Likely {cause}."
    return "backlash", size, words


def _centre(offset: tuple[float, float], names: tuple[str, str]) -> tuple[str, float, str]:
    each = ", ".join(f"{n} {v * 1e3:+.3g} µm" for n, v in zip(names, offset, strict=True))
    words = f"Centre off by {each}: set-up of the test, rounding of the encoders, an offset."
    return "centre", math.hypot(*offset), words


def _spike_words(
    spikes: dict[tuple[int, int], float], names: tuple[str, str]
) -> tuple[str, float, str]:
    reversing = [0.0, 0.0]  # at 0 and 180 degrees the first axis reverses
    for (quadrant, _), value in spikes.items():
        reversing[quadrant % 2] = max(reversing[quadrant % 2], abs(value), key=abs)
    each = ", ".join(f"{n} {_um(v)}" for n, v in zip(names, reversing, strict=True))
    words = (
        f"Reversal spikes, {each}: short peaks behind the quadrants. Friction, until the integral"
        " of the velocity loop has turned; raise its gain, shorten its integral time."
    )
    return "spikes", max(reversing), words
