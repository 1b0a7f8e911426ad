"""Two runs laid over one another: against their raw samples, the page's own data, theory."""

import json
import re
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT
from console import within
from page_curves import page_data, unwoven

import motionfmu
from motionfmu.base import columns
from motionfmu.base.errors import InputError
from motionfmu.compare import Comparison, compare, overlay, plots
from motionfmu.compare.comparison_page import page_text
from motionfmu.compare.number_pairs import Number
from motionfmu.compare.side import Side
from motionfmu.compare.words import GONE
from motionfmu.report.numbers import length
from motionfmu.run import Result, result_files

THEORY = ROOT / "scenarios/circle_theory"
PLACES = ("none", "half", "broken", "old", "torn", "short")
POSITION, STOCK = "machine.table_position", "card.stock"


def leave(result: Result, folder: Path) -> Path:
    """The folder of a run, without its report."""
    folder.mkdir()
    columns.write(folder / result_files.SIGNALS, result.signals, result.time)
    way = result_files.track(result.contour())
    columns.write(folder / result_files.TRACK, way, way.pop("time"))
    (folder / result_files.NUMBERS).write_text(json.dumps(result_files.numbers(result)))
    return folder


@pytest.fixture(scope="module")
def runs() -> tuple[Result, Result]:
    scenario = motionfmu.load(THEORY)
    return scenario.run(), scenario.run(set={"mcc.p_gain": 300})


@pytest.fixture(scope="module")
def found(runs: tuple[Result, Result]) -> Comparison:
    return compare(*runs)


@pytest.fixture(scope="module")
def folders(
    runs: tuple[Result, Result], tmp_path_factory: pytest.TempPathFactory
) -> tuple[Path, Path]:
    place = tmp_path_factory.mktemp("runs")
    return leave(runs[0], place / "a"), leave(runs[1], place / "b")


def test_a_difference_is_b_minus_a_at_every_sample(
    runs: tuple[Result, Result], found: Comparison
) -> None:
    a, b = runs
    assert found.names == list(a.signals) and not found.left
    for s in found.signals:
        gone = b.signals[s.name].astype(float) - a.signals[s.name].astype(float)
        assert np.array_equal(found[s.name].difference.reshape(gone.shape), gone)
        assert s.same == (not gone.any())
        assert abs(s.largest) == np.abs(gone).max() and s.largest in gone
        assert s.rms == pytest.approx(np.sqrt((gone**2).mean()), rel=1e-12)
    # A stiffer loop is ahead: with the axis moving up, B - A of the position is positive.
    way = found[POSITION]
    up = np.argmax(np.gradient(way.a[:, 0]))
    assert way.difference[up, 0] > 0.0


def test_the_page_shows_both_runs_and_b_minus_a(
    runs: tuple[Result, Result], found: Comparison
) -> None:
    page = page_text(found)
    data = page_data(page)
    drawn = {f["id"]: f for f in data["figures"]}
    apart = [s for s in found.signals if not s.same]
    assert POSITION in {s.name for s in apart}
    of = [f["data"] for name, f in drawn.items() if name.startswith("signal")]
    assert len(of) == len(apart), "a signal that differs is not drawn"
    for s, traces in zip(apart, of, strict=True):
        both = found[s.name]
        shown = [unwoven(t["samples"]["values"]) for t in traces]
        for k, i in enumerate(both.differing):
            gone = both.difference[:, i]
            near = 1e-5 * np.ptp(both.a[:, i]) + 1e-12
            assert traces[2 * k]["name"] == "run A" and traces[2 * k + 1]["name"] == "run B"
            assert np.abs(shown[2 * k] - both.a[:, i]).max() <= near
            assert np.abs(shown[2 * k + 1] - both.b[:, i]).max() <= near
            last = shown[2 * len(both.differing) + k]
            assert np.abs(last - gone).max() <= 1e-5 * np.ptp(gone)
    for name in runs[0].signals:
        assert name in page
    assert "mcc.p_gain" in page and GONE in page
    row = re.search(r"Contour error, largest</td>(.*?)</tr>", page)
    shown = [f">{length(r.contour().error.max)}<" for r in runs]
    assert row and row[1].index(shown[0]) < row[1].index(shown[1])
    verdict = re.search(r"radius_change</td>(.*?)</tr>", page)  # in the unit of the cards
    assert verdict and verdict[1].count(" µm<") == 3
    assert " um" not in page.partition("<script>")[0]


def test_the_contour_of_both_stands_side_by_side(
    runs: tuple[Result, Result], found: Comparison
) -> None:
    a, b = (r.contour() for r in runs)
    table = {n.name: n for n in found.table("contour")}
    for name in ("error.max", "error.rms", "following.x.max", "circles.0.ccw.g", "lag"):
        n = table[name]
        assert (n.a, n.b) == (a.number(name), b.number(name))
        assert n.difference == n.b - n.a
    # The radius shrinks by V^2/(2 R Kp^2): at 3/2 of the gain to 4/9.
    assert table["error.rms"].change == pytest.approx(100.0 * (4 / 9 - 1), abs=3.0)
    drawn, largest = plots.error_figure(found.a, found.b)
    over = {mark.name: mark.samples for mark in drawn.marks}
    assert over["run A"].values.max() > over["run B"].values.max() > 0.0
    middle = len(over[GONE].values) // 2
    gone = over["run B"].values.max() - over["run A"].values.max()
    assert over[GONE].values[middle] == pytest.approx(gone, rel=0.2)
    assert largest == pytest.approx(np.abs(over[GONE].values).max() * 1e-3)
    told = {mark.name for mark in plots.circle_figure(found, 0).marks}
    assert {"run A, counter-clockwise", "run B, counter-clockwise"} <= told
    path, factor = plots.path_figure(found.a, found.b)
    assert [mark.name for mark in path.marks] == ["programmed path", "run A", "run B"]
    assert factor > 1


def test_a_change_is_that_of_the_size_and_a_difference_has_a_sign() -> None:
    assert (Number("", -0.04, -0.02).difference, Number("", -0.04, -0.02).change) == (0.02, -50.0)
    assert Number("", 0.02, 0.03).change == pytest.approx(50.0)
    assert Number("", 0.0, 0.03).change is None and Number("", 1.0, -1.0).change is None
    assert Number("", None, 1.0).difference is None


def test_folders_say_what_the_runs_themselves_do(
    found: Comparison, folders: tuple[Path, Path]
) -> None:
    again = compare(*folders)
    assert (again.a.name, again.b.name) == tuple(map(str, folders))
    told, same = again.numbers(), found.numbers()
    for key in ("different", "common", "checks", "contour", "signals", "worse"):
        assert json.loads(json.dumps(told[key])) == json.loads(json.dumps(same[key])), key


def test_what_was_run_differently_is_listed(found: Comparison, folders: tuple[Path, Path]) -> None:
    assert [(d.what, d.a, d.b) for d in found.different] == [("mcc.p_gain", "200", "300")]
    a, b = (compare(f, f).a for f in folders)
    run = json.loads(json.dumps(a.numbers["run"]))
    run["files"] = dict.fromkeys(run["files"], "another")
    run["fmus"]["mcc"] = "another"
    run["settings"]["machine.tau"] = [0.5] * 6
    del run["settings"]["mcc.p_gain"]
    run |= {"step": 2e-4, "every": 3}
    other = replace(b, numbers=b.numbers | {"run": run})
    told = {d.what: (d.a, d.b) for d in compare_sides(a, other).different}
    assert told["file circle.ngc"] == ("one content", "another content")
    assert "FMU mcc" in told and "FMU epcio" not in told
    assert told["step"][1] == "0.2 ms" and told["every"] == ("1 step", "3 steps")
    assert told["machine.tau"][1].startswith("0.5")
    assert told["mcc.p_gain"][1].endswith("(default)")


def compare_sides(a: Side, b: Side) -> Comparison:
    return Comparison(a, b, overlay.common(a, b), [n for n in a.signals if n in b.signals], {})


def synthetic(time: np.ndarray, **signals: np.ndarray) -> Side:
    made = {"units": dict.fromkeys(signals, "mm"), "ok": True, "checks": []}
    return Side("x", made, time, signals, {})


def judged(ok: bool, *checks: tuple[str, bool | None]) -> Side:
    """A run with a verdict as a whole, and checks with theirs."""
    side = synthetic(np.arange(10) * 1e-3, x=np.zeros(10))
    rows = [
        {"name": n, "bounds": "<= 1", "value": 0.5, "ok": held, "reason": ""} for n, held in checks
    ]
    return replace(side, numbers=side.numbers | {"ok": ok, "checks": rows})


def test_a_check_that_a_has_not_and_b_fails_is_worse_if_a_holds() -> None:
    b = judged(False, ("old", True), ("new", False))
    assert compare_sides(judged(True, ("old", True)), b).worse == ["new"]
    assert compare_sides(judged(False, ("old", True), ("gone", False)), b).worse == []
    fails = judged(False, ("old", False), ("new", False))
    assert compare_sides(judged(False, ("old", True)), fails).worse == ["old"]
    assert compare_sides(b, judged(True, ("old", True))).worse == []


def test_a_default_that_one_run_spells_out_is_no_difference() -> None:
    scenario = motionfmu.load(THEORY)
    port = scenario.resolver.end("mcc.acc_time", "set", "mcc.acc_time").port
    default = float((port.start or "").split()[0])
    plain = scenario.run(stop=0.01)
    assert "mcc.acc_time" not in plain.parameters
    spelled = scenario.run(stop=0.01, set={"mcc.acc_time": default})
    assert compare(plain, spelled).different == compare(spelled, plain).different == []
    other = scenario.run(stop=0.01, set={"mcc.acc_time": 2.0 * default})
    for pair in ((plain, other), (other, plain)):
        assert [d.what for d in compare(*pair).different] == ["mcc.acc_time"]


def test_other_steps_and_lengths_are_compared_on_the_common_time() -> None:
    fine, coarse = np.arange(1000) * 1e-3, np.arange(350) * 2e-3
    a = synthetic(fine, x=np.sin(fine), n=(fine * 100).astype(int))
    b = synthetic(coarse, x=np.sin(coarse) - 0.25, n=(coarse * 100).astype(int) + 2)
    for first, second, sign, names in ((a, b, -1, "AB"), (b, a, 1, "BA")):
        found = compare_sides(first, second)
        assert np.array_equal(found.common.time, coarse) and found.common.between == (False, False)
        assert np.allclose(found["x"].difference, 0.25 * sign, atol=1e-15)
        assert np.array_equal(found["n"].difference[:, 0], np.full(350, -2.0 * sign))
        steps, ends = found.common.words
        assert "350 common instants" in steps
        assert ends.startswith(f"{names[1]} ends at 0.7 s, {names[0]} at 1 s")


def test_values_between_samples_lie_on_lines_and_counts_hold() -> None:
    three, ten = np.arange(40) * 3e-3, np.arange(11) * 1e-2
    a = synthetic(three, x=5 * three, n=np.arange(40))
    b = synthetic(ten, x=5 * ten + 1, n=np.arange(11))
    found = compare_sides(a, b)
    assert found.common.between == (True, False) and len(found.common.words) == 3
    assert np.allclose(found["x"].difference, 1.0, atol=1e-12)
    assert np.array_equal(found["n"].a[:, 0], [0, 3, 6, 10, 13, 16, 20, 23, 26, 30, 33])
    with pytest.raises(InputError, match="no time in common"):
        overlay.common(a, synthetic(ten + 5, x=ten))


def test_what_only_one_run_has_is_said(folders: tuple[Path, Path], tmp_path: Path) -> None:
    less = tmp_path / "less"
    less.mkdir()
    shutil.copytree(folders[1] / result_files.SIGNALS, less / result_files.SIGNALS)
    made = json.loads((folders[1] / result_files.NUMBERS).read_text())
    (less / result_files.SIGNALS / f"{STOCK}.npy").unlink()
    made["units"][POSITION] = "mm"
    (less / result_files.NUMBERS).write_text(json.dumps(made))
    found = compare(folders[0], less)
    assert found.left == {STOCK: "only in A", POSITION: "[m] in A, [mm] in B"}
    page = page_text(found)
    assert f"{STOCK}: only in A" in page
    with pytest.raises(InputError, match="is not compared: only in A"):
        found[STOCK]
    with pytest.raises(InputError, match=r"did you mean 'mcc\.done'"):
        found["mcc.dono"]


def test_the_console_says_it_and_its_status_is_the_verdict(
    folders: tuple[Path, Path], tmp_path: Path
) -> None:
    a, b = folders
    mine = tmp_path / "mine"
    mine.mkdir()
    base = Path(__file__).parents[2] / "scenarios/circle_theory"
    limit = '[check]\n"contour.circles.0.ccw.radius_change" = { max = -0.0530 }\n'
    text = f'# A limit.\nextends = "{base}"\n{limit}'
    (mine / "scenario.toml").write_text(text)
    worse = within("compare", mine, mine, "--set", "mcc.p_gain=300", "--json")
    told = json.loads(worse.stdout)
    assert worse.returncode == 1 and not told["ok"] and len(list(tmp_path.iterdir())) == 1
    failed = {c["name"] for c in told["checks"] if c["worse"]}
    assert failed == {*told["worse"]} and any("radius_change" in n for n in failed)
    for c in told["checks"]:
        assert c["worse"] == (c["ok"] == {"a": True, "b": False})
    better = within("compare", b, a, "--out", tmp_path / "back", "--signals", "card.*")
    assert better.returncode == 0, better.stderr
    assert "mcc.p_gain: 300 → 200" in better.stdout and "no verdict is worse" in better.stdout
    assert {p.name for p in (tmp_path / "back").iterdir()} == {"report.html", "result.json"}
    names = {s["name"] for s in json.loads((tmp_path / "back/result.json").read_text())["signals"]}
    assert names and all(n.startswith("card.") for n in names)


@pytest.mark.parametrize(
    ("line", "told"),
    [
        (("{b}", "--signals", "card.stok"), "no signal 'card.stok'"),
        (("{none}",), "no such scenario"),
        (("{half}",), "no signals/; the folder of a run"),
        (("{torn}",), f"signals/{STOCK}.npy: no array of numpy: mmap length"),
        (("{short}",), f"{STOCK} has not as many samples as the time"),
        (("{broken}",), "no JSON"),
        (("{old}",), "written by another version"),
        (("{b}", "--set", "mcc.p_gain=3"), "only a scenario can be run with --set"),
    ],
)
def test_wrong_input_is_one_message(
    line: tuple[str, ...], told: str, folders: tuple[Path, Path], tmp_path: Path
) -> None:
    places = {n: tmp_path / n for n in PLACES} | {"b": folders[1]}
    for name, text in (("half", "{}"), ("broken", "{"), ("old", "{}")):
        places[name].mkdir()
        (places[name] / result_files.NUMBERS).write_text(text)
    (places["old"] / result_files.SIGNALS).mkdir()
    for name in ("torn", "short"):
        shutil.copytree(folders[1], places[name])
    torn = places["torn"] / result_files.SIGNALS / f"{STOCK}.npy"
    torn.write_bytes(torn.read_bytes()[:5000])  # its head is whole
    np.save(places["short"] / result_files.SIGNALS / f"{STOCK}.npy", np.zeros((3, 6)))
    wrong = within(
        "compare", folders[0], *(x.format(**places) for x in line), "--out", tmp_path / "x"
    )
    assert wrong.returncode == 2 and told in wrong.stderr, wrong.stderr
    assert wrong.stderr.count("\n") == 1 and not (tmp_path / "x").exists()
