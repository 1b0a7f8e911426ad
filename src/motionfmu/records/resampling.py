"""Values between the samples of a signal, and how far off they may be."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError

LINEAR, HOLD = WAYS = ("linear", "hold")
# A value within this part of a signal's range of another is the same when errors are told.
Array = NDArray[Any]


@dataclass(frozen=True)
class ResamplingError:
    """How far values at new instants may be off [the signal's unit].

    Attributes
    ----------
    between : float
        Largest error of values between two samples, as far as the samples tell. Of a straight line
        it is h^2/8 times the second derivative, which is the second difference of the samples. Of a
        value that is held it is the step to the next sample. 0 if every new instant is a sample.
    lost : float
        Largest distance of a sample from the curve through the new ones: what a coarser grid does
        not show.
    """

    between: float
    lost: float


def check(how: str) -> None:
    """Refuse what is no way of resampling."""
    if how not in WAYS:
        raise InputError(f"resample = {how!r}: {' or '.join(WAYS)} wanted")


def at(ns: Array, values: Array, wanted: Array, how: str = LINEAR) -> Array:
    """Values (m, ...) at times [ns] within the samples; a sample's own value at its own time.

    Whole numbers and Booleans are held in any case.
    """
    place = np.searchsorted(ns, wanted, side="right") - 1
    place = np.clip(place, 0, len(ns) - 1)
    found = np.asarray(values)[place]
    if how == HOLD or not np.issubdtype(found.dtype, np.floating):
        return found
    between = (ns[place] != wanted) & (place + 1 < len(ns))
    if between.any():
        low = place[between]
        share = (wanted[between] - ns[low]) / (ns[low + 1] - ns[low])
        share = share.reshape(-1, *(1,) * (found.ndim - 1))
        first = np.asarray(values)[low]
        found[between] = first + share * (np.asarray(values)[low + 1] - first)
    return found


def error(ns: Array, values: Array, wanted: Array, how: str = LINEAR) -> ResamplingError:
    """How far off the values of `at` may be."""
    data = np.asarray(values).reshape(len(ns), -1).astype(np.float64)
    place = np.clip(np.searchsorted(ns, wanted, side="right") - 1, 0, len(ns) - 1)
    off = np.unique(place[(ns[place] != wanted) & (place + 1 < len(ns))])
    held = how == HOLD or not np.issubdtype(np.asarray(values).dtype, np.floating)
    between = _of_hold(data, off) if held else _of_line(ns, data, off)
    inside = (ns >= wanted[0]) & (ns <= wanted[-1]) if len(wanted) else np.zeros(len(ns), bool)
    lost = 0.0
    if inside.any():
        new = at(ns, data, wanted, HOLD if held else LINEAR)
        back = at(wanted, new, ns[inside], HOLD if held else LINEAR)
        lost = _largest(np.abs(back - data[inside]))
    return ResamplingError(between, lost)


def _largest(found: Array) -> float:
    good = found[np.isfinite(found)]
    return float(good.max()) if len(good) else 0.0


def _of_hold(data: Array, off: Array) -> float:
    """The largest step behind a sample whose value is held."""
    return _largest(np.abs(data[off + 1] - data[off])) if len(off) else 0.0


def _of_line(ns: Array, data: Array, off: Array) -> float:
    """The largest h^2/8 |x''| of the intervals in which values are wanted."""
    if not len(off) or len(ns) < 3:
        return 0.0
    step = np.diff(ns).astype(np.float64)
    slope = np.diff(data, axis=0) / step[:, None]
    bend = np.abs(2.0 * np.diff(slope, axis=0) / (step[1:] + step[:-1])[:, None])
    bend = np.concatenate([bend[:1], bend, bend[-1:]])  # at each sample; at the ends the next one
    worst = np.fmax(bend[off], bend[off + 1])
    return _largest(worst * (step[off] ** 2 / 8.0)[:, None])
