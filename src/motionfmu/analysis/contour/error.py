"""Contour error: every sample against the exact commanded geometry."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.contour.arcs import Array
from motionfmu.analysis.contour.assign import assign
from motionfmu.analysis.contour.circles import circular_tests
from motionfmu.analysis.contour.contour_result import ContourInput, ContourResult
from motionfmu.analysis.contour.corners import find_corners
from motionfmu.analysis.contour.instants import Instants
from motionfmu.analysis.contour.kinds import Statistics
from motionfmu.analysis.contour.path import Path
from motionfmu.analysis.contour.pulse_path import PulsePaths
from motionfmu.analysis.contour.scaled_values import blocks, places
from motionfmu.analysis.contour.track import Track, follow
from motionfmu.base.order import quantiles

# The tool is within exp(-5) = 0.7 % of a corner's following distance after five servo lags.
LAGS = 5.0
# Shortest servo window [s]: a loop with full feed-forward has no lag but still settles.
WINDOW_MIN = 0.05
# The tool may run ahead of the command by this part of the window: overshoot, feed-forward.
AHEAD = 0.2
# A circle counts when this many windows have passed since its start: exp(-10) of a transient.
SETTLE = 2.0


def analyse(
    run: ContourInput,
    progress: Callable[[float], None] = lambda share: None,
    known: PulsePaths | None = None,
) -> ContourResult:
    """Find the contour error of a run against the exact geometry.

    First the pulses put out are followed along the path. Each sample may lie on the segments
    whose points were written to the card within the time a command can wait in the FIFO. Where
    two commands are mixed it may lie on both, from the begin of the newer to the end of the older.
    Then the tool: it may lie on the segments where the pulses have been within the servo window.
    Both advance along the path and never return, see `motionfmu.analysis.contour.assign`.

    Parameters
    ----------
    run : ContourInput
        Geometry and signals, which may be memory maps: they are read in parts.
    progress : callable
        Told the share that is done, 0 to 1.
    known : PulsePaths, optional
        What earlier runs have in common with this one; what is found is added to it.

    Raises
    ------
    ValueError
        The run never moves on a line, arc or helix.
    """
    path, instants = run.path, run.instants
    known = PulsePaths() if known is None else known
    command = known.commanded(run, lambda share: progress(0.4 * share))
    progress(0.4)
    lag = servo_lag(instants, run.commanded, run.actual)
    window = max(LAGS * lag, WINDOW_MIN) if run.window is None else run.window
    owners = command.track.segment
    candidates = instants.shifted(owners, -window), instants.shifted(owners, AHEAD * window)
    owners = assign(run.actual, path, *candidates, lambda share: progress(0.4 + 0.3 * share))
    del candidates
    track = follow(run.actual, path, owners)
    progress(0.85)
    tracks = (track, command.track)
    cutting = np.empty(len(instants), dtype=bool)
    both, moved = np.empty_like(cutting), instants.shifted(command.moved, -window)
    shared = (track.segment, command.track.segment, command.moved, moved)
    for own in blocks(len(cutting), *shared):
        cutting[own] = path.cut[track.segment[own]]
        cutting[own] &= command.moved[own] > moved[own]
        both[own] = cutting[own] & path.cut[command.track.segment[own]]
    if not cutting.any():
        raise ValueError("the run never moves on a line, arc or helix: it has no contour")
    settle = SETTLE * window
    circles, missing = circular_tests(path, (instants, run.actual), tracks, settle, run.run_in)
    corners = find_corners(path, instants, tracks, cutting, window)
    error = statistics(path, run.time, track, cutting)
    command_error = statistics(path, run.time, command.track, both)
    path.segments.release()
    progress(1.0)
    return ContourResult(
        run=run,
        track=track,
        command_track=command.track,
        cutting=cutting,
        lag=lag,
        window=window,
        error=error,
        command_error=command_error,
        circles=circles,
        corners=corners,
        missing=missing,
    )


def statistics(path: Path, time: Array, track: Track, chosen: NDArray[np.bool_]) -> Statistics:
    """Statistics of the distance over chosen samples, one at least."""
    size, filled = np.empty(np.count_nonzero(chosen)), 0
    worst, top = 0, -1.0
    for block in blocks(len(chosen), track.distance):
        part = track.distance[block][chosen[block]]
        if len(part) and float(part.max()) > top:
            top = float(part.max())
            worst = block.start + int(np.flatnonzero(chosen[block])[np.argmax(part)])
        size[filled : filled + len(part)] = part
        filled += len(part)
    x, y, z = track.feet(np.array([worst]))[0].tolist()
    mean, square = float(size.mean()), float(np.einsum("i,i->", size, size))
    rms = math.sqrt(square / len(size))
    own = int(track.segment[worst])
    p50, p95, p99 = quantiles(size, (0.5, 0.95, 0.99), ours=True)
    return Statistics(
        max=top,
        rms=rms,
        mean=mean,
        p50=p50,
        p95=p95,
        p99=p99,
        time=float(time[worst]),
        line=int(path.lines[own]),
        command=int(path.commands[own]),
        point=(x, y, z),
    )


def servo_lag(instants: Instants, commanded: Any, actual: Any) -> float:
    """Following distance over speed [s], by least squares; 0 if nothing moves or the tool leads."""
    time = instants.time
    span = min(max(1, round(0.002 / instants.middle)), len(time) - 1)
    power = product = 0.0
    for own in blocks(len(time) - span, time, commanded, actual):
        place = places(commanded, slice(own.start, own.stop + span))
        gap = place[span:] - places(actual, slice(own.start + span, own.stop + span))
        speed = place[span:] - place[: own.stop - own.start]
        speed /= (time[own.start + span : own.stop + span] - time[own])[:, None]
        power += float(sum(np.einsum("i,i->", v, v) for v in speed.T))
        product += float(sum(np.einsum("i,i->", v, d) for v, d in zip(speed.T, gap.T, strict=True)))
    return max(0.0, product / power) if power > 0.0 else 0.0
