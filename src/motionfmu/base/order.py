"""Quantiles, median and distinct values as NumPy gives them, without importing masked arrays."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def quantiles(values: Array, shares: Sequence[float], ours: bool = False) -> list[float]:
    """The values below which these shares of the values (n,) lie, linearly interpolated.

    With `ours` the values may be put into another order.
    """
    places = [share * (len(values) - 1) for share in shares]
    low = [int(place) for place in places]
    high = [min(k + 1, len(values) - 1) for k in low]
    ordered = values if ours else values.copy()
    ordered.partition(sorted({*low, *high}))
    ends = zip(places, low, high, strict=True)
    return [float(ordered[a] + (ordered[b] - ordered[a]) * (place - a)) for place, a, b in ends]


def median(values: Array) -> float:
    """The middle of the values (n,)."""
    return quantiles(values, (0.5,))[0]


def distinct(values: Any) -> Any:
    """Each value once, from the least to the largest."""
    ordered = np.sort(values)
    return ordered[np.concatenate([[True], ordered[1:] != ordered[:-1]])] if len(values) else values
