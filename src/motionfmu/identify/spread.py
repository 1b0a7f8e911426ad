"""Standard deviations of what Gauss-Newton found, for residuals that are not white.

Residuals of a model that is not quite right go on for many samples. The information matrix alone
would count each sample as news; Newey and West (1987) weigh the products of scores at all
distances up to a lag:  H^-1 (sum of w_l S_l) H^-1.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from motionfmu.identify.shooting import Fitted

Array = NDArray[np.float64]
# The lag up to which products count: so many times the time in which residuals forget themselves,
# and no more than this share of the record.
_TIMES, _MOST = 4.0, 0.1
# Eigenvalues below this share of the largest are none.
_NONE = 1e-13
# Information below this is none.
_SILENT = 1e-200
# Variance, in units of a scaled quantity, of a direction in which the record says nothing.
_NOTHING = 1e20


@dataclass(frozen=True)
class Spread:
    """How well free quantities are known."""

    deviations: Array  # (free,) standard deviations
    white: Array  # (free,) as they were for white residuals
    correlation: Array  # (free, free)
    condition: float  # of the information matrix, each quantity scaled to 1
    information: Array  # (free, free) inverse of the covariance, were residuals white
    lag: int  # samples up to which residuals count as one another's

    def widened(self, factor: float) -> "Spread":
        """The same with deviations so many times as large."""
        return replace(self, deviations=factor * self.deviations)


def spread(fitted: Fitted) -> Spread:
    """Standard deviations and correlations of the free quantities of a fit."""
    now, sizes, first = fitted.linear, fitted.sizes, fitted.first
    root = np.sqrt(fitted.weights)[:, None]
    slopes = now.slopes * (root / sizes)[:, :, None]
    rest = now.rest * (root / sizes)
    samples, outputs, every = slopes.shape
    free = every - first
    rows = slopes.reshape(-1, every)
    matrix = rows.T @ rows + np.diag(fitted.prior**2)
    # what the starts explain is no news of the free quantities
    inner = np.sqrt(np.maximum(np.diag(matrix)[:first], 1e-300))
    known = np.linalg.pinv(
        matrix[:first, :first] / np.outer(inner, inner), rcond=_NONE, hermitian=True
    )
    back = (known @ (matrix[:first, first:] / inner[:, None])) / inner[:, None]
    news = (rows[:, first:] - rows[:, :first] @ back).reshape(samples, outputs, free)
    reduced = matrix[first:, first:] - matrix[first:, :first] @ back
    told = np.diag(reduced)
    scale = np.sqrt(np.where(told > _SILENT, told, 1.0))
    s, v = np.linalg.eigh(reduced / np.outer(scale, scale))
    good = s > _NONE * max(s[-1], 1e-300)
    inverse = v * np.where(good, 1.0 / np.where(good, s, 1.0), _NOTHING) @ v.T
    news = news / scale
    scores = np.einsum("kij,ki->kj", news, rest)
    lag = _lag(rest)
    meat = _summed(scores, lag)
    loose = samples * outputs / max(samples * outputs - every, 1)
    cover = loose * inverse @ meat @ inverse
    plain = np.diag(inverse) * loose
    # a sum of few products may come out too small by chance, never below that of white residuals
    variances = np.maximum(np.diag(cover), plain)
    root = np.sqrt(np.maximum(np.diag(cover), 0.0))
    root = np.where(root > 0.0, root, np.inf)  # of what no residual tells of, nothing is known
    return Spread(
        deviations=np.sqrt(variances) / scale,
        white=np.sqrt(plain) / scale,
        correlation=cover / root / root[:, None],
        condition=float(s[-1] / s[0]) if s[0] > 0.0 else np.inf,
        information=reduced,
        lag=lag,
    )


def _summed(scores: Array, lag: int) -> Array:
    """Sum of products of scores at all distances, with Bartlett's weights (Fourier transform)."""
    n, free = scores.shape
    size = 1 << int(np.ceil(np.log2(n + lag + 1)))
    f = np.fft.rfft(scores, size, axis=0)
    found = np.zeros((free, free))
    for i in range(free):
        for j in range(i, free):
            c = np.fft.irfft(f[:, i] * np.conj(f[:, j]), size)
            weights = 1.0 - np.arange(1, lag + 1) / (lag + 1)
            total = c[0] + float(weights @ (c[1 : lag + 1] + c[-1 : -lag - 1 : -1]))
            found[i, j] = found[j, i] = total
    return found


def autocorrelation(values: Array, most: int) -> Array:
    """Autocorrelation of a signal at distances 0 to most, in samples."""
    centred = values - values.mean()
    size = 1 << int(np.ceil(np.log2(2 * len(values))))
    f = np.fft.rfft(centred, size)
    c = np.fft.irfft(f * np.conj(f), size)[: most + 1]
    return np.asarray(c / max(c[0], 1e-300))


def _lag(rest: Array) -> int:
    """Samples over which residuals are one another's: until the slowest has forgotten itself."""
    n = len(rest)
    most = max(1, int(_MOST * n))
    longest = 1
    for column in rest.T:
        c = autocorrelation(column, most)
        gone = np.flatnonzero(np.abs(c) < 2.0 / np.sqrt(n))
        longest = max(longest, int(gone[0]) if len(gone) else most)
    return int(min(most, max(_TIMES, longest)))
