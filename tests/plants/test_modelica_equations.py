"""Modelica classes as differential equations: by hand, in small models, and what is refused."""

import json

import numpy as np
import pytest
import rumoca
from few_cases import few
from plant_library import PACKAGE

from motionfmu.fmu.modelica import causal, flat

FUNCTION = "function f input Real a; input Real b = 2; output Real y; algorithm y := a*b; end f; "
STATE = "Real x(start = 0.5, fixed = true); "


@pytest.fixture(scope="module")
def axis():
    return causal.load(PACKAGE, "MotionControl.BallScrewAxis")


def model(tmp_path, body, before=FUNCTION):
    """Ode of a small model whose text is given."""
    file = tmp_path / "M.mo"
    file.write_text(f"{before}model M {body} end M;")
    return causal.load(file, "M")


def by_hand(x, u, p):
    """dx/dt and force of the ball-screw axis, from Newton and the sketch of the machine."""
    current, angle, w, s, v = x
    r = p["lead"] / (2 * np.pi)

    def friction(speed, side):
        level = p[f"{side}_coulomb"] + (p[f"{side}_static"] - p[f"{side}_coulomb"]) / (
            1 + (speed / p[f"{side}_stribeck_speed"]) ** 2
        )
        sign = speed / np.hypot(speed, p[f"{side}_rest_speed"])
        return level * sign + p[f"{side}_viscous"] * speed

    elastic = p["screw_stiffness"] * (r * angle - s) + p["screw_damping"] * (r * w - v)
    half = p["screw_stiffness"] * p["backlash"] / 2
    force = np.sign(elastic) * max(abs(elastic) - half, 0.0)
    lag = p["current_time"]
    torque = current if lag > 0 else u[0]
    return [
        (u[0] - current) / lag if lag > 0 else 0.0,
        w,
        (torque - force * r - friction(w, "motor")) / p["motor_inertia"],
        v,
        (u[1] + force - friction(v, "table")) / p["table_mass"],
    ], force


def test_ball_screw_axis_equals_the_equations_by_hand(axis):
    rng = np.random.default_rng(1)
    f = axis.function()
    names = [d.name for d in axis.parameters]
    assert [d.name for d in axis.states] == [
        "current_loop.state", "rotor.angle", "rotor.speed", "table.position", "table.speed"
    ]  # fmt: skip
    force_at = [d.name for d in axis.outputs].index("screw_force")
    contact = 0
    for k in range(200):
        p = np.array(axis.p0) * rng.uniform(0.5, 1.5, len(names))
        p[names.index("backlash")] = rng.choice([0.0, 1e-5])
        if k % 10 == 0:
            p[names.index("current_time")] = 0.0
        s = rng.uniform(-0.4, 0.4)
        lead = p[names.index("lead")]
        angle = (s + rng.normal() * 1e-5) * 2 * np.pi / lead
        x = [rng.normal(), angle, rng.normal() * 10.0 ** rng.uniform(-4, 2), s, rng.normal() * 0.1]
        u = rng.normal(size=2) * [3.0, 50.0]
        xdot, y = (np.array(a).ravel() for a in f(x, u, p))
        expected, force = by_hand(x, u, dict(zip(names, p, strict=True)))
        # The screw's stretch is a difference of positions of 0.4 m, rounded at 1e-16: 1e-8 N.
        assert xdot == pytest.approx(expected, rel=1e-11, abs=1e-6)
        assert y[force_at] == pytest.approx(force, rel=1e-11, abs=1e-6)
        contact += force != 0.0
    assert 20 < contact < 200, "both in contact and in the gap"


def test_linearisation_is_the_slope(axis):
    x, u, p = np.array([0.5, 3.0, 0.02, 0.004, 3e-5]), np.array([0.4, 3.0]), axis.values()
    x[3] = x[1] * 0.01 / (2 * np.pi) - 1e-7
    a, b, c, d = axis.linear(x, u, p)
    f = axis.function()

    def at(dx, du):
        return np.concatenate([np.array(r).ravel() for r in f(x + dx, u + du, p)])

    for k, h in enumerate([1e-5, 1e-9, 1e-6, 1e-11, 1e-9]):
        e = np.eye(5)[k] * h
        slope = (at(e, 0 * u) - at(-e, 0 * u)) / (2 * h)
        assert np.concatenate([a[:, k], c[:, k]]) == pytest.approx(slope, rel=1e-4, abs=1e-3)
    for k in range(2):
        e = np.eye(2)[k]
        slope = (at(0 * x, e) - at(0 * x, -e)) / 2
        assert np.concatenate([b[:, k], d[:, k]]) == pytest.approx(slope, rel=1e-9, abs=1e-9)


def test_values_and_start(axis):
    p = axis.values(start_position=0.1, lead=0.02)
    assert axis.initial(p) == pytest.approx([0.0, 2 * np.pi * 0.1 / 0.02, 0.0, 0.1, 0.0])
    with pytest.raises(KeyError, match="has no parameter leed"):
        axis.values(leed=1.0)


CLASSES = sorted(f.stem for f in PACKAGE.glob("*.mo") if f.stem[0].isupper())


@pytest.mark.parametrize("name", few(CLASSES, 4))
def test_every_declaration_has_a_unit_and_a_description(name):
    kind, _, text = (PACKAGE / f"{name}.mo").read_text().split("\n")[1].partition(f" {name} ")
    assert text.startswith('"') or '\n  "' in (PACKAGE / f"{name}.mo").read_text()
    use = f"model T MotionControl.{name} it; equation it.{{}}; end T;"
    flow = {"RotationalFlange": "phi = 1", "TranslationalFlange": "s = 1", "HydraulicPort": "p = 1",
            "Frame": "a = {1, 2, 3}; it.z = it.a"}  # fmt: skip
    session = rumoca.Session(roots=[str(PACKAGE)])
    if kind == "connector":
        found = session.loads(use.format(flow[name]), model="T")
    else:
        found = session.load(str(PACKAGE / "package.mo"), model=f"MotionControl.{name}")
    doc = json.loads(found.to_json("flat"))
    assert doc["variables"]
    for variable, v in doc["variables"].items():
        assert v["description"], variable
        assert v["unit"] or doc["variable_type_names"][variable] != "Real", variable


def test_package_order_lists_every_class():
    listed = [n for n in (PACKAGE / "package.order").read_text().split() if n != "pi"]
    assert sorted(listed) == sorted(f.stem for f in PACKAGE.glob("*.mo") if f.stem != "package")


# Body, x' at x = 0.5, u = 3
SMALL = [
    ("input Real u; " + STATE + "equation der(x) = if u > 4 then 1 elseif u > 2 then 7 else 2;", 7),
    ("input Real u; " + STATE + "equation der(x) = noEvent(if u < 2 then u else -u);", -3),
    ("input Real u; " + STATE + "equation der(x) = min(max(u, -1), 1) + abs(-x) + sign(-u);", 0.5),
    ("input Real u; " + STATE + "equation if u > 1 then der(x) = 4; else der(x) = u; end if;", 4),
    ("input Real u; " + STATE + "equation der(x) = if u > 1 and not x > 1 then 5 else 6;", 5),
    ("input Real u; " + STATE + "equation der(x) = f(u) + f(b = x, a = 4);", 8),
    ("input Real u; " + STATE + "Real a; Real b; equation a + b = u; a - 2*b = x; der(x) = a*b;",
     6.5 / 3 * 2.5 / 3),
    ("input Real u; " + STATE + "Real y = 2*x; equation der(x) = y;", 1),
    ("parameter Real a = 2; final parameter Real b = 3*a; input Real u; " + STATE
     + "equation der(x) = b*u;", 18),
    ("parameter Boolean on = true; parameter Integer n = 4; input Real u; " + STATE
     + "equation der(x) = if on then n*u else 0;", 12),
    # A comparison decides, and what it compares is itself to be solved first.
    ("input Real u; " + STATE + "Real z; Boolean b; equation der(x) = if b then 1 else 2; "
     "b = z > 5; z = 2*u;", 1),
    ("input Real u; " + STATE + "parameter Real k[2, 3] = {{1, 2, 3}, {4, 5, 6}}; "
     "Real y[2]; final parameter Real h[3] = 10*k[2, :] - k[1, :]; equation for i in 1:2 loop "
     "y[i] = k[2, i] - k[1, 4 - i] + h[i + 1]; end for; der(x) = 100*y[1] + y[2];",
     100 * (4 - 3 + 48) + (5 - 2 + 57)),
    ("input Real u; " + STATE + "Real y; Real w; equation y = 2*x; w = der(y); der(x) = u; ", 3),
]  # fmt: skip


@pytest.mark.parametrize(("body", "expected"), SMALL)
def test_small_models(tmp_path, body, expected):
    ode = model(tmp_path, body)
    xdot = ode.function()([0.5], [3.0], ode.p0)[0]
    assert float(xdot) == pytest.approx(expected, rel=1e-14)


def test_dummy_derivative(tmp_path):
    """w = der(y) of a nonlinear y(x) is dy/dx x'."""
    ode = model(
        tmp_path,
        "input Real u; output Real w; Real y; "
        + STATE
        + "equation y = x^3; w = der(y); der(x) = u;",
    )
    assert float(ode.function()([0.5], [3.0], [])[1]) == pytest.approx(3 * 0.25 * 3, rel=1e-14)


def test_components_in_an_array(tmp_path):
    """Masses in a row, one behind another: each has its own parameters, a sum goes back."""
    before = """
connector C Real v; flow Real f; end C;
model Mass parameter Real m = 1; parameter Real c[2] = {0, 0}; C a; C b; Real v(start = c[2],
  fixed = true); equation m*der(v) = a.f + b.f; a.v = v; b.v = v + c[1]; end Mass;
model Wall C c; equation c.f = 0; end Wall;
"""
    ode = model(
        tmp_path,
        "parameter Real m[3] = {1, 2, 3}; parameter Real c[3, 2] = {{0, 1}, {0, 1}, {0, 1}}; "
        "input Real u[2](each start = 4); output Real w[2]; Mass mass[3](m = m, c = c); "
        "Damper d[2]; Wall wall; equation "
        "for i in 1:2 loop connect(mass[i].b, d[i].a); connect(d[i].b, mass[i + 1].a); "
        "w[i] = mass[4 - i].v; d[i].force = u[i]; end for; connect(mass[3].b, wall.c);",
        before
        + "model Damper C a; C b; Real force; equation a.f = force; b.f = -force; end Damper;",
    )
    assert [d.name for d in ode.parameters][:4] == ["m[1]", "m[2]", "m[3]", "c[1,1]"]
    assert [d.name for d in ode.inputs] == ["u[1]", "u[2]"] and ode.u0 == (4.0, 4.0)
    assert {d.port for d in ode.parameters} == {"m", "c"}
    xdot, y = ode.function()([7.0, 8.0, 9.0], [10.0, 20.0], ode.p0)
    assert np.array(xdot).ravel() == pytest.approx([-10 / 1, (10 - 20) / 2, 20 / 3], rel=1e-14)
    assert np.array(y).ravel().tolist() == [9.0, 8.0]


REFUSED = {
    "when-equation": "input Real u; " + STATE
    + "equation when u > 1 then reinit(x, 0); end when; der(x) = u;",
    "algorithm section": STATE + "Real y; algorithm y := x; equation der(x) = y;",
    "initial equation": "Real x; initial equation x = 1; equation der(x) = 1;",
    "k is not supported here": "parameter Real k[2] = {1, 2}; " + STATE
    + "equation der(x) = k*{x, 1};",
    "for-equation that is not written out": "parameter Real h[4] = {1, 2, 3, 4}; "
    "Real y[4]; " + STATE
    + "equation for i in 1:4 loop y[i] = h[i] + h[5 - i]; end for; der(x) = y[1];",
    "have no pivot that never vanishes": STATE + "Real a; Real b; equation x*a + 2*x*b = 1; "
    "x*a - x*b = 2; der(x) = a;",
    "built-in function mod": STATE + "equation der(x) = mod(x, 2);",
    "time is not supported": STATE + "equation der(x) = time;",
    "nonlinear equations for y": STATE + "Real y; equation y + y^3 = x; der(x) = y;",
    "nonlinear equations for z": STATE + "Real z; equation z = if z > 0 then x else 2; der(x) = z;",
    "x is neither a state (fixed = true)": "Real x; equation der(x) = 1;",
    "asks for the derivative of an input": "input Real u; " + STATE
    + "Real y; Real w; equation y = u + x; w = der(y); der(x) = w - u;",
    "y has fixed = true but no derivative": STATE
    + "Real y(start = 1, fixed = true); equation der(x) = 1; y = x;",
    "binding of b depends on other": "parameter Real a = 1; parameter Real b = 2*a; " + STATE
    + "equation der(x) = b;",
    "parameter a has no value": "parameter Real a; " + STATE + "equation der(x) = a;",
    "more than parameters": STATE + 'equation der(x) = 1; assert(x < 10, "too far");',
    "d is discrete": "discrete Real d; " + STATE + "equation d = 1; der(x) = d;",
    "s is type String": 'parameter String s = "a"; ' + STATE + "equation der(x) = 1;",
    "structurally singular": STATE + "Real y(start = 0, fixed = true); Real a; "
    "equation der(x) = a; der(y) = -a; x = y;",
}  # fmt: skip


@pytest.mark.parametrize("message", REFUSED)
def test_refusals_name_class_and_construct(tmp_path, message):
    with pytest.raises(flat.Unsupported) as raised:
        model(tmp_path, REFUSED[message])
    assert message in str(raised.value)
    assert str(raised.value).startswith("M")


def test_statements_of_functions_are_refused(tmp_path):
    loop = (
        "function g input Real a; output Real y; algorithm y := 0; "
        "for i in 1:3 loop y := y + a; end for; end g; "
    )
    with pytest.raises(flat.Unsupported, match="for statement in function g"):
        model(tmp_path, STATE + "equation der(x) = g(x);", before=loop)
    outside = 'function g input Real a; output Real y; external "C"; end g; '
    with pytest.raises(ValueError, match="external function"):
        model(tmp_path, STATE + "equation der(x) = g(x);", before=outside)


def test_partial_class_is_refused(tmp_path):
    file = tmp_path / "M.mo"
    file.write_text("partial model M Real x(start = 0, fixed = true); equation der(x) = 1; end M;")
    with pytest.raises(ValueError, match="M"):
        causal.load(file, "M")


def test_what_does_not_compile_is_one_message(tmp_path):
    wrong_models = (
        (STATE + "\nequation\n der(x) = nowhere;", r"M\.mo:3: M .*nowhere"),
        (STATE + "\n Real x equation", r"M\.mo:2: M .*unexpected"),
        ("input Real u; " + STATE + "equation der(x) = der(u);", r"M\.mo: .*derivative"),
    )
    for body, wrong in wrong_models:
        with pytest.raises(ValueError, match=wrong) as raised:
            model(tmp_path, body)
        assert "\n" not in str(raised.value)
    with pytest.raises(ValueError, match=r"none\.mo: there is no such Modelica file"):
        causal.load(tmp_path / "none.mo", "M")
    with pytest.raises(ValueError, match=r"MotionControl\.Nothing"):
        causal.load(PACKAGE, "MotionControl.Nothing")
