"""The linear model of an axis against closed formulas of servo loops."""

import math
from pathlib import Path

import control
import numpy as np
import pytest
from conftest import ROOT
from few_cases import few
from linear_rigs import DEMO, MODES, SMOOTH, WIDE, kp_of, theory
from written_out import WHOLE_TEXT

from motionfmu import InputError
from motionfmu.analysis import linear
from motionfmu.analysis.linear import law
from motionfmu.analysis.linear.block import Plant
from motionfmu.analysis.linear.loops import feedbacks, largest_gain
from motionfmu.analysis.linear.stability import margins
from motionfmu.analysis.linear.systems import StandstillSystem
from motionfmu.fmu.modelica import causal, class_description
from motionfmu.fmu.modelica.ode import Ode

T = 1e-4  # [s] sampling period of card and drives
ENC = "card.enc_phase"
PLANTS = sorted(
    p.parent.name for p in ROOT.glob("fmus/*/fmu.toml") if "\nmodelica" in p.read_text()
)


def test_a_plant_is_the_same_in_any_pieces() -> None:
    """Inputs are read at the instants k h, [from, to) of a step, and held for h: brute force."""
    draw = np.random.default_rng(3)
    f, g = draw.normal(size=(2, 2)) * 0.4, draw.normal(size=(2, 1))
    show = draw.normal(size=(1, 2)), np.zeros((1, 1))
    plant = Plant(("u",), ("a", "b"), ("y",), 4, (f, g), show)
    for pieces in ([4] * 12, [8, 12, 28], [1] * 48, [3] * 16, [5, 7, 2, 10, 1, 23], [6] * 8):
        work, clock = plant.begin(np.zeros((3, 1))), 0
        x, held = np.zeros((2, 1)), np.zeros((1, 1))
        for k, piece in enumerate(pieces):
            u = np.array([[math.sin(1.0 + k)]])
            work = plant.run(work, u, (clock, clock + piece))
            for now in range(clock, clock + piece):
                held = u if now % 4 == 0 else held
                x = f @ x + g @ held if (now + 1) % 4 == 0 else x
            clock += piece
            assert work == pytest.approx(np.vstack([x, held]), rel=1e-12), (pieces, clock)


@pytest.mark.parametrize("more", [0, 1, 4])
@pytest.mark.parametrize("gain", [20, 200, 4000])
def test_circle_figure_of_the_sampled_loop(gain: int, more: int) -> None:
    """|Kp T/(z^d (z - 1) + Kp T)|, d = 1 and the delays put in."""
    axis = theory(mcc__p_gain=gain)
    kt, d = kp_of(axis) * T, 1 + more
    closed = axis.system("card.pulses", "machine.table_position", delays={ENC: more})
    z = np.exp(1j * np.array([1e-3, 0.1, 1.0, 3.0]))
    # the delay sits in the feedback: the way forward has d = 1
    expected = z**more * kt / (z**d * (z - 1.0) + kt)
    pulse = 0.01 / 10_000  # [m]
    assert closed(z) / pulse == pytest.approx(expected, rel=1e-9)
    assert closed.dt == T


def test_software_law_has_two_samples_more() -> None:
    """Output mode 2: the PC reads the error on its bus and writes the voltage a period later."""
    axis = theory(mcc__output_mode=2, mcc__software_gain=1e-3)
    kt = 1e-3 * 300.0 / 60.0 * 10_000 * T
    z = np.exp(1j * np.linspace(0.01, 3.1, 7))
    assert axis.loop(ENC)(z) == pytest.approx(kt / (z**3 * (z - 1.0)), rel=1e-9)
    assert "mcc/card_dac_volts" in axis.loop(ENC).state_labels


@pytest.mark.parametrize("share", [0.0, 0.6, 1.0])
@pytest.mark.parametrize("lag", [0.0, 3e-3])
def test_feed_forward_makes_a_circle_grow(lag: float, share: float) -> None:
    """|H| - 1 = -(w/K)^2/2 (1 - kf^2 - 2 c K), c = tau + 3.5 T less what kf comes earlier, T/2.

    It goes beside the error's three samples, and without the half sample of the hold.
    """
    gain, pulse = 40.0, 1e-6
    axis = theory(
        mcc__output_mode=2, mcc__position_gain=gain, mcc__velocity_ff=share, machine__tau=lag
    )
    closed = axis.system("card.pulses", "machine.table_position")
    if lag == 0.0:
        z, kt = np.exp(1j * np.array([0.01, 0.3, 1.0])), gain * T
        whole = (kt / (z - 1.0) + share) / z**3 / (1.0 + kt / (z**3 * (z - 1.0)))
        assert closed(z) / pulse == pytest.approx(whole, rel=1e-6)
    w = 0.5  # [rad/s]
    size = abs(closed(np.exp(1j * w * T))) / pulse
    late = lag + 3.5 * T - 0.5 * share * T
    said = -0.5 * (w / gain) ** 2 * (1.0 - share**2 - 2.0 * late * gain)
    assert size - 1.0 == pytest.approx(said, rel=2e-3)


@pytest.mark.parametrize("d", [1, 2, 3, 6])
def test_stability_limit_with_extra_samples(d: int) -> None:
    """Kp T < 2 sin(pi/(2 (2 d + 1)))."""
    axis = theory()
    loop = axis.loop(ENC, delays={ENC: d - 1})
    limit = 2.0 * math.sin(math.pi / (2.0 * (2.0 * d + 1.0)))
    assert margins(loop).gain * kp_of(axis) * T == pytest.approx(limit, rel=1e-9)


@pytest.mark.parametrize("late", [0, 3, 10, 24])
def test_a_delay_of_a_loop_counts_communication_steps(late: int) -> None:
    """Ten steps in a loop period T: between two instants the axis moves on a straight line.

    A delay of (m + f) T makes L = Kp T/(z (z - 1)) z^-m ((1 - f) + f/z).
    """
    period = 10 * T
    axis = theory(card__loop_period=period, mcc__p_gain=200)
    loop = axis.loop(ENC, delays={ENC: late})
    m, f = divmod(late, 10)
    z = np.exp(1j * np.array([0.01, 0.3, 1.0, 3.0]))
    kt, f = kp_of(axis) * period, f / 10.0
    assert loop.dt == pytest.approx(period)
    assert loop(z) == pytest.approx(kt / (z * (z - 1.0)) / z**m * (1.0 - f + f / z), rel=1e-9)
    # with the largest gain the wired system, with the same delay, rings
    top = margins(loop).gain
    shut = axis.changed({"machine.speed_per_volt": top * axis.value("machine.speed_per_volt")})
    poles = shut.system("card.pulses", "machine.motor_phase", delays={ENC: late}).poles()
    assert np.abs(poles).max() == pytest.approx(1.0, abs=1e-9)
    if late == 10:
        assert top * kp_of(axis) == pytest.approx(2.0 * math.sin(math.pi / 10.0) / period, rel=1e-9)


def test_stability_limit_of_a_parameter() -> None:
    """The same limit as a gain of the library, interpolated between whole numbers."""
    axis = theory(card__p_scale=8)
    found = largest_gain(axis, ENC, (), "mcc.p_gain")
    kp = kp_of(axis) / axis.value("card.host_p_gain")
    assert not math.isfinite(found.gain)  # it would be 167,772: more than the register takes
    axis = theory(card__p_scale=4)
    found = largest_gain(axis, ENC, (), "mcc.p_gain")
    kp = kp_of(axis) / axis.value("card.host_p_gain")
    assert found.gain == pytest.approx(2.0 * math.sin(math.pi / 6.0) / (kp * T), rel=1e-4)
    assert found.omega * T == pytest.approx(math.pi / 3.0, rel=1e-4)


@pytest.mark.parametrize("d", [1, 3])
def test_gain_for_sixty_degrees(d: int) -> None:
    """Integrator, hold, d samples: lag 90 degrees + (d + 1/2) w T, |L| = Kp T/(2 sin(wT/2))."""
    wt = math.pi / 6.0 / (d + 0.5)
    wanted = 2.0 * math.sin(wt / 2.0) / T
    axis = theory(mcc__p_gain=1000)
    lines = round(2500 * wanted / kp_of(axis))
    axis = axis.changed({"machine.encoder_lines": lines})
    assert kp_of(axis) == pytest.approx(wanted, rel=1e-3)
    found = margins(axis.loop(ENC, delays={ENC: d - 1}))
    kt = kp_of(axis) * T
    wt = 2.0 * math.asin(kt / 2.0)
    lag = 90.0 - math.degrees((d + 0.5) * wt)
    assert found.phase == pytest.approx(lag, rel=1e-9) and found.phase == pytest.approx(60, abs=0.1)
    assert found.delay == pytest.approx(math.radians(lag) / (wt / T), rel=1e-9)


@pytest.mark.parametrize("parts", [4, 1, 0.5, 0.25])
def test_delay_of_the_communication_step(tmp_path: Path, parts: float) -> None:
    """The table of the runner's README: a step of n T makes every sample n T long."""
    text = WHOLE_TEXT.replace("step = 1e-4", f"step = {T / parts}")
    (tmp_path / "scenario.toml").write_text(text)
    (tmp_path / "circle.ngc").write_text("M30\n")
    axis = linear.model(tmp_path)
    period = T * max(1.0, 1.0 / parts)
    loop = axis.loop(ENC)
    assert loop.dt == pytest.approx(period)
    z = np.exp(1j * np.array([0.01, 1.0, 3.0]))
    assert loop(z) == pytest.approx(kp_of(axis) * period / (z * (z - 1.0)), rel=1e-9)


def test_unequal_periods_are_joined_to_their_common_one() -> None:
    """Grids of 75 and 100 us repeat after 300 us."""
    axis = theory(card__loop_period=7.5e-5, machine__micro_step=2.5e-5)
    loop = axis.loop(ENC)  # the communication step of 100 us is no multiple
    assert loop.dt == pytest.approx(3e-4)
    with pytest.raises(InputError, match=r"have a common period of"):
        theory(card__loop_period=9.999e-5, machine__micro_step=2.3e-5).loop(ENC)


@pytest.mark.parametrize(("k", "c", "m"), [(4e5, 6e2, 400.0), (2e5, 1.5e3, 300.0)])
def test_two_masses_fed_back_from_the_load(tmp_path: Path, k: float, c: float, m: float) -> None:
    """Kp < c k/(m k - c^2) with an ideal velocity source; fed back from the motor far more."""
    fast = 2.5e-5
    (tmp_path / "circle.ngc").write_text("M30\n")
    given = {
        **SMOOTH,
        **WIDE,
        "card.loop_period": fast,
        "drives.period": fast,
        "machine.motor_inertia": 1e4,  # nothing of the load comes back to the motor
        "drives.velocity_gain": 2e7,
        "drives.velocity_time": 0.0,
        "machine.current_time": 0.0,
        "machine.motor_viscous": 0.0,
        "machine.table_viscous": 0.0,
        "machine.screw_stiffness": k,
        "machine.screw_damping": c,
        "machine.table_mass": m,
    }
    found = {}
    for source in ("motor_phase", "table_phase"):
        (tmp_path / "scenario.toml").write_text(
            f'# One loop.\nmachine = "xy_table"\nstop = 8.0\nstep = {fast}\nwithout = ["contour"]\n'
            f'[connect]\n"card.enc_phase" = "machine.{source}"\n'
            '[set]\n"mcc.program" = "circle.ngc"\n'
        )
        axis = linear.model(tmp_path, set=given)
        lines = 2500 if source == "motor_phase" else 0.01 / axis.value("machine.scale_pitch")
        volts = axis.value("card.host_p_gain") / 64.0 * 20.0 / 65536.0 * 4 * lines
        kp = volts * axis.value("drives.speed_per_volt") / 60.0
        found[source] = largest_gain(axis, ENC).gain * kp
    assert found["table_phase"] == pytest.approx(c * k / (m * k - c * c), rel=0.01)
    assert found["motor_phase"] > 20.0 * found["table_phase"]


@pytest.mark.parametrize("damping", [1e4, 1e3])
def test_two_masses_between_torque_and_speed(damping: float) -> None:
    """Motor m s^2 + c s + k, table r (c s + k), over s (J m s^2 + (J + r^2 m)(c s + k)), held."""
    still = {"machine.motor_viscous": 0.0, "machine.table_viscous": 0.0}
    axis = linear.model(DEMO, set=SMOOTH | still | {"machine.screw_damping": damping})
    m, c, k, j, lag, lead = (
        axis.value(f"machine.{n}")
        for n in (
            "table_mass",
            "screw_damping",
            "screw_stiffness",
            "motor_inertia",
            "current_time",
            "lead",
        )
    )
    r = lead / (2.0 * math.pi)
    below = np.polymul([lag, 1.0], [j * m, (j + r * r * m) * c, (j + r * r * m) * k, 0.0])
    z = np.exp(1j * np.array([1e-3, 0.03, 0.1, 0.11, 0.4, 3.0]))
    cut = "machine.torque_command"
    for name, above in (("motor_speed", [m, c, k]), ("table_speed", [r * c, r * k])):
        found = axis.system(cut, f"machine.{name}", cut)
        wanted = control.c2d(control.tf(above, below), found.dt, "zoh")
        assert found(z) == pytest.approx(wanted(z), rel=1e-5)
    # without damping it rings at sqrt(k/m) sqrt(1 + r^2 m/J)
    bare = axis.changed({"machine.screw_damping": 0.0}).system(cut, "machine.motor_speed", cut)
    ringing = np.abs(np.log(bare.poles())) / bare.dt
    resonance = math.sqrt(k / m * (1.0 + r * r * m / j))
    assert np.abs(ringing - resonance).min() < 1e-4 * resonance


@pytest.mark.parametrize("damping", [1.0, math.sqrt(0.5), 0.5])
def test_damping_of_a_loop_behind_a_lag(damping: float) -> None:
    """Kp tau = 1/(4 zeta^2): overshoot exp(-pi zeta/sqrt(1 - zeta^2)), and the phase it leaves."""
    axis = theory(mcc__p_gain=200)
    kp = kp_of(axis)
    k = 0.25 / damping**2
    axis = axis.changed({"machine.tau": k / kp})
    closed = axis.system("card.pulses", "machine.table_position")
    y = control.step_response(closed, closed.dt * np.arange(4000)).outputs
    over = math.exp(-math.pi * damping / math.sqrt(1.0 - damping**2)) if damping < 1.0 else 0.0
    assert y.max() / closed.dcgain() - 1.0 == pytest.approx(over, abs=0.01)
    crossing = math.sqrt(0.5 * (math.sqrt(1.0 + 4.0 * k * k) - 1.0))  # w tau
    lag = crossing / (k / kp) * 1.5 * T
    found = margins(axis.loop(ENC))
    said = 90.0 - math.degrees(math.atan(crossing) + lag)
    assert found.phase == pytest.approx(said, abs=0.02)
    assert found.omega_phase == pytest.approx(crossing * kp / k, rel=1e-3)


def test_a_velocity_loop_by_its_parts() -> None:
    """Kv/(J s) (1 + 1/(Ti s)), the current loop's lag and two samples; it crosses at Kv/J."""
    still = {"machine.motor_viscous": 0.0, "machine.table_viscous": 0.0}
    axis = linear.model(DEMO, set=SMOOTH | still)
    m, j, lag, lead = (
        axis.value(f"machine.{n}") for n in ("table_mass", "motor_inertia", "current_time", "lead")
    )
    gain, time = axis.value("drives.velocity_gain"), axis.value("drives.velocity_time")
    crossing = gain / (j + m * (lead / (2.0 * math.pi)) ** 2)
    found = margins(axis.loop("drives.phase", ENC))
    assert found.omega_phase == pytest.approx(crossing, rel=0.03)
    phase = math.atan(crossing * time) - crossing * (lag + 2.0 * T)
    assert found.phase == pytest.approx(math.degrees(phase), abs=1.0)


def test_an_axis_at_rest_is_held_by_its_friction() -> None:
    """There the velocity loop acts on the slope f of friction at rest, and inertia hardly counts.

    The table's slope F is behind the screw: r^2 F (k + c s)/(k + (c + F) s).
    """
    axis = linear.model(DEMO, at={"machine.motor_speed": 0.0})
    static, rest, lead, k, c = (
        axis.value(f"machine.{n}")
        for n in ("motor_static", "motor_rest_speed", "lead", "screw_stiffness", "screw_damping")
    )
    table = axis.value("machine.table_static") / axis.value("machine.table_rest_speed")
    behind = (lead / (2.0 * math.pi)) ** 2 * table * control.tf([c, k], [c + table, k])
    gain, time = axis.value("drives.velocity_gain"), axis.value("drives.velocity_time")
    (kp,) = (g.kp for g in linear.gain_of(DEMO, axis=1) if g.name == "mcc.p_gain")
    pi = control.tf([gain, gain / time], [1.0, 0.0])
    loop = kp * control.tf([1.0], [1.0, 0.0]) * pi / (static / rest + behind + pi)
    found, said = margins(axis.loop(ENC)), margins(loop)
    assert found.phase == pytest.approx(said.phase, abs=0.5) and found.phase < 15.0
    assert found.omega_phase == pytest.approx(said.omega_phase, rel=0.02)


@pytest.mark.parametrize("speed", [0.05, -3.0, 60.0])
def test_friction_is_its_slope_at_the_stated_speed(speed: float) -> None:
    """A motor without a screw: its pole is exp(-h slope/J); torque and load are in balance."""
    loose = {"machine.screw_stiffness": 0.0, "machine.screw_damping": 0.0}
    axis = linear.model(DEMO, at={"machine.motor_speed": speed}, set=loose)
    fc, fs, vs, kv, v0, inertia = (
        axis.value(f"machine.motor_{n}")
        for n in ("coulomb", "static", "stribeck_speed", "viscous", "rest_speed", "inertia")
    )

    def friction(v: float) -> float:
        return v / math.hypot(v, v0) * (fc + (fs - fc) / (1.0 + (v / vs) ** 2)) + kv * v

    slope = (friction(speed + 1e-6) - friction(speed - 1e-6)) / 2e-6
    drive = axis.system("machine.torque_command", "machine.motor_speed", ["machine.torque_command"])
    expected = [math.exp(-slope / inertia * T), math.exp(-T / axis.value("machine.current_time"))]
    assert sorted(drive.poles().real) == pytest.approx(sorted([0.0, *expected])[-2:], abs=1e-4)
    assert axis.points["machine"].values["torque_command"] == pytest.approx(friction(speed))


@pytest.mark.parametrize("backlash", [0.0, 2e-5])
def test_a_load_is_carried_on_the_right_side_of_the_gap(backlash: float) -> None:
    at = {"machine.table_speed": -0.02, "machine.force": 300.0, "machine.table_position": 0.1}
    axis = linear.model(DEMO, at=at, set={"machine.backlash": backlash})
    v = axis.points["machine"].values
    assert v["table_position"] == pytest.approx(0.1) and v["force"] == 300.0
    assert v["motor_speed"] == pytest.approx(-0.02 * 2.0 * math.pi / 0.01)
    table = -(50.0 + 20.0 / (1.0 + (0.02 / 2e-3) ** 2)) - 200.0 * 0.02
    assert v["screw_force"] == pytest.approx(table - 300.0, rel=1e-4)
    nut = v["motor_angle"] * 0.01 / (2.0 * math.pi)
    push = v["screw_force"] / 1e8  # the spring is pressed to the left
    assert nut - 0.1 == pytest.approx(push - backlash / 2.0, rel=1e-5)
    stiff = axis.system("machine.force", "machine.screw_force")
    assert abs(stiff.dcgain()) > 0.9  # it is in contact, not in the gap


@pytest.mark.parametrize("speed", [-3.0, 0.01])
def test_a_motor_that_turns_through_the_gap_is_no_uniform_motion(speed: float) -> None:
    """For a moment nothing changes there, but the table would stay behind."""
    axis = linear.model(DEMO, at={"machine.motor_speed": speed}, set={"machine.backlash": 1e-5})
    values = axis.points["machine"].values
    assert values["table_speed"] == pytest.approx(speed * 0.01 / (2.0 * math.pi))
    assert abs(values["screw_force"]) > 40.0  # it pushes the table against its friction


def test_only_the_inner_loop_is_left_when_the_outer_is_cut() -> None:
    axis = linear.model(MODES, axis=2)
    assert feedbacks(axis) == {ENC: (), "drives.phase": (ENC,)}
    inner = axis.loop("drives.phase", cut=ENC)
    assert not any(s.startswith("card") for s in inner.state_labels)
    assert "drives/integral" in inner.state_labels
    # position mode closes both in the drive; the card's counter is read by nobody
    assert list(feedbacks(linear.model(MODES, axis=1))) == ["drives.phase"]


@pytest.mark.parametrize("at", [{}, {"machine.motor_speed": 30.0}, {"machine.table_speed": -0.1}])
def test_the_gain_at_standstill_in_spite_of_positions(at: dict[str, float]) -> None:
    """Speeds are 300 rpm/V and 5 mm/s per rpm; forces are those of the slowest of sines."""
    axis = linear.model(DEMO, at=at)
    names = ["motor_speed", "table_speed", "screw_force", "motor_torque", "motor_angle"]
    system = axis.system("drives.dac", [f"machine.{n}" for n in names], "drives.dac")
    gains = dict(zip(names, system.dcgain()[:, 0], strict=True))
    per_volt = axis.value("drives.speed_per_volt") * math.pi / 30.0
    assert gains["motor_speed"] == pytest.approx(per_volt, rel=1e-6)
    assert gains["table_speed"] == pytest.approx(per_volt * 0.01 / (2.0 * math.pi), rel=1e-6)
    slow = dict(
        zip(names, system(np.exp(1e-5j * system.dt), squeeze=False)[:, 0].real, strict=True)
    )
    for name in ("screw_force", "motor_torque"):
        assert gains[name] == pytest.approx(slow[name], rel=1e-3)
    assert gains["motor_angle"] == math.inf
    back = axis.loop("drives.phase", cut=ENC)
    assert back.dcgain() == math.inf
    one = axis.system("drives.dac", "machine.motor_speed", "drives.dac").dcgain()
    assert isinstance(one, float) and one == pytest.approx(per_volt, rel=1e-6)


def test_poles_at_one_that_matter() -> None:
    """Two integrators in a row, one of each sign, one that is not moved, one that is not seen."""
    a = np.array([[1.0, 0, 0, 0], [1, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 0.5]])
    b, c = np.array([[1.0], [0], [0], [1]]), np.array([[-2.0, 0, 0, 0], [0, 3, 0, 0], [0, 0, 1, 1]])
    change = np.random.default_rng(4).normal(size=(4, 4))
    turned = change @ a @ np.linalg.inv(change), change @ b, c @ np.linalg.inv(change)
    found = StandstillSystem(*turned, np.zeros((3, 1)), 1e-3).dcgain()[:, 0]
    assert found[:2].tolist() == [-math.inf, math.inf] and found[2] == pytest.approx(2.0)
    assert StandstillSystem(a, b, c[2], [[1.0]], 1e-3).dcgain() == pytest.approx(3.0)


def test_a_changed_gain_keeps_the_plant() -> None:
    axis = linear.model(DEMO, at={"machine.motor_speed": 10.0})
    other = axis.changed({"mcc.p_gain": 400})
    assert other.blocks["machine"] is axis.blocks["machine"]
    z = np.exp(0.3j)
    assert other.loop(ENC)(z) == pytest.approx(2.0 * axis.loop(ENC)(z))
    heavier = axis.changed({"machine.table_mass": 200.0})
    assert heavier.blocks["machine"] is not axis.blocks["machine"]
    assert heavier.at == axis.at


@pytest.mark.parametrize("speed", [0.0471746, 0.05, 0.123456789, 0.3])
def test_a_force_between_what_moves_alike_does_not_grow(speed: float) -> None:
    """Its rate is a difference of equal speeds, of which rounding is left."""
    axis = linear.model(ROOT / "scenarios/square", at={"machine.table_speed": speed})
    rates = axis.points["machine"].rates
    assert rates["screw_force"] == 0.0
    assert rates["table_position"] == pytest.approx(speed, rel=1e-9)


@pytest.mark.parametrize("name", few(PLANTS, ["ball_screw_axes"]))
def test_an_fmu_carries_the_equation_of_its_class(name: str) -> None:
    carried = law.carried(name)
    assert isinstance(carried, Ode)
    packing = class_description.read(ROOT / "fmus" / name / "fmu.toml")
    fresh = causal.load(packing.package, packing.modelica)
    assert [d.name for d in carried.states] == [d.name for d in fresh.states]
    assert carried.p0 == fresh.p0 and carried.limits == fresh.limits
    rng = np.random.default_rng(1)
    point = [rng.normal(size=v.shape[0]) for v in (fresh.x, fresh.u)]
    own, new = (ode.function()(*point, fresh.values()) for ode in (carried, fresh))
    assert all(np.array_equal(a.full(), b.full()) for a, b in zip(own, new, strict=True))


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (lambda: linear.model(DEMO, axis=7), "axis = 7: mcc has axes 1 to 6"),
        (lambda: linear.model(DEMO, axis=3), "axis = 3: it is not active in mcc"),
        (lambda: linear.model(DEMO, at={"card.dac": 1.0}), "'card' is no plant of the scenario"),
        (lambda: linear.model(DEMO, at={"machine.sped": 1.0}), "machine.sped = 1.0: ball_screw"),
        (lambda: linear.model(DEMO).loop("card.enc"), "card.enc is no input of the linear model"),
        (lambda: linear.model(DEMO).loop("card.pulses"), "card.pulses has no wire"),
        (lambda: linear.model(DEMO).system(ENC, "card.stock"), "card.stock is no output"),
        (lambda: linear.model(DEMO).changed({"mcc.p_gain": -1}), "set mcc.p_gain = -1: outside"),
        (lambda: linear.model(DEMO).value("card.nothing"), "card.nothing: nothing says its value"),
        (lambda: largest_gain(linear.model(DEMO), ENC, (), "mcc.program"), "a number above 0"),
        (
            lambda: linear.model(DEMO, at={"machine.table_speed": 0.1, "machine.motor_speed": 1.0}),
            "no uniform motion with",
        ),
    ],
)
def test_a_wrong_question_is_named(call, told: str) -> None:
    with pytest.raises(InputError) as caught:
        call()
    assert told in str(caught.value)


def test_systems_are_those_of_python_control() -> None:
    system = theory().system(["card.pulses", ENC], ["machine.table_position", "card.err_count"])
    assert isinstance(system, control.StateSpace)
    assert system.input_labels == ["card/pulses", "card/enc_phase"]
    assert system.output_labels == ["machine/table_position", "card/err_count"]
    assert all("/" in s for s in system.state_labels)
