"""Lines, arcs and splines: from end points to steps."""

import itertools
import math

from second.frames import Vector, plane_axes
from second.parameters import Wrong
from second.state import State, Step

CLOSED = 1e-6  # [rad] ends nearer than this are the same
ROUNDING = 1e-9  # [mm] sums of offsets differ by less
# Ends of an arc may differ in radius by what rounding start, end and centre makes: sqrt(2) times
# 0.02 mm, in inch 2.54 times as much; or by so much of the radius, up to 100 times the least.
LEAST, SHARE, MOST = 0.02 * math.sqrt(2.0), 1e-3, 100.0  # [mm]


def way(a: Vector, b: Vector) -> float:
    """Length that a feed is measured along. [mm]"""
    main = math.dist(a[:3], b[:3])
    return main if main > 0.0 else math.dist(a[3:], b[3:])


def speed(s: State, length: float) -> float:
    """Feed of a motion of a length. [mm/s]"""
    if s.feed_mode == 930:
        return s.feed * length
    if s.feed_mode == 950:
        if s.by_radius or s.rpm == 0.0:
            raise Wrong("G95 with a spindle at rest, or with G96")
        return s.feed * s.speed / 60.0
    return s.feed


def _made(s: State, step: Step) -> None:
    step.set, step.clear = s.set, s.clear
    s.set = s.clear = 0
    step.analog, s.analog = s.analog, {}
    s.steps.append(step)
    s.point = list(step.end)


def straight(s: State, end: Vector, rapid: bool) -> None:
    """A line to a point in machine coordinates; none to where the tool is."""
    end = [a if abs(a - b) < ROUNDING else b for a, b in zip(s.point, end, strict=True)]
    length = way(s.point, end)
    if length == 0.0:
        return
    feed = 0.0 if rapid else speed(s, length)
    kind = "rapid" if rapid else "line"
    _made(s, Step(kind, s.line, tuple(end), tuple(s.point), feed))


def arc_centre(s: State, start: Vector, end: Vector, r: float, ccw: bool) -> Vector:
    """Centre by the radius; below 0 it is that of more than half a turn."""
    a, b = plane_axes(s.plane)
    dx, dy = end[a] - start[a], end[b] - start[b]
    half = math.hypot(dx, dy) / 2.0
    if r == 0.0 or half == 0.0:
        raise Wrong("radius or chord 0")
    short = abs(r) - half
    if short < -least(s):
        raise Wrong("radius shorter than half the chord")
    off = math.sqrt(max(0.0, abs(r) ** 2 - half**2))
    side = 1.0 if ccw == (r > 0.0) else -1.0  # the centre lies left of the chord
    return [
        (start[a] + end[a]) / 2.0 - side * off * dy / (2.0 * half),
        (start[b] + end[b]) / 2.0 + side * off * dx / (2.0 * half),
    ]


def least(s: State) -> float:
    """By how much the ends of any arc may differ in radius. [mm]"""
    return LEAST * (2.54 if s.inch else 1.0)


def arc(s: State, end: Vector, centre: Vector, ccw: bool, turns: int) -> None:
    """An arc about a centre, all in machine coordinates."""
    a, b = plane_axes(s.plane)
    u = s.point[a] - centre[0], s.point[b] - centre[1]
    v = end[a] - centre[0], end[b] - centre[1]
    first, last = math.hypot(*u), math.hypot(*v)
    if first == 0.0 or last == 0.0:
        raise Wrong("arc without radius")
    size = least(s) * abs(s.scale[a])
    allowed = min(max(size, SHARE * max(first, last)), MOST * size)
    if abs(first - last) > allowed:
        raise Wrong("end of the arc off its circle")
    turn = (math.atan2(v[1], v[0]) - math.atan2(u[1], u[0])) % math.tau
    if min(turn, math.tau - turn) < CLOSED:
        turn = math.tau if ccw else 0.0
    sweep = turn + math.tau * (turns - 1) if ccw else turn - math.tau * turns
    length = math.hypot((first + last) / 2.0 * sweep, end[s.plane] - s.point[s.plane])
    step = Step("arc", s.line, tuple(end), tuple(s.point), speed(s, length), s.plane)
    step.centre, step.sweep = (centre[0], centre[1]), sweep
    _made(s, step)


def spline(s: State, points: list[Vector]) -> None:
    """A Bezier curve with these points behind the start, in machine coordinates."""
    control = [(s.point[0], s.point[1])] + [(p[0], p[1]) for p in points]
    step = Step("spline", s.line, tuple(points[-1]), tuple(s.point))
    step.control = tuple(control)
    step.feed = speed(s, bezier_length(step.control))
    _made(s, step)


def bezier(control: tuple[tuple[float, float], ...], t: float) -> tuple[float, float]:
    """Point of a Bezier curve by de Casteljau."""
    points = list(control)
    while len(points) > 1:
        points = [
            (a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]))
            for a, b in itertools.pairwise(points)
        ]
    return points[0]


def bezier_length(control: tuple[tuple[float, float], ...], pieces: int = 400) -> float:
    """Length of a Bezier curve by chords, with their error of the second order taken out."""

    def chords(n: int) -> float:
        points = [bezier(control, i / n) for i in range(n + 1)]
        return sum(math.dist(a, b) for a, b in itertools.pairwise(points))

    return chords(2 * pieces) + (chords(2 * pieces) - chords(pieces)) / 3.0
