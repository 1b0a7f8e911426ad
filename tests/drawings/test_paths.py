"""Paths of lines, arcs and curves: chords, chains, order, copies, and a drag knife's way."""

from itertools import pairwise

import numpy as np
import pytest
from few_cases import few
from lines_apart import apart

from motionfmu.drawings import Drawing, DrawingOptions, Polyline
from motionfmu.drawings.chains import MEET, chained
from motionfmu.drawings.contours import clean, contours_of, way_between
from motionfmu.drawings.pen_path import (
    NEAR,
    EllipseAxes,
    PathMaker,
    PenPath,
    at_share,
    bend_of,
    cubics_of,
)


def line(*places: tuple[float, float], pen: int = 1) -> Polyline:
    return Polyline(pen, True, PenPath.lines(np.array(places, float), 7), 7)


def drawing(*lines: Polyline, ordered: bool = False) -> Drawing:
    return Drawing(list(lines), [], ordered=ordered)


def square(x: float, y: float, side: float) -> Polyline:
    return line((x, y), (x + side, y), (x + side, y + side), (x, y + side), (x, y))


def dense(path: PenPath, n: int = 4000) -> np.ndarray:
    """Points of a path by its definition: arcs about their centres, curves by Bernstein."""
    found = []
    for k in range(len(path.source)):
        t = np.linspace(0.0, 1.0, n)
        if path.curved[k]:
            found.append(at_share(path.piece(k), t))
        elif path.bulges[k]:
            c, angle = path.centres()[k], 4.0 * np.arctan(path.bulges[k])
            x, y = (path.nodes[k] - c)[:, None]
            co, si = np.cos(angle * t), np.sin(angle * t)
            found.append(c + np.stack([co * x - si * y, si * x + co * y], axis=1))
        else:
            found.append(path.nodes[k] + t[:, None] * (path.nodes[k + 1] - path.nodes[k]))
    return np.vstack(found)


def mixed() -> PenPath:
    """A line, an arc to either side, a curve, a corner."""
    maker = PathMaker((0.0, 0.0))
    maker.line((10.0, 0.0))
    maker.arc((20.0, 10.0), np.tan(np.pi / 8))
    maker.arc((30.0, 20.0), -np.tan(np.pi / 8))
    maker.cubic(np.array([38.0, 20.0]), np.array([30.0, 40.0]), (42.0, 42.0))
    maker.line((10.0, 42.0))
    return maker.path()


@pytest.mark.parametrize("tolerance", [0.05, 0.005])
def test_chords_are_within_their_tolerance_and_no_nearer_than_asked(tolerance: float) -> None:
    path = mixed()
    points, places = path.with_chords(tolerance)
    assert np.allclose(points[places], path.nodes)
    off = apart([dense(path, 400)], [points])
    assert 0.4 * tolerance < off <= tolerance * 1.001
    assert apart([points], [dense(path, 4000)], 12) < 1e-6


def test_a_turned_path_is_the_same_path() -> None:
    path = mixed()
    assert np.allclose(path.reversed.points[::-1], path.points)
    assert np.allclose(path.reversed.headings()[::-1, ::-1], -path.headings())
    moved = path.moved(2.0, (3.0, -1.0))
    assert np.allclose(dense(moved), 2.0 * dense(path) + [3.0, -1.0])


@pytest.mark.parametrize(
    ("u", "v"),
    [((40.0, 0.0), (0.0, 5.0)), ((30.0, 10.0), (5.0, 12.0)), ((0.0, 400.0), (90.0, 0.0))],
)
def test_an_ellipse_is_cubic_curves_near_to_it(u: tuple, v: tuple) -> None:
    axes = EllipseAxes(np.array([3.0, 4.0]), np.array(u), np.array(v))
    maker = PathMaker(axes.at(0.3))
    maker.ellipse(axes, 0.3, 5.5)
    exact = np.array([axes.at(t) for t in np.linspace(0.3, 5.5, 40_000)])
    off = apart([dense(maker.path(), 300)], [exact], 8)
    assert off <= NEAR * 1.05


def test_a_circle_is_two_arcs() -> None:
    axes = EllipseAxes(np.array([3.0, 4.0]), np.array([0.0, 2.0]), np.array([2.0, 0.0]))
    maker = PathMaker(axes.at(0.0))
    maker.ellipse(axes, 0.0, 2.0 * np.pi)
    path = maker.path()
    assert path.bulges == pytest.approx([-1.0, -1.0])  # v is to the right of u
    assert np.hypot(*(dense(path) - [3.0, 4.0]).T) == pytest.approx(2.0)


def test_curves_near_to_a_curve_of_another_kind() -> None:
    def spiral(t: float) -> tuple[np.ndarray, np.ndarray]:
        c, s = np.cos(t), np.sin(t)
        return t * np.array([c, s]), np.array([c - t * s, s + t * c])

    found = cubics_of(spiral, 0.0, 20.0)
    exact = np.array([spiral(t)[0] for t in np.linspace(0.0, 20.0, 200_000)])
    ours = np.vstack([at_share(c, np.linspace(0.0, 1.0, 100)) for c in found])
    assert apart([ours], [exact], 8) <= NEAR and 5 < len(found) < 200


def test_the_curvature_of_a_curve() -> None:
    k = 0.5522847498
    quarter = np.array([[10.0, 0], [10, 10 * k], [10 * k, 10], [0, 10]])
    assert 1.0 / bend_of(quarter) == pytest.approx(10.0, rel=0.01)
    assert bend_of(np.array([[0.0, 0], [1, 1], [0, 1], [1, 0]])) == np.inf


def test_lines_are_joined_where_their_ends_meet() -> None:
    gap = 0.9 * MEET
    loose = [
        line((10, 0), (10, 10)),
        line((0, 0), (10, 0)),
        line((0, gap), (0, 10)),
        line((10, 10), (0, 10)),
        line((30, 0), (30, 5)),
        line((30, 5 + 2 * MEET), (30, 9)),
        line((30, 5), (35, 5), pen=2),
    ]
    found = chained(loose)
    assert [len(p.path.nodes) for p in found] == [6, 2, 2, 2]
    ring = found[0].path
    assert np.allclose(ring.nodes[0], ring.nodes[-1], atol=1e-12)
    assert np.linalg.norm(np.diff(ring.nodes, axis=0), axis=1).sum() == pytest.approx(40.0)
    closed = [c.closed for c in clean(drawing(*loose))]
    assert closed == [True, False, False, False]
    assert [c.closed for c in clean(drawing(*loose, ordered=True))] == [False] * 7


def test_a_gap_where_a_chain_ends_is_closed_too() -> None:
    near, far = 0.6 * MEET, 1.6 * MEET
    for gap, closed in ((near, True), (far, False)):
        ring = [line((0, 0), (5, 0)), line((5, 0), (5, 5)), line((5, 5), (gap, 0))]
        (found,) = clean(drawing(*ring))
        assert found.closed == closed and len(found.path.nodes) == (5 if closed else 4)


def test_where_several_lines_meet_the_straightest_goes_on() -> None:
    cross = [
        line((0, 0), (5, 5)),
        line((5, 5), (10, 0)),
        line((10, 10), (5, 5)),
        line((5, 5), (0, 10)),
    ]
    found = chained(cross)
    assert sorted(p.path.nodes.tolist() for p in found) == [
        [[0, 0], [5, 5], [10, 10]],
        [[0, 10], [5, 5], [10, 0]],
    ]


def test_what_lies_inside_comes_first_and_then_what_is_near() -> None:
    lines = [square(0, 0, 100), square(10, 10, 30), square(15, 15, 5), square(300, 0, 9)]
    lines += [line((60, 60), (70, 70))]
    order = [c.points[0].tolist() for c in clean(drawing(*lines), order="inside")]
    assert order.index([15, 15]) < order.index([10, 10]) < order.index([0, 0])
    assert order.index([60, 60]) < order.index([0, 0])
    assert order[0] == [15, 15] and order[-1] == [300, 0]
    rng = np.random.default_rng(1)
    many = [square(*place, 2.0) for place in rng.uniform(0, 400, (60, 2))]
    by = {o: way_between(clean(drawing(*many), order=o)) for o in ("file", "inside", "nearest")}
    assert by["inside"] < 0.4 * by["file"] and by["nearest"] < 0.4 * by["file"]


def test_scale_and_copies_are_the_drawing_elsewhere() -> None:
    plain = drawing(square(1, 2, 3), line((0, 0), (5, 5)), ordered=True)
    options = DrawingOptions(scale=2.0, copies=(3, 2), pitch=(20.0, 30.0))
    found = contours_of(plain, options)
    assert len(found) == 12
    own = [c.points for c in contours_of(plain, DrawingOptions())]
    shifts = [(0, 0), (20, 0), (40, 0), (40, 30), (20, 30), (0, 30)]  # there and back
    for k, shift in enumerate(shifts):
        for c, p in zip(found[2 * k : 2 * k + 2], own, strict=True):
            assert np.allclose(c.points, 2.0 * p + shift)
    arc = Polyline(1, True, mixed(), 0)
    assert np.allclose(
        contours_of(drawing(arc), DrawingOptions(scale=3.0))[0].path.bulges, mixed().bulges
    )


def edge(axis: np.ndarray, d: float, heading: np.ndarray, step: float = 2e-4) -> np.ndarray:
    """Places of a drag knife's edge by its equation, E' = h (h . A'), its axis led along lines."""
    places = [axis[0] - d * heading]
    for a, b in pairwise(axis):
        n = max(1, int(np.ceil(np.linalg.norm(b - a) / step)))
        for k in range(1, n + 1):
            now = a + (b - a) * k / n
            # The edge is drawn straight to the axis: exact for a step, up to its second order.
            h = now - places[-1]
            places.append(now - d * h / np.hypot(*h))
    return np.array(places)


@pytest.mark.more
@pytest.mark.parametrize("d", few([0.25, 1.0], 1))
def test_the_edge_of_a_drag_knife_follows_the_drawing(d: float) -> None:
    path = mixed()
    (contour,) = contours_of(drawing(Polyline(1, True, path, 0)), DrawingOptions(knife=d))
    axis = contour.path.with_chords(1e-4)[0]
    heading = np.array([1.0, 0.0])
    cut = edge(axis, d, heading)
    assert apart([cut], [dense(path, 2000)], 12) < 0.007  # chords of the curve: 0.005
    assert apart([dense(path, 50)], [cut], 12) < 0.007
    # Without the offset's way the corner is cut round.
    plain = edge(path.points, d, heading)
    assert apart([dense(path, 50)], [plain], 12) > 0.15 * d


def test_the_way_of_a_knife_in_closed_form() -> None:
    d = 0.5
    axes = EllipseAxes(np.zeros(2), np.array([10.0, 0.0]), np.array([0.0, 10.0]))
    maker = PathMaker(axes.at(0.0))
    maker.ellipse(axes, 0.0, 2.0 * np.pi)
    (circle,) = contours_of(drawing(Polyline(1, True, maker.path(), 0)), DrawingOptions(knife=d))
    nodes = circle.path.nodes
    # It turns in its place from heading +X to +Y, then goes round on a circle of its own.
    assert nodes[0] == pytest.approx([10.0 + d, 0.0]) and nodes[1] == pytest.approx([10.0, d])
    assert np.hypot(*circle.path.centres()[1]) < 1e-9
    assert np.hypot(*nodes[1:4].T) == pytest.approx(np.hypot(10.0, d))
    # The square's corners are arcs of radius d about them, and the cut goes on by d.
    (box,) = contours_of(drawing(square(0, 0, 10)), DrawingOptions(knife=d))
    arcs = np.flatnonzero(box.path.bulges)
    assert box.path.centres()[arcs] == pytest.approx(
        np.array([[10, 0], [10, 10], [0, 10], [0, 0]], float)
    )
    assert box.path.bulges[arcs] == pytest.approx(np.tan(np.pi / 8))
    assert box.path.nodes[-1] == pytest.approx([2 * d, 0.0])


@pytest.mark.more
def test_a_knife_follows_chords_of_a_curve_without_a_turn_at_each() -> None:
    t = np.linspace(0.0, np.pi, 200)
    raster = np.stack([10 * np.cos(t), 10 * np.sin(t)], axis=1)
    (way,) = contours_of(
        drawing(Polyline(1, True, PenPath.lines(raster), 0)), DrawingOptions(knife=0.25)
    )
    assert np.count_nonzero(way.path.bulges) == 1  # at the begin
    cut = edge(way.path.with_chords(1e-4)[0], 0.25, np.array([1.0, 0.0]))
    assert apart([cut], [raster]) < 0.005
