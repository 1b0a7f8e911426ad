"""The MSP430 on the hydraulic axis, through the FMUs: the article's figures, load steps, faults."""

import importlib.util
import tomllib
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from conftest import ROOT
from hydraulic_theory import edges, left_by_p, served, uniform

import motionfmu

FOLDER = ROOT / "scenarios"
COUNT = 5e-6  # [m]


def study(name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(f"{name}_study", FOLDER / name / "study.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def run(name: str, stop: float | None = None, **values: Any) -> motionfmu.Result:
    named = {k.replace("__", "."): v for k, v in values.items()}
    return motionfmu.load(FOLDER / name).run(set=named, stop=stop)


def driven(drives: str, **more: Any) -> motionfmu.Scenario:
    """The scenario of loads with other drives."""
    scenario = motionfmu.load(FOLDER / "hydraulic_load")
    return scenario.changed(drive=tomllib.loads(drives)["drive"], **more)


def test_windows_of_a_check() -> None:
    """Both ends count, nothing between windows does, a window without samples fails."""
    from motionfmu.run.checks import judge
    from motionfmu.scenarios.body import Bounds

    time = np.arange(5) * 0.1
    data = np.array([0.0, 1.0, 9.0, 2.0, 3.0])
    two = Bounds(windows=((0.0, 0.1), (0.3, 0.4)), max=3.0, peak=(3.0, 3.0), final=3.0)
    found = judge("x", two, time, data)
    assert [v.ok for v in found] == [True, True, True]
    assert found[0].bounds == "<= 3, in 2 windows"
    assert not judge("x", Bounds(windows=((0.1, 0.2),), max=3.0), time, data)[0].ok
    assert not judge("x", Bounds(windows=((0.5, 0.6),), max=3.0), time, data)[0].ok


@pytest.mark.parametrize(
    ("windows", "told"),
    [
        ("[[1.0, 9.0]]", "[1.0, 9.0] s is not within 0 .. 4.25 s"),
        ("[[0.2, 0.1]]", "[0.2, 0.1] s is not within"),
        ("[[0.1, 0.2]], at = 1.0", "at and windows exclude each other"),
        ("[]", "windows = []: "),
        ("[[0.1]]", "windows.0 = [0.1]: too few values"),
    ],
)
def test_wrong_windows_are_named(tmp_path: Path, windows: str, told: str) -> None:
    text = (FOLDER / "hydraulic_load/scenario.toml").read_text()
    text = text[: text.index("[check]")] + "[check]\n"
    text += f'"controller.error" = {{ windows = {windows}, max = 1 }}\n'
    (tmp_path / "scenario.toml").write_text(text)
    with pytest.raises(motionfmu.InputError) as caught:
        motionfmu.load(tmp_path)
    message = str(caught.value)
    assert message.startswith(f"{tmp_path}/scenario.toml:{len(text.splitlines())}: "), message
    assert "controller.error" in message and told in message


def test_p_step_is_one_exponential() -> None:
    s = study("hydraulic_p_step")
    time, way = s.step()
    assert s.GAIN == pytest.approx(2.0, rel=5e-3)
    assert 1.0 < np.abs(way - s.formula(time)).max() < 1.7
    assert np.abs(way - s.formula(time - s.DELAY)).max() < 0.9
    assert np.abs(way - s.formula(1.1 * time)).max() > 3.0


@pytest.mark.parametrize("machine", [0, 1, 2])
@pytest.mark.parametrize("p_gain", [512, 2048])
def test_p_leaves_what_the_valve_creeps_to(machine: int, p_gain: int) -> None:
    """At most u_d/Kc; and what steady speeds at each command leave, to a count and 1 %.

    The 1 % is for oil that rings on the way there, which those know nothing of.
    """
    s = study("hydraulic_p_step")
    one = s.MACHINES[machine]
    left = s.left(one, p_gain)
    theory = left_by_p(p_gain / 4096, (one.overlap, one.coulomb, one.static))
    assert abs(left - theory) <= 1.0 + 0.01 * theory
    assert left <= one.deadband * 4096 / p_gain


def test_a_true_integral_without_limit_hunts_in_the_deadband() -> None:
    """It never settles within a count; the literal one, which forgets at error 0, does."""
    r = run(
        "hydraulic_integral", sum_axis__valve_overlap=0.03, literal_band_axis__valve_overlap=0.03
    )
    late = r.time > 1.2
    assert 2 <= np.abs(r["sum.error"][late]).max() <= 8
    assert np.abs(r["literal_band.error"][late]).max() <= 1 and r["literal_band.error"][-1] == 0


def test_quadrature_both_ways() -> None:
    """A leads forwards, lags backwards; each edge has its interrupt; no edge between two counts."""
    r = run("hydraulic_quadrature")
    a, b, counter = r["written.pin_a"], r["written.pin_b"], r["written.counter"].astype(int)
    levels = 2 * a.astype(int) + b
    changes = np.flatnonzero(np.diff(levels))
    after = {True: {0: 2, 2: 3, 3: 1, 1: 0}, False: {0: 1, 1: 3, 3: 2, 2: 0}}
    up = np.diff(r["written.edges"])[changes] > 0
    assert np.count_nonzero(up) == 99 and np.count_nonzero(~up) == 94
    for k, forwards in zip(changes, up, strict=True):
        assert levels[k + 1] == after[bool(forwards)][int(levels[k])], r.time[k]
    # The number of the interrupt is the line and the way it changed.
    served = np.flatnonzero(np.diff(counter))
    for k in served:
        line = a if a[k - 4] != a[k + 1] else b
        number = (1 if line is a else 3) + (0 if line[k + 1] else 1)
        assert r["written.interrupt"][k + 1] == number, r.time[k]
    assert len(served) == 193 == r["written.interrupts"][-1]
    assert np.abs(counter - r["written.edges"]).max() <= 1
    assert np.array_equal(r["repaired.counter"][-1:], r["written.counter"][-1:])
    quarter = np.floor(4 * r["axis.table_phase"]).astype(int)
    assert np.abs(np.diff(quarter - quarter[0] - r["written.edges"])).max() <= 1


@pytest.mark.parametrize("cycles", [400, 100])
def test_counts_are_lost_beyond_the_border_speed(cycles: int) -> None:
    """To the edge those of the listing, worked out from the scale's phase alone."""
    s = study("hydraulic_lost_counts")
    edge = s.border(cycles, s.WRITTEN)
    below = s.measure(s.held(cycles, 0.99 * edge))
    assert below.lost == (0.0, 0.0) and below.turned == (0.0, 0.0)
    for share in (1.2, 1.4):
        speed = (np.floor(edge * share * s.PERIOD) + 0.382) / s.PERIOD
        r = s.held(cycles, speed)
        assert s.measure(r).speed == pytest.approx(speed, rel=2e-3)
        steps = edges((r["axis.table_position"] / s.pitch(speed)), 800)
        for repaired, name in enumerate(s.NAMES):
            lost, turned = served(steps, 8000, cycles, bool(repaired))
            assert (r[f"{name}.lost"][-1], r[f"{name}.turned"][-1]) == (lost, turned)
            assert turned > 0 and (lost > 0) != repaired


@pytest.mark.parametrize("cycles", [400, 200, 100])
def test_the_closed_form_of_lost_counts(cycles: int) -> None:
    """Within 1/100 edge of each timer period, and never too many: a mean over 2000 of them."""
    s = study("hydraulic_lost_counts")
    for share in (1.2, 1.4):
        speed = (np.floor(s.border(cycles, s.WRITTEN) * share * s.PERIOD) + 0.381966) / s.PERIOD
        lost, _ = served(uniform(speed, s.CLOCK, 2.0), 8000, cycles, False)
        formula = float(s.theory(cycles, s.WRITTEN, np.array([speed]))[0])
        assert 0.0 < (lost / 2.0 - formula) * s.PERIOD < 0.01


def test_the_counter_wraps_and_nothing_else_does() -> None:
    r = run("hydraulic_wrap")
    counter, edges = r["controller.counter"].astype(int), r["controller.edges"].astype(int)
    assert np.abs((edges - counter + 32768) % 65536 - 32768).max() <= 2
    assert {-1, 0, 1} >= set(np.unique((edges - counter).round(-1) // 65530).tolist())
    gap = r["controller.track"] - edges
    assert np.abs(gap).max() < 600 and np.abs(gap - r["controller.error"]).max() < 30


LOADS = """
[[drive]]
input = "axis.force"
at    = [0.25, 0.75]
value = [{force}, {after}]
"""


@pytest.mark.parametrize("place", [-0.05, 0.07])
@pytest.mark.parametrize(("force", "after"), [(700, 0), (-1500, 500), (2500, 0), (-3000, -1000)])
def test_held_within_a_count_under_any_load(place: float, force: int, after: int) -> None:
    """Recovered 0.35 s after the step, from less than twice what the oil gives at once."""
    drives = LOADS.format(force=force, after=after)
    scenario = driven(drives)
    values = {"axis.start_position": place, "axis.scale_offset": place - COUNT / 2}
    r = scenario.run(set=values, stop=1.25)
    t, error = r.time, r["controller.error"]
    place_now = (r["axis.table_position"] - place) / COUNT
    assert np.array_equal(r["controller.counter"][-1:], r["controller.edges"][-1:])
    v_a, v_b = 5e-5 + 9.46e-4 * (0.1 + place), 5e-5 + 9.46e-4 * (0.1 - place)
    stiffness = 1.2e9 * 9.46e-4**2 * (1 / v_a + 1 / v_b)
    for begin, step in ((0.25, force), (0.75, after - force)):
        inside = (t >= begin) & (t < begin + 0.5)
        held = inside & (t > begin + 0.35)
        assert np.abs(error[held]).max() <= 1
        assert np.abs(place_now[held]).max() <= 1.5
        gives = abs(step) / stiffness / COUNT
        deviation = np.sign(step) * place_now[inside]
        assert 0.6 * gives < deviation.max() < 2 * gives + 2
        assert deviation.min() > -2.5  # beyond the target on the way back


def test_a_harder_blow_loses_counts() -> None:
    """The table rings at F/sqrt(k m): 6 kN are 31000 counts/s, beyond the border of 17500."""
    drives = LOADS.format(force=6000, after=6000)
    scenario = driven(drives)
    r = scenario.run(stop=1.0)
    assert np.abs(r["axis.table_speed"]).max() > 17505 * COUNT
    assert r["controller.lost"][-1] + r["controller.turned"][-1] > 0
    assert r["controller.counter"][-1] != r["controller.edges"][-1]
    fast = scenario.run(set={"controller.timer_cycles": 150}, stop=1.0)
    assert fast["controller.lost"][-1] == fast["controller.turned"][-1] == 0
    assert fast["controller.counter"][-1] == fast["controller.edges"][-1]
    assert np.abs(fast["controller.error"][fast.time > 0.65]).max() <= 1


def test_the_literal_law_does_not_hold_a_load() -> None:
    s = study("hydraulic_load")
    literal = s.run(0.0, s.LAWS["literal, band 50"])
    assert literal.loaded > 20 and literal.free == 0
    true = s.run(0.0, s.LAWS["true, band 100"])
    assert (true.loaded, true.free) == (1, 0)


FAULTS = """
[[drive]]
input = "controller.{button}"
at    = [0.1, 0.2]
value = [true, false]

{more}
"""


def faulty(button: str, more: str, **values: Any) -> motionfmu.Result:
    """The axis of the load scenario with a button pressed at 0.1 s; the rest is as given."""
    drives = FAULTS.format(button=button, more=more)
    scenario = driven(drives, leave=["*.force"], record=["controller.*"])
    given = {k if "." in k else f"controller.{k}": v for k, v in values.items()}
    return scenario.run(set=given, stop=1.0)


def stopped(r: motionfmu.Result, code: int) -> float:
    """Time of the fault; from there on the valve is at zero, and the counter has every edge."""
    begin = int(np.argmax(r["controller.code"] == code))
    assert r["controller.code"][begin] == code and r["controller.state"][begin] == 8
    assert set(r["controller.code"][:begin]) == {0}
    assert set(r["controller.state"][begin:]) == {8}
    # The duty in force is latched at the next PWM period, 0.25 ms.
    assert set(r["controller.duty"][begin + 8 :]) == {1000}
    assert r["controller.lost"][-1] == r["controller.turned"][-1] == 0
    assert r["controller.counter"][-1] == r["controller.edges"][-1]
    assert abs(r["axis.table_speed"][-1]) < 1e-4
    return float(r.time[begin])


@pytest.mark.parametrize("target", [15001, -1001, 2147483647, -2147483648])
def test_a_target_outside_the_stroke(target: int) -> None:
    r = faulty("pb2", "", target=target, high_limit=15000)
    assert stopped(r, 2) == pytest.approx(0.12, abs=2e-3)
    assert r["controller.homed"].all()
    assert np.abs(r["controller.edges"]).max() <= 1 and not r["controller.track"].any()


@pytest.mark.parametrize("target", [15000, -1000])
def test_a_target_on_the_limit_is_none(target: int) -> None:
    r = faulty("pb2", "", target=target, high_limit=15000)
    assert not r["controller.code"].any() and np.abs(r["controller.track"]).max() > 900


UNPLUG = """
[[drive]]
input = "controller.scale_unplugged"
at    = [{at}]
value = [true]
"""


@pytest.mark.parametrize(("at", "silent"), [(0.0, 0.05), (0.3, 0.05), (0.3, 0.1)])
def test_a_scale_that_is_unplugged(at: float, silent: float) -> None:
    """Before the move or in it: code 4, `scale_time` after the valve is open without an edge."""
    r = faulty("pb2", UNPLUG.format(at=at), target=10000, scale_time=silent)
    when = stopped(r, 4)
    assert not r["controller.homed"][-1]
    inside = np.flatnonzero(r["controller.edges"] != r["controller.edges"][-1])
    last = r.time[inside[-1]] if len(inside) else at
    opened = np.argmax((np.abs(r["controller.duty"] - 1000) >= 200) & (r.time > last))
    assert 0.0 < when - max(last, r.time[opened]) < silent + 3e-3
    run_on = (
        r["axis.table_position"][-1] - r["axis.table_position"][np.searchsorted(r.time, at)]
    ) / COUNT
    assert run_on > 100, "the axis did move, unseen"


def test_a_plug_put_in_again_costs_whole_periods_only() -> None:
    more = UNPLUG.format(at="0.3, 0.45").replace("[true]", "[true, false]")
    r = faulty("pb2", more, target=10000, scale_time=0.05)
    stopped(r, 4)
    phase, edges = r["axis.table_position"][-1] / (4 * COUNT), r["controller.edges"][-1]
    assert abs((phase + 0.125 - edges / 4) - round(phase + 0.125 - edges / 4)) < 0.26


def test_a_blocked_axis_is_the_same_to_the_controller() -> None:
    """Against the end stop the valve is open and no edge comes."""
    fast = {"speed": 60000.0, "acceleration": 1e6, "error_limit": 32767, "timer_cycles": 100}
    r = faulty("pb2", "", target=30000, **fast)
    assert 0.6 < stopped(r, 4) < 0.9
    assert r["axis.table_position"][-1] == pytest.approx(0.1, abs=2e-3)


@pytest.mark.parametrize(("home", "code", "way"), [(True, 5, 1), (False, 6, -1)])
def test_home_switch_stuck_or_never_found(home: bool, code: int, way: int) -> None:
    switch = {"axis.home_position": 1.0 if home else -1.0}  # beyond both ends of the travel
    r = faulty("pb1", "", start_homed=False, home_search=1500, **switch)
    stopped(r, code)
    assert not r["controller.homed"].any()
    assert 1490 < way * r["controller.edges"][-1] < 1560


def test_a_following_error_beyond_its_limit() -> None:
    r = faulty("pb2", "", target=10000, error_limit=100)
    stopped(r, 3)
    assert r["controller.homed"][-1]
    assert np.abs(r["controller.error"]).max() <= 110
