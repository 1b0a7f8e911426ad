"""The console command and the library as a user meets them."""

import json
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT
from console import command

import motionfmu
from motionfmu.report.outcome import save


@pytest.fixture(scope="module")
def demo(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    folder = tmp_path_factory.mktemp("out") / "circle"
    done = command("run", "scenarios/circle", "--out", folder, "--csv", "--stop", "7.6")
    assert done.returncode == 0, done.stdout + done.stderr
    return folder, done.stdout


def test_run_writes_a_whole_result_and_says_where(demo: tuple[Path, str]) -> None:
    folder, text = demo
    assert f"report: {folder}/report.html" in text
    assert "circle: all checks hold" in text
    names = {p.name for p in folder.iterdir()}
    assert names == {
        "signals.npz",
        "signals.csv",
        "result.json",
        "contour.json",
        "contour.npz",
        "report.html",
        "path.png",
        "path.svg",
    }
    assert not list(folder.parent.glob(".*"))


def test_the_result_file_says_all_in_numbers(demo: tuple[Path, str]) -> None:
    folder, _ = demo
    found = json.loads((folder / "result.json").read_text())
    assert found["scenario"] == "circle" and found["ok"] is True
    assert found["options"]["engine"] == "native" and found["options"]["stop"] == 7.6
    assert {c["name"] for c in found["checks"]} >= {"mcc.done", "contour.error.max"}
    assert found["contour"] == json.loads((folder / "contour.json").read_text())
    with np.load(folder / "signals.npz") as signals:
        position = signals["machine.table_position"]
        assert position.shape == (76000, 6) and len(signals["time"]) == 76000
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
    out = tmp_path / "circle"
    done = command("run", "scenarios/mismatch_line", "--set", "mcc.p_gain=200", "--out", out)
    assert done.returncode == 1
    assert "a check FAILED" in done.stdout and (out / "report.html").is_file()
    row = next(r for r in done.stdout.splitlines() if "FAILED" in r and "contour.error.max" in r)
    assert ">= 0.2608" in row


def test_an_older_result_is_replaced(tmp_path: Path) -> None:
    out = tmp_path / "r"
    for stop in ("0.2", "0.3"):
        command("run", "scenarios/mismatch_line", "--stop", stop, "--out", out)
        assert json.loads((out / "result.json").read_text())["options"]["stop"] == float(stop)
    assert [p.name for p in tmp_path.iterdir()] == ["r"]


def test_list_info_describe_and_check() -> None:
    listed = command("list").stdout
    names = {p.parent.name for p in ROOT.glob("fmus/*/fmu.toml")}
    assert all(name in listed for name in names)
    assert all(str(p.parent.relative_to(ROOT)) in listed for p in ROOT.glob("scenarios/*/*.toml"))
    described = command("info", "servo_drives").stdout
    assert "velocity_gain" in described and "N.m.s/rad" in described
    told = command("info", "scenarios/circle").stdout
    assert "ball_screw_axes" in told and "mcc.p_gain[1,2] = 200 (Kp 47.7 1/s)" in told
    assert command("describe", "scope", "--xml", "--fmi", "2").stdout.startswith("<?xml")
    checked = command("check", "scenarios/mismatch_line", "scenarios/square")
    assert checked.returncode == 0 and checked.stdout.count("ok ") == 2
    assert "error.max" in command("contour", "scenarios/mismatch_line", "--figures").stdout


def test_the_readme_example_runs() -> None:
    result = motionfmu.load(ROOT / "scenarios/circle").run(set={"mcc.p_gain": 300}, stop=7.6)
    assert result.contour().error.max > 0.0
    assert result["card.err_count"].shape == (76000, 6)
    assert np.array_equal(result["card.err_count[2]"], result["card.err_count"][:, 1])
    with pytest.raises(KeyError, match=r"card.err_count\[7\] is not recorded"):
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
    monkeypatch.setattr("motionfmu.report.outcome.np.savez_compressed", full)
    with pytest.raises(motionfmu.InputError, match=r"cannot write .*No space left on device"):
        save(result, tmp_path / "a/b/result", {})
    assert list(tmp_path.iterdir()) == []
