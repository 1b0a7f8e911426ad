"""G2, G3, G5, G5.1: the words of a line as an arc or a curve."""

import math

from second.frames import end_point, machine, plane_axes, program
from second.moves import arc, arc_centre, spline
from second.parameters import Wrong
from second.state import State
from second.words import Words


def arc_of(s: State, w: Words) -> None:
    """An arc by centre or radius."""
    axes = plane_axes(s.plane)
    names = ["ijk"[i] for i in axes]
    turns = w.whole("p", 1, 10000) if w.has("p") and w.code.get("path") != 640 else 1
    if s.feed_mode == 930 and not w.has("f"):
        raise Wrong("G93 without F")
    closed = not w.has(w.axes)
    end = end_point(s, w)
    start = program(s, s.point)
    ccw = s.motion == 30
    radius = w.one("r")
    offsets = w.use("".join(names))
    if any(w.use("ijk"[s.plane]).values()):
        raise Wrong("centre along the normal")
    if (radius is None) == (not offsets):
        raise Wrong("arc with neither centre nor radius, or with both")
    if radius is not None:
        centre = arc_centre(s, start, end, radius * s.unit, ccw)
    else:
        if s.absolute_centre and len(offsets) < 2:
            raise Wrong("half a centre")
        base = [0.0, 0.0] if s.absolute_centre else [start[i] for i in axes]
        centre = [b + offsets.get(n, 0.0) * s.unit for b, n in zip(base, names, strict=True)]
    if closed and radius is not None:
        raise Wrong("radius without end")
    ratio = abs(s.scale[axes[0]])
    if ratio != abs(s.scale[axes[1]]) or (s.rotated and s.turn_plane != s.plane):
        raise Wrong("circle that is none any more")
    if s.turns[s.system] != 0.0 and s.plane != 2:
        raise Wrong("circle that is none any more")
    whole = list(start)
    for i, value in zip(axes, centre, strict=True):
        whole[i] = value
    place = machine(s, whole)
    mirrored = math.copysign(1.0, s.scale[axes[0]] * s.scale[axes[1]]) < 0.0
    arc(s, machine(s, end), [place[i] for i in axes], ccw != mirrored, turns)


def splines(s: State, w: Words) -> None:
    """G5 cubic, G5.1 quadratic, both in XY."""
    if s.plane != 2 or w.has("zabcuvw"):
        raise Wrong("spline outside XY")
    if s.feed_mode == 930 and not w.has("f"):
        raise Wrong("G93 without F")
    unit = s.unit
    end = end_point(s, w)
    start = program(s, s.point)
    ij = w.use("ij")
    if s.motion == 51:
        if not any(ij.values()):
            raise Wrong("G5.1 without I and J")
        points = [[start[0] + ij.get("i", 0.0) * unit, start[1] + ij.get("j", 0.0) * unit]]
    else:
        pq = w.use("pq")
        if len(pq) < 2 or len(ij) == 1 or (not ij and s.spline is None):
            raise Wrong("G5 without P, Q or I, J")
        out = (ij["i"] * unit, ij["j"] * unit) if ij else s.spline
        assert out is not None
        back = (pq["p"] * unit, pq["q"] * unit)
        points = [
            [start[0] + out[0], start[1] + out[1]],
            [end[0] + back[0], end[1] + back[1]],
        ]
        s.spline = (-back[0], -back[1])
    full = [machine(s, [*p, *start[2:]]) for p in points]
    spline(s, [*full, machine(s, end)])
