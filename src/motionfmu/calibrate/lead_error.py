"""Backlash, scale and the wave of a screw in a positioning test.

The mean deviation of both directions at the target x is fitted by least squares with

    m(x) = c + slope x + amplitude sin(2 pi x/period + phase)

and the reversal value, downwards less upwards, with the backlash b: behind a gap a table stops b/2
short of its target from either side. What m leaves at the targets counts as the deviation of one
of them, because approaches of one target are no news of the others.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar
from scipy.stats import f as f_distribution

from motionfmu.analysis.positioning import PositioningTest
from motionfmu.calibrate.estimate import Estimate

Array = NDArray[np.float64]
# A wave is told where chance gives one as good with this probability at most.
CHANCE = 0.01
# Another period is no explanation if it leaves more than this quantile of the F distribution.
OTHER = 0.95
# Frequencies tried in the width of a peak, and how far above the mean spacing's own limit where
# targets are unevenly spaced.
PER_PEAK, BEYOND = 20, 4.0
# Spacings that differ by less than this share are even, and waves shorter than two hide.
EVEN = 0.01
# Deviations of a reading that is exact [mm].
GRAIN = 1e-7


@dataclass(frozen=True)
class LeadError:
    """Parts of the positioning error of an axis.

    Attributes
    ----------
    test : PositioningTest
        [mm]
    backlash, offset, amplitude, period : Estimate
        [mm]
    slope : Estimate
        Error of the travel per travel [1].
    phase : Estimate
        Of the wave at 0 [rad].
    rest : float
        Root mean square of what the fit leaves of the mean deviations [mm].
    shortest : float
        The shortest period that these targets could tell [mm].
    """

    test: PositioningTest
    backlash: Estimate
    offset: Estimate
    slope: Estimate
    amplitude: Estimate
    period: Estimate
    phase: Estimate
    rest: float
    shortest: float

    def mean(self, x: Array) -> Array:
        """The fitted mean deviation of both directions [mm].

        Parameters
        ----------
        x : ndarray
            Places [mm].
        """
        found = self.offset.value + self.slope.value * x
        if self.amplitude.told:
            turn = 2.0 * math.pi * x / self.period.value + self.phase.value
            found = found + self.amplitude.value * np.sin(turn)
        return np.asarray(found, float)

    def numbers(self) -> dict[str, Any]:
        """Its numbers, ready for JSON."""
        names = ("backlash", "offset", "slope", "amplitude", "period", "phase")
        found: dict[str, Any] = {n: getattr(self, n).numbers() for n in names}
        up, down = self.test.means
        known = {"targets": self.test.targets, "up": up, "down": down}
        found |= {k: v.tolist() for k, v in known.items()}
        spread = np.maximum(*self.test.spreads) / math.sqrt(len(self.test.up))
        return found | {
            "deviation_of_means": spread.tolist(),
            "rest": self.rest,
            "shortest": self.shortest,
            "iso230_2": self.test.figures(),
        }


def lead_error(test: PositioningTest) -> LeadError:
    """Find the parts of an axis' positioning error.

    Parameters
    ----------
    test : PositioningTest
        [mm], three targets at least.

    Returns
    -------
    LeadError
    """
    x = test.targets
    both = np.array(test.means)
    mean, reversal = both.mean(axis=0), both[1] - both[0]
    plain = _Wave(x, mean, None)
    found, why = _searched(x, mean, plain)
    best = found or plain
    values, deviations = best.solved()
    spread = math.hypot(float(reversal.std(ddof=1)), GRAIN) / math.sqrt(len(x))
    backlash = Estimate(float(reversal.mean()), spread, "mm")
    wave = [Estimate(0.0, math.inf, unit, why or "-") for unit in ("mm", "mm", "rad")]
    if found is not None:
        wave = [
            Estimate(v, s, unit)
            for v, s, unit in zip(values[2:], deviations[2:], ("mm", "mm", "rad"), strict=True)
        ]
    amplitude, period, phase = wave
    return LeadError(
        test=test,
        backlash=backlash,
        offset=Estimate(values[0], deviations[0], "mm"),
        slope=Estimate(values[1], deviations[1], "1"),
        amplitude=amplitude,
        period=period,
        phase=phase,
        rest=math.sqrt(best.left / len(x)),
        shortest=1.0 / _highest(x),
    )


class _Wave:
    """Least squares of a line, and of a wave of one frequency [1/mm] where there is one."""

    def __init__(self, x: Array, y: Array, frequency: float | None) -> None:
        self.x, self.y, self.frequency = x, y, frequency
        columns = [np.ones_like(x), x]
        if frequency is not None:
            turn = 2.0 * math.pi * frequency * x
            columns += [np.sin(turn), np.cos(turn)]
        self.basis = np.column_stack(columns)
        self.c = np.linalg.lstsq(self.basis, y, rcond=None)[0]
        self.left = float(np.sum((y - self.basis @ self.c) ** 2))

    def solved(self) -> tuple[list[float], list[float]]:
        """Offset and slope, with a wave amplitude, period and phase; and their deviations."""
        columns, c = self.basis, [float(v) for v in self.c]
        values = c[:2]
        turns = np.eye(2)
        if self.frequency is not None:
            f = self.frequency
            angle = 2.0 * math.pi * f * self.x
            by_f = 2.0 * math.pi * self.x * (c[2] * np.cos(angle) - c[3] * np.sin(angle))
            columns = np.column_stack([columns, by_f])
            size = math.hypot(c[2], c[3])
            values += [size, 1.0 / f, math.atan2(c[3], c[2])]
            turns = np.zeros((5, 5))
            turns[:2, :2] = np.eye(2)
            turns[2, 2:4] = c[2] / size, c[3] / size
            turns[3, 4] = -1.0 / f**2
            turns[4, 2:4] = -c[3] / size**2, c[2] / size**2
        free = max(len(self.x) - columns.shape[1], 1)
        variance = self.left / free + GRAIN**2
        scale = np.linalg.norm(columns, axis=0)
        cover = np.linalg.pinv((columns / scale).T @ (columns / scale)) / np.outer(scale, scale)
        cover = variance * turns @ cover @ turns.T
        return values, [float(v) for v in np.sqrt(np.diag(cover))]


def _highest(x: Array) -> float:
    """The highest frequency that targets can tell [1/mm]."""
    steps = np.diff(x)
    even = float(np.ptp(steps)) < EVEN * float(steps.mean())
    return float((1.0 if even else BEYOND) * 0.5 / steps.mean())


def _searched(x: Array, y: Array, plain: _Wave) -> tuple[_Wave | None, str]:
    """The wave that explains what a line leaves; None with the reason."""
    span, free = float(np.ptp(x)), len(x) - 5
    if free < 1:
        return None, f"{len(x)} targets: six at least for a wave"
    width, high = 1.0 / span, _highest(x)
    tried = np.arange(width, high * (1.0 + 1e-9), width / PER_PEAK)
    if not len(tried):
        return None, "the targets are too few for a wave"
    left = np.array([_Wave(x, y, f).left for f in tried.tolist()])
    best = _refined(x, y, float(tried[np.argmin(left)]), (width, high))
    exact = len(x) * GRAIN**2
    gain = (plain.left - best.left) / 3.0 / ((best.left + exact) / free)
    chance = float(f_distribution.sf(gain, 3, free)) * max(1.0, high * span)
    if chance > CHANCE:
        return None, f"none stands out: chance makes one as good in {100 * min(chance, 1):.0f} %"
    assert best.frequency is not None
    far = np.abs(tried - best.frequency) > width
    if far.any():
        other = _refined(x, y, float(tried[far][np.argmin(left[far])]), (width, high))
        assert other.frequency is not None
        level = float(f_distribution.ppf(OTHER, free, free))
        apart = abs(other.frequency - best.frequency) > width
        if apart and other.left + exact < level * (best.left + exact):
            both = f"{1.0 / best.frequency:.4g} and {1.0 / other.frequency:.4g} mm"
            return None, f"waves of {both} explain these targets alike"
    return best, ""


def _refined(x: Array, y: Array, frequency: float, ends: tuple[float, float]) -> _Wave:
    """The wave nearest to a frequency tried that leaves least."""
    half = 1.0 / (PER_PEAK * float(np.ptp(x)))
    low, high = max(ends[0], frequency - half), min(ends[1], frequency + half)
    if high <= low:
        return _Wave(x, y, frequency)
    found = minimize_scalar(
        lambda f: _Wave(x, y, float(f)).left,
        bounds=(low, high),
        method="bounded",
        options={"xatol": 1e-9 * frequency},
    )
    return _Wave(x, y, float(found.x))
