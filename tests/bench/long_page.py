"""A page of a long recording in a browser: `make bench BENCH=--long`.

A curve of 10 million samples, its page and the files beside it. In Chromium: from the address to
the picture, and from a zoom to all samples of a stretch. Asked is processor time of the page's
process, medians of `ROUNDS`. Those of the clock stand beside it; other work makes them longer.
"""

import shutil
import statistics
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from figures import Figure

from motionfmu.report.diagram import Diagram, SamplesMark, Scale, Subplot, ends_of
from motionfmu.report.html_page import Page, PageFrame
from motionfmu.report.sample_files import SampleFiles
from motionfmu.report.samples import Samples
from motionfmu.run.decimate import reader

ROOT = Path(__file__).resolve().parents[2]
COUNT, STEP, ROUNDS = 10_000_000, 1e-4, 5
STRETCH = 900  # samples of a zoom
OPENED = """async () => {
  await opened;
  await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
  return performance.now();
}"""
ZOOMED = """async ([from, to]) => {
  const begin = performance.now(), [plot] = plots;
  await Plotly.relayout(plot.place, { "xaxis.range": [from, to] });
  await plot.refined;
  return performance.now() - begin;
}"""


def _made(folder: Path) -> tuple[float, float]:
    """Processor time of the page and its files [s], and its size [MB]."""
    random = np.random.default_rng(1)
    values = 50.0 * np.sin(np.arange(COUNT) * 3e-6) + random.normal(size=COUNT)
    times = STEP * np.arange(COUNT)
    begin, page = time.process_time(), Page(SampleFiles(folder))
    samples = Samples.made(times, reader(values))
    span = Scale("Time", "s", (0.0, float(times[-1])))
    mark = SamplesMark(samples, "noise", "#0b5cad")
    rows = [Subplot(Scale("Noise", "mm", ends_of([samples.values])), [mark], 188)]
    page.section("Noise", "", page.place("noise", Diagram((span,), rows)))
    text = page.text(PageFrame("long", "", "report", (), ""))
    (folder / "report.html").write_text(text, encoding="utf-8")
    return time.process_time() - begin, len(text) / 1e6


def _spent(session: Any) -> float:
    """Processor time of the page's process so far [s]."""
    found = session.send("Performance.getMetrics")["metrics"]
    return float(next(m["value"] for m in found if m["name"] == "ProcessTime"))


def figures_of_long_page() -> list[Figure]:
    """Make the page, open it, zoom into it."""
    from playwright.sync_api import sync_playwright

    found = next(filter(None, map(shutil.which, ("chromium", "chromium-browser"))), None)
    with tempfile.TemporaryDirectory(dir=ROOT / "build") as name, sync_playwright() as p:
        seconds, size = _made(Path(name))
        browser = p.chromium.launch(executable_path=found, args=["--no-sandbox"])
        first, zooms, clock = [], [], []
        for k in range(ROUNDS):
            page = browser.new_page(viewport={"width": 1400, "height": 900})
            session = page.context.new_cdp_session(page)
            session.send("Performance.enable")
            page.goto((Path(name) / "report.html").as_uri())
            opened = page.evaluate(OPENED) / 1e3
            first.append(_spent(session))
            at = STEP * COUNT * (k + 0.5) / ROUNDS
            clock.append((opened, page.evaluate(ZOOMED, [at, at + STRETCH * STEP]) / 1e3))
            zooms.append(_spent(session) - first[-1])
            page.close()
        browser.close()
    told = [f"{statistics.median(column):.2f} s" for column in zip(*clock, strict=True)]
    print(
        f"\na page of {COUNT:,} samples is made in {seconds:.1f} s of processor time; by the clock"
    )
    print(f"its picture is there after {told[0]}, that of a zoom after {told[1]}")
    return [
        Figure("page of 10,000,000 samples, MB", size, most=2.0),
        Figure("page of 10,000,000 samples, s to its picture", statistics.median(first), most=1.0),
        Figure("page of 10,000,000 samples, s of a zoom", statistics.median(zooms), most=0.1),
    ]
