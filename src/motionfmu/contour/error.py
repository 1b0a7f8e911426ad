"""Contour error: every sample against the exact commanded geometry."""

import numpy as np

from motionfmu.contour.assign import Index, assign
from motionfmu.contour.circles import circular_tests
from motionfmu.contour.corners import find_corners
from motionfmu.contour.geometry import TURN, Arc, Array
from motionfmu.contour.path import Path
from motionfmu.contour.result import ContourInput, ContourResult
from motionfmu.contour.statistics import statistics
from motionfmu.contour.track import Track

# The tool is within exp(-5) = 0.7 % of a corner's following distance after five servo lags.
LAGS = 5.0
# Shortest servo window [s]: a loop with full feed-forward has no lag but still settles.
WINDOW_MIN = 0.05
# The tool may run ahead of the command by this part of the window: overshoot, feed-forward.
AHEAD = 0.2
# A circle counts when this many windows have passed since its start: exp(-10) of a transient.
SETTLE = 2.0
FIFO_DEPTH = 63
# Commands under way beside the FIFO stock: one in the DDA, one transaction of 16, one spare.
UNDER_WAY = 18


def analyse(run: ContourInput) -> ContourResult:
    """Find the contour error of a run against the exact geometry.

    First the pulses put out are followed along the path: each sample may lie on the segments
    whose points were written to the card within the time a command can wait in the FIFO, where
    two commands are mixed on both from the begin of the newer to the end of the older. Then
    the tool: it may lie on the segments where the pulses have been within the servo window.
    Both advance along the path and never return, see `motionfmu.contour.assign`.

    Parameters
    ----------
    run : ContourInput
        Geometry and signals.

    Raises
    ------
    ValueError
        The run never moves on a line, arc or helix.
    """
    path, time = run.path, run.time
    older = path.segment_of(np.maximum.accumulate(run.command))
    newer = older if run.newest is None else path.segment_of(np.maximum.accumulate(run.newest))
    newer = np.maximum(older, newer)
    wait = run.dda_time * (UNDER_WAY + (FIFO_DEPTH if run.stock is None else np.max(run.stock)))
    first, last = older[_at(time, -wait)], newer[_at(time, wait)]
    owners = assign(run.commanded[:, :3], path.segments, first, last)
    command_track = _follow(run.commanded, path, owners)
    lag = servo_lag(time, run.commanded[:, :3], run.actual[:, :3])
    window = max(LAGS * lag, WINDOW_MIN) if run.window is None else run.window
    back, ahead = _at(time, -window), _at(time, AHEAD * window)
    owners = assign(run.actual[:, :3], path.segments, owners[back], owners[ahead])
    track = _follow(run.actual, path, owners)
    tracks = (track, command_track)
    steps = np.any(np.diff(run.commanded[:, :3], axis=0) != 0.0, axis=1)
    count = np.concatenate([[0], np.cumsum(steps)])
    kinds = np.array([s.label.kind != "ptp" for s in path.segments])
    cutting = (count > count[back]) & kinds[track.segment]
    if not cutting.any():
        raise ValueError("the run never moves on a line, arc or helix: it has no contour")
    circles, missing = circular_tests(
        path, (time, run.actual[:, :3]), tracks, SETTLE * window, run.run_in
    )
    return ContourResult(
        run,
        track,
        command_track,
        cutting,
        lag,
        window,
        statistics(path, time, track, cutting),
        statistics(path, time, command_track, cutting & kinds[command_track.segment]),
        circles,
        find_corners(path, time, tracks, cutting, window),
        missing,
    )


def servo_lag(time: Array, commanded: Array, actual: Array) -> float:
    """Following distance over speed [s], by least squares; 0 if nothing moves or the tool leads."""
    span = min(max(1, round(0.002 / float(np.median(np.diff(time))))), len(time) - 1)
    speed = (commanded[span:] - commanded[:-span]) / (time[span:] - time[:-span])[:, None]
    gap = (commanded - actual)[span:]
    power = float(np.sum(speed * speed))
    return max(0.0, float(np.sum(speed * gap)) / power) if power > 0.0 else 0.0


def _at(time: Array, shift: float) -> Index:
    """Sample that holds at each time plus a shift."""
    found = np.searchsorted(time, time + shift, side="right") - 1
    return np.clip(found, 0, len(time) - 1)


def _follow(positions: Array, path: Path, owners: Index) -> Track:
    """Nearest points on the segments the samples belong to."""
    points = positions[:, :3]
    foot, along = np.empty_like(points), np.empty(len(points))
    distance, tangent = np.empty(len(points)), np.empty_like(points)
    place = np.cumsum(path.straight) - 1  # of a line among the lines
    flat = path.straight[owners]
    if flat.any():
        which = place[owners[flat]]
        near = path.lines.foot(points[flat], which)
        foot[flat], distance[flat] = near.point, near.distance
        tangent[flat] = path.lines.direction[which]
        along[flat] = path.offsets[owners[flat]] + near.along
    cuts = np.searchsorted(owners, np.arange(len(path.segments) + 1))
    for s in np.unique(owners[~flat]).tolist():
        own = slice(int(cuts[s]), int(cuts[s + 1]))
        segment = path.segments[s]
        near = segment.foot(points[own])
        foot[own], distance[own] = near.point, near.distance
        tangent[own] = segment.tangent(near.along)
        way = near.along
        if isinstance(segment, Arc) and segment.rise == 0.0:
            way = _unwrap(segment, way)
        along[own] = path.offsets[s] + way
    signed = None
    if path.normal is not None:
        left = np.cross(path.normal, tangent)
        side = np.sum((points - foot) * left, axis=1)
        signed = np.where(side < 0.0, -distance, distance)
    return Track(owners, along, foot, distance, signed)


def _unwrap(arc: Arc, along: Array) -> Array:
    """Way along a circle that may be run through more than once."""
    turn = TURN / arc.angle * arc.length
    way = np.unwrap(along, period=turn)
    return np.clip(way - turn * np.round(way[0] / turn), 0.0, arc.length)
