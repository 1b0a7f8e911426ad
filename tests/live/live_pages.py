"""A live machine with its page on a thread of its own, and what hands do at it, for tests."""

import asyncio
import re
import threading
from collections.abc import Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from motionfmu.base.page_server import PageServer
from motionfmu.live.serving import MachineLink, application
from motionfmu.live.serving.machine_app import MESSAGE_MAX
from motionfmu.live.serving.machine_link import MachineStart

TOKEN = "a-token"
DESK = {"width": 1400, "height": 900}


@contextmanager
def serving(scenario: str | Path, **more: Any) -> Iterator[str]:
    """The address of a machine's page."""
    ended, found = asyncio.Event(), Future[tuple[asyncio.AbstractEventLoop, int]]()

    async def main() -> None:
        try:
            async with (
                MachineLink(MachineStart(str(scenario), **more)) as link,
                PageServer(application(link, TOKEN), 0, message_max=MESSAGE_MAX) as port,
            ):
                found.set_result((asyncio.get_running_loop(), port))
                await ended.wait()
        except BaseException as error:
            if not found.done():
                found.set_exception(error)
            raise

    thread = threading.Thread(target=asyncio.run, args=(main(),), daemon=True)
    thread.start()
    loop, port = found.result(60)
    try:
        yield f"http://127.0.0.1:{port}/?token={TOKEN}"
    finally:
        loop.call_soon_threadsafe(ended.set)
        thread.join(20)
    assert not thread.is_alive()


def ready(page: Any, name: str = "circle") -> None:
    """Wait until the page has the machine, and take it in hand."""
    from playwright.sync_api import expect

    expect(page.locator("#name")).to_have_text(name)
    expect(page.locator("#hand")).not_to_have_text("")
    if (
        page.locator("#take").is_visible()
        and "in your hand" not in page.locator("#hand").inner_text()
    ):
        page.locator("#take").click()
    expect(page.locator("#hand")).to_contain_text("in your hand")
    expect(page.locator("#readout tbody td").first).to_contain_text(re.compile(r"\d"))


def position(page: Any, axis: int) -> float:
    """A number of the readout, in its unit."""
    text = page.locator("#readout tbody tr").nth(axis - 1).locator("td").first.inner_text()
    return float(text.replace("\N{MINUS SIGN}", "-"))


def until(page: Any, script: str, argument: Any = None) -> Any:
    """Wait for as long as it takes until a script gives something true."""
    return page.wait_for_function(script, arg=argument, timeout=60_000).json_value()


# Whether an axis has moved that way by more than a little, or by so much.
MOVED = """([axis, from, way, far]) => {
  const cell = document.querySelector(`#readout tbody tr:nth-child(${axis}) td`);
  return way * (Number(cell.textContent.replace("\\u2212", "-")) - from) > (far ?? 0.05);
}"""
RESTS = """([axis, times]) => {
  const cell = document.querySelector(`#readout tbody tr:nth-child(${axis}) td`);
  const now = [cell.textContent, document.querySelector("#time").textContent];
  window.rest = window.rest?.[0] === now[0] ? [now[0], window.rest[1],
    window.rest[2] + (now[1] !== window.rest[1])] : [...now, 0];
  if (window.rest[2]) window.rest[1] = now[1];
  return window.rest[2] > times;
}"""


def rests(page: Any, axis: int) -> None:
    """Wait until an axis has the same position in 15 readouts of a running machine."""
    page.evaluate("() => { window.rest = null; }")
    until(page, RESTS, [axis, 15])
