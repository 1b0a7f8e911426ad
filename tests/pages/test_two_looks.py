"""Pages without a script follow the light or dark look that a browser or a notebook asks for."""

import base64
import io
from pathlib import Path
from typing import Any

import pytest
from made import made
from PIL import Image

import motionfmu

pytestmark = pytest.mark.xdist_group("pages")

DESK = {"width": 1400, "height": 900}
# Contrast of a text with its ground, after WCAG; large and bold text needs 3.
LEAST = 3.0
# Texts with less contrast with what they stand on, with opacities, in words.
FAINT = """(least) => {
  const channels = (text) => text.match(/[\\d.]+/g).map(Number);
  const light = (rgb) => {
    const [r, g, b] = rgb.map((v) => {
      const s = v / 255;
      return s <= 0.04045 ? s / 12.92 : ((s + 0.055) / 1.055) ** 2.4;
    });
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const paper = matchMedia("(prefers-color-scheme: dark)").matches ? [18, 18, 18] : [255, 255, 255];
  const over = (top, share, below) => top.map((v, k) => share * v + (1 - share) * below[k]);
  const wrong = [];
  const words = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  let seen = 0;
  while (words.nextNode()) {
    const element = words.currentNode.parentElement;
    if (!words.currentNode.data.trim() || element.closest("style, svg")) continue;
    seen++;
    const line = [];
    for (let e = element; e; e = e.parentElement) line.unshift(getComputedStyle(e));
    let ground = paper, opacity = 1;
    for (const style of line) {
      const [r, g, b, a = 1] = channels(style.backgroundColor);
      ground = over([r, g, b], a, ground);
      opacity *= Number(style.opacity);
    }
    const ink = over(channels(line.at(-1).color).slice(0, 3), opacity, ground);
    const [high, low] = [light(ink), light(ground)].sort((a, b) => b - a);
    const contrast = (high + 0.05) / (low + 0.05);
    if (contrast < least) wrong.push(`${words.currentNode.data}: ${contrast.toFixed(2)}`);
  }
  return [seen, wrong];
}"""
SOURCES = """() => [...document.querySelectorAll(".motionfmu img")]
  .filter((e) => e.getBoundingClientRect().width > 0).map((e) => e.src)"""


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> tuple[dict[str, Path], motionfmu.Result]:
    return made(tmp_path_factory.getbasetemp() / "pages")


def opened(browser: Any, page: Path, scheme: str) -> Any:
    """A page in a browser that asks for a light or a dark look."""
    found = browser.new_context(viewport=DESK, color_scheme=scheme).new_page()
    found.goto(page.as_uri())
    return found


def grounds(page: Any) -> list[str]:
    """Whether each picture that is seen is light or dark."""
    found = []
    for source in page.evaluate(SOURCES):
        file = base64.b64decode(source.partition(",")[2])
        corner = Image.open(io.BytesIO(file)).convert("L").getpixel((1, 1))
        found.append({255: "light", 29: "dark"}[corner])
    return found


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("kind", ["documentation", "notebook"])
def test_every_text_is_read_on_its_ground(browser: Any, pages: Any, kind: str, scheme: str) -> None:
    page = opened(browser, pages[0][kind], scheme)
    seen, wrong = page.evaluate(FAINT, LEAST)
    page.context.close()
    assert seen > 50 and wrong == []


@pytest.mark.more
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_picture_follows_the_browser_or_what_the_notebook_says(
    browser: Any, pages: Any, scheme: str
) -> None:
    page = opened(browser, pages[0]["notebook"], scheme)
    assert grounds(page) == 5 * [scheme]
    for host in (
        "document.body.dataset.jpThemeLight = '{lab}'",
        "document.body.className = 'vscode-{look}'",
        "document.documentElement.setAttribute('theme', '{look}')",
    ):
        page = opened(browser, pages[0]["notebook"], scheme)
        for look, lab in (("light", "true"), ("dark", "false")):
            page.evaluate(host.format(look=look, lab=lab))
            assert grounds(page) == 5 * [look], host
        page.context.close()
