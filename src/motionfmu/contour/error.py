"""Contour error: every sample against the exact commanded geometry."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.contour.arcs import Array
from motionfmu.contour.assign import assign
from motionfmu.contour.circles import circular_tests
from motionfmu.contour.corners import find_corners
from motionfmu.contour.path import Path
from motionfmu.contour.result import ContourInput, ContourResult
from motionfmu.contour.scaled import blocks
from motionfmu.contour.segments import Index
from motionfmu.contour.statistics import statistics
from motionfmu.contour.track import follow

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


def analyse(
    run: ContourInput, progress: Callable[[float], None] = lambda share: None
) -> ContourResult:
    """Find the contour error of a run against the exact geometry.

    First the pulses put out are followed along the path: each sample may lie on the segments
    whose points were written to the card within the time a command can wait in the FIFO, where
    two commands are mixed on both from the begin of the newer to the end of the older. Then
    the tool: it may lie on the segments where the pulses have been within the servo window.
    Both advance along the path and never return, see `motionfmu.contour.assign`.

    Parameters
    ----------
    run : ContourInput
        Geometry and signals, which may be memory maps: they are read in parts.
    progress : callable
        Told the share that is done, 0 to 1.

    Raises
    ------
    ValueError
        The run never moves on a line, arc or helix.
    """
    path, time = run.path, run.time
    owners = assign(run.commanded, path, *_written(run))
    progress(0.25)
    command_track = follow(run.commanded, path, owners)
    progress(0.4)
    lag = servo_lag(time, run.commanded, run.actual)
    window = max(LAGS * lag, WINDOW_MIN) if run.window is None else run.window
    candidates = shifted(owners, time, -window), shifted(owners, time, AHEAD * window)
    owners = assign(run.actual, path, *candidates)
    del candidates
    progress(0.7)
    track = follow(run.actual, path, owners)
    progress(0.85)
    tracks = (track, command_track)
    cutting = path.cut[track.segment]
    cutting &= _moved(run.commanded, time, window)
    if not cutting.any():
        raise ValueError("the run never moves on a line, arc or helix: it has no contour")
    circles, missing = circular_tests(path, (time, run.actual), tracks, SETTLE * window, run.run_in)
    corners = find_corners(path, time, tracks, cutting, window)
    both = cutting & path.cut[command_track.segment]
    errors = statistics(path, time, track, cutting), statistics(path, time, command_track, both)
    progress(1.0)
    return ContourResult(
        run, track, command_track, cutting, lag, window, *errors, circles, corners, missing
    )


def servo_lag(time: Array, commanded: Any, actual: Any) -> float:
    """Following distance over speed [s], by least squares; 0 if nothing moves or the tool leads."""
    span = min(max(1, round(0.002 / float(np.median(np.diff(time))))), len(time) - 1)
    power = product = 0.0
    for own in blocks(len(time) - span, time, commanded, actual):
        later = slice(own.start + span, own.stop + span)
        place = np.asarray(commanded[later])[:, :3]
        duration = (time[later] - time[own])[:, None]
        speed = (place - np.asarray(commanded[own])[:, :3]) / duration
        power += float(np.einsum("ij,ij->", speed, speed))
        gap = place - np.asarray(actual[later])[:, :3]
        product += float(np.einsum("ij,ij->", speed, gap))
    return max(0.0, product / power) if power > 0.0 else 0.0


def shifted(values: Any, time: Array, shift: float) -> Any:
    """Of values (n,) those that hold at each time plus a shift."""
    found = np.empty_like(values)
    for own in blocks(len(time), time):
        found[own] = values[_at(time, own, shift)]
    return found


def _at(time: Array, own: slice, shift: float) -> Index:
    """Sample that holds at some times plus a shift."""
    last = len(time) - 1
    goal = np.asarray(time[own]) + shift
    # Where the samples are even it is known, which is seen by looking there.
    even = np.arange(own.start, own.stop) + math.floor(shift / _step(time))
    found = np.clip(even, 0, last)
    found += (found < last) & (time[np.minimum(found + 1, last)] <= goal)
    wrong = (time[found] > goal) & (found > 0)
    wrong |= (found < last) & (time[np.minimum(found + 1, last)] <= goal)
    if wrong.any():
        rest = np.searchsorted(time, goal[wrong], side="right") - 1
        found[wrong] = np.clip(rest, 0, last)
    return found


def _step(time: Array) -> float:
    return float(time[-1] - time[0]) / (len(time) - 1)


def _written(run: ContourInput) -> tuple[Index, Index]:
    """First and last segment on which the pulses may be, by what was written to the card (n,)."""
    path, time = run.path, run.time
    older = _segments(path, run.command)
    newer = older if run.newest is None else np.maximum(older, _segments(path, run.newest))
    wait = run.dda_time * (UNDER_WAY + (FIFO_DEPTH if run.stock is None else np.max(run.stock)))
    return shifted(older, time, -wait), shifted(newer, time, wait)


def _segments(path: Path, command: Index) -> Index:
    """Segment of the newest command so far (n,)."""
    found = np.empty(len(command), dtype=np.int32)
    newest = command[0]
    for own in blocks(len(command), command):
        upto = np.maximum.accumulate(np.maximum(command[own], newest))
        newest = upto[-1]
        found[own] = path.segment_of(upto)
    return found


def _moved(commanded: Any, time: Array, window: float) -> NDArray[np.bool_]:
    """Whether the pulses moved the tool within the window (n,)."""
    found = np.zeros(len(commanded), dtype=np.int32)
    for own in blocks(len(commanded) - 1, commanded):
        places = np.asarray(commanded[own.start : own.stop + 1])[:, :3]
        found[own.start + 1 : own.stop + 1] = (places[1:] != places[:-1]).any(axis=1)
    count = np.cumsum(found, out=found)
    return np.asarray(count > shifted(count, time, -window))
