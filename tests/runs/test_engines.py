"""All engines and both FMI versions give the same bits; so does any step that divides the grids."""

import functools
from pathlib import Path

import fmpy_container
import numpy as np
import pytest
from conftest import ROOT
from few_cases import few
from written_out import WHOLE_CIRCLE, WHOLE_TEXT

import motionfmu
from motionfmu.base.platforms import Platform
from motionfmu.run.engines import ENGINES, native
from motionfmu.run.session import Session
from motionfmu.scenarios import document

NAMES = sorted(p.parent.name for p in ROOT.glob("scenarios/*/scenario.toml"))
# A scenario's tests go to one worker, which makes its usual run once.
SCENARIOS = [pytest.param(name, marks=pytest.mark.xdist_group(name)) for name in NAMES]


def of_every_fmu() -> list[str]:
    """Scenarios in which every FMU that any has comes once."""
    seen: set[str] = set()
    found = []
    for name in NAMES:
        fmus = document.read(ROOT / "scenarios" / name).body.component.values()
        if not seen.issuperset(fmus):
            seen.update(fmus)
            found.append(name)
    return found


# `make test` has these alone, where engines could differ with the variables of an FMU.
SOME = few(SCENARIOS, of_every_fmu())
# Engines that go through Python at each step run until something moves, and a little on.
SHORT = 0.4  # [s] at most
STEPS = 4000  # at most
ON = 100  # steps
# At once, of a step that is coarse for a drive; two components by turns.
WARN = [("robot_line", SHORT), ("pulse_underrun", 0.06)]
FINE = 400_000  # at most, of a run of which the step is divided
DRIVEN = """
[[drive]]
input = "mcc.hold"
at    = [0.3, 0.5]
value = [true, false]

[[drive]]
input = "mcc.override"
at    = [0.1, 0.6, 0.8]
value = [0.5, 1.5, 1.0]

[[drive]]
input = "mcc.abort"
at    = [0.9]
value = [true]

[record]
"""

TUNED = """# Gains that change while a drive moves its axis.
stop = 0.02
step = 1e-4
leave = ["drives.*", "machine.*"]

[component]
drives = "servo_drives"
machine = "ball_screw_axes"

[connect]
"machine.torque_command" = "drives.torque"
"drives.phase" = "machine.motor_phase"

[[drive]]
input = "drives.dac"
at = [0.0]
value = [1.0]

[[drive]]
input = "drives.velocity_gain"
at = [0.005]
value = [0.9]

[[drive]]
input = "machine.table_viscous"
at = [0.01]
value = [5000.0]

[record]
signals = ["drives.torque", "machine.table_speed"]
"""


@functools.cache
def loaded(scenario: str) -> motionfmu.Scenario:
    return motionfmu.load(ROOT / "scenarios" / scenario)


@functools.cache
def fused(scenario: str, stop: float | None = None) -> motionfmu.Result:
    return loaded(scenario).run(engine="fused", stop=stop)


def brief(scenario: str) -> float:
    """When enough has moved to compare engines [s]: three signals, or else `SHORT`."""
    body = loaded(scenario).document.body
    rows = int(min(SHORT, STEPS * body.step, body.stop_limit) / (body.step * body.record.every))
    moves = []
    for signal in fused(scenario).signals.values():
        x = signal[:rows].reshape(len(signal[:rows]), -1)
        changed = (x != x[:1]).any(axis=1)
        if changed.any():
            moves.append(int(np.argmax(changed)))
    last = sorted(moves)[2] + 1 if len(moves) > 2 else rows
    steps = min(last * body.record.every + ON, int(STEPS), round(SHORT / body.step))
    return min(steps * body.step, body.stop_limit)


def differing(
    a: motionfmu.Result, b: motionfmu.Result, every: int = 1, rows: int | None = None
) -> list[str]:
    """Signals of which the rows of `a` and every n-th row of `b`, or its first, differ in a bit."""
    assert set(a.signals) == set(b.signals) and len(a.time) > 0
    kept = slice(None, rows, every)
    return [k for k, x in a.signals.items() if x.tobytes() != b.signals[k][kept].tobytes()]


def moved(result: motionfmu.Result) -> bool:
    """Pulses went out or, where none are recorded, three signals changed, or all that there are."""
    if "card.pulse_count" in result.signals:
        return bool(np.ptp(result["card.pulse_count"]) > 100)
    changed = sum(bool(np.ptp(x.astype(float)) > 0) for x in result.signals.values())
    return changed >= min(3, len(result.signals))


@pytest.mark.parametrize("scenario", SCENARIOS)
def test_every_scenario_holds_its_verdict(scenario: str) -> None:
    result = fused(scenario)
    assert result.options["engine"] == "fused"
    assert result.checks
    assert [v for v in result.checks if not v.ok] == []


@pytest.mark.parametrize("scenario", few(SOME, 3))
def test_the_container_gives_the_bits_of_the_program(scenario: str) -> None:
    """Over the whole run; all that a result tells is the same, too."""
    same(fused(scenario), loaded(scenario).run(engine="native"))


@pytest.mark.parametrize("engine", ["fused", "native"])
@pytest.mark.parametrize("scenario", few(SOME, 3))
def test_fmi_2_gives_the_bits_of_fmi_3(scenario: str, engine: str) -> None:
    agree(scenario, engine, 2)


@pytest.mark.parametrize("scenario", SOME)
def test_the_python_engine_agrees_to_the_bit(scenario: str) -> None:
    agree(scenario, "python", 3)


@pytest.mark.parametrize(("engine", "fmi"), [("python", 2), ("fmpy", 3), ("fmpy", 2)])
@pytest.mark.parametrize("scenario", of_every_fmu())
def test_engines_agree_on_every_fmu(scenario: str, engine: str, fmi: int) -> None:
    """Their calls differ with the variables of an FMU, not with the scenario."""
    agree(scenario, engine, fmi)


@pytest.mark.more
@pytest.mark.parametrize("scenario", of_every_fmu())
def test_fmpys_container_agrees_on_every_fmu(scenario: str) -> None:
    in_fmpys_container(scenario)


@pytest.mark.long
@pytest.mark.parametrize("scenario", SCENARIOS)
def test_fmpys_container_agrees_on_every_scenario(scenario: str) -> None:
    in_fmpys_container(scenario)


def in_fmpys_container(scenario: str) -> None:
    one, other = fused(scenario), fmpy_container.run(loaded(scenario), stop=brief(scenario))
    found = differing(other, one, rows=len(other.time))
    assert [k for k in found if one[k].dtype != bool] == []


@pytest.mark.long
@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("scenario", SCENARIOS)
def test_fmpy_gives_the_bits_of_the_program(scenario: str, fmi: int) -> None:
    """Over the whole run; all that a result tells is the same, too."""
    same(fused(scenario), loaded(scenario).run(engine="fmpy", fmi=fmi))


def same(one: motionfmu.Result, other: motionfmu.Result) -> None:
    assert differing(one, other) == [] and one.time.tobytes() == other.time.tobytes()
    assert (one.stopped, one.warnings) == (other.stopped, other.warnings)
    assert one.geometry == other.geometry


def agree(scenario: str, engine: str, fmi: int) -> None:
    other = loaded(scenario).run(engine=engine, fmi=fmi, stop=brief(scenario))
    assert differing(other, fused(scenario), rows=len(other.time)) == []


@pytest.mark.more
def test_most_scenarios_move_in_the_time_of_the_slow_engines() -> None:
    body = {name: loaded(name).document.body for name in NAMES}
    still = [n for n in NAMES if brief(n) >= min(SHORT, STEPS * body[n].step, body[n].stop_limit)]
    assert len(still) < len(NAMES) / 4, still


@pytest.mark.parametrize(("engine", "fmi"), few([("python", 3), ("fmpy", 3), ("fmpy", 2)], 1))
def test_engines_agree_over_a_whole_run(engine: str, fmi: int) -> None:
    one = fused("mismatch_line")
    same(one, loaded("mismatch_line").run(engine=engine, fmi=fmi))
    assert moved(one) and np.ptp(one["mcc.done"].astype(int)) == 1, "a Boolean changes"


def test_fmpys_container_agrees_over_a_whole_run() -> None:
    one, other = fused("mismatch_line"), fmpy_container.run(loaded("mismatch_line"))
    assert differing(one, other) == ["mcc.done"]


@pytest.mark.parametrize(("engine", "fmi"), few([("python", 3), ("fmpy", 3), ("fmpy", 2)], 1))
@pytest.mark.parametrize(("scenario", "stop"), WARN)
def test_engines_tell_the_same_warnings(scenario, stop, engine: str, fmi: int) -> None:
    told = fused(scenario, stop).warnings
    assert told and loaded(scenario).run(engine=engine, fmi=fmi, stop=stop).warnings == told


def test_components_that_warn_in_turn_are_heard_in_turn() -> None:
    """So is the comparison above one of their order."""
    names = [told.partition(":")[0] for told in fused(*WARN[1]).warnings]
    assert names != sorted(names) and names != sorted(names, reverse=True)


@pytest.mark.parametrize("divisor", few([2, 10], [2]))
@pytest.mark.parametrize("scenario", SOME)
def test_dividing_the_step_changes_no_bit(scenario: str, divisor: int) -> None:
    body = loaded(scenario).document.body
    stop = min(body.stop_limit, 2.0, FINE * body.step / 10)
    coarse = fused(scenario, stop)
    fine = loaded(scenario).run(engine="fused", step=body.step / divisor, stop=stop)
    assert len(fine.time) == divisor * len(coarse.time)
    assert differing(coarse, fine, divisor) == []
    assert moved(coarse)


@pytest.fixture(scope="module")
def driven(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A scenario outside the project that is held, overridden and aborted while it moves."""
    folder = tmp_path_factory.mktemp("driven") / "here with space"
    folder.mkdir()
    text = WHOLE_TEXT.replace("[record]\n", DRIVEN).replace("stop = 3.0", "stop = 1.5")
    text = text.replace('"mcc.hold", "mcc.abort", "mcc.override", ', "")
    text = text[: text.index("[check]")]
    (folder / "scenario.toml").write_text(text)
    program = (WHOLE_CIRCLE / "circle.ngc").read_text()
    (folder / "circle.ngc").write_text(program)
    return folder


@pytest.mark.more
@pytest.mark.parametrize("fmi", [3, 2])
def test_stimuli_reach_every_engine_alike(driven: Path, fmi: int) -> None:
    scenario = motionfmu.load(driven)
    one = scenario.run(engine="fused")
    t, feed = one.time, one["mcc.path_feed"]
    assert feed[(t > 0.45) & (t < 0.5)].max() == 0.0, "held"
    assert feed[(t > 0.6) & (t < 0.9)].max() > 50.0, "faster than the programmed 50 mm/s"
    assert feed[-1] == 0.0 and one["mcc.status"][-1] == 1, "aborted"
    for engine in ENGINES:
        assert differing(one, scenario.run(engine=engine, fmi=fmi)) == [], engine
    assert differing(one, fmpy_container.run(scenario)) in ([], ["mcc.done"])


def test_tunable_parameters_count_in_every_engine_from_the_step_on(tmp_path: Path) -> None:
    runs = {}
    for name, text in {
        "tuned": TUNED,
        "drives": TUNED.replace("value = [5000.0]", "value = [100.0]"),
        "machine": TUNED.replace("value = [0.9]", "value = [0.5]"),
    }.items():
        folder = tmp_path / name
        folder.mkdir()
        (folder / "scenario.toml").write_text(text)
        scenario = motionfmu.load(folder)
        runs[name] = scenario.run(engine="fused")
        for engine in ENGINES if name == "tuned" else ():
            assert differing(runs[name], scenario.run(engine=engine)) == [], engine
    t = runs["tuned"].time

    def parts(other: str) -> float:
        """The time at which the table's speed becomes another one [s]."""
        one, two = runs["tuned"]["machine.table_speed"], runs[other]["machine.table_speed"]
        return t[np.flatnonzero(np.any(one != two, axis=1))[0]]

    # The sample at 5 ms takes the gain, its torque stands from 5.1 ms on.
    assert parts("machine") == pytest.approx(0.0052, abs=1e-9)
    assert parts("drives") == pytest.approx(0.0101, abs=1e-9)


@pytest.mark.parametrize("divisor", [2, 4, 10])
def test_stimuli_stay_where_they_are_when_the_step_is_divided(driven: Path, divisor: int) -> None:
    scenario = motionfmu.load(driven)
    assert differing(scenario.run(), scenario.run(step=1e-4 / divisor), divisor) == []


@pytest.fixture(scope="module")
def short(tmp_path_factory: pytest.TempPathFactory) -> motionfmu.Scenario:
    """A move of a hundredth of a second."""
    file = tmp_path_factory.mktemp("short") / "part.ngc"
    file.write_text("G21 G17 G90\nG1 X0.02 F3000\nM2\n")
    base = motionfmu.load(ROOT / "scenarios/circle_theory")
    return base.changed(set={"mcc.program": str(file)}, record=["mcc.services"])


@pytest.mark.parametrize("fmi", few([3, 2], 1))
def test_a_signal_ends_every_engine_alike(short: motionfmu.Scenario, fmi: int) -> None:
    whole = short.run(stop=0.2)
    first = int(np.argmax(whole["mcc.done"]))
    assert 50 < first < 1500 and not whole["mcc.done"][0]
    assert whole.done_at == whole.time[first] and whole.stopped == "stop = 0.2 s"
    ended = short.changed(stop="done", limit=0.5, settle=0.002)
    for engine in ENGINES:
        run = ended.run(engine=engine, fmi=fmi)
        assert len(run.time) == first + 1 + 20, engine
        assert run.stopped == f"mcc.done at {first * 1e-4:.9g} s" and run.overrides == []
        assert run.done_at == pytest.approx(first * 1e-4, abs=1e-12)
        assert differing(run, whole, rows=len(run.time)) == []
    contained = fmpy_container.run(ended)
    assert contained.stopped == f"mcc.done at {first * 1e-4:.9g} s"
    assert differing(contained, whole, rows=first + 21) == ["mcc.done"]
    at_once = short.changed(stop="mcc.done", limit=0.5).run()
    assert len(at_once.time) == first + 1 and at_once["mcc.done"][-1]
    assert not at_once["mcc.done"][:-1].any()
    fine = ended.run(step=5e-5)
    assert differing(ended.run(), fine, 2, rows=None) == [] and len(fine.time) == 2 * first + 1 + 40


def test_a_signal_that_never_comes_is_told(short: motionfmu.Scenario) -> None:
    run = short.changed(stop="mcc.done", limit=0.005, settle=0.01).run()
    assert run.stopped == "limit 0.005 s, mcc.done never came" and run.done_at is None
    assert "mcc.done never came within 0.005 s" in run.warnings and len(run.time) == 50
    late = short.changed(stop="mcc.services", limit=0.05, settle=0.2).run()
    assert late.stopped.startswith("mcc.services at 0") and len(late.time) == 500


@pytest.mark.parametrize("fmi", few([3, 2], 1))
def test_a_fault_ends_every_engine_alike(short: motionfmu.Scenario, fmi: int) -> None:
    whole = short.run(stop=0.2)
    first = int(np.argmax(whole["mcc.services"] != 0))
    failed = short.changed(stop="done", fault="services", limit=0.5, settle=0.002)
    told = f"mcc.services at {first * 1e-4:.9g} s"
    for engine in ENGINES:
        run = failed.run(engine=engine, fmi=fmi)
        assert len(run.time) == first + 1 + 20, engine
        assert run.stopped == told and run.done_at is None
        assert f"the run ended by its fault, {told}: mcc.done never came" in run.warnings
        assert differing(run, whole, rows=len(run.time)) == []
    contained = fmpy_container.run(failed)
    assert contained.stopped == told and contained.done_at is None
    # A fault that does not come, or an array's, leaves the end as it is; of two at once it counts.
    done = short.changed(stop="done", fault="card.enc_count[4]", limit=0.5)
    both = short.changed(stop="done", fault="done", limit=0.5)
    for engine in ENGINES:
        assert done.run(engine=engine, fmi=fmi).stopped == both.run(engine=engine).stopped
        assert both.run(engine=engine, fmi=fmi).warnings, engine
    assert not done.run().warnings and done.run().done_at is not None


def test_a_session_ends_by_a_signal(short: motionfmu.Scenario) -> None:
    ended = short.changed(stop="mcc.done", limit=0.5)
    with Session(ended, ["mcc.p_gain", "mcc.acc_time"]) as session:
        for given in ({"mcc.p_gain": 300}, {"mcc.p_gain[1]": 200}, {"mcc.acc_time": 0.1}):
            one, other = session.run(given), ended.run(set=given)
            assert differing(one, other) == [] and one.stopped == other.stopped
            assert one.options["set"] == given and one.overrides == other.overrides


def test_rows_of_every_so_many_steps(short: motionfmu.Scenario) -> None:
    ended = short.changed(stop="mcc.done", limit=0.5, settle=0.01, record={"every": 7})
    rows, whole = ended.run(), short.changed(stop="mcc.done", limit=0.5, settle=0.01).run()
    assert len(rows.time) == -(-len(whole.time) // 7)
    assert differing(rows, whole, 7) == [] and rows.stopped == whole.stopped
    assert differing(rows, whole.scenario.run(every=7)) == []


def test_more_signals_than_one_scope_holds() -> None:
    """A scope has ten groups of six real channels."""
    circle = motionfmu.load(ROOT / "scenarios/circle")
    wide = [e for e in circle.resolver.matching("*", "output") if e.port.shape == (6,)]
    circle.ends = list({e.name: e for e in [*circle.ends, *wide]}.values())
    assert sum(e.port.type == "Float64" for e in circle.ends if e.port.shape) > 10
    whole, plain = circle.run(engine="native", stop=SHORT), fused("circle", SHORT)
    assert len(whole.signals) > len(plain.signals)
    assert all(np.array_equal(whole[k], x) for k, x in plain.signals.items())


def test_a_difference_would_be_seen() -> None:
    one = fused("mismatch_line", SHORT)
    other = loaded("mismatch_line").run(stop=SHORT, set={"mcc.irq_latency": 3e-4})
    assert "card.stock" in differing(one, other)


def test_a_processor_for_which_the_container_has_no_master_is_told(monkeypatch) -> None:
    monkeypatch.setattr(native, "here", lambda: Platform("aarch64-linux"))
    told = "engine native: .* has no master for aarch64-linux; --engine fused needs a C compiler"
    with pytest.raises(motionfmu.InputError, match=told):
        motionfmu.load("schedule").run(engine="native", stop=0.1)
