"""Recorded signals in other units, converted part by part, so that no copy is made of them."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from motionfmu.analysis.contour.arcs import Array
from motionfmu.base.columns import forget

# Samples of a block: enough that there are few calls, few enough that they take little memory.
BLOCK = 1 << 15
FAR = 256  # rows far apart that are read at a time


@dataclass(frozen=True, eq=False)
class ScaledValues:
    """Values (n, m) divided by a number or one for each column; parts are computed when read."""

    values: Array
    divisor: Array | float

    @property
    def shape(self) -> tuple[int, ...]:
        """Rows and columns."""
        return self.values.shape

    @property
    def base(self) -> Array:
        """The array of which this is a view."""
        return self.values

    def __len__(self) -> int:
        return len(self.values)

    def __getitem__(self, key: Any) -> Array:
        divisor = self.divisor
        if isinstance(key, tuple) and np.ndim(divisor):
            divisor = np.asarray(divisor)[key[1]]
        return np.asarray(self.values[key] / divisor)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Array:
        return np.asarray(self[:], dtype=dtype)

    def copy(self) -> Array:
        """All values as an array that can be changed."""
        return self[:]


def places(values: Any, rows: Any) -> Array:
    """The first three columns (n, 3) of some rows, each contiguous, for quick sums of them."""
    divisor = 1.0
    if isinstance(values, ScaledValues):
        values, divisor = values.values, values.divisor
    each = np.broadcast_to(divisor, values.shape[1])
    columns = [values[rows, i] for i in range(3)]
    found = np.empty((3, len(columns[0])))
    for column, by, out in zip(columns, each.tolist(), found, strict=False):
        np.divide(column, by, out=out)
    return found.T


def picked(read: Callable[[Any], Array], rows: Any, *passed: Any) -> Array:
    """What `read` gives of rows that lie far apart, some at a time."""
    # A page of a mapped file brings those around it along, 64 kB.
    parts = []
    for first in range(0, max(1, len(rows)), FAR):
        parts.append(read(rows[first : first + FAR]))
        for array in passed:
            forget(array)
    return np.concatenate(parts)


def finite(values: Any, own: slice) -> Any:
    """Which values of some rows are finite; whole numbers always are."""
    good = np.ones(1, dtype=bool)
    if isinstance(values, ScaledValues):
        divisor, values = np.asarray(values.divisor), values.values
        good = np.isfinite(divisor) & (divisor != 0.0)
    return good if values.dtype.kind in "iub" else np.isfinite(values[own]) & good


def blocks(count: int, *passed: Any) -> Iterator[slice]:
    """Slices of all samples, block by block; pages of mapped arrays that were read are let go."""
    for first in range(0, count, BLOCK):
        yield slice(first, min(first + BLOCK, count))
        for array in passed:
            forget(array)
