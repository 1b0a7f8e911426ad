"""Contours that a machine follows, made of the lines that a pen draws."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from motionfmu.drawings.chains import chained
from motionfmu.drawings.drawing import Drawing
from motionfmu.drawings.drawing_options import DrawingOptions
from motionfmu.drawings.knife import knife_path
from motionfmu.drawings.pen_path import SAME, Array, PenPath, joined, tidy

# Length before and behind a vertex over which its angle is taken, so that steps of a raster are no
# corners.
REACH = 0.3  # [mm]


@dataclass(frozen=True)
class PenContour:
    """A line that is drawn without raising the pen."""

    path: PenPath  # [mm]; neighbours differ. A single node is a dot.
    pen: int
    closed: bool  # It ends where it begins
    speed: float  # [mm/s] that the drawing asks for; 0 none
    first: int  # Place of the file where it begins

    @property
    def points(self) -> Array:
        """Its vertices, those of chords where it is curved [mm]."""
        return self.path.points


def contours_of(drawing: Drawing, options: DrawingOptions) -> list[PenContour]:
    """What a machine follows to draw a drawing, as options say, without their offset."""
    size = options.scale
    lines = [replace(p, path=p.path.moved(size, (0.0, 0.0))) for p in drawing.lines if p.down]
    scaled = replace(drawing, lines=lines) if size != 1.0 else drawing
    own = clean(scaled, options.pens, options.order or drawing.order)
    found = list(own)
    for k in range(1, options.copies[0] * options.copies[1]):
        j, i = divmod(k, options.copies[0])
        i = options.copies[0] - 1 - i if j % 2 else i  # the next copy is beside the last one
        shift = (i * options.pitch[0], j * options.pitch[1])
        found += (replace(c, path=c.path.moved(1.0, shift)) for c in own)
    if options.knife > 0.0:
        return knife_paths(found, options.knife)
    return found


def knife_paths(contours: list[PenContour], offset: float) -> list[PenContour]:
    """Ways of a drag knife's axis along contours, an offset [mm] ahead of its edge."""
    heading = np.array([1.0, 0.0])
    found = []
    for c in contours:
        if len(c.points) > 1:  # a knife cuts no dots
            path, heading = knife_path(c.path, c.closed, offset, heading)
            found.append(replace(c, path=path, closed=False))
    return found


def clean(drawing: Drawing, pens: list[int] | None = None, order: str = "file") -> list[PenContour]:
    """Contours of a drawing in an order of `DrawingOptions`.

    Lines that follow each other with the same pen and speed are one; of a drawing without an order
    all whose ends meet. A closed contour begins where the file begins it; an open one may be
    turned round.
    """
    lines = [p for p in drawing.lines if p.down and (pens is None or p.pen in pens)]
    if not drawing.ordered:
        lines = chained(lines)
    runs: list[list] = []
    for line in lines:
        last = runs[-1] if runs else None
        if (
            last
            and last[1:3] == [line.pen, line.speed]
            and np.abs(last[0][-1].nodes[-1] - line.path.nodes[0]).max() <= SAME
        ):
            last[0].append(line.path)
        else:
            runs.append([[line.path], line.pen, line.speed, line.first])
    found = [_contour(joined(parts), pen, speed, first) for parts, pen, speed, first in runs]
    return found if order == "file" else _nearest(found, order == "inside")


def _contour(path: PenPath, pen: int, speed: float, first: int) -> PenContour:
    path = tidy(path)
    ends = bool(np.abs(path.nodes[-1] - path.nodes[0]).max() <= SAME)
    closed = ends and (len(path.nodes) > 2 or bool(path.curved.any()))
    return PenContour(path, pen, closed, speed, first)


def _nearest(contours: list[PenContour], inside: bool) -> list[PenContour]:
    """Contours sorted by pen, then each next to the end of the one before.

    inside: a closed one waits for all of its pen that lie in it.
    """
    found: list[PenContour] = []
    at = np.zeros(2)
    for pen in dict.fromkeys(c.pen for c in contours):
        left = [c for c in contours if c.pen == pen]
        around = _around(left) if inside else [[] for _ in left]
        waits = np.zeros(len(left), int)  # contours inside that are not drawn yet
        for outer in around:
            waits[outer] += 1
        starts = np.array([c.path.nodes[0] for c in left])
        ends = np.array([c.path.nodes[-1] for c in left])
        ends[[c.closed for c in left]] = np.inf
        for _ in range(len(left)):
            near = [(x[:, 0] - at[0]) ** 2 + (x[:, 1] - at[1]) ** 2 for x in (starts, ends)]
            k = int(np.argmin(np.where(waits > 0, np.inf, np.minimum(*near))))
            turned = near[1][k] < near[0][k]
            found.append(replace(left[k], path=left[k].path.reversed) if turned else left[k])
            at = found[-1].path.nodes[-1]
            starts[k] = ends[k] = np.inf
            waits[around[k]] -= 1
    return found


def _around(contours: Sequence[PenContour]) -> list[list[int]]:
    """Of each contour the closed ones in which it lies."""
    low = np.array([c.points.min(axis=0) for c in contours])
    high = np.array([c.points.max(axis=0) for c in contours])
    found: list[list[int]] = [[] for _ in contours]
    for k, c in enumerate(contours):
        if not c.closed:
            continue
        within = (low >= low[k]).all(axis=1) & (high <= high[k]).all(axis=1)
        within[k] = False
        for j in np.flatnonzero(within).tolist():
            equal = bool((low[j] == low[k]).all() and (high[j] == high[k]).all())
            if not equal and _holds(c.points, contours[j].points[0]):
                found[j].append(k)
    return found


def _holds(outline: Array, point: Array) -> bool:
    """Whether a point lies in a closed outline: a ray from it crosses that at odd times."""
    a, b = outline[:-1] - point, outline[1:] - point
    across = (a[:, 1] > 0.0) != (b[:, 1] > 0.0)
    a, b = a[across], b[across]
    ahead = a[:, 0] - a[:, 1] * (b[:, 0] - a[:, 0]) / (b[:, 1] - a[:, 1]) > 0.0
    return bool(np.count_nonzero(ahead) % 2)


def way_between(contours: list[PenContour]) -> float:
    """Length of the moves with the pen up, from 0 on [mm]."""
    at, way = np.zeros(2), 0.0
    for c in contours:
        way += float(np.linalg.norm(c.path.nodes[0] - at))
        at = c.path.nodes[-1]
    return way


def turns(points: np.ndarray, reach: float = REACH) -> np.ndarray:
    """Angle at each vertex between the ways `reach` before and behind it [deg]; at the ends 0."""
    n = len(points)
    found = np.zeros(n)
    if n < 3:
        return found
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])

    def at(s: np.ndarray) -> np.ndarray:
        return np.stack([np.interp(s, way, points[:, k]) for k in (0, 1)], axis=1)

    before, behind = points - at(way - reach), at(way + reach) - points
    cross = before[:, 0] * behind[:, 1] - before[:, 1] * behind[:, 0]
    angle = np.degrees(np.arctan2(np.abs(cross), (before * behind).sum(axis=1)))
    found[1:-1] = angle[1:-1]
    return found


def corners(points: np.ndarray, angle: float) -> np.ndarray:
    """Vertices where a line turns by more than an angle [deg]; of several nearby one counts."""
    turn = turns(points)
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    found = np.zeros(len(points), bool)
    blocked = np.zeros(len(points), bool)
    for k in np.argsort(-turn, kind="stable"):
        if turn[k] <= angle:
            break
        if not blocked[k]:
            found[k] = True
            low, high = np.searchsorted(way, [way[k] - REACH, way[k] + REACH])
            blocked[low:high] = True
    return found
