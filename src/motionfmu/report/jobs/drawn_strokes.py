"""The strokes of a part program of any length, as a picture can show them."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.gcode import Program, Stroke, Summary, strokes
from motionfmu.analysis.gcode.summary import pieces
from motionfmu.analysis.iso9283.simplify import simplified

# A program of more commands than that is drawn to within its size divided by FINE, and coarser
# if that still takes twice as many points as POINTS.
COMMANDS_MAX, FINE, POINTS = 10_000, 4000, 20_000
# Changes of the feed within such a part of the way that a picture resolves are one; its growth,
# and that of the tolerance, where there are too many points.
CELL, CELL_GROWS, GROWS = 1.0, 4.0, 1.5


class DrawnStrokes:
    """Strokes that draw a program.

    They are off the path by `within` at most [mm], 0 where nothing is left out; of `every` pairs of
    strokes one is there.
    """

    def __init__(self, program: Program, summary: Summary) -> None:
        self.strokes: list[Stroke] = []
        self.within, self.every, self._cell = 0.0, 1, 0.0
        self._points = self._seen = 0
        if summary.commands <= COMMANDS_MAX:
            self.strokes += strokes(program)
            return
        size = max(b - a for a, b in zip(summary.low[:3], summary.high[:3], strict=True))
        self.within = size / FINE
        self._cell = CELL * self.within
        for piece in pieces(program):
            if (self._seen // 2) % self.every == 0:
                self._put(piece)
                if self._points > 2 * POINTS:
                    self._coarsen()
            self._seen += 1

    def _put(self, stroke: Stroke) -> None:
        made = thinned(stroke, self.within, self._cell)
        self.strokes.append(made)
        self._points += len(made.points)

    def _coarsen(self) -> None:
        """Leave out points until half of the room is free."""
        while self._points > POINTS:
            self._cell *= CELL_GROWS
            self.within *= GROWS
            if len(self.strokes) > POINTS // 4:  # most have no point to spare
                self.every *= 2
                self.strokes = [s for k, s in enumerate(self.strokes) if k // 2 % 2 == 0]
            before, self.strokes, self._points = self.strokes, [], 0
            for stroke in before:
                self._put(stroke)


def thinned(stroke: Stroke, within: float, cell: float) -> Stroke:
    """A stroke without the points that are no farther off than that [mm].

    It has one feed on each cell of so much way [mm], and both ends of each stretch of one feed.
    """
    feed = _by_cells(stroke, cell)
    cuts = np.flatnonzero(np.diff(feed)) + 1
    kept, feeds = [], []
    for a, b in pairwise([0, *cuts.tolist(), len(feed)]):
        first = max(0, a - 1)  # from the end of the stretch before
        own = np.arange(first, b)
        if b - first > 2:
            own = first + simplified(stroke.points[first:b], within)
        kept.append(own)
        feeds.append(np.full(len(own), feed[a]))
    rows = np.concatenate(kept)
    return Stroke(
        stroke.rapid, stroke.tool, stroke.points[rows], np.concatenate(feeds), stroke.line[rows]
    )


def _by_cells(stroke: Stroke, cell: float) -> NDArray[np.float64]:
    """The feed of each point, that of the first in its cell."""
    if not np.diff(stroke.feed).any():
        return stroke.feed
    way = np.cumsum(np.linalg.norm(np.diff(stroke.points, axis=0), axis=1))
    number = np.concatenate([[0], (way / cell).astype(np.int64)])
    first = np.concatenate([[True], np.diff(number) != 0])
    return np.asarray(stroke.feed[np.maximum.accumulate(np.where(first, np.arange(len(first)), 0))])
