"""Where a signal repeats itself: its period, and the samples that are whole periods."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError

Array = NDArray[np.float64]
# Parts of a record in which a period is looked for: a lead-in comes first, a run-out last.
_PARTS = ((0.4, 1.0), (0.25, 0.85), (0.1, 0.6))
# Share of a signal's variance that a repeat may differ by, and what a repeat is told from.
_SAME, _OTHER = 0.1, 0.25
# Deviation of a repeat, of the signal's own, beyond which a sample is no part of it; in noise more,
# of the usual deviation, and at most.
_AWAY, _USUAL, _MOST = 0.25, 1.5, 0.7
_SPANS = 16  # of a period, over which that is taken
_FEWEST = 16  # samples of a period


@dataclass(frozen=True)
class WholePeriods:
    """The samples of a record that repeat."""

    first: int  # sample
    period: int  # samples
    count: int  # of periods


def period_of(signal: Array) -> int | None:
    """Samples after which a signal repeats, but for a straight drift; None if it does not."""
    for begin, end in _PARTS:
        part = signal[int(begin * len(signal)) : int(end * len(signal))]
        found = _shortest(part)
        if found is not None:
            return found
    return None


def _shortest(part: Array) -> int | None:
    """The least lag at which a part is itself again."""
    n = len(part)
    if n < 2 * _FEWEST:
        return None
    line = np.polyfit(np.arange(n), part, 1)
    x = part - np.polyval(line, np.arange(n))
    power = float(np.mean(x * x))
    if power <= 1e-24 * float(np.mean(part * part)) or power == 0.0:
        return None
    most = n // 2
    spectrum = np.fft.rfft(x, 2 * n)
    product = np.fft.irfft(np.abs(spectrum) ** 2)[: most + 1]
    square = np.concatenate([[0.0], np.cumsum(x * x)])
    lag = np.arange(most + 1)
    both = square[n - lag] + (square[n] - square[lag])
    apart = (both - 2.0 * product) / (n - lag) / (2.0 * power)
    left = np.flatnonzero(apart > _OTHER)
    if not len(left):
        return None
    begin = max(int(left[0]), _FEWEST)
    inner = apart[begin : most + 1]
    least = float(inner.min(initial=np.inf))
    if least > _SAME:
        return None
    near = begin + np.flatnonzero(inner <= max(4.0 * least, 1e-9))
    stop = int(np.flatnonzero(np.diff(near) > 1)[0]) + 1 if (np.diff(near) > 1).any() else len(near)
    return int(near[:stop][np.argmin(apart[near[:stop]])])


def whole_periods(signal: Array, period: int, name: str) -> WholePeriods:
    """The longest stretch in which a signal has this period, in whole ones of it."""
    if not _FEWEST <= period <= len(signal) // 2:
        raise InputError(
            f"{name}: a period of {period} samples: {_FEWEST} to {len(signal) // 2} wanted, so that"
            " the record has two"
        )
    step = signal[period:] - signal[:-period]
    drift = float(np.median(step))
    middle = signal[len(signal) // 4 : 3 * len(signal) // 4]
    line = np.polyfit(np.arange(len(middle)), middle, 1)
    size = float(np.std(middle - np.polyval(line, np.arange(len(middle)))))
    wide = max(1, period // _SPANS)  # noise of a sample is no deviation
    around = np.pad((step - drift) ** 2, (wide // 2, wide - 1 - wide // 2), "edge")
    mean = np.convolve(around, np.full(wide, 1.0 / wide), "valid")
    usual = float(np.median(np.sqrt(mean)))
    good = np.sqrt(mean) <= max(_AWAY * size, min(_USUAL * usual, _MOST * size))
    edges = np.flatnonzero(np.diff(np.concatenate([[False], good, [False]]).astype(int)))
    runs = edges.reshape(-1, 2)
    lengths = runs[:, 1] - runs[:, 0] if len(runs) else np.zeros(0, int)
    if not len(runs) or lengths.max() < period:
        raise InputError(f"{name}: it does not repeat after {period} samples")
    first, last = runs[int(np.argmax(lengths))]
    # the end counts: what comes late has least of the transient
    count = int((last + period - first) // period)
    return WholePeriods(int(last + period - count * period), period, count)
