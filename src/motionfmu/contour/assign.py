"""Which segment each sample belongs to: monotone along the path."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from motionfmu.contour.geometry import Array, Line, Lines, Segment

Index = NDArray[np.int64]
# First sample of a segment's candidates; for each of them: sample of entry, segment before it.
Row = tuple[int, NDArray[np.int32], NDArray[np.int32]]
# Samples of short lines that are taken in one go: few calls, and little memory.
TOGETHER = 20_000


def assign(points: Array, segments: tuple[Segment, ...], first: Index, last: Index) -> Index:
    """Give each sample (n, 3) one segment of its candidates, first to last (n,), never going back.

    Of all assignments that stay within the candidates and never return to an earlier segment, the
    one with the least sum of squared distances is found, exactly, by dynamic programming along the
    segments. So a path that crosses itself, or touches itself, attracts no sample to the wrong
    branch: jumping ahead would have to be paid for by all samples that follow. It is a ValueError
    if candidates decrease or are missing.

    With C(s, t) the least cost when sample t is on segment s, and D the running sum of its squared
    distances, ``C(s, t) = D(t) + min over u <= t of (M(u - 1) - D(u - 1))``, where M is the least C
    of all earlier segments: one running minimum per segment.
    """
    if (first > last).any() or (np.diff(first) < 0).any() or (np.diff(last) < 0).any():
        raise ValueError("candidates must not be empty nor decrease with time")
    count = len(points)
    least = np.full(count, np.inf)  # M
    owner = np.full(count, -1)  # segment that attains M
    table: dict[int, Row] = {}
    begin = np.searchsorted(last, np.arange(len(segments)), side="left")
    end = np.searchsorted(first, np.arange(len(segments)), side="right")
    for s, square in _squares(points, segments, begin, end):
        a, b = int(begin[s]), int(end[s])
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


def _squares(
    points: Array, segments: tuple[Segment, ...], begin: Index, end: Index
) -> Iterator[tuple[int, Array]]:
    """Each segment that has candidates, and their squared distances."""
    counts = np.maximum(end - begin, 0)
    upto = np.concatenate([[0], np.cumsum(counts)])
    s = 0
    while s < len(segments):
        stop = s
        while (
            stop < len(segments)
            and isinstance(segments[stop], Line)
            and upto[stop + 1] - upto[s] <= TOGETHER
        ):
            stop += 1
        if stop <= s + 1:
            if counts[s]:
                yield s, segments[s].foot(points[begin[s] : end[s]]).distance ** 2
            s += 1
            continue
        which = np.repeat(np.arange(stop - s), counts[s:stop])
        row = np.arange(len(which)) + (begin[s:stop] - upto[s:stop] + upto[s])[which]
        lines = Lines([x for x in segments[s:stop] if isinstance(x, Line)])
        square = lines.foot(points[row], which).distance ** 2
        for i in np.flatnonzero(counts[s:stop]).tolist():
            yield s + i, square[upto[s + i] - upto[s] : upto[s + i + 1] - upto[s]]
        s = stop


def _trace_back(count: int, s: int, table: dict[int, Row]) -> Index:
    chosen = np.empty(count, dtype=np.int64)
    stop = count
    while stop > 0:
        a, entry, before = table[s]
        start = int(entry[stop - 1 - a])
        chosen[a + start : stop] = s
        stop, s = a + start, int(before[start])
    return chosen
