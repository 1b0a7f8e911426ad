"""The built site: no warning, no dead link, no orphan; it can be searched and read from disk."""

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

import pytest
from browser import PHONE
from conftest import ROOT
from lxml import html

pytestmark = [pytest.mark.more, pytest.mark.xdist_group("site")]

DESK = {"width": 1400, "height": 900}
# Words that a user may look for, more than forty: each is in the site.
WORDS = """
    backlash ballbar Bode bandwidth calibrate chord circle clearance collision
    compensation contour corner cycle deadband encoder export feed feed-forward
    firmware friction FIFO gantry G-code gain homing hydraulic identify inertia interrupt
    jerk JUnit kinematics latency limit live lookahead machine margin mcc MSP430 OPC
    overshoot pulse resonance robot scenario servo singularity spline squareness sweep
    tolerance torque tune URDF voltage wheel
"""
# One page of each kind.
LOOKED_AT = (
    "index",
    "gallery",
    "README",
    "DESIGN",
    "decisions",
    "docs/decisions/motion/short-lines",
    "cores",
    "fmus",
    "reference/commands",
    "reference/files/scenario_toml",
    "reference/faults",
    "reference/python/motionfmu.run",
    "reference/c/pulse",
    "fmus/mcc/README",
    "docs/theory/smooth-paths",
    "docs/glossary",
    "docs/tutorials/control_student",
    "docs/tutorials/machine_builder",
    "docs/how-to/records",
    "scenarios/circle/README",
    "src/motionfmu/README",
    "search",
)
LOCAL = ("file:", "data:")
SEARCHED = """() => /found|did not match/.test(
    document.querySelector("#search-results .search-summary")?.textContent)"""
# Pages that Sphinx makes and that its own header leads to.
OWN = {"search.html", "genindex.html", "py-modindex.html"}


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site, built without a warning."""
    pytest.importorskip("sphinx", reason="Sphinx is not installed: make docs installs it")
    folder = tmp_path_factory.mktemp("site") / "site"
    line = [sys.executable, str(ROOT / "docs/site/build.py"), str(folder)]
    done = subprocess.run(line, capture_output=True, text=True, cwd=ROOT)
    told = [row for row in (done.stdout + done.stderr).splitlines() if "WARNING" in row]
    assert (done.returncode, told) == (0, []), done.stderr[-3000:]
    assert "build succeeded" in done.stdout
    return folder


@pytest.fixture(scope="module")
def pages(site: Path) -> dict[str, Any]:
    """All pages as trees, by their paths in the site."""
    files = {file.relative_to(site).as_posix(): file for file in sorted(site.rglob("*.html"))}
    found = {name: html.parse(str(file)).getroot() for name, file in files.items()}
    assert len(found) > 300
    return found


def links(page: Any) -> Iterator[str]:
    """Addresses of a page that lead into the site, and those of what it shows."""
    for element in page.iter("a", "img", "script", "link", "source"):
        address = element.get("href") or element.get("src")
        if address and not urlsplit(address).scheme and element.get("rel") != "canonical":
            yield address


def target(page: str, address: str) -> tuple[str, str]:
    """File in the site that an address of a page leads to, and the place in it."""
    parts = urlsplit(address)
    base = Path("/") / page
    file = (base.parent / unquote(parts.path)).resolve() if parts.path else base
    return file.as_posix()[1:], unquote(parts.fragment)


def dead(site: Path, pages: dict[str, Any]) -> list[str]:
    """Links that lead to no file or to no place in it."""
    places = {
        name: {e.get("id") for e in page.iter() if e.get("id")}
        | {e.get("name") for e in page.iter("a") if e.get("name")}
        for name, page in pages.items()
    }
    wrong = []
    for name, page in pages.items():
        for address in set(links(page)):
            file, place = target(name, address)
            there = (site / file).is_file()
            if not there or (place and file in places and place not in places[file]):
                wrong.append(f"{name}: {address}")
    return wrong


def orphans(pages: dict[str, Any]) -> set[str]:
    """Pages that no chain of links leads to from the front page, in their text or the menu."""
    reached, waiting = {"index.html"}, ["index.html"]
    while waiting:
        name = waiting.pop()
        for address in set(links(pages[name])):
            file, _ = target(name, address)
            if file in pages and file not in reached:
                reached.add(file)
                waiting.append(file)
    return pages.keys() - reached - OWN


def test_no_link_is_dead_and_no_page_an_orphan(site: Path, pages: dict[str, Any]) -> None:
    assert sum(len(set(links(page))) for page in pages.values()) > 10_000
    assert dead(site, pages) == []
    assert orphans(pages) == set()


def test_a_dead_link_and_an_orphan_are_found(tmp_path: Path) -> None:
    texts = {
        "index.html": '<a href="b.html#there">b</a><a href="b.html#gone">c</a><img src="x.png">',
        "b.html": '<h1 id="there">b</h1>',
        "lost.html": "<p>lost</p>",
    }
    for name, text in texts.items():
        (tmp_path / name).write_text(text)
    found = {name: html.fromstring(f"<html><body>{t}</body></html>") for name, t in texts.items()}
    assert sorted(dead(tmp_path, found)) == ["index.html: b.html#gone", "index.html: x.png"]
    assert orphans(found) == {"lost.html"}


def test_every_readme_is_a_page(pages: dict[str, Any]) -> None:
    listed = subprocess.run(
        ["git", "ls-files", "*.md"], capture_output=True, text=True, cwd=ROOT, check=True
    )
    names = [n for n in listed.stdout.split() if "/templates/" not in n]
    assert len(names) > 150
    names.remove("docs/site/index.md")  # the front page
    names.remove(".github/PULL_REQUEST_TEMPLATE.md")  # a form to fill in
    assert {n for n in names if f"{n.removesuffix('.md')}.html" not in pages} == set()


def test_the_gallery_shows_what_fits(site: Path, browser: Any) -> None:
    page = opened(browser, site / "gallery.html", DESK, "light")
    cards = page.locator(".cards .card")
    everything = cards.count()
    files = [*ROOT.glob("scenarios/*/scenario.toml")]
    files += ROOT.glob("src/motionfmu/machines/*/machine.toml")
    assert everything == len(files) > 60
    page.select_option("select[name=controller]", "soft_controller")
    shown = [c.get_attribute("data-controller") for c in cards.all() if c.is_visible()]
    assert 5 < len(shown) < everything and all("soft_controller" in s for s in shown)
    page.select_option("select[name=subject]", label="path of a tool (ISO 9283)")
    fewer = sum(c.is_visible() for c in cards.all())
    assert 0 < fewer < len(shown)
    assert page.inner_text("#shown") == f"{fewer} of {everything}"
    for name in ("controller", "subject"):
        page.select_option(f"select[name={name}]", "")
    choices = page.locator("select[name=theory] option").all_inner_texts()[1:]
    assert {"smooth paths", "speed"} <= set(choices)
    for choice in choices:
        file = f"docs/theory/{choice.replace(' ', '-')}.md"
        assert (ROOT / file).is_file()
        page.select_option("select[name=theory]", choice)
        shown = [c.get_attribute("href") for c in cards.all() if c.is_visible()]
        texts = {f: (ROOT / f.replace(".html", ".md")).read_text("utf-8") for f in shown}
        assert shown and [f for f, text in texts.items() if f"{file})" not in text] == []
    linking = [f for f in files if "docs/theory/speed.md)" in f.with_name("README.md").read_text()]
    page.select_option("select[name=theory]", "speed")
    assert sum(c.is_visible() for c in cards.all()) == len(linking) > 2
    broken = "[...document.images].filter((i) => i.complete && !i.naturalWidth).map((i) => i.src)"
    assert page.evaluate(broken) == [] and page.told == []
    page.context.close()


def test_search_finds_words_without_a_network(site: Path, browser: Any) -> None:
    page = opened(browser, site / "search.html", DESK, "light")
    missed = []
    for word in WORDS.split():
        page.goto(f"{(site / 'search.html').as_uri()}?q={word}")
        page.wait_for_function(SEARCHED)
        if not page.locator("#search-results ul.search li a").count():
            missed.append(word)
    assert missed == []
    page.goto(f"{(site / 'search.html').as_uri()}?q=xqzwv")
    page.wait_for_function(SEARCHED)
    assert "did not match" in page.inner_text("#search-results") and page.told == []
    page.context.close()


def opened(browser: Any, file: Path, size: dict[str, int], scheme: str) -> Any:
    """A page in a browser of a size; what it asks of a network or tells as an error is an error."""
    page = browser.new_context(viewport=size, color_scheme=scheme).new_page()
    page.told = []
    page.on("pageerror", lambda error: page.told.append(str(error)))
    page.on("console", lambda m: page.told.append(m.text) if m.type == "error" else None)
    page.on("request", lambda r: None if r.url.startswith(LOCAL) else page.told.append(r.url))
    page.goto(file.as_uri())
    return page


# A look by axe-core takes seconds. Pages share their colours and their parts: every other one is
# read in light, the others in dark; the other way round in the long tests.
@pytest.mark.parametrize(
    ("size", "scheme", "read"),
    [
        pytest.param(DESK, "light", LOOKED_AT[::2], id="desk-light"),
        pytest.param(DESK, "dark", (), id="desk-dark"),
        pytest.param(PHONE, "light", (), id="phone-light"),
        pytest.param(PHONE, "dark", LOOKED_AT[1::2], id="phone-dark"),
        pytest.param(DESK, "light", LOOKED_AT[1::2], id="others-light", marks=pytest.mark.long),
        pytest.param(PHONE, "dark", LOOKED_AT[::2], id="others-dark", marks=pytest.mark.long),
    ],
)
def test_pages_fit_and_everyone_can_read_them(
    site: Path, browser: Any, size: dict[str, int], scheme: str, read: tuple[str, ...]
) -> None:
    wrong = []
    for name in LOOKED_AT:
        page = opened(browser, site / f"{name}.html", size, scheme)
        wide = page.evaluate("document.documentElement.scrollWidth")
        wrong += [f"{name}: {wide} pixels wide"] if wide > size["width"] else []
        wrong += [f"{name}: {text}" for text in unreadable(page)] if name in read else []
        wrong += [f"{name}: {text}" for text in page.told]
        page.context.close()
    assert wrong == []


def unreadable(page: Any) -> list[str]:
    """What axe-core finds serious or critical on a page."""
    package = pytest.importorskip("axe_playwright_python").__path__[0]
    page.evaluate(next(Path(package).glob("axe.min.js")).read_text(encoding="utf-8"))
    found = page.evaluate("axe.run(document, { preload: false })")
    assert found["passes"]
    rules = (r for r in found["violations"] if r["impact"] in ("serious", "critical"))
    return [f"{rule['id']}: {rule['nodes'][0]['html'][:200]}" for rule in rules]


def test_what_is_unreadable_is_found(browser: Any, tmp_path: Path) -> None:
    file = tmp_path / "pale.html"
    file.write_text('<html lang="en"><title>a</title><p style="color:#ccc">pale</p>')
    page = opened(browser, file, DESK, "light")
    assert any(text.startswith("color-contrast") for text in unreadable(page))
    page.context.close()
