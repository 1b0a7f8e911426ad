"""Corners of a path and the contour error there."""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from motionfmu.contour.circles import SPEED_SPAN, speed_along
from motionfmu.contour.geometry import Arc, Array, Line, Segment
from motionfmu.contour.path import Path
from motionfmu.contour.track import Track

# Smallest change of direction that is called a corner [rad].
ANGLE_MIN = math.radians(10.0)
# A path that turns back by so much along an arc is run the other way: no corner [rad].
ANGLE_BACK = math.pi - ANGLE_MIN


@dataclass(frozen=True)
class Corner:
    """A corner between two cutting moves."""

    line_before: int  # of the program
    line_after: int
    point: tuple[float, float, float]  # [mm]
    angle: float  # change of direction; pi for a line that turns back [rad]
    error: float  # largest contour error on the two moves within the servo window [mm]
    time: float  # when it is largest [s]
    speed: float  # least commanded speed within the servo window [mm/s]


def find_corners(
    path: Path,
    time: Array,
    tracks: tuple[Track, Track],
    cutting: NDArray[np.bool_],
    window: float,
) -> tuple[Corner, ...]:
    """Corners of the cutting moves, in the order of travel.

    To each belongs the time `window` [s] before and after it; `tracks` are those of the actual
    position and of the pulses put out, `cutting` are the samples that count.
    """
    track, command = tracks
    speed = speed_along(time, command.along, SPEED_SPAN)
    moves = [s for s, move in enumerate(path.segments) if move.length and cutting_move(path, s)]
    corners = []
    for before, after in pairwise(moves):
        if not _joined(path, before, after):
            continue
        first, second = path.segments[before], path.segments[after]
        angle = _turn(_leaving(first), _entering(second))
        curved = isinstance(first, Arc) or isinstance(second, Arc)
        if angle < ANGLE_MIN or (curved and angle > ANGLE_BACK):
            continue
        passed = int(np.searchsorted(track.segment, after))
        if passed == len(time):  # the run ends before
            break
        low = int(np.searchsorted(time, time[passed] - window))
        high = int(np.searchsorted(time, time[passed] + window))
        low = max(low, int(np.searchsorted(track.segment, before)))
        high = min(high, int(np.searchsorted(track.segment, after, side="right")))
        own = low + np.flatnonzero(cutting[low:high])
        if not len(own):
            continue
        worst = int(own[np.argmax(track.distance[own])])
        x, y, z = (float(c) for c in second.start)
        corners.append(
            Corner(
                first.label.line,
                second.label.line,
                (x, y, z),
                angle,
                float(track.distance[worst]),
                float(time[worst]),
                float(speed[own].min()),
            )
        )
    return tuple(corners)


def cutting_move(path: Path, segment: int) -> bool:
    """Whether a segment is cut: a line, arc or helix."""
    return path.segments[segment].label.kind != "ptp"


def _joined(path: Path, before: int, after: int) -> bool:
    """Whether nothing but moves without length lies between two segments."""
    return all(path.segments[s].length == 0.0 for s in range(before + 1, after))


def _entering(segment: Segment) -> Array:
    """Unit tangent (3,) at the start."""
    return segment.direction if isinstance(segment, Line) else segment.tangent(np.zeros(1))[0]


def _leaving(segment: Segment) -> Array:
    """Unit tangent (3,) at the end."""
    if isinstance(segment, Line):
        return segment.direction
    return segment.tangent(np.array([segment.length]))[0]


def _turn(before: Array, after: Array) -> float:
    (a, b, c), (x, y, z) = before.tolist(), after.tolist()  # np.cross takes 20 us
    cross = math.hypot(b * z - c * y, c * x - a * z, a * y - b * x)
    return math.atan2(cross, float(before @ after))
