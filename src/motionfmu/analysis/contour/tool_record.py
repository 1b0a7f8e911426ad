"""Contour error of a measured tool position, of which only the program's path is known.

A run tells which command it is at; a record does not. What it tells is how far the tool has
travelled, and in what order. So each sample may lie on the segments about the place that is as far
along the path as the tool has come, and among these it is assigned as in a run: always forward.
"""

from dataclasses import dataclass

import numpy as np

from motionfmu.analysis.contour.arcs import Array
from motionfmu.analysis.contour.assign import assign
from motionfmu.analysis.contour.circles import SPEED_SPAN, circular_tests
from motionfmu.analysis.contour.contour_result import ContourInput, ContourResult
from motionfmu.analysis.contour.corners import find_corners
from motionfmu.analysis.contour.error import SETTLE, WINDOW_MIN, statistics
from motionfmu.analysis.contour.geometry import norms
from motionfmu.analysis.contour.instants import Instants
from motionfmu.analysis.contour.path import Path
from motionfmu.analysis.contour.track import follow

# The tool has moved when it is this far from where it last was [mm], or as many times the noise.
MOVED, NOISES = 0.01, 10.0
# The way that is found is off by as much as the whole ways differ, and by this [mm; 1].
OFF, OFF_PART = 0.2, 1e-3
# Ways of record and program that differ by more than this part are of two programs.
DIFFERENT = 0.1
# The tool moves while it is quicker than this part of its largest speed, and than noise makes it.
STANDS = 1e-3


@dataclass(frozen=True)
class ToolRecord:
    """Positions of the tool that were measured.

    Attributes
    ----------
    time : ndarray, shape (n,)
        [s], increasing.
    points : ndarray, shape (n, 3)
        X, Y, Z in the program's coordinates [mm].
    axes : tuple of int
        Axes that the program moves, 0 to 2.
    """

    time: Array
    points: Array
    axes: tuple[int, ...] = (0, 1, 2)


def analyse_record(record: ToolRecord, path: Path, window: float = WINDOW_MIN) -> ContourResult:
    """Find the contour error of a measured position.

    Parameters
    ----------
    record : ToolRecord
        Of the whole program, from before its first motion to behind its last.
    path : Path
        The planned geometry.
    window : float
        How long before and behind a corner its error is looked for [s]; that of a run fits.

    Returns
    -------
    ContourResult
        With error, circles and corners. It knows no pulses, so nothing follows and nothing lags:
        ``commanded`` is the nearest point of the path, the command error is 0.

    Raises
    ------
    ValueError
        The record's way is not the program's, or it never cuts.
    """
    time, points = record.time, record.points
    noise = _noise(points)
    moved = _travelled(points, max(MOVED, NOISES * noise))
    whole, wanted = float(moved[-1]), float(path.offsets[-1])
    if abs(whole - wanted) > DIFFERENT * wanted:
        told = f"the tool travels {whole:.5g} mm in the record, {wanted:.5g} mm in the program"
        raise ValueError(f"{told}: a record of the whole program wanted, in its coordinates")
    along = moved * (wanted / whole)
    off = abs(whole - wanted) + OFF + OFF_PART * wanted
    ends = path.offsets[1:]
    last = len(path.segments) - 1
    first = np.minimum(np.searchsorted(ends, along - off), last)
    behind = np.minimum(np.searchsorted(ends, along + off), last)
    owners = assign(points, path, first, behind)
    track = follow(points, path, owners)
    instants = Instants(time)
    speed = instants.speed(track.along, SPEED_SPAN)
    stands = max(STANDS * float(speed.max()), 2.0 * noise / SPEED_SPAN)
    cutting = path.cut[track.segment] & (speed > stands)
    if not cutting.any():
        raise ValueError("the tool never moves on a line, arc or helix: it has no contour")
    wide = np.zeros((2, len(time), 6))
    wide[0, :, :3], wide[1, :, :3] = points, track.foot
    given = ContourInput(
        path=path,
        time=time,
        actual=wide[0],
        commanded=wide[1],
        command=np.asarray(path.commands[track.segment]),
        axes=record.axes,
        window=window,
    )
    tracks = (track, track)
    circles, missing = circular_tests(path, (instants, wide[0]), tracks, SETTLE * window, None)
    corners = find_corners(path, instants, tracks, cutting, window)
    exact = follow(track.foot, path, owners)
    return ContourResult(
        run=given,
        track=track,
        command_track=exact,
        cutting=cutting,
        lag=0.0,
        window=window,
        error=statistics(path, time, track, cutting),
        command_error=statistics(path, time, exact, cutting),
        circles=circles,
        corners=corners,
        missing=missing,
    )


def _noise(points: Array) -> float:
    """Scatter of the samples [mm], by their second differences: sqrt(6) times as large."""
    bend = np.abs(np.diff(points, n=2, axis=0))
    return float(np.median(bend, axis=0).max() / (0.6745 * np.sqrt(6.0))) if len(bend) else 0.0


def _travelled(points: Array, least: float) -> Array:
    """The way of the tool (n,) from the first sample on [mm], in pieces of a length at least."""
    kept = [0]
    x, y, z = (float(c) for c in points[0])
    square = least * least
    for k, (a, b, c) in enumerate(points.tolist()):
        if (a - x) ** 2 + (b - y) ** 2 + (c - z) ** 2 >= square:
            kept.append(k)
            x, y, z = a, b, c
    way = np.concatenate([[0.0], np.cumsum(norms(np.diff(points[kept], axis=0)))])
    if way[-1] == 0.0:
        raise ValueError("the tool does not move in the record")
    return np.asarray(np.interp(np.arange(len(points)), kept, way))
