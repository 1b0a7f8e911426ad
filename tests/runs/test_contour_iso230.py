"""Circular test quantities of constructed shapes."""

import math

import numpy as np
import pytest
from scipy.optimize import linprog, minimize

from motionfmu.analysis.contour.circles import plane_axes
from motionfmu.analysis.contour.iso230 import (
    both_ways,
    fit_ellipse,
    least_squares_circle,
    minimax,
    minimum_zone,
    reading,
)

R = 100.0
ANGLE = np.linspace(0.0, 2.0 * math.pi, 3600, endpoint=False)


def shape(deviation, offset=(0.0, 0.0)) -> np.ndarray:
    """Points at radius R + deviation(angle)."""
    r = R + deviation(ANGLE)
    return np.column_stack([r * np.cos(ANGLE), r * np.sin(ANGLE)]) + offset


def zone_by_search(points: np.ndarray) -> float:
    """Least radial range over the centre, by simplex search from several starts."""

    def width(centre: np.ndarray) -> float:
        return float(np.ptp(np.hypot(*(points - centre).T)))

    start = least_squares_circle(points)[0]
    size = width(start)
    options = {"xatol": 1e-12, "fatol": 1e-13, "maxiter": 4000, "maxfev": 8000}
    starts = [start + size * np.array(d) for d in ((0.0, 0.0), (1.0, 0.0), (-0.3, -0.5))]
    return min(minimize(width, s, method="Nelder-Mead", options=options).fun for s in starts)


def test_perfect_circle_off_centre() -> None:
    points = shape(lambda a: 0.0 * a, offset=(0.03, -0.04))
    r = reading(points, R)
    assert r.g == pytest.approx(0.0, abs=1e-11)
    assert r.offset == pytest.approx((0.03, -0.04), abs=1e-12)
    assert (r.f_max, r.f_min) == pytest.approx((0.05, -0.05), abs=1e-7)
    assert (r.f_max_centred, r.f_min_centred) == pytest.approx((0.0, 0.0), abs=1e-11)
    assert r.radius_change == pytest.approx(0.0, abs=1e-12)


def test_lobes_of_known_zone() -> None:
    # three lobes: the least-squares centre is the minimum-zone centre by symmetry
    points = shape(lambda a: 0.01 * np.cos(3 * a) - 0.005)
    r = reading(points, R)
    assert r.g == pytest.approx(0.02, abs=1e-9)
    assert r.radius_change == pytest.approx(-0.005, abs=1e-9)


def test_minimum_zone_is_less_than_the_least_squares_range() -> None:
    def dent(a):
        return -0.02 * np.exp(-((np.angle(np.exp(1j * (a - 1.0))) / 0.3) ** 2)) + 0.004 * np.cos(
            3 * a
        )

    r = reading(shape(dent), R)
    assert r.g < 0.98 * r.g_least_squares
    assert r.g == pytest.approx(zone_by_search(shape(dent)), abs=1e-9)


@pytest.mark.parametrize("seed", range(12))
def test_minimum_zone_is_what_a_search_finds(seed: int) -> None:
    rng = np.random.default_rng(seed)
    terms = rng.normal(size=(12, 2)) * 0.01 / np.arange(1, 13)[:, None]
    orders = np.arange(1, 13)

    def wavy(a):
        return np.cos(np.outer(a, orders)) @ terms[:, 0] + np.sin(np.outer(a, orders)) @ terms[:, 1]

    points = shape(wavy)[:: rng.integers(1, 9)]
    if seed % 3 == 0:  # a part of the circle only
        points = points[: int(0.7 * len(points))]
    zone = minimum_zone(points)
    assert zone.width == pytest.approx(zone_by_search(points), abs=2e-9)
    radii = np.hypot(*(points - zone.centre).T)
    assert (radii.min(), radii.max()) == pytest.approx((zone.inner, zone.outer), abs=1e-13)
    # the optimum has at least four points on the two circles
    on = (radii - zone.inner < 1e-7 * zone.width) | (zone.outer - radii < 1e-7 * zone.width)
    assert on.sum() >= 4


@pytest.mark.parametrize("seed", range(20))
def test_minimax_is_what_a_linear_program_of_all_points_finds(seed: int) -> None:
    rng = np.random.default_rng(seed)
    count = int(rng.integers(4, 400))
    angle = rng.uniform(0.0, rng.uniform(3.3, 6.3), count)
    if seed % 4 == 0:  # laps: several values in each direction, many of them alike
        angle = np.repeat(angle[: count // 2 + 2], 2)
    values = np.round(rng.normal(size=len(angle)), int(rng.integers(0, 12)))
    rows = np.column_stack([np.cos(angle), np.sin(angle), np.ones(len(angle))])
    one = np.ones((len(angle), 1))
    program = linprog(
        [0.0, 0.0, 0.0, 1.0],
        A_ub=np.vstack([np.hstack([-rows, -one]), np.hstack([rows, -one])]),
        b_ub=np.concatenate([-values, values]),
        bounds=[(None, None)] * 3 + [(0.0, None)],
    )
    found = float(np.abs(values - rows @ minimax(rows, values)).max())
    assert found == pytest.approx(program.fun, abs=1e-9)


@pytest.mark.parametrize("spikes", [0, 3])
def test_no_point_is_outside_the_zone_of_many(spikes: int) -> None:
    # 200000 points, of which a few at random stick out by the width of a hair: their zone is the
    # one of a search over those on the hull of each side.
    rng = np.random.default_rng(7 + spikes)
    angle = np.sort(rng.uniform(0.0, 2.0 * math.pi, 200_000))
    radius = R + 0.01 * np.cos(2.0 * angle) + 1e-3 * rng.normal(size=len(angle))
    radius[rng.integers(0, len(angle), spikes)] += 0.02
    points = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
    zone = minimum_zone(points)
    radii = np.hypot(*(points - zone.centre).T)
    assert radii.min() >= zone.inner - 1e-13 and radii.max() <= zone.outer + 1e-13
    bound = (radii < zone.inner + 2e-3) | (radii > zone.outer - 2e-3)
    assert zone.width == pytest.approx(zone_by_search(points[bound]), abs=1e-9)


def test_minimum_zone_of_few_points_by_hand() -> None:
    # a square and its circle: all corners at one radius
    assert minimum_zone(np.array([[1.0, 1], [-1, 1], [-1, -1], [1, -1]])).width < 1e-15
    # corners at sqrt 2 alternate with points at 1.40: the centre stays by symmetry
    inner = 1.40 * np.array([[1.0, 0], [0, 1], [-1, 0], [0, -1]])
    outer = np.array([[1.0, 1], [-1, 1], [-1, -1], [1, -1]])
    zone = minimum_zone(np.concatenate([inner, outer]))
    assert zone.width == pytest.approx(math.sqrt(2.0) - 1.40, abs=1e-12)


@pytest.mark.parametrize("tilt", [0.0, 0.6, math.pi / 4, -1.2, math.pi / 2])
@pytest.mark.parametrize("part", [1.0, 0.6])
def test_ellipse_is_found_exactly(tilt: float, part: float) -> None:
    a = ANGLE[: int(part * len(ANGLE))]
    x, y = (R + 0.05) * np.cos(a), (R - 0.02) * np.sin(a)
    c, s = math.cos(tilt), math.sin(tilt)
    points = np.column_stack([c * x - s * y + 0.3, s * x + c * y - 0.2])
    found = fit_ellipse(points)
    assert (found.major, found.minor) == pytest.approx((R + 0.05, R - 0.02), abs=1e-9)
    assert found.centre == pytest.approx((0.3, -0.2), abs=1e-9)
    assert math.sin(found.orientation - tilt) == pytest.approx(0.0, abs=1e-8)


def test_scale_error_is_an_oval_along_an_axis_that_does_not_flip() -> None:
    stretched = shape(lambda a: 0.0 * a) * [1.0 + 2e-4, 1.0]
    forward, back = reading(stretched, R), reading(stretched[::-1], R)
    assert forward.major_change == pytest.approx(0.02, abs=1e-9)
    assert forward.minor_change == pytest.approx(0.0, abs=1e-9)
    assert forward.orientation == pytest.approx(0.0, abs=1e-6)
    assert back.orientation == pytest.approx(0.0, abs=1e-6)
    assert forward.g == pytest.approx(0.02, rel=1e-3)
    assert forward.radius_change == pytest.approx(0.01, rel=1e-3)


def test_squareness_error_is_an_oval_at_45_degrees() -> None:
    skew = 1e-4  # [rad]
    circle = shape(lambda a: 0.0 * a)
    points = np.column_stack([circle[:, 0] + skew * circle[:, 1], circle[:, 1]])
    r = reading(points, R)
    assert r.orientation == pytest.approx(math.pi / 4, abs=1e-3)
    assert r.g == pytest.approx(R * skew, rel=1e-3)
    both = both_ways(points, points[::-1], R)
    assert both.g == pytest.approx(r.g, abs=1e-12)


def test_two_radii_make_g_of_both_and_d_their_mean() -> None:
    big, little = shape(lambda a: 0.01 + 0.0 * a), shape(lambda a: -0.004 + 0.0 * a)
    both = both_ways(big, little[::3], R)
    assert both.g == pytest.approx(0.014, abs=1e-9)
    assert both.d == pytest.approx(0.003, abs=1e-9)
    assert both.d_nominal == pytest.approx(0.003, abs=1e-9)


def test_a_shift_of_both_ways_is_seen_from_the_nominal_centre_only() -> None:
    # About a centre off by e the mean of R + e cos a + e^2/(2 R) sin^2 a is e^2/(4 R) above R.
    offset = (0.3, -0.4)
    big, little = (shape(lambda a, d=d: d + 0.0 * a, offset) for d in (0.01, -0.004))
    both = both_ways(big, little, R)
    assert both.d == pytest.approx(0.003, abs=1e-9)
    assert both.d_nominal - both.d == pytest.approx(0.25 / (4.0 * R), rel=1e-4)
    assert reading(big, R).radius_change_nominal == pytest.approx(0.01 + 0.25 / (4 * R), abs=1e-7)


def test_planes_are_right_handed() -> None:
    for normal, names in (([0, 0, 1], "xy"), ([0, 1, 0], "zx"), ([1, 0, 0], "yz")):
        axes = plane_axes(np.array(normal, dtype=float))
        assert ["xyz"[int(np.argmax(a))] for a in axes] == list(names)
        assert np.cross(axes[0], axes[1]) == pytest.approx(normal)
