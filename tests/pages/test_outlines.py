"""What each kind of page shows: no section, row, word or curve is lost."""

from pathlib import Path

import pytest
from made import BARE, KINDS, made
from page_outline import outline, shows_what_is_kept

# What they share is made once, by one worker.
pytestmark = pytest.mark.xdist_group("pages")


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    return made(tmp_path_factory.getbasetemp() / "pages")[0]


@pytest.mark.more
def test_every_kind_is_looked_at(pages: dict[str, Path]) -> None:
    assert set(pages) == {*KINDS, *BARE}


@pytest.mark.parametrize("kind", KINDS)
def test_the_page_shows_what_is_kept(pages: dict[str, Path], kind: str) -> None:
    shows_what_is_kept(kind, pages[kind].read_text(encoding="utf-8"))


def test_an_outline_misses_what_a_page_has_lost(pages: dict[str, Path]) -> None:
    page = pages["sweep"].read_text(encoding="utf-8")
    assert "## What was varied" in outline(page)
    without = page.replace("What was varied", "")
    assert outline(without) != outline(page)
