"""Assignment of samples to segments of a path, in the order of travel."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.contour.arcs import Array
from motionfmu.analysis.contour.geometry import norms
from motionfmu.analysis.contour.path import Path
from motionfmu.analysis.contour.scaled_values import BLOCK, blocks, places
from motionfmu.analysis.contour.segments import Index
from motionfmu.base.columns import forget, room

# Successive samples are searched in groups of so many, of which the middle one comes first.
STRIDE = 32
# Number of parts of its candidates at whose ends such a sample is compared first.
SPREAD = 8
# Distances that differ by less are the same [mm]: a corner is as far from both its moves.
SAME = 1e-9
# Upper bound of rounding in the length along a path of kilometres [mm].
ROUNDED = 1e-6


def assign(
    points: Any,
    path: Path,
    first: Index,
    last: Index,
    progress: Callable[[float], None] = lambda share: None,
) -> Index:
    """Give each sample one segment of its candidates, first to last (n,), never going back.

    `points` are an array (n, 3 or more) [mm], or what gives one for some rows of it.

    Of all assignments that stay within the candidates and never return to an earlier segment, the
    one with the least sum of squared distances is found. So a path that crosses or touches itself
    attracts no sample to the wrong branch, because to jump ahead would make all later samples
    worse. Of segments that are equally near, as both moves are at a corner, the later one is taken.
    A ValueError if candidates decrease or are missing.

    No assignment is better than one where each sample has its nearest candidate. Where those do not
    decrease, they are the result. Stretches where they do are solved by dynamic programming, each
    by itself; if what is found there does not fit what is around it, both become one stretch.
    """
    count = len(first)
    low, high, own = _rooms(first, last)
    for some in blocks(count, points, low, high):
        several = some.start + np.flatnonzero(low[some] < high[some])
        if len(several):
            part = places(points, several)
            low[several], high[several] = nearest(part, path, (low[several], high[several]))
        progress(some.stop / len(low))
    if not len(low):
        return low
    alone, solved = None, np.zeros(len(low), dtype=bool)
    while True:
        _from_behind(high, own)
        bad, most = np.empty(count, dtype=bool), low[0]
        for some in blocks(count, low, high, own):
            upto = np.maximum.accumulate(np.maximum(low[some], most))
            most = upto[-1]
            bad[some] = upto > own[some]
            # a path that comes back may have farther segments between two that are as near
            inside = (low[some] < own[some]) & (own[some] < high[some])
            between = some.start + np.flatnonzero(inside)
            bad[between] = ~_as_near(points, path, between, (low, own))
        if not bad.any():
            return own
        alone = low.copy() if alone is None else alone
        for a, b in _stretches(bad | solved):
            if bad[a:b].any():
                candidates = np.asarray(first[a:b]), np.asarray(last[a:b])
                part = places(points, slice(a, b))
                low[a:b] = high[a:b] = _solved(part, path, candidates, alone[a:b])
                solved[a:b] = True


def _rooms(first: Index, last: Index) -> tuple[Index, Index, Index]:
    """Copies of candidates, which must not decrease nor be empty, and room for a result."""
    count, wrong = len(first), "candidates must not be empty nor decrease with time"
    low, high, own = (room(count, np.int32, first) for _ in range(3))
    for some in blocks(count, first, last, low, high):
        low[some], high[some] = first[some], last[some]
        if (first[some] > last[some]).any():
            raise ValueError(wrong)
        if any(_falls(x[max(0, some.start - 1) : some.stop]) for x in (first, last)):
            raise ValueError(wrong)
    return low, high, own


def _from_behind(high: Index, own: Index) -> None:
    """Fill in the least of all values from each on."""
    least = high[-1]
    for some in reversed(list(blocks(len(high), high, own))):
        back = high[some][::-1]
        np.minimum.accumulate(np.minimum(back, least), out=own[some][::-1])
        least = own[some.start]
        for array in (high, own):
            forget(array)


def _as_near(points: Any, path: Path, rows: Index, segments: tuple[Index, Index]) -> Any:
    """Whether the two segments of each of some samples are equally near."""
    good = np.empty(len(rows), dtype=bool)
    for begin in range(0, len(rows), BLOCK):
        own = rows[begin : begin + BLOCK]
        part = places(points, own)
        one, other = (path.segments.distances(part, s[own]) for s in segments)
        good[begin : begin + BLOCK] = other <= one + 2.0 * SAME
    return good


def nearest(
    points: Array, path: Path, candidates: tuple[Index, Index], room: Array | float = 0.0
) -> tuple[Index, Index]:
    """First and last of the segments that are nearest to points (n, 3), but for `room` [mm].

    Candidates (n,) are the segments from a first one to a last one. Nothing is missed: where the
    end of a segment is d farther from a point than the nearest place so far, no place within the
    way d of that end is nearer, and the search goes on behind it. Of points in a row, which lie
    within r of the middle one, none has a nearest segment that is more than 2 r farther from that
    one than its own: what is farther needs no look from the others.
    """
    count, (first, last) = len(points), candidates
    room = np.broadcast_to(np.asarray(room) + SAME, count)
    starts = np.arange(0, count, STRIDE)
    stops = np.minimum(starts + STRIDE, count)
    middle = (starts + stops) // 2
    sizes = stops - starts
    radius = np.maximum.reduceat(norms(points - np.repeat(points[middle], sizes, axis=0)), starts)
    wide = (first[starts], last[stops - 1])  # what is a candidate of one of the row at least
    own = 2.0 * radius + np.maximum.reduceat(room, starts)
    search = _Search.begin(points[middle], path, wide, own)
    for k in range(SPREAD + 1):
        search.look(np.arange(len(middle)), wide[0] + (wide[1] - wide[0]) * k // SPREAD)
    search.spread()
    found = search.nearest
    every = (first[stops - 1] <= found) & (found <= last[starts])  # a candidate of all of the row
    low = np.repeat(np.where(every, search.low, wide[0]), sizes)
    high = np.repeat(np.where(every, search.high, wide[1]), sizes)
    low, high = np.maximum(low, first), np.minimum(high, last)
    rows = np.flatnonzero(low < high)
    if len(rows):
        some = (low[rows], high[rows])
        guess = np.round(np.interp(rows, middle, found)).astype(np.int32)
        search = _Search.begin(points[rows], path, some, room[rows])
        search.look(np.arange(len(rows)), np.clip(guess, *some))
        search.spread()
        low[rows], high[rows] = search.low, search.high
    return low, high


@dataclass(eq=False)
class _Search:
    """State of the search of the nearest segments of some points."""

    points: Array
    path: Path
    candidates: tuple[Index, Index]
    room: Array
    best: Array  # distance of the nearest place so far [mm]
    nearest: Index  # its segment
    low: Index  # first and last of the equally near segments
    high: Index

    @classmethod
    def begin(
        cls, points: Array, path: Path, candidates: tuple[Index, Index], room: Array
    ) -> "_Search":
        one = candidates[0].astype(np.int32)
        none = np.full(len(points), np.inf)
        return cls(points, path, candidates, room, none, one, one.copy(), one.copy())

    def look(self, rows: Index, segment: Index) -> None:
        """Compare some of the points with a segment."""
        distance = self.path.segments.distances(self.points[rows], segment)
        best, room = self.best[rows], self.room[rows]
        near = distance <= best + room
        if not near.any():
            return
        fresh = distance < best - room
        low, high = self.low[rows], self.high[rows]
        self.low[rows] = np.where(fresh, segment, np.where(near, np.minimum(low, segment), low))
        self.high[rows] = np.where(fresh, segment, np.where(near, np.maximum(high, segment), high))
        self.nearest[rows] = np.where(distance < best, segment, self.nearest[rows])
        self.best[rows] = np.minimum(distance, best)

    def spread(self) -> None:
        """Compare all candidates on either side that may be as near as the best so far."""
        segments = self.path.segments
        begin, end = segments.way
        here = self.nearest.copy()
        rows, s = np.flatnonzero(here < self.candidates[1]), here[here < self.candidates[1]]
        while len(rows):
            free = self._free(rows, segments.ends[s])
            s = np.maximum(s + 1, np.searchsorted(end, end[s] + free))
            on = s <= self.candidates[1][rows]
            rows, s = rows[on], s[on]
            self.look(rows, s)
        rows, s = np.flatnonzero(here > self.candidates[0]), here[here > self.candidates[0]]
        while len(rows):
            free = self._free(rows, segments.columns.start[s])
            s = np.minimum(s - 1, np.searchsorted(begin, begin[s] - free, side="right") - 1)
            on = s >= self.candidates[0][rows]
            rows, s = rows[on], s[on]
            self.look(rows, s)

    def _free(self, rows: Index, node: Array) -> Array:
        """Length from a segment's end on which nothing is as near as the best so far [mm]."""
        return norms(self.points[rows] - node) - self.best[rows] - self.room[rows] - ROUNDED


def _solved(points: Array, path: Path, candidates: tuple[Index, Index], alone: Index) -> Index:
    """The best assignment of some samples, by dynamic programming along the segments.

    A simple assignment moves each sample forward only as far as those before it require. Its cost
    is a bound: a segment that costs one sample more has no part in the best assignment.

    With C(s, t) the least cost when sample t is on segment s, and D the running sum of its squared
    distances, ``C(s, t) = D(t) + min over u <= t of (M(u - 1) - D(u - 1))``, where M is the least C
    of all earlier segments: one running minimum per segment.
    """
    distances = path.segments.distances
    single = distances(points, alone)
    trial = distances(points, np.maximum.accumulate(alone))
    slack = float(np.sum(np.maximum(trial**2 - single**2, 0.0)))
    slack += 2.0 * SAME * float(np.sum(trial + SAME))
    low, high = nearest(points, path, candidates, np.sqrt(single**2 + slack) - single + SAME)
    low, high = np.minimum.accumulate(low[::-1])[::-1], np.maximum.accumulate(high)
    count = len(points)
    least = np.full(count, np.inf)  # M
    owner = np.full(count, -1)  # segment that attains M
    table: dict[int, tuple[int, Index, Index]] = {}
    for s in range(int(low[0]), int(high[-1]) + 1):
        a, b = int(np.searchsorted(high, s)), int(np.searchsorted(low, s, side="right"))
        if a >= b:
            continue
        square = distances(points[a:b], np.full(b - a, s)) ** 2
        total = np.cumsum(square)
        enter = np.concatenate([[0.0 if a == 0 else least[a - 1]], least[a : b - 1]])
        enter = enter - (total - square)
        run = np.minimum.accumulate(enter)
        fresh = np.concatenate([[True], enter[1:] < run[:-1]])
        entry = np.maximum.accumulate(np.where(fresh, np.arange(b - a), 0))
        before = np.concatenate([[-1 if a == 0 else owner[a - 1]], owner[a : b - 1]])
        table[s] = (a, entry.astype(np.int32), before.astype(np.int32))
        cost = run + total
        better = cost < least[a:b]
        least[a:b][better] = cost[better]
        owner[a:b][better] = s
    return _trace_back(count, int(owner[-1]), table)


def _trace_back(count: int, s: int, table: dict[int, tuple[int, Index, Index]]) -> Index:
    chosen = np.empty(count, dtype=np.int32)
    stop = count
    while stop > 0:
        a, entry, before = table[s]
        start = int(entry[stop - 1 - a])
        chosen[a + start : stop] = s
        stop, s = a + start, int(before[start])
    return chosen


def _falls(values: Index) -> bool:
    return bool((values[1:] < values[:-1]).any())


def _stretches(chosen: NDArray[np.bool_]) -> list[tuple[int, int]]:
    edges = np.flatnonzero(np.diff(np.concatenate([[False], chosen, [False]])))
    return [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]
