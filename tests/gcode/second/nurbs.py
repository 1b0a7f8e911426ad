"""G5.2 and G5.3: a rational B-spline by SciPy in homogeneous coordinates."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import BSpline

from second.frames import end_point, machine, plane_axes
from second.moves import _made, speed
from second.parameters import Wrong
from second.state import State, Step
from second.words import Words

Points = NDArray[np.float64]


def curve(points: ArrayLike, weights: ArrayLike, order: int) -> BSpline:
    """Even knots, clamped at both ends."""
    place, weight = np.asarray(points, float), np.asarray(weights, float)
    n = len(place)
    inner = np.arange(n - order + 2)
    knots = np.concatenate([np.zeros(order - 1), inner, np.full(order - 1, n - order + 1.0)])
    return BSpline(knots, np.column_stack([place * weight[:, None], weight]), order - 1)


def places(spline: BSpline, count: int) -> Points:
    """As many points of the curve, even by its parameter."""
    found = spline(np.linspace(0.0, spline.t[-1], count))
    return np.asarray(found[:, :-1] / found[:, -1:])


def nurbs(s: State, w: Words) -> None:
    """A line with G5.2, with a point behind it, or with G5.3."""
    a, b = plane_axes(s.plane)
    letters = w.axes[a] + w.axes[b]
    point = w.has(letters)
    if w.code.get("motion") == 53 and not w.has(w.axes + "@^"):
        s.motion = -1
        _end(s)
        return
    turned = bool(s.nurbs) and s.plane != s.nurbs_plane
    if s.motion != 52 or turned or s.side or s.feed_mode == 930:
        raise Wrong("not between G5.2 and G5.3")
    weight = 1.0 if (given := w.one("p")) is None else given
    if weight <= 0.0 or (point and not all(w.has(c) for c in letters)):
        raise Wrong("weight, or point without both axes")
    s.nurbs_line = s.line
    if not s.nurbs:
        s.nurbs_plane = s.plane
        s.nurbs_order = w.whole("l", 3, 10) if w.has("l") else 3
        s.nurbs = [(list(s.point), 1.0 if point else weight)]
    elif not point:
        raise Wrong("line without a point")
    s.nurbs_feed = speed(s, 1.0)
    if point:
        at, s.point = s.point, list(s.nurbs[-1][0])
        end = machine(s, end_point(s, w))
        s.point = at
        s.nurbs.append((end, weight))
    if set(w.value) & set(w.axes) - set(letters):
        raise Wrong("not an axis of the plane")


def _end(s: State) -> None:
    points, s.nurbs = s.nurbs, []
    if not points or len(points) < s.nurbs_order:
        raise Wrong("G5.3 behind too few points")
    step = Step("nurbs", s.line, tuple(points[-1][0]), tuple(s.point), s.nurbs_feed)
    step.nurbs = tuple((*p[:3], weight) for p, weight in points)
    step.order = s.nurbs_order
    _made(s, step)


def samples(nurbs: Sequence[Sequence[float]], order: int, count: int) -> Points:
    """Points of the curve of a step. [mm]"""
    rows = np.asarray(nurbs)
    return places(curve(rows[:, :3], rows[:, 3], order), count)
