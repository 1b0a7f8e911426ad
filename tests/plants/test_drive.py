"""The servo drives as an FMU: one period of delay, whatever the steps."""

import random
from typing import Any

import pytest
from fmi_tools import ERROR, OK, Instance

TICK = 25e-9
PERIOD = 4000  # [ticks] 100 us


def drives(fmi: int = 3, **values: Any) -> Instance:
    return Instance("servo_drives", fmi).initialize(values)


def to_tick(fmu: Instance, tick: int) -> None:
    """One step to `tick`; the time is counted, not added up."""
    now = round(fmu.time / TICK)
    fmu.time = now * TICK
    assert fmu.step((tick - now) * TICK) == OK, fmu.said
    fmu.time = tick * TICK


@pytest.mark.parametrize("period", [1e-4, 2.5e-5, 2e-4])
def test_any_split_into_steps_gives_the_same_bits(period: float) -> None:
    rng = random.Random(7)
    values = {
        "mode": [0, 1, 0, 1, 0, 1],
        "period": period,
        "error_limit": 0.02,
        "command_mean_time": [0.0, 4 * period, 0.0, 0.0, 0.0, 9 * period],
        "command_time": [0.0, 0.0, 0.0, 3e-3, 0.0, 3e-3],
        "rated_torque": [0.0, 0.0, 4.0, 0.0, 0.0, 0.0],
        "thermal_time": 1e-3,
        "brake_torque": [0.0, 0.0, 0.0, 0.0, 1.0, 0.0],
        "brake_close_time": 3 * period,
        "brake_hold_time": 2 * period,
        "active": [True, True, True, True, True, False],
    }
    whole, split = drives(**values), drives(**values)
    phase, pulses = [0.0] * 6, [0] * 6
    alarms = 0
    for k in range(200):
        phase = [p + rng.uniform(-30, 40) for p in phase]
        pulses = [p + rng.randint(-50, 60) for p in pulses]
        row = {
            "phase": phase,
            "pulse_count": pulses,
            "dac": [rng.uniform(-10, 10) for _ in range(6)],
            "enable": [rng.random() < 0.95 for _ in range(6)],
            "alarm_reset": [rng.random() < 0.2 for _ in range(6)],
        }
        for fmu in (whole, split):
            for name, value in row.items():
                assert fmu.set(name, value) == OK
        begin, end = k * PERIOD, (k + 1) * PERIOD
        to_tick(whole, end)
        for cut in [*sorted(rng.sample(range(begin + 1, end), rng.choice([0, 1, 4]))), end]:
            to_tick(split, cut)
        seen = whole.outputs()
        assert repr(seen) == repr(split.outputs()), f"instant {k}"
        assert [x[5] for x in seen.values()] == [0.0, 0.0, 0.0, 0.0, 0.0, False, False, 0]
        alarms += sum(seen["alarm"])
    assert alarms > 0
    whole.free()
    split.free()


@pytest.mark.parametrize("fmi", [2, 3])
def test_a_torque_stands_one_period_after_its_cause(fmi: int) -> None:
    fmu = drives(fmi, velocity_time=0.0, velocity_gain=0.1)
    to_tick(fmu, PERIOD)
    assert fmu.get("ready") == [True] * 6
    fmu.set("dac", 1.0)
    to_tick(fmu, PERIOD + 1)
    assert fmu.get("torque") == [0.0] * 6
    to_tick(fmu, 2 * PERIOD - 1)
    assert fmu.get("torque") == [0.0] * 6
    to_tick(fmu, 2 * PERIOD)
    assert fmu.get("torque") == pytest.approx([0.1 * 300 * 3.141592653589793 / 30] * 6, rel=1e-14)
    fmu.set("velocity_gain", 0.2)  # tunable while it runs
    to_tick(fmu, 3 * PERIOD)
    assert fmu.get("torque") == pytest.approx([0.2 * 300 * 3.141592653589793 / 30] * 6, rel=1e-14)
    fmu.free()


@pytest.mark.parametrize("fmi", [2, 3])
def test_a_gain_set_before_a_state_was_saved_counts_where_it_is_restored(fmi: int) -> None:
    fmu = drives(fmi, velocity_time=0.0, velocity_gain=0.1)
    fmu.set("dac", 1.0)
    to_tick(fmu, PERIOD)
    fmu.set("velocity_gain", 0.2)
    state, time = fmu.save(), fmu.time
    fmu.set("velocity_gain", 0.1)
    to_tick(fmu, 2 * PERIOD)
    assert fmu.restore(state, time) == OK
    to_tick(fmu, 3 * PERIOD)
    assert fmu.get("torque") == pytest.approx([0.2 * 300 * 3.141592653589793 / 30] * 6, rel=1e-14)
    fmu.free_state(state)
    fmu.free()


@pytest.mark.parametrize("fmi", [2, 3])
def test_an_encoder_that_is_unplugged_trips_its_drive_alone(fmi: int) -> None:
    fmu = drives(fmi)
    to_tick(fmu, PERIOD)
    fmu.set("encoder_unplugged", [False, True, False, False, False, False])  # while it runs
    to_tick(fmu, 3 * PERIOD)
    assert fmu.get("alarm") == [0, 4, 0, 0, 0, 0]
    assert fmu.get("ready") == [True, False, True, True, True, True]
    fmu.set("encoder_unplugged", False)
    to_tick(fmu, 5 * PERIOD)
    assert fmu.get("alarm") == [0, 4, 0, 0, 0, 0]
    fmu.set("alarm_reset", True)
    to_tick(fmu, 7 * PERIOD)
    assert fmu.get("alarm") == [0] * 6
    fmu.free()


def test_a_wrong_period_is_named() -> None:
    fmu = Instance("servo_drives", 3)
    assert fmu.set("period", 1.00003e-4) == OK
    fmu.enter()
    assert fmu.call("ExitInitializationMode") == ERROR
    assert any("period = 0.000100003" in text for _, _, text in fmu.messages), fmu.messages
    fmu.free()


def test_a_phase_beyond_all_counts_is_named() -> None:
    fmu = drives()
    fmu.set("phase", [0, 0, 0, -1e16, 0, 0])
    assert fmu.step(1e-4) == ERROR
    assert any("phase[4] = -1e+16" in text for _, _, text in fmu.messages), fmu.messages
    fmu.free()


def test_a_mean_over_too_many_samples_is_named() -> None:
    fmu = Instance("servo_drives", 3)
    assert fmu.set("command_mean_time", [0.0, 0.1, 0.1001, 0.0, 0.0, 0.0]) == OK
    fmu.enter()
    assert fmu.call("ExitInitializationMode") == ERROR
    said = "command_mean_time[3] = 0.1001 s: at most 1000 samples of 0.0001 s"
    assert any(said in text.replace("0.10009999999999999", "0.1001") for _, _, text in fmu.messages)
    fmu.free()


def test_a_motor_that_is_too_hot_trips() -> None:
    """300 % of the rated torque from cold, for -T ln(1 - (1.15/3)^2) = 0.1589 T."""
    fmu = drives(velocity_time=0.0, velocity_gain=0.1, rated_torque=1.0, thermal_time=1.0)
    volts = 3.0 / (0.1 * 300 * 3.141592653589793 / 30)
    fmu.set("dac", [0.0, volts, 0.0, 0.0, 0.0, 0.0])
    to_tick(fmu, 1580 * PERIOD)
    assert fmu.get("alarm") == [0] * 6
    assert fmu.get("load_ratio")[1] == pytest.approx(1.147, abs=1e-3)
    to_tick(fmu, 1600 * PERIOD)
    assert fmu.get("alarm") == [0, 3, 0, 0, 0, 0]
    fmu.free()
