"""Corners of a path and the contour error there."""

import math

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.contour.arcs import Array
from motionfmu.analysis.contour.circles import SPEED_SPAN
from motionfmu.analysis.contour.instants import Instants
from motionfmu.analysis.contour.kinds import Corner
from motionfmu.analysis.contour.path import Path
from motionfmu.analysis.contour.ranges import largest, parts
from motionfmu.analysis.contour.segments import ARC, CUBIC, Index, Segments
from motionfmu.analysis.contour.track import Track

# Smallest change of direction that is called a corner [rad].
ANGLE_MIN = math.radians(10.0)
# A path that turns back by so much along an arc is run the other way: no corner [rad].
ANGLE_BACK = math.pi - ANGLE_MIN


def find_corners(
    path: Path,
    instants: Instants,
    tracks: tuple[Track, Track],
    cutting: NDArray[np.bool_],
    window: float,
) -> tuple[Corner, ...]:
    """Corners of the cutting moves, in the order of travel.

    To each belongs the time `window` [s] before and after it; `tracks` are those of the actual
    position and of the pulses put out, `cutting` are the samples that count.
    """
    track, command = tracks
    time = instants.time
    before, after, angle = _corners(path)
    if not len(before):
        return ()
    passed = np.searchsorted(track.segment, after)
    reached = passed < len(time)  # a run may end before a corner
    before, after, passed = before[reached], after[reached], passed[reached]
    angle = angle[reached]
    low = np.searchsorted(time, time[passed] - window)
    high = np.searchsorted(time, time[passed] + window)
    low = np.maximum(low, np.searchsorted(track.segment, before))
    high = np.minimum(high, np.searchsorted(track.segment, after, side="right"))
    upto = np.concatenate([[0], np.cumsum(cutting, dtype=np.int32)])
    own = np.flatnonzero(upto[high] > upto[low])
    before, after, low, high = before[own], after[own], low[own], high[own]
    angle = angle[own]
    speed = instants.speed(command.along, SPEED_SPAN)
    corners = []
    for some, rows, first in parts(low, high):
        cut = cutting[rows]
        error, worst = largest(np.where(cut, track.distance[rows], -1.0), first)
        slowest = np.minimum.reduceat(np.where(cut, speed[rows], np.inf), first)
        columns = (
            path.lines[before[some]],
            path.lines[after[some]],
            path.segments.columns.start[after[some]],
            angle[some],
            error,
            time[rows[worst]],
            slowest,
        )
        corners += [
            Corner(line, then, tuple(point), *rest)
            for line, then, point, *rest in zip(*(c.tolist() for c in columns), strict=True)
        ]
    return tuple(corners)


def _corners(path: Path) -> tuple[Index, Index, Array]:
    """The cutting moves before and after each corner, and its angle [rad]."""
    segments = path.segments
    moves = np.flatnonzero(path.cut & (path.lengths > 0.0))
    before, after = moves[:-1], moves[1:]
    # only moves without length lie between them
    still = np.concatenate([[0], np.cumsum(path.lengths > 0.0)])
    joined = still[after] - still[before] == 1
    before, after = before[joined], after[joined]
    a, b = _tangents(segments, before, "leaving"), _tangents(segments, after, "entering")
    (ax, ay, az), (bx, by, bz) = a.T, b.T
    cross = np.hypot(np.hypot(ay * bz - az * by, az * bx - ax * bz), ax * by - ay * bx)
    angle = np.arctan2(cross, ax * bx + ay * by + az * bz)
    shape = segments.columns.shape
    curved = (shape[before] == ARC) | (shape[after] == ARC)
    found = (angle >= ANGLE_MIN) & ~(curved & (angle > ANGLE_BACK))
    return before[found], after[found], angle[found]


def _tangents(segments: Segments, which: Index, end: str) -> Array:
    """Unit tangents (n, 3) at the begin (entering) or the end (leaving) of segments."""
    found = segments.directions[which]
    shape = segments.columns.shape[which]
    rows = np.flatnonzero(shape == ARC)
    if len(rows):
        arcs = segments.arcs[segments.place[which[rows]]]
        found[rows] = arcs.tangents(arcs.angle if end == "leaving" else 0.0 * arcs.angle)
    for i in np.flatnonzero(shape == CUBIC).tolist():
        curve = segments[int(which[i])]
        found[i] = curve.tangent(np.array([curve.length if end == "leaving" else 0.0]))[0]
    return found
