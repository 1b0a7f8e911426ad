"""A sampled loop with noise in it, whose plant and noise are known in closed form."""

import numpy as np
from scipy import signal

from motionfmu.analysis.measured_response import LoopSignals

STEP = 1e-3  # [s]
GAIN = 0.8  # of the law
COLOUR = 0.7  # of the noise: how much of it stays from sample to sample


def multisine(n, lines, rng):
    spectrum = np.zeros(n // 2 + 1, dtype=complex)
    spectrum[lines] = np.exp(2j * np.pi * rng.random(len(lines)))
    x = np.fft.irfft(spectrum, n)
    return x / x.std()


def loop_of(reference, noise, seed):
    """A sampled plant of one lag under a proportional law, with noise of its own: r, u, y."""
    rng = np.random.default_rng(seed)
    e = noise * signal.lfilter([1.0], [1.0, -COLOUR], rng.standard_normal(len(reference)))
    x, u, y = 0.0, np.zeros(len(reference)), np.zeros(len(reference))
    for k, r in enumerate(reference):
        y[k] = x + e[k]
        u[k] = GAIN * (r - y[k])
        x = 0.9 * x + 0.5 * u[k]
    return LoopSignals(reference, u, y, STEP, "loop")


def plant_of(omega):
    z = np.exp(1j * omega * STEP)
    return 0.5 / (z - 0.9)


def noise_of(omega, noise):
    """Spectral density of the noise where that of white noise of deviation 1 is 1."""
    return noise**2 / np.abs(1.0 - COLOUR * np.exp(-1j * omega * STEP)) ** 2


def direct_of(omega, noise):
    """S(input, output) / S(input, input) for a white reference of deviation 1."""
    e = noise_of(omega, noise)
    return (plant_of(omega) - e / GAIN) / (1.0 + e)
