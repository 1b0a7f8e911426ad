"""Times of samples, and values of signals some time before or after them."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from motionfmu.analysis.contour.arcs import Array
from motionfmu.analysis.contour.scaled_values import blocks
from motionfmu.analysis.contour.segments import Index
from motionfmu.base.columns import room
from motionfmu.base.order import median

# Samples are evenly spaced if each lies within this part of a step of its place; k times a step,
# rounded, is far nearer even after days.
EVEN = 1e-7


@dataclass(frozen=True, eq=False)
class Instants:
    """Times (n,) of samples [s], which increase."""

    time: Array

    def __len__(self) -> int:
        return len(self.time)

    @cached_property
    def step(self) -> float:
        """Mean time between two samples [s]."""
        return float(self.time[-1] - self.time[0]) / (len(self.time) - 1)

    @cached_property
    def even(self) -> bool:
        """Whether samples are evenly spaced."""
        time, step = self.time, self.step
        for own in blocks(len(time), time):
            off = time[own] - (float(time[0]) + step * np.arange(own.start, own.stop))
            if not np.abs(off, out=off).max() <= EVEN * step:
                return False
        return True

    @cached_property
    def middle(self) -> float:
        """Median time between two samples [s]."""
        return self.step if self.even else median(np.diff(self.time))

    def shifted(self, values: Any, shift: float) -> Any:
        """Values (n,) that hold at each time plus a shift [s]."""
        count = len(self)
        found = room(count, values.dtype, values)
        k = math.floor(shift / self.step)
        if self.even and 2.0 * EVEN < shift / self.step - k < 1.0 - 2.0 * EVEN:
            k = min(max(k, -count), count)
            for own in blocks(count, values, found):
                low, high = own.start + k, own.stop + k
                if low >= 0 and high <= count:
                    found[own] = values[low:high]
                else:
                    found[own] = values[np.clip(np.arange(low, high), 0, count - 1)]
            return found
        for own in blocks(count, self.time, values, found):
            found[own] = values[self._at(own, shift)]
        return found

    def _at(self, own: slice, shift: float) -> Index:
        """The samples whose values hold at times plus a shift."""
        time, last = self.time, len(self) - 1
        goal = np.asarray(time[own]) + shift
        # For evenly spaced samples it can be computed, which is verified.
        even = np.arange(own.start, own.stop) + math.floor(shift / self.step)
        found = np.clip(even, 0, last)
        found += (found < last) & (time[np.minimum(found + 1, last)] <= goal)
        wrong = (time[found] > goal) & (found > 0)
        wrong |= (found < last) & (time[np.minimum(found + 1, last)] <= goal)
        if wrong.any():
            rest = np.searchsorted(time, goal[wrong], side="right") - 1
            found[wrong] = np.clip(rest, 0, last)
        return found

    def speed(self, along: Array, span: float, own: slice | None = None) -> Array:
        """Speed [mm/s] at samples of a position along the path [mm], averaged over `span` [s]."""
        time = self.time
        begin, end, _ = (own or slice(None)).indices(len(time))
        found = room(max(0, end - begin), np.float64, along)
        part, whole = math.modf(0.5 * span / self.step)
        reach = int(whole)
        for block in blocks(len(found), time, along, found):
            low, high = begin + block.start, begin + block.stop
            if self.even and low > reach and high + reach < len(time):
                way = along[low - reach - 1 : high + reach + 1]
                less = part * way[: high - low] + (1.0 - part) * way[1 : high - low + 1]
                way = way[2 * reach + 1 :]
                more = (1.0 - part) * way[:-1] + part * way[1:]
                np.subtract(more, less, out=found[block])
                found[block] /= span
                continue
            now = np.asarray(time[low:high])
            first = np.maximum(now - 0.5 * span, time[0])
            last = np.minimum(now + 0.5 * span, time[-1])
            near = slice(
                max(0, int(np.searchsorted(time, first[0], side="right")) - 1),
                int(np.searchsorted(time, last[-1])) + 1,
            )
            place, way = time[near], along[near]
            found[block] = np.interp(last, place, way) - np.interp(first, place, way)
            found[block] /= last - first
        return found
