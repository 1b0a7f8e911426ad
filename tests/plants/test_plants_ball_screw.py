"""The ball-screw axis in C: against other solvers, and against closed forms."""

import casadi as ca
import numpy as np
import pytest
import rumoca
from plant_library import PACKAGE, ROOT, Library, Run
from scipy.integrate import solve_ivp

from motionfmu.fmu.modelica import causal

FRICTIONLESS = {
    f"{side}_{kind}": 0.0
    for side in ("motor", "table")
    for kind in ("coulomb", "static", "viscous")
}
SHOWN = ("motor_torque", "motor_angle", "motor_speed", "table_position", "table_speed")


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    return Library(
        ROOT / "fmus/ball_screw_axes/fmu.toml", tmp_path_factory.mktemp("ball_screw"), built=True
    )


@pytest.fixture(scope="module")
def ode():
    return causal.load(PACKAGE, "MotionControl.BallScrewAxis")


def shown(run, axis=0):
    return np.array([run.get(name)[axis] for name in SHOWN])


# Torque steps, an external force, reversal through friction and backlash, then motor off to rest.
PIECES = ((0.02, 2.0, 0.0), (0.04, 2.0, 30.0), (0.09, -2.0, 30.0), (0.12, 0.0, 0.0))


def radau(ode, p, pieces):
    f = ode.function()
    jacobian = ca.Function("J", [ode.x, ode.u, ode.p], [ca.jacobian(ode.xdot, ode.x)])
    x, t0, found = ode.initial(p), 0.0, []
    for t1, *u in pieces:
        s = solve_ivp(
            lambda t, x, u=u: np.array(f(x, u, p)[0]).ravel(),
            (t0, t1),
            x,
            method="Radau",
            rtol=1e-9,
            atol=1e-12,
            jac=lambda t, x, u=u: np.array(jacobian(x, u, p)),
        )
        x, t0 = s.y[:, -1], t1
        found.append(x)
    return np.array(found)


@pytest.fixture(scope="module")
def exact(ode):
    return radau(ode, ode.values(backlash=1e-5), PIECES)


def drive(run, pieces):
    assert run.start() == 0, run.said
    found, t0 = [], 0.0
    for t1, torque, force in pieces:
        run.set(torque_command=torque, force=force)
        for _ in range(round((t1 - t0) / 1e-3)):
            assert run.step(1e-3) == 0, run.said
        found.append(shown(run))
        t0 = t1
    return np.array(found)


def test_trajectory_against_radau(library, exact):
    ours = drive(Run(library, backlash=1e-5), PIECES)
    # torque N.m, angle rad, speed rad/s, position m, speed m/s: 25 us steps through the contacts
    bound = np.array([1e-12, 5e-6, 3e-4, 1e-8, 3e-6])
    assert np.all(np.abs(ours - exact) < bound), np.abs(ours - exact).max(axis=0)
    assert np.ptp(exact[:, 2]) > 30.0, "the motor must have reversed"


FRICTION = ("table_coulomb", "table_static", "table_viscous", "motor_coulomb", "motor_static")


def test_friction_that_changes_in_a_run_against_radau(library, ode):
    """Doubled on one axis while it moves: from there on the trajectory of the other parameters."""
    before = ode.values(backlash=1e-5)
    twice = {d.name: 2.0 * v for d, v in zip(ode.parameters, before, strict=True)}
    after = ode.values(backlash=1e-5, **{n: twice[n] for n in FRICTION})
    x, t0 = ode.initial(before), 0.0
    f = ode.function()
    for t1, p in ((0.04, before), (0.08, after)):
        s = solve_ivp(
            lambda t, x, p=p: np.array(f(x, [2.0, 30.0], p)[0]).ravel(),
            (t0, t1),
            x,
            method="Radau",
            rtol=1e-9,
            atol=1e-12,
        )
        x, t0 = s.y[:, -1], t1
    run = Run(library, backlash=1e-5)
    assert run.start() == 0, run.said
    run.set(torque_command=2.0, force=30.0)
    for k in range(80):
        if k == 40:
            for name in FRICTION:
                run.set(**{name: [twice[name]] + [twice[name] / 2.0] * 5})
        assert run.step(1e-3) == 0, run.said
    bound = np.array([1e-12, 5e-6, 3e-4, 1e-8, 3e-6])
    assert np.all(np.abs(shown(run) - x) < bound), np.abs(shown(run) - x)
    same = drive(Run(library, backlash=1e-5), ((0.08, 2.0, 30.0),))[0]
    assert np.all(shown(run, 1) == same), "the other axes go on as before"
    assert shown(run)[4] < same[4] - 1e-3, "more friction, less speed"


def test_what_is_tuned_is_checked_and_may_need_shorter_steps(library):
    run = Run(library)
    assert run.start() == 0
    run.set(torque_command=2.0)
    assert run.step(1e-3) == 0
    run.set(table_static=[70.0, 70.0, 40.0, 70.0, 70.0, 70.0])
    assert run.step(1e-3) == -1
    assert run.said == "axis 3: table_static must not be below table_coulomb"
    run.set(table_static=[70.0, 70.0, 7e7, 70.0, 70.0, 70.0])
    assert run.step(1e-3) == -1
    assert "axis 3: too stiff" in run.said and "more than 1000" in run.said
    # A hundred times the friction, smoothed over the same speed, is a hundred times as steep.
    run.set(table_static=7000.0, table_coulomb=5000.0)
    for _ in range(400):
        assert run.step(1e-3) == 0, run.said
    assert np.all(np.abs(run.get("table_speed")) < 2e-5), "at rest but for creep"


def test_trajectory_converges_to_radau(library, exact):
    errors = []
    for micro_step in (25e-6, 1e-6):
        ours = drive(Run(library, backlash=1e-5, micro_step=micro_step), PIECES)
        errors.append(np.abs(ours - exact).max(axis=0))
    assert np.all(errors[1][1:] < np.array([1e-7, 1e-6, 1e-10, 1e-8])), errors
    assert np.all(errors[1][1:] < errors[0][1:])


def test_trajectory_against_the_simulator_of_rumoca(library):
    def pulse(values):
        *early, last = zip((piece[0] for piece in PIECES), values, strict=True)
        chain = " elseif ".join(f"time < {t} then {v}" for t, v in early)
        return f"if {chain} else {last[1]}"

    text = (
        "model T MotionControl.BallScrewAxis a(backlash = 1e-5); equation "
        f"a.torque_command = {pulse([p[1] for p in PIECES])}; "
        f"a.force = {pulse([p[2] for p in PIECES])}; end T;"
    )
    model = rumoca.Session(roots=[str(PACKAGE)]).loads(text, model="T")
    config = rumoca.SimConfig(solver="rk-like", rtol=1e-8, atol=1e-11)
    result = model.simulate((0.0, PIECES[-1][0]), dt=1e-3, config=config)
    reference = np.array([result[f"a.{name}"][-1] for name in SHOWN])
    ours = drive(Run(library, backlash=1e-5), PIECES)[-1]
    assert np.all(np.abs(ours - reference) < [1e-9, 3e-5, 5e-4, 5e-8, 2e-6]), ours - reference


def test_static_wind_up_is_force_over_stiffness(library):
    k, force, lead = 5e7, 400.0, 0.02
    run = Run(library, **FRICTIONLESS, screw_stiffness=k, lead=lead, screw_damping=5e4)
    assert run.start() == 0
    run.set(torque_command=force * lead / (2 * np.pi), force=-force)
    for _ in range(200):
        run.step(1e-3)
    wind_up = run.get("motor_angle") * lead / (2 * np.pi) - run.get("table_position")
    assert wind_up == pytest.approx(np.full(6, force / k), rel=1e-6)
    assert run.get("screw_force") == pytest.approx(np.full(6, force), rel=1e-6)


def test_lead_error_shifts_the_table_and_nothing_else(library):
    slope, amplitude, period = 1e-4, 8e-6, 0.013
    errors = {"slope": slope, "amplitude": amplitude, "period": period}
    with_error = Run(library, **{f"lead_error_{k}": v for k, v in errors.items()})
    exact = Run(library)
    for run in (with_error, exact):
        assert run.start() == 0
        run.set(torque_command=2.0)
    for _ in range(300):
        for run in (with_error, exact):
            run.step(1e-3)
        s, v = exact.get("table_position"), exact.get("table_speed")
        shift = slope * s + amplitude * np.sin(2 * np.pi * s / period)
        turn = slope + amplitude * 2 * np.pi / period * np.cos(2 * np.pi * s / period)
        assert with_error.get("table_position") == pytest.approx(s + shift, abs=1e-15)
        assert with_error.get("table_phase") == pytest.approx((s + shift) / 2e-5, rel=1e-12)
        assert with_error.get("table_speed") == pytest.approx(v * (1 + turn), rel=1e-12)
        assert np.array_equal(with_error.get("motor_angle"), exact.get("motor_angle"))
    assert s[0] > 0.05


def test_lost_motion_is_the_backlash(library):
    """Push from either side against the standing table: the motor finds the gap."""
    backlash, push, lead = 4e-5, 20.0, 0.01
    run = Run(library, backlash=backlash, motor_coulomb=0.0, motor_static=0.0, motor_viscous=0.05)
    assert run.start() == 0
    ends = []
    for sign in (1.0, -1.0):
        run.set(torque_command=sign * push * lead / (2 * np.pi))  # below the table's 70 N
        for _ in range(300):
            run.step(1e-3)
        gap = run.get("motor_angle") * lead / (2 * np.pi) - run.get("table_position")
        ends.append(gap - sign * push / 1e8)
    assert ends[0] - ends[1] == pytest.approx(np.full(6, backlash), rel=1e-3)


def test_steady_speed_balances_friction(library):
    run = Run(library, motor_viscous=0.05, table_viscous=2000.0)
    assert run.start() == 0
    run.set(torque_command=1.5, force=-10.0)
    for _ in range(3000):
        run.step(1e-3)
    w, ratio = run.get("motor_speed")[0], 0.01 / (2 * np.pi)

    def friction(v, coulomb, static, stribeck, viscous):
        return coulomb + (static - coulomb) / (1 + (v / stribeck) ** 2) + viscous * v

    load = friction(w * ratio, 50.0, 70.0, 2e-3, 2000.0) + 10.0
    assert friction(w, 0.15, 0.2, 1.0, 0.05) + load * ratio == pytest.approx(1.5, rel=1e-6)
    assert 15.0 < w < 27.0
    assert run.get("table_speed")[0] == pytest.approx(w * ratio, rel=1e-6)


def test_creep_below_break_away_is_what_the_regularisation_says(library):
    load, static, v_rest = 35.0, 70.0, 2e-5
    run = Run(library, motor_coulomb=0.0, motor_static=0.0, motor_viscous=0.0, motor_inertia=1e-6)
    assert run.start() == 0
    run.set(force=load)
    for _ in range(500):
        run.step(1e-3)
    creep = v_rest * load / np.sqrt(static**2 - load**2)
    assert run.get("table_speed")[0] == pytest.approx(creep, rel=1e-3)


def test_energy_is_conserved_without_losses(library):
    k, lead, inertia, mass = 1e8, 0.01, 2e-3, 100.0
    run = Run(library, **FRICTIONLESS, screw_damping=0.0, start_position=0.0)
    assert run.start() == 0
    run.set(torque_command=5.0)
    run.step(5e-3)
    run.set(torque_command=0.0)
    run.step(20e-3)  # forty time constants of the current loop

    def energy():
        _, angle, w, s, v = shown(run)
        stretch = angle * lead / (2 * np.pi) - s
        return 0.5 * (inertia * w**2 + mass * v**2 + k * stretch**2)

    before, highest = energy(), 0.0
    for _ in range(200):
        run.step(1e-4)
        highest = max(highest, abs(energy() - before))
    assert before > 0.1
    assert highest < 1e-6 * before


def test_two_mass_frequency(library):
    """Period of the free vibration: sqrt(k (1/m1 + 1/m2)), m1 the reflected motor inertia."""
    run = Run(library, **FRICTIONLESS, screw_damping=0.0)
    assert run.start() == 0
    run.set(torque_command=5.0)
    run.step(1e-2)
    run.set(torque_command=0.0)
    run.step(2e-2)
    force = []
    for _ in range(8000):
        run.step(25e-6)
        force.append(run.get("screw_force")[0])
    signs = np.nonzero(np.diff(np.sign(force)))[0]
    force = np.array(force)
    crossings = signs - force[signs] / (force[signs + 1] - force[signs])
    period = 2 * 25e-6 * (crossings[-1] - crossings[0]) / (len(crossings) - 1)
    m1 = 2e-3 * (2 * np.pi / 0.01) ** 2
    assert 2 * np.pi / period == pytest.approx(np.sqrt(1e8 * (1 / m1 + 1 / 100.0)), rel=1e-5)


def test_switches_index_and_scales(library):
    start = np.array([0.0, -0.46, -0.51, 0.51, 0.0025, 0.3])
    run = Run(library, start_position=start)
    assert run.start() == 0
    assert run.get("home_switch").tolist() == [False, True, True, False, False, False]
    assert run.get("lower_limit").tolist() == [False, False, True, False, False, False]
    assert run.get("upper_limit").tolist() == [False, False, False, True, False, False]
    assert run.get("index").tolist() == [True, True, True, True, False, True]
    assert run.get("table_position") == pytest.approx(start, abs=0)
    assert run.get("table_phase") == pytest.approx(start / 2e-5, rel=1e-14)
    assert run.get("motor_phase") == pytest.approx(2500 * start / 0.01, rel=1e-14)


def test_index_is_one_line_period_wide(library):
    lines = 2500
    offsets = np.array([0.49, 0.51, -0.49, -0.51, lines + 0.49, lines / 2])
    run = Run(library, start_position=offsets / lines * 0.01)
    assert run.start() == 0
    assert run.get("index").tolist() == [True, False, True, False, True, False]
