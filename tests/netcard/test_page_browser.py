"""The page of the cards in a browser: on cards that answer as real ones, and on the real server."""

import asyncio
import functools
import shutil
import threading
import zipfile
from collections.abc import Awaitable, Callable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from dataclasses import dataclass
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import pytest
from browser import tab as browser_tab
from conftest import ROOT
from few_cases import few
from fleet import Fleet, circle, status
from page_rules import RULES
from page_words import WORDS
from soft_card import SoftCard, serve_card

from motionfmu.cards import messages
from motionfmu.cards.config import load
from motionfmu.cards.server import Cards
from motionfmu.cards.server_page import PageServer, application

CARD = ROOT / "examples/network_card_firmware/card.toml"
TOKEN = "a-token"


@dataclass
class Served:
    fleet: Fleet
    port: int
    config: Path


@contextmanager
def serving(cards: Any, config: Path, beside: Callable[[], Awaitable[Any]]) -> Iterator[int]:
    """The page on a loop of its own, with what else runs there; its port."""
    ended, found = asyncio.Event(), Future[tuple[asyncio.AbstractEventLoop, int]]()

    async def main() -> None:
        async with PageServer(application(cards, TOKEN, config), 0) as port:
            other = asyncio.ensure_future(beside())
            found.set_result((asyncio.get_running_loop(), port))
            await ended.wait()
            other.cancel()

    thread = threading.Thread(target=asyncio.run, args=(main(),), daemon=True)
    thread.start()
    loop, port = found.result(10)
    yield port
    loop.call_soon_threadsafe(ended.set)
    thread.join(10)
    assert not thread.is_alive()


@pytest.fixture
def served(tmp_path: Path) -> Iterator[Served]:
    fleet, config = Fleet(), tmp_path / "card.toml"
    shutil.copy(CARD, config)
    fleet.add(1, "EMPTY")
    fleet.add(4, "FAULT")
    with serving(fleet, config, lambda: asyncio.sleep(0)) as port:
        yield Served(fleet, port, config)


def address(port: int) -> str:
    return f"http://127.0.0.1:{port}/?token={TOKEN}"


@pytest.fixture
def tab(browser: Any, served: Served) -> Iterator[Any]:
    with browser_tab(browser, address(served.port)) as page:
        yield page


def test_a_job_is_opened_sent_started_paused_stopped_homed(tab: Any, served: Served) -> None:
    from playwright.sync_api import expect

    fleet = served.fleet
    state, said = tab.locator("#state"), tab.locator("#told")

    def press(name: str, words: str) -> None:
        tab.get_by_role("button", name=name, exact=True).click()
        expect(said).to_have_text(words)

    expect(state).to_have_text("EMPTY")
    assert "token" not in tab.url
    press("Start", "Start refused: there is no job in the card (EMPTY). Load a job, then start it.")
    file = {"name": "circle.mcj", "mimeType": "application/octet-stream", "buffer": circle()}
    tab.get_by_label("Open drawing or job").set_input_files(files=[file])
    expect(tab.locator("#job-about")).to_contain_text("mm, 1 line, 0.25 m drawn")
    fleet.going = False
    tab.get_by_role("button", name="Send to card").click()
    expect(tab.locator("#sent")).to_contain_text("waits: the card is away")
    assert tab.get_by_role("progressbar", name="Upload").get_attribute("value") == "0"
    tab.reload()  # the upload goes on without the page, and is seen again
    expect(tab.locator("#sent")).to_contain_text("waits: the card is away")
    fleet.going = True
    expect(state).to_have_text("READY")
    expect(tab.locator("#job-name")).to_have_text("circle.mcj")
    expect(tab.locator("#job-about")).to_contain_text("In the card.")
    press("Start", "Start: done (RUNNING)")
    expect(state).to_have_text("RUNNING")
    todo = "Look at the state of the card: wait, or stop it, then give the command again."
    press("Home", f"Home refused: not in this state (RUNNING). {todo}")
    # Space pauses, and does not press the button that has the focus.
    tab.get_by_role("button", name="Start", exact=True).focus()
    tab.keyboard.press("Space")
    expect(said).to_have_text("Pause: done (PAUSED)")
    press("Start", "Start: done (RUNNING)")
    press("Pause", "Pause: done (PAUSED)")
    press("Stop", "Stop: done (READY)")
    press("Home", "Home: done (HOMING)")
    expect(state).to_have_text("HOMING")
    names = ["start", "pause", "start", "pause", "stop", "home"]
    assert fleet.done == [(1, name) for name in names]
    expect(tab.locator("#events li").first).to_contain_text("home: done")
    tab.get_by_role("button", name="Card 4").click()
    press("Reset", "Reset: done (READY)")
    assert fleet.done[-1] == (4, "reset")
    # Nothing is wider than a telephone's screen, and Stop is on it.
    assert tab.locator("html").evaluate("e => e.scrollWidth") == 390
    box = tab.get_by_role("button", name="Stop").bounding_box()
    assert box["y"] + box["height"] <= 844 and box["width"] > 300


@pytest.mark.more
@pytest.mark.parametrize("width", [390, 1400])
def test_no_text_lies_over_text(tab: Any, served: Served, width: int) -> None:
    from playwright.sync_api import expect

    tab.set_viewport_size({"width": width, "height": 900})
    name = f"{'a_job_with_a_name_of_forty_letters_':_<36}.mcj"
    file = {"name": name, "mimeType": "application/octet-stream", "buffer": circle()}
    tab.get_by_label("Open drawing or job").set_input_files(files=[file])
    tab.get_by_role("button", name="Send to card").click()
    expect(tab.locator("#job-name")).to_have_text(name)
    expect(tab.locator("#job-about")).to_contain_text("in the card.")
    for view in ("#tab-config", "#tab-cards"):
        # What stays in its place while the page is scrolled lies over text elsewhere: on
        # a telephone the keys, otherwise the head of the form.
        tab.evaluate(f"scrollTo(0, {'document.body.scrollHeight' if width == 390 else 0})")
        assert tab.evaluate(WORDS) == []
        assert tab.locator("html").evaluate("e => e.scrollWidth") == width
        tab.locator(view).click()


@pytest.mark.more
def test_the_picture_shows_the_speed_and_the_tool(tab: Any, served: Served) -> None:
    from playwright.sync_api import expect

    file = {"name": "circle.mcj", "mimeType": "application/octet-stream", "buffer": circle()}
    tab.get_by_label("Open drawing or job").set_input_files(files=[file])
    expect(tab.locator("#fastest")).to_have_text("194 mm/s")
    expect(tab.locator("#position li").nth(1)).to_have_text("Y20.500mm")
    canvas = tab.locator("#picture")

    def ink(x: float, y: float) -> list[int]:
        """The strongest colour around a place [mm]."""
        return canvas.evaluate(
            """(c, [x, y]) => {
                const [w, h] = [c.clientWidth, c.clientHeight], room = 34;
                const scale = Math.min((w - 2 * room) / 80, (h - 2 * room) / 80);
                const u = (w - scale * 80) / 2 + scale * x;
                const v = (h + scale * 80) / 2 - scale * (y + 40);
                const d = c.getContext("2d").getImageData(u - 3, v - 3, 7, 7).data;
                let best = [0, 0, 0], most = -1;
                for (let k = 0; k < d.length; k += 4) {
                    const rgb = [d[k], d[k + 1], d[k + 2]];
                    const spread = d[k + 3] * (Math.max(...rgb) - Math.min(...rgb));
                    if (spread > most) [best, most] = [rgb, spread];
                }
                return best;
            }""",
            [x, y],
        )

    red, _, blue = ink(0.05, 2.0)  # where it begins, slowly
    assert red > 2 * blue
    red, _, blue = ink(80.0, 0.0)  # half way, at its fastest
    assert blue > 2 * red
    assert max(ink(40.0, 0.0)) - min(ink(40.0, 0.0)) < 30  # nothing is drawn in the middle
    served.fleet.cards[1].status = status(position=(40_000, 0, 0, 0))
    served.fleet.tell("status", 1, "")
    expect(tab.locator("#position li").first).to_have_text("X40.000mm")
    tab.wait_for_timeout(100)
    arm = canvas.evaluate(
        """c => { const d = c.getContext("2d").getImageData(
            c.width / 2 - 12, c.height / 2 - 12, 24, 24).data;
            let n = 0; for (let k = 3; k < d.length; k += 4) n += d[k] > 200; return n; }"""
    )
    assert arm > 60


@pytest.mark.more
def test_the_form_checks_as_it_is_typed_and_saves(tab: Any, served: Served) -> None:
    from playwright.sync_api import expect

    tab.get_by_role("tab", name="Configuration").click()
    field = tab.get_by_label("Highest speed [mm/s], axis X")
    expect(field).to_have_value("200")
    verdict, save = tab.locator("#verdict"), tab.get_by_role("button", name="Save")
    expect(verdict).to_have_text("All values are good")
    field.fill("600")
    expect(verdict).to_have_text("1 value is wrong")
    expect(tab.get_by_text("that is 600000 pulses/s; 1 .. 500000 wanted")).to_be_visible()
    expect(save).to_be_disabled()
    field.fill("150")
    tab.get_by_label("Does, input 7").select_option("event")
    box = tab.get_by_label("Start only when homed")
    box.focus()
    tab.keyboard.press("Space")  # in the form space is the form's
    expect(verdict).to_have_text("All values are good")
    save.click()
    expect(verdict).to_contain_text("Saved in")
    assert "# " in served.config.read_text()
    send = tab.get_by_role("button", name="Send to card 1")
    send.click()
    expect(verdict).to_contain_text("Axis X: Highest speed: 1 -> 150 mm/s: done")
    assert served.fleet.done.pop() == (1, "speed_max 150000")
    saved = load(served.config)
    assert saved.axes[0].speed_max == 150 and saved.inputs[7].action == "event"
    assert saved.motion.must_home and served.fleet.done == []
    with tab.expect_download() as got:
        tab.get_by_role("button", name="Download headers").click()
    assert len(zipfile.ZipFile(got.value.path()).namelist()) == 6
    assert tab.locator("html").evaluate("e => e.scrollWidth") == 390


def test_another_page_cannot_press_start(browser: Any, served: Served, tmp_path: Path) -> None:
    """A page of another origin knows even the token, and is refused all the same."""
    served.fleet.add(1, "READY")
    context = browser.new_context()
    page = context.new_page()
    handler = functools.partial(SimpleHTTPRequestHandler, directory=tmp_path)
    other = ThreadingHTTPServer(("127.0.0.1", 0), handler)
    threading.Thread(target=other.serve_forever, daemon=True).start()
    page.goto(f"http://127.0.0.1:{other.server_port}/")
    here = f"127.0.0.1:{served.port}"
    page.evaluate(
        """([here, token]) => fetch(`http://${here}/cards/1/command`, { method: "POST",
            mode: "no-cors", body: JSON.stringify({ name: "start" }) }).catch(() => 0)
            .then(() => fetch(`http://${here}/cards/1/command`, { method: "POST",
            headers: { authorization: `Bearer ${token}` },
            body: JSON.stringify({ name: "start" }) })).catch(() => 0)""",
        [here, TOKEN],
    )
    heard = page.evaluate(
        """([here, token]) => new Promise((done) => { const w = new WebSocket(`ws://${here}/live`);
            w.onopen = () => w.send(token); w.onmessage = (e) => done(e.data);
            w.onerror = w.onclose = () => done(""); })""",
        [here, TOKEN],
    )
    assert heard == "" and served.fleet.done == [] and served.fleet.queues == []
    context.close()
    other.shutdown()
    other.server_close()


@pytest.mark.more
def test_the_page_works_on_the_real_server_with_a_card_that_comes_late(
    browser: Any, tmp_path: Path
) -> None:
    from playwright.sync_api import expect

    soft, cards, come = SoftCard(5), Cards(tmp_path / "cards"), threading.Event()
    config = tmp_path / "card.toml"
    shutil.copy(CARD, config)

    async def beside() -> None:
        port = await cards.listen("127.0.0.1", 0)
        waits = asyncio.create_task(cards.upload(5, circle(50.0)))
        while not come.is_set():
            await asyncio.sleep(0.01)
        try:
            await serve_card(soft, "127.0.0.1", port, 0.02)
        finally:
            waits.cancel()
            await cards.close()

    with serving(cards, config, beside) as port, browser_tab(browser, address(port)) as tab:
        expect(tab.locator("#state")).to_have_text("OFFLINE")
        expect(tab.locator("#sent")).to_contain_text("waits")
        tab.get_by_role("button", name="Start", exact=True).click()
        expect(tab.locator("#told")).to_have_text("Start refused: the card is not connected")
        come.set()
        expect(tab.locator("#state")).to_have_text("READY")
        assert soft.job == circle(50.0)
        file = {"name": "two.mcj", "mimeType": "application/octet-stream", "buffer": circle()}
        tab.get_by_label("Open drawing or job").set_input_files(files=[file])
        tab.get_by_role("button", name="Send to card").click()
        expect(tab.locator("#job-about")).to_contain_text("two.mcj is in the card.")
        assert soft.job == circle()
        for name, state in (("Start", "RUNNING"), ("Pause", "PAUSED"), ("Stop", "READY")):
            tab.get_by_role("button", name=name, exact=True).click()
            expect(tab.locator("#told")).to_have_text(f"{name}: done ({state})")
        tab.get_by_role("button", name="Home", exact=True).click()
        expect(tab.locator("#told")).to_have_text("Home: done (READY)")
    kinds = [type(order) for order in soft.orders]
    assert kinds == [messages.Start, messages.Pause, messages.Stop, messages.Home]


@pytest.mark.more
def test_another_page_of_a_drawing_is_chosen(tab: Any, served: Served, tmp_path: Path) -> None:
    from playwright.sync_api import expect

    file = tmp_path / "two.plt"
    file.write_bytes(b"IN;SP1;PU400,400;PD2000,400;PG;PU400,800;PD1000,800;PG;")
    tab.locator("#file").set_input_files(file)
    about, page = tab.locator("#job-about"), tab.get_by_label("Page", exact=True)
    expect(about).to_contain_text("40.0 \N{MULTIPLICATION SIGN} 0.0 mm")
    expect(tab.locator("#pages")).to_have_text("Page of 2")
    assert tab.locator("#pages").bounding_box()["width"] < 160
    page.fill("2")
    page.press("Enter")
    expect(about).to_contain_text("15.0 \N{MULTIPLICATION SIGN} 0.0 mm, 1 line")


@pytest.mark.more
def test_a_drawing_that_is_opened_before_a_card_is_known(browser: Any, tmp_path: Path) -> None:
    from playwright.sync_api import expect

    fleet, config, file = Fleet(), tmp_path / "card.toml", tmp_path / "line.plt"
    shutil.copy(CARD, config)
    file.write_bytes(b"IN;SP1;PU400,400;PD2000,400;PU;")
    opened = threading.Event()

    async def come() -> None:
        while not opened.is_set():
            await asyncio.sleep(0.01)
        fleet.add(1, "EMPTY")
        fleet.tell("connect", 1, "is there")

    with serving(fleet, config, come) as port, browser_tab(browser, address(port)) as page:
        expect(page.locator("#link")).to_have_attribute("data-good", "true")
        page.locator("#file").set_input_files(file)
        opened.set()
        expect(page.locator("#job-about")).to_contain_text("40.0 \N{MULTIPLICATION SIGN} 0.0 mm")


@pytest.mark.parametrize("theme", few(["light", "dark"], 1, pytest.mark.long))
@pytest.mark.parametrize(
    "size", few([pytest.param((1280, 900), id="desk"), pytest.param((390, 844), id="phone")], 1)
)
def test_everyone_can_read_and_reach_the_page(
    browser: Any, served: Served, size: tuple[int, int], theme: Any
) -> None:
    for k in range(40):
        served.fleet.tell("result", 1, f"start {k}: done")
    with browser_tab(browser, address(served.port), {"width": size[0], "height": size[1]}) as tab:
        tab.emulate_media(color_scheme=theme)
        tab.locator("#events li").nth(30).wait_for()
        found = tab.evaluate(RULES)
        assert found["words"] > 60
        assert {rule: wrong for rule, wrong in found["wrong"].items() if wrong} == {}
        tab.locator("#tab-config").click()
        tab.locator("#form fieldset, #form table").first.wait_for()
        found = tab.evaluate(RULES)
        assert {rule: wrong for rule, wrong in found["wrong"].items() if wrong} == {}
