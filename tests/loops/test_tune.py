"""Tuning: slopes against differences, margins and motions against theory and FMUs, brute force."""

import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import control
import numpy as np
import pytest
from conftest import ROOT
from console import command
from linear_rigs import DEMO, THEORY, kp_of

import motionfmu
from motionfmu.analysis import linear
from motionfmu.analysis.linear.stability import margins
from motionfmu.base.errors import InputError
from motionfmu.cli.common import settings
from motionfmu.run import Options
from motionfmu.study.tune import RanAway, Tuned, choice, problem, tune
from motionfmu.study.tune.axis_study import AxisStudy, Signals
from motionfmu.study.tune.choice import DecisionVariable
from motionfmu.study.tune.curve import Loop, margin
from motionfmu.study.tune.problem import ON_PATH
from motionfmu.study.tune.solve import solve
from motionfmu.study.tune.steps import ArrayWithSlopes, lifted, system
from motionfmu.study.tune.tuning_functions import CostAndLimits, TuningFunctions
from motionfmu.study.tune.tuning_words import assumptions, summed

GAINS = ["mcc.p_gain", "drives.velocity_gain", "drives.velocity_time"]
SIGNALS = Signals("card.pulses", "machine.table_position", ("drives.torque", "card.dac"))
POINTS = [np.array(p) for p in ([200.0, 0.5, 0.02], [420.0, 0.85, 0.03], [294.0, 0.99, 0.005])]


@pytest.fixture(scope="module")
def axis() -> AxisStudy:
    model = linear.model(DEMO, 1, at={"machine.table_speed": 0.1})
    return AxisStudy(model, GAINS, SIGNALS)


@pytest.fixture(scope="module")
def base() -> motionfmu.Result:
    return motionfmu.load(DEMO).run()


@pytest.fixture(scope="module")
def tuned() -> Tuned:
    return tune(DEMO, {"check": 20})


def differences(function: Any, at: np.ndarray) -> np.ndarray:
    """Central differences of a function, one row for each gain."""
    rows = []
    for k in range(len(at)):
        h = np.zeros(len(at))
        h[k] = 1e-5 * at[k]
        rows.append((function(at + h) - function(at - h)) / (2.0 * h[k]))
    return np.array(rows)


def stepped(gain: int, tau: float) -> tuple[TuningFunctions, CostAndLimits]:
    """ISE of both axes of the loop of theory at a gain."""
    chosen = {"machine.tau": tau}
    asked = problem({"cost": "ise", "bounds": {"mcc.p_gain": [50, 8000]}})
    loaded = motionfmu.load(THEORY)
    study = TuningFunctions(loaded, asked, loaded.run(set=chosen), chosen)
    return study, study.values(np.array([v.share(gain) for v in study.variables]), False)


def agree(slopes: np.ndarray, expected: np.ndarray, share: float) -> None:
    scale = np.abs(expected).max()
    assert np.abs(slopes - expected).max() <= share * scale, (slopes, expected)


def random_system(at: float, rate: bool) -> tuple[ArrayWithSlopes, ...]:
    """A, B, C, D of five states, two inputs, three outputs, along a line of one gain."""
    draw, found = np.random.default_rng(1), []
    for shape, size in (((5, 5), 0.3), ((5, 2), 1.0), ((3, 5), 1.0), ((3, 2), 1.0)):
        first, then = size * draw.normal(size=shape), 0.1 * draw.normal(size=(1, *shape))
        found.append(ArrayWithSlopes(first + at * then[0], then if rate else then[:0]))
    return tuple(found)


@pytest.mark.parametrize("count", [31, 201])
def test_chunks_are_the_plain_recursion(count: int) -> None:
    """All outputs, at one step too; slopes are differences, of inputs that move with the gain."""
    u, du = np.random.default_rng(2).normal(size=(2, 2, count))

    def plain(at: float) -> np.ndarray:
        (a, b, c, d), x, found = (m.value for m in random_system(at, False)), np.zeros(5), []
        for now in (u + at * du).T:
            found.append(c @ x + d @ now)
            x = a @ x + b @ now
        return np.array(found).T

    driven = system(*random_system(0.0, True)).driven(u, du[None])
    found = driven.outputs(slice(1, None))
    np.testing.assert_allclose(found.value, plain(0.0)[1:], atol=1e-12)
    slopes = (plain(1e-5) - plain(-1e-5)) / 2e-5
    np.testing.assert_allclose(found.slopes[0], slopes[1:], atol=1e-7)
    for k in (0, count // 2, count - 1):
        one = driven.at(1, k)
        np.testing.assert_allclose(one.value, found.value[0, k], atol=1e-12)
        np.testing.assert_allclose(one.slopes, found.slopes[:, 0, k], atol=1e-12)
    alone = system(*random_system(0.0, False)).driven(u).outputs(slice(1, None))
    assert (alone.value == found.value).all() and alone.slopes.shape == (0, 2, count)


@pytest.mark.parametrize("periods", [1, 5, 8])
def test_periods_together_are_the_plain_recursion(periods: int) -> None:
    """Their input goes straight from sample to sample; slopes are differences."""
    u, count = np.cumsum(np.random.default_rng(3).normal(size=(2, 41)), axis=1), 41

    def along(at: float, rate: bool) -> tuple[ArrayWithSlopes, ...]:
        return lifted(*random_system(at, rate)[:2], periods)

    a, b = (m.value for m in random_system(0.0, False)[:2])
    whole, begin, end = (m.value for m in along(0.0, True))
    x = np.zeros(5)
    for k in range(count - 1):
        known = whole @ x + begin @ u[:, k] + end @ u[:, k + 1]
        for j in range(periods):
            x = a @ x + b @ (u[:, k] + j / periods * (u[:, k + 1] - u[:, k]))
        np.testing.assert_allclose(known, x, rtol=1e-12, atol=1e-12)
    sides = zip(along(1e-5, False), along(-1e-5, False), along(0.0, True), strict=True)
    for up, down, found in sides:
        slope = (up.value - down.value) / 2e-5
        np.testing.assert_allclose(found.slopes[0], slope, atol=1e-7)


@pytest.mark.parametrize("gains", POINTS, ids=str)
def test_slopes_are_differences(axis: AxisStudy, gains: np.ndarray) -> None:
    t = 1e-3 * np.arange(700)
    pulses = np.round(20_000 * (1.0 - np.cos(9.0 * t)))  # two reversals
    found = axis.motion(gains, pulses, 10)

    def numbers(g: np.ndarray) -> np.ndarray:
        motion = axis.motion(g, pulses, 10, False)
        return np.append(motion.position.value, [peak.value for peak in motion.peaks])

    expected = differences(numbers, gains)
    for k in range(3):
        agree(found.position.slopes[k], expected[k, :700], 2e-3)
        for peak, slope in zip(found.peaks, expected[k, 700:], strict=True):
            assert peak.slopes[k] == pytest.approx(slope, rel=2e-3, abs=2e-3 * abs(peak.value))
    step = axis.step(gains, 5, 400)
    agree(step.slopes, differences(lambda g: axis.step(g, 5, 400, False).value, gains), 1e-5)
    agree(axis.slowest(gains)[1], differences(lambda g: np.array(axis.slowest(g)[0]), gains), 1e-4)
    for name in axis.loops:
        slopes = margin(axis.loop(name, gains)).slopes.T
        expected = differences(lambda g, n=name: margin(axis.loop(n, g)).values, gains)
        agree(slopes, expected, 1e-4)


@pytest.mark.parametrize("lead", [0.0, 3.0])
def test_the_slope_of_a_phase_on_either_side(lead: float) -> None:
    """1/s^2 held between samples lacks phase, with a lead it has some: both by differences."""
    plant = control.c2d(control.ss([[0, 1], [0, 0]], [[0], [1]], [[1, lead]], 0), 0.01)

    def loop(gain: float) -> Loop:
        none = np.zeros((1, 2, 2)), np.zeros((1, 2, 1))
        matrices = plant.A, plant.B, gain * plant.C, gain * plant.D
        return Loop(*matrices, *none, plant.C[None], plant.D[None], 0.01)

    at, h = 2.0, 1e-5
    found, up, down = margin(loop(at)), margin(loop(at + h)).values, margin(loop(at - h)).values
    w = np.geomspace(0.1, 300.0, 100_000)
    values = loop(at).value(w)
    crossing = int(np.flatnonzero(np.abs(values) > 1.0)[-1])
    lag = np.angle(-values[crossing])
    assert (lag < 0.0) == (lead == 0.0)
    assert found.values[3] == pytest.approx(abs(lag), rel=1e-3)
    assert found.slopes[3, 0] == pytest.approx((up[3] - down[3]) / (2.0 * h), rel=1e-4)


@pytest.mark.parametrize("gains", POINTS, ids=str)
def test_margins_are_those_of_the_linear_model(axis: AxisStudy, gains: np.ndarray) -> None:
    model = axis.axis.changed(dict(zip(GAINS, [int(gains[0]), *gains[1:]], strict=True)))
    for name, cut in axis.loops.items():
        found, known = margin(axis.loop(name, gains)).values, margins(model.loop(name, cut))
        assert 1.0 / found[0] == pytest.approx(known.sensitivity, rel=1e-4)
        assert math.exp(found[1]) == pytest.approx(known.gain, rel=1e-6)
        assert math.degrees(found[3]) == pytest.approx(known.phase, rel=1e-6)


def test_a_circle_has_the_radius_of_theory() -> None:
    """Ideal drive, one sample of delay: |K T / (z (z - 1) + K T)|, and a lag of 1/K."""
    model = linear.model(THEORY)
    study = AxisStudy(model, ["mcc.p_gain"], Signals("card.pulses", "machine.table_position", ()))
    gains, period = np.array([float(model.value("mcc.p_gain"))]), study.period
    kp, w = kp_of(model), 8.0
    t = 10 * period * np.arange(4000)
    y = study.motion(gains, np.cos(w * t) * 1e6, 10).position.value
    settled = t > 1.0
    waves = np.stack([np.cos(w * t), np.sin(w * t)])[:, settled]
    radius = np.linalg.norm(np.linalg.lstsq(waves.T, y[settled], rcond=None)[0])
    z = np.exp(1j * w * period)
    wanted = abs(kp * period / (z * (z - 1.0) + kp * period))
    lead = 1e6 / 10_000 * 0.01  # [m] of 10^6 pulses
    # between samples the command is a chord: shorter by (w dt)^2/12
    chord = 1.0 - (w * 10 * period) ** 2 / 12.0
    assert radius / lead == pytest.approx(wanted * chord, rel=1e-7)
    assert study.lag(gains) == pytest.approx(1.0 / kp, rel=1e-9)


def test_nearest_points_are_those_of_the_contour_analysis(base: motionfmu.Result) -> None:
    study = TuningFunctions(motionfmu.load(DEMO), problem({}), base)
    contour, stride = base.contour(), slice(None, None, 10)
    table = base["machine.table_position"]
    error = study.path.error({k: table[stride, k - 1] - table[0, k - 1] for k in (1, 2)})
    wanted = contour.track.distance[stride][contour.cutting[stride]]
    np.testing.assert_allclose(error.distance, wanted, atol=1e-9)
    for cost in ("contour_rms", "contour_max"):
        value, slope = error.cost(cost)
        assert contour.error.rms * 0.99 < value < contour.error.max * 1.6
        assert np.sum(slope * error.gap) == pytest.approx(value)  # homogeneous of degree one
    modelled = study.path.error(study.motions(study.present))
    assert modelled.rms == pytest.approx(contour.error.rms, rel=0.01)
    assert modelled.max == pytest.approx(contour.error.max, rel=0.03)


def test_the_demo_is_tuned_to_its_limit(tuned: Tuned) -> None:
    assert tuned.stopped_by == ["overshoot 5 %, axes 1, 2"]
    after, before = (r[0].result.contour().error for r in (tuned.after, tuned.before))
    assert after.rms < before.rms / 4.0 and after.max < before.max / 3.0
    assert tuned.after[0].model.rms == pytest.approx(after.rms, rel=0.02)
    assert tuned.after[0].result["mcc.done"][-1]
    assert tuned.values.feasible()
    text = " ".join(tuned.toml().splitlines())
    for said in ("card.enc_phase reads machine.motor_phase", "card samples every 100 µs"):
        assert said in text
    first = tuned.settings["mcc.p_gain"][0]
    assert f"= {first} (Kp {first / 200 * 47.683716:#.3g} 1/s)" in text
    found = tuned.found
    assert found.starts[0] == pytest.approx(found.starts[1], rel=1e-4)
    # The global search alone, of some twenty points, is near but no better.
    assert found.values.worst <= found.check < 1.5 * found.values.worst
    assert found.evaluations[1] >= 20


def test_what_a_scenario_records_changes_no_gain(tuned: Tuned) -> None:
    """Nor what is told of the runs: the tuner takes a row for each step."""
    sparse = motionfmu.load(DEMO).changed(record={"every": 7})
    again = tune(sparse, {"check": 20})
    assert again.settings == tuned.settings
    for one, other in zip(again.before + again.after, tuned.before + tuned.after, strict=True):
        assert one.fmus.values.tobytes() == other.fmus.values.tobytes()
    with pytest.raises(InputError, match="needs each step of its run, not one of 7: every = 1"):
        TuningFunctions(sparse, problem({}), sparse.run())


def test_the_demo_is_as_good_as_brute_force(tuned: Tuned) -> None:
    """In steps of 2 and then 0.1 of the register, which is 0.05 % of the cost."""
    study, best, register = tuned.study, math.inf, 400.0
    for width, step in ((40.0, 2.0), (2.0, 0.1)):
        for one in register + np.arange(-width, width + step / 2.0, step):
            z = np.array([v.share(one) for v in study.variables])
            values = study.values(z, False)
            if values.feasible() and values.worst < best:
                best, register = values.worst, one
    assert tuned.found.values.worst == pytest.approx(best, rel=1e-3)


def test_no_register_is_better_in_runs_of_the_fmus(tuned: Tuned) -> None:
    """Costs by runs, overshoot by python-control: nothing of the tuner."""
    study = tuned.study

    def overshoot(register: int) -> float:
        loop = study.axes[1].changed({"mcc.p_gain": register})
        step = loop.system("card.pulses", "machine.table_position")
        y = control.step_response(step, step.dt * np.arange(3000)).outputs
        return float(y.max() / step.dcgain() - 1.0)

    looked = range(400, 424)
    first, second = [r for r in looked if overshoot(r) <= 0.05][-2:]
    assert second < looked[-1]
    found = tuple(tuned.settings["mcc.p_gain"][:2])
    costs = {}
    for pair in {(300, 300), (380, 380), (first, first), (first, second), (second, second), found}:
        ran = study.scenario.run(set={"mcc.p_gain": [*pair, *[200] * 4]})
        costs[pair] = ran.contour().error.rms
    assert costs[found] == pytest.approx(min(costs.values()), rel=1e-3)


def test_a_gains_file_is_taken_assettings(tuned: Tuned, tmp_path: Path) -> None:
    file = tmp_path / "gains.toml"
    file.write_text(tuned.toml())
    given = settings([str(file), "mcc.irq_latency=1e-3"])
    assert given == {**tuned.settings, "mcc.irq_latency": 1e-3}
    assert tuned.settings["mcc.p_gain"][2:] == [200] * 4
    motionfmu.load(DEMO).resolved(Options(set=given))
    with pytest.raises(InputError, match=r"--set .*none\.toml: No such file"):
        settings([str(tmp_path / "none.toml")])


def test_a_family_is_held_at_every_corner(base: motionfmu.Result, tuned: Tuned) -> None:
    asked = {"axes": "equal", "starts": 1, "check": 0}
    alone = tuned.found
    ranges = {"machine.table_mass": [50.0, 250.0]}
    study = TuningFunctions(motionfmu.load(DEMO), problem({**asked, "family": ranges}), base)
    found = solve(study)
    assert study.plants == [{}, {"machine.table_mass": 50.0}, {"machine.table_mass": 250.0}]
    assert found.values.feasible() and len(found.values.costs) == 3
    assert {x.plant for x in found.stopped_by} == {2}  # the heavy one overshoots first
    assert found.values.costs[0] > 1.01 * alone.values.worst
    nominal = study.values(alone.z[:1], False)
    assert nominal.slack[[x.plant == 2 for x in study.limits]].min() < -0.02


class Formula:
    """A study whose cost is a formula of one gain."""

    def __init__(self, cost: Any, bounds: tuple[float, float], limit: float = math.inf) -> None:
        self.cost, self.limit = cost, limit
        self.variables = [
            DecisionVariable("card.gain", (1,), *bounds, math.sqrt(bounds[0] * bounds[1]), False)
        ]
        self.names, self.plants, self.evaluations = ["card.gain"], [{}], 0
        self.limits = [SimpleNamespace(what="largest gain", axis=1, plant=0)]
        self.problem = problem({"cost": "ise", "check": 30})
        self.scenario = SimpleNamespace(document=SimpleNamespace(file="formula.toml"))
        self.present = np.array([0.5])

    def values(self, z: np.ndarray, slopes: bool = True) -> CostAndLimits:
        self.evaluations += 1
        variable = self.variables[0]
        k = variable.value(float(z[0]))
        rate = (self.cost(k * 1.000001) - self.cost(k * 0.999999)) / (2e-6 * k)
        slope = variable.slope(k)
        slack = np.array([1.0 - k / self.limit])
        room = np.array([[-slope / self.limit]])
        return CostAndLimits(np.array([self.cost(k)]), slack, np.array([[rate * slope]]), room)

    def rough(self, z: np.ndarray) -> CostAndLimits:
        return self.values(z, False)


@pytest.mark.parametrize(
    "cost",
    [
        lambda k: (1.0 + 0.005 * k) / (2.0 * k),  # ISE of K/(s (0.005 s + 1))
        lambda k: 1.0 / k**2,  # ITAE of K/s
    ],
    ids=["ise", "itae"],
)
def test_a_cost_without_delay_runs_away_and_is_told(cost: Any) -> None:
    with pytest.raises(RanAway, match=r"card\.gain\[1\] ran to its own upper bound 1000"):
        solve(Formula(cost, (1.0, 1000.0)))  # type: ignore[arg-type]
    found = solve(Formula(cost, (1.0, 1000.0), limit=200.0))  # type: ignore[arg-type]
    assert [x.what for x in found.stopped_by] == ["largest gain"]


def test_a_delay_bounds_the_gain_as_theory_says() -> None:
    """ISE of K exp(-s d)/s is cos(K d) / (2 K (1 - sin(K d))): least at K d = 0.7391."""
    delay = 1e-3

    def ise(k: float) -> float:
        return math.cos(k * delay) / (2.0 * k * (1.0 - math.sin(k * delay)))

    study = Formula(ise, (20.0, 1500.0))
    found = solve(study)  # type: ignore[arg-type]
    assert not found.stopped_by
    best = min(ise(k) for k in np.linspace(20.0, 1500.0, 20001))
    assert found.values.worst == pytest.approx(best, rel=1e-4)
    gain = study.variables[0].value(float(found.z[0]))
    assert gain * delay == pytest.approx(0.7391, abs=0.01)


@pytest.mark.parametrize("gain", [200, 1000, 3000])
def test_the_ise_of_a_step_is_the_sampled_loops(gain: int) -> None:
    """e[n+1] = e[n] - k e[n-1] from 1, 1: sum of squares (1 + k)/(k (1 - k)(2 + k))."""
    study, values = stepped(gain, 0.0)
    k, period = kp_of(study.axes[1]) * gain / 200.0 * 1e-4, 1e-4
    squares = (1.0 + k) / (k * (1.0 - k) * (2.0 + k))
    expected = period * (squares - 0.5)  # trapezoids
    assert values.costs[0] / 2.0 == pytest.approx(expected, rel=2e-3)


def test_the_ise_of_a_lag_is_the_published_formula() -> None:
    """(1 + tau K)/(2 K) without delay; the 1.5 periods of the loop add less than half of them."""
    study, values = stepped(200, 0.005)
    k = kp_of(study.axes[1])
    assert any("ise is the sum over axes 1, 2" in text for text in assumptions(study))
    more = values.costs[0] / 2.0 - (1.0 + 0.005 * k) / (2.0 * k)
    assert 0.0 < more < 0.75e-4


def test_a_machine_without_a_program_is_told_so(tmp_path: Path) -> None:
    done = command("tune", "mill3", "--out", tmp_path / "out")
    assert done.returncode == 2
    assert done.stderr.endswith("a program's path: tune PROGRAM --machine mill3\n")
    assert not (tmp_path / "out").exists()


def test_the_command_refuses_a_gain_that_ran_away(tmp_path: Path) -> None:
    file, out = tmp_path / "away.toml", tmp_path / "out"
    file.write_text(
        'cost = "itae"\naxes = "equal"\nstarts = 1\ncheck = 0\n[bounds]\n"mcc.p_gain" = [50, 300]\n'
        "[limits]\novershoot = 1e6\nrecovery = 1e6\n[limits.margins]\n"
    )
    done = command("tune", "scenarios/circle", "--problem", file, "--out", out)
    assert done.returncode == 2
    assert "mcc.p_gain[1,2] ran to its own upper bound 300" in done.stderr
    assert not out.exists()


def test_feed_forward_shortens_the_lag_and_leaves_the_step(tmp_path: Path) -> None:
    text = """# By pulses.
machine = "xy_table"
stop = 8.0
without = ["connect.drives.dac", "leave.drives.pulse_count"]
leave = ["drives.dac"]

[connect]
"drives.pulse_count" = "card.pulse_count"

[set]
"mcc.program" = "circle.ngc"
"mcc.output_mode" = 0
"drives.mode" = 1
"""
    (tmp_path / "scenario.toml").write_text(text)
    (tmp_path / "circle.ngc").write_text((ROOT / "scenarios/circle/circle.ngc").read_text())
    model = linear.model(tmp_path, 1, at={"machine.table_speed": 0.1})
    study = AxisStudy(model, ["drives.position_gain", "drives.feed_forward"], SIGNALS)
    without, full = np.array([60.0, 0.0]), np.array([60.0, 1.0])
    assert study.lag(without) - study.lag(full) == pytest.approx(1.0 / 60.0, rel=1e-6)
    answers = [study.step(g, 10, 300, False).value for g in (without, full)]
    np.testing.assert_array_equal(*answers)


@pytest.mark.parametrize(("present", "low", "high"), [(10, 1, 200), (200, 10, 4000)])
def test_a_register_is_looked_for_from_1_where_a_twentieth_is_less(
    present: int, low: int, high: int
) -> None:
    model = linear.model(DEMO, 1, set={"mcc.p_gain": present})
    (found,) = choice.variables({1: model}, ["mcc.p_gain"], problem({}))
    assert (found.low, found.high, found.start, found.whole) == (low, high, present, True)


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({"gains": ["mcc.nothing"]}, "mcc.nothing"),
        ({"gains": ["mcc.software_gain"]}, "mcc.software_gain changes nothing"),
        ({"feed_forward": True}, "no feed-forward gain acts"),
        ({"bounds": {"drives.velocity_gain": (0.1, 1.0)}}, "it is not among the gains"),
        ({"bounds": {"mcc.p_gain": (10.0, 1e6)}}, "outside 0 .. 65535"),
        ({"family": {"card.loop_period": (1.0, 2.0)}}, "no parameter of a plant"),
        ({"limits": {"loop": {"drives.dac": {}}}}, "no loop there"),
        ({"limits": {"peak": {"machine.colour": 1.0}}}, "no output of the linear model"),
    ],
)
def test_a_wrong_name_or_value_gets_one_message(
    base: motionfmu.Result, asked: dict[str, Any], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        TuningFunctions(motionfmu.load(DEMO), problem(asked), base)


def test_limits_that_nothing_keeps_are_told() -> None:
    study = Formula(lambda k: 1.0 / k, (1.0, 100.0), limit=0.5)
    with pytest.raises(InputError, match=r"no gains .*; nearest: largest gain, axis 1, plant 0"):
        solve(study)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("cost", "axes", "words"),
    [
        ("ise", [2], ""),
        ("ise", [1, 2], ", ise is the sum over axes 1, 2"),
        (min(ON_PATH), [1, 2], ""),
    ],
)
def test_a_cost_is_a_sum_only_of_several_axes(cost: str, axes: list[int], words: str) -> None:
    made: Any = SimpleNamespace(problem=SimpleNamespace(cost=cost), axes=axes)
    assert summed(made) == words
