"""`motionfmu check` as a CI script uses it."""

import json
from pathlib import Path

import pytest
from console import within
from junitparser import Error, Failure, JUnitXml

from motionfmu.cli.new import TEMPLATES, rendered

PLACES = ("good", "other", "slow", "wrong")


@pytest.fixture(scope="module")
def scenarios(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of scenarios far from the project: two hold, one fails, one is wrong."""
    folder = tmp_path_factory.mktemp("far") / "line_4"
    for place in PLACES:
        (folder / place).mkdir(parents=True)
        for file in ("scenario.toml", "README.md"):
            (folder / place / file).write_text(rendered(TEMPLATES / "scenario" / file, place))
    slow, wrong = (folder / place / "scenario.toml" for place in ("slow", "wrong"))
    slow.write_text(slow.read_text().replace("value = [1.0]", "value = [0.5]"))
    wrong.write_text(wrong.read_text().replace('"axis.tau" ', '"axis.taw" ', 1))
    (folder / "notes").mkdir()
    return folder


def cases(file: Path) -> list[tuple[str, str, str]]:
    """Name, kind and message of all cases, read by another program."""
    xml = JUnitXml.fromfile(str(file))
    assert all(suite.tests == len(list(suite)) for suite in xml)
    kinds = {Failure: "failure", Error: "error"}
    return [
        (case.name, *((kinds[type(r)], r.message) for r in case.result[:1]))
        if case.result
        else (case.name, "", "")
        for suite in xml
        for case in suite
    ]


@pytest.mark.parametrize("jobs", [1, 3])
def test_a_folder_anywhere_in_the_order_of_its_names(
    scenarios: Path, jobs: int, tmp_path: Path
) -> None:
    file = tmp_path / "check.xml"
    done = within("check", scenarios, "-j", jobs, "--junit", file, folder=tmp_path)
    assert done.returncode == 2
    rows = [row for row in done.stdout.splitlines() if row.startswith(("ok", "FAILED"))]
    assert [row.split()[1] for row in rows] == list(PLACES)
    assert all(row.endswith(" s") for row in rows)
    last = done.stdout.splitlines()[-1]
    assert last.startswith("4 scenarios: 2 hold, 1 fail, 1 wrong, ") and last.endswith(" s")
    assert done.stderr.startswith(f"motionfmu: {scenarios}/wrong/scenario.toml:10: ")
    assert done.stderr.count("\n") == 1
    xml = JUnitXml.fromfile(str(file))
    assert (xml.tests, xml.failures, xml.errors) == (4, 1, 1)
    # Four times and their sum are rounded to 1 ms.
    rounding = 5 * 0.5e-3 + 1e-9
    assert xml.time == pytest.approx(sum(c.time for s in xml for c in s), abs=rounding)
    assert xml.time > 0
    found = cases(file)
    assert [name for name, *_ in found] == list(PLACES)
    assert found[0][1] == found[1][1] == ""
    assert found[2][1][0] == "failure" and "axis.table_speed[1] = 0.025, asked" in found[2][1][1]
    assert found[3][1][0] == "error" and "axis.taw" in found[3][1][1]


def test_json_says_the_same(scenarios: Path, tmp_path: Path) -> None:
    paths = [scenarios / "slow", scenarios / "good" / "scenario.toml"]
    done = within("check", *paths, "--json", folder=tmp_path)
    assert done.returncode == 1 and done.stderr.startswith("2 scenarios: 1 hold, 1 fail, ")
    told = json.loads(done.stdout)
    assert told["ok"] is False and [c["scenario"] for c in told["cases"]] == ["slow", "good"]
    assert [c["ok"] for c in told["cases"]] == [False, True]
    assert told["cases"][0]["checks"][0]["value"] == pytest.approx(0.025, rel=1e-6)
    assert 0.0 < told["cases"][1]["seconds"] <= told["seconds"]


def test_contraries_are_cases_too(scenarios: Path, tmp_path: Path) -> None:
    file = tmp_path / "check.xml"
    done = within("check", scenarios / "good", "--contrary", "--junit", file, folder=tmp_path)
    assert done.returncode == 0
    told = "1 scenario, 2 contraries: 2 fail as they must, 0 do not, "
    assert done.stdout.splitlines()[-1].startswith(told)
    assert [name for name, *_ in cases(file)] == ["good, off: the lag", "good, off: 1 V: 1 % less"]
    assert list(tmp_path.iterdir()) == [file]
    one = tmp_path / "one"
    one.mkdir()
    text = (scenarios / "good" / "scenario.toml").read_text()
    (one / "scenario.toml").write_text(text[: text.rindex("[[contrary]]")])
    done = within("check", one, "--contrary", folder=tmp_path)
    last = done.stdout.splitlines()[-1]
    assert last.startswith("1 scenario, 1 contrary fails as it must, "), last


def test_what_is_no_place_is_refused_before_anything_runs(scenarios: Path, tmp_path: Path) -> None:
    for line, told in (
        ([scenarios / "none"], "no such scenario, nor a folder of scenarios"),
        ([scenarios / "notes"], "neither scenario.toml nor a folder with one in it"),
        ([], "no scenario here: name one"),
        ([scenarios, "--junit", tmp_path / "no" / "x.xml"], "a file in a folder that exists"),
        ([scenarios, "-j", 0], "invalid value for '-j' / '--jobs'"),
    ):
        done = within("check", *line, folder=tmp_path)
        assert (done.returncode, done.stdout) == (2, "") and told in done.stderr
        assert done.stderr.count("\n") == 1


def test_a_run_that_ends_its_process_is_an_error_of_its_own(
    scenarios: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # The worker's own modules: one that ends the process over a scenario named slow.
    (tmp_path / "sitecustomize.py").write_text(
        "import os, sys\n"
        "if 'serve(' in ' '.join(sys.orig_argv):\n"
        "    from motionfmu.run import suite\n"
        "    judged = suite.judged\n"
        "    suite.judged = lambda p, *rest: os.abort() if p.name == 'slow' else judged(p, *rest)\n"
    )
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    paths = [scenarios / place for place in ("slow", "good", "other")]
    done = within("check", *paths, "-j", 2, folder=tmp_path)
    assert done.returncode == 2 and "slow: it ended its process (signal 6)" in done.stderr
    assert done.stdout.splitlines()[-1].startswith("3 scenarios: 2 hold, 0 fail, 1 wrong, ")
