"""Fits and quantities of the circular test (ISO 230-4)."""

import math
from dataclasses import dataclass

import numpy as np

from motionfmu.contour.geometry import Array

# Gauss-Newton and its minimax kin square the error each round when the points lie near a circle;
# six rounds go from 1 % to rounding. More are allowed for odd shapes.
ROUNDS_MAX = 50
# A centre is found when it moves by less than this part of the radius.
MOVE_DONE = 1e-13
# Constraints added per round of the minimax fit, at least.
SECTORS = 64
# HiGHS keeps constraints to 1e-7 of their scale; here scaled so that the zone's width is near 1.
ZONE_DONE = 1e-6


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


def least_squares_circle(points: Array) -> tuple[Array, float]:
    """Centre (2,) and radius of the circle with the least sum of squared radial distances from
    points (n, 2), three at least and not on a straight line [mm].
    """
    origin = points.mean(axis=0)
    shifted = points - origin
    matrix = np.column_stack([2.0 * shifted, np.ones(len(points))])
    solution = np.linalg.lstsq(matrix, np.sum(shifted**2, axis=1), rcond=None)[0]
    centre = solution[:2]
    for _ in range(ROUNDS_MAX):
        gap = shifted - centre
        radii = np.hypot(gap[:, 0], gap[:, 1])
        matrix = np.column_stack([gap / radii[:, None], np.ones(len(points))])
        step = np.linalg.lstsq(matrix, radii, rcond=None)[0]
        centre = centre + step[:2]
        if np.abs(step[:2]).max() <= MOVE_DONE * float(radii.mean()):
            break
    gap = shifted - centre
    return centre + origin, float(np.hypot(gap[:, 0], gap[:, 1]).mean())


def minimum_zone(points: Array) -> Zone:
    """Two concentric circles of least radial separation, about points (n, 2) [mm].

    They lie all round or at least over half a circle. Each round linearises the radii about the
    present centre and finds the minimax step by linear programming: least h with
    ``|r_i - u_i . dc - R| <= h`` over dc and R. Only the points that bind are given to the program;
    those that its solution violates are added until there are none. For points near a circle, as
    here, the problem is convex but for terms of the order of deviation over radius, and the rounds
    converge quadratically to the one minimum.
    """
    centre, radius = least_squares_circle(points)
    best = _zone_about(points, centre)
    floor = 4.0 * float(np.finfo(float).eps) * (radius + float(np.abs(points).max()))
    for _ in range(ROUNDS_MAX):
        if best.width <= floor:
            break
        step = _minimax_step(points - centre, best.width)
        trial = _zone_about(points, centre + step)
        if not trial.width < best.width:
            break
        gain = best.width - trial.width
        centre, best = centre + step, trial
        if gain <= ZONE_DONE**2 * best.width:
            break
    return best


def _zone_about(points: Array, centre: Array) -> Zone:
    radii = np.hypot(points[:, 0] - centre[0], points[:, 1] - centre[1])
    return Zone((float(centre[0]), float(centre[1])), float(radii.min()), float(radii.max()))


def _minimax_step(gap: Array, scale: float) -> Array:
    from scipy.optimize import linprog  # takes longer to import than most commands

    radii = np.hypot(gap[:, 0], gap[:, 1])
    unit = gap / radii[:, None]
    middle = 0.5 * (float(radii.min()) + float(radii.max()))
    size = (radii - middle) / scale
    sector = np.floor((np.arctan2(gap[:, 1], gap[:, 0]) / math.tau + 0.5) * SECTORS)
    order = np.lexsort((size, sector))
    ends = np.flatnonzero(np.diff(sector[order], prepend=-1.0, append=SECTORS + 1.0))
    chosen = np.unique(np.concatenate([order[ends[:-1]], order[ends[1:] - 1]]))
    while True:
        u, s = unit[chosen], size[chosen]
        one = np.ones(len(chosen))
        # s - u.x - R <= h and -(s - u.x - R) <= h over x (2), R, h
        rows = np.vstack([np.column_stack([-u, -one, -one]), np.column_stack([u, one, -one])])
        free = (None, None)
        answer = linprog(
            [0.0, 0.0, 0.0, 1.0],
            A_ub=rows,
            b_ub=np.concatenate([-s, s]),
            bounds=[free, free, free, (0.0, None)],
        )
        if not answer.success:
            raise ArithmeticError(f"minimum zone: {answer.message}")
        rest = np.abs(size - unit @ answer.x[:2] - answer.x[2])
        over = rest > answer.x[3] + ZONE_DONE
        over[chosen] = False
        if not over.any():
            return np.array(answer.x[:2] * scale)
        worst = np.flatnonzero(over)
        worst = worst[np.argsort(rest[worst])[-SECTORS:]]
        chosen = np.union1d(chosen, worst)


def fit_ellipse(points: Array) -> Ellipse:
    """Ellipse by least squares through points (n, 2) [mm] near a circle, five at least, all round.

    The general conic ``a x^2 + b xy + c y^2 + d x + e y = 1`` about the points' middle, scaled to
    unit size: exact for points on an ellipse, and for small deviations the same as the second
    harmonic of the radius.
    """
    origin, radius = least_squares_circle(points)
    x, y = ((points - origin) / radius).T
    matrix = np.column_stack([x * x, x * y, y * y, x, y])
    a, b, c, d, e = np.linalg.lstsq(matrix, np.ones(len(points)), rcond=None)[0]
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


@dataclass(frozen=True)
class Reading:
    """Circular test of one directed path [mm]."""

    # circular deviation G: minimum radial separation of two concentric circles (minimum zone, own
    # centre) that envelop the path
    g: float
    g_least_squares: float  # range of the radii about the least-squares centre
    # radial deviation F: largest distance from the nominal centre, minus the nominal radius
    f_max: float
    f_min: float  # with the smallest distance
    f_max_centred: float  # the same about the least-squares centre, set-up errors removed
    f_min_centred: float
    radius_change: float  # mean radius about the least-squares centre, minus the nominal radius
    radius_change_nominal: float  # about the nominal centre
    offset: tuple[float, float]  # least-squares centre minus nominal centre, in the plane's axes
    major_change: float  # semi-axes of the fitted ellipse minus the nominal radius
    minor_change: float
    orientation: float  # of the major axis from the plane's first axis [rad]


@dataclass(frozen=True)
class BothWays:
    """Circular test of both directions together [mm]."""

    # bi-directional circular deviation G(b): minimum radial separation of two concentric circles
    # (minimum zone) that envelop both paths
    g: float
    # mean bi-directional radial deviation D: mean of both directions' mean radii about their common
    # least-squares centre, minus the nominal radius
    d: float
    d_nominal: float  # the same about the nominal centre


def reading(points: Array, radius: float) -> Reading:
    """Quantities of one directed path (n, 2) from the nominal centre, in the plane's axes [mm]."""
    centre, mean = least_squares_circle(points)
    about_nominal = np.hypot(points[:, 0], points[:, 1]) - radius
    about_own = np.hypot(points[:, 0] - centre[0], points[:, 1] - centre[1]) - radius
    ellipse = fit_ellipse(points)
    return Reading(
        g=minimum_zone(points).width,
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
    centre, _ = least_squares_circle(points)

    def mean(path: Array, about: Array) -> float:
        return float(np.hypot(path[:, 0] - about[0], path[:, 1] - about[1]).mean())

    nominal = np.zeros(2)
    return BothWays(
        g=minimum_zone(points).width,
        d=0.5 * (mean(first, centre) + mean(second, centre)) - radius,
        d_nominal=0.5 * (mean(first, nominal) + mean(second, nominal)) - radius,
    )
