"""The console command and the library as a user meets them."""

import json
import re
from html.parser import HTMLParser
from importlib import metadata
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT
from console import command, within

import motionfmu
from motionfmu.cli.common import results
from motionfmu.report.result_folder import save
from motionfmu.scenarios import fmus


@pytest.fixture(scope="module")
def demo(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    folder = tmp_path_factory.mktemp("out") / "circle"
    done = command("run", "scenarios/circle", "--out", folder, "--csv", "--stop", "7.6")
    assert done.returncode == 0, done.stdout + done.stderr
    return folder, done.stdout


def test_run_writes_a_whole_result_and_says_where(demo: tuple[Path, str]) -> None:
    folder, text = demo
    assert f"report: {folder}/report.html" in text
    assert "circle: all 5 checks hold, 9 expected not judged" in text
    (radius,) = (line for line in text.splitlines() if "contour.error.max" in line)
    assert re.fullmatch(
        r" expected  contour.error.max +0\.0\d+ +>= 0\.044 and <= 0\.047; as expected", radius
    )
    names = {p.name for p in folder.iterdir()}
    assert names == {
        "signals",
        "signals.csv",
        "result.json",
        "contour.json",
        "contour",
        "report.html",
    }
    assert not list(folder.parent.glob(".*"))


def test_the_result_file_says_all_in_numbers(demo: tuple[Path, str]) -> None:
    folder, _ = demo
    found = json.loads((folder / "result.json").read_text())
    assert found["scenario"] == "circle" and found["ok"] is True
    assert found["options"]["engine"] == "fused" and found["options"]["stop"] == 7.6
    assert {c["name"] for c in found["checks"]} >= {"mcc.done", "contour.error.max"}
    assert found["contour"] == json.loads((folder / "contour.json").read_text())
    position = np.load(folder / "signals/machine.table_position.npy", mmap_mode="r")
    assert position.shape == (76000, 6)
    time = np.load(folder / "signals/time.npy")
    assert np.array_equal(time, np.arange(76000) * 1e-4)
    head = (folder / "signals.csv").open().readline().strip().split(",")
    table = np.loadtxt(folder / "signals.csv", delimiter=",", skiprows=1, max_rows=5)
    assert head[0] == "time" and table.shape == (5, len(head))
    column = head.index("machine.table_position[2]")
    assert np.array_equal(table[:, column], position[:5, 1])


def test_the_report_needs_no_network(demo: tuple[Path, str]) -> None:
    page = (demo[0] / "report.html").read_text()
    assert "circle" in page and len(page) < 8_000_000
    fetched: list[str] = []

    class Tags(HTMLParser):
        def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
            fetched.extend(v or "" for k, v in attrs if k in ("src", "href"))

    Tags().feed(page)
    assert [link for link in fetched if "//" in link] == []


def test_a_failed_check_is_status_1_and_named(tmp_path: Path) -> None:
    out, mine = tmp_path / "circle", tmp_path / "mine"
    mine.mkdir()
    limit = '[check]\n"contour.error.max" = { min = 0.2608 }\n'
    text = f'# A limit.\nextends = "{ROOT}/scenarios/mismatch_line"\n{limit}'
    (mine / "scenario.toml").write_text(text)
    done = within("run", mine, "--set", "mcc.p_gain=200", "--out", out)
    assert done.returncode == 1
    assert "not as written: mcc.p_gain = 200 (scenario: [200, 160, 0, 0, 0, 0])" in done.stdout
    assert "ended: stop = 2 s; the program was done at 1." in done.stdout
    assert "mine: 1 of 6 checks FAILED" in done.stdout and (out / "report.html").is_file()
    row = next(r for r in done.stdout.splitlines() if "FAILED" in r and "contour.error.max" in r)
    assert ">= 0.2608" in row


def test_values_of_a_file_are_told_with_its_name_and_every_thins(tmp_path: Path) -> None:
    (tmp_path / "gains.toml").write_text('"mcc.p_gain" = [150, 150, 0, 0, 0, 0]\n')
    line = ["scenarios/mismatch_line", "--set", tmp_path / "gains.toml", "--stop", "0.2"]
    done = within("run", *line, "--every", 10, "--out", tmp_path / "r")
    assert "not as written: gains.toml: mcc.p_gain = [150, 150, 0, 0, 0, 0]" in done.stdout
    assert "not as written: every = 10 (scenario: 1)" in done.stdout
    assert len(np.load(tmp_path / "r/signals/time.npy")) == 200


def test_an_older_result_is_replaced(tmp_path: Path) -> None:
    out = tmp_path / "r"
    for stop in ("0.2", "0.3"):
        within("run", "scenarios/mismatch_line", "--stop", stop, "--out", out)
        assert json.loads((out / "result.json").read_text())["options"]["stop"] == float(stop)
    assert [p.name for p in tmp_path.iterdir()] == ["r"]


def test_list_tells_all_there_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    listed = within("list").stdout
    names = {p.parent.name for p in ROOT.glob("fmus/*/fmu.toml")}
    assert all(name in listed for name in names)
    assert all(str(p.parent.relative_to(ROOT)) in listed for p in ROOT.glob("scenarios/*/*.toml"))
    monkeypatch.setenv("MOTIONFMU_FMUS", str(tmp_path))
    told = f"none is built in {tmp_path}; "
    assert within("list").stdout.startswith(f"FMUs: {told}make build builds them\n")
    assert within("info", "mcc").stderr.endswith(
        f"nor a scenario (FMUs: {told}run make build; scenarios: motionfmu list)\n"
    )


@pytest.mark.parametrize("columns", [80, 160])
def test_info_crops_nothing(columns: int) -> None:
    done = within("info", "servo_drives", columns=columns)
    assert max(map(len, done.stdout.splitlines())) <= columns
    words = " ".join(done.stdout.split())
    for port in fmus.ports("servo_drives").values():
        assert port.name in words and " ".join(port.doc.split()) in words
    assert "velocity_gain Float64[6] N·m·s/rad 0.5 >= 0 " in words


def test_info_chooses_variables() -> None:
    found = within("info", "mcc", "home_*", "hold").stdout
    names = [line.split()[0] for line in found.splitlines() if line[2:3].strip() and "_" in line]
    assert {n for n in names if n.islower()} >= {"home_first", "home_settle"}
    assert "p_gain" not in found and "\n  hold " in found
    of_scenario = within("info", "scenarios/circle", "mcc.p_*", "card.enc_phase").stdout
    assert "mcc.p_gain" in of_scenario and "here 200; P gain" in of_scenario
    assert "from machine.motor_phase; " in of_scenario
    wrong = within("info", "mcc", "hme_first")
    assert wrong.returncode == 2
    assert wrong.stderr == "motionfmu: no variable 'hme_first'; did you mean 'home_first'?\n"


def test_info_of_a_scenario_and_of_an_fmu_s_xml() -> None:
    words = " ".join(within("info", "scenarios/circle").stdout.split())
    assert "machine ball_screw_axes Six ball-screw axes" in words
    assert "mcc.p_gain 200" in words and "mcc.done final = true" in words
    assert "friction at reversal machine.motor_coulomb = 0" in words and "1/s" in words
    assert within("info", "scope", "--xml", "--fmi", "2").stdout.startswith("<?xml")
    assert within("info", "scenarios/circle", "--xml").returncode == 2


def test_wrong_words_get_one_line_with_what_was_meant() -> None:
    for line, told in (
        ("rnu", "no such command 'rnu'; did you mean 'run'? (help: motionfmu --help)"),
        ("describe mcc", "no such command 'describe'; did you mean 'info'? (help"),
        ("run --enginee x", "no such option: --enginee; did you mean '--engine'? (help: motion"),
        ("card srve", "no such command 'srve'; did you mean 'serve'? (help: motionfmu card --h"),
        ("run", "missing argument 'path' (help: motionfmu run --help)"),
    ):
        done = within(*line.split())
        assert done.returncode == 2 and done.stdout == ""
        assert done.stderr.startswith(f"motionfmu: {told}") and done.stderr.count("\n") == 1
    version = within("--version")
    assert (version.returncode, version.stdout) == (
        0,
        f"motionfmu {metadata.version('motionfmu')}\n",
    )


def test_help_lists_commands_whole() -> None:
    words = " ".join(within("--help").stdout.split())
    assert "resumes where an earlier call was ended." in words and words.count("...") == 1


def test_the_readme_example_runs() -> None:
    result = motionfmu.load(ROOT / "scenarios/circle").run(set={"mcc.p_gain": 300}, stop=7.6)
    assert result.contour().error.max > 0.0
    assert result["card.err_count"].shape == (76000, 6)
    assert np.array_equal(result["card.err_count[2]"], result["card.err_count"][:, 1])
    with pytest.raises(KeyError, match=r"card.err_count has 6 axes"):
        result["card.err_count[7]"]


def test_progress_ends_at_one_and_never_falls() -> None:
    shares: list[float] = []
    motionfmu.load(ROOT / "scenarios/mismatch_line").run(stop=0.5, progress=shares.append)
    assert len(shares) >= 50 and shares[-1] == 1.0
    assert shares == sorted(shares)


def test_a_result_that_cannot_be_written_leaves_nothing(tmp_path, monkeypatch) -> None:
    def full(*_, **__) -> None:
        raise OSError(28, "No space left on device")

    result = motionfmu.load(ROOT / "scenarios/circle").run(stop=0.01)
    monkeypatch.setattr("motionfmu.report.result_folder.write", full)
    with pytest.raises(motionfmu.InputError, match=r"cannot write .*No space left on device"):
        save(result, tmp_path / "a/b/result")
    assert list(tmp_path.iterdir()) == []


def test_results_of_all_commands_are_named_alike() -> None:
    """A run's folder has the scenario's name; any other ends with the command's after a dot."""
    assert [str(results("a")), str(results("a", "tune"))] == ["results/a", "results/a.tune"]
    kinds = {}
    for name in ("run", "compare", "contour", "gcode", "margins", "sweep", "tune", "card_plan"):
        text = (ROOT / f"src/motionfmu/cli/{name}.py").read_text()
        calls = re.findall(r"[ (]results\((.*)\)", text)
        kinds[name] = [k for call in calls for k in re.findall(r', "(\w+)"', call) or [""]]
    own = {n: [n] for n in ("compare", "gcode", "margins", "sweep", "tune")}
    assert kinds == own | {"run": [""], "contour": ["iso9283", "contour"], "card_plan": ["plan"]}
