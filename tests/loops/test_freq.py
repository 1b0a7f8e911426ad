"""Frequency responses of the running FMUs against the linear model.

Within 1 % of the magnitude and 1 degree, up to half the sampling rate.
"""

from typing import Any

import numpy as np
import pytest
from linear_rigs import DEMO, MODES, SMOOTH, THEORY, WIDE

from motionfmu import InputError
from motionfmu.analysis import freq, linear

ENC = "card.enc_phase"
N = 500  # samples of a period
LINES = np.unique(np.round(np.geomspace(1, N // 2 - 1, 40)).astype(int))
FINE = {"machine.encoder_lines": 2**20, "drives.encoder_lines": 2**20}
# kp of the card with FINE encoders: 50 1/s
SLOW_CARD = {"mcc.p_gain": 1, "card.p_scale": 7}
LAG = {"mcc.p_gain": 200, "machine.tau": 1e-3}
PULSES = {"drives.pulses_per_turn": 10**6}


def multisine(peak: float, settle: int = 8) -> freq.Excitation:
    return freq.multisine(N, LINES, peak, settle=settle, measure=2)


def test_a_multisine_goes_up_to_half_the_sampling_rate() -> None:
    for n in (8, 9):
        top = n // 2
        signal = freq.multisine(n, np.array([top]), 3.0).signal
        assert np.abs(signal).max() == pytest.approx(3.0)
        found = np.abs(np.fft.rfft(signal))
        assert np.delete(found, top) == pytest.approx(0.0, abs=1e-12) and found[top] > n
        for line in (0, top + 1):
            with pytest.raises(
                ValueError, match=f"lines of a period of {n} samples are 1 to {top}"
            ):
                freq.multisine(n, np.array([1, line]), 3.0)


def errors(
    setup: freq.Setup, response: freq.Response, late: dict[str, int] | None = None
) -> tuple[float, float]:
    """Largest differences of magnitude [%] and phase [deg] from the linear model."""
    system = setup.axis.system(setup.inputs, setup.outputs, setup.cut, late)
    assert system.dt == pytest.approx(response.period)
    expected = system(np.exp(1j * response.omega * system.dt), squeeze=False)[:, 0, :].T
    ratio = response.values / expected
    return 100.0 * np.abs(np.abs(ratio) - 1.0).max(), np.degrees(np.abs(np.angle(ratio)).max())


CASES: list[Any] = [
    # velocity_axes: alone, with its lag, and in the card's loop
    (THEORY, 1, {"machine.tau": 0.0}, "machine.voltage", ["motor_speed", "table_position"], 5.0),
    (THEORY, 1, LAG, "machine.voltage", ["motor_speed", "motor_phase", "table_phase"], 5.0),
    (THEORY, 2, LAG, ENC, ["motor_speed", "table_position"], 1500.0),
    # servo_drives in velocity mode, with ball_screw_axes
    (MODES, 2, {}, "drives.dac", ["motor_speed", "table_speed", "screw_force"], 5.0),
    (MODES, 2, {"drives.velocity_time": 0.0}, "drives.dac", ["motor_speed", "table_speed"], 5.0),
    (MODES, 2, {}, "drives.phase", ["motor_phase", "motor_torque"], 5.0),
    (MODES, 2, {}, "machine.torque_command", ["motor_speed", "table_speed"], 5.0),
    (MODES, 2, {}, "machine.force", ["table_position", "motor_angle"], 500.0),
    # servo_drives in position mode
    (MODES, 1, PULSES, "drives.pulse_count", ["motor_speed", "table_speed"], 1e6),
    (MODES, 1, PULSES | {"drives.feed_forward": 0.7}, "drives.pulse_count", ["motor_speed"], 1e6),
    # the whole chain through the card
    (MODES, 2, FINE | SLOW_CARD, ENC, ["motor_phase", "motor_torque"], 20_000.0),
]


@pytest.mark.parametrize("case", CASES, ids=lambda c: f"{c[0].name}-{c[1]}-{c[3]}")
def test_linear_model_is_what_the_fmus_do(case: tuple[Any, ...]) -> None:
    scenario, axis, set_, at, outputs, peak = case
    wide = {} if scenario == THEORY else WIDE | SMOOTH
    model = linear.model(scenario, axis, set=wide | set_)
    cut = () if at in (ENC, "drives.phase", "drives.pulse_count") else (at,)
    cut = (*cut, "drives.dac") if scenario == MODES and at != ENC and axis == 2 else cut
    setup = freq.setup(model, at, [f"machine.{o}" for o in outputs], cut)
    slow = at == "drives.pulse_count"  # the position loop settles in 20 ms
    size, angle = errors(setup, freq.measure(setup, multisine(peak, 16 if slow else 8)))
    assert size < 1.0 and angle < 1.0


@pytest.mark.parametrize("tau", [1e-3, 1.5e-5, 5e-6])
def test_the_integrator_itself_is_in_the_model(tau: float) -> None:
    """The micro-grid of 25 us is coarse for these lags, the last one gets sub-steps: 12 digits."""
    model = linear.model(THEORY, set={"machine.tau": tau})
    setup = freq.setup(model, "machine.voltage", "machine.motor_speed", "machine.voltage")
    assert max(errors(setup, freq.measure(setup, multisine(5.0)))) < 1e-9


@pytest.mark.parametrize("out", ["torque", "speed", "speed_command", "following_error"])
def test_position_mode_inside_the_drive(out: str) -> None:
    model = linear.model(MODES, 1, set=WIDE | SMOOTH | PULSES)
    setup = freq.setup(model, "drives.pulse_count", f"drives.{out}")
    size, angle = errors(setup, freq.measure(setup, multisine(1e6)))
    assert size < 1.0 and angle < 1.0


def test_one_sample_of_delay_too_many_is_seen() -> None:
    fast = LAG | {"mcc.p_gain": 2000}
    setup = freq.setup(linear.model(THEORY, set=fast), ENC, "machine.motor_speed")
    response = freq.measure(setup, multisine(100.0))
    assert max(errors(setup, response)) < 1.0
    assert min(errors(setup, response, {ENC: 1})) > 1.0
    late = freq.Setup(*(setup.axis, setup.inputs, setup.outputs), delays={ENC: 1})
    response = freq.measure(late, multisine(100.0))
    assert max(errors(setup, response, {ENC: 1})) < 1.0


def test_unequal_periods() -> None:
    """The card at 200 us, the drive at 100 us, the step at 50 us."""
    periods = {"card.loop_period": 2e-4, "drives.velocity_gain": 0.8}
    model = linear.model(MODES, 2, set=WIDE | SMOOTH | FINE | SLOW_CARD | periods)
    setup = freq.setup(model, ENC, "machine.motor_phase")
    response = freq.measure(setup, multisine(20_000.0, settle=4))
    assert response.period == pytest.approx(2e-4)
    assert max(errors(setup, response)) < 1.0


def test_prbs_and_single_sines_agree_with_the_multisine() -> None:
    setup = freq.setup(linear.model(THEORY, set=LAG), ENC, "machine.motor_speed")
    assert max(errors(setup, freq.measure(setup, freq.prbs(9, 1500.0, settle=6)))) < 1.0
    held = freq.measure(setup, freq.prbs(6, 1500.0, hold=4, settle=12))
    assert max(errors(setup, held)) < 1.0 and held.omega.max() < 0.5 * np.pi / held.period
    shares: list[float] = []
    sines = freq.sweep(setup, [300.0, 3000.0, 12_000.0], 500.0, cycles=40, progress=shares.append)
    assert max(errors(setup, sines)) < 1.0 and shares[-1] == 1.0


def test_open_loop_measured_with_the_loop_closed() -> None:
    model = linear.model(MODES, 2, set=WIDE | SMOOTH)
    setup = freq.setup(model, "drives.phase", (), "drives.dac")
    found = freq.measured_loop(setup, multisine(5.0))
    loop = model.loop("drives.phase", "drives.dac")
    ratio = found.values[:, 0] / loop(np.exp(1j * found.omega * found.period))
    assert np.abs(ratio - 1.0).max() < 0.01


def test_friction_at_a_stated_speed_and_load() -> None:
    """A ramp moves the FMUs at the speed at which the friction was linearised."""
    at = {"machine.table_speed": 0.03, "machine.force": 100.0}
    heavy = {"machine.motor_viscous": 0.02, "machine.table_viscous": 3000.0}
    model = linear.model(DEMO, 1, at=at, set=heavy | FINE | SLOW_CARD)
    setup = freq.setup(model, ENC, "machine.motor_phase")
    lines = np.array([1, 2, 3, 5, 8, 13, 21])
    response = freq.measure(setup, freq.multisine(1000, lines, 10_000.0, settle=5))
    assert max(errors(setup, response)) < 1.0
    still = freq.setup(linear.model(DEMO, 1, set=heavy | FINE | SLOW_CARD), ENC, setup.outputs)
    assert max(errors(still, response)) > 1.0  # stiction is another slope


def test_signals_are_flat_and_of_maximum_length() -> None:
    chosen = freq.multisine(400, np.arange(1, 100), 2.0)
    assert np.abs(chosen.signal).max() == pytest.approx(2.0)
    size = np.abs(np.fft.rfft(chosen.signal))
    assert np.ptp(size[1:100]) < 1e-9 * size.max() and size[100:].max() < 1e-9 * size.max()
    assert np.abs(chosen.signal).max() / chosen.signal.std() < 2.0  # crest factor; in phase: 14
    for order in (5, 6, 7, 9, 10, 11, 15):
        s = freq.prbs(order, 1.0).signal
        n = 2**order - 1
        shifted = np.fft.irfft(np.abs(np.fft.rfft(s)) ** 2, n)
        assert shifted[0] == pytest.approx(n) and shifted[1:] == pytest.approx(-np.ones(n - 1))


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (lambda m: freq.measure(freq.setup(m, "card.pulses", "card.dac"), multisine(1)), "inside"),
        (lambda m: freq.measured_loop(freq.setup(m, "machine.force", ()), multisine(1)), "no wire"),
        (lambda m: freq.measure(freq.setup(m, ENC, "card.dc"), multisine(1)), "card.dc is no out"),
        (lambda m: freq.prbs(8, 1.0), "order = 8"),
        (lambda m: freq.multisine(100, np.array([51]), 1.0), "1 to 50"),
    ],
)
def test_a_wrong_measurement_is_named(call, told: str) -> None:
    with pytest.raises((InputError, ValueError)) as caught:
        call(linear.model(DEMO))
    assert told in str(caught.value)
