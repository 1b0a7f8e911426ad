"""Contours that a machine follows, made of the lines that a pen draws."""

from dataclasses import dataclass, replace

import numpy as np

from motionfmu.cards.plt import PltDrawing

# Points nearer than this are one; files round more coarsely. [mm]
SAME = 1e-6
# Length before and behind a vertex over which its angle is taken, so that steps of a raster are no
# corners.
REACH = 0.3  # [mm]


@dataclass(frozen=True)
class PenContour:
    """A line that is drawn without raising the pen."""

    points: np.ndarray  # [mm]; neighbours differ. A single point is a dot.
    pen: int
    closed: bool  # It ends where it begins
    speed: float  # [mm/s] that the drawing asks for; 0 none
    first: int  # Byte of the file where it begins


def clean(
    drawing: PltDrawing, pens: list[int] | None = None, order: str = "file"
) -> list[PenContour]:
    """Contours of a drawing in the order of the "file", or always to the "nearest" end.

    Lines that follow each other with the same pen and speed are one. A closed contour begins where
    the file begins it; an open one may be turned round.
    """
    runs: list[list] = []
    for line in drawing.lines:
        if not line.down or (pens is not None and line.pen not in pens):
            continue
        last = runs[-1] if runs else None
        if (
            last
            and last[1:3] == [line.pen, line.speed]
            and np.abs(last[0][-1][-1] - line.points[0]).max() <= SAME
        ):
            last[0].append(line.points)
        else:
            runs.append([[line.points], line.pen, line.speed, line.first])
    found = [_contour(np.vstack(parts), pen, speed, first) for parts, pen, speed, first in runs]
    return _nearest(found) if order == "nearest" else found


def _contour(points: np.ndarray, pen: int, speed: float, first: int) -> PenContour:
    keep = np.abs(np.diff(points, axis=0)).max(axis=1, initial=0.0) > SAME
    points = points[np.concatenate([[True], keep])]
    closed = len(points) > 2 and bool(np.abs(points[-1] - points[0]).max() <= SAME)
    return PenContour(points, pen, closed, speed, first)


def _nearest(contours: list[PenContour]) -> list[PenContour]:
    """Contours sorted by pen, then each next to the end of the one before."""
    found: list[PenContour] = []
    at = np.zeros(2)
    for pen in dict.fromkeys(c.pen for c in contours):
        left = [c for c in contours if c.pen == pen]
        starts = np.array([c.points[0] for c in left])
        ends = np.array([c.points[-1] for c in left])
        ends[[c.closed for c in left]] = np.inf
        for _ in range(len(left)):
            near = [np.square(x - at).sum(axis=1) for x in (starts, ends)]
            k = int(np.argmin(np.minimum(*near)))
            turned = near[1][k] < near[0][k]
            found.append(replace(left[k], points=left[k].points[::-1]) if turned else left[k])
            at = found[-1].points[-1]
            starts[k] = ends[k] = np.inf
    return found


def way_between(contours: list[PenContour]) -> float:
    """Length of the moves with the pen up, from 0 on [mm]."""
    at, way = np.zeros(2), 0.0
    for c in contours:
        way += float(np.linalg.norm(c.points[0] - at))
        at = c.points[-1]
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
