"""Recorded signals in other units and in parts, without a copy of them."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from motionfmu.columns import forget
from motionfmu.contour.arcs import Array

# Samples that are looked at together: enough for few calls, few enough for little memory.
BLOCK = 1 << 16


@dataclass(frozen=True, eq=False)
class Scaled:
    """Values (n, m) over a divisor, or one for each column: made for the part that is asked for."""

    values: Array
    divisor: Array | float

    @property
    def shape(self) -> tuple[int, ...]:
        """Rows and columns."""
        return self.values.shape

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
        """All of it, to be changed."""
        return self[:]


def blocks(count: int, *passed: Any) -> Iterator[slice]:
    """Samples in parts; of arrays that are passed with them, a file's pages are let go."""
    for first in range(0, count, BLOCK):
        yield slice(first, min(first + BLOCK, count))
        for array in passed:
            forget(array.values if isinstance(array, Scaled) else array)
