"""Curves too long for a page: its size is bounded, and a zoom shows the samples beside it."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from browser import tab
from few_cases import few

from motionfmu.report.diagram import Diagram, SamplesMark, Scale, Subplot, ends_of
from motionfmu.report.html_page import LARGEST, Page, PageFrame
from motionfmu.report.sample_files import FOLDER, PIECE, SampleFiles
from motionfmu.report.samples import COARSE, Samples
from motionfmu.run.decimate import reader

STEP = 1e-4  # [s]
COUNT = 5 * PIECE + 1234
DESK = {"width": 1400, "height": 900}
# What a plot shows between two times, once the samples of the view are there.
ZOOMED = """async ([k, from, to]) => {
  await opened;
  const { place, traces } = plots[k];
  await Plotly.relayout(place, { "xaxis.range": [from, to] });
  await plots[k].refined;
  const { x, y, customdata } = place.data[traces[0].k];
  const inside = Array.from(x, (_, i) => i).filter((i) => x[i] >= from && x[i] <= to);
  const { least, largest } = between(traces[0].curve, from, to);
  return { x: inside.map((i) => x[i]), y: inside.map((i) => y[i]), least, largest,
    lines: customdata && inside.map((i) => customdata[i]), value: valueAt(traces[0].curve, from) };
}"""


def noise(seed: int) -> np.ndarray:
    """A slow wave with noise and single peaks."""
    random = np.random.default_rng(seed)
    found = 50.0 * np.sin(np.arange(COUNT) * 3e-6 * (seed + 1)) + random.normal(size=COUNT)
    found[random.integers(0, COUNT, 9)] += 40.0
    return found


def uneven() -> np.ndarray:
    """Times that are not even [s]."""
    return np.cumsum(STEP * (0.5 + np.random.default_rng(9).random(COUNT)))


CURVES = {
    "even": (STEP * np.arange(COUNT), noise(0)),
    "uneven": (uneven(), noise(1)),
    "gaps": (STEP * np.arange(COUNT), np.where(np.arange(COUNT) % 997 < 50, np.nan, noise(2))),
}
LINES = np.arange(COUNT) // 100


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A page with curves of 300,000 samples, and their files."""
    place: Path = tmp_path_factory.mktemp("long")
    page = Page(SampleFiles(place))
    for name, (time, values) in CURVES.items():
        samples = Samples.made(time, reader(values), lines=reader(LINES))
        assert not samples.all
        span = Scale("Time", "s", (float(time[0]), float(time[-1])))
        mark = SamplesMark(samples, name, "#0b5cad")
        rows = [Subplot(Scale(name, "mm", ends_of([samples.values])), [mark], 188)]
        page.section(name, "", page.place(name, Diagram((span,), rows)))
    text = page.text(PageFrame("long", "", "report", (), ""))
    (place / "report.html").write_text(text, encoding="utf-8")
    return place


@pytest.mark.parametrize("k", few(range(len(CURVES)), 1))
def test_zoomed_stretch_shows_the_samples(browser: Any, folder: Path, k: int) -> None:
    """Peaks, single values and what cursors read are those of brute force, at any place."""
    time, values = list(CURVES.values())[k]
    peak = int(np.nanargmax(values))
    random = np.random.default_rng(5)
    places = [0, COUNT - 901, PIECE - 450, peak - 300, *random.integers(0, COUNT - 901, 2).tolist()]
    with tab(browser, (folder / "report.html").as_uri(), DESK) as page:
        for first in places:
            ends = [float(time[first]), float(time[first + 900])]
            got = page.evaluate(ZOOMED, [k, *ends])
            own = (time >= ends[0]) & (time <= ends[1])
            off = 2.0 * COARSE * float(np.nanmax(values) - np.nanmin(values))
            assert got["least"] == pytest.approx(np.nanmin(values[own]), abs=off)
            assert got["largest"] == pytest.approx(np.nanmax(values[own]), abs=off)
            if not np.isnan(values[first]):
                assert got["value"] == pytest.approx(values[first], abs=off)
        shown = page.evaluate(ZOOMED, [k, float(time[peak - 60]), float(time[peak + 60])])
    few = slice(peak - 60, peak + 61)
    assert shown["x"] == pytest.approx(time[few], abs=1e-9)  # each sample
    drawn = np.array(shown["y"], dtype=float)
    assert drawn == pytest.approx(values[few], abs=off, nan_ok=True)
    assert shown["lines"] == LINES[few].tolist()


@pytest.mark.more
def test_views_of_any_width_have_the_extremes(browser: Any, folder: Path) -> None:
    """The least and the largest sample are drawn of the whole and of each part."""
    time, values = CURVES["even"]
    with tab(browser, (folder / "report.html").as_uri(), DESK) as page:
        for share in (1.0, 0.3, 0.1, 0.02):
            ends = [float(time[0]), float(time[int(share * (COUNT - 1))])]
            got = page.evaluate(ZOOMED, [0, *ends])
            own = values[(time >= ends[0]) & (time <= ends[1])]
            off = 2.0 * COARSE * float(np.ptp(values))
            assert got["least"] == pytest.approx(own.min(), abs=off)
            assert got["largest"] == pytest.approx(own.max(), abs=off)


def test_page_sent_alone_has_the_peaks(browser: Any, folder: Path, tmp_path: Path) -> None:
    """Without its files a page shows what it has, and asks for them no more."""
    alone = tmp_path / "report.html"
    alone.write_text((folder / "report.html").read_text("utf-8"), encoding="utf-8")
    time, values = CURVES["even"]
    peak = int(np.argmax(values))
    context = browser.new_context(viewport=DESK)
    page = context.new_page()
    wrong: list[str] = []
    page.on("pageerror", lambda error: wrong.append(str(error)))
    page.goto(alone.as_uri())
    got = page.evaluate(ZOOMED, [0, float(time[peak - 400]), float(time[peak + 400])])
    more = page.evaluate("plots[0].traces[0].curve.more")
    context.close()
    assert wrong == [] and more is None
    assert got["largest"] == pytest.approx(values[peak], rel=1e-5)
    assert 4 < len(got["x"]) < 700


def test_files_hold_every_sample_once_and_the_page_is_bounded(folder: Path) -> None:
    """A page of 2 MB at most whatever the number of samples, and files of one piece each."""
    assert (folder / "report.html").stat().st_size <= LARGEST
    files = {f.name for f in (folder / FOLDER).iterdir()}
    assert files == {f"{curve}.{piece}.js" for curve in range(3) for piece in range(6)}
    for name in files:
        text = (folder / FOLDER / name).read_text("utf-8")
        head, _, rest = text.partition(",")
        assert head == f'piece("{name.removesuffix(".js")}"'
        found = json.loads(rest.rstrip().removesuffix(");"))
        assert found["values"]["count"] == (PIECE if ".5." not in name else 1234)
    assert max((folder / FOLDER / n).stat().st_size for n in files) < 1_000_000


def test_short_curves_have_no_files(tmp_path: Path) -> None:
    """A page that has all samples stands alone."""
    page = Page(SampleFiles(tmp_path))
    time = STEP * np.arange(1000)
    mark = SamplesMark(Samples.made(time, reader(np.sin(time))), "v", "#0b5cad")
    span = Scale("Time", "s", (0.0, float(time[-1])))
    rows = [Subplot(Scale("v", "mm", (-1.0, 1.0)), [mark], 188)]
    page.section("v", "", page.place("v", Diagram((span,), rows)))
    page.text(PageFrame("short", "", "report", (), ""))
    assert list(tmp_path.iterdir()) == []
