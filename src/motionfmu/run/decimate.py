"""Fewer points of a long signal, with every peak kept."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.columns import ROWS, forget
from motionfmu.base.order import distinct

Array = NDArray[np.float64]
Index = NDArray[np.int64]
# A function that gives the values from one sample to before another, of a signal or of what is
# computed from one; so a long signal can be read block by block.
Read = Callable[[int, int], Array]

# A figure has so many samples of a curve at most; of a longer curve it has the peaks.
MOST = 120_000


def reader(values: Any) -> Read:
    """A `Read` of an array; of a mapped file the last part is let go when the next one is read."""

    def read(first: int, last: int) -> Array:
        forget(values)
        return np.asarray(values[first:last])

    return read


def few(count: int, read: Read, steps: bool, most: int = MOST) -> Index | None:
    """The samples of a curve of `count` that a figure has; None for all."""

    def plain(first: int, last: int) -> Array:
        return np.nan_to_num(np.asarray(read(first, last), dtype=np.float64))

    if count <= most:
        return None
    return (steps_of if steps else peaks_of)(count, plain, most // 2 - 1)


def at(read: Read, samples: Index) -> Array:
    """Values at some samples, whose numbers increase."""
    parts = [read(0, 0)]
    for first in range(0, int(samples[-1]) + 1 if len(samples) else 0, ROWS):
        low, high = np.searchsorted(samples, [first, first + ROWS])
        if high > low:
            parts.append(read(first, int(samples[high - 1]) + 1)[samples[low:high] - first])
    return np.concatenate(parts)


def blocks(count: int, read: Read) -> Iterator[Array]:
    """All values, block by block."""
    for first in range(0, count, ROWS):
        yield read(first, min(first + ROWS, count))


def ends(count: int, read: Read) -> tuple[Array, Array]:
    """The least and the largest value of each column; NaN where one is."""
    low, high = read(0, 1)[0], read(0, 1)[0]
    for block in blocks(count, read):
        low = np.minimum(low, block.min(axis=0))
        high = np.maximum(high, block.max(axis=0))
    return low, high


def keep_steps(values: Array, buckets: int) -> Index:
    """Samples at which a staircase changes, or its peaks."""
    return steps_of(len(values), reader(values), buckets)


def keep_peaks(values: Array, buckets: int) -> Index:
    """Samples with the least and the largest value of each bucket."""
    # The values are (n,) or (n, k): one or k signals with common samples. Both ends are kept.
    return peaks_of(len(values), reader(values), buckets)


def steps_of(count: int, read: Read, buckets: int) -> Index:
    """Samples at which a staircase changes, or its peaks."""
    # Peaks are taken if there are more than twice as many changes as buckets. Both ends are kept.
    parts, found = [np.array([0, count - 1])], 0
    for first in range(1, count, ROWS):
        block = read(first - 1, min(first + ROWS, count))
        parts.append(np.flatnonzero(block[1:] != block[:-1]) + first)
        found += len(parts[-1])
        if found > 2 * buckets:
            return peaks_of(count, read, buckets)
    return distinct(np.concatenate(parts))


def peaks_of(count: int, read: Read, buckets: int) -> Index:
    """Samples with the least and the largest value of each bucket."""
    if count <= 2 * buckets:
        return np.arange(count)
    edges = np.linspace(0, count, buckets + 1).astype(np.int64)
    width = int(np.diff(edges).max())
    kept = [np.array([0, count - 1])]
    several = max(1, ROWS // width)  # so many buckets are read at a time
    for first in range(0, buckets, several):
        ends = edges[first : first + several + 1]
        # rows of equal length: the last samples of a shorter bucket are repeated
        rows = np.minimum(ends[:-1, None] + np.arange(width), ends[1:, None] - 1)
        block = read(int(ends[0]), int(ends[-1]))
        for column in block.reshape(len(block), -1).T:
            values = column[rows - ends[0]]
            for best in (values.argmin(axis=1), values.argmax(axis=1)):
                kept.append(rows[np.arange(len(rows)), best])
    return distinct(np.concatenate(kept))
