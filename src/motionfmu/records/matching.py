"""A signal of a run beside a column of a record: difference, and the lag between them."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError
from motionfmu.records.resampling import HOLD, LINEAR, at

Array = NDArray[Any]
# Largest lag that is looked for, of the common time: at least three quarters overlap.
LAG_PART = 0.25
# Two curves that are as alike at every lag as at the best one, but for so much of the correlation
# coefficient, tell no lag: a straight line that comes later is one that lies lower.
FLAT = 1e-3
# The correlation of two samples in a row differs by more than this if rounding does not make it.
ROUNDED = 1e-13
SAMPLES_MIN = 8


@dataclass(frozen=True)
class Lag:
    """How much later one signal comes than another.

    Attributes
    ----------
    seconds : float
        Of the largest correlation, between samples by a parabola; NaN if there is none.
    correlation : float
        The coefficient there.
    reason : str
        Why there is no lag; else empty.
    """

    seconds: float
    correlation: float
    reason: str = ""


@dataclass(frozen=True)
class Match:
    """A signal and a record's column on their common time.

    Attributes
    ----------
    ns : ndarray, shape (n,)
        Common times [ns].
    signal, record : ndarray, shape (n,)
        In one unit.
    lag : Lag
        Of the signal behind the record; it is shown, and in no other number taken out.
    """

    ns: Array
    signal: Array
    record: Array
    lag: Lag

    @property
    def time(self) -> Array:
        """Common times [s]."""
        return np.asarray(self.ns / 1e9)

    @property
    def difference(self) -> Array:
        """The signal less the record."""
        return np.asarray(self.signal - self.record)

    def numbers(self) -> dict[str, float | int | None]:
        """Its numbers; None is no number.

        max, rms and mean of the difference are in the signal's unit, at and lag in s. ``nrmse`` is
        the norm of the difference over that of the record, ``nrmse_centred`` over that of the
        record less its mean, which an offset does not make small.
        """
        off = self.difference
        worst = int(np.argmax(np.abs(off)))
        size, mean = float(np.linalg.norm(off)), float(self.record.mean())
        whole, centred = (float(np.linalg.norm(self.record - m)) for m in (0.0, mean))
        found = {
            "samples": len(off),
            "max": float(off[worst]),
            "at": float(self.time[worst]),
            "rms": size / math.sqrt(len(off)),
            "mean": float(off.mean()),
            "nrmse": size / whole if whole else math.nan,
            "nrmse_centred": size / centred if centred else math.nan,
            "lag": self.lag.seconds,
            "correlation": self.lag.correlation,
        }
        return {k: v if math.isfinite(v) else None for k, v in found.items()}


def match(signal: tuple[Array, Array], record: tuple[Array, Array], hold: bool = False) -> Match:
    """Lay a signal over a record, in the time that both cover.

    Both are taken at the samples of the coarser one.

    Parameters
    ----------
    signal, record : tuple of ndarray
        Times [ns], shape (n,), and values (n,), in one unit. What is not a number is left out.
    hold : bool
        Values between samples are those of the sample before, not on straight lines.

    Raises
    ------
    InputError
        They have less than two samples in common.
    """
    (one, x), (other, y) = (_known(*pair) for pair in (signal, record))
    if len(one) < 2 or len(other) < 2:
        raise InputError("less than two samples are numbers")
    low, high = max(one[0], other[0]), min(one[-1], other[-1])
    coarse = one if np.median(np.diff(one)) > np.median(np.diff(other)) else other
    ns = coarse[(coarse >= low) & (coarse <= high)]
    if len(ns) < 2:
        spans = (f"{a[0] / 1e9:.9g} .. {a[-1] / 1e9:.9g} s" for a in (one, other))
        raise InputError(f"the run ({next(spans)}) and the record ({next(spans)}) do not overlap")
    how = HOLD if hold else LINEAR
    a, b = at(one, x, ns, how), at(other, y, ns, how)
    return Match(ns, a, b, lag_of(ns, a, b))


def _known(ns: Array, values: Array) -> tuple[Array, Array]:
    data = np.asarray(values, dtype=np.float64)
    good = np.isfinite(data)
    return (ns, data) if good.all() else (np.asarray(ns)[good], data[good])


def lag_of(ns: Array, signal: Array, record: Array, part: float = LAG_PART) -> Lag:
    """Find how much later a signal comes than a record.

    Parameters
    ----------
    ns : ndarray, shape (n,)
        Common times [ns]; uneven ones are made even at their median.
    signal, record : ndarray, shape (n,)
    part : float
        Largest lag that is looked for, of the whole time.

    Notes
    -----
    For every lag k the correlation coefficient of the parts that overlap, signal[k:] and
    record[:n - k], is found, so neither offset nor scale nor the shrinking overlap moves its peak.
    """
    step = float(np.median(np.diff(ns)))
    x, y = np.asarray(signal, dtype=np.float64), np.asarray(record, dtype=np.float64)
    if np.ptp(np.diff(ns)) > 0:
        even = np.round(np.arange(ns[0], ns[-1] + 0.5 * step, step)).astype(np.int64)
        even = even[even <= ns[-1]]
        x, y = at(ns, x, even), at(ns, y, even)
    n = len(x)
    reach = int(part * n)
    if n < SAMPLES_MIN or reach < 2:
        return Lag(math.nan, math.nan, f"{n} samples are too few")
    if np.ptp(x) == 0.0 or np.ptp(y) == 0.0:
        return Lag(math.nan, math.nan, "nothing moves")
    found = correlation(x, y, reach)
    best = int(np.argmax(found))
    top = float(found[best])
    if top - float(found.min()) < FLAT:
        return Lag(math.nan, top, "as alike at every lag: a straight line tells none")
    if best in (0, len(found) - 1):
        return Lag(math.nan, top, f"more than {reach * step * 1e-6:.6g} ms, or none")
    before, after = float(found[best - 1]), float(found[best + 1])
    bend = before - 2.0 * top + after
    shift = 0.5 * (before - after) / bend if bend < -ROUNDED else 0.0
    return Lag((best - reach + shift) * step * 1e-9, top)


def correlation(x: Array, y: Array, reach: int) -> Array:
    """Coefficients (2 reach + 1,) of x[k:] with y[:n - k], for lags k from -reach to reach."""
    n = len(x)
    x, y = x - x.mean(), y - y.mean()
    x, y = x / np.abs(x).max(), y / np.abs(y).max()
    size = 1 << (2 * n - 1).bit_length()
    both = np.fft.irfft(np.fft.rfft(x, size) * np.conj(np.fft.rfft(y, size)), size)
    lags = np.arange(-reach, reach + 1)
    product = both[lags]  # a negative lag counts from the end
    count = n - np.abs(lags)

    def sums(values: Array, late: Array) -> Array:
        """Sums of the part that overlaps at each lag: from `late` on, as long as the overlap."""
        upto = np.concatenate([[0.0], np.cumsum(values)])
        return np.asarray(upto[late + count] - upto[late])

    after, before = np.maximum(lags, 0), np.maximum(-lags, 0)
    sx, sy = sums(x, after), sums(y, before)
    wx, wy = sums(x * x, after) - sx * sx / count, sums(y * y, before) - sy * sy / count
    power = np.sqrt(np.maximum(wx, 0.0) * np.maximum(wy, 0.0))
    moves = power > ROUNDED * n
    return np.where(moves, (product - sx * sy / count) / np.where(moves, power, 1.0), 0.0)
