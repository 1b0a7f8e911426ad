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
    from playwright.sync_api import sync_playwright

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
    page = context.new_page()
    page.set_default_timeout(60_000)
    told: list[str] = []
    page.on("pageerror", lambda error: told.append(str(error)))
    page.on("console", lambda m: told.append(m.text) if m.type == "error" else None)
    page.goto(address)
    try:
        yield page
    finally:
        context.close()
    assert told == []
