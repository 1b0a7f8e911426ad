"""C text, FMU description and fmu.toml of Modelica FMUs."""

import ctypes
import re

import casadi as ca
import numpy as np
import pytest
from few_cases import few
from plant_library import BUILD, PACKAGE, ROOT, Library, Run, array

from motionfmu.fmu import fmu_toml
from motionfmu.fmu.modelica import causal, class_description, codegen, cprint
from motionfmu.fmu.modelica.nodes import program

# What they share is made once, by one worker.
pytestmark = pytest.mark.xdist_group("modelica code")

BALL_SCREW = ROOT / "fmus/ball_screw_axes/fmu.toml"


@pytest.fixture(scope="module")
def axis():
    return causal.load(PACKAGE, "MotionControl.BallScrewAxis")


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    return Library(BALL_SCREW, tmp_path_factory.mktemp("ball_screw"))


@pytest.mark.parametrize("lanes", codegen.WIDTHS)
def test_c_equals_casadi_in_every_lane(library, axis, lanes):
    rng = np.random.default_rng(2)
    f = axis.function()
    constants = int(re.search(r"PLANT_CONSTANTS = (\d+)", codegen.generate(axis, 6)[1])[1])
    for _ in range(120 // (2 + lanes)):
        p = np.array(axis.p0) * rng.uniform(0.5, 1.5, (lanes, len(axis.p0)))
        p[:, [d.name for d in axis.parameters].index("backlash")] = rng.choice([0.0, 1e-5], lanes)
        s = rng.uniform(-0.6, 0.6, lanes)
        lead = p[:, [d.name for d in axis.parameters].index("lead")]
        angle = (s + rng.normal(size=lanes) * 1e-5) * 2 * np.pi / lead
        x = np.array(
            [rng.normal(size=lanes), angle, rng.normal(size=lanes) * 5, s, rng.normal(size=lanes)]
        )
        u = rng.normal(size=(2, lanes)) * [[3.0], [50.0]]
        c = np.empty((constants, lanes))
        for i in range(lanes):
            one = array(np.empty(constants))
            library.c.plant_constants(array(p[i]), one)
            c[:, i] = one
        dx, y = array(np.empty((5, lanes))), array(np.empty((12, lanes)))
        getattr(library.c, f"plant_rhs_{lanes}")(array(x), array(u), array(c), dx)
        getattr(library.c, f"plant_outputs_{lanes}")(array(x), array(u), array(c), y)
        for i in range(lanes):
            expected = [np.array(r).ravel() for r in f(x[:, i], u[:, i], p[i])]
            # Divisions by parameters became multiplications: an ulp of 0.6 m is 1e-8 N at 1e8 N/m
            assert np.reshape(dx, (5, lanes))[:, i] == pytest.approx(
                expected[0], rel=1e-12, abs=1e-5
            )
            assert np.reshape(y, (12, lanes))[:, i] == pytest.approx(
                expected[1], rel=1e-12, abs=1e-6
            )


@pytest.mark.parametrize(
    ("fmu", "axes", "moves"),
    few(
        [
            ("stepper_axes", [1, 2, 3], {"pulse_count": 40}),
            ("ball_screw_axes", [1, 2, 3, 4, 6], {"torque_command": 0.8}),
            ("robot_arm", [0], {"torque": 0.3}),
        ],
        1,
    ),
)
def test_every_processor_gives_the_same_bits(tmp_path, fmu, axes, moves):
    """Vectors of AVX2 against those that every processor has, both as the build compiled them."""
    library = Library(ROOT / "fmus" / fmu / "fmu.toml", tmp_path, built=True)
    if not library.wide.value:
        pytest.skip("needs a processor with AVX2")
    outputs = [v.name for v in library.description.variables if v.causality == "output"]
    for used in axes:
        active = {"active": np.arange(6) < used} if used else {}
        runs = {wide: Run(library, **active).set(**moves) for wide in (True, False)}
        first = {}
        for k in range(100):
            for library.wide.value, run in runs.items():
                assert (run.start() if k == 0 else run.step(1e-4)) == 0, run.said
            here, everywhere = ({o: run.get(o) for o in outputs} for run in runs.values())
            first = first or here
            for o in outputs:
                assert here[o].tobytes() == everywhere[o].tobytes(), (used, k, o)
        assert any(here[o].tobytes() != first[o].tobytes() for o in outputs)


@pytest.mark.parametrize(
    "largest", few([codegen.WHOLE_JACOBIAN, 0], 1), ids=["whole", "by columns"]
)
def test_jacobian_with_the_true_branches_is_casadis(tmp_path, monkeypatch, largest, axis):
    """Among all branches one gives CasADi's Jacobian, in contact and in the gap."""
    monkeypatch.setattr(codegen, "WHOLE_JACOBIAN", largest)
    library = Library(BALL_SCREW, tmp_path)
    assert ("static void along" in (tmp_path / "plant.c").read_text()) == (largest == 0)
    p, u = axis.values(backlash=1e-5), np.array([0.3, 2.0])
    exact = ca.Function("J", [axis.x, axis.u, axis.p], [ca.jacobian(axis.xdot, axis.x)])
    for stretch in (0.0, 2e-5, -2e-5):
        x = np.array([0.1, stretch * 2 * np.pi / 0.01, 1e-3, 0.0, 1e-6])
        distance = []
        for branches in range(16):
            a = array(np.empty(25))
            library.c.plant_jacobian(array(x), array(u), array(p), ctypes.c_uint(branches), a)
            wanted = np.array(exact(x, u, p))
            distance.append(np.max(np.abs(np.reshape(a, (5, 5)) - wanted) / (np.abs(wanted) + 1.0)))
        assert np.nanmin(distance) < 1e-12
        assert np.nanmax(distance) > 0.5, "other branches differ"


def test_every_operation_in_c_equals_casadi(tmp_path):
    """All C forms, by compiling one function of each and comparing with CasADi's value."""
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    unary = [ca.fabs, ca.sign, ca.sqrt, ca.floor, ca.ceil, ca.sin, ca.cos, ca.tan, ca.asin, ca.acos,
             ca.atan, ca.sinh, ca.cosh, ca.tanh, ca.exp, ca.log, lambda a: -a, lambda a: 1 / a,
             lambda a: a * a, lambda a: a + a, ca.logic_not]  # fmt: skip
    binary = [ca.fmin, ca.fmax, ca.atan2, ca.logic_and, ca.logic_or,
              lambda a, b: ca.if_else(a > b, a, 0),
              lambda a, b: a**b, lambda a, b: a < b, lambda a, b: a <= b, lambda a, b: a == b,
              lambda a, b: a != b, lambda a, b: a + b, lambda a, b: a - b, lambda a, b: a * b,
              lambda a, b: a / b, lambda a, b: a**2.5, lambda a, b: a + ca.inf * b]  # fmt: skip
    results = ca.vertcat(*[f(x) for f in unary], *[f(x, y) for f in binary])
    p = program([x, y], [results])

    def leaf(_, node):
        return "xy"[node.input[0]] if node.op == ca.OP_INPUT else None

    lines = cprint.statements(p, p.results[0], leaf)
    lines += [f"out[{k}] = a{n};" for k, n in enumerate(p.results[0])]
    text = (
        '#include <math.h>\n#include "elementary.h"\nvoid f(double x, double y, double *out)\n{'
        + "\n".join(lines)
        + "}\n"
    )
    (tmp_path / "f.c").write_text(text)
    Library.compile([tmp_path / "f.c", BUILD / "libelementary.a"], tmp_path / "f.so", [])
    c = ctypes.CDLL(str(tmp_path / "f.so"))
    exact = ca.Function("f", [x, y], [results])
    for at in ((0.5, 0.25), (0.25, 0.5), (0.5, 0.5), (0.9, -2.0), (0.3, 0.0)):
        out = array(np.empty(results.numel()))
        c.f(ctypes.c_double(at[0]), ctypes.c_double(at[1]), out)
        assert np.array(out) == pytest.approx(np.array(exact(*at)).ravel(), rel=1e-14, nan_ok=True)


def test_description_comes_from_the_class():
    d = fmu_toml.load(BALL_SCREW)
    by_name = {v.name: v for v in d.variables}
    assert (d.name, d.tick_ns, d.cores) == ("BallScrewAxes", 25, ())
    assert [v.name for v in d.variables][:2] == ["active", "micro_step"]
    assert by_name["micro_step"].start == [25e-6]
    assert by_name["micro_step"].dims == ()
    stiffness = by_name["screw_stiffness"]
    assert (stiffness.unit, stiffness.dims, stiffness.start) == ("N/m", (6,), [1e8] * 6)
    assert stiffness.min == 0.0
    assert stiffness.doc == "Axial stiffness from motor to table"
    assert by_name["encoder_lines"].type == "i32"
    assert by_name["encoder_lines"].start == [2500] * 6
    assert by_name["home_switch"].type == "bool"
    assert by_name["motor_phase"].unit is None
    assert by_name["motor_phase"].continuous
    assert [v.name for v in d.variables if v.causality == "input"] == ["torque_command", "force"]
    assert not any("." in v.name for v in d.variables)


TOML = """name = "Test"
description = "Test"
tick_ns = 25
experiment = { stop = 1.0, step = 1e-4 }
modelica = "Small.Axis"
instances = 2
micro_step = 25e-6
"""
CLASS = """within Small;
model Axis "Axis"
  parameter Real tau(unit = "s", min = 0) = 1 "Time constant";
  input Real u(unit = "V") "Input";
  output Real x(unit = "V", start = 0, fixed = true) "Output";
equation
  tau*der(x) = u - x;
end Axis;
"""


@pytest.fixture
def small(tmp_path):
    """A project of its own: modelica/Small and fmus/test/fmu.toml."""
    package = tmp_path / "modelica" / "Small"
    package.mkdir(parents=True)
    (package / "package.mo").write_text('within;\npackage Small "Test"\nend Small;\n')
    (package / "package.order").write_text("Axis\n")
    (package / "Axis.mo").write_text(CLASS)
    toml = tmp_path / "fmus" / "test" / "fmu.toml"
    toml.parent.mkdir(parents=True)
    toml.write_text(TOML)
    return toml


def test_a_project_elsewhere_works(small, tmp_path):
    d = fmu_toml.load(small)
    assert [v.name for v in d.variables] == [
        "active",
        "micro_step",
        "tau",
        "u",
        "x",
        "strict_step",
        "begin_state",
    ]
    codegen.write(small, tmp_path / "out")
    before = (tmp_path / "out" / "plant.c").stat().st_mtime_ns
    codegen.write(small, tmp_path / "out")
    assert (tmp_path / "out" / "plant.c").stat().st_mtime_ns == before, "equal text is left alone"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("tick_ns = 25", "tick_ns = 0", r"fmu.toml:3: tick_ns 0 is not a positive integer"),
        ("instances = 2", "instances = true", r"fmu.toml:6: instances True is not"),
        ("micro_step = 25e-6", "micro_step = nan", r"fmu.toml:7: micro_step nan is not a positive"),
        ("Small.Axis", "Large.Axis", r"fmu.toml:5: there is no package modelica/Large"),
        ("Small.Axis", "Small.Axes", r"Small.Axes"),
        ('"Small.Axis"', "7", r"fmu.toml:5: modelica 7 is not a class name"),
        ("instances = 2\n", "", r"fmu.toml: 'instances' is missing"),
        ("instances = 2", "instances = 2\ntolerance = 0.5", r"fmu.toml:7: tolerance 0.5 is not a"),
        ("instances = 2", "instances = 2\ntolerance = true", r"fmu.toml:7: tolerance True is not"),
        ("instances = 2", "instances = 2\ncores = []", r"fmu.toml:7: unknown key 'cores'"),
        (
            "micro_step = 25e-6",
            "micro_step = 25e-6\n[input]\nx = 1",
            r"fmu.toml:8: unknown key 'input'",
        ),
        ("name = ", "name : ", r"fmu.toml:1: "),
    ],
)
def test_wrong_fmu_toml(small, old, new, message):
    small.write_text(TOML.replace(old, new))
    with pytest.raises(ValueError, match=message):
        fmu_toml.load(small)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('(unit = "V") "Input"', ' "Input"', "Small.Axis: u has no unit"),
        ('unit = "V") "Input"', 'unit = "volt") "Input"', 'input u: unit "volt"'),
        (' "Input";', ";", "input u: doc is missing"),
        ("Real u(", "Real active(", "the name active is taken"),
        ("Real tau(", "Real Tau(", "a name is snake_case"),
        ("= 1 ", "= -1 ", "start -1.0 is outside 0.0"),
    ],
)
def test_declarations_an_fmu_cannot_carry(small, old, new, message):
    text = CLASS.replace(old, new)
    if "Real active" in new:
        text = text.replace("u - x", "active - x")
    if "Real Tau" in new:
        text = text.replace("tau*der", "Tau*der")
    (small.parents[2] / "modelica/Small/Axis.mo").write_text(text)
    with pytest.raises(ValueError, match=re.escape(message)):
        fmu_toml.load(small)


def test_the_largest_of_many_branches_is_found(small):
    """Slopes of 12 bends, stiff ones among those that help: the sum of the stiff ones."""
    slopes = [3e4 if k % 3 else -2e4 for k in range(12)]
    bends = " + ".join(f"({slope})*max(x - {k + 1}, 0)" for k, slope in enumerate(slopes))
    file = small.parents[2] / "modelica/Small/Axis.mo"
    file.write_text(CLASS.replace("u - x", f"u - x - ({bends})"))
    run = Run(Library(small, small.parent))
    assert run.start() == 0
    found = re.search(r"stiff, (\d+) sub-steps per micro step of (.*) s", run.said)
    bound = 1 + sum(s for s in slopes if s > 0)
    assert int(found[1]) == np.ceil(float(found[2]) * bound / 2)


def test_arrays_and_elements_of_ports(small):
    """An array of the class is one port, behind the axes; its elements have the same limits."""
    file = small.parents[2] / "modelica/Small/Axis.mo"
    gains = 'parameter Real k[3](each unit = "1", each min = 0) = {1, 2, 3} "Gains";\n  input'
    text = CLASS.replace("input", gains, 1).replace("u - x", "k[2]*u - k[3]*x")
    file.write_text(text)
    k = next(v for v in fmu_toml.load(small).variables if v.name == "k")
    assert k.dims == (2, 3) and k.start == [1, 2, 3, 1, 2, 3] and k.min == 0
    codegen.write(small, small.parent)
    assert "p[2] = v->k[instance][1];" in (small.parent / "plant.c").read_text()
    file.write_text(text.replace("each min = 0", "min = {0, 0, 1}"))
    with pytest.raises(ValueError, match=re.escape("k[3] has other limits than k[1]")):
        fmu_toml.load(small)


def test_too_many_branches_are_refused(small):
    bumps = " + ".join(f"abs(x - {k})" for k in range(codegen.MAX_BRANCHES + 1))
    file = small.parents[2] / "modelica/Small/Axis.mo"
    file.write_text(CLASS.replace("u - x", f"u - ({bumps})"))
    with pytest.raises(ValueError, match=r"Small\.Axis: 32 branches in the Jacobian, at most 31"):
        codegen.write(small, small.parent)
    assert not (small.parent / "plant.c").exists()


def test_a_class_without_state_is_refused(small):
    file = small.parents[2] / "modelica/Small/Axis.mo"
    text = CLASS.replace(", start = 0, fixed = true", "").replace("tau*der(x) = u - x", "x = tau*u")
    file.write_text(text)
    with pytest.raises(ValueError, match=r"Small\.Axis: a plant needs a state and an output"):
        codegen.write(small, small.parent)


def test_one_instance_has_scalars_and_lanes_of_its_own(small):
    for instances, dims, lanes in ((1, (), 1), (2, (2,), 2), (3, (3,), 4), (6, (6,), 6)):
        small.write_text(TOML.replace("instances = 2", f"instances = {instances}"))
        by_name = {v.name: v for v in fmu_toml.load(small).variables}
        assert {by_name[n].dims for n in ("active", "tau", "u", "x")} == {dims}
        codegen.write(small, small.parent)
        header = (small.parent / "plant.h").read_text()
        assert f"PLANT_LANES = {lanes}," in header
        widths = " ".join(f"X({n})" for n in codegen.WIDTHS if n <= lanes)
        assert f"#define PLANT_WIDTHS(X) {widths}\n" in header


SINE = CLASS.replace("tau*der(x) = u - x", "der(x) = v;\n  tau^2*der(v) = -x").replace(
    "equation",
    '  parameter Real v0(unit = "V/s") = 1e3 "Start";\nprotected\n'
    '  Real v(unit = "V/s", start = v0, fixed = true, nominal = 1/tau) "Speed";\nequation',
)


@pytest.mark.parametrize("tolerance", [1e-5, 1e-8])
def test_controlled_steps_keep_the_tolerance(small, tmp_path, tolerance):
    """A swing of 1 V at 1000 rad/s for a radian; the speed counts in units of 1/tau."""
    file = small.parents[2] / "modelica/Small/Axis.mo"
    file.write_text(SINE.replace("= 1 ", "= 1e-3 "))
    text = TOML.replace("25e-6", "1e-3") + f"tolerance = {tolerance}\n"
    small.write_text(text)
    library = Library(small, tmp_path)
    errors = []
    for tau in ([1e-3, 2e-3], [1e-3, 1e-4]):
        run = Run(library, tau=tau)
        assert run.start() == 0
        assert run.step(1e-3) == 0, run.said
        exact = 1e3 * np.array(tau) * np.sin(1e-3 / np.array(tau))
        errors.append(np.abs(run.get("x") - exact))
    assert tolerance / 100 < errors[0][0] < 20 * tolerance
    assert errors[0][0] == errors[1][0], "an axis does not change another's steps"


def test_a_nominal_of_states_is_refused(small):
    file = small.parents[2] / "modelica/Small/Axis.mo"
    file.write_text(SINE.replace("nominal = 1/tau", "nominal = 1 + x"))
    with pytest.raises(ValueError, match="nominal of v depends on more than parameters"):
        codegen.write(small, small.parent)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ('["tua"]', "Small.Axis: tunable: it has no Real parameter 'tua'"),
        ('["x"]', "Small.Axis: tunable: it has no Real parameter 'x'"),
        ('["tau", "tau"]', "is not a list of names, each once"),
        ("true", "is not a list of names, each once"),
        ("[1]", "is not a list of names, each once"),
    ],
)
def test_wrong_tunables_are_refused(small, given, said):
    text = TOML.replace("micro_step", f"tunable = {given}\nmicro_step")
    assert text != TOML
    small.write_text(text)
    with pytest.raises(ValueError, match=said):
        codegen.write(small, small.parent)


def test_a_tunable_parameter_is_described_and_looked_for(small, tmp_path):
    small.write_text(TOML.replace("micro_step", 'tunable = ["tau"]\nmicro_step'))
    library = Library(small, tmp_path)
    tau = next(v for v in library.description.variables if v.name == "tau")
    assert tau.tunable and tau.variability == "tunable"
    slow, quick = Run(library, tau=[1.0, 1.0]), Run(library, tau=[1.0, 1.0])
    for run in (slow, quick):
        assert run.start() == 0
        run.set(u=1.0)
    quick.set(tau=[1.0, 0.5])
    for run in (slow, quick):
        assert run.step(1e-3) == 0
    assert slow.get("x")[0] == quick.get("x")[0]
    assert slow.get("x")[1] != quick.get("x")[1]


def test_packing_finds_the_package():
    assert class_description.read(BALL_SCREW).package == PACKAGE
