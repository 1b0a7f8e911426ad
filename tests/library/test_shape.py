"""Commands in a row as one smooth path: its distance both ways, C2, speed, hard cases."""

import itertools
import math

import numpy as np
import pytest
from few_cases import few
from shape_paths import Array, Segment, both_ways, jumps, least_time, lines, shaped

TURN = 2.0 * math.pi


def raster(points: Array, per_mm: float = 40.0) -> Array:
    """On a raster, without points twice in a row."""
    p = np.round(points * per_mm) / per_mm
    return p[np.r_[True, np.any(np.diff(p, axis=0) != 0.0, axis=1)]]


def polar(r: Array, t: Array) -> Array:
    return np.c_[r * np.cos(t), r * np.sin(t)]


def outline() -> Array:
    t = np.linspace(0.0, TURN, 6001)
    r = np.exp(np.cos(t)) - 2.0 * np.cos(4.0 * t) + np.sin(t / 12.0) ** 5
    return raster(polar(8.0 * r, t))


def contour() -> Array:
    t = np.linspace(0.0, TURN, 251)
    return np.round(polar(91.0 * (1.0 + 0.1 * np.cos(3.0 * t) + 0.02 * np.sin(7.0 * t)), t), 4)


def star() -> Array:
    t = np.pi / 2.0 + np.arange(6) * 2.0 * TURN / 5.0
    ends = polar(np.full(6, 20.0), t)
    parts = [a + np.linspace(0.0, 1.0, 700)[:, None] * (b - a) for a, b in itertools.pairwise(ends)]
    return raster(np.vstack(parts))


def chip() -> Array:
    x = np.arange(31.0)
    rows = []
    for k in range(12):
        y = x if k % 2 == 0 else x[::-1]
        z = 2.0 * np.exp(-((y - 15.0) ** 2 + (k - 6.0) ** 2) / 40.0) + 0.2 * np.sin(1.3 * y + k)
        rows.append(np.c_[y, k + 0.2 * np.sin(2.0 * y), np.round(z, 3)])
    return np.vstack(rows)


def circle() -> Array:
    return raster(polar(np.full(1500, 10.0), np.linspace(0.0, TURN, 1500)))


def spiral() -> Array:
    t = np.linspace(0.0, 4.0 * TURN, 6000)
    return raster(polar(1.0 + 0.5 * t, t))


# shape, tolerance [mm], time [s] at 1000 mm/s^2 and 100 mm/s: least and most
SHAPES = [
    (outline, 0.02, 3.2, 4.0),
    (circle, 0.02, 0.70, 0.76),
    (spiral, 0.02, 2.10, 2.30),
    (star, 0.02, 2.20, 2.45),
    (contour, 0.02, 5.8, 6.6),
    (chip, 0.02, 8.0, 16.0),
    (circle, 0.1, 0.68, 0.76),
    (outline, 0.01, 5.0, 60.0),
]


@pytest.mark.parametrize(("shape", "tolerance", "least", "most"), few(SHAPES, 3))
def test_a_curve_within_the_tolerance(shape, tolerance, least, most) -> None:  # type: ignore[no-untyped-def]
    points = shape()
    segments, marks = shaped(lines(points, tolerance))
    there, back = both_ways(segments, points, tolerance)
    place, slope, bend = jumps(segments)
    time = least_time(segments, 1000.0, 100.0)
    speeds = np.concatenate(
        [np.linalg.norm(p.at(np.linspace(0.0, p.length, 9))[1][:, :3], axis=1) for p in segments]
    )
    print(
        f"{shape.__name__} {len(points) - 1} lines, {len(segments)} segments, off {there:.5f} "
        f"{back:.5f} of {tolerance}, jumps {place:.0e} {slope:.0e} {bend:.0e}, "
        f"|r'| {speeds.min():.3f}..{speeds.max():.3f}, {time:.3f} s"
    )
    assert there <= tolerance and back <= tolerance
    assert place < 1e-9 and slope < 1e-9 and bend < 1e-8
    assert len(marks) == len(points) - 1 and np.all(np.diff(marks) >= 0.0)
    assert least < time < most
    assert np.allclose(segments[-1].at(np.array([segments[-1].length]))[0][0, :2], points[-1, :2])


def arc_gap(points: Array, arc: tuple[Array, float, float, float]) -> Array:
    """Distance of points (n, 2) from an arc by centre, radius, first angle and sweep."""
    centre, radius, first, sweep = arc
    off = points - centre
    turned = np.mod((np.arctan2(off[:, 1], off[:, 0]) - first) * np.sign(sweep), TURN)
    ends = [
        np.linalg.norm(off - radius * polar(np.ones(1), np.array([a])), axis=1)
        for a in (first, first + sweep)
    ]
    on = np.abs(np.hypot(off[:, 0], off[:, 1]) - radius)
    return np.where(turned <= abs(sweep), on, np.minimum(*ends))


def test_a_corner_of_arcs_is_within_the_tolerance_of_the_arcs() -> None:
    """Not of the chords that stand for them in the proof: these take a part of the tolerance."""
    tolerance, heading = 0.1, -2.329
    before = (np.array([0.0, -9.363]), 9.363, TURN / 4.0 + 4.6 / 9.363, -4.6 / 9.363)
    normal = np.array([-math.sin(heading), math.cos(heading)])
    behind = (24.608 * normal, 24.608, heading - TURN / 4.0, 7.825 / 24.608)
    rows = ["merge 0", "start"]
    for centre, radius, first, sweep in (before, behind):
        at = (centre + polar(radius * np.ones(2), np.array([first, first + sweep]))).ravel()
        x, y, to_x, to_y, a, b = (repr(float(v)) for v in (*at, *centre))
        rows[1] += f" {x} {y} 0 0 0 0" if rows[1] == "start" else ""
        rows.append(f"arc {tolerance} 100 2 {int(sweep > 0)} 1 {a} {b} {to_x} {to_y} 0 0 0 0")
    curves = [p for p in shaped(rows)[0] if p.kind == "curve"]
    assert len(curves) >= 1
    far = 0.0
    for curve in curves:
        points = curve.at(np.linspace(0.0, curve.length, 4001))[0][:, :2]
        far = max(far, np.minimum(arc_gap(points, before), arc_gap(points, behind)).max())
    assert 0.9 * tolerance < far <= tolerance


def wander(seed: int, scale: float, tolerance: float) -> tuple[list[str], Array]:
    """Lines and arcs at random, mostly nearly tangential, in all six axes."""
    dice = np.random.default_rng(seed)
    at, heading = np.zeros(6), 0.0
    rows, path = ["merge 1e9", "start 0 0 0 0 0 0"], [at]
    for _ in range(60):
        length = scale * 10 ** dice.uniform(-1.0, 0.6)
        heading += 0.2 * dice.normal() if dice.random() < 0.8 else dice.uniform(-3.0, 3.0)
        end = at.copy()
        end[2:] += 0.1 * length * dice.normal(size=4) * (seed % 2)
        words = f"line {tolerance} 100"
        if dice.random() < 0.6:
            end[:2] += length * np.array([math.cos(heading), math.sin(heading)])
            path.append(end)
        else:
            r, side = scale * 10 ** dice.uniform(-0.5, 0.7), dice.choice([-1.0, 1.0])
            centre = at[:2] + side * r * np.array([-math.sin(heading), math.cos(heading)])
            angle = heading - side * TURN / 4.0
            sweep = side * min(6.0, length / r)
            x = np.linspace(0.0, 1.0, math.ceil(abs(sweep) * math.sqrt(r / (4e-3 * tolerance))) + 4)
            arc = at + x[1:, None] * (end - at)
            arc[:, 0] = centre[0] + r * np.cos(angle + sweep * x[1:])
            arc[:, 1] = centre[1] + r * np.sin(angle + sweep * x[1:])
            path.extend(arc)
            end, heading = arc[-1], heading + sweep
            words = f"arc {tolerance} 100 2 {int(side > 0)} 1 " + " ".join(
                repr(float(c)) for c in centre
            )
        rows.append(words + " " + " ".join(repr(float(e)) for e in end))
        at = end
    return rows, np.array(path)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(("scale", "tolerance"), [(1.0, 0.02), (10.0, 0.02), (1.0, 0.2)])
def test_lines_and_arcs_at_random(seed: int, scale: float, tolerance: float) -> None:
    rows, path = wander(seed, scale, tolerance)
    segments, marks = shaped(rows)
    there, back = both_ways(segments, path, tolerance)
    place, slope, bend = jumps(segments)
    rests = sum(p.rest for p in segments)
    print(f"off {there:.5f} {back:.5f} of {tolerance}, {len(segments)} segments, {rests} rests")
    assert there <= 1.001 * tolerance and back <= 1.001 * tolerance  # chords of the arcs here
    assert place < 1e-9 and slope < 1e-9 and bend < 1e-8
    assert len(marks) == 60


def splines(seed: int, tolerance: float) -> tuple[list[str], Array]:
    """Cubics, every third with a corner before it, and between some of them short lines."""
    dice = np.random.default_rng(seed)
    rows, path, heading = ["merge 1e9", "start 0 0 0 0 0 0"], [np.zeros(6)], 0.0
    for k in range(30):
        at, length = path[-1], 10.0 ** dice.uniform(-0.7, 1.5)
        heading += 1.0 * (k % 3 == 0)
        turn = dice.uniform(-1.0, 1.0)
        way = [np.array([math.cos(heading + a), math.sin(heading + a)]) for a in (0.0, turn)]
        end = at.copy()
        end[:2] += 0.5 * length * (way[0] + way[1])
        end[3] += 0.1 * length * (seed % 2)
        inner = np.zeros((2, 3))
        inner[:, :2] = at[:2] + length / 3.0 * way[0], end[:2] - length / 3.0 * way[1]
        words = [*inner.ravel(), *end]
        rows.append(f"cubic {tolerance} 100 " + " ".join(repr(float(w)) for w in words))
        x = np.linspace(0.0, 1.0, 20 + math.ceil(40.0 * length))[1:, None]
        row = at + x * (end - at)
        corners = [at[:2], *inner[:, :2], end[:2]]
        row[:, :2] = sum(
            math.comb(3, j) * x**j * (1.0 - x) ** (3 - j) * c for j, c in enumerate(corners)
        )
        path.extend(row)
        heading += turn
        for _ in range(4 * (k % 2)):
            end = path[-1].copy()
            end[:2] += 0.3 * np.array([math.cos(heading), math.sin(heading)])
            rows.append(f"line {tolerance} 100 " + " ".join(repr(float(e)) for e in end))
            path.append(end)
    return rows, np.array(path)


@pytest.mark.parametrize(("seed", "tolerance"), [(0, 0.02), (1, 0.02), (2, 0.005)])
def test_cubics_keep_their_geometry(seed: int, tolerance: float) -> None:
    rows, path = splines(seed, tolerance)
    segments, marks = shaped(rows)
    there, back = both_ways(segments, path, tolerance)
    place, slope, bend = jumps(segments)
    kept = sum(p.kind == "cubic" for p in segments)
    print(f"off {there:.5f} {back:.5f} of {tolerance}, {len(segments)} segments, {kept} cubics")
    assert there <= 1.001 * tolerance and back <= 1.001 * tolerance  # chords here
    assert place < 1e-9 and slope < 1e-8 and bend < 1e-6  # lengths by splines here
    assert kept > 5 and not any(p.rest for p in segments[:-1])
    assert len(marks) == len(rows) - 2


@pytest.mark.parametrize("seed", range(3))
def test_steps_of_every_size_and_reversals(seed: int) -> None:
    dice = np.random.default_rng(seed)
    steps = dice.normal(size=(200, 3)) * 10.0 ** dice.uniform(-8.0, 0.7, (200, 1))
    steps[::17] = 0.0
    steps[5::19] = -steps[4::19][: len(steps[5::19])]
    points = np.cumsum(steps, axis=0) + [0.0, 1e3, 1e5][seed % 3]
    segments, marks = shaped(lines(points, 0.05))
    there, back = both_ways(segments, points, 0.05)
    rests = sum(p.rest for p in segments)
    print(f"off {there:.5f} {back:.5f}, {len(segments)} segments, {rests} rests")
    assert there <= 0.05 and back <= 0.05
    assert jumps(segments)[0] < 1e-9
    assert len(marks) == 199


def test_without_merging_only_corners_are_rounded() -> None:
    points = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [2.0, 1.0]])
    segments, _ = shaped(lines(points, 0.02, 0.0))
    assert [p.kind for p in segments] == ["line", *(["curve", "curve", "line"] * 2)]
    middle = segments[2].at(np.zeros(1))[0][0, :2]
    assert 0.95 * 0.02 < math.dist(middle, (1.0, 0.0)) <= 0.02


def test_where_there_is_no_room_one_quintic_rounds_a_corner() -> None:
    points = np.array([[0.0, 0.0], [0.1, 0.0], [0.1, 0.1], [0.2, 0.1]])
    segments, _ = shaped(lines(points, 0.02, 0.0))
    curves = [p for p in segments if p.kind == "curve"]
    assert len(curves) == 2
    # two lines: the curve's middle is 0.1875 of its half length times the turn off the corner
    half = 0.5 * curves[0].length
    middle = curves[0].at(np.array([half]))[0][0, :2]
    assert math.dist(middle, (0.1, 0.0)) == pytest.approx(0.1875 * half * math.sqrt(2.0))
    assert math.dist(middle, (0.1, 0.0)) <= 0.02


def one_quintic(turn: float, side: float, tolerance: float) -> list[Segment]:
    """Two lines from and to rest whose corner is cut by all of a tolerance, on the inside alone."""
    ways = np.zeros((2, 6))
    ways[:, :2] = polar(np.ones(2), np.array([0.0, turn]))
    half = tolerance / (0.1875 * np.linalg.norm(ways[1] - ways[0]))
    at = np.array([-1.0, -0.6, -0.2])[:, None] * half
    control = np.vstack([at * ways[0], -at[::-1] * ways[1]])
    return [
        Segment("line", side - half, False, np.r_[-side * ways[0], ways[0]]),
        Segment("curve", 2.0 * half, False, np.r_[np.zeros(6), control.ravel()]),
        Segment("line", side - half, True, np.r_[half * ways[1], ways[1]]),
    ]


@pytest.mark.parametrize("slow", [2, 3])
def test_a_corner_keeps_the_lower_feed(slow: int) -> None:
    rows = lines(np.array([[0.0, 0.0], [9.0, 0.0], [9.0, 9.0]]), 0.02, 0.0)
    rows[slow] = rows[slow].replace(" 100 ", " 40 ")
    segments, _ = shaped(rows)
    assert [p.kind for p in segments] == ["line", "curve", "curve", "line"]
    assert [p.feed for p in segments[1:3]] == [40.0, 40.0]
    assert sorted((segments[0].feed, segments[3].feed)) == [40.0, 100.0]


@pytest.mark.parametrize(
    ("degrees", "part"),
    [(20.0, 0.968), (30.0, 0.968), (60.0, 0.983), (90.0, 0.989), (120.0, 0.988), (150.0, 0.997)],
)
def test_a_corner_takes_the_tolerance_on_both_sides(degrees: float, part: float) -> None:
    tolerance, side, turn = 0.05, 14.0, math.radians(degrees)
    points = np.array([[-side, 0.0], [0.0, 0.0], [side * math.cos(turn), side * math.sin(turn)]])
    segments, _ = shaped(lines(points, tolerance, 0.0))
    there, back = both_ways(segments, points, tolerance)
    curves = [p for p in segments if p.kind == "curve"]
    first = curves[0].at(np.linspace(0.0, curves[0].length, 2001))[0]
    x, y = first[:, 0], first[:, 1]
    swing = (y < 0.0) | ((x > 0.0) & (x * math.sin(turn) > y * math.cos(turn)))
    outside = np.hypot(np.maximum(x, 0.0), y)[swing].max()  # off the line or its end
    inside = float(np.linalg.norm(first[-1, :2]))
    new, old = (
        least_time(segments, 1000.0, 100.0),
        least_time(one_quintic(turn, side, tolerance), 1000.0, 100.0),
    )
    print(
        f"{degrees} degrees: {curves[0].length:.3f} mm, out {outside:.5f}, in {inside:.5f}, off "
        f"{there:.5f} {back:.5f} of {tolerance}, {new:.5f} s, one quintic {old:.5f} s"
    )
    assert [p.kind for p in segments] == ["line", "curve", "curve", "line"]
    assert there <= tolerance and back <= tolerance
    assert 0.9 * tolerance < outside and 0.98 * tolerance < inside
    assert max(jumps(segments)) < 1e-8
    assert new < part * old
