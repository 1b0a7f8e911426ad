"""The hydraulic axis in C: against other solvers, conservation of oil, ports, grid, refusals."""

import ctypes

import numpy as np
import pytest
import rumoca
from fmi_tools import OK, Instance
from hydraulic_rig import HARD, SHOWN, START, STEP, Case, drive, drive_all, reference, started
from hypothesis import given, settings
from hypothesis import strategies as st
from plant_library import PACKAGE, ROOT, Library, Run
from scipy.integrate import cumulative_simpson

# What they share is made once, by one worker.
pytestmark = pytest.mark.xdist_group("hydraulics")

AGREED = 1e-6  # [1] of the largest value of an output


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    return Library(
        ROOT / "fmus/hydraulic_axis/fmu.toml", tmp_path_factory.mktemp("hydraulic"), built=True
    )


@pytest.fixture(scope="module")
def exact():
    """The reference's outputs at every micro step."""
    case = Case(**START)
    states = reference(case, HARD)
    u = np.repeat([piece[1:] for piece in HARD], np.diff([0, *(ends())]), axis=0)
    return case.shown(states.T, u.T).full().T


def ends():
    return [round(piece[0] / STEP) for piece in HARD]


@pytest.mark.more
def test_the_reference_goes_through_everything(exact):
    _, spool, a, b, s, v = exact.T
    assert (spool.max(), spool.min()) == (1.0, pytest.approx(-0.514, abs=0.01))
    assert s.max() > 0.10005, "into the stop"
    assert v.max() > 0.25
    assert v.min() < -0.15
    assert np.count_nonzero(np.diff(np.sign(v))) > 10, "reversals through friction"
    assert max(a.max(), b.max()) > 0.9 * 140e5
    assert b.min() < 3e5


@pytest.mark.more
@pytest.mark.parametrize("fmi", [2, 3])
def test_fmu_against_radau(exact, fmi):
    fmu = Instance("hydraulic_axis", fmi).initialize(START)
    rows, t0 = [], 0.0
    for t1, voltage, force in HARD:
        fmu.set("voltage", voltage)
        fmu.set("force", force)
        for _ in range(round((t1 - t0) / 1e-4)):
            assert fmu.step(1e-4) == OK
            rows.append([fmu.get(name)[0] for name in SHOWN])
        t0 = t1
    error = np.abs(np.array(rows) - exact[3::4]).max(axis=0) / np.abs(exact).max(axis=0)
    assert np.all(error < AGREED), dict(zip(SHOWN, error, strict=True))
    fmu.free()


@pytest.mark.more
def test_every_micro_step_against_radau(library, exact):
    ours = drive_all(started(library, **START), HARD)
    error = np.abs(ours - exact).max(axis=0) / np.abs(exact).max(axis=0)
    assert np.all(error < AGREED), dict(zip(SHOWN, error, strict=True))


def test_trajectory_against_the_simulator_of_rumoca(library):
    def held(place):
        *early, last = ((piece[0], piece[place]) for piece in HARD)
        chain = " elseif ".join(f"time < {t} then {v}" for t, v in early)
        return f"if {chain} else {last[1]}"

    text = (
        f"model T MotionControl.HydraulicAxis a(start_position = {START['start_position']}); "
        f"equation a.voltage = {held(1)}; a.force = {held(2)}; end T;"
    )
    model = rumoca.Session(roots=[str(PACKAGE)]).loads(text, model="T")
    config = rumoca.SimConfig(solver="rk-like", rtol=1e-9, atol=1e-12)
    result = model.simulate((0.0, HARD[-1][0]), dt=1e-3, config=config)
    ours = drive_all(started(library, **START), HARD, every=1e-3)
    # It shows an instant at which an input jumps twice.
    places = np.searchsorted(result["time"], 1e-3 * np.arange(1, len(ours) + 1) - 1e-9)
    theirs = np.array([np.asarray(result[f"a.{name}"])[places] for name in SHOWN]).T
    error = np.abs(ours - theirs).max(axis=0) / np.abs(ours).max(axis=0)
    assert np.all(error < AGREED), dict(zip(SHOWN, error, strict=True))


def test_oil_is_conserved_at_every_sample(library):
    """Oil through the valve and past the piston = swept volume + compression, in both chambers."""
    areas = {"area_a": 1.2e-3, "area_b": 8e-4, "cylinder_leakage": 5e-12}
    names = ("flow_a", "flow_b", "pressure_a", "pressure_b", "table_position", "table_speed")
    run = started(library, **START, **areas)
    before = np.array([[float(run.get(n)) for n in names]])
    rows = np.concatenate([before, drive_all(run, HARD, names=names)])
    q_a, q_b, a, b, s, v = rows.T
    leak = areas["cylinder_leakage"] * (a - b)
    sides = (
        (q_a - leak, a, areas["area_a"], 5e-5 + areas["area_a"] * (s + 0.1), 1.0),
        (q_b + leak, b, areas["area_b"], 5e-5 + areas["area_b"] * (0.1 - s), -1.0),
    )

    def integral(y):  # in pieces: its slope jumps where the inputs do
        parts, begin = [np.zeros(1)], 0
        for end in ends():
            rest = cumulative_simpson(y[begin : end + 1], dx=STEP)
            parts.append(parts[-1][-1] + rest)
            begin = end
        return np.concatenate(parts)

    for inflow, pressure, area, volume, way in sides:
        passed = integral(inflow)
        swept = volume - volume[0]
        # integral of V dp = V p - integral of p dV
        stored = volume * pressure - volume[0] * pressure[0] - integral(pressure * area * way * v)
        compressed = stored / 1.2e9
        lost = passed - swept - compressed
        assert np.abs(lost).max() < 1e-5 * np.abs(passed).max()
        assert np.abs(compressed).max() > 0.02 * np.abs(passed).max(), "it matters"


def test_stops_push_back_only(library):
    run = started(library, start_position=0.099)
    names = ("table_position", "stop_force")
    rows = np.concatenate(
        [drive(run, 0.05, names=names, voltage=10.0), drive(run, 0.9, 2e-4, names, voltage=-10.0)]
    )
    s, f = rows.T
    assert np.all(f[s > 0.1] <= 0.0)
    assert np.all(f[s < -0.1] >= 0.0)
    assert np.all(f[np.abs(s) < 0.1] == 0.0)
    assert f.min() < -1e4
    assert f.max() > 1e4
    rest = 138e5 * 9.46e-4 / 1e8  # dent of the force that the oil can have
    assert rest * 0.9 < np.abs(s).max() - 0.1 < rest + np.sqrt(rest**2 + 100 * 0.2425**2 / 1e8)


def test_a_soft_stop_is_left_without_a_pull(library):
    """Faster off the stop than 1/damping the force is 0, though the dent is still there."""
    run = started(library, start_position=0.099, stop_stiffness=1e6, stop_damping=10.0)
    names = ("table_position", "table_speed", "stop_force")
    drive(run, 0.1, 1e-3, names, voltage=10.0)
    s, v, f = drive(run, 0.1, names=names, voltage=-10.0).T
    quick = (s > 0.1) & (v < -0.1)
    assert np.count_nonzero(quick) > 100
    assert np.all(f[quick] == 0.0)
    assert np.all(f <= 0.0)


def test_scale_and_home_switch(library):
    for start, on in ((0.0, 0.0), (-0.0799, 0.0), (-0.08, 1.0), (-0.1, 1.0)):
        run = started(library, start_position=start, scale_pitch=1e-5, scale_offset=-0.02)
        assert float(run.get("home_switch")) == on
        assert float(run.get("table_position")) == start
        assert float(run.get("table_phase")) == pytest.approx((start + 0.02) / 1e-5, rel=1e-13)
    rows = drive(run, 0.2, 1e-3, ("table_position", "table_phase", "home_switch"), voltage=10.0)
    assert rows[:, 1] == pytest.approx((rows[:, 0] + 0.02) / 1e-5, rel=1e-12)
    assert np.array_equal(rows[:, 2] == 1.0, rows[:, 0] <= -0.08)
    assert rows[-1, 2] == 0.0


def test_an_axis_alone_has_scalars(library):
    assert all(v.dims == () for v in library.description.variables)
    run = started(library, active=False)
    assert drive(run, 0.01, voltage=10.0).max() == 0.0


@settings(max_examples=25)
@given(
    cuts=st.sets(st.integers(1, 399), max_size=20),
    switch=st.integers(1, 399),
    volts=st.sampled_from([-10.0, 0.31, 5.0]),
)
def test_any_split_gives_the_same_bits(library, cuts, switch, volts):
    """Steps that follow the error know nothing of communication points (unit 2.5 us)."""

    def run(points):
        r = started(library, **START)
        r.set(voltage=10.0)
        seen = {}
        for tick in sorted({*points, switch, 400}):
            assert r.step((2500 * tick - r.now) * 1e-9) == 0
            seen[tick] = [float(r.get(name)) for name in SHOWN]
            if tick == switch:
                r.set(voltage=volts, force=1000.0)
        return seen

    fine, coarse = run(cuts), run(())
    assert all(fine[tick] == coarse[tick] for tick in coarse)


def test_state_is_plain_memory(library):
    size = ctypes.c_size_t.in_dll(library.c, "run_size").value
    run = started(library, **START)
    drive(run, 0.003, voltage=10.0)
    kept, now = ctypes.string_at(run.fmu, size), run.now
    after = drive(run, 0.01, voltage=-10.0)
    ctypes.memmove(run.fmu, kept, size)
    run.now = now
    assert np.array_equal(drive(run, 0.01, voltage=-10.0), after)


REFUSED = [
    ({"table_static": 100.0}, "axis 1: table_static must not be below table_coulomb"),
    ({"upper_stop": -0.2}, "axis 1: upper_stop must be above lower_stop"),
    ({"start_position": 0.11}, "axis 1: start_position must be between lower_stop and upper_stop"),
    ({"supply_pressure": 2e5}, "axis 1: supply_pressure must be above tank_pressure"),
    ({"micro_step": 1.001e-6}, "micro_step 1.001e-06 s is not a whole multiple of 25 ns"),
]


@pytest.mark.parametrize(("values", "message"), REFUSED)
def test_wrong_parameters_are_refused(library, values, message):
    run = Run(library, **values)
    assert run.start() == -1
    assert run.said.startswith(message), run.said


def test_what_is_too_stiff_stops_with_a_message(library):
    run = started(library, table_mass=1e-9)
    run.set(voltage=10.0)
    assert run.step(1e-3) == -1
    assert run.said == (
        "axis 1: too stiff at 0.000025000 s, 2.5e-05 s would need more than 1000 sub-steps"
    )
