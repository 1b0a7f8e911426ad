"""Studies: points, rows whatever runs them, resuming after a kill, errors as rows, pictures."""

import hashlib
import json
import os
import shutil
import signal
import subprocess
import sys
import time
import zipfile
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest
from conftest import ROOT
from hypothesis import given, settings
from hypothesis import strategies as st
from page_curves import page_data

import motionfmu
from motionfmu.run.session import Session
from motionfmu.scenarios import fmus
from motionfmu.scenarios.body import Bounds
from motionfmu.scenarios.system import End
from motionfmu.study import (
    book,
    open_runs,
    processes,
    study_axes,
    study_columns,
    study_table,
    worker,
)
from motionfmu.sweep import Outcome, Study, Ways, conduct, study

CIRCLE = ROOT / "scenarios/circle_theory"
GAIN, TAU = "mcc.p_gain", "machine.tau"
RESULTS = ["card.err_count.absmax", "machine.table_position[1].final", "mcc.starved.max"]
SHORT = {"stop": 0.03, "results": RESULTS, "cost": RESULTS[0]}


def small(n: int = 6, **more: object) -> Study:
    """A grid of 2 n runs of 30 ms."""
    axis = {GAIN: {"from": 100, "to": 600, "n": n}, "mcc.irq_latency": [2e-4, 3e-3]}
    return study(CIRCLE, {**SHORT, "axis": axis, **more})


def table(folder: Path) -> list[dict]:
    return pq.read_table(folder / "sweep.parquet").to_pylist()


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Outcome:
    return conduct(small(), tmp_path_factory.mktemp("sweep") / "two", Ways(workers=2))


@pytest.fixture
def here(monkeypatch: pytest.MonkeyPatch) -> None:
    """All runs in this process, without a report: much faster where neither matters."""
    monkeypatch.setattr(processes, "rows", lambda job, tasks, _: iter(worker.chunk(job, tasks)))
    monkeypatch.setattr("motionfmu.report.studies.sweep_page.write_sweep", lambda *_: None)


# ---- points


def axis(kind: str, spec: object, name: str = "a.b") -> study_axes.Axis:
    port = motionfmu.load(CIRCLE).resolver.ports["mcc"]["irq_latency"]
    kinds = {"port": type(port)(**{**port.__dict__, "type": kind, "shape": ()})}
    source = (
        study_axes.ListedValues(values=spec)
        if isinstance(spec, list)
        else (study_axes.Normal if "mean" in spec else study_axes.Span).model_validate(spec)
    )
    return study_axes.Axis(name, End("a", **kinds), source)


def test_a_grid_has_every_combination_the_last_axis_fastest() -> None:
    found = study_axes.points(
        [axis("Float64", {"from": 0, "to": 1, "n": 3}), axis("String", ["u", "v"])], "grid", 0, 0
    )
    assert found == [(x, t) for x in (0.0, 0.5, 1.0) for t in ("u", "v")]
    decades = axis("Float64", {"from": 1e-3, "to": 1e3, "n": 7, "log": True}).grid()
    assert decades == pytest.approx(10.0 ** np.arange(-3, 4), rel=1e-14)
    assert (decades[0], decades[-1]) == (1e-3, 1e3)


@settings(max_examples=25)
@given(runs=st.integers(1, 200), dimensions=st.integers(1, 5), seed=st.integers(0, 2**32))
def test_a_latin_hypercube_takes_every_part_of_every_axis_once(
    runs: int, dimensions: int, seed: int
) -> None:
    every = [axis("Float64", {"from": 2.0, "to": 5.0})] * dimensions
    found = np.array(study_axes.points(every, "latin", runs, seed))
    parts = np.floor((found - 2.0) / 3.0 * runs).astype(int).clip(0, runs - 1)
    assert (np.sort(parts, axis=0) == np.arange(runs)[:, None]).all()
    assert study_axes.points(every, "latin", runs, seed) == [tuple(p) for p in found]


def test_draws_follow_their_distribution() -> None:
    from scipy import stats

    specs = [
        axis("Float64", {"from": 2.0, "to": 5.0}),
        axis("Float64", {"from": 1e-2, "to": 1e2, "log": True}),
        axis("Float64", {"mean": 3.0, "deviation": 0.5}),
        axis("Int32", {"from": 1, "to": 4}),
        axis("Boolean", [True, False]),
    ]
    a, b, c, d, e = zip(*study_axes.points(specs, "random", 4000, 7), strict=True)
    for sample, law in (
        (a, stats.uniform(2, 3)),
        (b, stats.loguniform(1e-2, 1e2)),
        (c, stats.norm(3.0, 0.5)),
    ):
        assert stats.kstest(sample, law.cdf).pvalue > 1e-3
    whole = Counter(d)
    assert set(whole) == {1, 2, 3, 4} and all(isinstance(x, int) for x in d)
    assert stats.chisquare(list(whole.values())).pvalue > 1e-3
    assert set(e) == {True, False}
    assert study_axes.points(specs, "random", 5, 7) != study_axes.points(specs, "random", 5, 8)


# ---- rows


def test_a_session_gives_the_bits_of_a_run_of_its_own() -> None:
    scenario = motionfmu.load(CIRCLE)
    with Session(scenario, [GAIN, f"{GAIN}[2]", TAU], stop=0.05) as session:
        for values, alone in (
            ({GAIN: 300}, {GAIN: 300}),
            ({f"{GAIN}[2]": 90, TAU: 0.003}, {GAIN: [200, 90, 200, 200, 200, 200], TAU: 0.003}),
            ({f"{GAIN}[2]": 90, GAIN: 300}, {GAIN: [300, 90, 300, 300, 300, 300]}),
            ({}, {}),
        ):
            found, single = session.run(values), scenario.run(set=alone, stop=0.05)
            assert found.signals.keys() == single.signals.keys()
            for name, signal in single.signals.items():
                assert np.array_equal(found[name], signal), (name, values)
            assert found.geometry == single.geometry
        with pytest.raises(motionfmu.InputError, match=r"set mcc.p_gain = -1: outside 0"):
            session.run({GAIN: -1})
        assert session.run({GAIN: 300}).parameters[GAIN] == (300,) * 6


def test_rows_are_what_single_runs_give(whole: Outcome) -> None:
    rows = table(whole.folder)
    assert [r["run"] for r in rows] == list(range(12)) and {r["status"] for r in rows} == {"ok"}
    assert [(r[GAIN], r["mcc.irq_latency"]) for r in rows] == [
        (g, t) for g in range(100, 601, 100) for t in (2e-4, 3e-3)
    ]
    scenario = motionfmu.load(CIRCLE)
    for row in rows[::5]:
        given = {n: row[n] for n in (GAIN, "mcc.irq_latency")}
        result = scenario.run(set=given, stop=0.03)
        assert row[RESULTS[0]] == np.abs(result["card.err_count"]).max()
        assert row[RESULTS[1]] == result["machine.table_position"][-1, 0]
        assert row[RESULTS[2]] == result["mcc.starved"].max()
        assert row["checks"] is False and row["message"] == ""  # 30 ms hold no circle to judge
    schema = pq.read_schema(whole.folder / "sweep.parquet")
    assert schema.field(RESULTS[1]).metadata[b"unit"] == b"m"
    about = json.loads(schema.metadata[b"motionfmu"])
    assert about["runs"] == 12 and about["axes"] == [GAIN, "mcc.irq_latency"]


def test_one_worker_gives_the_same_rows_and_the_journal_is_gone(
    whole: Outcome, tmp_path: Path
) -> None:
    conduct(small(), tmp_path / "one", Ways(workers=1))
    assert table(tmp_path / "one") == table(whole.folder)
    names = {p.name for p in (tmp_path / "one").iterdir()}
    assert names == {"sweep.parquet", "report.html", "sweep.png", "sweep.svg"}


@pytest.mark.more
def test_a_cluster_gives_the_same_rows(whole: Outcome, tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, host="127.0.0.1"
    ) as cluster:
        ways = Ways(scheduler=cluster.scheduler_address)
        conduct(small(), tmp_path / "dask", ways)
        assert len(cluster.scheduler_info["workers"]) == 2
    assert table(tmp_path / "dask") == table(whole.folder)


def test_contour_figures_and_checks_become_columns() -> None:
    found = study(CIRCLE, {"axis": {GAIN: [100, 200]}})
    names = [c.name for c in found.columns]
    assert names[-2] == "contour.circles.0.ccw.radius_change"
    assert "mcc.error.absmax" in names and "mcc.done.final" in names
    # Nothing checks it, and no cost is named: it is what a study of a contour is about.
    assert names[-1] == found.cost == found.shown == "contour.error.max"


def test_a_check_of_one_element_becomes_a_column_of_it() -> None:
    scenario = motionfmu.load(ROOT / "scenarios/fifo_doubled")
    names = [c.name for c in study_columns.usual(scenario)]
    assert [n for n in names if "[" in n] == [
        "card.pulse_count[1].final",
        "card.stock[1].min",
        "card.stock[1].max",
    ]
    assert {"card.frames_refused.max", "mcc.services.final"} < {*names}
    every = Bounds(final=0.0)
    scenario.document.body.expect["card.err_count"] = [every]
    names = [c.name for c in study_columns.usual(scenario)]
    assert names[-6:] == [f"card.err_count[{i}].final" for i in range(1, 7)]


def test_the_radius_of_each_row_is_the_one_of_theory(tmp_path: Path, here) -> None:
    """V = 50 mm/s, R = 10 mm, ideal drive: dR = R (1/sqrt(1 + (V/(R Kp))^2) - 1)."""
    radius = "contour.circles.0.ccw.radius_change"
    chosen = study(CIRCLE, {"axis": {GAIN: [100, 200]}, "results": [radius], "set": {TAU: 0.0}})
    rows = conduct(chosen, tmp_path / "r").rows
    for row, gain in zip(rows, (47.7 / 2, 47.7), strict=True):
        z = np.exp(1j * 5.0 * 1e-4)
        sampled = 10.0 * (abs(gain * 1e-4 / (z * (z - 1) + gain * 1e-4)) - 1.0)
        assert row.values[0] == pytest.approx(sampled, rel=0.01)
    assert [row.checks for row in rows] == [True, True]  # no point is the scenario as written


def test_rows_of_mismatched_gains_are_those_of_theory(tmp_path: Path, here: None) -> None:
    """Steady contour error V sin a cos a (1/Kx - 1/Ky), V = 100 mm/s, a = 45 degrees."""
    axis = {f"{GAIN}[1]": [200, 240], f"{GAIN}[2]": [200, 160]}
    given = {"axis": axis, "results": ["contour.error.max"]}
    outcome = conduct(study(ROOT / "scenarios/mismatch_line", given), tmp_path / "m")
    for x, y, found in zip(*map(outcome.axis, axis), outcome.cost, strict=True):
        theory = 100.0 * 0.5 * abs(200 / x - 200 / y) / 47.684
        assert found == pytest.approx(theory, rel=0.01, abs=3e-3), (x, y)
    assert outcome.best == 0 and max(outcome.cost) > 0.4


class CountedRow(worker.Row):
    """A row that is counted as long as it is there."""

    now = most = 0

    def __init__(self, *given: object, **named: object) -> None:
        super().__init__(*given, **named)
        CountedRow.now += 1
        CountedRow.most = max(CountedRow.most, CountedRow.now)

    def __del__(self) -> None:
        CountedRow.now -= 1


@pytest.mark.parametrize("sampling", ["grid", "random"])
def test_rows_in_memory_do_not_grow_with_the_runs(
    sampling: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Journal, table, page: a group of rows, a neighbour, what is drawn; not four times as many."""
    group, most = 200, []
    monkeypatch.setattr(study_table, "GROUP", group)
    monkeypatch.setattr("motionfmu.report.studies.drawn_rows.DRAWN", group)
    monkeypatch.setattr("motionfmu.report.matplotlib_figure.write_picture", lambda *_: None)
    for module in (book, study_table):
        monkeypatch.setattr(module, "Row", CountedRow)

    def ended(job: object, tasks: open_runs.OpenRuns, _: int) -> Iterator[worker.Row]:
        order = np.random.default_rng(1).permutation(len(tasks))  # as workers might end
        for k in order:
            run, _ = tasks[int(k)]
            bad = run % 50 == 7
            values = (None,) * 3 if bad else (1.0 + run, float(run), 0.0)
            yield CountedRow(run, "error" if bad else "ok", f"no {run}" * bad, None, values)

    monkeypatch.setattr(processes, "rows", ended)
    for runs in (1000, 4000):
        axis: dict[str, object] = {GAIN: {"from": 1.0, "to": 600.0}, TAU: {"from": 1e-3, "to": 0.1}}
        more: dict[str, object] = {"sampling": sampling, "runs": runs}
        if sampling == "grid":
            axis, more = {GAIN: {"from": 1, "to": runs // 4, "n": runs // 4}, TAU: [1, 2, 3, 4]}, {}
        CountedRow.most = CountedRow.now = 0
        outcome = conduct(study(CIRCLE, {**SHORT, "axis": axis, **more}), tmp_path / f"{runs}")
        most.append(CountedRow.most)
        assert [row.run for row in outcome.rows] == list(range(runs))
        assert outcome.errors == runs // 50 and outcome.best == 0
        found = table(outcome.folder)
        assert [r[RESULTS[1]] for r in found] == [
            None if k % 50 == 7 else float(k) for k in range(runs)
        ]
        assert [(r[GAIN], r[TAU]) for r in found] == [*outcome.study.points]
        page = (outcome.folder / "report.html").read_text()
        assert f"of {runs} runs are drawn" in page
        (drawn,) = page_data(page)["figures"]
        assert "best: run 0" in {trace.get("name") for trace in drawn["data"]}
        del outcome
    assert group <= most[0] < 5 * group and most[1] < 1.2 * most[0]


def test_points_made_when_asked_for_are_those_of_a_list(tmp_path: Path) -> None:
    """And a study keeps the digest that it had when they were one, so that it is gone on with."""
    axis: dict[str, object] = {GAIN: {"from": 1, "to": 7, "n": 7}, "mcc.acc_type": ["T", "S"]}
    grid = study(CIRCLE, {**SHORT, "axis": {**axis, TAU: [0.25, 0.5, 0.75]}})
    whole = [(g, t, x) for g in range(1, 8) for t in ("T", "S") for x in (0.25, 0.5, 0.75)]
    drawn = study(
        CIRCLE,
        {
            **SHORT,
            "sampling": "random",
            "runs": 50,
            "axis": {GAIN: {"from": 1, "to": 7}, TAU: {"mean": 0.5, "deviation": 0.01}},
        },
    )
    for chosen, listed in ((grid, whole), (drawn, [*drawn.points])):
        points = chosen.points
        assert points == listed and len(points) == len(listed) and points[-1] == listed[-1]
        assert points[3:40:5] == listed[3:40:5] and [points[k] for k in (0, 9)] == listed[0:10:9]
        assert [type(x) for x in points[4]] == [type(x) for x in listed[4]]
        for i in range(points.width):
            assert sorted(points.different(i)) == sorted({point[i] for point in listed})
        with pytest.raises(IndexError):
            points[len(listed)]
        text = json.dumps([chosen.job.__dict__, listed], default=str, sort_keys=True)
        assert chosen.digest == hashlib.sha256(text.encode()).hexdigest()
    open_ones = open_runs.OpenRuns(grid.points, bytearray([1, 0, 2] * 14))
    assert [*open_ones] == open_ones[:] == [(k, whole[k]) for k in range(1, 42, 3)]
    queue = open_runs.Queue(open_ones)
    first = queue.take(3)
    queue.give_back(first[1:])
    assert [first[0], *queue.take(99)] == [*open_ones] and len(queue) == 0


# ---- errors


def test_a_wrong_run_is_a_row_with_its_error(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr(processes, "rows", lambda job, tasks, _: iter(worker.chunk(job, tasks)))
    axis = {GAIN: [200, -5, 70_000, 300], "mcc.program": ["circle.ngc", "none.ngc"]}
    chosen = study(CIRCLE, {**SHORT, "axis": axis})
    outcome = conduct(chosen, tmp_path / "s", Ways(workers=2))
    rows = table(tmp_path / "s")
    assert [r["run"] for r in rows if r["status"] == "ok"] == [0, 6]
    assert {r["status"] for r in rows} == {"ok", "error"} and len(rows) == 8
    assert "mcc.p_gain = -5: outside 0 .. 65535" in rows[2]["message"]
    assert "none.ngc" in rows[1]["message"] and rows[1][RESULTS[0]] is None
    assert outcome.errors == 6 and outcome.best in (0, 6)
    page = (tmp_path / "s/report.html").read_text()
    assert "outside 0 .. 65535" in page and "6 with an error" in page


def test_a_number_that_is_not_there_is_an_empty_cell_beside_the_others(
    tmp_path: Path, here: None
) -> None:
    given = {**SHORT, "axis": {GAIN: [200]}, "results": [RESULTS[0], "contour.circles.0.both.g"]}
    (row,) = conduct(study(CIRCLE, given), tmp_path / "s", Ways(workers=1)).rows
    assert row.status == "ok" and "circles" in row.message
    assert row.values[0] > 0 and row.values[1] is None


@pytest.mark.more
def test_a_run_that_ends_its_process_is_a_row_and_is_tried_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """sitecustomize makes a run of one gain kill its process, as a broken FMU would."""
    site = tmp_path / "site"
    site.mkdir()
    (site / "sitecustomize.py").write_text(
        "import os, motionfmu.run.session as s\n"
        "made = s.Session._execution_of\n"
        "def deadly(self, given, folder):\n"
        "    if given.get('mcc.p_gain') == 300: os.kill(os.getpid(), 11)\n"
        "    return made(self, given, folder)\n"
        "s.Session._execution_of = deadly\n"
    )
    chosen = study(CIRCLE, {**SHORT, "axis": {GAIN: {"from": 100, "to": 600, "n": 6}}})
    monkeypatch.setenv("PYTHONPATH", str(site))
    rows = conduct(chosen, tmp_path / "s", Ways(workers=2)).rows
    assert [r.status for r in rows] == ["ok", "ok", "crash", "ok", "ok", "ok"]
    assert "signal 11" in rows[2].message
    monkeypatch.delenv("PYTHONPATH")
    again = conduct(chosen, tmp_path / "s", Ways(workers=1))
    assert again.resumed == 5 and [r.status for r in again.rows] == ["ok"] * 6
    assert again.rows[1] == rows[1]


@pytest.mark.long
def test_ten_thousand_rows_are_what_single_runs_give_in_flat_memory(tmp_path: Path) -> None:
    """500 rows of them, drawn evenly, and the hash of each column.

    What workers hold after 1,000 runs is enough for 10,000.
    """
    count, held = 10_000, {}
    axis = {TAU: {"from": 1e-3, "to": 0.05, "n": 2500}, GAIN: [100, 200, 300, 400]}
    chosen = study(CIRCLE, {**SHORT, "stop": 0.01, "axis": axis})

    def progress(done: int, errors: int) -> None:
        if done in (1000, count - 100):
            held[done] = max(resident(child) for child in children())

    conduct(chosen, tmp_path / "s", Ways(workers=2, progress=progress))
    assert held[count - 100] < 1.05 * held[1000]
    rows = table(tmp_path / "s")
    assert [row["run"] for row in rows] == list(range(count))
    scenario, alone = motionfmu.load(CIRCLE), []
    for run in range(7, count, 20):
        point = dict(zip(chosen.job.axes, chosen.points[run], strict=True))
        result = scenario.run(set=point, stop=0.01)
        values = [column.of(result) for column in chosen.columns]
        alone.append({"run": run, **point, **dict(zip(chosen.job.columns, values, strict=True))})
    sampled = rows[7::20]
    assert len(alone) == len(sampled) == 500 and {row["status"] for row in rows} == {"ok"}
    for name in alone[0]:
        one, whole = (np.array([row[name] for row in some]) for some in (alone, sampled))
        digests = {hashlib.sha256(values.tobytes()).hexdigest() for values in (one, whole)}
        assert one.dtype == whole.dtype and len(digests) == 1, name
    assert len({row[RESULTS[1]] for row in alone}) > 400, "equal rows show no mixing"


def children() -> list[int]:
    """Processes that this one has started and not ended."""
    tasks = Path(f"/proc/{os.getpid()}/task").iterdir()
    return [int(x) for task in tasks for x in (task / "children").read_text().split()]


def resident(process: int) -> int:
    """Memory of a process [kB]."""
    lines = Path(f"/proc/{process}/status").read_text().splitlines()
    return int(next(line.split()[1] for line in lines if line.startswith("VmRSS")))


# ---- resuming


def finished(folder: Path) -> list[int]:
    """Runs in the journal, every time they were written."""
    journal = folder / book.JOURNAL
    lines = journal.read_bytes().split(b"\n")[1:-1] if journal.exists() else []
    return [json.loads(line)["run"] for line in lines]


@pytest.mark.more
def test_a_kill_loses_and_repeats_nothing_that_was_done(whole: Outcome, tmp_path: Path) -> None:
    """SIGKILL while rows come; the workers end by themselves, the rest is done once."""
    out = tmp_path / "killed"
    text = ROOT / "scenarios/circle_theory/scenario.toml"
    line = [sys.executable, "-m", "motionfmu", "sweep", text, "--out", out, "--workers", "2"]
    line += ["--stop", "0.03", "--vary", f"{GAIN}=100:600:6", "--vary", "mcc.irq_latency=2e-4,3e-3"]
    for name in RESULTS:
        line += ["--result", name]
    kept: list[int] = []
    for least in (1, 5):
        env = os.environ | {"TMPDIR": str(tmp_path)}
        process = subprocess.Popen(list(map(str, line)), stdout=subprocess.DEVNULL, env=env)
        while process.poll() is None and len(finished(out)) < least:
            time.sleep(0.002)
        os.kill(process.pid, signal.SIGKILL)
        process.wait()
        folded = [r["run"] for r in table(out)] if (out / book.TABLE).exists() else []
        assert set(kept) <= set(folded) | set(finished(out))
        kept = folded + finished(out)
        assert len(kept) == len(set(kept)), "a run was done twice"
    with (out / book.JOURNAL).open("ab") as journal:
        journal.write(b'{"run": 11, "status": "o')  # a line that the kill cut off
    seen: list[int] = []
    outcome = conduct(small(), out, Ways(workers=2, progress=lambda done, _: seen.append(done)))
    assert outcome.resumed == len(kept) >= 5
    assert seen == list(range(len(kept), 13))
    assert table(out) == table(whole.folder)
    assert not (out / book.JOURNAL).exists()


def test_an_interrupt_says_how_to_go_on(
    whole: Outcome, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys
) -> None:
    from motionfmu import cli

    def interrupted(*_: object) -> Iterator[worker.Row]:
        yield from whole.rows[:3]
        raise KeyboardInterrupt

    monkeypatch.setattr(processes, "rows", interrupted)
    line = ["motionfmu", "sweep", str(CIRCLE), "--out", str(tmp_path / "o"), "--stop", "0.03"]
    line += ["--vary", f"{GAIN}=100:600:6", "--result", RESULTS[0], "--result", RESULTS[1]]
    monkeypatch.setattr(sys, "argv", line)
    with pytest.raises(SystemExit) as end:
        cli.main()
    assert end.value.code == 130 and len(finished(tmp_path / "o")) == 3
    assert "3 of 6 runs are done; the same command goes on" in capsys.readouterr().err


def test_a_study_that_is_done_runs_nothing(whole: Outcome, monkeypatch) -> None:
    monkeypatch.setattr("motionfmu.study.processes.rows", None)
    before = table(whole.folder)
    assert conduct(small(), whole.folder).resumed == 12
    assert table(whole.folder) == before


def test_another_study_does_not_mix_with_it(whole: Outcome, tmp_path: Path, here: None) -> None:
    with pytest.raises(motionfmu.InputError, match=r"sweep.parquet holds another study.*--new"):
        conduct(small(seed=0, stop=0.02), whole.folder)
    with book.Book(tmp_path / "s", small()) as held:
        held.add(whole.rows[0])
        with pytest.raises(motionfmu.InputError, match="another sweep is running here"):
            book.Book(tmp_path / "s", small())
    other = small(4)
    outcome = conduct(other, tmp_path / "s", Ways(workers=1, fresh=True))
    assert outcome.resumed == 0 and len(outcome.rows) == 8
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine/letter.txt").write_text("dear")
    with pytest.raises(motionfmu.InputError, match="holds no earlier study"):
        conduct(other, tmp_path / "mine")


def test_a_study_knows_its_fmus(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Rows of other FMUs are not gone on with: those of the scenario, and what records."""
    used = {*motionfmu.load(CIRCLE).document.body.component.values(), "scope"}
    for name in (*used, "stimulus"):
        shutil.copy(fmus.fmu_path(name), tmp_path)
    monkeypatch.setenv("MOTIONFMU_FMUS", str(tmp_path))
    axis = {"mcc.p_gain": [100, 200]}
    found = {study(CIRCLE, {**SHORT, "axis": axis}).digest for _ in range(2)}
    assert len(found) == 1 and len(used) > 3
    for name in sorted(used):
        with zipfile.ZipFile(tmp_path / f"{name}.fmi3.fmu", "a") as archive:
            archive.comment = b"built anew"
        found.add(study(CIRCLE, {**SHORT, "axis": axis}).digest)
    assert len(found) == 1 + len(used)
    (tmp_path / "stimulus.fmi3.fmu").unlink()  # which no component is
    assert study(CIRCLE, {**SHORT, "axis": axis}).digest in found


def test_a_study_knows_the_files_its_values_name(tmp_path: Path) -> None:
    shutil.copytree(CIRCLE, tmp_path / "c")
    (tmp_path / "c/other.ngc").write_text((CIRCLE / "circle.ngc").read_text())

    def now() -> str:
        axis = {"mcc.program": ["circle.ngc", "other.ngc"]}
        return study(tmp_path / "c", {**SHORT, "axis": axis}).digest

    first = now()
    assert now() == first
    for name in ("circle.ngc", "other.ngc", "scenario.toml"):
        before = now()
        with (tmp_path / "c" / name).open("a") as file:
            file.write("\n")
        assert now() != before, name


def test_a_start_that_fails_leaves_nothing(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr("motionfmu.study.cluster.TIMEOUT", 0.5)
    with pytest.raises(motionfmu.InputError, match=r"--scheduler tcp://127\.0\.0\.1:1"):
        conduct(small(), tmp_path / "a/b", Ways(scheduler="tcp://127.0.0.1:1"))
    chosen = small()
    stale = replace(chosen, job=replace(chosen.job, digest="0"))
    with pytest.raises(motionfmu.InputError, match="other files or FMUs than the study"):
        conduct(stale, tmp_path / "a/b", Ways(workers=2))
    assert list(tmp_path.iterdir()) == []
