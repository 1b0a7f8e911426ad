"""All samples of a curve, for a page that draws what is in view and measures it."""

import base64
import zlib
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.run.decimate import MOST, Read, at, few, reader

LEVEL = 1  # of zlib: takes a quarter of the time of its usual level, for a tenth more bytes
# Real numbers get 32 bits if that moves none by more than this part of the curve's height.
COARSE = 1e-6
EVEN = 1e-9  # [s] times that are so near to even ones are kept as start and step


@dataclass(frozen=True)
class Samples:
    """A curve over time as it was recorded."""

    time: NDArray[Any]  # (n,) increases
    values: NDArray[Any]  # (n,) as shown; NaN is a gap
    steps: bool = False  # a value holds until the next one
    dots: bool = False  # single events, no line between them
    lines: NDArray[Any] | None = None  # (n,) lines of the program, which are shown beside the value
    all: bool = True  # none of the recorded samples are left out

    @classmethod
    def made(
        cls, time: NDArray[Any], read: Read, steps: bool = False, lines: Read | None = None
    ) -> "Samples":
        """The samples that a page holds of a curve that is made block by block."""
        kept = few(len(time), read, steps)
        if kept is None:
            every = 0, len(time)
            return cls(time, read(*every), steps, lines=None if lines is None else lines(*every))
        said = None if lines is None else at(lines, kept)
        return cls(time[kept], at(read, kept), steps, lines=said, all=False)

    def few(self) -> "Samples":
        """The samples that a page holds: of very many the peaks."""
        if len(self.time) <= MOST:
            return self
        lines = None if self.lines is None else reader(self.lines)
        made = Samples.made(self.time, reader(self.values), self.steps, lines)
        return replace(made, dots=self.dots)


def bits(values: NDArray[Any]) -> dict[str, Any]:
    """Numbers as one short text: whole ones exact, real ones to 7 digits of the height."""
    # Differences of the bits are sorted by the place of their bytes, because neighbours of a smooth
    # curve have most bytes in common.
    kind = _kind(values)
    word = np.dtype(f"<u{kind[1]}")
    raw = np.ascontiguousarray(values, dtype="<" + kind).view(word)
    change = np.diff(raw, prepend=word.type(0))
    woven = change.view(np.uint8).reshape(len(raw), word.itemsize).T
    packed = zlib.compress(np.ascontiguousarray(woven).tobytes(), LEVEL)
    return {"kind": kind, "count": len(raw), "bdata": base64.b64encode(packed).decode()}


def clock(time: NDArray[Any]) -> dict[str, Any]:
    """Times, even ones as start and step."""
    count = len(time)
    step = float(time[-1] - time[0]) / (count - 1) if count > 1 else 0.0
    if count and np.abs(time - (time[0] + step * np.arange(count))).max() < EVEN:
        return {"start": float(time[0]), "step": step, "count": count}
    return bits(np.asarray(time, dtype=np.float64))


def _kind(values: NDArray[Any]) -> str:
    if values.dtype.kind in "biu" and values.dtype.itemsize <= np.dtype("i4").itemsize:
        return "i4" if values.dtype != np.uint32 else "f8"
    real = values[np.isfinite(values)]
    if not len(real):
        return "f4"
    ends = float(real.min()), float(real.max())
    top = np.iinfo(np.int32).max
    whole = len(real) == len(values) and -top <= ends[0] and ends[1] <= top
    if whole and np.array_equal(real, np.rint(real)):
        return "i4"
    near = np.abs(real - real.astype(np.float32)).max() <= COARSE * (ends[1] - ends[0])
    return "f4" if near else "f8"
