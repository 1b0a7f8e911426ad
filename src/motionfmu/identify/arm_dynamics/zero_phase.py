"""Low pass and derivatives without delay, by the Fourier transform.

The gain is that of a Butterworth filter of fourth order forwards and backwards, 1/(1 + (f/fc)^8),
whatever the rate, so that signals of two rates are filtered alike. Both ends are continued by
their mirror images about the end points.
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
# Periods of the corner frequency by which a signal is continued; what the ends may be wrong by.
_PERIODS = 6.0
ENDS = 2.0
# Share of the power of speeds that counts as motion.
_POWER = 0.99


def low_pass(values: Array, rate: float, corner: float, derivative: int = 0) -> Array:
    """Filter columns (n, ...) sampled at `rate` [Hz]; a derivative per second if wanted."""
    n = len(values)
    more = min(n - 1, int(np.ceil(_PERIODS * rate / corner)))
    before = 2.0 * values[0] - values[more:0:-1]
    behind = 2.0 * values[-1] - values[-2 : -more - 2 : -1]
    long = np.concatenate([before, values, behind])
    line = np.linspace(0.0, 1.0, len(long)).reshape(-1, *([1] * (values.ndim - 1)))
    slope = long[-1] - long[0]
    whole = np.fft.rfft(long - long[0] - line * slope, axis=0)
    f = np.fft.rfftfreq(len(long), 1.0 / rate)
    gain = (2j * np.pi * f) ** derivative / (1.0 + (f / corner) ** 8)
    found = np.fft.irfft(whole * gain.reshape(-1, *([1] * (values.ndim - 1))), len(long), axis=0)
    if derivative == 0:
        found = found + long[0] + line * slope
    elif derivative == 1:
        found = found + slope * (rate / (len(long) - 1))
    return np.asarray(found[more : more + n])


def fastest(angles: Array, rate: float) -> float:
    """The frequency below which the speeds of all joints have their power [Hz]."""
    speeds = np.diff(angles, axis=0)
    window = np.hanning(len(speeds))[:, None]
    power = np.abs(np.fft.rfft((speeds - speeds.mean(axis=0)) * window, axis=0)) ** 2
    total = np.cumsum(power, axis=0)
    f = np.fft.rfftfreq(len(speeds), 1.0 / rate)
    moves = total[-1] > 1e-6 * total[-1].max()
    return float(max(f[np.argmax(c >= _POWER * c[-1])] for c in total.T[moves]))
