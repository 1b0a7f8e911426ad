"""The pulses of a run followed along its path; runs with other gains have the same."""

from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from motionfmu.analysis.contour.arcs import Array
from motionfmu.analysis.contour.assign import assign
from motionfmu.analysis.contour.contour_result import ContourInput
from motionfmu.analysis.contour.path import Path
from motionfmu.analysis.contour.scaled_values import ScaledValues, blocks, places
from motionfmu.analysis.contour.segments import Index
from motionfmu.analysis.contour.track import Track, follow
from motionfmu.base.columns import room

FIFO_DEPTH = 63
# Commands on their way beside the FIFO stock: one in the DDA, a transaction of 16, one spare.
UNDER_WAY = 18
# [bytes] that are kept of earlier runs; what was not used for the longest time goes first.
ROOM, TEXTS = 64_000_000, 16_000_000


@dataclass(frozen=True, eq=False)
class PulsePath:
    """Positions on the path of the pulses put out."""

    track: Track
    moved: Index  # (n,) number of samples so far at which they moved the tool


def commanded(run: ContourInput, progress: Callable[[float], None]) -> PulsePath:
    """Follow the pulses along the path."""
    owners = assign(run.commanded, run.path, *_written(run), lambda share: progress(0.6 * share))
    return PulsePath(follow(run.commanded, run.path, owners), _moved(run.commanded))


class PulsePaths:
    """Paths and pulses of the last runs: runs that differ in gains only have them in common.

    Whoever has many runs analysed keeps one and hands it to `analyse`. What it holds is bounded;
    inputs are compared value by value.
    """

    def __init__(self) -> None:
        self._found: OrderedDict[int, tuple[_Inputs, PulsePath]] = OrderedDict()
        self._paths: OrderedDict[str, Path] = OrderedDict()
        self._count = 0

    def path(self, text: str, make: Callable[[str], Path]) -> Path:
        """The path of a text, made by `make` unless it is kept from before."""
        found = self._paths.get(text)
        if found is None:
            found = self._paths[text] = make(text)
        self._paths.move_to_end(text)
        while sum(map(len, self._paths)) > TEXTS:
            self._paths.popitem(last=False)
        return found

    def commanded(self, run: ContourInput, progress: Callable[[float], None]) -> PulsePath:
        """As the function `commanded`; runs with the same pulses share one result."""
        given = _Inputs.of(run)
        for key, (before, found) in self._found.items():
            if before.same(given):
                self._found.move_to_end(key)
                return found
        found = commanded(run, progress)
        if given.size + _size(found) <= ROOM:
            self._count += 1
            self._found[self._count] = given.copy(), found
            while sum(i.size + _size(c) for i, c in self._found.values()) > ROOM:
                self._found.popitem(last=False)
        return found


@dataclass(frozen=True, eq=False)
class _Inputs:
    """All inputs on which a `PulsePath` depends."""

    path: Path
    numbers: tuple[float, ...]
    arrays: tuple[Any, ...]

    @classmethod
    def of(cls, run: ContourInput) -> "_Inputs":
        pulses = run.commanded
        values, divisor = (
            (pulses.values, np.ravel(pulses.divisor).tolist())
            if isinstance(pulses, ScaledValues)
            else (pulses, [])
        )
        newest = run.command if run.newest is None else run.newest
        return cls(run.path, (_wait(run), *divisor), (values, run.command, newest, run.time))

    @property
    def size(self) -> int:
        """Size in memory [bytes]."""
        return sum(int(x.nbytes) for x in self.arrays)

    def copy(self) -> "_Inputs":
        """A copy in memory of its own."""
        return _Inputs(self.path, self.numbers, tuple(np.array(x) for x in self.arrays))

    def same(self, other: "_Inputs") -> bool:
        """Whether all inputs are equal."""
        pairs = list(zip(self.arrays, other.arrays, strict=True))
        return (
            self.path is other.path
            and self.numbers == other.numbers
            and all(a.shape == b.shape for a, b in pairs)
            and all(bool((a[own] == b[own]).all()) for a, b in pairs for own in blocks(len(a)))
        )


def _size(found: PulsePath) -> int:
    track = found.track
    arrays = (track.segment, track.along, track.distance, track.right, found.moved)
    return sum(0 if x is None else int(x.nbytes) for x in arrays)


def _wait(run: ContourInput) -> float:
    """Longest time of a command between host and motor [s]."""
    stock = run.stock
    if stock is None:
        return run.dda_time * (UNDER_WAY + FIFO_DEPTH)
    most = max(float(stock[own].max()) for own in blocks(len(stock), stock))
    return run.dda_time * (UNDER_WAY + most)


def _written(run: ContourInput) -> tuple[Index, Index]:
    """First and last segment on which the pulses may be, by what was written to the card (n,)."""
    path, wait, shifted = run.path, _wait(run), run.instants.shifted
    older = _segments(path, run.command)
    newer = older if run.newest is None else _segments(path, run.newest)
    for own in blocks(len(older), older, newer):
        np.maximum(newer[own], older[own], out=newer[own])
    return shifted(older, -wait), shifted(newer, wait)


def _segments(path: Path, command: Index) -> Index:
    """Segment of the newest command so far (n,)."""
    found = room(len(command), np.int32, command)
    newest = command[0]
    for own in blocks(len(command), command, found):
        upto = np.maximum.accumulate(np.maximum(command[own], newest))
        newest = upto[-1]
        found[own] = path.segment_of(upto)
    return found


def _moved(pulses: Array | ScaledValues) -> Index:
    found = room(len(pulses), np.int32, pulses)
    found[0] = count = 0
    for own in blocks(len(pulses) - 1, pulses, found):
        place = places(pulses, slice(own.start, own.stop + 1))
        upto = count + np.cumsum((place[1:] != place[:-1]).any(axis=1))
        found[own.start + 1 : own.stop + 1] = upto
        count = upto[-1]
    return found
