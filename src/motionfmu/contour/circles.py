"""Circles of a program: where they are, and their circular tests."""

import math
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.contour.assign import Index
from motionfmu.contour.geometry import TURN, Arc, Array, Segment
from motionfmu.contour.iso230 import BothWays, Reading, both_ways, reading
from motionfmu.contour.path import Path
from motionfmu.contour.track import Track

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
class Way:
    """One directed path round a circle."""

    first: int  # first segment
    last: int  # last segment
    lines: tuple[int, int]  # first and last line of the program
    points: Array  # (n, 2) samples that count, from the nominal centre in the plane's axes [mm]
    time: Array  # (n,) of these samples [s]
    coverage: float  # angle they cover [rad]
    steady: bool  # run-in and run-out are left out; false if the circle is too short for that
    speed: float  # median of the command's over them [mm/s]
    reading: Reading

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
    ccw: Way | None = None  # seen from the positive end of the normal
    cw: Way | None = None
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
    samples: tuple[Array, Array],
    tracks: tuple[Track, Track],
    settle: float,
    run_in: float | None,
) -> tuple[tuple[CircularTest, ...], dict[str, str]]:
    """Circular tests of all full circles of a path; a circle run both ways is one.

    `samples` are time (n,) [s] and actual position (n, 3) [mm], `tracks` those of the actual
    position and of the pulses put out. Left out are `settle` [s] after the speed or the curvature
    has changed and `run_in` [rad] at both ends; None leaves out what is not steady. The second
    result is the reason by ``circles.<place>.<way>`` of each that has no test.
    """
    circles: list[CircularTest] = []
    run: list[set[str]] = []  # ways round each that the path has
    missing: dict[str, str] = {}
    for ends in _full_circles(path.segments):
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
    samples: tuple[Array, Array],
    tracks: tuple[Track, Track],
    left_out: tuple[float, float | None],
) -> Way | str:
    """The circular test of one directed path, or why there is none."""
    arc, (settle, run_in) = path.segments[ends[0]], left_out
    assert isinstance(arc, Arc)
    normal = arc.axis * np.sign(arc.axis[np.argmax(np.abs(arc.axis))])
    on = np.flatnonzero((tracks[0].segment >= ends[0]) & (tracks[0].segment <= ends[1]))
    if len(on) < SAMPLES_MIN:
        return f"{len(on)} samples on it, {SAMPLES_MIN} wanted"
    span = max(SPEED_SPAN, SPEED_PART * float(samples[0][on[-1]] - samples[0][on[0]]))
    speed = speed_along(samples[0], tracks[1].along, span)
    if run_in is None:
        chosen = _steady(samples[0], speed, (tracks[1].segment, ends), settle)
    else:
        low, high = path.offsets[ends[0]], path.offsets[ends[1] + 1]
        skip = run_in * arc.radius
        chosen = (tracks[0].along >= low + skip) & (tracks[0].along <= high - skip)
    points = (samples[1] - arc.centre) @ plane_axes(normal).T
    kept = _whole_turns(points, on[chosen[on]])
    steady = _coverage(points, kept) >= COVERAGE_MIN
    if not steady:
        kept = _whole_turns(points, on)
    if (covered := _coverage(points, kept)) < COVERAGE_MIN:
        wanted = math.degrees(COVERAGE_MIN)
        return f"the tool covers {math.degrees(covered):.0f} degrees of it, {wanted:.0f} wanted"
    try:
        quantities = reading(points[kept], arc.radius)
    except ArithmeticError as error:
        return str(error)
    return Way(
        *ends,
        lines=(arc.label.line, path.segments[ends[1]].label.line),
        points=points[kept],
        time=samples[0][kept],
        coverage=covered,
        steady=steady,
        speed=float(np.median(speed[kept])),
        reading=quantities,
    )


def plane_axes(normal: Array) -> Array:
    """Axes (2, 3) of the plane with a unit normal, right-handed; for main planes XY, YZ or ZX."""
    main = int(np.argmax(np.abs(normal)))
    first = np.eye(3)[(main + 1) % 3]
    first = first - (first @ normal) * normal
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(normal, first)])


def _full_circles(segments: tuple[Segment, ...]) -> list[tuple[int, int]]:
    """First and last segment of each run of arcs that makes a full turn or more."""
    found = []
    i = 0
    while i < len(segments):
        j, turned = i, 0.0
        head = segments[i]
        while j < len(segments) and _continues(head, segments[j]):
            turned += segments[j].angle  # type: ignore[union-attr]
            j += 1
        if turned >= TURN * (1.0 - 1e-9):
            found.append((i, j - 1))
        i = max(j, i + 1)
    return found


def _continues(head: Segment, other: Segment) -> bool:
    if not isinstance(head, Arc) or not isinstance(other, Arc) or other.rise or head.rise:
        return False
    near = np.abs(head.centre - other.centre).max() <= SAME
    alike = abs(head.radius - other.radius) <= SAME and head.axis @ other.axis >= 1.0 - SAME
    return bool(near and alike)


def _steady(
    time: Array, speed: Array, where: tuple[Index, tuple[int, int]], settle: float
) -> NDArray[np.bool_]:
    """Samples of the longest steady part of a circle, after it has settled."""
    segment, ends = where
    inside = (segment >= ends[0]) & (segment <= ends[1])
    # The tool may rest at an end for long: the usual speed is that of the samples in motion.
    moving = inside & (speed > 0.1 * float(speed[inside].max(initial=0.0)))
    middle = float(np.median(speed[moving])) if moving.any() else 0.0
    good = inside & (np.abs(speed - middle) <= STEADY * middle)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], good.astype(int), [0]])))
    if not len(edges):
        return good
    begins, stops = edges[::2], edges[1::2]
    longest = int(np.argmax(stops - begins))
    begin, end = time[begins[longest]] + settle, time[stops[longest] - 1] - 0.5 * SPEED_SPAN
    return (time >= begin) & (time <= end)


def speed_along(time: Array, along: Array, span: float) -> Array:
    """Speed [mm/s] of a way along the path [mm], averaged over `span` [s]."""
    low = np.maximum(time - 0.5 * span, time[0])
    high = np.minimum(time + 0.5 * span, time[-1])
    return (np.interp(high, time, along) - np.interp(low, time, along)) / (high - low)


def _turned(points: Array, chosen: Index) -> Array:
    """Angle turned through since the first of some samples [rad]."""
    angle = np.unwrap(np.arctan2(points[chosen, 1], points[chosen, 0]))
    return np.abs(angle - angle[0]) if len(angle) else angle


def _coverage(points: Array, chosen: Index) -> float:
    return float(_turned(points, chosen)[-1]) if len(chosen) >= SAMPLES_MIN else 0.0


def _whole_turns(points: Array, chosen: Index) -> Index:
    """As many whole turns as there are; all samples if there is not one."""
    way = _turned(points, chosen)
    turns = math.floor(float(way[-1]) / TURN) if len(way) else 0
    return chosen[: np.searchsorted(way, turns * TURN, side="right")] if turns else chosen


def _same(one: CircularTest, other: CircularTest) -> bool:
    return bool(
        np.abs(one.centre - other.centre).max() <= SAME
        and abs(one.radius - other.radius) <= SAME
        and one.normal @ other.normal >= 1.0 - SAME
    )
