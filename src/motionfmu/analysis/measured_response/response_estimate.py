"""Frequency responses of a measured axis in a closed loop, with their errors.

The reference is the instrument: G = S(reference, output) / S(reference, input), which noise that
goes round the loop does not bias (Wellstead, Automatica 17 (1981) 217; Pintelon and Schoukens,
System Identification, 2nd ed., chapter 2).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.measured_response.period_of_signal import period_of, whole_periods
from motionfmu.base.errors import InputError

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
# A line counts as excited if the reference there is this share of its largest neighbours, within
# this factor of frequency.
_EXCITED, _NEIGHBOURS = 0.05, 1.3
# Share of the largest line that one has at least: of a reference, whose lines fall with frequency;
# of the input itself, whose lines a good excitation makes alike.
_OF_LARGEST, _OF_INPUT = 1e-6, 5e-3
# Relative deviation above which a line tells nothing, and how far a line stands above its noise, in
# standard deviations of its mean: of noise alone 1 in 10,000 does so by chance in 6 periods.
_VAGUE, _ABOVE = 0.3, 5.0
# Share of the sampling rate up to which lines are used.
_OF_RATE = 0.45
# A first period is left out while it differs from the later ones by so many times what they do.
_SETTLED = 3.0
# Correlation of two Hann windows of which half is common.
_ALIKE = 1.0 / 6.0
# Segments into which a record without periods is cut, with half of each overlapping: at least and
# at most, and the root of its samples over this.
_SEGMENTS, _ROOT = (8, 64), 8.0
# Effective averages of Hann windows that overlap by half (Welch 1967; Bendat and Piersol).
_OVERLAP = 0.95
# Coherence of reference and output below which a frequency without periods tells nothing.
_COHERENT = 0.5


@dataclass(frozen=True)
class LoopSignals:
    """What was recorded of a loop, at even instants.

    Parameters
    ----------
    reference : ndarray or None, shape (n,)
        What excites the loop from outside; None: nothing of it is known, as the mean of periods
        needs nothing of it.
    input, output : ndarray, shape (n,)
        Between which the response is wanted.
    interval : float
        [s] between two samples.
    name : str
        Of the record, for messages.
    """

    reference: Array | None
    input: Array
    output: Array
    interval: float
    name: str = "record"

    def __post_init__(self) -> None:
        """Refuse signals of unlike lengths."""
        sizes = {len(x) for x in (self.reference, self.input, self.output) if x is not None}
        if len(sizes) != 1:
            raise InputError(f"{self.name}: signals of {', '.join(map(str, sizes))} samples")


@dataclass(frozen=True)
class EstimateOptions:
    """How a response is estimated.

    Parameters
    ----------
    period : float, optional
        [s] of the excitation; found if not given. 0: there is none, windows are averaged.
    low, high : float, optional
        [Hz] of the band that is kept.
    """

    period: float | None = None
    low: float | None = None
    high: float | None = None


@dataclass(frozen=True)
class MeasuredResponse:
    """A measured frequency response and how sure it is.

    Attributes
    ----------
    omega : ndarray, shape (n,)
        [rad/s].
    values : ndarray of complex, shape (n,)
        Output per input.
    deviation : ndarray, shape (n,)
        Standard deviation of the complex value; NaN if nothing tells it.
    coherence : ndarray, shape (n,)
        Of output and reference, 0 to 1; NaN if nothing tells it.
    drift, level : float
        Mean rate of the output [its unit/s], and its mean; NaN if nothing tells them.
    swing, swing_rate : float
        RMS of what is excited of the output and of its rate; NaN likewise.
    way : str
        How it was estimated, in words.
    name : str
        Of the record or file.
    notes : tuple of str
        What a reader must know.
    loop : ndarray of complex or None, shape (n,)
        Input per reference.
    """

    omega: Array
    values: Complex
    deviation: Array
    coherence: Array
    way: str
    name: str
    notes: tuple[str, ...] = ()
    loop: Complex | None = None
    drift: float = math.nan
    level: float = math.nan
    swing: float = math.nan
    swing_rate: float = math.nan

    def kept(self, which: NDArray[np.bool_]) -> "MeasuredResponse":
        """The same with some frequencies only.

        Parameters
        ----------
        which : ndarray of bool, shape (n,)

        Returns
        -------
        MeasuredResponse
        """
        parts = {n: getattr(self, n)[which] for n in ("omega", "values", "deviation", "coherence")}
        return replace(self, **parts, loop=None if self.loop is None else self.loop[which])

    def scaled(self, factor: Complex | float) -> "MeasuredResponse":
        """The same times a factor for each frequency.

        Parameters
        ----------
        factor : ndarray of complex, shape (n,), or float

        Returns
        -------
        MeasuredResponse
        """
        return replace(self, values=self.values * factor, deviation=self.deviation * np.abs(factor))


def estimate(
    signals: LoopSignals, options: EstimateOptions = EstimateOptions()
) -> MeasuredResponse:
    """Estimate a frequency response from a record of a closed loop.

    Where the reference repeats, the transient is left out and the periods are averaged, whose
    differences give the deviation. Else windows are averaged, as chirps and noise need it.

    Parameters
    ----------
    signals : LoopSignals
    options : EstimateOptions

    Returns
    -------
    MeasuredResponse

    Raises
    ------
    InputError
        Nothing excites the loop, or the record has no such period.
    """
    source = signals.input if signals.reference is None else signals.reference
    for what, x in (("input", signals.input), ("output", signals.output)):
        if not np.ptp(x) > 0.0:
            raise InputError(f"{signals.name}: the {what} does not change")
    if not np.ptp(source) > 0.0:
        raise InputError(f"{signals.name}: the reference does not change: nothing excites the loop")
    period: int | None
    if options.period is None:
        period = period_of(source)
    elif options.period == 0.0:
        period = None
    else:
        samples = options.period / signals.interval
        period = round(samples)
        if abs(samples - period) > 1e-3 * max(1.0, 1e-2 * samples):
            raise InputError(
                f"{signals.name}: a period of {options.period:g} s is no whole number of samples of"
                f" {signals.interval:g} s; 0 averages windows instead"
            )
    found = _windows(signals) if period is None else _periods(signals, period)
    if signals.reference is None and period is None:  # else the mean of periods has no noise
        note = (
            "no reference and no periods: noise that goes round the loop biases the response"
            " towards that of the controller"
        )
        found = replace(found, notes=(note, *found.notes))
    hertz = found.omega / (2.0 * math.pi)
    keep = hertz >= (options.low or 0.0)
    keep &= hertz <= (options.high if options.high is not None else math.inf)
    found = found.kept(keep)
    if len(found.omega) < 3:
        raise InputError(
            f"{signals.name}: {len(found.omega)} frequencies of the band are excited above the"
            " noise, 3 at least wanted"
        )
    return found


def _drift(x: Array, period: int, count: int) -> float:
    """Rate of a straight drift over whole periods, per sample."""
    if count < 2:
        return 0.0
    each = x.reshape(count, period).mean(axis=1)
    return float(np.polyfit(np.arange(count) * period, each, 1)[0])


def _spectra(x: Array, period: int, count: int) -> Complex:
    """Spectra at the lines of a period, a row for each stretch of it.

    A stretch is two periods below a Hann window, half of which the next one shares. The window
    reaches one line of two periods to either side, and lines lie two apart, so none sees another;
    but what does not repeat, as an axis that drifts away, is not smeared over all of them.
    """
    if count < 3:
        level = x - _drift(x, period, count) * np.arange(len(x))
        return np.asarray(np.fft.rfft(level.reshape(count, period), axis=1))
    window = 0.5 - 0.5 * np.cos(np.pi * np.arange(2 * period) / period)
    rows = []
    time = np.arange(2 * period) - period + 0.5
    for k in range(count - 1):
        part = x[k * period : (k + 2) * period]
        part = part - part.mean()
        part = part - time * float(time @ part) / float(time @ time)
        rows.append(np.fft.rfft(part * window)[::2])
    return np.asarray(rows)


def _settled(signals: LoopSignals, source: Array, period: int) -> tuple[int, int, int]:
    """First sample, periods, and periods that the transient takes."""
    repeat = whole_periods(source, period, signals.name)
    first, count, lost = repeat.first, repeat.count, 0
    while count > 3:
        apart = []
        for x in (signals.input, signals.output):
            whole = x[first : first + count * period]
            rate = _drift(whole[period:], period, count - 1)
            level = (whole - rate * np.arange(len(whole))).reshape(count, period)
            level = level - level.mean(axis=1)[:, None]
            later = level[1:].mean(axis=0)
            size = np.sqrt(np.mean((level - later) ** 2, axis=1))
            apart.append(size[0] / max(float(np.median(size[1:])), 1e-12 * float(np.std(later))))
        if max(apart) <= _SETTLED:
            break
        first, count, lost = first + period, count - 1, lost + 1
    return first, count, lost


def _periods(signals: LoopSignals, period: int) -> MeasuredResponse:
    """The mean of all periods, and their scatter."""
    source = signals.input if signals.reference is None else signals.reference
    first, count, lost = _settled(signals, source, period)
    end = first + count * period
    r, u, y = (
        _spectra(x[first:end], period, count) for x in (source, signals.input, signals.output)
    )
    rate = _drift(signals.output[first:end], period, count)
    line = np.arange(1, int(_OF_RATE * period) + 1, dtype=np.int64)
    r, u, y = r[:, line], u[:, line], y[:, line]
    mean_r, mean_u, mean_y = (x.mean(axis=0) for x in (r, u, y))
    least = _OF_INPUT if signals.reference is None else _OF_LARGEST
    excited = _excited(np.abs(mean_r), line, least)
    with np.errstate(divide="ignore", invalid="ignore"):
        values = mean_y / mean_u
        # each period's error of the output beside what its input explains; the reference repeats
        rest = (y - mean_y) - values * (u - mean_u)
        error = _of_mean(rest) / np.abs(mean_u)
        scatter = np.sum(np.abs(y - mean_y) ** 2, axis=0) / max(len(y) - 1, 1)
        coherence = np.abs(mean_y) ** 2 / (np.abs(mean_y) ** 2 + scatter)
        loop = mean_u / mean_r
    if len(y) == 1:
        error, coherence = np.full(len(line), math.nan), np.full(len(line), math.nan)
    good = excited & np.isfinite(values) & ~(error > _VAGUE * np.abs(values))
    if len(y) > 1:
        excited &= np.abs(mean_r) > _ABOVE * _of_mean(r)
        good &= excited & (np.abs(mean_u) > _ABOVE * _of_mean(u))
        good &= np.abs(mean_y) > _ABOVE * _of_mean(y)
    seconds = period * signals.interval
    way = f"{count} periods of {seconds:.6g} s averaged"
    notes = [f"{lost} period{'s' * (lost != 1)} of transient left out"] if lost else []
    if len(y) == 1:
        notes.append("one period: nothing tells how sure the response is")
    dropped = int(np.sum(excited & ~good))
    if dropped:
        notes.append(f"{dropped} of {int(excited.sum())} excited lines are lost in noise")
    omega: Array = np.asarray(2.0 * math.pi * line / seconds, dtype=np.float64)
    mean_y = np.where(good, mean_y, 0.0)
    found = MeasuredResponse(
        omega,
        np.asarray(values),
        np.asarray(error),
        np.asarray(coherence),
        way,
        signals.name,
        tuple(notes),
        loop,
        drift=rate / signals.interval,
        level=float(np.mean(signals.output[first:end])),
        swing=float(np.sqrt(2.0 * np.sum(np.abs(mean_y) ** 2))) / period,
        swing_rate=float(np.sqrt(2.0 * np.sum((omega * np.abs(mean_y)) ** 2))) / period,
    )
    return found.kept(good)


def _of_mean(x: Complex) -> Array:
    """Standard deviation of the mean of some stretches' lines."""
    count = len(x)
    if count == 1:
        return np.full(x.shape[1], math.nan)
    scatter = np.sum(np.abs(x - x.mean(axis=0)) ** 2, axis=0)
    alike = 1.0 + 2.0 * (1.0 - 1.0 / count) * _ALIKE  # neighbours share half their samples
    return np.asarray(np.sqrt(alike * scatter / (count * (count - 1))))


def _excited(size: Array, line: NDArray[np.int64], least: float) -> NDArray[np.bool_]:
    """Lines at which the reference has something."""
    low = np.searchsorted(line, line / _NEIGHBOURS)
    high = np.searchsorted(line, line * _NEIGHBOURS, side="right")
    largest = np.array([size[a:b].max() for a, b in zip(low, high, strict=True)])
    floor = least * float(size.max(initial=0.0))
    return np.asarray((size > _EXCITED * largest) & (size > floor))


def _windows(signals: LoopSignals) -> MeasuredResponse:
    """Spectral densities averaged over windows, the reference as instrument."""
    from scipy.signal import csd

    source = signals.input if signals.reference is None else signals.reference
    segments = round(min(max(math.sqrt(len(source)) / _ROOT, _SEGMENTS[0]), _SEGMENTS[1]))
    size = 2 * len(source) // (segments + 1)
    if size < 16:
        raise InputError(f"{signals.name}: {len(source)} samples are too few")
    count = _OVERLAP * segments

    def density(a: Array, b: Array) -> Complex:
        _, found = csd(
            a, b, 1.0 / signals.interval, nperseg=size, noverlap=size // 2, detrend="linear"
        )
        return np.asarray(found[1:])

    hertz = np.fft.rfftfreq(size, signals.interval)[1:]
    u, y = signals.input, signals.output
    ru, ry, uy = density(source, u), density(source, y), density(u, y)
    rr, uu, yy = (np.real(density(x, x)) for x in (source, u, y))
    with np.errstate(divide="ignore", invalid="ignore"):
        values = ry / ru
        rest = yy - 2.0 * np.real(np.conj(values) * uy) + np.abs(values) ** 2 * uu
        error = np.sqrt(np.maximum(rest, 0.0) * rr / (count * np.abs(ru) ** 2))
        coherence = np.abs(ry) ** 2 / (rr * yy)
        loop = ru / rr
    good = (coherence > _COHERENT) & (hertz <= _OF_RATE / signals.interval)
    good &= np.isfinite(values) & ~(error > _VAGUE * np.abs(values))
    good &= hertz >= 2.0 / (size * signals.interval)  # a window's own width blurs what is below
    rate = float(np.polyfit(np.arange(len(y)) * signals.interval, y, 1)[0])
    band = np.where(good, np.abs(ry) ** 2 / rr, 0.0)  # output's power from the reference
    found = MeasuredResponse(
        np.asarray(2.0 * math.pi * hertz, dtype=np.float64),
        values,
        error,
        coherence,
        f"{segments} Hann windows of {size * signals.interval:.4g} s averaged",
        signals.name,
        (),
        loop,
        drift=rate,
        level=float(np.mean(y)),
        swing=float(np.sqrt(np.sum(band) * hertz[0])),
        swing_rate=float(np.sqrt(np.sum(band * (2.0 * math.pi * hertz) ** 2) * hertz[0])),
    )
    return found.kept(good)


def together(found: Sequence[MeasuredResponse]) -> MeasuredResponse:
    """The mean of responses of several records.

    It is taken at the frequencies that all have.

    Their scatter, which has what is not linear in it where their phases differ, is in the
    deviation.

    Parameters
    ----------
    found : sequence of MeasuredResponse

    Returns
    -------
    MeasuredResponse

    Raises
    ------
    InputError
        They have no three frequencies in common.
    """
    if len(found) == 1:
        return found[0]
    first = found[0]
    keys = [np.round(np.log(r.omega) * 1e6).astype(np.int64) for r in found]
    common = keys[0]
    for key in keys[1:]:
        common = common[np.isin(common, key)]
    if len(common) < 3:
        names = ", ".join(r.name for r in found)
        raise InputError(f"{names}: the records have {len(common)} frequencies in common")
    parts = [r.kept(np.isin(k, common)) for r, k in zip(found, keys, strict=True)]
    values = np.array([r.values for r in parts])
    count = len(parts)
    mean = values.mean(axis=0)
    scatter = np.sqrt(np.sum(np.abs(values - mean) ** 2, axis=0) / (count * (count - 1)))
    own = np.sqrt(np.sum(np.array([r.deviation for r in parts]) ** 2, axis=0)) / count
    deviation = np.fmax(scatter, own)
    notes = [f"{r.name}: {note}" for r in found for note in r.notes]
    ratio = np.sqrt(np.nanmean((scatter / np.abs(mean)) ** 2))
    expected = np.sqrt(np.nanmean((own / np.abs(mean)) ** 2))
    notes.append(
        f"the records differ by {100 * ratio:.2g} %, noise alone would by {100 * expected:.2g} %"
    )
    return replace(
        parts[0],
        values=mean,
        deviation=deviation,
        coherence=np.min([r.coherence for r in parts], axis=0),
        way=f"{count} records: {first.way}",
        name=", ".join(r.name for r in found),
        notes=tuple(notes),
        loop=None,
    )
