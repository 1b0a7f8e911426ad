"""Every kind of page in a real browser: nothing overlaps or overflows, cursors read the run."""

from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from browser import PHONE, tab
from few_cases import few
from made import BARE, KINDS, made
from page_words import WORDS

import motionfmu
from motionfmu.report.html_page import LARGEST

# What they share is made once, by one worker.
pytestmark = pytest.mark.xdist_group("pages")

DESK = {"width": 1400, "height": 900}
# Sections on what limits a program, of the pages that have them.
TIME = ("Where the time goes", "Slowest lines")
LIMITED = {
    "contour": ("Axes and their limits", *TIME),
    "machine": ("Axes and their limits", *TIME),
    "gcode": (*TIME, "What if"),
}
FRAME = "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"
# What is wrong with how a page looks, in words.
LOOK = """async () => {
  await opened;
  const wrong = [], name = (e) => e.closest("section")?.querySelector("h2, h3")?.textContent;
  const box = (e) => e.getBoundingClientRect();
  const hit = (a, b) => a.width && b.width && a.left < b.right - 1 && b.left < a.right - 1
    && a.top < b.bottom - 1 && b.top < a.bottom - 1;
  const { scrollWidth: wide, clientWidth: room } = document.documentElement;
  if (wide > room) wrong.push(`${wide} pixels wide`);
  let bars = 0;
  for (const plot of document.querySelectorAll(".plot")) {
    const bar = plot.querySelector(".modebar");
    if (!bar || !box(bar).width) { wrong.push(`${name(plot)}: no tools`); continue; }
    bars++;
    const drawn = plot.querySelector(".js-plotly-plot")._fullLayout;
    if (drawn.yaxis?.scaleanchor && drawn.height > 200
      && drawn._size.h - drawn.yaxis._length > 12) wrong.push(`${name(plot)}: room left over`);
    if (box(bar).left < 0 || box(bar).right > room) wrong.push(`${name(plot)}: tools cut`);
    const around = plot.closest("section").querySelectorAll("h2, h3, .note, .measure, select");
    const own = plot.querySelectorAll(
      ".legend, .nsewdrag, .polarlayer .plotbg, .polarlayer text, .gl-container canvas, .colorbar");
    for (const e of [...own, ...around]) {
      if (hit(box(bar), box(e))) wrong.push(`${name(plot)}: tools over ${e.getAttribute("class")}`);
    }
  }
  if (!bars) wrong.push("no plot");
  for (const plot of document.querySelectorAll(".js-plotly-plot")) {
    const titles = [...plot.querySelectorAll("text[class$=title]")]
      .filter((e) => e.textContent);
    titles.forEach((a, k) => titles.slice(0, k).forEach((b) => {
      if (hit(box(a), box(b))) wrong.push(`titles: ${a.textContent} over ${b.textContent}`);
    }));
  }
  const words = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (words.nextNode()) {
    const { data, parentElement } = words.currentNode;
    if (!parentElement.closest("script, style, code") && /(?<![\\w.>\\/+\\]:-])-\\d/.test(data))
      wrong.push(`a hyphen for a minus: ${data}`);
  }
  for (const card of document.querySelectorAll(".card"))
    if (card.scrollWidth > card.clientWidth) wrong.push(`beyond its card: ${card.innerText}`);
  for (const part of room < 861 ? [] : document.querySelectorAll(".wide .scroll, .two .scroll"))
    if (!part.closest(".readout") && part.scrollWidth > part.clientWidth)
      wrong.push(`${name(part)}: a table cut`);
  const range = document.createRange();
  for (const cell of document.querySelectorAll("td, th, h1, h2, .what, .value")) {
    const walk = document.createTreeWalker(cell, NodeFilter.SHOW_TEXT);
    while (walk.nextNode()) {
      for (const word of walk.currentNode.data.matchAll(/[^\\s,/]+/g)) {
        range.setStart(walk.currentNode, word.index);
        range.setEnd(walk.currentNode, word.index + word[0].length);
        const rows = new Set([...range.getClientRects()].map((r) => Math.round(r.top)));
        if (rows.size > 1 && word[0].length < 24) wrong.push(`broken: ${word[0]}`);
      }
    }
  }
  return wrong;
}"""


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> tuple[dict[str, Path], motionfmu.Result]:
    return made(tmp_path_factory.getbasetemp() / "pages")


def band_holds_every_sample(page: Any, run: motionfmu.Result) -> None:
    stock = run["card.stock"][:, list(run.contour().run.axes)].min(axis=1)
    mean, band = page.evaluate(
        """() => { const { traces, data } = plots.find((p) => p.place.id === "fifo");
            const { k, band } = traces[0];
            return [data[k], data[band]].map((t) => [Array.from(t.x), Array.from(t.y)]); }"""
    )
    bins = len(band[0]) // 2
    assert 30 <= bins < len(run.time) / 50 and len(mean[0]) == bins
    high, low = np.array(band[1][:bins]), np.array(band[1][bins:][::-1])
    edges = np.floor(np.arange(bins + 1) / bins * len(stock) + 0.5).astype(int)
    for k, (a, b) in enumerate(pairwise(edges)):
        part = stock[a:b]
        assert (low[k], high[k]) == (part.min(), part.max())
        assert mean[1][k] == pytest.approx(part.mean(), rel=1e-6)


def step_has_cursors_of_its_own(page: Any, _: motionfmu.Result) -> None:
    page.locator(".plot:has(#loop0_step) .measure").tap()
    page.evaluate(FRAME)
    assert page.locator(".readout:visible").count() == 1
    told = page.locator(".readout:visible .number").inner_text()
    assert "ms" in told and "kHz" in told


def a_plot_is_saved(page: Any) -> None:
    for format, begin in (("png", b"\x89PNG"), ("svg", b"<svg")):
        with page.expect_download() as saved:
            page.locator(f"[data-save='path.{format}']").click()
        assert saved.value.suggested_filename == f"path.{format}"
        assert Path(saved.value.path()).read_bytes().startswith(begin)


ON_A_PHONE = {"contour": band_holds_every_sample, "margins": step_has_cursors_of_its_own}


@pytest.mark.parametrize("kind", few(KINDS, 2))
def test_nothing_overlaps_overflows_or_breaks(browser: Any, pages: Any, kind: str) -> None:
    paths, run = pages
    with tab(browser, paths[kind].as_uri(), PHONE) as page:
        assert page.evaluate(LOOK) == []
        if kind in ON_A_PHONE:
            ON_A_PHONE[kind](page, run)
            assert page.evaluate(LOOK) == []  # with the readouts too
        titles = page.locator("main h2").all_inner_texts()
        assert set(LIMITED.get(kind, ())) <= set(titles)
        page.set_viewport_size(DESK)
        for _ in range(200):  # plots follow their size in 100 ms, on a busy machine later
            page.wait_for_timeout(150)
            if not page.evaluate(LOOK):
                break
        assert page.evaluate(LOOK) == []
        if kind == "contour":
            a_plot_is_saved(page)


def drawn(page: Any) -> None:
    page.evaluate("typeof opened === 'undefined' || opened")
    page.evaluate(FRAME)


@pytest.mark.parametrize("kind", few((*KINDS, *BARE), 2))
@pytest.mark.parametrize("size", [PHONE, DESK], ids=["390", "1400"])
def test_no_text_lies_over_text(browser: Any, pages: Any, kind: str, size: Any) -> None:
    with tab(browser, pages[0][kind].as_uri(), size) as page:
        drawn(page)
        assert page.evaluate(WORDS) == []
        assert "nan" not in page.locator("body").inner_text()
        room = page.evaluate("document.documentElement.clientWidth")
        assert page.evaluate("document.documentElement.scrollWidth") == room
        for part in page.locator("details").all():
            part.evaluate("e => { e.open = true; }")
        assert page.evaluate(WORDS) == []


@pytest.mark.more
@pytest.mark.parametrize(
    "move",
    [
        "document.querySelector('section .note').style.translate = '0 -20px'",
        """{ const tick = document.querySelector("#following .xtick text");
              tick.parentNode.append(tick.cloneNode(true)); }""",
    ],
)
def test_text_over_text_is_seen(browser: Any, pages: Any, move: str) -> None:
    with tab(browser, pages[0]["contour"].as_uri(), DESK) as page:
        drawn(page)
        page.evaluate(move)
        assert page.evaluate(WORDS) != []


@pytest.mark.more
def test_a_page_is_small_light_and_dark_with_contents(browser: Any, pages: Any) -> None:
    paths, _ = pages
    for kind in KINDS:
        assert paths[kind].stat().st_size <= LARGEST
    ground = "getComputedStyle(document.body).backgroundColor"
    paper = "document.querySelector('.main-svg').style.background"
    with tab(browser, paths["contour"].as_uri(), DESK) as page:
        drawn(page)
        looks = []
        for _ in range(3):
            looks.append((page.evaluate(ground), page.evaluate(paper)))
            page.locator("#theme").click()
            page.evaluate(FRAME)
        assert looks[0] == looks[2] and looks[0][0] != looks[1][0] and looks[0][1] != looks[1][1]
        titles = page.locator("main h2").all_inner_texts()
        assert page.locator(".contents a").all_inner_texts() == titles
        page.locator(".contents a").last.click()
        assert page.locator("main section").last.evaluate(
            "e => e.getBoundingClientRect().top < innerHeight"
        )
        page.set_viewport_size(PHONE)
        assert not page.locator(".contents ol").is_visible()


def test_a_browser_that_cannot_unpack_says_so(browser: Any, pages: Any) -> None:
    context = browser.new_context(viewport=DESK)
    page = context.new_page()
    page.add_init_script("delete window.DecompressionStream")
    page.goto(pages[0]["contour"].as_uri())
    page.evaluate("opened")
    assert page.locator("#unable").is_visible() and page.locator("td").first.is_visible()
    context.close()


def test_a_long_name_breaks_in_its_card(browser: Any, pages: Any) -> None:
    with tab(browser, pages[0]["tune"].as_uri(), PHONE) as page:
        page.locator(".card .value").first.evaluate(
            "e => e.textContent = 'controller.' + 'x'.repeat(30)"
        )
        assert page.evaluate(LOOK) == []


def cells(page: Any, plot: str) -> dict[str, list[float]]:
    """The rows of a readout: name of the curve, its numbers."""
    rows = page.locator(f".plot:has(#{plot}) .readout tbody tr:visible").all()
    found = {}
    for row in rows:
        name, *values = row.locator("td").all_inner_texts()
        found[name] = [
            float("nan" if v == "\N{EN DASH}" else v.replace("\N{MINUS SIGN}", "-")) for v in values
        ]
    return found


def stands(page: Any) -> list[float]:
    return [
        float(page.locator(f"#following .cursor-C{n}").get_attribute("aria-valuenow")) for n in "12"
    ]


def read(found: list[float], values: np.ndarray, rows: list[int], dt: float) -> None:
    """A readout against the samples of the run."""
    a, b = (float(values[k]) for k in rows)
    part = values[min(rows) : max(rows) + 1].astype(float)
    rms = np.sqrt(np.mean(part**2))
    wanted = [a, b, b - a, (b - a) / dt, part.min(), part.max(), part.mean(), rms]
    height = np.ptp(values.astype(float))
    assert np.allclose(
        found[:3] + found[4:], wanted[:3] + wanted[4:], rtol=1e-5, atol=2e-6 * height
    )
    assert found[3] == pytest.approx(wanted[3], rel=1e-5, abs=4e-6 * height / abs(dt))


@pytest.mark.more
def test_cursors_read_the_samples_of_the_run(browser: Any, pages: Any) -> None:
    paths, run = pages
    following = run.contour().following
    stock = run["card.stock"][:, list(run.contour().run.axes)].min(axis=1)
    step = run.time[1] - run.time[0]
    with tab(browser, paths["contour"].as_uri(), DESK) as page:
        assert page.evaluate(LOOK) == []
        assert page.locator(".cursor:visible").count() == 0
        page.locator(".plot:has(#following) .measure").click()
        page.evaluate(FRAME)
        shared = page.locator(".readout:visible").count()
        assert shared == page.locator(".measure").count() > 3  # all plots over time have them
        a, b = page.locator("#following .cursor-C1"), page.locator("#following .cursor-C2")

        def check() -> list[int]:
            page.evaluate(
                "new Promise((d) => requestAnimationFrame(() => requestAnimationFrame(d)))"
            )
            at = stands(page)
            rows = [round(t / step) for t in at]
            assert np.allclose(at, run.time[rows], rtol=0, atol=1e-12)  # on samples
            dt = run.time[rows[1]] - run.time[rows[0]]
            found = cells(page, "following")
            assert list(found) == ["X [mm]", "Y [mm]"]
            for k, values in enumerate(found.values()):
                read(values, following[:, k], rows, dt)
            read(cells(page, "fifo")["FIFO stock [commands]"], stock, rows, dt)
            return rows

        first = check()
        # By keys: a sample, a hundredth of what is in view, the end.
        b.focus()
        page.keyboard.press("ArrowRight")
        assert check() == [first[0], first[1] + 1]
        page.keyboard.press("Shift+ArrowLeft")
        assert check()[1] == first[1] + 1 - round(0.01 * (len(run.time) - 1))
        page.keyboard.press("End")
        assert check()[1] == len(run.time) - 1
        # By the mouse, past the other one.
        box = a.bounding_box()
        a.scroll_into_view_if_needed()
        box = a.bounding_box()
        x, y = box["x"] + box["width"] / 2, box["y"] + 60
        page.mouse.move(x, y)
        page.mouse.down()
        page.mouse.move(x + 50, y)
        page.mouse.up()
        wide = page.evaluate("document.getElementById('following')._fullLayout.xaxis._length")
        moved = check()[0] - first[0]
        assert moved == pytest.approx(50 / wide * len(run.time), abs=2)
        # By number, to the nearest sample; then a zoom to what is between them.
        page.locator(".plot:has(#following) .readout input").first.fill("0.40004")
        page.keyboard.press("Enter")
        page.locator(".plot:has(#following) .readout input").nth(1).fill("0.42")
        page.keyboard.press("Enter")
        rows = check()
        assert [round(float(t), 9) for t in run.time[rows]] == [0.4, 0.42]
        page.locator(".plot:has(#following) .readout button").click()
        page.wait_for_function("document.getElementById('fifo')._fullLayout.xaxis.range[1] < 0.43")
        # All plots over time show that stretch; the FIFO's band has become its single values.
        page.wait_for_function("document.getElementById('fifo').data[0].x.length > 150")
        shown = page.evaluate(
            """() => { const [t] = document.getElementById("fifo").data;
                return [Array.from(t.x), Array.from(t.y)]; }"""
        )
        time, values = np.array(shown[0]), np.array(shown[1])
        inside = (time > 0.4) & (time < 0.42)
        at = np.rint(time[inside] / step).astype(int)
        assert len(at) > 150 and np.array_equal(values[inside], stock[at])
        page.keyboard.press("Escape")
        # A curve that is not shown is not read.
        page.evaluate("Plotly.restyle('following', { visible: 'legendonly' }, [1])")
        page.evaluate(FRAME)
        assert list(cells(page, "following")) == ["X [mm]"]
        page.locator(".plot:has(#following) .measure").click()
        page.evaluate(FRAME)
        assert page.locator(".cursor:visible, .readout:visible").count() == 0
