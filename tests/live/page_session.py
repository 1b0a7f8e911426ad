"""A person at a live machine's page for a whole session, and what is left of it."""

import json
import re
import urllib.request
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import numpy as np
from browser import tab as browser_tab
from live_pages import DESK, MOVED, TOKEN, position, ready, serving, until

import motionfmu
from motionfmu.live import LiveMachine

# Whether the canvas of the path has been drawn on, in how many colours.
COLOURS = """(id) => {
  const c = document.querySelector(id), seen = new Set();
  for (const part of c.parentElement.querySelectorAll("canvas")) {
    const { data } = part.getContext("2d").getImageData(0, 0, part.width, part.height);
    for (let k = 0; k < data.length; k += 4) {
      if (data[k + 3]) seen.add(`${data[k] >> 4},${data[k + 1] >> 4},${data[k + 2] >> 4}`);
    }
  }
  return seen.size;
}"""


# What the head of the page has said of the machine's state since it was opened.
SAID = """window.said = [];
addEventListener("DOMContentLoaded", () => {
  const head = document.querySelector("#state");
  new MutationObserver(() => window.said.push(head.textContent))
    .observe(head, { childList: true, characterData: true, subtree: true });
});"""


@dataclass
class Session:
    """A page of a machine, worked by mouse, finger and keyboard."""

    page: Any
    address: str
    folder: Path
    channels: Sequence[str]

    def view(self, name: str) -> None:
        """Open a view: operate, scope, values, journal."""
        self.page.locator(f"#tab-{name}").click()

    def click(self, name: str, part: str = "#keys") -> None:
        """Press a key of the panel."""
        button = self.page.locator(part).get_by_role("button", name=name, exact=True)
        button.scroll_into_view_if_needed()
        button.click()

    def state(self, words: str) -> None:
        """Wait for what the head of the page says of the machine."""
        from playwright.sync_api import expect

        expect(self.page.locator("#state")).to_have_text(re.compile(words))

    def alarm(self, *words: str) -> None:
        """Wait for an alarm that says all of this."""
        from playwright.sync_api import expect

        for text in words:
            expect(self.page.get_by_role("alert")).to_contain_text(text)

    def no_alarm(self) -> None:
        """Wait until there is none."""
        from playwright.sync_api import expect

        expect(self.page.locator("#alarm")).to_be_hidden()

    def lamp(self, label: str) -> None:
        """Wait until a lamp is lit."""
        lit = self.page.locator("#lamps li", has_text=label).locator("i.on")
        lit.wait_for(state="attached")

    def pace(self, words: str) -> None:
        """Choose a pace by its words."""
        self.page.locator("#pace").select_option(label=words)

    def key(self, name: str, axis: int, far: float) -> None:
        """Hold a key of the keyboard until an axis has moved so far, in the readout's unit."""
        self.page.locator(".jog-pad").focus()
        before = position(self.page, axis)
        self.page.keyboard.down(name)
        until(self.page, MOVED, [axis, before, np.sign(far).item(), abs(far)])
        self.page.keyboard.up(name)

    @contextmanager
    def finger(self, name: str) -> Iterator[None]:
        """Keep a finger on a button of the jog pad."""
        button = self.page.get_by_role("button", name=name, exact=True)
        button.scroll_into_view_if_needed()
        box = button.bounding_box()
        place = {"x": box["x"] + box["width"] / 2, "y": box["y"] + box["height"] / 2}
        touch = self.page.context.new_cdp_session(self.page)
        touch.send("Emulation.setTouchEmulationEnabled", {"enabled": True, "maxTouchPoints": 1})
        touch.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": [place]})
        try:
            yield
        finally:
            touch.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
            touch.send("Emulation.setTouchEmulationEnabled", {"enabled": False})
            touch.detach()

    def hold_and_slow(self, dial: str, goes_on: Callable[[], None]) -> None:
        """Hold the program that runs, halve it by a dial, and let it go on."""
        from playwright.sync_api import expect

        self.click("Hold")
        self.state("^Hold$")
        expect(self.page.locator("#readout")).to_contain_text("Feed0 mm/min")
        self.page.get_by_label(dial, exact=True).fill("0.5")
        self.click("Hold")
        goes_on()
        until(self.page, f"() => ({COLOURS})('#path') > 12")

    def mdi(self, line: str) -> None:
        """Type a line."""
        field = self.page.get_by_label("Line to run")
        field.fill(line)
        field.press("Enter")

    def fault(self, search: str, label: str, element: int = 0) -> Any:
        """Find a fault on its view; its box and its field."""
        self.view("values")
        self.page.locator("#values-search").fill(search)
        box = self.page.locator(".value", has_text=label).first
        return box, box.locator("input").nth(element)

    def undo(self, box: Any) -> None:
        """Take a fault back, and wait until the machine has it."""
        from playwright.sync_api import expect

        box.get_by_role("button", name="Undo").click()
        expect(box).not_to_have_class(re.compile("changed"))

    def clear_drives(self) -> None:
        """Clear the drives' alarms; a reset before they are gone would be in vain."""
        from playwright.sync_api import expect

        self.click("Clear alarms")
        expect(self.page.locator("#alarm")).not_to_contain_text("Servo drives")

    def arm(self, channel: str, kind: str, level: str = "") -> None:
        """Arm the oscilloscope's trigger."""
        from playwright.sync_api import expect

        self.view("scope")
        page = self.page
        if page.locator("#trigger").get_attribute("open") is None:
            page.locator("#trigger summary").click()
        page.locator("#trigger-channel").select_option(channel)
        page.locator("#trigger-kind").select_option(label=kind)
        if level:
            page.locator("#trigger-level").fill(level)
        page.locator("#trigger-length").select_option("0.2")
        page.get_by_role("button", name="Arm", exact=True).click()
        expect(page.locator("#trigger-state")).to_contain_text(f"waits until {channel}")

    def triggered(self) -> dict[str, Any]:
        """Wait for the trigger, see its picture; the record of its file."""
        from playwright.sync_api import expect

        self.view("scope")
        expect(self.page.locator("#trigger-state")).to_contain_text("triggered at")
        until(self.page, f"() => ({COLOURS})('#scope') > 4")
        with self.page.expect_download() as got:
            self.page.get_by_role("button", name="NumPy").click()
        with np.load(got.value.path()) as file:
            record = dict(file)
        self.page.get_by_role("button", name="Run", exact=True).click()
        return record

    def record(self) -> None:
        """Have every step of the channels written into a file."""
        from playwright.sync_api import expect

        self.view("scope")
        self.page.locator("#record summary").click()
        self.page.get_by_label("File", exact=True).fill(str(self.folder / "live.npz"))
        self.page.get_by_role("button", name="Record", exact=True).click()
        expect(self.page.locator("#record-state")).to_contain_text("live.npz")
        self.view("operate")

    def saved(self, check: str) -> None:
        """Pause, save what was done with a check; its run must have the same bits."""
        from playwright.sync_api import expect

        page = self.page
        page.locator("#run").click()
        expect(page.locator("#run")).to_have_text("Run")
        self.view("scope")
        page.locator("#record").get_by_role("button", name="End", exact=True).click()
        expect(page.locator("#told")).to_contain_text("Written")
        self.view("journal")
        page.locator("#checks-search").fill(check)
        row = page.locator("#checks .check", has=page.locator(f"code:text-is('{check}')"))
        row.get_by_role("checkbox").check()
        page.get_by_label("Folder").fill(str(self.folder / "by_hand"))
        page.get_by_role("button", name="Save", exact=True).click()
        expect(page.locator("#told")).to_contain_text("Saved")
        self._same_bits(check)

    def _same_bits(self, check: str) -> None:
        """Every step of the channels, and all signals at the end: live, run, and live again."""
        plan = motionfmu.load(self.folder / "by_hand")
        with np.load(self.folder / "live.npz") as file:
            live = dict(file)
        result = plan.changed(record={"every": 1, "signals": signals_of(self.channels)}).run()
        assert any(check in v.name for v in result.checks)
        assert result.ok, [v for v in result.checks if not v.ok]
        steps = round(plan.document.tables["stop"] / plan.document.tables["step"]) - 1
        for channel in self.channels:
            whole, _, element = channel.rstrip("]").partition("[")
            want = result[whole][:, int(element) - 1] if element else result[whole]
            assert len(live[channel]) == steps, channel
            assert np.array_equal(live[channel], want[:steps].astype(float)), channel
        with LiveMachine(plan) as again:
            again.step(steps)
            names = list(again.names[0])
            now = self.ask("values", names=names)
            differ = [n for n, v in zip(names, again.read(names), strict=True) if v != now[n]]
        assert differ == []
        assert len(names) > 2 * len(self.channels)

    def ask(self, request: str, **arguments: Any) -> Any:
        """Ask the machine by HTTP, beside the page."""
        place = urlsplit(self.address)
        asked = urllib.request.Request(
            f"http://{place.netloc}/do/{request}",
            json.dumps(arguments).encode(),
            {"Authorization": f"Bearer {TOKEN}", "Content-Type": "application/json"},
        )
        with urllib.request.urlopen(asked, timeout=60) as answer:
            return json.load(answer)["value"]


def signals_of(channels: Sequence[str]) -> list[str]:
    """Signals that the channels are of."""
    return list(dict.fromkeys(re.sub(r"\[\d+\]$", "", c) for c in channels))


@contextmanager
def session(
    browser: Any, folder: Path, machine: str, channels: Sequence[str], **more: Any
) -> Iterator[Session]:
    """A machine that stands at its start, its page on a desk, every step recorded."""
    with (
        serving(machine, running=False, **more) as address,
        browser_tab(browser, address, DESK) as page,
    ):
        expected = Path(more["program"]).stem if "program" in more else machine
        ready(page, expected)
        chosen = f"localStorage.setItem('scope:{expected}', '{json.dumps(list(channels))}')"
        page.evaluate(chosen)
        page.add_init_script(SAID)
        page.goto(address)
        ready(page, expected)
        found = Session(page, address, folder, channels)
        found.record()
        page.locator("#run").click()
        try:
            yield found
            said = page.evaluate("window.said")
            assert said and not [text for text in said if "undefined" in text.lower()]
        except BaseException:
            page.screenshot(path=folder / "failed.png")
            for part in ("#state", "#alarm", "#time", "#hand"):
                print("the page shows", part, page.locator(part).inner_text())
            print("the machine has", found.ask("values", names=signals_of(channels)))
            raise
