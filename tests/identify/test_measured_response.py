"""Frequency responses of a measured axis against closed forms, scipy and the running FMUs."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from noisy_loop import STEP, loop_of, multisine, plant_of
from scipy import signal

import motionfmu
from motionfmu import InputError
from motionfmu.analysis.linear.stability import response as exact
from motionfmu.analysis.measured_response import (
    EstimateOptions,
    LoopSignals,
    MassModel,
    MeasuredResponse,
    ResponseOptions,
    estimate,
    fit_masses,
    found_response,
    identify_response,
    together,
)
from motionfmu.analysis.measured_response.period_of_signal import period_of, whole_periods
from motionfmu.analysis.measured_response.plant_response import axis_of, model_response
from motionfmu.identify import AxisRecord, ColumnUse
from motionfmu.report.loop_pages.response_page import _bode

TRUE = MassModel(5e-4, 3e-4, 200.0, 0.01, 2e-3, 5e-4, 2e-4)
OFF = [False] * 5


@pytest.mark.parametrize(("period", "drift"), [(250, 0.0), (377, 3e-2), (1000, -1e-2)])
def test_period_is_found_in_noise_and_drift(period, drift):
    rng = np.random.default_rng(period)
    lines = np.arange(1, period // 8)
    x = np.tile(multisine(period, lines, rng), 5) + drift * np.arange(5 * period)
    x += 0.05 * rng.standard_normal(len(x))
    assert period_of(x) == period
    assert whole_periods(x, period, "x").count == 5


def test_a_slow_signal_does_not_repeat_at_once():
    # neighbours of a slow signal are alike, too
    x = np.tile(multisine(1000, np.arange(1, 4), np.random.default_rng(5)), 4)
    assert period_of(x) == 1000


def test_noise_and_a_chirp_have_no_period():
    rng = np.random.default_rng(1)
    time = np.arange(4000) * STEP
    assert period_of(rng.standard_normal(4000)) is None
    assert period_of(signal.chirp(time, 1.0, 4.0, 100.0)) is None


def test_periods_give_the_plant_within_their_deviation():
    rng = np.random.default_rng(2)
    n, lines = 500, np.arange(1, 200)
    reference = np.tile(multisine(n, lines, rng), 13) + 1e-3 * np.arange(13 * n)
    found = estimate(loop_of(reference, 0.05, 3))
    assert len(found.omega) == len(lines)
    away = np.abs(found.values - plant_of(found.omega)) / found.deviation
    # squares of a complex normal deviate over its mean, which 8 stretches tell: 1; 8 % above 3
    assert 0.7 < np.mean(away**2) < 1.4
    assert np.mean(away**2 > 3.0) < 0.14
    assert found.drift == pytest.approx(0.8, rel=0.01)  # 5 x 0.8 over 1 + 5 x 0.8


def test_the_reference_as_instrument_is_not_biased_by_noise_in_the_loop():
    rng = np.random.default_rng(4)
    signals = loop_of(rng.standard_normal(60000), 0.2, 5)
    good = estimate(signals, EstimateOptions(period=0.0, high=100.0))
    _, uy = signal.csd(signals.input, signals.output, 1 / STEP, nperseg=2048)
    frequency, uu = signal.welch(signals.input, 1 / STEP, nperseg=2048)
    direct = np.interp(good.omega / 2 / np.pi, frequency, np.real(uy / uu))
    truth = np.real(plant_of(good.omega))
    norm = np.linalg.norm(truth)
    assert truth @ np.real(good.values) / norm**2 == pytest.approx(1.0, abs=0.1)
    assert truth @ direct / norm**2 < 0.75  # what an estimate without it gives


def test_windows_are_those_of_scipy():
    rng = np.random.default_rng(6)
    signals = loop_of(rng.standard_normal(9000), 0.1, 7)
    found = estimate(signals, EstimateOptions(period=0.0))
    size = 2 * 9000 // 13  # 12 segments, half of each overlapping
    frequency, ry = signal.csd(
        signals.reference, signals.output, 1 / STEP, nperseg=size, detrend="linear"
    )
    _, ru = signal.csd(signals.reference, signals.input, 1 / STEP, nperseg=size, detrend="linear")
    _, same = signal.coherence(
        signals.reference, signals.output, 1 / STEP, nperseg=size, detrend="linear"
    )
    at = np.searchsorted(frequency, found.omega / 2 / np.pi - 1e-9)
    np.testing.assert_allclose(found.values, (ry / ru)[at], rtol=1e-9)
    np.testing.assert_allclose(found.coherence, same[at], rtol=1e-9)


def test_a_wandering_output_is_not_smeared_over_the_lines():
    # a mass: noise of its torque, which is recorded, makes it wander from period to period
    rng = np.random.default_rng(8)
    n, lines = 1000, np.arange(4, 300)
    u = np.tile(multisine(n, lines, rng), 8) + 0.3 * rng.standard_normal(8 * n)
    y = np.cumsum(np.cumsum(np.concatenate([[0.0, 0.0], u])))[:-2]
    y = y - np.linspace(0.0, y[-1], len(y))
    found = estimate(LoopSignals(None, u, y, STEP, "mass"), EstimateOptions(low=100.0))

    def wrong(values):
        z = np.exp(1j * found.omega * STEP)
        return float(np.sqrt(np.mean(np.abs(values * (z - 1.0) ** 2 - 1.0) ** 2)))

    k = np.rint(found.omega * n * STEP / 2 / np.pi).astype(int)
    both = [np.fft.rfft(x[n:].reshape(-1, n).mean(0)) for x in (u, y)]
    assert len(k) == 200
    assert wrong(found.values) < 1e-3
    assert wrong(both[1][k] / both[0][k]) > 0.5


def test_records_with_other_phases_are_averaged():
    found = []
    for seed in (1, 2, 3):
        rng = np.random.default_rng(seed)
        reference = np.tile(multisine(500, np.arange(1, 100), rng), 5)
        found.append(estimate(loop_of(reference, 0.1, seed)))
    mean = together(found)
    one = np.abs(found[0].values - plant_of(found[0].omega))
    assert np.sqrt(np.mean(np.abs(mean.values - plant_of(mean.omega)) ** 2)) < 0.8 * np.sqrt(
        np.mean(one**2)
    )
    assert "3 records" in mean.way
    with pytest.raises(InputError, match="0 frequencies in common"):
        moved = replace(found[1], omega=found[1].omega * 1.01)
        together([found[0], moved])


@pytest.mark.parametrize(
    ("signals", "options", "told"),
    [
        ({"input": np.zeros(1000)}, {}, "the input does not change"),
        ({"reference": np.ones(1000)}, {}, "nothing excites the loop"),
        ({"output": np.arange(999.0)}, {}, "signals of"),
        ({}, {"period": 0.1234}, "no whole number of samples"),
        ({}, {"period": 0.8}, "16 to 500 wanted"),
        ({}, {"period": 0.3}, "does not repeat after 300 samples"),
        ({}, {"low": 490.0, "high": 499.0}, "0 frequencies of the band"),
    ],
)
def test_what_is_no_record_of_a_loop_is_told(signals, options, told):
    rng = np.random.default_rng(9)
    reference = np.tile(multisine(250, np.arange(1, 60), rng), 4)
    whole = loop_of(reference, 0.0, 1)
    parts = {"reference": whole.reference, "input": whole.input, "output": whole.output}
    with pytest.raises(InputError, match=re.escape(told)):
        estimate(LoopSignals(**(parts | signals), interval=STEP), EstimateOptions(**options))


def measured(model, omega, noise=0.0, seed=1, load=False):
    rng = np.random.default_rng(seed)
    values = model.response(omega, load)
    error = noise * np.abs(values)
    both = rng.standard_normal(len(omega)) + 1j * rng.standard_normal(len(omega))
    deviation = error if noise else np.full(len(omega), math.nan)
    return MeasuredResponse(
        omega, values + error * both / math.sqrt(2), deviation, 0 * omega, "made", "x"
    )


OMEGA = 2 * np.pi * np.arange(4.0, 400.0, 2.0)


def test_the_closed_form_is_that_of_the_equations():
    m = TRUE
    a = np.array(
        [
            [0, 1, 0, 0],
            [-m.stiffness / m.motor, -(m.damping + m.motor_viscous) / m.motor,
             m.stiffness / m.motor, m.damping / m.motor],
            [0, 0, 0, 1],
            [m.stiffness / m.load, m.damping / m.load,
             -m.stiffness / m.load, -(m.damping + m.load_viscous) / m.load],
        ]
    )  # fmt: skip
    for row, load in (([1.0, 0, 0, 0], False), ([0, 0, 1.0, 0], True)):
        moved = [np.linalg.solve(1j * w * np.eye(4) - a, [0, 1 / m.motor, 0, 0]) for w in OMEGA]
        values = np.array(moved) @ row
        late = np.exp(-1j * OMEGA * m.delay)
        np.testing.assert_allclose(m.response(OMEGA, load), values * late, rtol=1e-9)
    zeros = np.sqrt(m.stiffness / m.load), np.sqrt(m.stiffness * (1 / m.motor + 1 / m.load))
    assert (m.antiresonance, m.resonance) == pytest.approx(zeros)


@pytest.mark.parametrize("ratio", [0.1, 0.6, 3.0])
def test_masses_are_found_within_their_deviations(ratio):
    truth = replace(TRUE, load=ratio * TRUE.motor)
    fit = fit_masses(measured(truth, OMEGA, 0.03), TRUE.motor_viscous)
    assert fit.two
    for name in ("motor", "load", "stiffness", "damping", "delay"):
        away = abs(getattr(fit.model, name) - getattr(truth, name))
        assert away < 4.0 * fit.deviations[name], name
    assert fit.model.antiresonance == pytest.approx(truth.antiresonance, rel=0.01)
    assert fit.model.resonance == pytest.approx(truth.resonance, rel=0.01)
    assert fit.ratio == pytest.approx(ratio, rel=0.03)


def test_the_load_alone_tells_the_resonance_and_no_ratio():
    fit = fit_masses(measured(TRUE, OMEGA, 0.03, load=True), TRUE.motor_viscous, True)
    assert fit.two
    assert fit.model.resonance == pytest.approx(TRUE.resonance, rel=0.01)
    assert fit.told("resonance")
    assert not fit.told("ratio")
    assert not fit.told("antiresonance")


@pytest.mark.more
def test_deviations_are_those_of_many_draws():
    found = [fit_masses(measured(TRUE, OMEGA, 0.03, seed), 2e-3) for seed in range(24)]
    for name in ("motor", "stiffness", "antiresonance"):
        values = [getattr(f.model, name) for f in found]
        told = np.mean([f.deviations[name] for f in found])
        assert 0.6 < np.std(values) / told < 1.5, name


def test_one_mass_is_told_as_one():
    for truth in (MassModel(5e-4, load_viscous=2e-3), replace(TRUE, stiffness=2e5)):
        fit = fit_masses(measured(truth, OMEGA, 0.03))
        assert not fit.two
        assert fit.model.motor == pytest.approx(truth.motor + truth.load, rel=0.02)
        assert not fit.told("stiffness")


def test_what_lies_beyond_the_band_is_not_told():
    high = 2 * np.pi * np.arange(4.0, 148.0, 2.0)
    fit = fit_masses(measured(TRUE, high, 0.05), 2e-3)
    assert TRUE.resonance > high[-1]
    for name, deviation in fit.deviations.items():
        if fit.told(name) and name != "delay":
            true = {"ratio": TRUE.load / TRUE.motor} | vars(TRUE)
            true |= {"antiresonance": TRUE.antiresonance, "resonance": TRUE.resonance}
            value = {"ratio": fit.ratio, "resonance": fit.model.resonance}.get(
                name, getattr(fit.model, name, None)
            )
            assert abs(value - true[name]) < 5.0 * deviation, name
    with pytest.raises(InputError, match="8 at least"):
        fit_masses(measured(TRUE, OMEGA[:6]))


def scenario(**values):
    """A drive in velocity mode and an elastic axis."""
    return motionfmu.scenario(
        {
            "stop": 1.0,
            "step": 1e-4,
            "component": {"drives": "servo_drives", "machine": "ball_screw_axes"},
            "connect": {
                "drives.phase": "machine.motor_phase",
                "machine.torque_command": "drives.torque",
            },
            "leave": ["drives.enable", "drives.alarm_reset", "drives.pulse_count", "machine.force"],
            "drive": [{"input": "drives.dac", "at": [0.0], "value": [0.0]}],
            "set": {
                "drives.active": [True, *OFF],
                "machine.active": [True, *OFF],
                "drives.velocity_gain": 0.25,
                **{f"machine.{n}": v for n, v in values.items()},
            },
            "record": {"every": 1, "signals": ["drives.torque", "machine.motor_phase"]},
        },
        name="axis",
    )


ELASTIC = {
    "screw_stiffness": 8e7,
    "screw_damping": 3e3,
    "table_mass": 120.0,
    "motor_inertia": 4.65e-4,
}
WRONG = {"screw_stiffness": 3e7, "table_mass": 60.0, "motor_inertia": 9e-4, "screw_damping": 3e3}


def test_the_masses_of_a_plant_are_those_of_its_linear_model():
    smooth = {"motor_static": 0.15, "table_static": 50.0}  # friction has no slope but the viscous
    axis, masses = axis_of(scenario(**ELASTIC, **smooth, current_time=0.0), 1, {})
    pair = "machine.torque_command", "machine.motor_angle"
    omega = 2 * np.pi * np.array([1.0, 10.0, 100.0, 160.0, 300.0])
    model = replace(masses.of(axis), delay=0.5e-4)  # of a hold of 0.1 ms
    ours = model.response(omega)
    np.testing.assert_allclose(ours, model_response(axis, masses, pair, omega), rtol=5e-3)
    system = axis.system(*pair, cut=pair[0])
    np.testing.assert_allclose(exact(system, omega), ours, rtol=5e-3)
    zeros = np.log(system.zeros().astype(complex)) / system.dt
    near = np.abs(zeros[np.abs(zeros.imag) > 100.0])
    assert near.min() == pytest.approx(model.antiresonance, rel=1e-3)


def test_exact_responses_of_other_values_give_those_values():
    axis, masses = axis_of(scenario(**ELASTIC), 1, {}, 30.0)
    signals = "drives.torque", "drives.speed"
    values = model_response(axis, masses, signals, OMEGA)
    exact_ = MeasuredResponse(OMEGA, values, np.full(len(OMEGA), math.nan), 0 * OMEGA, "made", "x")
    found = found_response(scenario(**WRONG), exact_, signals)
    for name, value in ELASTIC.items():
        assert found.settings[f"machine.{name}[1]"] == pytest.approx(value, rel=2e-3), name
    assert found.fit.model.delay == pytest.approx(0.0, abs=1e-6)
    # the loop that is measured is the loop of the true axis
    loop = axis.loop("drives.phase")
    [mine] = found.loops
    np.testing.assert_allclose(mine.measured, exact(loop, mine.omega), rtol=1e-6)


def test_of_one_mass_the_load_has_what_the_motor_leaves():
    stiff = {"screw_stiffness": 1e10, "screw_damping": 1e6, "motor_inertia": 4.65e-4}
    axis, masses = axis_of(scenario(**stiff, table_mass=120.0), 1, {})
    low = OMEGA[:48]  # to 100 Hz, far below the antiresonance at 1.45 kHz
    pair = "drives.torque", "machine.motor_phase"
    values = model_response(axis, masses, pair, low)
    unknown = np.full(len(low), math.nan)
    measured_ = MeasuredResponse(low, values, unknown, unknown, "", "x")
    found = found_response(scenario(**stiff, table_mass=60.0), measured_, pair)
    assert not found.fit.two
    assert found.settings == pytest.approx({"machine.table_mass[1]": 120.0}, rel=0.01)
    magnitude, phase = _bode(found).subplots
    for row, measured_row in (
        (magnitude, 20 * np.log10(abs(values))),
        (phase, np.angle(values, 1)),
    ):
        marks = {m.name: m.y for m in row.marks if hasattr(m, "y")}
        assert set(marks) == {"model, values before", "model, values found", "measured"}
        turns = (marks["measured"] - measured_row) / (360.0 if row is phase else 1.0)
        assert turns == pytest.approx(np.round(turns), abs=1e-9)
        assert np.abs(marks["measured"] - marks["model, values found"]).max() < 0.5
    heavy = found_response(scenario(**stiff | {"motor_inertia": 1e-2}), measured_, pair)
    assert heavy.settings == {}
    assert all("only the sum" in p.why or "one mass" in p.why for p in heavy.parameters[:4])


def test_loops_inside_loops_have_the_measured_plant_too():
    mill = motionfmu.scenario({"machine": "mill3", "stop": 1.0}, name="mill3")
    true = {"machine.screw_stiffness": 5e7, "machine.table_mass": 200.0}
    axis, masses = axis_of(mill, 1, true)
    pair = "drives.torque", "machine.motor_phase"
    values = model_response(axis, masses, pair, OMEGA)
    unknown = np.full(len(OMEGA), math.nan)
    found = found_response(mill, MeasuredResponse(OMEGA, values, unknown, unknown, "", "x"), pair)
    assert [loop.at for loop in found.loops] == ["card.enc_phase", "drives.phase"]
    for loop, cut in zip(found.loops, ((), ("card.enc_phase",)), strict=True):
        right = exact(axis.loop(loop.at, cut), loop.omega)
        np.testing.assert_allclose(loop.measured, right, rtol=1e-6)
        assert np.abs(exact(loop.before, loop.omega) / right - 1.0).max() > 0.3


COLUMN = {"gain": ColumnUse("machine.motor_speed/drives.torque")}


def table(tmp_path, head, rows):
    file = tmp_path / "response.csv"
    lines = [head, *(",".join(f"{x:.10g}" for x in row) for row in rows)]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return file


@pytest.fixture(scope="module")
def speeds():
    axis, masses = axis_of(scenario(**ELASTIC), 1, {})
    values = model_response(axis, masses, ("drives.torque", "machine.motor_speed"), OMEGA)
    return OMEGA / 2 / np.pi, values


@pytest.mark.parametrize(
    ("head", "columns"),
    [
        ("frequency [Hz],gain [dB],phase [deg]", lambda f, g: (f, db(g), deg(g))),
        ("f [kHz],Gain (dB),Phase (°)", lambda f, g: (f / 1e3, db(g), deg(g))),
        ("omega [rad/s],magnitude [rpm/(N.m)],phase [rad]",
         lambda f, g: (2 * np.pi * f, np.abs(g) * 30 / np.pi, np.angle(g))),
        ("Frequency [Hz],real,imag", lambda f, g: (f, g.real, g.imag)),
        ("Frequency [Hz],gain,phase,coherence", lambda f, g: (f, np.abs(g), deg(g), 0 * f + 0.99)),
    ],
)  # fmt: skip
def test_tables_of_drives_are_read(tmp_path, speeds, head, columns):
    f, g = speeds
    file = table(tmp_path, head, zip(*columns(f, g), strict=True))
    name = head.split(",")[1].split(" ")[0]
    use = {name: COLUMN["gain"]}
    found = identify_response(scenario(**WRONG), [file], ResponseOptions(use))
    for name, value in ELASTIC.items():
        assert found.settings[f"machine.{name}[1]"] == pytest.approx(value, rel=0.01), name


def db(g):
    return 20 * np.log10(np.abs(g))


def deg(g):
    return np.degrees(np.angle(g))


GOOD = [(f, -10.0, -90.0) for f in (1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0)]


@pytest.mark.parametrize(
    ("head", "rows", "columns", "told"),
    [
        ("f [Hz],gain [dB]", [(f, -10.0) for f in range(1, 9)], COLUMN, "without a phase"),
        ("f [Hz],gain [dB],phase [deg]", GOOD, {}, ":1:8: gain: --column gain=OUTPUT/INPUT"),
        ("f [Hz],gain [dB],phase [deg]", [(0.0, 1.0, 2.0), *GOOD], COLUMN, ":2:1: f = 0: above 0"),
        ("f [Hz],gain [dB],phase [deg]", [*GOOD, GOOD[0]], COLUMN, ":11:1: 1 Hz is there twice"),
        ("f [Hz],gain,phase [deg]", GOOD, COLUMN, "gain = -10: above 0 wanted"),
        ("f [Hz],gain [dB],phase [mm]", GOOD, COLUMN, "phase is in [mm]"),
        ("f [Hz],gain [V],phase [deg]", [(f, 1.0, p) for f, _, p in GOOD], COLUMN, "say its scale"),
        ("f [Hz],gain [dB],phase [deg]", GOOD, {"gain": ColumnUse("drives.torque")},
         "OUTPUT/INPUT wanted"),
        ("f [Hz],gain [dB],phase [deg]", GOOD,
         {"gain": ColumnUse("machine.motor_sped/drives.torque")}, "no such variable"),
        ("f [Hz],gain [dB],phase [deg]", GOOD,
         {"gain": ColumnUse("machine.motor_speed/drives.speed")}, "does not move the plant"),
        ("f [Hz],gain [dB],phase [deg]", GOOD,
         {"gain": ColumnUse("drives.torque/drives.torque")}, "neither a position nor a speed"),
    ],
)  # fmt: skip
def test_wrong_tables_are_told(tmp_path, head, rows, columns, told):
    file = table(tmp_path, head, rows)
    with pytest.raises(InputError, match=re.escape(told)) as error:
        identify_response(scenario(), [file], ResponseOptions(columns))
    assert "\n" not in str(error.value)


RECORD = AxisRecord(
    1e-4 * np.arange(4000),
    {
        "r": np.tile(multisine(1000, np.arange(2, 200), np.random.default_rng(1)), 4),
        "u": np.tile(multisine(1000, np.arange(2, 200), np.random.default_rng(2)), 4),
        "x": np.tile(multisine(1000, np.arange(2, 200), np.random.default_rng(3)), 4),
    },
    {"u": "N.m", "x": "mm"},
    "trace",
)


@pytest.mark.parametrize(
    ("columns", "told"),
    [
        ({"q": "drives.torque"}, "trace has no column 'q'; it has: r, u, x"),
        ({"x": "machine.motor_phase"}, "no column is what moves the plant, drives.torque or"),
        ({"u": "drives.torque"}, "no column is a position or speed"),
        ({"u": "drives.torque", "r": "drives.speed", "x": "machine.motor_phase"}, "both output"),
        ({"u": "drives.torque", "x": "machine.motor_fase"}, "machine.motor_fase is no signal"),
        ({"u": "drives.torque", "x": "machine.screw_force"}, "neither a position nor a speed"),
        ({"x": "drives.torque", "u": "machine.motor_phase"}, "its scale must be said"),
        (
            {"u": "drives.torque", "r": "machine.motor_angle"},
            "column r [no unit] is no machine.motor_angle [rad]: its scale must be said",
        ),
    ],
)
def test_wrong_columns_are_told(columns, told):
    uses = {name: ColumnUse(of) for name, of in columns.items()}
    with pytest.raises(InputError, match=re.escape(told)):
        identify_response(scenario(), [RECORD], ResponseOptions(uses))
