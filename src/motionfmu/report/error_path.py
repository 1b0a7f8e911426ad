"""The path of a run and its contour error, as few points as a chart of them needs."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.contour import ContourResult
from motionfmu.analysis.contour.arcs import Array
from motionfmu.analysis.contour.circles import plane_axes
from motionfmu.analysis.contour.geometry import norms
from motionfmu.analysis.contour.path import Path, outline
from motionfmu.analysis.contour.scaled_values import blocks, picked, places
from motionfmu.analysis.contour.segments import Index
from motionfmu.analysis.iso9283.simplify import simplified
from motionfmu.base.columns import forget, room
from motionfmu.base.order import distinct
from motionfmu.report.error_scale import magnification, scale_end, within
from motionfmu.run.decimate import peaks_of

# The error is drawn through so many points, which are even along the magnified curve. Its peaks
# and the joints of segments are drawn besides.
POINTS = 2400
BUCKETS = 300
JOINTS_MAX = 2000
# Where the error turns by more than this part of itself at a joint, there is a corner: the line
# of the error is interrupted.
JUMP = 0.25
# The length of the magnified curve is kept at so many samples, far more than are drawn.
WAYS = 1 << 20
# A path of more than SEGMENTS_MAX segments is drawn to within its size divided by FINE.
SEGMENTS_MAX, FINE = 10_000, 4000
PART = 1 << 14  # segments that are worked on at a time
JOINED = 1e-9  # [mm]
# Number of hairs: short lines from the path to the magnified error.
HAIRS = 320
OUTLIERS_MAX = 50  # the largest, that are marked
AXES = "XYZ"


@dataclass(frozen=True)
class ErrorPath:
    """A path in the coordinates it is drawn in, and its error."""

    names: tuple[str, ...]  # of the axes drawn: two for a path in a plane, else three
    path: Array  # (m, k) nominal path, a row of NaN between two parts [mm]
    rapids: Array  # (r, k) rapids, as the path [mm]
    foot: Array  # (n, k) points of the path [mm]
    gap: Array  # (n, k) the error at these points; NaN where it is not counted [mm]
    error: Array  # (n,) magnitude of the error, signed for a path in a plane [mm]
    time: Array  # (n,) [s]
    line: NDArray[np.int64]  # (n,) line of the program
    hairs: NDArray[np.int64]  # points that have a hair
    magnify: float  # a magnification that suits path and error
    end: float  # where the colours end [mm]
    outliers: NDArray[np.int64]  # points with the largest error of each stretch beyond that

    def magnified(self, factor: float) -> Array:
        """The path (n, k) with its error so many times as large, outliers cut short [mm]."""
        return self.foot + factor * self.shown

    @property
    def shown(self) -> Array:
        """The error as it is drawn (n, k): no longer than the colours reach [mm]."""
        return within(self.gap, self.end)


def draw(contour: ContourResult) -> ErrorPath:
    """Choose the points that draw the path of a run and its error."""
    path, track = contour.run.path, contour.track
    basis = np.eye(3) if path.normal is None else plane_axes(path.normal)
    cutting = _outlined(path, np.flatnonzero(path.cut), basis)
    size = float(np.max(np.nanmax(cutting, axis=0) - np.nanmin(cutting, axis=0)))
    reach = float(path.lengths[path.cut].sum()) / (len(contour.corners) + 1)
    errors = contour.error.p95, contour.error.max
    magnify, end = magnification(errors, size, reach), scale_end(errors)
    kept, whole = _choose(contour, magnify, end)
    actual, along = contour.run.actual, track.along
    foot = picked(track.feet, kept, track.segment, along) @ basis.T
    place = picked(lambda rows: places(actual, rows), kept, actual)
    gap = np.where(whole[:, None], place @ basis.T - foot, np.nan)
    error = picked(track.distance.__getitem__, kept, track.distance)
    right = None if track.right is None else picked(track.right.__getitem__, kept, track.right)
    time = contour.run.time
    return ErrorPath(
        names=tuple(_name(b) for b in basis),
        path=cutting,
        rapids=_outlined(path, np.flatnonzero(~path.cut), basis),
        foot=foot,
        gap=gap,
        error=error if right is None else np.where(right, -error, error),
        time=picked(time.__getitem__, kept, time),
        line=path.lines[picked(track.segment.__getitem__, kept, track.segment)],
        hairs=_even(picked(along.__getitem__, kept, along), ~np.isnan(gap[:, 0])),
        magnify=magnify,
        end=end,
        outliers=_outliers(np.where(whole, np.abs(error), 0.0), end),
    )


def _choose(contour: ContourResult, magnify: float, end: float) -> tuple[Index, NDArray[np.bool_]]:
    """Samples that draw the magnified error well, and which of them are to be drawn.

    Where the curve has to be interrupted, the next sample is there but not drawn.
    """
    track, actual = contour.track, contour.run.actual

    def distances(first: int, last: int) -> Array:
        for array in (moved, track.distance):
            forget(array)
        return track.distance[moved[first:last]][:, None]

    moved = room(int(contour.cutting.sum()), np.int32, track.distance)
    count, joined, length, last = 0, 0, 0.0, None
    ways, joints = [np.zeros(1)], [np.zeros(0, dtype=np.int64)]
    stride = 1 + len(moved) // WAYS
    shared = track.segment, track.along, track.distance, moved
    for own in blocks(len(contour.cutting), actual, *shared):
        rows = own.start + np.flatnonzero(contour.cutting[own])
        if not len(rows):
            continue
        moved[count : count + len(rows)] = rows
        foot = track.feet(rows)
        shown = foot + magnify * within(places(actual, rows) - foot, end)
        segment = track.segment[rows]
        if last is not None:
            shown = np.concatenate([last[0], shown])
            segment = np.concatenate([last[1], segment])
        turns = np.flatnonzero(segment[1:] > segment[:-1]) + count + (last is None)
        joined += len(turns)
        if joined <= JOINTS_MAX:
            joints.append(turns)
        way = length + np.cumsum(norms(shown[1:] - shown[:-1]))
        length = float(way[-1]) if len(way) else length
        place = np.arange(count + (last is None), count + len(rows))
        ways.append(way[place % stride == 0])
        count, last = count + len(rows), (shown[-1:], segment[-1:])
    even = stride * np.searchsorted(np.concatenate(ways), np.linspace(0.0, length, POINTS))
    parts = [np.minimum(even, len(moved) - 1)]
    parts.append(peaks_of(len(moved), distances, BUCKETS))
    if joined <= JOINTS_MAX:
        parts += [*joints, *(j - 1 for j in joints)]
    chosen = distinct(np.concatenate(parts))
    rows = moved[chosen]
    foot = picked(track.feet, rows, track.segment, track.along)
    gap = picked(lambda some: places(actual, some), rows, actual) - foot
    size = norms(gap)
    turned = norms(gap[1:] - gap[:-1]) > JUMP * np.maximum(size[1:], size[:-1])
    corner = (
        turned
        & (np.diff(picked(track.segment.__getitem__, rows, track.segment)) > 0)
        & (np.diff(chosen) == 1)
    )
    pause = np.diff(rows - chosen) > 0  # samples between that do not cut
    breaks = np.flatnonzero(corner | pause) + 1
    kept = np.insert(rows, breaks, rows[breaks])
    whole = np.insert(np.ones(len(chosen), dtype=bool), breaks, False)
    return kept, whole


def _outliers(size: Array, end: float) -> NDArray[np.int64]:
    """Where each stretch beyond the end of the colours is largest; of very many the largest."""
    beyond = np.concatenate([[False], size > end, [False]])
    starts, ends = np.flatnonzero(np.diff(beyond)).reshape(-1, 2).T
    places = [a + int(np.argmax(size[a:b])) for a, b in zip(starts, ends, strict=True)]
    chosen = np.array(places, dtype=np.int64)
    return np.sort(chosen[np.argsort(-size[chosen], kind="stable")[:OUTLIERS_MAX]])


def _outlined(path: Path, chosen: Index, basis: Array) -> Array:
    """Points to draw some segments by, a row of NaN where one does not start at the last one's end.

    Of a path of very many points those are left out that a picture cannot show.
    """
    found: list[Array] = []
    end = np.full((1, len(basis)), np.nan)
    size = float(np.ptp(path.segments.columns.start[chosen], axis=0).max()) if len(chosen) else 0.0
    thin = size / FINE if len(chosen) > SEGMENTS_MAX else 0.0
    for first in range(0, len(chosen), PART):
        points, starts = outline(path.segments, chosen[first : first + PART])
        points = points @ basis.T
        before = np.concatenate([end, points[starts[1:] - 1]])
        apart = starts[~(np.abs(points[starts] - before).max(axis=1) <= JOINED)]
        for a, b in pairwise([0, *apart[apart > 0].tolist(), len(points)]):
            if a in apart and found:
                found.append(np.full((1, len(basis)), np.nan))
            piece = points[a:b]
            found.append(piece[simplified(piece, thin)] if thin else piece)
        end = points[-1:]
    return np.concatenate(found) if found else np.empty((0, len(basis)))


def _name(direction: Array) -> str:
    main = int(np.argmax(np.abs(direction)))
    return AXES[main] if abs(direction[main]) > 1.0 - 1e-9 else AXES[main] + "\N{PRIME}"


def _even(along: Array, usable: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Points at even distances along the path."""
    found = np.flatnonzero(usable)
    wanted = np.linspace(along[found[0]], along[found[-1]], HAIRS)
    return distinct(found[np.clip(np.searchsorted(along[found], wanted), 0, len(found) - 1)])
