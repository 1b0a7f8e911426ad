"""Which segment each sample belongs to: monotone along the path."""

import numpy as np
from numpy.typing import NDArray

from motionfmu.contour.geometry import Array, Segment

Index = NDArray[np.int64]
# First sample of a segment's candidates; for each of them: sample of entry, segment before it.
Row = tuple[int, NDArray[np.int32], NDArray[np.int32]]


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
    for s, (a, b) in enumerate(zip(begin.tolist(), end.tolist(), strict=True)):
        if a >= b:
            continue
        square = segments[s].foot(points[a:b]).distance ** 2
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


def _trace_back(count: int, s: int, table: dict[int, Row]) -> Index:
    chosen = np.empty(count, dtype=np.int64)
    stop = count
    while stop > 0:
        a, entry, before = table[s]
        start = int(entry[stop - 1 - a])
        chosen[a + start : stop] = s
        stop, s = a + start, int(before[start])
    return chosen
