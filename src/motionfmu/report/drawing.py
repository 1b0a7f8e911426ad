"""What the pictures of a path are made of: points, magnified error, gaps."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from motionfmu.contour import ContourResult
from motionfmu.contour.arcs import Array
from motionfmu.contour.circles import plane_axes
from motionfmu.contour.path import outline
from motionfmu.report.numbers import magnification
from motionfmu.run.decimate import Index, keep_peaks

# Points of the drawn error, even along the magnified curve; peaks and joints come on top.
POINTS = 2400
BUCKETS = 300
JOINTS_MAX = 2000
# A joint at which the error turns by more than this part of itself is a corner: no line across.
JUMP = 0.25
# Hairs from the path to the magnified error.
HAIRS = 320
AXES = "XYZ"


@dataclass(frozen=True)
class Drawing:
    """A path in the coordinates it is drawn in, and its error."""

    names: tuple[str, ...]  # of the axes drawn: two for a path in a plane, else three
    path: Array  # (m, k) nominal, pieces parted by a row of NaN [mm]
    rapids: Array  # (r, k) likewise [mm]
    foot: Array  # (n, k) points of the path [mm]
    gap: Array  # (n, k) the error there; NaN where it is not counted [mm]
    error: Array  # (n,) its magnitude, signed for a path in a plane [mm]
    time: Array  # (n,) [s]
    line: NDArray[np.int64]  # (n,) of the program
    hairs: NDArray[np.int64]  # which of the points get a hair
    magnify: float  # magnification that suits

    def magnified(self, factor: float) -> Array:
        """The path (n, k) with its error so many times as large [mm]."""
        return self.foot + factor * self.gap


def draw(contour: ContourResult) -> Drawing:
    """Make the drawing of a run."""
    path, track = contour.run.path, contour.track
    basis = np.eye(3) if path.normal is None else plane_axes(path.normal)
    error = track.distance if track.signed is None else track.signed
    cuts = [s for s in path.segments if s.label.kind != "ptp"]
    rest = [s for s in path.segments if s.label.kind == "ptp"]
    cutting = _pieces([outline([s]) @ basis.T for s in cuts], len(basis))
    rapids = _pieces([outline([s]) @ basis.T for s in rest], len(basis))
    size = float(np.max(np.nanmax(cutting, axis=0) - np.nanmin(cutting, axis=0)))
    reach = sum(s.length for s in cuts) / (len(contour.corners) + 1)
    magnify = magnification((contour.error.p95, contour.error.max), size, reach)
    kept, whole = _choose(contour, magnify)
    foot = track.feet(kept) @ basis.T
    gap = np.where(whole[:, None], contour.run.actual[kept, :3] @ basis.T - foot, np.nan)
    return Drawing(
        names=tuple(_name(b) for b in basis),
        path=cutting,
        rapids=rapids,
        foot=foot,
        gap=gap,
        error=error[kept],
        time=contour.run.time[kept],
        line=path.lines[track.segment[kept]],
        hairs=_even(contour.track.along[kept], ~np.isnan(gap[:, 0])),
        magnify=magnify,
    )


def _choose(contour: ContourResult, magnify: float) -> tuple[Index, NDArray[np.bool_]]:
    """Samples that draw the magnified error well, and which of them are to be drawn.

    Where the curve has to be interrupted, the next sample is there but not drawn.
    """
    track = contour.track
    moved = np.flatnonzero(contour.cutting)
    foot, point = track.feet(moved), contour.run.actual[moved, :3]
    shown = foot + magnify * (point - foot)
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(shown, axis=0), axis=1))])
    even = np.searchsorted(way, np.linspace(0.0, way[-1], POINTS))
    joints = np.flatnonzero(np.diff(track.segment[moved]) > 0) + 1
    if len(joints) > JOINTS_MAX:
        joints = joints[:0]
    parts = [np.clip(even, 0, len(moved) - 1), keep_peaks(track.distance[moved], BUCKETS)]
    chosen = np.unique(np.concatenate([*parts, joints, joints - 1]))
    gap = point[chosen] - foot[chosen]
    size = np.linalg.norm(gap, axis=1)
    turned = np.linalg.norm(np.diff(gap, axis=0), axis=1) > JUMP * np.maximum(size[1:], size[:-1])
    corner = turned & (np.diff(track.segment[moved[chosen]]) > 0) & (np.diff(chosen) == 1)
    pause = np.diff(np.cumsum(~contour.cutting)[moved[chosen]]) > 0
    breaks = np.flatnonzero(corner | pause) + 1
    kept = np.insert(moved[chosen], breaks, moved[chosen][breaks])
    whole = np.insert(np.ones(len(chosen), dtype=bool), breaks, False)
    return kept, whole


def _name(direction: Array) -> str:
    main = int(np.argmax(np.abs(direction)))
    return AXES[main] if abs(direction[main]) > 1.0 - 1e-9 else AXES[main] + "\N{PRIME}"


def _pieces(parts: list[Array], width: int) -> Array:
    """Join polylines; a row of NaN where one does not start at the end of the last."""
    if not parts:
        return np.empty((0, width))
    rows: list[Array] = [parts[0]]
    for before, after in pairwise(parts):
        if np.abs(before[-1] - after[0]).max() > 1e-9:
            rows.append(np.full((1, before.shape[1]), np.nan))
        rows.append(after)
    return np.concatenate(rows)


def _even(along: Array, usable: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Points at even distances along the path."""
    found = np.flatnonzero(usable)
    wanted = np.linspace(along[found[0]], along[found[-1]], HAIRS)
    return np.unique(found[np.clip(np.searchsorted(along[found], wanted), 0, len(found) - 1)])
