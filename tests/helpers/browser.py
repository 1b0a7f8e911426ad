"""A real browser for tests of pages: the system's Chromium, else that of playwright, or a skip."""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

PHONE = {"width": 390, "height": 844}
FOUND = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), "")


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    from playwright.sync_api import expect, sync_playwright

    expect.set_options(timeout=60_000)  # whatever the machine's speed
    with sync_playwright() as p:
        path = FOUND or p.chromium.executable_path
        if not Path(path).exists():
            pytest.skip("no Chromium here: pages are not tried in a browser")
        found = p.chromium.launch(executable_path=path, args=["--no-sandbox"])
        yield found
        found.close()


@contextmanager
def tab(browser: Any, address: str, size: dict[str, int] = PHONE) -> Iterator[Any]:
    """A page in a browser window of a given size; an error in its console fails the test."""
    context = browser.new_context(viewport=size, is_mobile=size is PHONE, has_touch=size is PHONE)
    told: list[str] = []
    page = _opened(context, address, told)
    try:
        yield page
    finally:
        context.close()
    assert told == []


def _opened(context: Any, address: str, told: list[str], tries: int = 3) -> Any:
    """A page at an address; a browser that does not answer is asked again."""
    from playwright.sync_api import TimeoutError as NoAnswer

    page = context.new_page()
    page.set_default_timeout(60_000)
    page.on("pageerror", lambda error: told.append(str(error)))
    page.on("console", lambda m: told.append(m.text) if m.type == "error" else None)
    try:
        page.goto(address)
    except NoAnswer:
        page.close()
        if tries == 1:
            raise
        return _opened(context, address, told, tries - 1)
    return page
