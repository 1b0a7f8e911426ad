"""Which rows of a large study are drawn: some thousands show what a million would."""

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from motionfmu.study.study_outcome import Outcome

DRAWN = 5_000  # rows; a page of them has 1 MB


def drawn_rows(outcome: "Outcome") -> "Outcome":
    """The outcome itself, or one of at most some thousand of its rows.

    Of a grid over two axes some of its lines each way are kept, else rows by chance, always the
    same. The smallest and the largest cost are always among them.
    """
    count = len(outcome.rows)
    if count <= DRAWN:
        return outcome
    kept = _ends(outcome)
    sizes = [len(outcome.study.points.different(i)) for i in range(len(outcome.study.axes))]
    whole = count == math.prod(sizes) == len(outcome.study.points)
    if outcome.study.sampling == "grid" and len(sizes) == 2 and whole:
        places = _lines(kept, sizes)
    else:
        by_chance = np.random.default_rng(0).choice(count, DRAWN - len(kept), replace=False)
        places = np.union1d(kept, by_chance)
    return replace(outcome, rows=[outcome.rows[int(place)] for place in places])


def _ends(outcome: "Outcome") -> NDArray[Any]:
    """Places of the smallest cost, without an error and of all, and of the largest."""
    cost = outcome.cost
    good = np.where(outcome.counts.ok, cost, np.nan)
    found = [cost if np.isfinite(cost).any() else None, good if np.isfinite(good).any() else None]
    ends = [f(c) for c in found if c is not None for f in (np.nanargmin, np.nanargmax)]
    return np.unique(np.array(ends, dtype=np.int64))


def _lines(kept: NDArray[Any], sizes: list[int]) -> NDArray[Any]:
    """Places on some lines of a grid of two axes, among them those of some places."""
    across, up = sizes
    even = math.isqrt(DRAWN)
    first = min(across, max(even, DRAWN // up))
    numbers = first, min(up, DRAWN // first)
    i, j = (
        np.union1d(np.linspace(0, size - 1, number).round().astype(np.int64), own)
        for size, number, own in zip(sizes, numbers, (kept // up, kept % up), strict=True)
    )
    return (i[:, None] * up + j).ravel()
