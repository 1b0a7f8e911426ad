"""A number that a run does not have: a failed check with its reason, an empty cell of a study."""

import json
import math
import re
from html import escape
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT
from console import command, within
from contour_runs import Machine, Program, run_along

import motionfmu
from motionfmu.analysis.contour import analyse
from motionfmu.analysis.contour.names import wrong
from motionfmu.base.errors import NoNumber
from motionfmu.report.result_folder import save
from motionfmu.run.checks import judge
from motionfmu.scenarios.body import Bounds
from motionfmu.study import processes, worker
from motionfmu.sweep import Ways, conduct, study

TORQUE = [1e-6] * 6  # [N.m] less than friction: the table stands still


def written(folder: Path) -> dict:
    """The numbers of a whole result folder."""
    names = {p.name for p in folder.iterdir()}
    assert names >= {"signals", "result.json", "report.html"}
    signals = {f.stem: np.load(f) for f in (folder / "signals").iterdir()}
    assert all(len(x) == len(signals["time"]) for x in signals.values())
    return json.loads((folder / "result.json").read_text())


def test_a_run_that_ends_before_its_circle_is_status_1_with_a_whole_result(tmp_path: Path) -> None:
    out = tmp_path / "r"
    done = within("run", ROOT / "scenarios/circle", "--stop", "1", "--out", out, columns=72)
    assert done.returncode == 1, done.stdout + done.stderr
    assert done.stderr == "" and "checks FAILED" in done.stdout
    found = written(out)
    assert re.search(r"expected +contour\.circles\.0\.ccw\.radius_change +none", done.stdout)
    missing = {c["name"]: c for c in found["checks"] if c["reason"]}
    name = "contour.circles.0.ccw.radius_change"
    assert missing[name]["value"] is None and missing[name]["ok"] is None
    reason = missing[name]["reason"]
    assert "degrees of it" in reason
    assert reason in done.stdout and found["ok"] is False
    shown = (out / "report.html").read_text()
    told = re.escape(f"{escape(reason)}</div></td>") + "<td[^>]*>[^<]*</td><td[^>]*>none</td>"
    assert re.search(rf"{re.escape(name)}<div.*?{told}", shown)
    assert ">nan<" not in shown
    good = [c for c in found["checks"] if not c["reason"]]
    assert good and all(math.isfinite(c["value"]) for c in good)


def test_a_run_without_any_contour_is_status_1_with_a_whole_result(tmp_path: Path) -> None:
    out = tmp_path / "r"
    done = command("run", "scenarios/circle", "--stop", "1e-4", "--out", out)
    assert done.returncode == 1 and done.stderr == ""
    found = written(out)
    assert found["contour"] is None and found["no_contour"].startswith("no contour: ")
    assert found["no_contour"] in (out / "report.html").read_text()


def test_a_table_that_stands_still_has_no_circle_and_says_so(tmp_path: Path) -> None:
    result = motionfmu.load(ROOT / "scenarios/circle").run(
        set={"drives.torque_limit": TORQUE}, stop=4.0
    )
    assert result.ok is False
    reasons = {v.name: v.reason for v in result.checks}
    assert "degrees of it" in reasons["contour.circles.0.ccw.radius_change"]
    save(result, tmp_path / "r")
    assert written(tmp_path / "r")["ok"] is False


@pytest.mark.parametrize("name", sorted(p.parent.name for p in ROOT.glob("scenarios/*/*.toml")))
def test_every_scenario_cut_short_gives_verdicts(name: str, tmp_path: Path) -> None:
    scenario = motionfmu.load(ROOT / "scenarios" / name)
    body = scenario.document.body
    result = scenario.run(stop=body.step * max(2, round(0.01 * body.stop_limit / body.step)))
    assert result.ok in (True, False)
    assert all(v.reason for v in result.checks if not math.isfinite(v.value))
    if body.contour is not None:
        save(result, tmp_path / "r")
        written(tmp_path / "r")


def test_corners_that_the_tool_has_not_reached_are_not_there() -> None:
    path = Program(0, 0).line(60, 0).line(60, 60).line(0, 60).path()
    whole = run_along(path, 100.0, Machine())
    for share in (0.2, 0.5, 0.9):
        cut = int(share * len(whole.time))
        parts = {n: getattr(whole, n)[:cut] for n in ("time", "actual", "commanded", "command")}
        result = analyse(type(whole)(path=path, **parts))
        reached = {0.2: 0, 0.5: 1, 0.9: 2}[share]
        assert len(result.corners) == reached


def test_a_circle_keeps_its_number_when_one_before_it_has_no_test() -> None:
    """The tool stands still on the first circle and runs the second."""
    path = Program(30, 0).arc((0, 0), 2 * math.pi).line(20, 0).arc((0, 0), 2 * math.pi).path()
    run = run_along(path, 50.0, Machine(gains=(200.0,) * 3))
    actual = run.actual.copy()
    on_first = np.hypot(*run.commanded[:, :2].T) > 29.999
    actual[on_first, :2] = [30.0, 0.0]
    result = analyse(type(run)(path, run.time, actual, run.commanded, run.command, window=0.05))
    assert [c.radius for c in result.circles] == pytest.approx([20.0])
    with pytest.raises(NoNumber, match="line 10: the tool covers 0 degrees of it, 198 wanted"):
        result.number("circles.0.ccw.g")
    with pytest.raises(NoNumber, match="line 10"):
        result.number("circles.0.both.g")
    assert result.number("circles.1.radius") == pytest.approx(20.0)


def test_a_circle_run_twice_the_same_way_is_two() -> None:
    there = Program(30, 0).arc((0, 0), 2 * math.pi).line(40, 0).line(30, 0)
    back = there.arc((0, 0), 2 * math.pi).line(40, 0).line(30, 0).arc((0, 0), -2 * math.pi)
    circles = analyse(run_along(back.path(), 50.0, Machine(gains=(200.0,) * 3))).circles
    assert [(c.place, c.ccw is None, c.cw is None) for c in circles] == [
        (0, False, False),
        (1, False, True),
    ]


def test_names_are_those_of_the_analysis() -> None:
    """Every number of an analysis has a possible name, and every possible name is met once."""
    path = Program(30, 0).arc((0, 0), 2 * math.pi).arc((0, 0), -2 * math.pi).line(60, 0)
    numbers = analyse(run_along(path.path(), 50.0, Machine(gains=(40.0, 45.0, 50.0)))).numbers()
    met = set()

    def walk(value: object, name: str) -> None:
        if isinstance(value, dict | list):
            rows = value.items() if isinstance(value, dict) else enumerate(value)
            for key, inner in rows:
                walk(inner, f"{name}.{key}" if name else str(key))
        elif isinstance(value, int | float) and not isinstance(value, bool):
            assert wrong(name) == "", name
            met.add(".".join("0" if p.isdigit() else p for p in name.split(".")))

    walk(numbers, "")
    for name in ("error", "circles", "circles.0.ccw", "circles.x", "error.max.x", "errror", ""):
        assert wrong(name) != ""
    assert "circles.0.both.d" in met and "corners.0.error" in met and "following.x.rms" in met
    # Told apart from numbers that are there: the words of a row and its verdicts.
    assert {wrong("commands.0.kind"), wrong("circles.0.ccw.steady"), wrong("units.length")} != {""}


@pytest.mark.parametrize(
    ("check", "what"),
    [
        (Bounds(at=0.8, final=1.0), "the run ends at 0.5 s, before 0.8 s"),
        (Bounds(windows=((0.1, 0.2), (0.4, 0.7)), max=3.0), "the run ends at 0.5 s, before 0.7 s"),
        (Bounds(windows=((0.1001, 0.1002),), max=3.0), "no sample is in a window"),
    ],
)
def test_what_a_run_did_not_reach_is_failed(check: Bounds, what: str) -> None:
    time = np.arange(50) * 0.01
    (verdict,) = judge("x", check, time, np.ones(50))
    assert not verdict.ok and math.isnan(verdict.value) and verdict.reason == what


def test_a_check_at_the_very_end_is_judged() -> None:
    (verdict,) = judge("x", Bounds(at=0.5, final=1.0), np.arange(50) * 0.01, np.ones(50))
    assert verdict.ok and verdict.reason == ""


def test_a_missing_number_is_an_empty_cell_with_its_reason(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr(processes, "rows", lambda job, tasks, _: iter(worker.chunk(job, tasks)))
    given = {
        "stop": 1.0,
        "axis": {"mcc.p_gain": [100, 200]},
        "results": ["contour.error.max", "contour.circles.0.both.g", "mcc.error.absmax"],
        "cost": "contour.error.max",
    }
    chosen = study(ROOT / "scenarios/circle_theory/scenario.toml", given)
    outcome = conduct(chosen, tmp_path / "s", Ways(workers=1))
    assert outcome.errors == 0 and [r.status for r in outcome.rows] == ["ok", "ok"]
    for row in outcome.rows:
        assert row.values[0] > 0.0 and row.values[1] is None and row.values[2] is not None
        assert "circles.0.both.g" in row.message and row.checks is False
    assert outcome.best == int(np.argmin([r.values[0] for r in outcome.rows]))
    page = (tmp_path / "s/report.html").read_text()
    assert "Missing numbers" in page and "0 with an error" in page


def test_a_study_refuses_a_figure_that_no_run_can_have() -> None:
    given = {"axis": {"mcc.p_gain": [100]}, "results": ["contour.circles.0.cvw.g"]}
    with pytest.raises(motionfmu.InputError, match=r"no 'cvw', there is centre, normal"):
        study(ROOT / "scenarios/circle_theory/scenario.toml", given)
