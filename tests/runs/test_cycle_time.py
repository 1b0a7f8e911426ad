"""Where a program's time goes: against closed forms, runs, and runs with limits lifted."""

import json
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from console import command
from few_cases import few

import motionfmu
from motionfmu.analysis.cycle_time import driven, planned, what_if
from motionfmu.analysis.cycle_time.program_plan import CommandedMotion
from motionfmu.base.motion_rows import NUMBER_OF, ROW
from motionfmu.cards import load
from motionfmu.run import Options, Session
from motionfmu.run.axis_figures import axis_figures
from motionfmu.run.controller_plan import bounded
from motionfmu.scenarios.package_files import MACHINES

# F6000 with ramps of 0.1 s: 100 mm/s, 1000 mm/s2; rapids 500 mm/s.
BY_HAND = {
    "feed": ("G1 X50 F3000", 1.1, {("feed", ""): 0.9, ("acceleration", ""): 0.1}),
    "speed": ("G0 Y250", 0.6, {("speed", "Y"): 0.4, ("exact stop", ""): 0.1}),
    "dwell": ("G4 P0.5", 0.5, {("dwell", ""): 0.5}),
    "stop": ("G1 X1 F6000", 0.0632, {("exact stop", ""): 0.0316, ("acceleration", ""): 0.0316}),
}
FRAME = 1.024e-3


def on_table(tmp_path: Path, text: str, **given) -> motionfmu.Scenario:
    file = tmp_path / "part.ngc"
    file.write_text(f"{text}\nM2\n")
    return motionfmu.machine("xy_table").scenario(file, **given)


@pytest.mark.parametrize("name", BY_HAND)
def test_each_cause_by_a_program_made_for_it(name, tmp_path):
    text, time, shares = BY_HAND[name]
    plan = planned(on_table(tmp_path, text))
    assert plan.time == pytest.approx(time, abs=2 * FRAME)
    found = {(s.cause, s.axis): s.time for s in plan.shares()}
    for key, expected in shares.items():
        assert found[key] == pytest.approx(expected, abs=2 * FRAME)


def test_the_sum_is_the_cycle_time_and_lines_are_parts_of_it():
    plan = planned(motionfmu.load("scenarios/pocket"))
    assert plan.rows.dtype == ROW  # of the FMU's file, and of what the package writes
    assert sum(s.time for s in plan.shares()) == pytest.approx(plan.time, abs=1e-9)
    blocks = plan.blocks()
    assert sum(b.time for b in blocks) == pytest.approx(plan.time, abs=1e-9)
    assert all(a.lost >= b.lost for a, b in pairwise(blocks))
    for block in blocks:
        rows = plan.rows[plan.rows["line"] == block.line]
        assert block.time == pytest.approx(len(rows) * plan.frame, abs=1e-12)


def test_lost_time_is_what_the_programmed_feed_would_save(tmp_path):
    plan = planned(on_table(tmp_path, "G1 X50 F6000\nG4 P1\nX0 F600"))
    lost = {b.line: b.lost for b in plan.blocks()}
    assert lost == pytest.approx({1: 0.1, 2: 0.0, 3: 0.1}, abs=2 * FRAME)


PROGRAMS = few(["circle", "pocket", "lookahead", "square", "spline", "gear", "short_lines"], 3)


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_plan_takes_as_long_as_the_run(name):
    scenario = motionfmu.load(f"scenarios/{name}")
    result = scenario.run()
    assert planned(scenario).time == pytest.approx(result.done_at, rel=0.01)


LIFTS = ["Feeds, by the override", "Acceleration of the ramps", "Speed of the motor"]


@pytest.mark.parametrize("lift", LIFTS)
def test_a_lifted_limit_against_a_real_run(lift, tmp_path):
    text = "G0 X100 Y40\nG1 X0 F6000\nG64 P0.05\nY0\nX60\nG0 X0\nX90\nX0"
    scenario = on_table(tmp_path, text, set={"mcc.max_rpm": 900})
    base = scenario.run().done_at
    one = next(x for x in what_if(scenario) if x.title == lift)
    real = scenario.run(set=one.set).done_at
    assert one.saved > 0.02
    assert one.time == pytest.approx(real, rel=0.02)
    assert one.saved == pytest.approx(base - real, abs=0.02 * base)


def test_what_no_controller_plans_is_told():
    with pytest.raises(motionfmu.InputError, match="hydraulic_valve: none of its components plans"):
        planned(motionfmu.load("scenarios/hydraulic_valve"))
    with pytest.raises(motionfmu.InputError, match="share = 0: above 0 wanted"):
        what_if(motionfmu.load("scenarios/circle"), share=0.0)


def test_a_program_that_is_refused_names_file_and_line(tmp_path):
    with pytest.raises(motionfmu.InputError, match=r"part.ngc: line 1: .*Q7"):
        planned(on_table(tmp_path, "G1 X50 Q7"))


@pytest.mark.parametrize("name", few(["circle", "pocket", "robot_line"], ["circle", "pocket"]))
def test_figures_of_axes_by_brute_force(name):
    scenario = motionfmu.load(f"scenarios/{name}")
    result = scenario.run()
    found = axis_figures(result, scenario.axis_limits())
    assert {f.limit.axis.name for f in found} == {a.name for a in scenario.document.axes}
    for f in found:
        x = np.asarray(result[f.limit.signal.name], float)
        x = x[:, f.limit.element] if x.ndim > 1 else x
        for _ in range(f.limit.derivative):
            x = x[1:] - x[:-1]
        x = x / (result.time[1] - result.time[0]) ** f.limit.derivative
        x = x * (180.0 / np.pi if f.limit.unit.startswith("deg") else 1.0)
        assert (f.low, f.high) == (x.min(), x.max())
        assert abs(f.largest) == np.abs(x).max()
        assert f.rms == pytest.approx(np.sqrt((x**2).mean()), rel=1e-9, abs=1e-300)
        if f.limit.limit:
            assert f.share == np.abs(x).max() / f.limit.limit
            at = (np.abs(x) >= 0.999 * f.limit.limit).sum() * (result.time[1] - result.time[0])
            assert f.time_at_limit >= at - 1e-12


def test_command(tmp_path):
    file = tmp_path / "part.ngc"
    file.write_text("G1 X50 F3000\nG4 P0.5\nM2\n")
    ran = command("gcode", file, "--machine", "xy_table", "--out", tmp_path).stdout
    assert "1.6 s" in ran and "exact stop" in ran and "Feeds, by the override" in ran
    told = json.loads((tmp_path / "part.gcode/result.json").read_text())
    assert told["time"] == pytest.approx(1.6, abs=2 * FRAME)
    assert sum(s["time"] for s in told["where"]) == pytest.approx(told["time"], abs=1e-9)


@pytest.mark.more
def test_command_reads_with_the_values_that_are_set(tmp_path):
    file = tmp_path / "part.ngc"
    file.write_text("G1 A400 F1000\nM2\n")
    values = ("check_over_travel=true", "low_limit=-300", "high_limit=300")
    sets = [x for v in values for x in ("--set", f"mcc.{v}")]
    good = command("gcode", file, "--machine", "mill4", "--out", tmp_path).stdout
    assert "A 0.0000 .. 400.0000 °" in good
    bad = command("gcode", file, "--machine", "mill4", *sets).stdout
    assert "A to 400, limit 300" in bad
    run = command("run", file, "--machine", "mill4", *sets)
    assert '"G1 A400 F1000" (A to 400 deg, limit 300 deg)' in run.stderr


def test_a_program_may_take_twice_its_planned_time(tmp_path):
    """Told when it runs, from the values of the run; checked and exported without a run."""
    slow = on_table(tmp_path, "G1 X50 F60\n" + "X0\nX50\n" * 8)  # 850 s
    assert slow.stop_limit == 600.0
    plan = bounded(slow, Options())
    assert plan.limit == np.ceil(2 * planned(slow).time) == 1704.0
    quick = bounded(slow, Options(set={"mcc.override": 2.0}))
    assert quick.limit == 857.0  # 17 lines of 25 s and 0.2 s for the ramps
    assert bounded(slow, Options(stop=1.0)).limit is None
    assert bounded(on_table(tmp_path, "G1 X50 F60", limit=70.0), Options()).limit is None


@pytest.mark.more
def test_runs_end_at_the_planned_limit(tmp_path):
    result = on_table(tmp_path, "G1 X50 F60\nM0").run()
    assert result.stopped == "limit 600 s, mcc.done never came"
    slow = on_table(tmp_path, "G1 X50 F60\n" + "X0\nX50\n" * 8)
    with Session(slow, ["mcc.p_gain"]) as session:
        assert session.run({}).stopped.startswith("mcc.done at 851.69")


def test_figures_of_an_axis_that_turns_are_in_degrees(tmp_path):
    result = motionfmu.machine("mill4").run("src/motionfmu/machines/mill4/example.ngc")
    found = axis_figures(result, result.scenario.axis_limits())
    travel = {f.limit.axis.name: f for f in found if f.limit.figure == "travel"}
    assert (travel["A"].limit.unit, travel["X"].limit.unit) == ("deg", "m")
    assert travel["A"].high == pytest.approx(1e3 * result["machine.table_position"][:, 3].max())
    assert travel["A"].limit.high == 36_000.0
    page = result.save(tmp_path / "out") and (tmp_path / "out/report.html").read_text()
    assert "Following error A" in page and "Following error U" not in page


def test_what_limits_a_robot(tmp_path):
    """300 mm at 100 mm/s and 1 m/s2; beside the singularity joint 4 takes all its speed."""
    folder = Path("scenarios/robot_singularity").resolve()
    values = {"soft.points": str(folder / "points.txt")}
    job = motionfmu.machine("robot6").scenario(folder / "through.job", set=values)
    result = job.changed(record=["soft.joint_rate", "soft.status"]).run()
    plan = driven(result)
    line = {b.line: {(s.cause, s.axis): s.time for s in b.shares} for b in plan.blocks()}
    expected = {("feed", ""): 2.9, ("acceleration", ""): 0.1, ("exact stop", ""): 0.1}
    assert line[4] == pytest.approx(expected, abs=2 * plan.frame)
    assert 0.04 < line[6]["speed", "J4"] < 0.1 and line[6]["acceleration", "J4"] > 1.0
    rows = result["soft.limited_by"] == 2
    rate = np.abs(result["soft.joint_rate"][rows, 3]) / np.radians(300.0)
    assert result["soft.limited_axis"][rows].tolist() == [4] * rows.sum()
    assert 1 / 1.3 < rate.min() and rate.max() < 1.0 + 1e-6  # 1.3 within a segment
    assert plan.time == pytest.approx((result["soft.status"] == 1).sum() * plan.frame)
    page = result.save(tmp_path / "out") and (tmp_path / "out/report.html").read_text()
    assert "speed of J4" in page and "acceleration of J4" in page


def test_waits_of_a_robot_are_told():
    names = [f"soft.{v}" for v in ("status", "limited_*", "programmed_feed", "path_feed")]
    names += ["soft.line", "soft.tool_position"]
    result = motionfmu.load("scenarios/robot_pick").changed(record=names).run()
    plan, status = driven(result), result["soft.status"]
    told = {s.cause: s.time for s in plan.shares()}
    waits = np.isin(status, (2, 3, 5)).sum() * plan.frame
    assert told["waiting"] == pytest.approx(waits) and waits > 3.0
    assert told["corner"] > 1.0 and told["jerk"] > 0.1


def test_what_limits_a_job_of_a_network_card(tmp_path):
    """A line of 100 mm between rests: the ramps of a profile with limited jerk, by closed form."""
    (tmp_path / "line.plt").write_text("IN;SP1;PU0,0;PD4000,0;PU;")
    scenario = motionfmu.machine("engraver").scenario(tmp_path / "line.plt")
    plan = planned(scenario)
    told = {(s.cause, s.axis): s.time for s in plan.shares()}
    motion = load(MACHINES / "engraver/card.toml")
    x, free = motion.axes[0], 1.0 - motion.motion.reserve
    a, j, feed = free * x.acceleration_max, free * x.jerk_max, motion.motion.feed
    ramp = feed / a + a / j  # from rest to the feed
    assert plan.rows["place"][-1, 0] == pytest.approx(100.0)
    assert told["feed", ""] == pytest.approx((100.0 - feed * ramp) / feed, rel=0.02)
    assert told["jerk", "X"] == pytest.approx(2 * 2 * a / j, rel=0.1)
    assert told["acceleration", "X"] == pytest.approx(2 * (feed / a - a / j), rel=0.1)
    assert told["dwell", ""] > 0.0 and ("speed", "X") not in told
    assert sum(told.values()) == pytest.approx(plan.time, abs=1e-9)


def test_a_limit_that_is_none_of_the_six_axes_is_outside_the_arm():
    rows = np.zeros(6, dtype=ROW)
    rows["cause"], rows["axis"] = NUMBER_OF["speed"], [0, 1, 1, 6, 7, 7]
    motion = CommandedMotion(0.5, rows, ("J1", "J2", "J3", "J4", "J5", "J6"))
    times = {share.axis: share.time for share in motion.shares()}
    assert times == {"": 0.5, "J1": 1.0, "J6": 0.5, "external": 1.0}
