"""All samples of a curve, for a page that draws what is in view and measures it."""

import base64
import math
import zlib
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.columns import forget
from motionfmu.run.decimate import MOST, Read, at, few, reader

LEVEL = 3  # of zlib: a third of the time of its usual one, 3 % larger
# Real numbers are whole multiples of a step that is no more than this part of the curve's height.
COARSE = 1e-6
GAP = 1 << 31  # the number of steps, below 0, that stands for NaN
EVEN = 1e-9  # [s] times that are so near to even ones are kept as start and step


@dataclass(frozen=True)
class SampleSource:
    """A recording that is read block by block."""

    time: NDArray[Any]  # (n,) increases
    read: Read  # its values
    lines: Read | None = None


@dataclass(frozen=True)
class Samples:
    """A curve over time as it was recorded."""

    time: NDArray[Any]  # (n,) increases
    values: NDArray[Any]  # (n,) as shown; NaN is a gap
    steps: bool = False  # a value holds until the next one
    dots: bool = False  # single events, no line between them
    lines: NDArray[Any] | None = None  # (n,) lines of the program, which are shown beside the value
    all: bool = True  # none of the recorded samples are left out
    source: SampleSource | None = None  # all of a recording that is too long for a page

    @classmethod
    def made(
        cls,
        time: NDArray[Any],
        read: Read,
        steps: bool = False,
        lines: Read | None = None,
        most: int = MOST,
    ) -> "Samples":
        """The samples that a page holds of a curve that is made block by block."""
        kept = few(len(time), read, steps, most)
        if kept is None:
            every = 0, len(time)
            return cls(time, read(*every), steps, lines=None if lines is None else lines(*every))
        said = None if lines is None else at(lines, kept)
        source = SampleSource(time, read, lines)
        few_times = at(reader(time), kept)
        forget(time)
        return cls(few_times, at(read, kept), steps, lines=said, all=False, source=source)

    def few(self, most: int) -> "Samples":
        """The samples that a page holds: of more than so many the peaks."""
        if len(self.time) <= most:
            return self
        lines = None if self.lines is None else reader(self.lines)
        made = Samples.made(self.time, reader(self.values), self.steps, lines, most)
        return replace(made, dots=self.dots, source=self.source)


def bits(values: NDArray[Any]) -> dict[str, Any]:
    """Numbers as one short text: whole ones exact, real ones to `COARSE` of their height."""
    if (whole := _whole(values)) is not None:
        return _woven(whole, "i4")
    values = np.asarray(values, dtype=np.float64)
    real = values[np.isfinite(values)]
    height = float(np.ptp(real)) if len(real) else 0.0
    # A power of two, so that halves and quarters stay what they are.
    step = 2.0 ** math.floor(math.log2(COARSE * height)) if height > 0.0 else 0.0
    if np.isinf(values).any() or np.abs(real).max(initial=0.0) >= GAP * step:
        return _woven(values, "f8")
    count = np.where(np.isnan(values), -GAP, np.rint(values / step))
    return _woven(count.astype(np.int32), "i4") | {"step": step}


def clock(time: NDArray[Any]) -> dict[str, Any]:
    """Times as a start and steps, even ones without saying how many lie between two."""
    count = len(time)
    start = float(time[0]) if count else 0.0
    step = float(time[-1] - start) / (count - 1) if count > 1 else 0.0
    if count and np.abs(time - (start + step * np.arange(count))).max() < EVEN:
        return {"start": start, "step": step, "count": count}
    step = float(np.diff(time).min(initial=np.inf))
    steps = np.rint((time - start) / step) if 0.0 < step < np.inf else np.full(count, np.inf)
    if count and steps[-1] < GAP and np.abs(time - (start + step * steps)).max() < EVEN:
        return {"start": start, "step": step, "steps": _woven(steps.astype(np.int32), "i4")}
    return _woven(time, "f8")


def _woven(values: NDArray[Any], kind: str) -> dict[str, Any]:
    """Numbers of a kind, bit by bit."""
    # Differences of neighbours, of whole numbers with the sign last, are sorted by the place of
    # their bytes: those of a smooth curve have most bytes in common.
    word = np.dtype(f"<u{kind[1]}")
    raw = np.ascontiguousarray(values, dtype="<" + kind).view(word)
    change = np.diff(raw, prepend=word.type(0))
    if kind == "i4":
        sign = change.view(np.int32) >> 31
        change = (change << 1) ^ sign.view(np.uint32)
    woven = change.view(np.uint8).reshape(len(raw), word.itemsize).T
    packed = zlib.compress(np.ascontiguousarray(woven).tobytes(), LEVEL)
    return {"kind": kind, "count": len(raw), "bdata": base64.b64encode(packed).decode()}


def _whole(values: NDArray[Any]) -> NDArray[np.int32] | None:
    """The numbers as 32-bit whole ones, if they are; the least one of those means a gap."""
    if values.dtype.kind == "b":
        return values.astype(np.int32)
    if not len(values) or not np.isfinite(values).all():
        return None
    if values.min() < -GAP or values.max() >= GAP:
        return None
    if values.dtype.kind == "f" and not np.array_equal(values, np.rint(values)):
        return None
    return values.astype(np.int32)
