"""What must hold for any setting, and what a scenario as written is expected to give."""

import json
import re
from pathlib import Path
from xml.etree import ElementTree

import pytest
from console import within

import motionfmu
from motionfmu.run import suite
from motionfmu.run.checks import beyond, tally

ROOT = Path(__file__).parents[2]
GAIN = {"mcc.p_gain": 300}
TUNED = "contour.error.max"


def mine(folder: Path, text: str) -> Path:
    folder.mkdir()
    (folder / "scenario.toml").write_text(f"# Mine.\n{text}")
    return folder


@pytest.fixture(scope="module")
def written() -> motionfmu.Result:
    return motionfmu.load(ROOT / "scenarios/circle").run(stop=None)


@pytest.fixture(scope="module")
def tuned() -> motionfmu.Result:
    return motionfmu.load(ROOT / "scenarios/circle").run(set=GAIN)


def test_as_written_everything_is_judged(written) -> None:
    assert written.as_written and written.ok and all(v.ok for v in written.checks)
    assert {v.table for v in written.checks} == {"check", "expect"}
    same = motionfmu.load(ROOT / "scenarios/circle").run(set={"mcc.p_gain": 200})
    assert same.as_written and [v.ok for v in same.checks] == [v.ok for v in written.checks]


def test_another_gain_is_judged_by_what_must_hold_alone(tuned) -> None:
    assert tuned.ok and not tuned.as_written
    assert {v.ok for v in tuned.checks if v.table == "check"} == {True}
    assert {v.ok for v in tuned.checks if v.table == "expect"} == {None}
    low = next(v for v in tuned.checks if v.name == TUNED)
    assert not low.within and low.beyond == pytest.approx(tuned.contour().error.max - 0.044)
    assert "expected not judged" in repr(tuned) and "FAILED" not in repr(tuned)


def test_a_changed_scenario_is_another_one() -> None:
    other = motionfmu.load(ROOT / "scenarios/mismatch_line").changed(name="mine")
    found = other.run()
    assert found.ok and not found.as_written and any(v.ok is None for v in found.checks)


def test_a_check_fails_whatever_is_set() -> None:
    limit = {TUNED: {"max": 0.01}}
    found = motionfmu.load(ROOT / "scenarios/circle").changed(check=limit).run(set=GAIN)
    assert not found.ok and [v.name for v in found.checks if v.ok is False] == [TUNED]


def test_page_and_numbers_show_expected_got_and_difference(tuned, tmp_path: Path) -> None:
    page = tuned.save(tmp_path / "r").read_text()
    row = re.search(rf"{re.escape(TUNED)}<div.*?</tr>", page[page.index("Expected as written") :])
    assert row and "≥" not in row[0] and re.search(r"&gt;= 44 .*21\.1\d* µm.*.22\.8\d* µm", row[0])
    assert "✓ all 5 checks hold" in page and "fail" not in row[0]
    numbers = json.loads((tmp_path / "r/result.json").read_text())
    rows = [c for c in numbers["checks"] if c["name"] == TUNED]
    assert numbers["ok"] and not numbers["as_written"] and [c["ok"] for c in rows] == [None] * 2
    assert rows[0]["beyond"] == pytest.approx(rows[0]["value"] - 0.044) and rows[1]["beyond"] == 0
    assert "expected" in tuned._repr_html_() and "FAILED" not in tuned._repr_html_()


def test_the_console_shows_the_difference_without_a_verdict(tmp_path: Path) -> None:
    gain = ("--set", "mcc.p_gain=200")
    path = ROOT / "scenarios/mismatch_line"
    done = within("run", path, *gain, "--out", tmp_path / "r", columns=200)
    assert done.returncode == 0 and "FAILED" not in done.stdout
    assert re.search(rf" expected +{re.escape(TUNED)} .*; differs by -0\.2\d", done.stdout)
    told = within("compare", path, path, *gain, "--json")
    ok = {tuple(c["ok"].values()) for c in json.loads(told.stdout)["checks"]}
    assert told.returncode == 0 and ok == {(True, True), (True, None)}


def test_a_run_without_any_check_says_so(tmp_path: Path) -> None:
    path = ROOT / "scenarios/mismatch_line"
    folder = mine(
        tmp_path / "bare", f'extends = "{path}"\nwithout = ["check", "expect", "contrary"]\n'
    )
    done = within("run", folder, "--out", tmp_path / "r")
    assert done.returncode == 0 and "bare: no checks: nothing was judged" in done.stdout
    page = (tmp_path / "r/report.html").read_text()
    assert "No checks: nothing was judged." in page and "checks hold" not in page
    junit = tmp_path / "j.xml"
    done = within("check", folder, "--junit", junit)
    assert "0 hold, 0 fail, 1 without a check" in done.stdout
    root = ElementTree.parse(junit).getroot()
    assert root.find(".//skipped") is not None and root[0].get("skipped") == "1"


def test_contrary_runs_judge_all() -> None:
    cases = suite.judged(ROOT / "scenarios/mismatch_line", {}, suite.SuiteWays(contraries=True))
    assert cases and all(case.ok for case in cases)
    assert all(v.ok is not None for case in cases for v in case.checks)


@pytest.mark.parametrize(
    ("table", "told"),
    [
        ('[expect]\n"mcc.don" = { final = true }', r"scenario.toml:\d+: mcc.don.*did you mean"),
        ('[expect]\n"mcc.done" = {}', "mcc.done: no bound"),
        ('[expect]\n"mcc.done" = { least = 1 }', "unknown key 'least'"),
        ('[expect]\n"contour.eror.max" = { max = 1 }', "no 'eror', there is"),
        ('[expect]\n"mcc.done" = { at = 99.0, final = true }', "at = 99.0 s is not within"),
    ],
)
def test_wrong_expectations_are_refused_as_wrong_checks_are(tmp_path: Path, table, told) -> None:
    folder = mine(tmp_path / "m", f'extends = "{ROOT}/scenarios/mismatch_line"\n{table}\n')
    with pytest.raises(motionfmu.InputError, match=told):
        motionfmu.load(folder)


def test_a_machine_expects_nothing(tmp_path: Path) -> None:
    (tmp_path / "machine.toml").write_text(
        '# M.\nextends = "xy_table"\n[expect]\n"mcc.done" = { final = true }\n'
    )
    with pytest.raises(motionfmu.InputError, match=r"machine\.toml:3: expect is a scenario's"):
        motionfmu.machine(tmp_path)


def test_counts_and_distances() -> None:
    assert tally([True, False, None, None]).words == "1 of 2 checks FAILED, 2 expected not judged"
    assert tally([]).words == "no checks: nothing was judged"
    found = motionfmu.load(ROOT / "scenarios/mismatch_line").run().checks
    assert beyond(v for v in found if v.table == "expect") == 0.0
