"""The hydraulic axis against closed forms, and against a published worked example.

Formulas of the linear model: Merritt, "Hydraulic Control Systems" (1967), chapter 6. The example:
Esposito, "Fluid Power with Applications", chapter 17, electrohydraulic servo system.
"""

import numpy as np
import pytest
from hydraulic_rig import Case, drive, started
from hydraulic_theory import oil_and_mass, speed_under
from hypothesis import given, settings
from hypothesis import strategies as st
from plant_library import ROOT, Library

from motionfmu.analysis.linear.law import carried
from motionfmu.analysis.linear.plant import Linearised
from motionfmu.fmu.modelica.ode import Ode

NO_FRICTION = {"table_coulomb": 0.0, "table_static": 0.0, "table_viscous": 0.0}
TIGHT = {"valve_leakage": 0.0, "cylinder_leakage": 0.0, "valve_rounding": 1e-7}


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    return Library(
        ROOT / "fmus/hydraulic_axis/fmu.toml", tmp_path_factory.mktemp("hydraulic"), built=True
    )


def resonance(a, places=(3, 4, 6)):
    """Frequency and damping ratio of oil and mass: states pressures and speed."""
    own = np.linalg.eigvals(a[np.ix_(places, places)])
    mode = own[np.argmax(np.abs(own.imag))]
    return abs(mode), -mode.real / abs(mode)


def test_natural_frequency_at_mid_stroke():
    """A sqrt(2 beta/(V M)), with the leakages as they are."""
    case = Case(**NO_FRICTION)
    v = case.value
    volume = v["dead_volume_a"] + v["area_a"] * 0.1
    expected = v["area_a"] * np.sqrt(2 * v["bulk_modulus"] / (volume * v["table_mass"]))
    assert resonance(case.slope(case.start, [0, 0]).full())[0] == pytest.approx(expected, rel=0.01)


@settings(max_examples=30)
@given(
    area_a=st.floats(3e-4, 5e-3),
    area_b=st.floats(3e-4, 5e-3),
    place=st.floats(-0.1, 0.1),
    mass=st.floats(5.0, 2000.0),
)
def test_natural_frequency_of_any_cylinder(area_a, area_b, place, mass):
    """sqrt(beta (A_a^2/V_a + A_b^2/V_b)/M)."""
    areas = {"area_a": area_a, "area_b": area_b}
    case = Case(**NO_FRICTION, **TIGHT, **areas, start_position=place, table_mass=mass)
    stiffness = 1.2e9 * (
        area_a**2 / (5e-5 + area_a * (place + 0.1)) + area_b**2 / (5e-5 + area_b * (0.1 - place))
    )
    omega, zeta = resonance(case.slope(case.start, [0, 0]).full())
    assert omega == pytest.approx(np.sqrt(stiffness / mass), rel=1e-6)
    assert abs(zeta) < 1e-5


@pytest.mark.parametrize("opening", [0.0, 0.5])
def test_damping_by_leakage_friction_and_valve(opening):
    """2 zeta w = B/M + 2 beta C/V, w^2 = 2 beta (A^2 + B C)/(V M).

    C: past the piston, over the closed edges, and the slope of the flow over the open ones.
    """
    case = Case(
        table_coulomb=0.0, table_static=0.0, table_viscous=3000.0, valve_rounding=1e-7,
        valve_leakage=2e-12, cylinder_leakage=4e-12, laminar_drop=1.0,
    )  # fmt: skip
    v, x = case.value, np.array(case.start)
    area, drop = v["area_a"], (v["supply_pressure"] - v["tank_pressure"]) / 2
    gain = v["rated_flow"] / (1 - v["valve_overlap"]) / np.sqrt(v["rated_drop"])
    x[[0, 1]] = opening
    own = gain * max(opening - v["valve_overlap"], 0.0) / (2 * np.sqrt(drop))
    c = v["cylinder_leakage"] + v["valve_leakage"] + own / 2
    volume, beta, mass = v["dead_volume_a"] + area * 0.1, v["bulk_modulus"], v["table_mass"]
    b = v["table_viscous"]
    omega = np.sqrt(2 * beta * (area**2 + b * c) / (volume * mass))
    zeta = (b / mass + 2 * beta * c / volume) / (2 * omega)
    found = resonance(case.slope(x, [10 * opening, 0]).full())
    assert found == pytest.approx((omega, zeta), rel=1e-5)
    assert 0.05 < zeta < 0.9


@pytest.mark.parametrize("opening", [0.0, 0.2])
@pytest.mark.parametrize("place", [-0.08, -0.03, 0.0, 0.06])
def test_natural_frequency_and_damping_at_any_place(place, opening):
    """2 z w = B/M + b (1/V_a + 1/V_b) C + b (1/V_a^2 + 1/V_b^2)/(1/V_a + 1/V_b) k_e."""
    case = Case(
        table_coulomb=0.0, table_static=0.0, valve_rounding=1e-7, laminar_drop=1.0,
        start_position=place,
    )  # fmt: skip
    x = np.array(case.start)
    x[[0, 1]] = opening
    gain, drop = 1.667e-4 / 0.97 / np.sqrt(35e5), 69e5
    edges = gain * max(opening - 0.03, 0.0) / (2 * np.sqrt(drop)) + 2 * 3e-13
    volumes = 5e-5 + 9.46e-4 * (0.1 + place), 5e-5 + 9.46e-4 * (0.1 - place)
    expected = oil_and_mass(volumes, 100.0, 1e-12, edges, 1000.0)
    found = resonance(case.slope(x, [10 * opening, 0]).full())
    assert found == pytest.approx(expected, rel=3e-3 if place else 1e-5)


def test_the_fmu_carries_its_linear_model():
    """At a speed: oil and mass as in the README, too little damped for a gain of w/3."""
    ode = carried("hydraulic_axis")
    assert isinstance(ode, Ode)
    linear, p = Linearised(ode), np.array(ode.p0)
    at = linear.point(p, {"table_speed": 0.05, "force": 0.0})
    omega, zeta = resonance(linear.matrices(at.x, at.u, p)[0])
    assert omega == pytest.approx(385.4, rel=5e-3)
    assert zeta == pytest.approx(0.076, abs=0.002)


@pytest.mark.parametrize("areas", [(9.46e-4, 9.46e-4), (1.2e-3, 7e-4), (7e-4, 1.2e-3)])
def test_no_load_speed(library, areas):
    """Oil through both edges at the speed that the pressures share: k sqrt(F/(A_a^3 + A_b^3))."""
    a, b = areas
    gain = 1.667e-4 / np.sqrt(35e5)
    for sign, force in ((1.0, 140e5 * a - 2e5 * b), (-1.0, 140e5 * b - 2e5 * a)):
        run = started(
            library, **NO_FRICTION, valve_leakage=0.0, cylinder_leakage=0.0,
            area_a=a, area_b=b, laminar_drop=1e3,
        )  # fmt: skip
        v = drive(run, 0.2, 1e-3, ("table_speed",), voltage=sign * 10.0)[-1, 0]
        assert v == pytest.approx(sign * gain * np.sqrt(force / (a**3 + b**3)), rel=1e-5)


@pytest.mark.parametrize("force", [3000.0, -5000.0, -12_000.0])
def test_speed_under_a_load(library, force):
    """Times the root of what is left of the stall force."""
    run = started(
        library, **NO_FRICTION, valve_leakage=0.0, cylinder_leakage=0.0, laminar_drop=1e3,
        valve_rounding=1e-6,
    )  # fmt: skip
    v = drive(run, 0.3, 1e-3, ("table_speed",), voltage=5.0, force=force)[-1, 0]
    assert v == pytest.approx(speed_under(0.5, 0.03, force), rel=1e-5)
    free = speed_under(0.5, 0.03, 0.0)
    assert v == pytest.approx(free * np.sqrt(1.0 + force / (138e5 * 9.46e-4)), rel=1e-5)


def test_a_load_on_the_shut_valve_creeps_through_the_leakages(library):
    """(C + c) F/A^2: past the piston, and over the closed edges."""
    for force in (500.0, -2000.0):
        run = started(library, **NO_FRICTION, valve_rounding=1e-7)
        s = drive(run, 4.0, 1e-2, ("table_position",), force=force)[:, 0]
        speed = (s[-1] - s[-101]) / 1.0
        assert speed == pytest.approx((1e-12 + 3e-13) * force / 9.46e-4**2, rel=1e-3)


def test_a_rounded_corner_passes_oil_at_the_centre(library):
    """K w^2/(4 o) per root of the drop over each of the four edges; a soft root is short of it."""
    run = started(library, **NO_FRICTION, valve_leakage=0.0, cylinder_leakage=0.0)
    q = drive(run, 0.5, 1e-2, ("supply_flow",))[-1, 0]
    gain, drop = 1.667e-4 / 0.97 / np.sqrt(35e5), 69e5
    opening = 0.5 * (np.hypot(0.03, 2e-3) - 0.03)
    assert opening == pytest.approx(2e-3**2 / (4 * 0.03), rel=2e-3)
    short = 1.0 - (1e5 / drop) ** 2 / 4.0
    assert q == pytest.approx(2 * gain * opening * np.sqrt(drop) * short, rel=1e-6)


def test_stall_force(library):
    """No load is moved by more than p_s A; against a stop all of it arrives."""
    area, supply = 1e-3, 100e5
    own = {"area_a": area, "area_b": area, "supply_pressure": supply, "tank_pressure": 0.0}
    values = {**own, **NO_FRICTION, "valve_leakage": 0.0, "cylinder_leakage": 0.0}
    run = started(library, **values, start_position=0.1)
    force = drive(run, 1.0, 1e-2, ("stop_force",), voltage=10.0)[-1, 0]
    assert force == pytest.approx(-supply * area, rel=1e-6)
    for share, way in ((0.98, 1.0), (1.02, -1.0)):
        run = started(library, **values)
        s = drive(run, 1.0, 1e-2, ("table_position",), voltage=10.0, force=-share * supply * area)
        assert np.sign(s[-1, 0] - s[-20, 0]) == way


def test_inside_the_deadband_only_leakage_moves_the_table(library):
    speeds = {}
    for volts in (0.29, -0.29, 0.32):
        run = started(library, **NO_FRICTION, valve_rounding=1e-5)
        s = drive(run, 3.0, 1e-2, ("table_position",), voltage=volts)[:, 0]
        speeds[volts] = (s[-1] - s[-11]) / 0.1
    full = 1.667e-4 * np.sqrt(138e5 / (2 * 35e5)) / 9.46e-4
    assert abs(speeds[0.29]) < 1e-6 * full
    assert abs(speeds[-0.29]) < 1e-6 * full
    assert speeds[0.32] == pytest.approx(full * 0.002 / 0.97, rel=0.01)


# The example's figures in SI: the only place where they are converted.
INCH, POUND = 0.0254, 4.4482216152605  # [m], [N]
PSI = POUND / INCH**2  # [Pa]
FIGURES = {
    "valve_gain": 0.15 * INCH**3 / 1e-3,  # [m3/s/A]
    "area": 5.0 * INCH**2,
    "transducer": 4.0 / INCH,  # [V/m]
    "volume": 50.0 * INCH**3,  # of one chamber at mid stroke
    "mass": 1000.0 / 386.0 * POUND / INCH,  # [kg]
    "deadband": 4e-3,  # [A] to either side
    "bulk_modulus": 175e3 * PSI,
    "amplifier": 0.723,  # [A/V]
    "saturation": 0.3,  # [A]
}
# What the book gives, to three digits.
BOOK = {"frequency": 260.0, "gain": 86.7, "repeatable": 1.38e-3 * INCH, "tracking": 0.104 * INCH}
THREE_DIGITS = 2e-3
# The book has no damping and no supply: leakage for a ratio of 0.5, and 1000 psi without return
# pressure. The rest is made ideal: no friction, a fast spool, sharp edges.
SUPPLY, ZETA, HALF_STROKE = 1000.0 * PSI, 0.5, 5.0 * INCH


def esposito():
    """Parameters of the plant for the example."""
    f = FIGURES
    dead = f["volume"] - f["area"] * HALF_STROKE
    overlap = f["deadband"] / f["saturation"]
    omega = f["area"] * np.sqrt(2 * f["bulk_modulus"] / (f["volume"] * f["mass"]))
    return {
        **NO_FRICTION,
        "amplifier_gain": f["amplifier"], "current_limit": f["saturation"], "current_time": 0.0,
        "rated_current": f["saturation"], "valve_frequency": 5e3, "valve_damping": 1.0,
        "valve_overlap": overlap, "valve_rounding": 1e-6,
        "rated_flow": f["valve_gain"] * f["saturation"] * (1 - overlap), "rated_drop": SUPPLY / 2,
        "laminar_drop": 1e3, "valve_leakage": 0.0, "supply_pressure": SUPPLY, "tank_pressure": 0.0,
        "area_a": f["area"], "area_b": f["area"], "dead_volume_a": dead, "dead_volume_b": dead,
        "bulk_modulus": f["bulk_modulus"],
        "cylinder_leakage": ZETA * omega * f["volume"] / f["bulk_modulus"],
        "table_mass": f["mass"], "lower_stop": -HALF_STROKE, "upper_stop": HALF_STROKE,
    }  # fmt: skip


def p_loop(run, command, seconds, every=1e-4):
    """Voltage = transducer * (command(t) - position); the errors [m]."""
    errors = []
    for k in range(round(seconds / every)):
        errors.append(command(k * every) - float(run.get("table_position")))
        run.set(voltage=FIGURES["transducer"] * errors[-1])
        assert run.step(every) == 0, run.said
    return np.array(errors)


def test_textbook_frequency():
    case = Case(**esposito())
    omega, zeta = resonance(case.slope(case.start, [0, 0]).full())
    assert omega == pytest.approx(BOOK["frequency"], rel=THREE_DIGITS)
    assert zeta == pytest.approx(ZETA, rel=1e-6)


def test_textbook_gain():
    """Speed per voltage of the linear model in a uniform motion, times the transducer's."""
    case = Case(**esposito())
    linear = Linearised(case.ode)
    at = linear.point(case.p, {"table_speed": 2.0 * INCH})
    a, b, c, _ = linear.matrices(at.x, at.u, case.p)
    keep = [1, 2, 3, 4, 6]  # without the position, which only adds up, and the ideal current
    a, b, row = a[np.ix_(keep, keep)], b[keep, 0], c[case.names.index("table_speed"), keep]
    gain = FIGURES["transducer"] * -row @ np.linalg.solve(a, b)
    assert gain == pytest.approx(BOOK["gain"], rel=THREE_DIGITS)
    assert gain == pytest.approx(BOOK["frequency"] / 3, rel=THREE_DIGITS)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_textbook_repeatable_error(library, sign):
    """Where a slow approach comes to rest; a quick one stops somewhere inside."""
    run = started(library, **esposito())
    slow = p_loop(run, lambda t: sign * min(t, 0.2) * 0.02 * INCH, 0.6)
    assert sign * slow[-1] == pytest.approx(BOOK["repeatable"], rel=5e-3)
    quick = p_loop(started(library, **esposito()), lambda _: sign * 0.5 * INCH, 0.6)
    assert np.abs(quick[-1000:]).max() < 1.005 * BOOK["repeatable"]


def test_textbook_tracking_error(library):
    """Error at a speed that just does not saturate the valve; a faster one is lost."""
    begin, ramp = -4.5 * INCH, 0.4
    run = started(library, **esposito(), start_position=begin)
    fastest = drive(run, 0.3, 1e-3, ("table_speed",), voltage=10.0)[-1, 0]
    for share, kept in ((0.999, True), (1.05, False)):
        run = started(library, **esposito(), start_position=begin)

        def command(t, v=share * fastest):
            return begin + v * (t**2 / (2 * ramp) if t < ramp else t - ramp / 2)

        errors = p_loop(run, command, 0.8)
        if kept:
            assert errors[-1] == pytest.approx(BOOK["tracking"], rel=5e-3)
            assert np.ptp(errors[-1000:]) < 1e-3 * errors[-1]
        else:
            assert errors[-1] > 1.5 * BOOK["tracking"]
            assert np.all(np.diff(errors[-1000:]) > 0.0)
