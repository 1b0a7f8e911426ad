"""Parts of a positioning error that are known, found in made records."""

import numpy as np
import pytest

from motionfmu.analysis.positioning import PositioningTest
from motionfmu.calibrate import lead_error

BACKLASH, SLOPE, SIZE, PERIOD, PHASE, OFFSET = 15e-3, 45e-6, 6e-3, 130.0, 0.7, 2e-3
TRUTH = {
    "backlash": BACKLASH,
    "slope": SLOPE,
    "amplitude": SIZE,
    "period": PERIOD,
    "phase": PHASE,
    "offset": OFFSET,
}


def targets(count: int = 15, even: bool = False) -> np.ndarray:
    """Over 400 mm, moved out of an even row as ISO 230-2 asks."""
    x = np.linspace(-200.0, 200.0, count)
    if not even:
        x[1:-1] += 9.0 * np.sin(7.3 * np.arange(1, count - 1))
    return x


def made(x: np.ndarray, noise: float, seed: int = 0, size: float = SIZE) -> PositioningTest:
    """Five approaches; noise of the targets, and of each approach."""
    rng = np.random.default_rng(seed)
    mean = OFFSET + SLOPE * x + size * np.sin(2 * np.pi * x / PERIOD + PHASE)
    mean = mean + noise * rng.normal(size=len(x))
    own = noise * rng.normal(size=(2, 5, len(x)))
    return PositioningTest(x, mean - BACKLASH / 2 + own[0], mean + BACKLASH / 2 + own[1])


def test_what_is_exact_is_found_to_the_last_digits() -> None:
    found = lead_error(made(targets(), 0.0))
    for name, value in TRUTH.items():
        assert getattr(found, name).value == pytest.approx(value, rel=1e-5), name
    assert found.rest < 1e-6


def test_deviations_are_those_of_many_records() -> None:
    away = []
    for seed in range(60):
        found = lead_error(made(targets(), 5e-4, seed))
        assert found.amplitude.told
        away.append(
            [(getattr(found, n).value - v) / getattr(found, n).deviation for n, v in TRUTH.items()]
        )
    # each is Student's t of at least ten degrees of freedom: its RMS is 1.12
    rms = np.sqrt(np.mean(np.square(away), axis=0))
    assert (rms > 0.75).all() and (rms < 1.5).all(), dict(zip(TRUTH, rms, strict=True))


def test_no_wave_is_seen_in_noise() -> None:
    seen = [lead_error(made(targets(), 1e-3, k, size=0.0)).amplitude.told for k in range(40)]
    assert sum(seen) <= 3
    found = lead_error(made(targets(), 1e-3, 0, size=0.0))
    assert "none stands out" in found.amplitude.why
    assert abs(found.slope.value - SLOPE) < 4.0 * found.slope.deviation


def test_two_periods_that_targets_cannot_tell_apart_are_both_named() -> None:
    # at targets on multiples of 20 mm, all but one, waves of 1/70 and 1/20 -+ 1/70 are alike
    x = np.arange(-140.0, 141.0, 20.0)
    x[0] += 0.3
    wave = 5e-3 * np.sin(2 * np.pi * x / 70.0)
    rng = np.random.default_rng(2)
    both = wave + 1e-3 * rng.normal(size=(2, 5, len(x)))
    found = lead_error(PositioningTest(x, both[0], both[1]))
    assert not found.amplitude.told
    periods = [float(w) for w in found.amplitude.why.split() if w[0].isdigit()]
    assert periods[0] == pytest.approx(70.0, rel=0.02) or periods[1] == pytest.approx(70.0, 0.02)
    alias = 1.0 / min(periods)
    assert alias in (pytest.approx(1 / 28, rel=0.02), pytest.approx(9 / 140, rel=0.02)), periods


def test_even_targets_tell_no_wave_shorter_than_two_of_their_steps() -> None:
    x = targets(15, even=True)
    assert lead_error(made(x, 0.0)).shortest == pytest.approx(2 * (x[1] - x[0]))
    assert lead_error(made(targets(), 0.0)).shortest < 20.0


def test_few_targets_tell_no_wave_but_scale_and_backlash() -> None:
    x = np.array([-100.0, 0.0, 50.0, 120.0])
    found = lead_error(made(x, 0.0, size=0.0))
    assert "six at least" in found.amplitude.why
    assert found.slope.value == pytest.approx(SLOPE)
    assert found.backlash.value == pytest.approx(BACKLASH)
