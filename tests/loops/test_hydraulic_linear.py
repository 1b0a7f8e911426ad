"""The linear model of the MSP430's hydraulic loop against its running FMUs, and against theory."""

import math
from typing import Any

import numpy as np
import pytest
from conftest import ROOT
from hydraulic_theory import AREA, LEAK_VALVE, SUPPLY, TANK, oil_and_mass
from hydraulic_theory import largest_gain as theory_gain
from typer.testing import CliRunner

from motionfmu import InputError
from motionfmu.analysis import freq, linear
from motionfmu.analysis.freq.limit import RingingTest, simulated_gain, usual_kick
from motionfmu.analysis.freq.loop_study import LoopStudyOptions, study
from motionfmu.analysis.freq.response import fastest
from motionfmu.analysis.linear.loops import feedbacks, largest_gain
from motionfmu.analysis.linear.stability import margins
from motionfmu.cli import app

SCENARIO = ROOT / "scenarios/hydraulic_positioning"
SCALE = "controller.scale_phase"
AT = {
    "axis.table_speed": 0.05,
    "axis.table_position": 0.0,
}  # through the middle, where the oil is softest
# A short timer routine: the scale may then move ten times as fast before an edge is lost.
P = {
    "controller.law": 0,
    "controller.p_gain": 100,
    "controller.pwm_counts": 800,
    "controller.timer_cycles": 5,
    "axis.start_position": -0.025,
    "axis.table_coulomb": 0.0,
    "axis.table_static": 0.0,
}
PI = {"controller.law": 2, "controller.i_gain": 300, "controller.band": 0}
FAST = {
    "controller.timer_period": 5e-4,
    "controller.filter_time": 2e-4,
    "controller.p_gain": 50,
    "axis.valve_frequency": 5000.0,
    "axis.current_time": 2e-5,
}
SLOW_PWM = {"controller.pwm_counts": 2000, "controller.p_gain": 250}
LATE = {"controller.timer_cycles": 1500, "controller.flag_clear": 1}
CASES: dict[str, dict[str, Any]] = {"P": {}, "PI": PI, "fast": FAST, "slow PWM": SLOW_PWM}


def model(**changed: Any) -> linear.AxisModel:
    return linear.model(
        SCENARIO, at=AT, set=P | {k.replace("__", "."): v for k, v in changed.items()}
    )


@pytest.mark.parametrize("case", CASES)
def test_frequency_response_is_that_of_the_fmus(case: str) -> None:
    """Sines of 25 line periods on the scale, about a steady speed: within 1 % and 1 degree.

    Not at the resonance itself, 380 to 450 rad/s: it moves by as much while the axis travels.
    """
    axis = model(**CASES[case])
    outputs = ["axis.table_speed", "axis.spool"]
    system = axis.system(SCALE, outputs)
    setup = freq.setup(axis, SCALE, outputs)
    for omega in (60.0, 150.0, 300.0, 600.0, 800.0):
        cycles = max(3, round(0.15 * omega / (2.0 * math.pi)))
        n = round(cycles * 2.0 * math.pi / (omega * system.dt))
        found = freq.measure(setup, freq.sine(n, cycles, 25.0))
        expected = system(np.exp(1j * found.omega * system.dt), squeeze=False)[:, 0, :].T
        ratio = found.values / expected
        assert np.abs(np.abs(ratio) - 1.0).max() < 0.01, omega
        assert np.degrees(np.abs(np.angle(ratio))).max() < 1.0, omega


@pytest.mark.parametrize("case", [*CASES, "late"])
def test_largest_gain_by_poles_and_by_ringing(case: str) -> None:
    axis = model(**(LATE if case == "late" else CASES[case]))
    assert feedbacks(axis) == {SCALE: ()}
    expected = largest_gain(axis, SCALE)
    found = simulated_gain(axis, (SCALE, ()), RingingTest(usual_kick(axis, SCALE), 20))
    assert found.gain == pytest.approx(expected.gain, rel=0.02)
    assert found.omega == pytest.approx(expected.omega, rel=0.06)


def test_a_register_at_its_limit() -> None:
    """p_gain as a parameter, whole numbers; the literal integral counts with its largest count."""
    axis = model()
    by_wire, by_register = (
        largest_gain(axis, SCALE),
        largest_gain(axis, SCALE, (), "controller.p_gain"),
    )
    assert by_register.gain == pytest.approx(100 * by_wire.gain, abs=1.0)
    literal = model(controller__law=1, controller__i_gain=1, controller__i_shift=16)
    again = largest_gain(literal, SCALE, (), "controller.p_gain")
    assert by_register.gain - again.gain == pytest.approx(32767 / 2**16 * 2**8, abs=1.0)


GAIN = ROOT / "scenarios/hydraulic_gain"
OWN = P | {"controller.p_gain": 1200, "axis.start_position": 0.0}
QUICK = {
    "controller.timer_period": 2e-4,
    "controller.filter_time": 1e-4,
    "axis.valve_frequency": 5000.0,
    "axis.current_time": 2e-5,
}


@pytest.mark.parametrize("leakage", [0.0, 1e-12, 6e-12])
@pytest.mark.parametrize("quick", [True, False])
def test_largest_gain_by_its_phase(leakage: float, quick: bool) -> None:
    """Oil, mass, spool, coil, filter and a dead time, within 3 %; none of it needs the FMU."""
    more = QUICK if quick else {}
    given = OWN | more | {"axis.cylinder_leakage": leakage}
    axis = linear.model(GAIN, at=AT | {"axis.force": 0.0}, set=given)
    loop, low = axis.loop(SCALE), 0.05
    found = largest_gain(axis, SCALE)
    kp = abs(loop(np.exp(1j * low * loop.dt))) * low
    # At the middle, through an edge that is open for 50 mm/s.
    volume, drop = 5e-5 + AREA * 0.1, (SUPPLY - TANK) / 2
    edge = AREA * 0.05 / (2.0 * drop)
    oil = oil_and_mass((volume, volume), 100.0, leakage, 2.0 * LEAK_VALVE + edge, 1000.0)
    spool, coil, lag = (5000.0, 2e-5, 1e-4) if quick else (500.0, 2e-4, 2e-3)
    # Half a timer period, a PWM period, and an instant of the pins that its mean takes.
    dead = (2e-4 if quick else 1e-3) / 2 + 1e-4 + 1e-4
    gain, omega = theory_gain(oil, (spool, 0.8), (coil, lag), dead)
    assert kp * found.gain == pytest.approx(gain, rel=0.03)
    assert found.omega == pytest.approx(omega, rel=0.03)
    if quick and leakage == 0.0:
        assert gain == pytest.approx(2.0 * oil[0] * oil[1], rel=0.03)


def test_gain_of_the_loop_at_low_frequency() -> None:
    """Kp = counts/s per volt, times volts per PWM count, times p_gain/2^p_shift: the README's."""
    axis = model()
    loop, w = axis.loop(SCALE), 0.5
    has = abs(loop(np.exp(1j * w * loop.dt))) * w
    near = [model_at(v).points["axis"].values["voltage"] for v in (0.0499, 0.0501)]
    per_volt = 0.0002 / (near[1] - near[0]) / 5e-6
    assert has == pytest.approx(per_volt * 20.0 / 800.0 * 100 / 2**8, rel=1e-3)


def model_at(speed: float) -> linear.AxisModel:
    return linear.model(SCENARIO, at={**AT, "axis.table_speed": speed}, set=P)


def test_an_input_is_not_moved_faster_than_it_is_followed() -> None:
    """The edge rate at which the first count is lost: 57 and 457 clocks, README of the msp430."""
    assert fastest(model(), SCALE) == pytest.approx(0.8 * 8e6 / (6 + 5 + 51) / 4)
    axis = model(controller__timer_cycles=400)
    assert fastest(axis, SCALE) == pytest.approx(0.8 * 8e6 / 457 / 4)
    ring = largest_gain(axis, SCALE).omega
    assert usual_kick(axis, SCALE) * 4.0 * ring <= 1.001 * fastest(axis, SCALE)


def test_fmus_that_would_lose_edges_are_not_run() -> None:
    """50 mm/s are 10,000 counts/s, and ten times that with the gain at its limit on the wire."""
    (only,) = study(model(controller__timer_cycles=400), LoopStudyOptions())
    assert only.simulated is None and only.measured is None
    assert "faster than its FMU follows" in only.silent


@pytest.mark.parametrize(
    ("changed", "told"),
    [
        ({"controller.timer_period": 1.05e-3}, "no whole number of pin periods"),
        ({"controller.pwm_counts": 1234}, "no whole number of PWM periods"),
        (
            {
                "controller.timer_cycles": 7990,
                "controller.pwm_counts": 4000,
            },
            "after the next timer",
        ),
        ({"controller.pin_period": 5e-7}, "latency of an interrupt"),
    ],
)
def test_what_has_no_linear_model_is_refused(changed: dict[str, Any], told: str) -> None:
    with pytest.raises(InputError, match=told):
        linear.model(SCENARIO, at=AT, set=P | changed)


def test_the_command_at_a_moving_point(tmp_path) -> None:
    arguments = ["--at", "axis.table_speed=0.05", "--at", "axis.table_position=0"]
    arguments += ["--set", "controller.law=0", "--set", "axis.start_position=-0.02"]
    done = CliRunner().invoke(
        app, ["margins", str(SCENARIO), *arguments, "--out", str(tmp_path / "o")]
    )
    assert done.exit_code == 0, done.output
    page = (tmp_path / "o/report.html").read_text()
    assert "controller.scale_phase" in done.output and "Phase margin" in page
    axis = linear.model(SCENARIO, at={"axis.table_speed": 0.05}, set={"controller.law": 0})
    assert margins(axis.loop(SCALE)).stable


def test_the_literal_integral_is_its_worst_case(tmp_path) -> None:
    """The scenario's own law: unstable in the end, said so, and no FMU is made to ring."""
    done = CliRunner().invoke(
        app,
        ["margins", str(SCENARIO), "--at", "axis.table_speed=0.05", "--out", str(tmp_path / "o")],
    )
    assert done.exit_code == 0, done.output
    assert "unstable" in done.output
    assert "largest count" in (tmp_path / "o/report.html").read_text()
