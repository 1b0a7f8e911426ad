"""Signals at every communication step, as many of the latest as there is room for."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

CHANNELS = 16
ROWS = 1 << 18  # 26 s at 0.1 ms, 34 MB with all channels


class SampleRing:
    """Samples of channels, each of before its communication step."""

    def __init__(self, channels: Sequence[str], first: int = 0, rows: int = ROWS) -> None:
        self.channels = tuple(channels)
        self.first = self.end = first
        self._rows = rows
        self._samples = np.zeros((rows, len(self.channels)))

    @property
    def begin(self) -> int:
        """The earliest step that is still there."""
        return max(self.first, self.end - self._rows)

    def write(self, rows: NDArray[Any]) -> None:
        """Add the samples of steps, shape (steps, channels)."""
        self.end += len(rows)
        rows = rows[-self._rows :]
        first = (self.end - len(rows)) % self._rows
        head = min(len(rows), self._rows - first)
        self._samples[first : first + head] = rows[:head]
        self._samples[: len(rows) - head] = rows[head:]

    def cut(self, step: int) -> None:
        """Forget what was at a step and later."""
        self.first = self.begin  # what was before has been written over
        if not self.first <= step <= self.end:
            self.first = step
        self.end = step

    def since(self, step: int, most: int | None = None) -> tuple[int, NDArray[Any]]:
        """The first step that is there from one on, and samples of shape (steps, channels).

        With `most` the latest so many.
        """
        begin = max(step, self.begin)
        if most is not None:
            begin = max(begin, self.end - most)
        return begin, self.between(begin, self.end)

    def between(self, begin: int, end: int) -> NDArray[Any]:
        """Samples of steps that are all there, shape (steps, channels)."""
        places = np.arange(begin, max(begin, end)) % self._rows
        return self._samples[places]
