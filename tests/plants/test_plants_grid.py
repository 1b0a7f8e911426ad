"""The plants' time grid, sub-steps, axes side by side, and what is refused."""

import ctypes
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from plant_library import PACKAGE, ROOT, Library, Run, array

from motionfmu.fmu.modelica import causal

HORIZON = 1000_000  # [ns]
INSIDE = st.integers(1, HORIZON // 25 - 1)  # [25 ns]
ON_GRID = st.integers(1, HORIZON // 25_000 - 1).map(lambda k: 1000 * k)


@pytest.fixture(scope="module")
def ball_screw(tmp_path_factory):
    return Library(
        ROOT / "fmus/ball_screw_axes/fmu.toml", tmp_path_factory.mktemp("ball_screw"), built=True
    )


@pytest.fixture(scope="module")
def velocity(tmp_path_factory):
    return Library(
        ROOT / "fmus/velocity_axes/fmu.toml", tmp_path_factory.mktemp("velocity"), built=True
    )


def outputs(run):
    names = [v.name for v in run.library.description.variables if v.causality == "output"]
    return b"".join(run.get(n).tobytes() for n in names)


@settings(max_examples=40)
@given(
    cuts=st.sets(INSIDE | ON_GRID, max_size=30),
    switch=INSIDE | ON_GRID,
    backlash=st.sampled_from([0.0, 2e-6]),
)
def test_any_split_gives_the_same_bits(ball_screw, cuts, switch, backlash):
    """One input change at any tick; all other communication points are arbitrary."""

    def run(points):
        r = Run(ball_screw, backlash=backlash)
        assert r.start() == 0
        r.set(torque_command=3.0)
        seen = {}
        for tick in sorted({*points, switch, HORIZON // 25}):
            assert r.step((25 * tick - r.now) * 1e-9) == 0
            seen[tick] = outputs(r)
            if tick == switch:
                r.set(torque_command=-3.0, force=20.0)
        return seen

    fine, coarse = run(cuts), run(())
    assert all(fine[tick] == coarse[tick] for tick in coarse)


def test_inputs_are_read_and_states_shown_on_the_grid(velocity):
    """With tau = 0 one micro step moves the motor by speed * h, whoever looks between."""
    h, gain = 25e-6, 300.0 * 2 * np.pi / 60
    r = Run(velocity)
    assert r.start() == 0
    r.set(voltage=2.0)
    r.step(h / 5)
    assert r.get("motor_angle")[0] == 0.0, "the first grid instant after 0 is h"
    r.set(voltage=7.0)  # not read before h
    r.step(4 * h / 5)
    assert r.get("motor_angle")[0] == pytest.approx(2.0 * gain * h, rel=1e-14)
    assert r.get("motor_speed")[0] == pytest.approx(2.0 * gain, rel=1e-14)
    r.step(h / 5)
    assert r.get("motor_speed")[0] == pytest.approx(2.0 * gain, rel=1e-14), "shown at 2 h"
    r.step(4 * h / 5)
    assert r.get("motor_speed")[0] == pytest.approx(7.0 * gain, rel=1e-14)
    assert r.get("motor_angle")[0] == pytest.approx(9.0 * gain * h, rel=1e-14)
    r.step(h / 5)
    r.set(voltage=1.0)  # read at 3 h, inside the next communication step
    r.step(9 * h / 5)
    assert r.get("motor_angle")[0] == pytest.approx(17.0 * gain * h, rel=1e-14)


def test_pure_integrator_and_lag_against_closed_forms(velocity):
    gain, tau = 300.0 * 2 * np.pi / 60, np.array([0.0, 1e-6, 1e-4, 2e-3, 0.05, 1.0])
    r = Run(velocity, tau=tau, lead=0.02)
    assert r.start() == 0, r.said
    r.set(voltage=-4.0)
    for _ in range(10):
        assert r.step(1e-3) == 0
    t, w = 0.01, -4.0 * gain
    decay = np.exp(-t / np.where(tau > 0, tau, 1e-9))
    # 1 us is integrated in 13 sub-steps: the bound is that of its first, unresolved microseconds
    speed, angle = w * (1 - decay), w * (t - tau * (1 - decay))
    assert r.get("motor_speed") == pytest.approx(speed, rel=1e-7)
    assert r.get("motor_angle") == pytest.approx(angle, rel=1e-7)
    assert r.get("table_position") == pytest.approx(angle * 0.02 / (2 * np.pi), rel=1e-7)
    assert r.get("motor_phase") == pytest.approx(2500 * angle / (2 * np.pi), rel=1e-7)
    assert r.get("table_phase") == pytest.approx(angle * 0.02 / (2 * np.pi) / 2e-5, rel=1e-7)


def test_runge_kutta_has_order_four(velocity):
    """Error of the lag after one time constant falls by 2^4 when the micro step is halved."""
    errors = []
    for h in (2e-4, 1e-4):
        r = Run(velocity, tau=2e-3, micro_step=h)
        assert r.start() == 0
        r.set(voltage=1.0)
        r.step(2e-3)
        errors.append(abs(r.get("motor_speed")[0] - 10 * np.pi * (1 - np.exp(-1.0))))
    assert errors[0] / errors[1] == pytest.approx(16.0, rel=0.1)


def test_axes_do_not_influence_each_other(ball_screw):
    """An axis gives the same bits alone as beside stiff, fast or switched-off neighbours."""

    def run(**values):
        r = Run(ball_screw, **values)
        assert r.start() == 0, r.said
        r.set(torque_command=[2.0, 1.0, -1.0, 0.5, 0.2, 0.1])
        for _ in range(20):
            assert r.step(1e-4) == 0
        return r

    together = run()
    mixed = run(
        active=[True, False, True, True, False, True],
        table_rest_speed=[2e-5, 2e-5, 1e-7, 2e-5, 2e-5, 1e-6],
        current_time=[5e-4, 5e-4, 1e-6, 5e-4, 5e-4, 0.0],
    )
    for name in ("motor_angle", "motor_speed", "table_position", "screw_force"):
        a, b = together.get(name), mixed.get(name)
        assert a[[0, 3]].tobytes() == b[[0, 3]].tobytes(), name
        assert b[[1, 4]].tolist() == [0.0, 0.0], f"{name} of an inactive axis"
        assert np.all(b[[2, 5]] != 0.0)
    for n in range(1, 6):  # blocks of every width
        few = run(active=np.arange(6) < n).get("screw_force")
        assert few[:n].tobytes() == together.get("screw_force")[:n].tobytes(), f"{n} axes"
        assert not few[n:].any()


def test_sub_steps_follow_the_stiffest_mode(ball_screw):
    """Sub-steps are ceil(h |lambda| / 2) of the standing axis, by numpy's eigenvalues."""
    ode = causal.load(PACKAGE, "MotionControl.BallScrewAxis")
    for changed in ({"table_rest_speed": 1e-6}, {"motor_inertia": 1e-6}, {"current_time": 1e-6}):
        p = ode.values(**changed)
        a = ode.linear(ode.initial(p), np.zeros(2), p)[0]
        h_lambda = 25e-6 * np.abs(np.linalg.eigvals(a)).max()
        r = Run(ball_screw, active=[True] + [False] * 5, **changed)
        assert r.start() == 0
        said = re.fullmatch(r"axis 1: stiff, (\d+) sub-steps per micro step of 2.5e-05 s", r.said)
        assert said, r.said
        assert np.ceil(h_lambda / 2) <= int(said[1]) <= np.ceil(1.03 * h_lambda / 2)
    r = Run(ball_screw)
    assert r.start() == 0
    assert r.said == "", "the defaults need none"


def test_stiffness_is_seen_across_the_gap(ball_screw):
    """With backlash the start is out of contact; the bound must be that of the contact."""
    ode = causal.load(PACKAGE, "MotionControl.BallScrewAxis")
    stiff = {"screw_stiffness": 1e13, "table_mass": 10.0}
    touching, largest = ode.initial(ode.values(**stiff)), []
    touching[[d.name for d in ode.states].index("rotor.angle")] = 1e-3  # the screw is stretched
    for x in (ode.initial(ode.values(**stiff)), touching):
        a = ode.linear(x, np.zeros(2), ode.values(**stiff))[0]
        largest.append(np.abs(np.linalg.eigvals(a)).max())
    h_lambda = 25e-6 * max(largest)
    for backlash in (0.0, 1e-4):
        r = Run(ball_screw, backlash=backlash, **stiff)
        assert r.start() == 0
        (steps,) = map(int, re.findall(r"stiff, (\d+) sub-steps", r.said))
        assert np.ceil(h_lambda / 2) <= steps <= np.ceil(1.03 * h_lambda / 2)


def test_stiff_friction_stands_still(ball_screw):
    """Rest speeds far below what the micro step could resolve alone: no chatter."""
    r = Run(ball_screw, table_rest_speed=1e-7, motor_rest_speed=1e-5)
    assert r.start() == 0
    r.set(torque_command=0.1, force=30.0)  # both below break-away
    for _ in range(200):
        r.step(1e-3)
    speeds = []
    for _ in range(100):
        r.step(1e-4)
        speeds.append(r.get("table_speed")[0])
    assert 0.0 < min(speeds)
    assert max(speeds) < 1e-7
    assert np.all(np.diff(speeds) <= 0.0), "it settles, and does not ring"


def test_spectral_radius_bounds_the_eigenvalues(ball_screw):
    rng = np.random.default_rng(5)
    for _ in range(50):
        scale = 10.0 ** rng.uniform(-4, 4, 5)
        a = rng.normal(size=(5, 5)) * scale[:, None] / scale[None, :]
        exact = np.abs(np.linalg.eigvals(a)).max()
        bound = ball_screw.c.run_radius(array(a))
        assert exact * (1 - 1e-12) <= bound <= 1.05 * exact
    for a, expected in ((np.zeros((5, 5)), 0.0), (np.eye(5, k=1), 0.0), (-3 * np.eye(5), 3.0)):
        assert ball_screw.c.run_radius(array(a)) == pytest.approx(expected)
    assert np.isnan(ball_screw.c.run_radius(array(np.full((5, 5), np.nan))))


def test_a_number_that_is_none_names_the_variable(ball_screw):
    r = Run(ball_screw)
    assert r.start() == 0
    r.set(torque_command=[0.0, 0.0, 1e308, 0.0, 0.0, 0.0])
    status = 0
    for _ in range(100):
        status = r.step(1e-3)
        if status:
            break
    assert status == -1
    assert re.match(r"axis 3: current_loop.state is -?(nan|inf) at 0\.001000000 s", r.said), r.said


REFUSED = [
    ({"micro_step": 1.001e-6}, "micro_step 1.001e-06 s is not a whole multiple of 25 ns"),
    ({"micro_step": 1e-9}, "micro_step 1e-09 s is not"),
    ({"motor_static": 0.1}, "axis 1: motor_static must not be below motor_coulomb"),
    ({"table_static": [70, 70, 70, 49, 70, 70]}, "axis 4: table_static must not be below"),
    ({"upper_limit_position": -0.5}, "axis 1: upper_limit_position must be above"),
    ({"table_rest_speed": 1e-9}, "axis 1: too stiff, 2.5e-05 s would need"),
    ({"table_mass": 0.0}, "axis 1: too stiff, 2.5e-05 s would need"),
    ({"screw_stiffness": np.nan}, "axis 1: too stiff, 2.5e-05 s would need nan"),
]


@pytest.mark.parametrize(("values", "message"), REFUSED)
def test_wrong_parameters_are_refused(ball_screw, values, message):
    r = Run(ball_screw, **values)
    assert r.start() == -1
    assert r.said.startswith(message), r.said


def test_wrong_parameters_of_an_inactive_axis_do_not_matter(ball_screw):
    r = Run(ball_screw, motor_static=[0.1] + [0.2] * 5, active=[False] + [True] * 5)
    assert r.start() == 0, r.said


def test_starting_again_gives_the_same_run(ball_screw):
    def run(r):
        assert r.start() == 0
        r.now = 0
        r.set(torque_command=1.0)
        r.step(5e-3)
        return outputs(r)

    r = Run(ball_screw)
    first = run(r)
    assert run(r.set(torque_command=0.0)) == first


def test_no_axis_active_runs(ball_screw):
    r = Run(ball_screw, active=False)
    assert r.start() == 0
    assert r.step(1e-2) == 0
    assert not any(outputs(r))


def test_state_is_plain_memory(ball_screw):
    """A copy of the bytes continues with the same bits: what getFMUState relies on."""
    size = ctypes.c_size_t.in_dll(ball_screw.c, "run_size").value
    r = Run(ball_screw)
    r.start()
    r.set(torque_command=1.0)
    r.step(1e-3)
    kept, now = ctypes.string_at(r.fmu, size), r.now
    r.step(3e-3)
    after = outputs(r)
    ctypes.memmove(r.fmu, kept, size)
    r.now = now
    r.step(3e-3)
    assert outputs(r) == after
