"""Fits of a plant with a gap: what their slopes, weights and deviations are."""

import re
from dataclasses import replace
from unittest import mock

import numpy as np
import pytest
from axis_truth import COLUMNS, AxisTruth, drawn, moves, simulated

from motionfmu.identify import AxisRecord, IdentifyOptions, identify
from motionfmu.identify.contact_shooting import ContactShooting
from motionfmu.identify.fit_notes import contact_notes
from motionfmu.identify.ground import Ground, ground
from motionfmu.identify.law_choice import extended, free_names
from motionfmu.identify.near_fits import near_fits
from motionfmu.identify.shooting import Fitted, Guess, Shooting
from motionfmu.identify.span_fit import misfit
from motionfmu.identify.spread import spread

NOISE = 0.01  # of the torque, as a share of its RMS
SEED = 0  # 9 um of backlash, a light table
NAMES = ("table_mass", "table_coulomb", "table_viscous", "table_viscous_asymmetry")
OPTIONS = IdentifyOptions(COLUMNS, laws=["direction"])
Known = tuple[AxisTruth, AxisRecord]


@pytest.fixture(scope="module")
def known() -> Known:
    truth, rng, (speed, acceleration) = drawn(SEED, gap=True)
    return truth, simulated(truth, moves(rng, 3.0, speed, acceleration), rng, NOISE)


def problem_of(known: Known, off: float) -> tuple[Ground, ContactShooting, Guess]:
    """The problem, and a guess whose quantities are all beside the truth by a share."""
    truth, record = known
    own = ground(truth.scenario(), record, OPTIONS, ({}, {}))
    free = own.free(extended(own, free_names(own, OPTIONS), ["direction"], OPTIONS))
    assert free.names == NAMES
    values = true(truth) * (1.0 + off)
    problem, starts = own.shooting(free, (own.first, own.data.samples - 1), values)
    assert isinstance(problem, ContactShooting)
    return own, problem, Guess(values, starts)


def worse(own: Ground, fit: Fitted) -> float:
    """How many times noise the fit leaves."""
    return misfit(own, fit, (own.first, own.data.samples - 1))


def true(truth: AxisTruth) -> np.ndarray:
    return np.array([truth.values[f"machine.{n}"] for n in NAMES])


@pytest.mark.parametrize(
    "off", [pytest.param(x, marks=[] if x > 0.0 else pytest.mark.more) for x in (0.05, -0.05)]
)
def test_a_fit_across_hollows_finds_the_truth(known: Known, off: float) -> None:
    own, problem, guess = problem_of(known, off)
    fit = problem.fit(guess)
    assert fit.settled
    away = fit.guess.free / true(known[0]) - 1.0
    assert (np.abs(away) < [1e-4, 1e-4, 1e-4, 3e-3]).all(), away
    assert worse(own, fit) < 1.1


def test_a_hollow_beside_the_truth_leaves_more_than_noise(known: Known) -> None:
    """Slopes as they are at a point end where they begin; deviations are so much wider there."""
    own, p, guess = problem_of(known, 0.05)
    fit = Shooting(p.motion, p.stretch, p.values, p.bounds, p.ranges).fit(guess)
    assert np.abs(fit.guess.free / true(known[0]) - 1.0).max() > 0.02
    wide = worse(own, fit)
    assert wide > 3.0
    assert spread(fit).widened(wide).deviations == pytest.approx(wide * spread(fit).deviations)
    assert any(
        f"are {wide:.3g} times" in n
        for n in contact_notes(own, fit, (own.first, own.data.samples - 1))
    )


def test_a_time_in_which_the_motion_is_another_one_counts_little(known: Known) -> None:
    truth, record = known
    columns = {n: c.copy() for n, c in record.columns.items()}
    columns["torque"][2000:2060] += 0.5 * np.abs(columns["torque"]).max()
    own, problem, guess = problem_of((truth, replace(record, columns=columns)), 0.02)
    fit = problem.fit(guess)
    aside = problem.stretch.rows[fit.weights < 0.5]
    assert len(aside) > 40 and aside.min() > 1960 and aside.max() < 2100
    assert fit.guess.free[0] == pytest.approx(truth.values["machine.table_mass"], rel=1e-3)
    told = next(contact_notes(own, fit, (own.first, own.data.samples - 1)))
    assert re.search(r"% of the samples count little: at 1\.9\d* s", told), told


def test_a_slope_in_the_gap_is_not_believed(known: Known) -> None:
    """At a reversal the parts do not touch, and the drive's slope there is anything."""
    own, problem, guess = problem_of(known, 0.0)
    free = own.free(NAMES)
    usual = own.reach(free, guess.free)
    plain = own.follow(free, guess.free, own.points)
    wild = plain.slopes.copy()
    wild[len(wild) // 2, 0] = 1e13
    with mock.patch.object(Ground, "follow", return_value=replace(plain, slopes=wild)):
        assert own.reach(free, guess.free) == pytest.approx(usual, rel=0.02)
    # so much of the drive: the mass a good third, the asymmetry next to nothing
    share = guess.free / usual
    assert 0.2 < share[0] < 0.6 and share[3] < 0.02
    assert problem.reach[:3] == pytest.approx(usual[:3]) and problem.reach[3] == 1.0  # its limit


def test_the_best_of_fits_beside_one_another_is_taken(known: Known) -> None:
    """Deviations are how far the others lie away from it, beside a share of the drive."""
    own, problem, guess = problem_of(known, 0.0)
    free = own.free(NAMES)
    good = problem.fit(guess)
    values = good.guess.free * np.array([1.002, 1.0, 1.0, 1.0])
    joined, rest = problem._joined(replace(guess, free=values))
    linear = replace(good.linear, rest=rest)
    beside = replace(good, guess=joined, linear=linear)
    span = own.first, own.data.samples - 1
    with mock.patch.object(ContactShooting, "fit", side_effect=[beside, good, good, beside]):
        best, told = near_fits(own, free, beside, span)
    assert best is good
    away = np.sqrt(3.0 / 4.0) * 0.002 * good.guess.free[0]  # three of the four others
    assert told.deviations[0] == pytest.approx(away, rel=0.3)
    assert (told.deviations > 0.9e-4 * own.reach(free, good.guess.free)).all()


@pytest.mark.long
def test_a_gap_that_is_not_the_plants_is_told(known: Known) -> None:
    """With the one that is, and deviations that hold what the wrong one does."""
    truth, record = known
    right = truth.values["machine.backlash"]
    gap = {"machine.backlash": 0.5 * right}
    found = identify(truth.scenario().changed(set=gap), record, OPTIONS)
    assert any("Standard deviations are" in note for note in found.notes), found.notes
    told = next(n for n in found.notes if n.startswith("The record contradicts machine.backlash"))
    assert float(re.findall(r"[\d.e-]+(?= m\b)", told)[1]) == pytest.approx(right, rel=0.01)
    for p in found.parameters:
        if p.told:
            away = abs(p.value - truth.values[p.name])
            assert away < 3.0 * p.deviation, (p.name, p.value, p.deviation)
