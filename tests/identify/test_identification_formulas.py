"""Formulas of docs/theory/identification.md against what the package computes."""

from types import SimpleNamespace

import numpy as np
import pytest
from noisy_loop import STEP, direct_of, loop_of, plant_of

from motionfmu.analysis.measured_response import (
    EstimateOptions,
    LoopSignals,
    estimate,
    response_estimate,
)
from motionfmu.identify import rigid_motion
from motionfmu.identify.found_values import value_text
from motionfmu.identify.identification import Parameter
from motionfmu.identify.spread import spread


def test_differences_lose_what_the_formula_says() -> None:
    t = STEP * np.arange(4001)
    for hertz in (10.0, 60.0, 200.0):
        w = 2.0 * np.pi * hertz
        v, a = rigid_motion.derivatives(np.sin(w * t), STEP)
        lost = np.sin(w * STEP) / (w * STEP), (np.sin(0.5 * w * STEP) / (0.5 * w * STEP)) ** 2
        assert v[5:-5] == pytest.approx(w * lost[0] * np.cos(w * t)[5:-5], abs=1e-6 * w)
        assert a[5:-5] == pytest.approx(-(w**2) * lost[1] * np.sin(w * t)[5:-5], abs=1e-6 * w**2)


def test_the_low_pass_of_positions_and_what_it_leaves_of_their_noise() -> None:
    t = STEP * np.arange(8000)
    for hertz in (20.0, 40.0, 60.0, 90.0):
        wave = np.sin(2.0 * np.pi * hertz * t)
        through = rigid_motion.smooth([wave], STEP, 60.0)[0][1000:-1000]
        gain = through @ wave[1000:-1000] / (wave[1000:-1000] @ wave[1000:-1000])
        # a filter of samples has its frequencies along a tangent
        warped = np.tan(np.pi * hertz * STEP) / np.tan(np.pi * 60.0 * STEP)
        assert gain == pytest.approx(1.0 / (1.0 + warped**8), abs=2e-3)
    noise = np.random.default_rng(1).normal(size=400_000)
    for corner in (30.0, 60.0):
        rest = rigid_motion.second(rigid_motion.smooth([noise], STEP, corner)[0], STEP).std()
        share = 3.0 * np.pi / 64.0 / np.sin(3.0 * np.pi / 8.0)
        wanted = (2.0 * np.pi * corner) ** 2 * np.sqrt(2.0 * corner * STEP * share)
        assert rest == pytest.approx(wanted, rel=0.03)
    raw = rigid_motion.second(noise, STEP).std()
    assert raw == pytest.approx(np.sqrt(6.0) / STEP**2, rel=0.01)


def fitted(columns: np.ndarray, rest: np.ndarray) -> SimpleNamespace:
    """A fit whose residuals and slopes are given."""
    scale = np.sqrt(np.mean(rest**2))
    return SimpleNamespace(
        linear=SimpleNamespace(slopes=columns[:, None, :], rest=rest[:, None]),
        sizes=np.array([scale]),
        first=0,
        weights=np.ones(len(rest)),
        prior=np.zeros(columns.shape[1]),
    )


@pytest.mark.parametrize("motion", ["even accelerations", "a sine"])
def test_how_alike_viscous_and_coulomb_friction_are(motion: str) -> None:
    phase = np.linspace(0.0, 20.0, 20_000, endpoint=False)
    v = 0.4 * np.sin(2.0 * np.pi * phase)
    alike = 2.0 * np.sqrt(2.0) / np.pi
    if motion == "even accelerations":
        v, alike = 0.4 * (4.0 * np.abs(phase % 1.0 - 0.5) - 1.0), np.sqrt(3.0) / 2.0
    columns = np.column_stack([v, np.sign(v)])
    rest = 0.1 * np.random.default_rng(2).normal(size=len(v))
    known = spread(fitted(columns, rest))
    assert known.condition == pytest.approx((1.0 + alike) / (1.0 - alike), rel=1e-2)
    for k in range(2):
        wanted = 0.1 / np.linalg.norm(columns[:, k]) / np.sqrt(1.0 - alike**2)
        assert known.white[k] == pytest.approx(wanted, rel=0.02)


def test_residuals_that_go_on_count_as_fewer() -> None:
    stays, rng = 0.9, np.random.default_rng(3)
    rest = np.zeros(40_000)
    for k, news in enumerate(rng.normal(size=len(rest))):
        rest[k] = stays * rest[k - 1] + news
    known = spread(fitted(np.ones((len(rest), 1)), rest))
    wider = float(known.deviations[0] / known.white[0])
    # Bartlett's weights count a little less
    assert 0.85 < wider / np.sqrt((1.0 + stays) / (1.0 - stays)) < 1.05


def test_what_input_and_output_alone_give_in_a_loop() -> None:
    reference = np.random.default_rng(4).normal(size=200_000)
    told = loop_of(reference, 0.2, 5)
    blind = LoopSignals(None, told.input, told.output, STEP)
    found = estimate(blind, EstimateOptions(period=0.0, low=5.0, high=60.0))
    wanted = direct_of(found.omega, 0.2)
    assert len(found.omega) > 200
    assert abs(np.mean(found.values / wanted) - 1.0) < 0.02
    assert abs(np.mean(found.values / plant_of(found.omega)) - 1.0) > 0.25


def test_windows_give_the_plant_within_their_deviation() -> None:
    away = []
    for seed in range(4):
        reference = np.random.default_rng(seed).normal(size=60_000)
        found = estimate(loop_of(reference, 0.1, 10 + seed), EstimateOptions(0.0, 5.0, 200.0))
        away.append(np.abs(found.values - plant_of(found.omega)) / found.deviation)
    assert 0.8 < np.mean(np.concatenate(away) ** 2) < 1.25


def test_hann_windows_that_share_a_half() -> None:
    window = np.sin(np.pi * np.arange(4096) / 4096) ** 2
    alike = window[:2048] @ window[2048:] / (window @ window)
    assert response_estimate._ALIKE == pytest.approx(alike, rel=1e-3)
    assert response_estimate._OVERLAP == pytest.approx(1.0 / (1.0 + 2.0 * alike**2), abs=0.005)


@pytest.mark.parametrize(
    ("deviation", "told", "text"),
    [
        (0.012, True, "1.234 ± 0.012"),
        (0.012, False, "1.23412"),
        (np.inf, True, "1.23412"),
        (np.inf, False, "1.23412"),
        (3e-12, True, "1.23412 ± 3e-12"),
        (0.0, True, "1.234123 ± 0"),
    ],
)
def test_a_value_has_the_digits_that_the_record_tells(deviation, told, text):
    assert value_text(Parameter("a.b", "B", "", 1.0, 1.2341234, deviation, told)) == text
