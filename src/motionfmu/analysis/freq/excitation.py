"""Periodic signals that excite many frequencies at once."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
# Feedback taps of maximum-length shift registers, by length; Golomb, Shift Register Sequences.
_TAPS = {5: 3, 6: 5, 7: 6, 9: 5, 10: 7, 11: 9, 15: 14}


@dataclass(frozen=True)
class Excitation:
    """One period of a signal and how often it is repeated.

    Attributes
    ----------
    signal : ndarray, shape (n,)
        One period, a value per sample, in the unit of the input.
    lines : ndarray of int
        Whole cycles per period that it excites.
    settle, measure : int
        Periods before the measurement, and in it.
    """

    signal: Array
    lines: NDArray[np.int64]
    settle: int = 2
    measure: int = 2


def multisine(
    n: int, lines: NDArray[np.int64], peak: float, settle: int = 2, measure: int = 2
) -> Excitation:
    """Sum of equal sines with a small crest factor.

    Schroeder's phases, -pi k (k - 1)/K: IEEE Trans. Inf. Theory 16 (1970) 85.

    Parameters
    ----------
    n : int
        Samples per period.
    lines : ndarray of int
        Cycles per period, above 0 and not above n/2.
    peak : float
        Largest magnitude, in the unit of the input.
    settle, measure : int
        Periods before the measurement, and in it.

    Returns
    -------
    Excitation

    Raises
    ------
    ValueError
        A line is outside the range.
    """
    chosen = np.asarray(lines, dtype=np.int64)
    if not chosen.size or chosen.min() < 1 or chosen.max() > n // 2:
        raise ValueError(f"lines of a period of {n} samples are 1 to {n // 2}")
    size = np.ones(chosen.size)
    return replace(shaped(n, chosen, [(peak, size)]), settle=settle, measure=measure)


def shaped(n: int, lines: NDArray[np.int64], caps: list[tuple[float, NDArray[Any]]]) -> Excitation:
    """Sum of sines, each as large as what it may move allows.

    Schroeder's phases for shares p of the power, -2 pi sum (k - l) p_l over l < k. A cap is the
    largest magnitude of something that moves with the signal, and its response at the lines; all
    caps are kept once the start has died away, and one is met.
    """
    worth = np.max([np.abs(of) / max(cap, 1e-300) for cap, of in caps], axis=0)
    size = 1.0 / np.maximum(worth, 1e-12 * worth.max())
    share = size * size / np.sum(size * size)
    later = np.concatenate([[0.0], np.cumsum(np.cumsum(share))[:-1]])
    sines = size * np.exp(-2j * np.pi * later)

    def signal(values: NDArray[Any]) -> Array:
        spectrum = np.zeros(n // 2 + 1, dtype=complex)
        spectrum[lines] = values
        found: Array = np.fft.irfft(spectrum, n)
        return found

    factor = min(cap / np.abs(signal(sines * of)).max() for cap, of in caps)
    return Excitation(factor * signal(sines), lines)


def prbs(order: int, peak: float, hold: int = 1, settle: int = 2, measure: int = 2) -> Excitation:
    """Pseudo-random binary sequence of maximum length.

    Parameters
    ----------
    order : int
        Bits of the shift register: 5, 6, 7, 9, 10, 11 or 15.
    peak : float
        The value is +peak or -peak.
    hold : int
        Samples per bit; what lies above 0.4/hold of the sampling rate is not used.
    settle, measure : int
        Periods before the measurement, and in it.

    Returns
    -------
    Excitation
        (2^order - 1) hold samples.

    Raises
    ------
    ValueError
        The order is not in the list.
    """
    if order not in _TAPS:
        raise ValueError(f"order = {order}: one of {', '.join(map(str, _TAPS))} wanted")
    register, bits = [1] * order, []
    for _ in range(2**order - 1):
        bits.append(register[-1])
        register = [register[-1] ^ register[_TAPS[order] - 1], *register[:-1]]
    signal = np.repeat(peak * (2.0 * np.array(bits) - 1.0), hold)
    top = len(signal) // 2 if hold == 1 else int(0.4 * len(signal) / hold)
    return Excitation(signal, np.arange(1, top + 1), settle, measure)


def sine(n: int, line: int, peak: float, settle: int = 2, measure: int = 2) -> Excitation:
    """One sine: the classic sweep takes one after the other.

    Parameters
    ----------
    n : int
        Samples per period of the signal, which has `line` cycles.
    line : int
    peak : float
        In the unit of the input.
    settle, measure : int
        Periods before the measurement, and in it.

    Returns
    -------
    Excitation

    Raises
    ------
    ValueError
        The line is outside 1 to n/2.
    """
    return multisine(n, np.array([line]), peak, settle, measure)
