"""Nearest points on lines, arcs and helices against brute force and symmetry."""

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.optimize import brentq, minimize_scalar

from motionfmu.analysis.contour.arcs import kepler_root
from motionfmu.analysis.contour.geometry import Arc, Cubic, Label, LineSegment
from motionfmu.analysis.contour.planned_geometry import make_arc

LABEL = Label(1, 10, "line", 0.0)
# Rounding of coordinates up to about 200 mm, a few operations long. [mm]
ROUNDING = 1e-12 * 200.0

coordinate = st.floats(-60.0, 60.0, allow_subnormal=False)
point = st.tuples(coordinate, coordinate, coordinate).map(np.array)
positive = st.floats(0.1, 50.0)


@st.composite
def arcs(draw) -> Arc:
    """Arcs and helices of up to three turns about any axis, some with a radius that changes."""
    axis = draw(point.filter(lambda v: np.linalg.norm(v) > 1.0))
    axis = axis / np.linalg.norm(axis)
    spoke = np.cross(axis, np.eye(3)[int(np.argmin(np.abs(axis)))])
    radius = draw(positive)
    centre = draw(point)
    rise = draw(st.one_of(st.just(0.0), st.floats(-40.0, 40.0)))
    growth = draw(st.one_of(st.just(0.0), st.floats(-1e-3, 1e-3), st.floats(-1.0, 3.0))) * radius
    angle = draw(st.floats(0.01, 6.0 * math.pi))
    start = centre + radius * spoke / np.linalg.norm(spoke)
    return Arc(LABEL, start, centre, axis, angle, rise, growth)


@st.composite
def segments(draw) -> LineSegment | Arc:
    if draw(st.booleans()):
        return draw(arcs())
    return LineSegment(LABEL, draw(point), draw(point))


# Each turn has a nearest point of its own; the radius that shrinks and the rise choose among them.
SPIRAL = Arc(
    LABEL,
    np.array([0.0, 1.0, 1.0]),
    np.array([0.0, 0.0, 1.0]),
    np.array([0.0, 0.0, 1.0]),
    13.0,
    -0.0078125,
    -0.0007720621271445606,
)


@settings(max_examples=200)
@given(segments(), st.lists(point, min_size=1, max_size=8))
@example(SPIRAL, [np.array([0.0, -12.0, 0.0])])
def test_no_sampled_point_is_nearer(segment, points) -> None:
    points = np.array(points)
    foot = segment.foot(points)
    dense = segment.at(np.linspace(0.0, segment.length, 2000))
    brute = np.linalg.norm(points[:, None, :] - dense[None, :, :], axis=2).min(axis=1)
    assert (foot.distance <= brute + ROUNDING).all()
    # and it is a distance to a point of the segment, not less
    assert np.allclose(segment.at(foot.along), foot.point, atol=ROUNDING * 10, rtol=0.0)
    assert (foot.along >= 0.0).all() and (foot.along <= segment.length * (1 + 1e-15)).all()
    own = np.linalg.norm(points - foot.point, axis=1)
    assert np.allclose(foot.distance, own, atol=ROUNDING, rtol=0.0)


@pytest.mark.parametrize("seed", range(8))
def test_the_nearest_of_all_turns_of_a_spiral(seed: int) -> None:
    """Each minimum of dense samples, made exact by Brent: the least one is the foot's distance."""
    rng = np.random.default_rng(seed)
    for _ in range(12):
        radius = 10 ** rng.uniform(-1, 1.5)
        growth = radius * rng.choice([1e-4 * rng.normal(), rng.uniform(-1, 3)])
        rise = rng.choice([0.0, 1e-3 * rng.normal(), radius * rng.normal()])
        shape = (10 ** rng.uniform(-1, 1.6), rise, growth)
        spiral = Arc(LABEL, radius * np.eye(3)[0], np.zeros(3), np.eye(3)[2], *shape)
        for query in rng.normal(size=(4, 3)) * 2 * radius * 10 ** rng.uniform(-3, 0.5, (4, 1)):

            def gap(along: float, spiral: Arc = spiral, query: np.ndarray = query) -> float:
                return float(np.linalg.norm(spiral.at(np.array([along]))[0] - query))

            ways = np.linspace(0.0, spiral.length, 4001)
            gaps = np.linalg.norm(spiral.at(ways) - query, axis=1)
            least = gaps.min()
            for i in np.flatnonzero((gaps[1:-1] <= gaps[:-2]) & (gaps[1:-1] <= gaps[2:])):
                near = (ways[i], ways[i + 2])
                least = min(least, minimize_scalar(gap, bounds=near, options={"xatol": 1e-9}).fun)
            assert spiral.foot(query[None, :]).distance[0] == pytest.approx(least, abs=1e-10)


# A rise so small that the circle's foot is as near as the helix', to the last digit.
FLAT = Arc(LABEL, np.array([0.0, 0.0, -1.0]), np.zeros(3), np.array([0.0, 1.0, 0.0]), 4.0, 7.5e-10)
ROUND = Arc(LABEL, np.array([0.0, 0.0, -1.0]), np.zeros(3), np.array([0.0, 1.0, 0.0]), 4.0, 0.0)


@settings(max_examples=200)
@given(segments(), point)
@example(FLAT, np.array([0.0, 1.0, 1.0]))
@example(ROUND, np.array([1e-303, 0.0, 1e-303]))
def test_foot_is_square_to_the_path_or_an_end(segment, query) -> None:
    foot = segment.foot(query[None, :])
    along = foot.along[0]
    if 0.0 < along < segment.length:
        tangent = segment.tangent(foot.along)[0]
        gap = query - foot.point[0]
        # the angle's rounding times the arm it turns
        arm = np.linalg.norm(gap) + segment.length + 1.0
        assert abs(gap @ tangent) <= 1e-11 * arm


def rotation(axis: np.ndarray, angle: float) -> np.ndarray:
    x, y, z = axis / np.linalg.norm(axis)
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross


@settings(max_examples=100)
@given(segments(), point, point, point.filter(lambda v: np.linalg.norm(v) > 1.0), st.floats(-3, 3))
def test_moving_everything_moves_nothing(segment, query, shift, axis, angle) -> None:
    turn = rotation(axis, angle)

    def moved(p: np.ndarray) -> np.ndarray:
        return turn @ p + shift

    if isinstance(segment, LineSegment):
        other = LineSegment(LABEL, moved(segment.start), moved(segment.end))
    else:
        other = Arc(
            LABEL,
            moved(segment.start),
            moved(segment.centre),
            turn @ segment.axis,
            segment.angle,
            segment.rise,
            segment.growth,
        )
    before = segment.foot(query[None, :]).distance[0]
    after = other.foot(moved(query)[None, :]).distance[0]
    assert after == pytest.approx(before, abs=20.0 * ROUNDING)


@settings(max_examples=100)
@given(segments(), st.lists(point, min_size=2, max_size=6))
def test_many_points_at_once_are_as_each_alone(segment, points) -> None:
    points = np.array(points)
    together = segment.foot(points)
    for i, p in enumerate(points):
        alone = segment.foot(p[None, :])
        assert together.distance[i] == pytest.approx(alone.distance[0], abs=ROUNDING)


@settings(max_examples=200)
@given(st.floats(0.0, 1e4), st.floats(1e-6, 1e3), st.floats(-math.pi, math.pi))
def test_kepler_root_is_the_one_brent_finds(pull, stiff, way) -> None:
    def slope(w: float) -> float:
        return pull * math.sin(w) + stiff * (w - way)

    root = kepler_root(np.array([pull]), stiff, np.array([way]), np.array([abs(way)]))[0]
    low, high = sorted((0.0, way))
    if slope(low) * slope(high) < 0.0:
        other = brentq(slope, low, high, xtol=1e-15, rtol=1e-15)
        # where pull and stiff nearly cancel, the root is as flat as the rounding of the slope
        noise = 1e-14 * (pull + stiff * abs(way)) / max(pull * math.cos(other) + stiff, 1e-300)
        assert abs(root - other) <= 1e-13 + noise
    assert low <= root <= high


def test_circle_closed_forms() -> None:
    arc = Arc(LABEL, np.array([50.0, 0, 0]), np.zeros(3), np.array([0, 0, 1.0]), 2 * math.pi)
    points = np.array([[30.0, 40.0, 0], [33.0, 44.0, 0], [27.0, 36.0, 4.0], [0.0, 0.0, 0.0]])
    want = [0.0, 5.0, math.hypot(5.0, 4.0), 50.0]
    assert arc.foot(points).distance == pytest.approx(want, abs=1e-13)


def test_arc_beyond_its_ends_takes_the_nearer_end() -> None:
    quarter = Arc(LABEL, np.array([50.0, 0, 0]), np.zeros(3), np.array([0, 0, 1.0]), math.pi / 2)
    foot = quarter.foot(np.array([[50.0, -3.0, 0], [-3.0, 50.0, 0], [-50.0, -49.0, 0]]))
    assert foot.along == pytest.approx([0.0, quarter.length, quarter.length], abs=1e-12)
    assert foot.distance[:2] == pytest.approx([3.0, 3.0], abs=1e-12)


def test_helix_takes_the_right_turn() -> None:
    helix = Arc(
        LABEL, np.array([10.0, 0, 0]), np.zeros(3), np.array([0, 0, 1.0]), 8 * math.pi, rise=20.0
    )
    # 0.1 mm outside of the middle of the third turn, and on the axis
    middle = helix.at(np.array([5.0 / 8.0 * helix.length]))
    out = middle + 0.1 * np.array([[-1.0, 0.0, 0.0]])
    foot = helix.foot(out)
    assert foot.along[0] == pytest.approx(5.0 / 8.0 * helix.length, abs=1e-9)
    assert foot.distance[0] == pytest.approx(0.1, abs=1e-12)
    assert helix.foot(np.array([[0.0, 0.0, 9.0]])).distance[0] == pytest.approx(10.0, abs=1e-12)


@pytest.mark.parametrize("sweep", [math.pi / 2, -math.pi / 2, 5.0, -5.0])
def test_sweep_turns_about_the_normal(sweep: float) -> None:
    start, normal = np.array([2.0, 0, 1.0]), np.array([0.0, 0, 2.0])
    end = np.array([2 * math.cos(sweep), 2 * math.sin(sweep), 4.0])
    arc = make_arc(LABEL, (start, end), (np.zeros(3), normal), sweep)
    assert arc.end == pytest.approx(end, abs=1e-12)
    assert arc.length == pytest.approx(math.hypot(2 * sweep, 3.0), rel=1e-14)
    middle = arc.at(np.array([0.5 * arc.length]))[0]
    assert middle == pytest.approx([2 * math.cos(sweep / 2), 2 * math.sin(sweep / 2), 2.5])
    assert arc.tangent(np.zeros(1))[0, 1] * sweep > 0.0


@pytest.mark.parametrize("seed", range(20))
def test_cubic_has_its_length_and_nothing_is_nearer_than_its_foot(seed: int) -> None:
    rng = np.random.default_rng(seed)
    control = rng.uniform(-50.0, 50.0, (4, 3))
    cubic = Cubic(LABEL, control)
    first = 3.0 * np.diff(control, axis=0)

    def speed(t: float) -> float:
        weights = [(1 - t) ** 2, 2 * t * (1 - t), t * t]
        return float(np.linalg.norm(weights @ first))

    assert cubic.length == pytest.approx(quad(speed, 0, 1, epsabs=1e-11, limit=200)[0], abs=1e-9)
    points = rng.uniform(-60.0, 60.0, (40, 3))
    foot = cubic.foot(points)
    dense = cubic.at(np.linspace(0.0, cubic.length, 4000))
    gaps = np.linalg.norm(points[:, None, :] - dense, axis=2).min(axis=1)
    assert (foot.distance <= gaps + 1e-9).all()
    assert (foot.distance >= gaps - 1e-3).all()
    assert cubic.at(foot.along) == pytest.approx(foot.point, abs=1e-9)
    # also where it passes by itself, between places at which it would be sampled
    flat = Cubic(LABEL, control * np.array([1.0, 1.0, 0.0]))
    on = flat.at(rng.uniform(0.0, flat.length, 500))
    assert flat.foot(on).distance.max() < 1e-9
    off = rng.normal(size=on.shape)
    assert (flat.foot(on + off).distance <= np.linalg.norm(off, axis=1) + 1e-9).all()
    step = np.linalg.norm(np.diff(dense, axis=0), axis=1)
    assert step.sum() == pytest.approx(cubic.length, rel=1e-5)
    assert (step <= cubic.length / 3999 * (1 + 1e-9)).all()
    middle = np.array([0.3, 0.7]) * cubic.length
    chord = (cubic.at(middle + 1e-4) - cubic.at(middle - 1e-4)) / 2e-4
    assert cubic.tangent(middle) == pytest.approx(chord, abs=1e-6)


def test_line_without_length_is_a_point() -> None:
    dot = LineSegment(LABEL, np.array([1.0, 2, 3]), np.array([1.0, 2, 3]))
    foot = dot.foot(np.array([[1.0, 2.0, 7.0]]))
    assert foot.distance[0] == 4.0 and foot.along[0] == 0.0
