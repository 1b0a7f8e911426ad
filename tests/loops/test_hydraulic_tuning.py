"""The textbook's gain of a hydraulic axis against its damping, and the tuner on that loop."""

import importlib.util
import tomllib
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from conftest import ROOT

import motionfmu
from motionfmu.analysis.linear.loops import largest_gain
from motionfmu.analysis.linear.stability import margins
from motionfmu.base.errors import InputError
from motionfmu.study.tune import RanAway, Tuned, problem, read, tune
from motionfmu.study.tune.move import MoveCost
from motionfmu.study.tune.trial import tried

# What they share is made once, by one worker.
pytestmark = pytest.mark.xdist_group("hydraulic tuning")

SCENARIO = ROOT / "scenarios/hydraulic_gain"
SCALE = "controller.scale_phase"


@pytest.fixture(scope="module")
def study() -> ModuleType:
    spec = importlib.util.spec_from_file_location("hydraulic_gain_study", SCENARIO / "study.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def tuned() -> Tuned:
    return tune(SCENARIO, read(SCENARIO / "tune.toml") | {"check": 0, "starts": 1})


def test_a_fast_loop_rings_at_the_textbook_limit(study: ModuleType) -> None:
    """2 d w by formula, by the poles and by the FMUs; a third of w is twice that."""
    row = study.measure("fast valve and controller", study.DAMPED[study.DEFAULT])
    assert row.damping == pytest.approx(0.08, abs=0.005)
    assert row.model == pytest.approx(row.formula, rel=0.03)
    assert row.fmus == pytest.approx(row.formula, rel=0.03)
    assert row.ringing == pytest.approx(row.frequency, rel=0.03)
    assert row.frequency / 3.0 > 1.9 * row.fmus


def test_the_rule_needs_a_damping_of_a_sixth(study: ModuleType) -> None:
    """With leakages on both sides of it; the delays ask for a little more."""
    below, above = ((6e-12 * k, 1000.0) for k in (0.5, 1.4))
    for damped, stable in ((below, False), (above, True)):
        axis = study.axis_of("fast valve and controller", damped)
        omega, damping = study.resonance(axis)
        limit = study.gain_of(axis) * largest_gain(axis, SCALE).gain
        assert (damping > 1.0 / 6.0) is stable
        assert (limit > omega / 3.0) is stable


def test_lags_of_valve_and_filter_carry_the_phase_past_the_resonance(study: ModuleType) -> None:
    """The article's loop: the limit lies below w and hardly depends on the damping."""
    row = study.measure("the article's", study.DAMPED[study.DEFAULT])
    assert row.fmus == pytest.approx(row.model, rel=0.02)
    assert row.model > 2.5 * row.formula and row.ringing < 0.65 * row.frequency
    softer = study.axis_of("the article's", study.DAMPED[0])
    limit = study.gain_of(softer) * largest_gain(softer, SCALE).gain
    assert limit == pytest.approx(row.model, rel=0.02)


def test_the_rule_rings_up_where_the_loop_is_fast(study: ModuleType) -> None:
    def under_way(loop: str, gain: float) -> float:
        time, speed, _ = study.move(loop, gain)
        return float(np.ptp(speed[(time > 0.5) & (time < 0.8)]))

    fast, article = study.LOOPS
    assert under_way(fast, 129.0) > 400.0  # [mm/s], of 50
    assert under_way(fast, 21.0) < 5.0
    assert under_way(article, 129.0) < 5.0


@pytest.mark.more
def test_the_tuner_keeps_its_limits(tuned: Tuned) -> None:
    """Stopped by the margins, in whole registers, better on the FMUs too; the file is its own."""
    (least,) = tuned.margins(tuned.z)
    assert least.sensitivity <= 1.5 * 1.001 and least.gain >= 3.0 and least.phase >= 45.0
    assert any(text.startswith("sensitivity 1.5") for text in tuned.stopped_by)
    axis = tuned.study.axes[1].changed({k: v for k, v in tuned.settings.items() if "band" not in k})
    assert margins(axis.loop(SCALE)).sensitivity == pytest.approx(least.sensitivity, rel=1e-3)
    assert tuned.after[0].fmus.rms < 0.5 * tuned.before[0].fmus.rms
    kept = tomllib.loads((SCENARIO / "gains.toml").read_text())
    for name, value in kept.items():
        assert tuned.settings[name] == pytest.approx(value, rel=0.05)
    assert isinstance(tuned.settings["controller.band"], int)


@pytest.mark.more
def test_the_band_is_what_the_deadband_leaves(tuned: Tuned) -> None:
    """V0/Kp, 0.3 V at 25 mV a PWM count; less by half a PWM count and the rounded corner."""
    trial = tuned.trial
    assert trial is not None
    kp = tuned.settings["controller.p_gain"] / 2**12
    assert 0.75 * 12.0 / kp < trial.value <= 12.0 / kp
    best = trial.tried[trial.value]
    below = [look for value, look in trial.tried.items() if value < 0.7 * trial.value]
    above = [look for value, look in trial.tried.items() if value > 4.0 * trial.value]
    assert min(look.cost for look in below) > 3.0 * best.cost
    assert best.beyond < 0.03 and min(look.beyond for look in above) > 0.2
    assert any("controller.band" in text for text in tuned.stopped_by)


@pytest.mark.more
def test_what_a_scenario_records_changes_no_trial(tuned: Tuned) -> None:
    sparse = motionfmu.load(SCENARIO).changed(record={"every": 3})
    asked, path = tuned.study.problem, tuned.study.path
    assert isinstance(path, MoveCost) and tuned.trial is not None
    ((name, ends),) = asked.trial.items()
    again = tried(sparse, path, (name, ends, tuned.trial.limit), tuned.settings)
    assert again == tuned.trial


@pytest.mark.parametrize("late", [0, 1, 5])
def test_a_command_that_is_shown_late_is_put_in_earlier(late: int) -> None:
    """What follows the command at once, and is seen as late as the command is, has no error."""
    asked, time = problem(read(SCENARIO / "tune.toml")), 1e-3 * np.arange(400)
    assert asked.command is not None and asked.position is not None
    shown = np.round(1e4 * np.clip(time - 0.1, 0.0, 0.2) ** 2)

    class Run(dict[str, Any]):
        scenario = motionfmu.load(SCENARIO)

    base: Any = Run({asked.command: shown})
    base.time = time
    move = MoveCost(base, (asked.command, asked.position), 1e-3, (2e-6, late))
    put_in = move.pulses[1]
    assert np.ptp(put_in) == np.ptp(shown) and len(put_in) == len(time)
    position = 2e-6 * np.concatenate([np.full(late, put_in[0]), put_in[: len(time) - late]])
    assert move.error({1: position}).distance.max() < 1e-12
    assert move.error({1: 2e-6 * put_in}).distance.max() > (1e-4 if late else -1.0)


@pytest.mark.more
def test_a_band_at_the_bound_of_its_search_is_an_error(tuned: Tuned) -> None:
    move = tuned.study.path
    assert isinstance(move, MoveCost)
    scenario = motionfmu.load(SCENARIO)
    for ends, told in (((10.0, 22.0), "upper bound 22"), ((30.0, 45.0), "lower bound 30")):
        with pytest.raises(RanAway, match=f"controller.band ran to its own {told}"):
            tried(scenario, move, ("controller.band", ends, 0.1), tuned.settings)
    with pytest.raises(InputError, match=r"limits.beyond = 0.1: missed by all"):
        tried(scenario, move, ("controller.band", (100.0, 200.0), 0.1), tuned.settings)


@pytest.mark.more
def test_the_worst_gain_of_the_literal_integral_counts() -> None:
    options = {**read(SCENARIO / "tune.toml"), "check": 0, "starts": 1}
    literal = {"controller.law": 1, "controller.p_gain": 1811, "controller.i_gain": 250}
    with pytest.raises(InputError, match=r"no gains within the bounds keep all limits"):
        tune(SCENARIO, options, literal)


@pytest.mark.parametrize(
    ("changed", "told"),
    [
        ({"position": None}, "command and position go together"),
        ({"command": "controller.counter"}, "it shows no command"),
        ({"position": "axis.place"}, "axis.place: hydraulic_axis has no variable 'place'"),
        ({"cost": "contour_rms"}, "cost = 'contour_rms': of .contour. tables"),
        ({"command": None, "position": None}, "needs the signals of"),
        ({"trial": {"controller.band": (10.0, 5.0)}}, "the first must be less"),
        ({"trial": {"controller.bend": (10.0, 50.0)}}, "controller.bend"),
    ],
)
def test_a_wrong_problem_is_named(changed: dict[str, Any], told: str) -> None:
    with pytest.raises(InputError, match=told):
        tune(SCENARIO, problem({**read(SCENARIO / "tune.toml"), **changed}))
