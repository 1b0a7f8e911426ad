"""Squareness, scales and backlash of two axes in a circle run both ways round (ISO 230-4).

They are parts of a ballbar's signature (`motionfmu.analysis.explain.ballbar`), with deviations. A
squareness of s more than 90° is q = -s R/2, and scales of the two axes that differ by d are R d/2.
What changes its sign with the direction (lag, gains) is no geometry.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.contour.circles import CircularTest
from motionfmu.analysis.explain.ballbar import FittedCircle, fitted
from motionfmu.calibrate.estimate import Estimate

Array = NDArray[np.float64]
# Residuals forget themselves at the latest within this share of a way round.
LONGEST = 0.1
SAMPLES = 4000  # of both ways that deviations are taken of
# A ballbar that is exact [mm].
GRAIN = 1e-7
MEAN, X, Y, SCALE, SQUARE, MISMATCH, BX, BY = range(8)


@dataclass(frozen=True)
class CircleErrors:
    """Geometry of two axes.

    Attributes
    ----------
    test : CircularTest
    plane : str
        ``XY``, ``ZX`` or ``YZ``.
    squareness : Estimate
        Angle between the positive directions less 90° [rad].
    scale : Estimate
        Travel per travel of the first axis more than of the second [1].
    backlash : tuple of Estimate
        Of both axes [mm].
    mismatch : Estimate
        What of the oval at 45° turns with the direction: gains and delays [mm].
    radius : Estimate
        Mean radius less the nominal one [mm].
    centre : tuple of Estimate
        [mm]
    fit : FittedCircle
    """

    test: CircularTest
    plane: str
    squareness: Estimate
    scale: Estimate
    backlash: tuple[Estimate, Estimate]
    mismatch: Estimate
    radius: Estimate
    centre: tuple[Estimate, Estimate]
    fit: FittedCircle

    @property
    def left(self) -> float:
        """Root mean square that the fit leaves [mm]."""
        return float(np.sqrt(np.mean(self.fit.rest[self.fit.used] ** 2)))

    def numbers(self) -> dict[str, Any]:
        """Its numbers, ready for JSON."""
        names = ("squareness", "scale", "mismatch", "radius")
        found: dict[str, Any] = {n: getattr(self, n).numbers() for n in names}
        for name in ("backlash", "centre"):
            two = getattr(self, name)
            found[name] = {a: e.numbers() for a, e in zip(self.plane, two, strict=True)}
        return found | {"nominal": self.test.radius, "rest": self.left}


def circle_errors(test: CircularTest, plane: str, lag: float = 0.0) -> CircleErrors:
    """Find the geometry of two axes in a circular test.

    Parameters
    ----------
    test : CircularTest
        With both ways.
    plane : str
        ``XY``, ``ZX`` or ``YZ``.
    lag : float
        Servo lag [s]: axes that lag by different times get different radii, too.

    Returns
    -------
    CircleErrors

    Raises
    ------
    ValueError
        One way is missing.
    """
    fit = fitted(test)
    cover = _covariance(fit)
    assert test.ccw is not None
    turn = lag * test.ccw.speed / test.radius

    def part(weights: dict[int, float], unit: str = "mm") -> Estimate:
        w = np.zeros(8)
        w[list(weights)] = list(weights.values())
        return Estimate(float(w @ fit.parts), math.sqrt(max(float(w @ cover @ w), 0.0)), unit)

    each = 2.0 / test.radius
    return CircleErrors(
        test,
        plane,
        part({SQUARE: -each}, "rad"),
        part({SCALE: each, MISMATCH: each * turn}, "1"),
        (part({BX: 1.0}), part({BY: 1.0})),
        part({MISMATCH: 1.0}),
        part({MEAN: 1.0}),
        (part({X: 1.0}), part({Y: 1.0})),
        fit,
    )


def _covariance(fit: FittedCircle) -> Array:
    """Of the parts, with residuals that go on over many samples (Newey and West 1987)."""
    every = max(1, len(fit.used) // SAMPLES)  # samples beside these are no news
    used = fit.used[::every]
    columns = np.where(used[:, None], fit.columns[::every], 0.0)
    rest = np.where(used, fit.rest[::every], 0.0)
    count = int(used.sum())
    inverse = np.linalg.pinv(columns.T @ columns)
    most = max(1, int(LONGEST * len(rest) / 2))
    scores = columns * rest[:, None]
    meat = scores.T @ scores + GRAIN**2 * columns.T @ columns
    power = float(rest @ rest) + 1e-300
    for lag in range(1, most + 1):
        if float(rest[lag:] @ rest[:-lag]) / power < 2.0 / math.sqrt(count):
            break
        cross = scores[lag:].T @ scores[:-lag]
        meat += (1.0 - lag / (most + 1)) * (cross + cross.T)
    loose = count / max(count - len(fit.parts), 1)
    return np.asarray(loose * inverse @ meat @ inverse)
