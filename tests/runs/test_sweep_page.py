"""The page and the picture of a study."""

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from few_cases import few
from page_curves import page_data, unpacked
from test_sweep import CIRCLE, GAIN, SHORT

from motionfmu.study import worker
from motionfmu.sweep import Outcome, study


def synthetic(names: list[str], sampling: str, runs: int, folder: Path) -> Outcome:
    """A study of the real scenario whose rows hold a bowl with its bottom at one point."""
    span = {"from": 1, "to": 1000, "log": True} | ({"n": runs} if sampling == "grid" else {})
    given = {**SHORT, "sampling": sampling, "axis": dict.fromkeys(names, span)}
    if sampling != "grid":
        given["runs"] = runs
    chosen = study(CIRCLE, given)
    cost = [sum((math.log10(x) - 1.5) ** 2 for x in point) for point in chosen.points]
    rows = [worker.Row(i, "ok", "", True, (c, 0.0, 0.0)) for i, c in enumerate(cost)]
    rows[0] = worker.Row(0, "error", "broken", None, (None,) * 3)
    return Outcome(chosen, rows, folder, 0)


@pytest.mark.parametrize(
    ("count", "sampling", "runs", "way"),
    few(
        [
            (1, "grid", 9, "curve"),
            (2, "grid", 7, "field"),
            (2, "latin", 150, "field"),
            (3, "random", 40, "matrix"),
        ],
        2,
    ),
)
def test_the_page_shows_the_cost_over_what_was_varied(
    count: int, sampling: str, runs: int, way: str, tmp_path: Path
) -> None:
    from PIL import Image

    from motionfmu.report.studies import cost_field, sweep_page

    names = [f"{GAIN}[{i + 1}]" for i in range(count)]
    outcome = synthetic(names, sampling, runs, tmp_path)
    assert cost_field.kind(outcome) == way
    outcome.study.tuned.update(dict.fromkeys(names, 30))
    text = sweep_page.write_sweep(outcome, tmp_path).read_text()
    data = page_data(text)
    (drawn,) = data["figures"]
    marked = {t.get("name") for t in drawn["data"]}
    assert f"best: run {outcome.best}" in marked
    assert "tuned" in marked or "shapes" in drawn["layout"]
    assert Image.open(tmp_path / "sweep.png").width > 600
    if way == "field":
        found = cost_field.field(outcome)
        x, y = np.log10(np.meshgrid(found.x, found.y))
        bowl = (x - 1.5) ** 2 + (y - 1.5) ** 2
        known = np.isfinite(found.z)
        assert known.mean() > 0.6
        error = np.abs(found.z - bowl)[known]
        assert error.max() < 1e-12 if sampling == "grid" else np.quantile(error, 0.9) < 0.1


@pytest.mark.parametrize("count", few([1, 2, 3], [1]))
@pytest.mark.parametrize("cost", [0.0, 3.0, None])
def test_a_page_of_equal_costs_or_of_none_is_written(
    cost: float | None, count: int, tmp_path: Path
) -> None:
    from motionfmu.report.studies import sweep_page

    names = [f"{GAIN}[{i + 1}]" for i in range(count)]
    outcome = synthetic(names, "grid", 3, tmp_path)
    outcome.rows[:] = [replace(r, values=(cost, 0.0, 0.0)) for r in outcome.rows]
    assert "sweep.parquet" in sweep_page.write_sweep(outcome, tmp_path).read_text()
    assert (tmp_path / "sweep.png").exists() == (cost is not None)


@pytest.mark.parametrize(
    "cost", [[0.0, 1.0], [3.0, 3.0], [-4e-7, 9e-7], [1e-3, 40.0], [2.0, 2.5], [0.0, 0.0]]
)
def test_levels_are_round_and_span_the_cost(cost: list[float]) -> None:
    from motionfmu.report.studies.cost_field import levels

    found = levels(np.array([*cost, math.nan]))
    assert found[0] <= min(cost) and found[-1] >= max(cost)
    assert 2 <= len(found) <= 20 and (np.diff(found) > 0).all()
    assert all(float(f"{v:.3g}") == pytest.approx(v, rel=1e-9, abs=1e-12) for v in found)


@pytest.mark.parametrize(
    "cost, wanted",
    [([1.0, 31.0], False), ([1.0, 32.0], True), ([1e-9, 0.9e-9, 1e-7], True), ([0.0, 1e9], False)],
)
def test_a_cost_is_drawn_by_its_logarithm_from_a_decade_and_a_half_on(
    cost: list[float], wanted: bool
) -> None:
    from motionfmu.report.studies.cost_field import logarithmic

    assert logarithmic(np.array([*cost, math.nan])) is wanted
    assert not logarithmic(np.array([math.nan]))


def test_nothing_is_drawn_below_zero_of_a_cost_that_is_not_negative(tmp_path: Path) -> None:
    from motionfmu.report.studies import sweep_page

    for count in (1, 2, 3):
        names = [f"{GAIN}[{i + 1}]" for i in range(count)]
        outcome = synthetic(names, "grid", 5, tmp_path)
        outcome.rows[1:] = [replace(r, values=(r.run % 25, 0.0, 0.0)) for r in outcome.rows[1:]]
        text = sweep_page.page_text(outcome)
        (drawn,) = page_data(text)["figures"]
        if count == 2:
            even = drawn["data"][0]["contours"]
            assert even["start"] - even["size"] == pytest.approx(0.0, abs=1e-12)
            dots = next(t for t in drawn["data"] if t.get("name") == "runs")
            assert len(unpacked(dots["x"])) == len(outcome.rows) - 1  # one has no cost: a cross
        else:
            axis = drawn["layout"]["yaxis" if count == 1 else "yaxis3"]
            assert axis["rangemode"] == "nonnegative"


def test_units_stand_beside_every_number_of_a_page(tmp_path: Path) -> None:
    from motionfmu.report.studies import sweep_page

    results = ["contour.error.max", "contour.circles.0.ccw.radius_change", "contour.lag"]
    given = {"axis": {"mcc.irq_latency": [2e-4, 3e-3]}, "results": results, "stop": 0.03}
    chosen = study(CIRCLE, given)
    assert [c.unit for c in chosen.columns] == ["mm", "mm", "s"]
    rows = [worker.Row(i, "ok", "", True, (0.0625 * (i + 1), -0.04, 0.02)) for i in range(2)]
    outcome = Outcome(chosen, rows, tmp_path, 0)
    page = sweep_page.page_text(outcome)
    assert "contour.error.max [µm]" in page and "mcc.irq_latency [s]" in page
    assert "mcc.irq_latency = 0.0002 s" in page and ">62.5<" in page
    for word in ("radius_change [mm]", "contour.lag [s]"):
        assert word in page


def test_the_cost_stands_first_in_the_table_of_best_runs(tmp_path: Path) -> None:
    from motionfmu.report.studies import sweep_page

    results = ["contour.lag", "contour.error.rms", "contour.error.max"]
    given = {"axis": {"mcc.irq_latency": [2e-4, 3e-3]}, "results": results, "stop": 0.03}
    chosen = study(CIRCLE, given | {"cost": "contour.error.max"})
    rows = [worker.Row(i, "ok", "", True, (0.02, 0.03, 0.05 - 0.01 * i)) for i in range(2)]
    page = sweep_page.page_text(Outcome(chosen, rows, tmp_path, 0))
    table = page[page.index("<h2>Best runs") :]
    heads = re.findall(r"<th[^>]*>([^<]*)</th>", table)[:6]
    assert [h.partition(" ")[0] for h in heads[3:]] == [results[2], *results[:2]]
    cells = re.findall(r"<td[^>]*>([^<]*)</td>", table)[:12]
    assert cells[3:6] == ["0.04", "0.02", "0.03"] and cells[9:] == ["0.05", "0.02", "0.03"]


def test_a_best_run_at_the_edge_of_the_study_is_said(tmp_path: Path) -> None:
    from motionfmu.report.studies import sweep_page

    names = [f"{GAIN}[1]", f"{GAIN}[2]"]
    outcome = synthetic(names, "grid", 7, tmp_path)
    assert outcome.at_the_edge == []
    assert "edge of the study" not in sweep_page.page_text(outcome)
    first, *rest = outcome.rows
    last = [replace(r, values=(float(-r.run), 0.0, 0.0)) for r in rest]
    outcome = replace(outcome, rows=[first, *last])
    assert outcome.best == 48
    assert outcome.at_the_edge == [f"{n} = 1000, the largest of the study" for n in names]
    assert "The best run is at the edge of the study" in sweep_page.page_text(outcome)
    assert outcome.summary[-1] == f"at the edge of the study: {'; '.join(outcome.at_the_edge)}"
    # A cost that does not depend on an axis has no edge there.
    level = [replace(r, values=(float(-(r.run // 7)), 0.0, 0.0)) for r in last]
    outcome = replace(outcome, rows=[first, *level])
    assert outcome.at_the_edge == [f"{names[0]} = 1000, the largest of the study"]
    drawn = synthetic(names, "latin", 60, tmp_path)
    first, *rest = drawn.rows
    slope = [replace(r, values=(drawn.study.points[r.run][0], 0.0, 0.0)) for r in rest]
    drawn = replace(drawn, rows=[first, *slope])
    assert [t.partition(" = ")[0] for t in drawn.at_the_edge] == names[:1]


def test_without_a_cost_no_run_is_the_best(tmp_path: Path) -> None:
    from motionfmu.report.studies import sweep_page

    given = {"axis": {GAIN: [100, 200]}, "results": ["card.err_count.absmax"], "stop": 0.03}
    chosen = study(CIRCLE, given)
    assert chosen.cost == "" and chosen.shown == "card.err_count.absmax"
    rows = [worker.Row(i, "ok", "", True, (float(i),)) for i in range(2)]
    outcome = Outcome(chosen, rows, tmp_path, 0)
    page = sweep_page.write_sweep(outcome, tmp_path).read_text()
    assert outcome.best is None and outcome.at_the_edge == []
    assert "Best runs" not in page and "best: run" not in page and "Smallest" not in page
    assert "No cost was named" in page and (tmp_path / "sweep.png").exists()
