"""Largest, least and mean values of many ranges of samples at once."""

from collections.abc import Iterator

import numpy as np

from motionfmu.analysis.contour.arcs import Array
from motionfmu.analysis.contour.scaled_values import BLOCK
from motionfmu.analysis.contour.segments import Index


def parts(low: Index, high: Index) -> Iterator[tuple[slice, Index, Index]]:
    """Ranges from low to before high (n,), not empty, in parts of not too many samples.

    A part is a slice of the ranges, all their samples one range behind the other, and where each
    range begins among these.
    """
    counts = high - low
    upto = np.concatenate([[0], np.cumsum(counts)])
    begin = 0
    while begin < len(low):
        end = max(begin + 1, int(np.searchsorted(upto, upto[begin] + BLOCK, side="right")) - 1)
        own = slice(begin, end)
        first = upto[begin:end] - upto[begin]
        shift = np.repeat(low[own] - first, counts[own])
        yield own, np.arange(len(shift)) + shift, first
        begin = end


def largest(values: Array, first: Index) -> tuple[Array, Index]:
    """Largest value of each range, and where it is first."""
    top = np.maximum.reduceat(values, first)
    counts = np.diff(first, append=len(values))
    there = np.flatnonzero(values == np.repeat(top, counts))
    return top, there[np.searchsorted(there, first)]
