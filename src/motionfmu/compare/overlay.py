"""Two recordings on one time axis, and their difference."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError
from motionfmu.base.units import spelled
from motionfmu.compare.side import Side

Array = NDArray[np.float64]

NEAR = 1e-6  # two times that differ by this part of a step at most are equal


@dataclass(frozen=True)
class Common:
    """The instants at which two runs are compared."""

    time: Array  # (n,) [s]
    words: tuple[str, ...]  # in what the two recordings differ; empty if they have the same times
    between: tuple[bool, bool]  # whether values of A, of B are taken between its samples


@dataclass(frozen=True)
class Pair:
    """A signal of both runs."""

    name: str
    unit: str  # as FMI spells it; 1 for a bare number
    steps: bool  # it holds between samples
    time: Array  # (n,) common [s]
    a: Array  # (n, k) of the first run
    b: Array  # (n, k) of the second
    scalar: bool  # not an array of axes

    @property
    def difference(self) -> Array:
        """B - A, (n, k); 0 where neither is a number."""
        both = np.isnan(self.a) & np.isnan(self.b)
        return np.where(both, 0.0, self.b - self.a)

    @property
    def names(self) -> list[str]:
        """Of the elements."""
        return (
            [self.name]
            if self.scalar
            else [f"{self.name}[{i + 1}]" for i in range(self.a.shape[1])]
        )

    @property
    def same(self) -> bool:
        """Whether all common samples are equal."""
        return bool(np.array_equal(self.a, self.b, equal_nan=True))

    @property
    def differing(self) -> list[int]:
        """Elements that differ, from 0."""
        return [int(i) for i in np.flatnonzero((self.difference != 0.0).any(axis=0))]

    @property
    def largest(self) -> tuple[float, int, float]:
        """Difference of the largest magnitude with its sign, its element from 0, its time [s]."""
        found = self.difference
        size = np.where(np.isnan(found), np.inf, np.abs(found))
        at, element = np.unravel_index(int(np.argmax(size)), size.shape)
        return float(found[at, element]), int(element), float(self.time[at])

    @property
    def rms(self) -> float:
        """Root of the mean square of the difference over common samples and elements."""
        return float(np.sqrt(np.mean(self.difference**2)))


# CCN 16: three things may differ between two recordings, each with its words for the reader.
def common(a: Side, b: Side) -> Common:
    """Where both runs have values: the samples of the coarser one in the time both cover."""
    if len(a.time) == len(b.time) and np.allclose(a.time, b.time, rtol=0, atol=1e-12):
        return Common(a.time, (), (False, False))
    steps = [float(np.median(np.diff(x.time))) if len(x.time) > 1 else 0.0 for x in (a, b)]
    near = NEAR * min((s for s in steps if s > 0), default=0.0)
    low, high = max(a.time[0], b.time[0]), min(a.time[-1], b.time[-1])
    coarse = a if steps[0] >= steps[1] else b
    time = coarse.time[(coarse.time >= low - near) & (coarse.time <= high + near)]
    if not len(time):
        raise InputError(f"{a.name} and {b.name} have no time in common")
    words = []
    if abs(steps[0] - steps[1]) > near:
        told = " and ".join(
            f"every {1e3 * s:.9g} ms ({n})" for s, n in zip(steps, "AB", strict=True)
        )
        words.append(
            f"recorded {told}: compared at the {len(time)} common instants of {'AB'[coarse is b]}"
        )
    ends = (a.time[-1] + steps[0], b.time[-1] + steps[1])
    if abs(ends[0] - ends[1]) > near:
        first, last = ("A", "B") if ends[0] < ends[1] else ("B", "A")
        words.append(
            f"{first} ends at {min(ends):.9g} s, {last} at {max(ends):.9g} s: compared up to the"
            f" end of {first}"
        )
    between = tuple(not _on(x.time, time, near) for x in (a, b))
    for name, off in zip("AB", between, strict=True):
        if off:
            words.append(f"values of {name} between its samples lie on straight lines; counts hold")
    return Common(time, tuple(words), (between[0], between[1]))


def _on(samples: Array, time: Array, near: float) -> bool:
    """Whether all times are samples."""
    at = np.clip(np.searchsorted(samples, time - near), 0, len(samples) - 1)
    return bool((np.abs(samples[at] - time) <= near).all())


def mismatch(name: str, a: Side, b: Side) -> str:
    """Why a signal that both runs have cannot be compared; else empty."""
    units = a.numbers["units"][name], b.numbers["units"][name]
    if units[0] != units[1]:
        return f"[{spelled(units[0]) or '1'}] in A, [{spelled(units[1]) or '1'}] in B"
    shapes = [x.signals[name].shape[1:] for x in (a, b)]
    if shapes[0] != shapes[1]:
        one, other = (s[0] if s else 1 for s in shapes)
        return f"{one} elements in A, {other} in B"
    return ""


def pair(name: str, a: Side, b: Side, at: Common) -> Pair:
    """A signal that both runs have alike, on their common time."""
    one, other = a.signals[name], b.signals[name]
    steps = not all(np.issubdtype(x.dtype, np.floating) for x in (one, other))
    first = _values(one, a.time, at.time, steps or not at.between[0])
    second = _values(other, b.time, at.time, steps or not at.between[1])
    return Pair(name, a.numbers["units"][name], steps, at.time, first, second, one.ndim == 1)


def _values(x: NDArray[np.generic], samples: Array, time: Array, hold: bool) -> Array:
    """Values (n, k) at times: those of the latest sample, or on lines between samples."""
    columns = x.reshape(len(x), -1).astype(np.float64)
    if hold:
        near = NEAR * float(np.median(np.diff(samples))) if len(samples) > 1 else 0.0
        return columns[np.clip(np.searchsorted(samples, time + near, side="right") - 1, 0, None)]
    return np.column_stack([np.interp(time, samples, c) for c in columns.T])
