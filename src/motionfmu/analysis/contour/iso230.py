"""Fits and quantities of the circular test (ISO 230-4)."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.contour.arcs import EPS, Array
from motionfmu.analysis.contour.kinds import BothWays, CircleFigures
from motionfmu.analysis.contour.segments import Index
from motionfmu.base.order import distinct, quantiles

# Gauss and Newton's method and its minimax form square the error in each round if points lie near a
# circle; six rounds lead from 1 % to rounding. Odd shapes may take more.
ROUNDS_MAX = 50
# A centre is found when it moves by less than this part of the radius.
MOVE_DONE = 1e-13
# The minimax fit begins with the extreme points of so many parts of the points.
PARTS = 64
# A point outside a zone by less than this part of its width counts as inside.
ZONE_DONE = 1e-10
# An exchange is one of at most so many points: far more than any shape needs.
EXCHANGES_MAX = 1000
# Number of corrections of a least squares solution; each squares the error of the normal equations.
CORRECTIONS = 2


@dataclass(frozen=True)
class Zone:
    """Two concentric circles that enclose all points."""

    centre: tuple[float, float]  # [mm]
    inner: float  # radius [mm]
    outer: float  # radius [mm]

    @property
    def width(self) -> float:
        """Radial separation [mm]."""
        return self.outer - self.inner


@dataclass(frozen=True)
class Ellipse:
    """An ellipse in the plane of a circle."""

    centre: tuple[float, float]  # [mm]
    major: float  # semi-axis [mm]
    minor: float  # semi-axis [mm]
    orientation: float  # of the major axis from the plane's first axis, -pi/2 to pi/2 [rad]


def _normal(rows: Array) -> Array:
    """Sums (k, k) of products of rows (k, n)."""
    # no matrix products, for a library with threads is slower with so few rows
    found = np.empty((len(rows), len(rows)))
    for i, row in enumerate(rows):
        for j in range(i, len(rows)):
            found[i, j] = found[j, i] = np.einsum("n,n->", row, rows[j])
    return found


def _sums(rows: Array, values: Array) -> Array:
    """Sums (k,) of rows (k, n) times values (n,)."""
    return np.array([np.einsum("n,n->", row, values) for row in rows])


def least_squares(rows: Array, values: Array) -> Array:
    """Solve rows (k, n) @ x = values (n,) for x (k,) with the least sum of squares.

    It is found by the normal equations, which take one pass over the samples, and corrected by the
    residuals, because the condition of these equations loses digits.
    """
    normal = _normal(rows)
    found = np.linalg.solve(normal, _sums(rows, values))
    for _ in range(CORRECTIONS):
        rest = values - sum(x * row for x, row in zip(found, rows, strict=True))
        found = found + np.linalg.solve(normal, _sums(rows, rest))
    return np.asarray(found)


def least_squares_circle(points: Array) -> tuple[Array, float]:
    """Centre (2,) and radius of the circle with the least sum of squared radial distances from
    points (n, 2), three at least and not on a straight line [mm].

    Gauss and Newton's steps end where the residuals are orthogonal to the slopes, whatever solves
    for them: the normal equations of the first round serve all, and are not corrected.
    """
    origin = points.mean(axis=0)
    x, y = np.ascontiguousarray((points - origin).T)
    # to unit size, so that all three weigh the same
    square = x * x + y * y
    size = float(np.sqrt(square.mean()))
    rows = np.stack([x / size, y / size, np.ones(len(points))])
    centre = 0.5 * np.linalg.solve(_normal(rows), _sums(rows, square / size))[:2]
    normal = None
    for _ in range(ROUNDS_MAX):
        np.subtract(x, centre[0], out=rows[0])
        np.subtract(y, centre[1], out=rows[1])
        radii = np.sqrt(rows[0] ** 2 + rows[1] ** 2)
        rows[:2] /= radii
        mean = float(radii.mean())
        normal = _normal(rows) if normal is None else normal
        step = np.linalg.solve(normal, _sums(rows, radii - mean))
        centre = centre + step[:2]
        if np.abs(step[:2]).max() <= MOVE_DONE * mean:
            break
    return centre + origin, float(_radii(points, centre + origin).mean())


def minimum_zone(points: Array, circle: tuple[Array, float] | None = None) -> Zone:
    """Two concentric circles of least radial separation, about points (n, 2) [mm].

    The points lie all round or at least over half a circle; `circle` is the least-squares one. The
    zone of a few extreme points is found, then points outside it are added, until it holds all of
    them. It is the least zone of all points then, being that of some.
    """
    centre, _ = circle or least_squares_circle(points)
    radii = _radii(points, centre)
    chosen = _extremes(radii, np.ones(len(points), dtype=bool))
    floor = 4.0 * EPS * (float(radii.max()) + float(np.abs(points).max()))
    while True:
        few = _zone_of_few(points[chosen], centre, floor)
        centre = np.array(few.centre)
        radii = _radii(points, centre)
        low, high = float(radii.min()), float(radii.max())
        slack = ZONE_DONE * few.width + floor
        out = (radii < few.inner - slack) | (radii > few.outer + slack)
        out[chosen] = False
        if not out.any():
            return Zone(few.centre, low, high)
        chosen = distinct(np.concatenate([chosen, _extremes(radii, out)]))


def _extremes(radii: Array, of: NDArray[np.bool_]) -> Index:
    """The nearest and the farthest point of each of `PARTS` parts of the points."""
    rows = np.flatnonzero(of)
    cuts = distinct(np.linspace(0, len(rows), PARTS + 1).astype(int))
    found = []
    for a, b in zip(cuts[:-1].tolist(), cuts[1:].tolist(), strict=True):
        own = radii[rows[a:b]]
        found += [a + int(own.argmin()), a + int(own.argmax())]
    return distinct(rows[found])


def _radii(points: Array, centre: Array) -> Array:
    x, y = points[:, 0] - centre[0], points[:, 1] - centre[1]
    return np.asarray(np.sqrt(x * x + y * y))


def _zone_of_few(points: Array, centre: Array, floor: float) -> Zone:
    """The least zone of few points.

    Each round linearises the radii about the present centre and finds the minimax step: least h
    with ``|r_i - u_i . dc - R| <= h`` over dc and R. For points near a circle, as here, the problem
    is convex but for terms of the order of deviation over radius, and the rounds converge
    quadratically to the one minimum.
    """
    best = _zone_about(points, centre)
    for _ in range(ROUNDS_MAX):
        if best.width <= floor:
            break
        gap = points - centre
        radii = _radii(points, centre)
        middle = 0.5 * (best.inner + best.outer)
        rows = np.column_stack([gap / radii[:, None], np.ones(len(points))])
        step = best.width * minimax(rows, (radii - middle) / best.width)[:2]
        trial = _zone_about(points, centre + step)
        if not trial.width < best.width:
            break
        gain = best.width - trial.width
        centre, best = centre + step, trial
        if gain <= ZONE_DONE * best.width:
            break
    return best


def _zone_about(points: Array, centre: Array) -> Zone:
    radii = _radii(points, centre)
    return Zone((float(centre[0]), float(centre[1])), float(radii.min()), float(radii.max()))


def minimax(rows: Array, values: Array) -> Array:
    """The x (3,) with the least largest ``|values - rows @ x|``; rows are (n, 3): cos, sin, 1.

    Exchange after Stiefel, which is the dual simplex method: four points at a time, with signs such
    that no x is better for all four. The point that the x of these four misses most takes the place
    of the one that keeps this so; the largest miss of the four grows each time, up to that of all.
    """
    angle = np.arctan2(rows[:, 1], rows[:, 0])
    order = np.argsort(angle)
    # For four directions round the circle whose signs alternate no x is better.
    ends = np.searchsorted(angle[order], quantiles(distinct(angle), (0.0, 0.34, 0.67, 1.0)))
    four = order[ends]
    sign = np.array([1.0, -1.0, 1.0, -1.0])
    up = np.array([0.0, 0.0, 0.0, 1.0])
    for _ in range(EXCHANGES_MAX):
        table = np.column_stack([sign[:, None] * rows[four], np.ones(4)])
        found = np.linalg.solve(table, sign * values[four])
        rest = values - rows @ found[:3]
        worst = int(np.argmax(np.abs(rest)))
        if abs(rest[worst]) <= found[3] + 1e-13:
            return np.asarray(found[:3])
        side = math.copysign(1.0, rest[worst])
        both = np.linalg.solve(table.T, np.column_stack([up, [*(side * rows[worst]), 1.0]]))
        weight, part = both.T
        ratio = np.divide(weight, part, out=np.full(4, np.inf), where=part > EPS)
        leaves = int(np.argmin(ratio))
        four[leaves], sign[leaves] = worst, side
    raise ArithmeticError(f"minimum zone: not found in {EXCHANGES_MAX} exchanges")


def fit_ellipse(points: Array, circle: tuple[Array, float] | None = None) -> Ellipse:
    """Ellipse by least squares through points (n, 2) [mm] near a circle, five at least, all round.

    The general conic ``a x^2 + b xy + c y^2 + d x + e y = 1`` about the least-squares circle,
    scaled to unit size: exact for points on an ellipse, and for small deviations the same as the
    second harmonic of the radius.
    """
    origin, radius = circle or least_squares_circle(points)
    x, y = np.ascontiguousarray(((points - origin) / radius).T)
    rows = np.stack([x * x, x * y, y * y, x, y])
    a, b, c, d, e = least_squares(rows, np.ones(len(points)))
    form = np.array([[a, 0.5 * b], [0.5 * b, c]])
    middle = np.linalg.solve(form, -0.5 * np.array([d, e]))
    level = 1.0 + middle @ form @ middle
    values, vectors = np.linalg.eigh(form)
    if values[0] <= 0.0:
        raise ArithmeticError("the points lie on no ellipse")
    major, minor = np.sqrt(level / values) * radius
    direction = vectors[:, 0]
    orientation = math.atan2(direction[1], direction[0])
    orientation -= math.pi * round(orientation / math.pi)
    centre = origin + radius * middle
    return Ellipse((float(centre[0]), float(centre[1])), float(major), float(minor), orientation)


def reading(points: Array, radius: float) -> CircleFigures:
    """Quantities of one directed path (n, 2) from the nominal centre, in the plane's axes [mm]."""
    circle = least_squares_circle(points)
    centre, mean = circle
    about_nominal = _radii(points, np.zeros(2)) - radius
    about_own = _radii(points, centre) - radius
    ellipse = fit_ellipse(points, circle)
    return CircleFigures(
        g=minimum_zone(points, circle).width,
        g_least_squares=float(np.ptp(about_own)),
        f_max=float(about_nominal.max()),
        f_min=float(about_nominal.min()),
        f_max_centred=float(about_own.max()),
        f_min_centred=float(about_own.min()),
        radius_change=mean - radius,
        radius_change_nominal=float(about_nominal.mean()),
        offset=(float(centre[0]), float(centre[1])),
        major_change=ellipse.major - radius,
        minor_change=ellipse.minor - radius,
        orientation=ellipse.orientation,
    )


def both_ways(first: Array, second: Array, radius: float) -> BothWays:
    """Quantities of two opposite paths (n, 2), (m, 2) from the nominal centre [mm]."""
    points = np.concatenate([first, second])
    circle = least_squares_circle(points)
    centre, _ = circle

    def mean(path: Array, about: Array) -> float:
        return float(_radii(path, about).mean())

    nominal = np.zeros(2)
    return BothWays(
        g=minimum_zone(points, circle).width,
        d=0.5 * (mean(first, centre) + mean(second, centre)) - radius,
        d_nominal=0.5 * (mean(first, nominal) + mean(second, nominal)) - radius,
    )
