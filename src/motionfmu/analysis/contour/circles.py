"""Circles of a path, and their circular tests."""

import math
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from motionfmu.analysis.contour.arcs import TURN, Array, unwrapped
from motionfmu.analysis.contour.geometry import Arc, Segment
from motionfmu.analysis.contour.instants import Instants
from motionfmu.analysis.contour.iso230 import both_ways, reading
from motionfmu.analysis.contour.kinds import BothWays, CircleFigures
from motionfmu.analysis.contour.path import Path
from motionfmu.analysis.contour.scaled_values import ScaledValues, places
from motionfmu.analysis.contour.segments import ARC, Index
from motionfmu.analysis.contour.track import Track
from motionfmu.base.order import median

# Arcs belong to one circle if centre, radius and normal agree to this [mm; 1]: the rounding of
# a part program with four decimals.
SAME = 1e-3
# A circle is run steadily while its speed stays within this part of its median...
STEADY = 0.01
# ...measured over this time [s], and this part of the circle, in which pulse rounding averages out.
SPEED_SPAN = 0.02
SPEED_PART = 0.01
# An ellipse needs more than half the circle to be found well.
COVERAGE_MIN = 0.55 * TURN
# Five unknowns of the ellipse, twice over.
SAMPLES_MIN = 10


@dataclass(frozen=True)
class CirclePass:
    """One directed path round a circle."""

    first: int  # first segment
    last: int  # last segment
    lines: tuple[int, int]  # first and last line of the program
    points: Array  # (n, 2) samples used, from the nominal centre in the plane's axes [mm]
    time: Array  # (n,) of these samples [s]
    coverage: float  # angle they cover [rad]
    steady: bool  # without run-in and run-out; false if the circle is too short for that
    speed: float  # median speed of the command over these samples [mm/s]
    reading: CircleFigures

    def numbers(self) -> dict[str, Any]:
        """Its numbers, ready for JSON."""
        out = {"lines": list(self.lines), "coverage": self.coverage, "speed": self.speed}
        rest = {"steady": self.steady, "samples": len(self.points)}
        return out | rest | asdict(self.reading)


@dataclass(frozen=True)
class CircularTest:
    """Circular test of one circle, in one direction or both."""

    place: int  # number of the circle among those of the path, from 0
    centre: Array  # (3,) [mm]
    normal: Array  # (3,) points to the positive side of its largest component
    radius: float  # [mm]
    axes: Array  # (2, 3) first and second axis of the plane: XY, YZ or ZX for the main planes
    ccw: CirclePass | None = None  # seen from the positive end of the normal
    cw: CirclePass | None = None
    both: BothWays | None = None  # if both directions are there

    def numbers(self) -> dict[str, Any]:
        """Its numbers, ready for JSON."""
        return {
            "centre": self.centre.tolist(),
            "normal": self.normal.tolist(),
            "radius": self.radius,
            "ccw": self.ccw.numbers() if self.ccw else None,
            "cw": self.cw.numbers() if self.cw else None,
            "both": asdict(self.both) if self.both else None,
        }


def circular_tests(
    path: Path,
    samples: tuple[Instants, Array | ScaledValues],
    tracks: tuple[Track, Track],
    settle: float,
    run_in: float | None,
) -> tuple[tuple[CircularTest, ...], dict[str, str]]:
    """Circular tests of all full circles of a path; a circle run both ways is one.

    `samples` are times and actual position (n, 3) [mm], `tracks` those of the actual
    position and of the pulses put out. Left out are `settle` [s] after the speed or the curvature
    has changed and `run_in` [rad] at both ends; None leaves out what is not steady. The second
    result is the reason by ``circles.<place>.<way>`` of each that has no test.
    """
    circles: list[CircularTest] = []
    run: list[set[str]] = []  # directions in which the path goes round each circle
    missing: dict[str, str] = {}
    for ends in _full_circles(path):
        arc = path.segments[ends[0]]
        assert isinstance(arc, Arc)
        normal = arc.axis * np.sign(arc.axis[np.argmax(np.abs(arc.axis))])
        name = "ccw" if float(arc.axis @ normal) > 0.0 else "cw"
        bare = CircularTest(len(circles), arc.centre, normal, arc.radius, plane_axes(normal))
        others = (c for c in circles if name not in run[c.place] and _same(c, bare))
        place = next(others, bare).place
        if place == len(circles):
            circles.append(bare)
            run.append(set())
        run[place].add(name)
        found = _way(path, ends, samples, tracks, (settle, run_in))
        if isinstance(found, str):
            missing[f"circles.{place}.{name}"] = f"line {arc.label.line}: {found}"
            continue
        test = circles[place]
        test = replace(test, ccw=found) if name == "ccw" else replace(test, cw=found)
        if test.ccw and test.cw:
            test = replace(test, both=both_ways(test.ccw.points, test.cw.points, test.radius))
        circles[place] = test
    return tuple(c for c in circles if c.ccw or c.cw), missing


def _way(
    path: Path,
    ends: tuple[int, int],
    samples: tuple[Instants, Array | ScaledValues],
    tracks: tuple[Track, Track],
    left_out: tuple[float, float | None],
) -> CirclePass | str:
    """The circular test of one directed path, or why there is none."""
    arc, (settle, run_in) = path.segments[ends[0]], left_out
    assert isinstance(arc, Arc)
    normal = arc.axis * np.sign(arc.axis[np.argmax(np.abs(arc.axis))])
    time, along = samples[0].time, tracks[1].along
    a, b = np.searchsorted(tracks[0].segment, [ends[0], ends[1] + 1]).tolist()
    if b - a < SAMPLES_MIN:
        return f"{b - a} samples on it, {SAMPLES_MIN} wanted"
    span = max(SPEED_SPAN, SPEED_PART * float(time[b - 1] - time[a]))
    if run_in is None:
        first, last = np.searchsorted(tracks[1].segment, [ends[0], ends[1] + 1]).tolist()
        begin, end = min(a, first), max(b, last)
        speed = samples[0].speed(along, span, slice(begin, end))
        low, high = _steady(time[first:last], speed[first - begin : last - begin], settle)
        speed = speed[a - begin : b - begin]
        chosen = np.arange(*np.searchsorted(time[a:b], [low, np.nextafter(high, np.inf)]))
    else:
        speed = samples[0].speed(along, span, slice(a, b))
        low, high = path.offsets[ends[0]], path.offsets[ends[1] + 1]
        skip = run_in * arc.radius
        way = tracks[0].along[a:b]
        chosen = np.flatnonzero((way >= low + skip) & (way <= high - skip))
    points = _in_plane(places(samples[1], slice(a, b)) - arc.centre, plane_axes(normal))
    kept, covered = _whole_turns(points, chosen)
    steady = covered >= COVERAGE_MIN
    if not steady:
        kept, covered = _whole_turns(points, np.arange(b - a))
    if covered < COVERAGE_MIN:
        wanted = math.degrees(COVERAGE_MIN)
        return f"the tool covers {math.degrees(covered):.0f} degrees of it, {wanted:.0f} wanted"
    own = _taken(points, kept)
    try:
        quantities = reading(own, arc.radius)
    except ArithmeticError as error:
        return str(error)
    return CirclePass(
        *ends,
        lines=(arc.label.line, int(path.lines[ends[1]])),
        points=own,
        time=np.asarray(time[a:b])[kept],
        coverage=covered,
        steady=steady,
        speed=median(speed[kept]),
        reading=quantities,
    )


def _in_plane(gaps: Array, axes: Array) -> Array:
    """Vectors (n, 3) along two axes (2, 3): (n, 2)."""
    found = np.empty((2, len(gaps)))
    for out, (x, y, z) in zip(found, axes.tolist(), strict=True):
        np.add(x * gaps[:, 0] + y * gaps[:, 1], z * gaps[:, 2], out=out)
    return found.T


def _taken(points: Array, rows: Index) -> Array:
    """Some points (n, 2), each column in a piece."""
    return np.stack([points[rows, 0], points[rows, 1]]).T


def plane_axes(normal: Array) -> Array:
    """Axes (2, 3) of the plane with a unit normal, right-handed; for main planes XY, YZ or ZX."""
    main = int(np.argmax(np.abs(normal)))
    first = np.eye(3)[(main + 1) % 3]
    first = first - (first @ normal) * normal
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(normal, first)])


def _full_circles(path: Path) -> list[tuple[int, int]]:
    """First and last segment of each run of arcs that makes a full turn or more."""
    columns = path.segments.columns
    rows = np.flatnonzero(columns.shape == ARC)
    angle, rise = columns.turned[:, 0], columns.turned[:, 1]
    # Arcs that are equal to the first of a group within a tolerance are equal to their neighbours
    # within twice of it. So groups of equal neighbours are found first; few turn far enough.
    alike = (np.diff(rows) == 1) & (np.abs(np.diff(columns.centre, axis=0)).max(axis=1) <= 2 * SAME)
    starts = np.flatnonzero(np.concatenate([[True], ~alike])[: len(rows)])
    found = []
    turned = np.add.reduceat(angle, starts) if len(rows) else angle
    for k in np.flatnonzero(turned >= TURN * (1.0 - 1e-9)).tolist():
        i, end = int(starts[k]), int(starts[k + 1]) if k + 1 < len(starts) else len(rows)
        while i < end:
            head, j, total = path.segments[int(rows[i])], i, 0.0
            while j < end and not rise[j] and _continues(head, path.segments[int(rows[j])]):
                total += float(angle[j])
                j += 1
            if total >= TURN * (1.0 - 1e-9):
                found.append((int(rows[i]), int(rows[j - 1])))
            i = max(j, i + 1)
    return found


def _continues(head: Segment, other: Segment) -> bool:
    if not isinstance(head, Arc) or not isinstance(other, Arc) or head.rise:
        return False
    near = np.abs(head.centre - other.centre).max() <= SAME
    alike = abs(head.radius - other.radius) <= SAME and head.axis @ other.axis >= 1.0 - SAME
    return bool(near and alike)


def _steady(time: Array, speed: Array, settle: float) -> tuple[float, float]:
    """Begin and end of the longest steady part of a circle, after it has settled [s]."""
    # The tool may rest at an end for long, so the usual speed is taken of samples in motion.
    moving = speed > 0.1 * float(speed.max(initial=0.0))
    middle = median(speed[moving]) if moving.any() else 0.0
    good = np.abs(speed - middle) <= STEADY * middle
    edges = np.flatnonzero(np.diff(np.concatenate([[False], good, [False]])))
    if not len(edges):
        return math.inf, -math.inf
    begins, stops = edges[::2], edges[1::2]
    longest = int(np.argmax(stops - begins))
    return float(time[begins[longest]]) + settle, float(time[stops[longest] - 1]) - 0.5 * SPEED_SPAN


def _whole_turns(points: Array, chosen: Index) -> tuple[Index, float]:
    """Samples of all whole turns, or all if there is none, and the angle they cover [rad]."""
    if not len(chosen):
        return chosen, 0.0
    angle = unwrapped(np.arctan2(points[chosen, 1], points[chosen, 0]), TURN)
    way = np.abs(angle - angle[0])
    turns = math.floor(float(way[-1]) / TURN)
    count = int(np.searchsorted(way, turns * TURN, side="right")) if turns else len(way)
    return chosen[:count], float(way[count - 1]) if count >= SAMPLES_MIN else 0.0


def _same(one: CircularTest, other: CircularTest) -> bool:
    return bool(
        np.abs(one.centre - other.centre).max() <= SAME
        and abs(one.radius - other.radius) <= SAME
        and one.normal @ other.normal >= 1.0 - SAME
    )
