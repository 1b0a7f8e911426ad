"""All segments of a path as columns, and the nearest points on many of them at once."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.contour.arcs import Arcs, Array, Foot
from motionfmu.analysis.contour.geometry import Arc, Cubic, Label, LineSegment, Segment, norms
from motionfmu.base.memo import Memo
from motionfmu.base.order import distinct

Index = NDArray[Any]  # of integers
KINDS = ("ptp", "line", "arc", "helix", "curve")
LINE, ARC, CUBIC = 0, 1, 2
# If so many successive points or more are on one segment, they are handled together, so that the
# segment's data are not copied for each point.
RUN = 256
# So many segments are kept as objects, with the values computed from them.
KEPT = 64
MANY = 1 << 18  # segments whose columns are too large to be kept for later


@dataclass(frozen=True, eq=False)
class SegmentColumns:
    """Columns of a table with a row for each segment."""

    command: Index  # (n,) of the library
    line: Index  # (n,) of the part program
    kind: Index  # (n,) place in KINDS
    feed: Array  # (n,) as programmed [mm/s]
    shape: Index  # (n,) LINE, ARC or CUBIC
    start: Array  # (n, 3) [mm]
    end: Array  # (n, 3) of a line [mm]
    centre: Array  # (k, 3) of each arc [mm]
    axis: Array  # (k, 3)
    turned: Array  # (k, 3) its angle [rad], rise and growth [mm]
    curves: dict[int, Cubic]  # by row

    @classmethod
    def joined(cls, parts: "list[SegmentColumns]") -> "SegmentColumns":
        """The rows of several tables, one behind the other."""
        if len(parts) == 1:
            return parts[0]
        names = [name for name in cls.__dataclass_fields__ if name != "curves"]
        columns = {name: np.concatenate([getattr(p, name) for p in parts]) for name in names}
        begins = np.cumsum([0, *(len(p.command) for p in parts)]).tolist()
        pairs = zip(begins, parts, strict=False)
        return cls(**columns, curves={b + i: c for b, p in pairs for i, c in p.curves.items()})


class Segments(Sequence[Segment]):
    """Segments in the order of travel; each is made when it is asked for."""

    def __init__(self, columns: SegmentColumns) -> None:
        self.columns = columns
        self._made: Memo[Segment] = Memo(KEPT)

    @classmethod
    def of(cls, segments: Iterable[Segment]) -> "Segments":
        """The columns of segments."""
        found = list(segments)
        arcs = [s for s in found if isinstance(s, Arc)]
        shapes = {LineSegment: LINE, Arc: ARC, Cubic: CUBIC}
        places = np.array([s.start for s in found], dtype=float).reshape(-1, 3)
        return cls(
            SegmentColumns(
                np.array([s.label.command for s in found], dtype=np.int64),
                np.array([s.label.line for s in found], dtype=np.int64),
                np.array([KINDS.index(s.label.kind) for s in found], dtype=np.int8),
                np.array([s.label.feed for s in found], dtype=float),
                np.array([shapes[type(s)] for s in found], dtype=np.int8),
                places,
                np.array([s.end for s in found], dtype=float).reshape(-1, 3),
                np.array([s.centre for s in arcs], dtype=float).reshape(-1, 3),
                np.array([s.axis for s in arcs], dtype=float).reshape(-1, 3),
                np.array([(s.angle, s.rise, s.growth) for s in arcs]).reshape(-1, 3),
                {i: s for i, s in enumerate(found) if isinstance(s, Cubic)},
            )
        )

    def __len__(self) -> int:
        return len(self.columns.command)

    @overload
    def __getitem__(self, i: int) -> Segment: ...

    @overload
    def __getitem__(self, i: slice) -> list[Segment]: ...

    def __getitem__(self, i: int | slice) -> Segment | list[Segment]:
        if isinstance(i, slice):
            return [self[k] for k in range(*i.indices(len(self)))]
        k = range(len(self))[i]
        return self._made(k, lambda: self._one(k))

    def _one(self, i: int) -> Segment:
        c = self.columns
        if c.shape[i] == CUBIC:
            return c.curves[i]
        label = Label(int(c.command[i]), int(c.line[i]), KINDS[c.kind[i]], float(c.feed[i]))
        if c.shape[i] == LINE:
            return LineSegment(label, c.start[i], c.end[i])
        k = int(self.place[i])
        return Arc(label, c.start[i], c.centre[k], c.axis[k], *c.turned[k].tolist())

    @cached_property
    def place(self) -> Index:
        """Place of each arc among the arcs (n,)."""
        return np.asarray(np.cumsum(self.columns.shape == ARC) - 1)

    @cached_property
    def arcs(self) -> Arcs:
        """All arcs."""
        c = self.columns
        return Arcs.of(c.start[c.shape == ARC], (c.centre, c.axis), tuple(c.turned.T))

    @cached_property
    def lengths(self) -> Array:
        """Length of each [mm]."""
        c = self.columns
        found = norms(c.end - c.start)
        found[c.shape == ARC] = self.arcs.length
        for i, curve in c.curves.items():
            found[i] = curve.length
        return found

    @cached_property
    def directions(self) -> Array:
        """Unit vector from start to end of each (n, 3); zero without length."""
        way = self.columns.end - self.columns.start
        size = norms(way)
        way /= np.where(size > 0.0, size, 1.0)[:, None]
        return way

    @cached_property
    def ends(self) -> Array:
        """Last point of each (n, 3) [mm]."""
        c = self.columns
        found = c.end.copy()
        found[c.shape == ARC] = self.arcs.points(self.arcs.angle)
        return found

    @cached_property
    def way(self) -> tuple[Array, Array]:
        """Way to the start and to the end of each (n,), jumps between them as well [mm].

        Two points of the path are no farther apart than the way between them is long.
        """
        c = self.columns
        own = self.lengths.copy()
        own[c.shape == ARC] = self.arcs.reach
        jumps = np.concatenate([[0.0], norms(c.start[1:] - self.ends[:-1])])
        end = np.cumsum(own + jumps)
        return end - own, end

    def release(self) -> None:
        """Let go what was computed of very many segments; it is computed again when needed."""
        if len(self) > MANY:
            for name in ("way", "ends", "directions"):
                self.__dict__.pop(name, None)

    def foot(self, points: Array, which: Index) -> Foot:
        """Nearest point to each of the points (n, 3) [mm] on the segment of its number (n,)."""
        if parts := [self[int(which[a])].foot(points[a:b]) for a, b in _long_runs(which)]:
            return parts[0] if len(parts) == 1 else _joined(parts)
        shapes = self.columns.shape[which]
        if (shapes == LINE).all():
            return self._on_lines(points, which)
        found = Foot(*(np.empty((len(points), *s)) for s in ((3,), (), (), (3,))))
        for shape, foot in ((LINE, self._on_lines), (ARC, self._on_arcs), (CUBIC, self._on_curves)):
            rows = np.flatnonzero(shapes == shape)
            if len(rows):
                _put(found, rows, foot(points[rows], which[rows]))
        return found

    def distances(self, points: Array, which: Index) -> Array:
        """Distance (n,) of each of the points from its segment, as `foot` gives it [mm]."""
        shapes = self.columns.shape[which]
        if not (shapes == ARC).any():
            return self.foot(points, which).distance
        found = np.empty(len(points))
        if ends := _long_runs(which):
            for a, b in ends:
                found[a:b] = _distances(self[int(which[a])], points[a:b])
            return found
        for shape in (LINE, ARC, CUBIC):
            rows = np.flatnonzero(shapes == shape)
            part, own = points[rows], which[rows]
            if shape == ARC:
                found[rows] = self.arcs[self.place[own]].distances(part)
            elif len(rows):
                found[rows] = self.foot(part, own).distance
        return found

    def _on_lines(self, points: Array, which: Index) -> Foot:
        c = self.columns
        start, way, length = c.start[which], self.directions[which], self.lengths[which]
        along = np.einsum("ij,ij->i", points - start, way)
        along = np.minimum(np.maximum(along, 0.0), length)
        point = start + along[:, None] * way
        ended = along >= length
        point[ended] = c.end[which[ended]]
        return Foot(point, along, norms(points - point), way)

    def _on_arcs(self, points: Array, which: Index) -> Foot:
        return self.arcs[self.place[which]].foot(points)

    def _on_curves(self, points: Array, which: Index) -> Foot:
        found = Foot(*(np.empty((len(points), *s)) for s in ((3,), (), (), (3,))))
        order = np.argsort(which, kind="stable")
        for rows in np.split(order, np.flatnonzero(np.diff(which[order])) + 1):
            _put(found, rows, self.columns.curves[int(which[rows[0]])].foot(points[rows]))
        return found

    def at(self, which: Index, along: Array) -> Array:
        """Points (n, 3) on segments of their numbers, at distances from the start [mm]."""
        c = self.columns
        found = c.start[which] + along[:, None] * self.directions[which]
        shapes = c.shape[which]
        rows = np.flatnonzero(shapes == ARC)
        if len(rows):
            arcs = self.arcs[self.place[which[rows]]]
            found[rows] = arcs.points(along[rows] / arcs.length * arcs.angle)
        for i in distinct(which[shapes == CUBIC]).tolist():
            rows = np.flatnonzero(which == i)
            found[rows] = c.curves[i].at(along[rows])
        return found


def _long_runs(which: Index) -> list[tuple[int, int]]:
    """First and last row + 1 of each run of equal numbers (n,); empty if most runs are short."""
    cuts = np.flatnonzero(which[1:] != which[:-1]) + 1
    many = not len(which) or RUN * (len(cuts) + 1) > len(which)
    return [] if many else [*pairwise([0, *cuts.tolist(), len(which)])]


def _distances(segment: Segment, points: Array) -> Array:
    if isinstance(segment, Arc):
        return segment.own.distances(points)
    return segment.foot(points).distance


def _put(found: Foot, rows: Index, part: Foot) -> None:
    for name in Foot.__dataclass_fields__:
        getattr(found, name)[rows] = getattr(part, name)


def _joined(parts: list[Foot]) -> Foot:
    names = Foot.__dataclass_fields__
    return Foot(*(np.concatenate([getattr(p, name) for p in parts]) for name in names))
