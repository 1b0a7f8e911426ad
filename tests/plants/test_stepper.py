"""The stepping motor: its torque law, pendulum, pull-out and lost steps against closed forms.

p teeth, T torque at rest, J inertia, a = p tau w, b = w / emf_speed. The six axes of a run are six
values side by side.
"""

import math

import numpy as np
import pytest
from plant_library import ROOT, Library, Run
from scipy.integrate import solve_ivp
from scipy.special import ellipk

P, HOLD, TAU, EMF, LEAD = 50, 1.2, 2e-4, 110.0, 0.005
RATIO = LEAD / (2 * math.pi)
INERTIA = 3e-5 + 1e-5 + 5 * RATIO**2
FREE = dict.fromkeys(("motor_coulomb", "motor_viscous", "table_coulomb", "table_viscous"), 0.0)
IDEAL = {**FREE, "winding_time": 1e-5, "emf_speed": 1e12}
FINE = 4_000_000  # pulses per turn
SWING = math.sqrt(P * HOLD / INERTIA)  # [rad/s] of small oscillations
STEP = 1e-4  # [s]


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    return Library(
        ROOT / "fmus/stepper_axes/fmu.toml", tmp_path_factory.mktemp("stepper"), built=True
    )


def started(library, **values):
    run = Run(library, **values)
    assert run.start() == 0, run.said
    return run


def swing(run, seconds):
    """Following error of each axis at every STEP."""
    found = []
    for _ in range(round(seconds / STEP)):
        assert run.step(STEP) == 0, run.said
        found.append(run.get("following_error"))
    return np.array(found)


def periods(error):
    """Mean period of each column, from its upward crossings of zero."""
    found = []
    for column in error.T:
        k = np.flatnonzero((column[:-1] < 0) & (column[1:] >= 0))
        at = (k + column[k] / (column[k] - column[k + 1])) * STEP
        assert len(at) > 10
        found.append((at[-1] - at[0]) / (len(at) - 1))
    return np.array(found)


def test_swings_like_a_pendulum(library):
    """Small ones at sqrt(p T / J) / 2 pi, large ones slower by the elliptic integral."""
    steps = np.array([0.01, 0.02, 0.5, 1.0, 1.5, 1.9])
    run = started(library, **IDEAL, pulses_per_turn=FINE)
    run.set(pulse_count=np.rint(steps * FINE / 200).astype(int))
    found = periods(swing(run, 0.15))
    amplitude = steps * math.pi / 2  # electric
    assert found[:2] == pytest.approx(2 * math.pi / SWING, rel=2e-4)
    assert found == pytest.approx(4 * ellipk(np.sin(amplitude / 2) ** 2) / SWING, rel=2e-4)
    print(f"{1 / found[0]:.2f} Hz, {SWING / 2 / math.pi:.2f} by theory")


def test_small_swings_follow_teeth_torque_and_inertia(library):
    values = {
        "rotor_teeth": [50, 100, 50, 50, 50, 25],
        "holding_torque": [1.2, 1.2, 0.3, 1.2, 1.2, 2.0],
        "rotor_inertia": [3e-5, 3e-5, 3e-5, 3e-4, 3e-5, 1e-5],
        "table_mass": [5.0, 5.0, 5.0, 5.0, 40.0, 0.0],
    }
    run = started(library, **IDEAL, **values, pulses_per_turn=FINE)
    run.set(pulse_count=100)
    p, torque, rotor, mass = (np.array(v) for v in values.values())
    theory = 2 * math.pi / np.sqrt(p * torque / (rotor + 1e-5 + mass * RATIO**2))
    assert periods(swing(run, 0.4)) == pytest.approx(theory, rel=3e-4)


def test_held_torque_is_the_sine_of_the_lag(library):
    """Up to the holding torque; above it the motor slips by steps that are multiples of 4."""
    share = np.array([-0.9, 0.2, 0.5, 0.8, 0.99, 1.01])
    run = started(library, **{**FREE, "motor_viscous": 0.02})
    for part in np.linspace(0, 1, 201):
        run.set(force=-share * part * HOLD / RATIO)
        assert run.step(2e-3) == 0
    for _ in range(200):
        assert run.step(1e-3) == 0
    error = run.get("following_error")
    assert error[:5] * math.pi / 2 == pytest.approx(np.arcsin(share[:5]), abs=1e-3)
    assert run.get("motor_torque")[:5] == pytest.approx(HOLD * share[:5], rel=1e-4)
    lost = run.get("lost_steps")
    assert not lost[:5].any() and lost[5] > 4 and lost[5] % 4 == 0
    assert run.get("torque_margin")[:5] == pytest.approx(HOLD * (1 - np.abs(share[:5])), abs=1e-3)


def limit_of_start(load):
    """Field speed [rad/s electric] that a free motor just follows at once: energy up to the saddle.

    d'' = -SWING^2 (sin d - load): from rest at sin d = load up to pi - d with speed 0.
    """
    d = math.asin(load)
    return SWING * math.sqrt(2 * (2 * math.cos(d) - (math.pi - 2 * d) * load))


def follow(run, angle, seconds, every=25e-6):
    """Pulses of a motor angle [rad] at a time [s]; steps lost at the end."""
    for k in range(round(seconds / every)):
        pulses = np.broadcast_to(angle((k + 0.5) * every), 6) * (FINE / (2 * math.pi))
        run.set(pulse_count=np.rint(pulses).astype(int))
        assert run.step(every) == 0, run.said
    return run.get("lost_steps")


@pytest.mark.parametrize("load", [0.0, 0.3])
def test_instantaneous_start_up_to_the_energy_of_the_saddle(library, load):
    share = np.array([0.5, 0.9, 0.99, 1.01, 1.1, 1.5])
    run = started(library, **IDEAL, pulses_per_turn=FINE)
    for k in range(1, 1001):  # so slowly that nothing swings
        run.set(force=-load * HOLD / RATIO * 0.5 * (1 - math.cos(math.pi * k / 1000)))
        assert run.step(5e-4) == 0
    speed = share * limit_of_start(load) / P  # [rad/s]
    lost = follow(run, lambda t: speed * t, 0.05)
    assert (lost[:3] == 0).all() and (lost[3:] > 0).all() and (lost % 4 == 0).all(), lost
    if load == 0.0:
        print(f"start and stop at {limit_of_start(0) / (math.pi / 2):.0f} full steps/s")


def pull_out(speed):
    """Largest torque of a motor that turns evenly."""
    a, b = P * TAU * speed, speed / EMF
    return HOLD * (math.sqrt(1 + a * a) - b) / (1 + a * a)


@pytest.mark.parametrize("speed", [20.0, 60.0, 100.0])
def test_turns_evenly_up_to_the_pull_out_torque(library, speed):
    share = np.array([0.2, 0.8, 0.97, 1.03, 1.1, 1.3])
    run = started(library, **FREE, pulses_per_turn=FINE)
    rise = 0.1  # [s] to the speed, evenly accelerated
    follow(run, lambda t: speed * t * t / (2 * rise), rise)
    margin = []

    def on(t):
        run.set(force=-share * pull_out(speed) / RATIO * min(1.0, t / 0.15))
        margin.append(run.get("torque_margin"))
        return speed * (rise / 2 + t)

    lost = follow(run, on, 0.25)
    assert (lost[:3] == 0).all() and (lost[3:] > 0).all(), lost
    held = np.mean(margin[-2000:], axis=0)[:3]  # 50 ms: a motor near its limit swings a little
    assert held == pytest.approx(pull_out(speed) * (1 - share[:3]), abs=0.01)
    print(f"{speed} rad/s: {pull_out(speed):.3f} N.m")


def test_a_step_of_speed_loses_fours_and_a_ramp_loses_none(library):
    """What a pause that stops the pulses at once does to a machine, and a ramp does not."""
    rise = np.array([1e-9, 1e-3, 5e-3, 0.05, 0.1, 0.1])  # [s] to the speed and from it
    speed = np.array([94.2, 94.2, 94.2, 94.2, 94.2, 15.0])  # [rad/s]; 94.2: 3000 full steps/s
    even = 0.1

    def angle(t):
        up, down = np.clip(t, 0, rise), np.clip(t - rise - even, 0, rise)
        return speed * (
            up**2 / (2 * rise) + np.clip(t - rise, 0, even) + down - down**2 / (2 * rise)
        )

    run = started(library, pulses_per_turn=FINE)
    lost = follow(run, angle, 0.4)
    error = run.get("following_error")
    print(f"lost {lost}, table {1e3 * run.get('table_position')} mm")
    assert (lost[:3] > 0).all() and (lost[:3] % 4 == 0).all() and not lost[3:].any()
    assert np.abs(error - lost).max() < 0.05  # but for what friction holds
    table = (angle(0.4) - error * 2 * math.pi / 200) * RATIO
    assert run.get("table_position") == pytest.approx(table, abs=1e-8)


def by_hand(t, x, field, on, force):
    """The equations once more."""
    angle, speed, i_a, i_b = x
    friction = 0.02 + RATIO * 5
    viscous = 2e-4 + 20 * RATIO**2
    torque = HOLD * (i_b * math.cos(P * angle) - i_a * math.sin(P * angle))
    torque -= 0.05 * math.sin(4 * P * angle)
    lost = friction * speed / math.hypot(speed, 0.05) + viscous * speed
    return (
        speed,
        (torque + RATIO * force - lost) / INERTIA,
        (on * (math.cos(P * field) + speed / EMF * math.sin(P * angle)) - i_a) / TAU,
        (on * (math.sin(P * field) - speed / EMF * math.cos(P * angle)) - i_b) / TAU,
    )


# Until [s], pulses of 3200 a turn, current, force [N]: a step, 2.5 at once, back, pushed, let go.
PIECES = (
    (0.01, 16, True, 0.0),
    (0.02, 56, True, 0.0),
    (0.03, -70, True, 0.0),
    (0.04, -70, True, 300.0),
    (0.05, -70, False, 300.0),
    (0.06, -70, True, -100.0),
)


def test_trajectory_against_another_solver(library):
    x, t0 = np.array([0.0, 0.0, 1.0, 0.0]), 0.0
    run = started(library, detent_torque=0.05, micro_step=2e-6)
    turns = []
    for t1, pulses, on, force in PIECES:
        field = 2 * math.pi * pulses / 3200
        found = solve_ivp(
            by_hand, (t0, t1), x, "DOP853", args=(field, on, force), rtol=1e-10, atol=1e-12
        )
        x, t0 = found.y[:, -1], t1
        run.set(pulse_count=pulses, enable=on, force=force)
        while run.now < round(t1 * 1e9):
            assert run.step(1e-3) == 0
        assert run.get("motor_angle")[0] == pytest.approx(x[0], abs=2e-8)
        assert run.get("motor_speed")[0] == pytest.approx(x[1], abs=2e-5)
        turns.append(x[0])
    assert max(turns) - min(turns) > 0.1


def test_without_current_it_turns_freely_and_switches_tell_where(library):
    run = started(library, **FREE, start_position=[-0.5, -0.45, -0.449, 0.0, 0.499, 0.5])
    assert run.get("home_switch").tolist() == [True, True, False, False, False, False]
    assert run.get("lower_limit").tolist() == [True] + [False] * 5
    assert run.get("upper_limit").tolist() == [False] * 5 + [True]
    run.set(enable=False, force=10.0)
    assert run.step(0.1) == 0
    mass = INERTIA / RATIO**2
    # the current goes in 0.2 ms, in which it still holds
    assert run.get("table_speed") == pytest.approx(10.0 / mass * 0.1, rel=0.02)
    assert run.get("motor_torque") == pytest.approx(0.0, abs=1e-9)
