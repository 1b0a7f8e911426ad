"""The page says what was computed: its curves hold the very numbers, peaks included."""

import base64
import gzip
import math
import re
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import matplotlib.image
import numpy as np
import pytest
from conftest import ROOT
from hypothesis import given
from hypothesis import strategies as st
from page_curves import curve, page_data, unpacked, unwoven

import motionfmu
from motionfmu.analysis.contour import analyse
from motionfmu.analysis.contour.scaled_values import places
from motionfmu.analysis.explain.theory import CornerRow
from motionfmu.compare import comparison_page as compared
from motionfmu.compare.differences import Checked
from motionfmu.report import plotly_script, write_report
from motionfmu.report.cause_pages.explain_page import _corners
from motionfmu.report.diagram import SamplesMark, Scale, one
from motionfmu.report.error_path import draw
from motionfmu.report.error_scale import magnification, scale_end, within
from motionfmu.report.html_page import LARGEST, Page, PageFrame
from motionfmu.report.html_tables import check_table, judged
from motionfmu.report.numbers import MINUS, figure, length
from motionfmu.report.path_chart import outlier_words, path_chart
from motionfmu.report.samples import COARSE, Samples, bits
from motionfmu.report.typed_arrays import packed
from motionfmu.run.checks import Verdict
from motionfmu.run.decimate import keep_peaks

FLOAT32 = 1e-6


@pytest.fixture(scope="module")
def reported(tmp_path_factory: pytest.TempPathFactory):
    folder = tmp_path_factory.mktemp("report")
    result = motionfmu.load(ROOT / "scenarios/circle").run()
    page = write_report(result, result.contour(), folder, pictures=True)
    return result, folder, page.read_text(), page_data(page)


def traces(data, name: str) -> list[dict]:
    return next(f for f in data["figures"] if f["id"] == name)["data"]


@given(
    st.lists(st.floats(-1e6, 1e6), min_size=1, max_size=400), st.integers(1, 40), st.integers(1, 3)
)
def test_no_peak_is_lost(values: list[float], buckets: int, columns: int) -> None:
    data = np.array(values)[: len(values) // columns * columns].reshape(-1, columns)
    if not len(data):
        return
    kept = keep_peaks(data, buckets)
    assert np.array_equal(kept, np.unique(kept)) and kept[0] == 0 and kept[-1] == len(data) - 1
    assert len(kept) <= 2 * buckets * columns + 2
    for column in data.T:
        assert column[kept].max() == column.max() and column[kept].min() == column.min()


@given(st.lists(st.floats(-1e3, 1e3, width=32), max_size=30))
def test_packed_numbers_come_back(values: list[float]) -> None:
    assert np.array_equal(unpacked(packed(np.array(values))), np.array(values, np.float32))


@given(
    st.one_of(
        st.lists(st.integers(-(2**31), 2**31 - 1), max_size=40).map(lambda v: np.array(v, "i4")),
        st.lists(st.floats(-1e6, 1e6), max_size=40).map(np.array),
        st.lists(st.floats(-1.0, 1.0), max_size=40).map(lambda v: 1e7 + np.array(v)),
        st.lists(st.sampled_from([0.5, np.nan, -3.0]), max_size=9).map(np.array),
        st.lists(st.booleans(), max_size=9).map(lambda v: np.array(v, dtype=bool)),
    )
)
def test_samples_come_back(values: np.ndarray) -> None:
    back = unwoven(bits(values))
    assert len(back) == len(values)
    if values.dtype.kind in "bi":
        assert np.array_equal(back, values)
    elif len(values):
        known = values[np.isfinite(values)]
        height = np.ptp(known) if len(known) else 0.0
        assert np.array_equal(np.isnan(back), np.isnan(values))
        assert np.nanmax(np.abs(back - values), initial=0.0) <= COARSE * height


def test_the_error_curve_has_the_largest_error(reported) -> None:
    result, _, _, data = reported
    error = result.contour().error
    whole, peak = traces(data, "error")
    time, values = curve(data, whole)
    shown = np.abs(values)
    assert np.nanmax(shown) == pytest.approx(1e3 * error.max, rel=FLOAT32)
    at = time[np.nanargmax(shown)]
    assert at == pytest.approx(error.time, abs=1e-4)
    assert unpacked(peak["x"])[0] == error.time and length(error.max) in peak["text"][0]


def test_the_path_is_drawn_with_the_true_error(reported) -> None:
    result, _, _, data = reported
    gap = np.hypot(*(unpacked(c) for c in data["path"]["gap"]))
    assert np.nanmax(gap) == pytest.approx(result.contour().error.max, rel=1e-5)
    foot = np.hypot(*(unpacked(c) for c in data["path"]["foot"]))
    assert np.allclose(foot, 50.0, atol=1e-4)  # the nearest point is on the commanded circle


def test_the_fifo_curve_is_the_least_stock(reported) -> None:
    result, _, _, data = reported
    time, stock = curve(data, traces(data, "fifo")[0])
    assert np.allclose(time, result.time, rtol=0, atol=1e-12)
    assert np.array_equal(stock, result["card.stock"][:, :2].min(axis=1))


def test_the_polar_plot_shows_both_ways(reported) -> None:
    result, _, page, data = reported
    names = {str(t.get("name", "")).lower() for t in traces(data, "circle0")}
    assert any("counter" in n for n in names) and any(re.match("clockwise", n) for n in names)
    assert "ISO 230-4" in page and figure(1e3 * result.contour().circles[0].both.g) in page


def test_the_pictures_are_pictures(reported) -> None:
    _, folder, _, _ = reported
    picture = matplotlib.image.imread(folder / "path.png")
    assert min(picture.shape[:2]) > 500 and len(np.unique(picture.reshape(-1, 4), axis=0)) > 50
    assert (folder / "path.svg").read_text().lstrip().startswith("<?xml")


@pytest.mark.parametrize(
    ("value", "bounds", "unit", "shown"),
    [
        (0.0419, "in 0.0414 .. 0.0424", "mm", ("41.9 µm", "in 41.4 .. 42.4 µm")),
        (0.15, "peak in 0.1 .. 0.2, at 0.5 s", "mm", ("150 µm", "peak in 100 .. 200 µm, at 0.5 s")),
        (0.1, "|.| <= 5, 0.5 to 0.6 s", "mm", ("0.1 mm", "|.| <= 5 mm, 0.5 to 0.6 s")),
        (-3e-6, ">= -1e-05", "mm", (f"{MINUS}0.003 µm", f">= {MINUS}0.01 µm")),
        (3.0, "changes = 3, in 2 windows", "mm", ("3", "changes = 3, in 2 windows")),
        (4.0, "rate over 0.002 s <= 5", "mm", ("4", "rate over 0.002 s <= 5")),
        (2.0, "order 1, 2", "", ("2", "order 1, 2")),
        (0.2, ">= 0.1, in 2 windows", "mm", ("200 µm", ">= 100 µm, in 2 windows")),
        (0.2, "min in 0.1 .. 3, in 2 windows", "m", ("0.2 m", "min in 0.1 .. 3 m, in 2 windows")),
    ],
)
def test_checks_are_told_in_the_unit_of_the_cards(
    value: float, bounds: str, unit: str, shown: tuple[str, str]
) -> None:
    assert judged(value, bounds, unit) == shown


def test_one_number_between_two_bounds_is_one_row() -> None:
    def shown(*checks: Verdict) -> list[str]:
        rows = check_table(checks, lambda _: ("", "mm")).split("<tr>")[2:]
        return [re.sub("<[^>]+>", " ", row).split("pass")[-1].strip() for row in rows]

    low, high = Verdict("a.max", ">= 0.04", 0.045, True), Verdict("a.max", "<= 0.05", 0.045, True)
    (row,) = shown(low, high)
    assert "45 µm" in row and "&gt;= 40 µm and &lt;= 50 µm" in row
    other = Verdict("a.max", "<= 0.05", 0.046, True)  # of another sample: a row of its own
    assert len(shown(low, other)) == len(shown(low, Verdict("b", "<= 0.05", 0.045, True))) == 2
    failed = Verdict("a.max", "<= 0.04", 0.045, False)
    assert len(shown(low, failed)) == 2
    first, second = (
        [replace(v, bounds=f"{v.bounds}, at {t} s") for v in (low, high)] for t in (3, 7)
    )
    before, after = shown(*first, *second)  # the same value twice is not one number
    assert "&gt;= 40 µm and &lt;= 50 µm, at 3 s" in before and "µm, at 7 s" in after
    without = [Verdict("a.max", "<= 1", math.nan, False, why) for why in ("no path", "no run")]
    assert len(shown(*without)) == 2


def test_a_comparison_has_one_row_for_one_number_of_each_run() -> None:
    def rows(*bounds: tuple[str, bool, bool]) -> list[str]:
        checks = [
            Checked("contour.error.max", (b, b), (0.045, 0.021), (a_ok, b_ok), ("", ""))
            for b, a_ok, b_ok in bounds
        ]
        text = compared._checks(SimpleNamespace(checks=checks))  # type: ignore[arg-type]
        return [re.sub("<[^>]+>", "|", row) for row in text.split("<tr>")[2:]]

    (row,) = rows((">= 0.02", True, True), ("<= 0.05", True, True))
    assert "|&gt;= 20 µm and &lt;= 50 µm|" in row and row.count("45 µm") == 1
    worse, same = rows(("<= 0.05", True, True), (">= 0.044", True, False))
    assert "&gt;= 44 µm" in worse and "✗" in worse and "&lt;= 50 µm" in same


def test_failed_checks_stand_first() -> None:
    """In the order they were given, whatever their names and values are."""
    checks = [Verdict(n, "<= 1", v, v <= 1.0) for n, v in (("b", 0), ("c", 2), ("a", 3), ("d", 1))]
    rows = check_table(checks, lambda _: ("", "")).split("<tr>")[2:]
    marks = ["pass" if "✓ pass" in row else "fail" for row in rows]
    assert marks == ["fail", "fail", "pass", "pass"]
    names = [re.sub("<[^>]+>", " ", row).split()[2] for row in rows]
    assert names == ["c", "a", "b", "d"]


def test_a_page_of_many_corners_shows_the_worst_and_opens_the_others() -> None:
    def corners(count: int) -> str:
        rows = (CornerRow((k, k + 1), "sharp", 1.0, 9.0, 1e-3 * k, 0.0, 0.0) for k in range(count))
        return _corners(SimpleNamespace(corners=tuple(rows)))  # type: ignore[arg-type]

    whole = corners(670)
    seen, _, hidden = whole.partition("<details>")
    assert re.findall(r">(\d+) to", seen) == [str(k) for k in range(669, 659, -1)]
    assert re.findall(r">(\d+) to", hidden) == [str(k) for k in range(659, -1, -1)]
    assert "660 more" in hidden and "<details>" not in corners(10)


def test_the_page_tells_a_failed_check(tmp_path: Path) -> None:
    limit = {"contour.error.max": {"max": 0.1}}
    result = motionfmu.load(ROOT / "scenarios/mismatch_line").changed(check=limit).run()
    page = write_report(result, result.contour(), tmp_path).read_text()
    assert re.search(r"✗ 1 of \d+ checks FAILED", page)


@pytest.mark.parametrize(
    ("errors", "size", "reach"), [((0.01, 0.04), 100.0, 100.0), ((1e-4, 1e-3), 20.0, 1.0)]
)
def test_the_magnification_keeps_details_apart(errors, size: float, reach: float) -> None:
    factor = magnification(errors, size, reach)
    assert factor >= 1.0 and factor * scale_end(errors) <= 0.5 * reach + 1e-12
    assert magnification((0.0, 0.0), size, reach) == 1.0


def test_one_plunge_leaves_the_colours_to_the_rest(reported) -> None:
    """A plunge of 2 mm for 20 samples of 80,000: scale and magnification stay, it is marked."""
    result, _, page, _ = reported
    contour = result.contour()
    plain = draw(contour)
    assert len(plain.outliers) == 0 and "Colours end" not in page
    plunged = np.zeros((len(result.time), 6))
    plunged[:, :3] = places(contour.run.actual, np.arange(len(result.time)))
    cut = np.flatnonzero(contour.cutting)
    own = cut[len(cut) // 3 :][:20]
    foot = contour.track.feet(own)
    plunged[own, :3] = foot + 2.0 * (foot / np.linalg.norm(foot, axis=1, keepdims=True))
    other = analyse(replace(contour.run, actual=plunged))
    assert other.error.max == pytest.approx(2.0, rel=1e-3)
    drawn = draw(other)
    assert drawn.magnify == plain.magnify and drawn.end == 1.5 * other.error.p95
    (marked,) = drawn.outliers
    assert abs(drawn.error[marked]) == other.error.max
    assert np.nanmax(np.linalg.norm(drawn.shown, axis=1)) == pytest.approx(drawn.end)
    near = np.abs(drawn.error) < drawn.end
    assert np.array_equal(drawn.shown[near], drawn.gap[near], equal_nan=True)
    chart = path_chart(drawn)
    error, outlier = chart.marks[3:]
    assert error.heat.ends == (0.0, 1e3 * drawn.end)
    assert outlier.name == f"beyond {length(drawn.end)}" and len(outlier.x) == 1
    line = drawn.line[marked]
    assert f"no longer than that: 2.00 mm in line {line}." in outlier_words(drawn)


def test_outliers_are_drawn_no_longer_than_the_colours_reach() -> None:
    gap = np.array([[3.0, 4.0], [0.3, 0.4], [0.0, 0.0], [np.nan, np.nan]])
    shown = within(gap, 1.0)
    assert np.allclose(shown[0], [0.6, 0.8]) and np.array_equal(shown[1:], gap[1:], equal_nan=True)
    assert scale_end((0.02, 2.0)) == 0.03 and scale_end((0.02, 0.039)) == 0.039
    assert scale_end((0.0, 2.0)) == 2.0  # of a path with fewer errors than 5 %


def test_a_page_of_long_noise_has_its_peaks_in_2_mb() -> None:
    rng = np.random.default_rng(3)
    time = np.arange(120_000) * 1e-3
    page = Page()
    for k in range(20):
        curve = SamplesMark(Samples(time, rng.normal(size=len(time))), "noise")
        page.place(f"plot{k}", one(Scale("Time", "s"), Scale("Noise"), [curve], 100.0), True)
    text = page.text(PageFrame("noise", "", "report", (), ""))
    assert 1_000_000 < len(text.encode()) <= LARGEST
    for k, drawn in enumerate(page_data(text)["figures"]):
        whole = page.plots[k]["data"][0]["samples"].values
        (trace,) = drawn["data"]
        values = unwoven(trace["samples"]["values"])
        assert not trace["samples"]["all"]
        assert values.max() == pytest.approx(whole.max(), rel=1e-5)
        assert values.min() == pytest.approx(whole.min(), rel=1e-5)


def test_the_script_is_cut_to_the_curves_of_pages() -> None:
    """The installed plotly is bundled as the cut expects, and less is left than half."""
    whole = plotly_script._file().read_text("utf-8")
    cut = plotly_script.cut(whole, plotly_script.PLANE)
    assert len(cut) < 0.5 * len(whole)
    assert plotly_script.cut("a=1", plotly_script.PLANE) == "a=1"  # bundled otherwise: whole
    back = gzip.decompress(base64.b64decode(plotly_script.packed_script(False)))
    assert back.decode() == cut
