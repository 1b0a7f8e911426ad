"""What makes a tuning quick gives the same numbers: CasADi, linprog, the plain recursion."""

import casadi as ca
import numpy as np
import pytest
from conftest import ROOT
from linear_rigs import DEMO
from scipy.optimize import linprog

import motionfmu
from motionfmu.analysis import linear
from motionfmu.analysis.linear.parts import equation
from motionfmu.analysis.linear.pointwise import Pointwise, Quick
from motionfmu.study.tune import problem, solve
from motionfmu.study.tune.curve import Loop
from motionfmu.study.tune.path_error import PathCost
from motionfmu.study.tune.tuning_functions import CostAndLimits, TuningFunctions

PLANTS = [
    f.parent.name for f in sorted((ROOT / "fmus").glob("*/fmu.toml")) if "modelica" in f.read_text()
]


@pytest.fixture(scope="module")
def study() -> TuningFunctions:
    scenario = motionfmu.load(DEMO)
    return TuningFunctions(scenario, problem({"velocity": True}), scenario.run())


@pytest.mark.parametrize("plant", PLANTS)
def test_a_plant_at_many_points_is_that_of_casadi(plant: str) -> None:
    """5000 states, more than one block: its equation to rounding, all branches."""
    ode = equation(plant).ode
    xdot = ca.substitute([ode.xdot], [ode.u, ode.p], [ca.DM(ode.u0), ca.DM(ode.p0)])[0]
    draw, count = np.random.default_rng(3), 5000
    x = draw.normal(size=(len(ode.states), count)) * np.geomspace(1e-6, 10.0, count)
    plain = ca.Function("plain", [ode.x], [ca.densify(xdot)]).map(count)(x).full()
    found = Pointwise(ode.x, [xdot])(x)[0]
    scale = np.abs(plain).max(axis=1, keepdims=True) + 1e-300
    np.testing.assert_allclose(found / scale, plain / scale, rtol=0.0, atol=1e-12)


def test_every_operation_is_that_of_casadi() -> None:
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    each = [
        *(x + y, x - y, x * y, x / y, -x, 1 / x, x**2, 2 * x, x**y, x**3, ca.fabs(y)),
        *(ca.fmin(x, y), ca.fmax(x, y), x < y, x <= y, ca.eq(x, y), ca.ne(x, y), ca.sign(y)),
        *(ca.logic_not(x < y), ca.logic_and(x < 1, y < 0), ca.logic_or(x < 1, y < 0)),
        *(ca.if_else(x < y, x, y), ca.floor(x), ca.ceil(y), ca.sqrt(x), ca.exp(y), ca.log(x)),
        *(f(y) for f in (ca.sin, ca.cos, ca.tan, ca.sinh, ca.cosh, ca.tanh, ca.atan)),
        *(ca.asin(y / 3), ca.acos(y / 3), ca.atan2(x, y), ca.SX(7.0)),
    ]
    draw = np.random.default_rng(4)
    at = np.vstack([draw.uniform(0.1, 3.0, 300), draw.uniform(-2.0, 2.0, 300)])
    at[1, :30] = at[0, :30]
    both, result = ca.vertcat(x, y), ca.vertcat(*each)
    plain = ca.Function("f", [both], [result]).map(300)(at).full()
    np.testing.assert_allclose(Pointwise(both, [result])(at)[0], plain, rtol=1e-14, equal_nan=True)
    with pytest.raises(ValueError, match=r"CasADi operation \d+ has no form in numpy here"):
        Pointwise(both, [ca.erf(x)])


def test_a_quick_call_has_the_bits_of_a_plain_one() -> None:
    ode = equation("ball_screw_axes").ode
    arguments, results = [ode.x, ode.p], [ca.jacobian(ode.xdot, ode.x), ode.xdot[:0]]
    free = ca.substitute(results, [ode.u], [ca.SX.zeros(ode.u.shape)])
    at = np.linspace(0.1, 0.5, len(ode.states)), np.array(ode.p0)
    quick = Quick("q", arguments, free)
    first = quick(*at)
    quick(*(2.0 * v for v in at))
    for found, plain in zip(first, ca.Function("f", arguments, free)(*at), strict=True):
        assert found.shape == plain.shape and (found == plain.full()).all()


def test_a_loop_at_many_frequencies_is_that_at_one(study: TuningFunctions) -> None:
    part, gains = study.parts[0][1], study.gains(study.present)[1]
    for name in part.loops:
        loop: Loop = part.loop(name, gains)
        omega = loop.grid()
        omega = omega[omega > 3e-4 / loop.period]  # below, the loop is 10^12: digits of A are lost
        many, one = loop.value(omega), loop.at(omega)
        np.testing.assert_allclose(many, one[0], rtol=1e-8)
        np.testing.assert_allclose(loop.steep(omega)[1], one[1], rtol=1e-7)


def test_axes_alike_share_what_they_need_not_compute_twice(
    study: TuningFunctions, monkeypatch: pytest.MonkeyPatch
) -> None:
    one, two = study.axes.values()
    assert one.alike(two) and study.parts[0][1] is study.parts[0][2]
    for name, value in (("mcc.p_gain", [200, 201] * 3), ("machine.table_mass", [100.0, 101.0] * 3)):
        unequal = [linear.model(study.scenario, k, study.at, {name: value}) for k in (1, 2)]
        assert not unequal[0].alike(unequal[1])
    line = motionfmu.load(ROOT / "scenarios/mismatch_line")
    assert not linear.model(line, 1).alike(linear.model(line, 2))
    monkeypatch.setattr(linear.AxisModel, "alike", lambda *_: False)
    apart = TuningFunctions(study.scenario, study.problem, study.base)
    assert apart.parts[0][1] is not apart.parts[0][2]
    alone, shared = apart.values(study.present), study.values(study.present)
    for found, wanted in ((shared.costs, alone.costs), (shared.slack, alone.slack)):
        np.testing.assert_allclose(found, wanted, rtol=1e-9)
    np.testing.assert_allclose(shared.dslack, alone.dslack, rtol=1e-7, atol=1e-9)


def test_the_global_search_sees_what_there_is(study: TuningFunctions) -> None:
    """Where limits are kept, a cost of fewer samples is the same within 5 %; they are fewer."""
    draw, kept = np.random.default_rng(6), 0
    for z in np.repeat(draw.uniform(0.3, 0.8, (40, 3)), 2, axis=1):
        fine, rough = study.values(z, False), study.rough(z)
        if fine.feasible():
            kept += 1
            assert rough.worst == pytest.approx(fine.worst, rel=0.05) and rough.worst != fine.worst
    assert kept > 3
    assert isinstance(study._rough, PathCost) and len(study._rough.time) == len(study.path.time) / 2


def test_what_is_called_settled_cannot_be_bettered() -> None:
    """Against linprog: limits at random, at vertices and beside them."""
    draw, said = np.random.default_rng(7), {True: 0, False: 0}
    for k in range(60):
        n = int(draw.integers(1, 5))
        limits, slack = draw.normal(size=(n, n)), np.abs(draw.normal(size=n)) * (k % 3) * 1e-9
        slope = limits.T @ (draw.uniform(0.0, 1.0, n) - (0.3 if k % 2 else 0.0))
        values = CostAndLimits(np.array([2.0]), slack, 2.0 * slope[None, :], limits)
        box = (-solve._BOX, solve._BOX)
        best = linprog(slope, A_ub=-limits, b_ub=slack, bounds=[box] * n)
        settled = solve._settled(values)
        said[settled] += 1
        assert not settled or -best.fun < solve._SETTLED
    assert min(said.values()) > 10
    assert not solve._settled(CostAndLimits(np.ones(2), slack, np.zeros((2, n)), limits))
