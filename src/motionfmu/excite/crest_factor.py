"""Phases of a multisine with which what it moves has low peaks.

The p-norm of all signals is made small for p = 4, 8, 16, ..., each from the phases of the one
before (Guillaume, Schoukens, Pintelon, Kollar, IEEE Trans. Instrum. Meas. 40 (1991) 982), from
Schroeder's phases on.
"""

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
_POWERS = (4, 8, 16, 32, 64)
_STEPS = 80  # of a search with one power
_FINE = 8  # samples in the shortest period of the multisine


def crest(signal: Array) -> float:
    """Peak over RMS of a signal without its mean."""
    level = signal - signal.mean()
    return float(np.abs(level).max() / np.sqrt(np.mean(level**2)))


def waves(sines: Complex, lines: NDArray[np.int64], n: int) -> Array:
    """One period of sums of sines, (..., n): the real part of sine k is amplitude and phase."""
    spectrum = np.zeros((*sines.shape[:-1], n // 2 + 1), dtype=complex)
    spectrum[..., lines] = 0.5 * n * sines
    return np.asarray(np.fft.irfft(spectrum, n, axis=-1))


def schroeder(size: Array) -> Array:
    """Schroeder's phases for amplitudes: -2 pi sum (k - l) p_l over l < k, p shares of power."""
    share = size**2 / np.sum(size**2)
    return np.asarray(-2.0 * math.pi * np.concatenate([[0.0], np.cumsum(np.cumsum(share))[:-1]]))


def low_peaks(sines: Complex, lines: NDArray[np.int64]) -> Array:
    """Phases to be added so that the largest of some signals has a low peak.

    `sines` are complex amplitudes of each signal over what it may reach at most, (signals, lines).
    """
    from scipy.optimize import minimize

    n = 2 ** math.ceil(math.log2(_FINE * int(lines.max()) + 1))
    best = phases = schroeder(np.abs(sines).max(axis=0))
    lowest = _peak(sines, lines, phases, n)

    def norm(x: Array, power: int, scale: float) -> tuple[float, Array]:
        turned = sines * np.exp(1j * x)
        t = waves(turned, lines, n) / scale
        sum_ = float(np.mean(np.abs(t) ** power))
        value = sum_ ** (1.0 / power)
        w = np.abs(t) ** (power - 1) * np.sign(t)
        back = np.fft.rfft(w, axis=-1)[..., lines]
        slope = np.real(1j * turned * np.conj(back)).sum(axis=0) / scale / t.size
        return value, value ** (1 - power) * slope

    for power in _POWERS:
        scale = _peak(sines, lines, phases, n)
        found = minimize(
            norm,
            phases,
            args=(power, scale),
            jac=True,
            method="L-BFGS-B",
            options={"maxiter": _STEPS},
        )
        phases = np.asarray(found.x)
        peak = _peak(sines, lines, phases, n)
        if peak < lowest:
            best, lowest = phases, peak
    return best


def _peak(sines: Complex, lines: NDArray[np.int64], phases: Array, n: int) -> float:
    return float(np.abs(waves(sines * np.exp(1j * phases), lines, n)).max())
