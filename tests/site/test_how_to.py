"""How-to pages do what they say in an empty folder, with the package and FMUs of the checkout."""

import os
import sys
from pathlib import Path

import pytest
from conftest import FMUS, ROOT
from followed_pages import Folder, steps

pytestmark = pytest.mark.more

PAGES = sorted((ROOT / "docs/how-to").glob("*.md"))


def followed(page: str, folder: Path) -> str | None:
    """What went otherwise than a page says in a folder, with the checkout's package and FMUs."""
    places = (str(Path(sys.executable).parent), os.environ["PATH"])
    told = {"MOTIONFMU_FMUS": str(FMUS), "COLUMNS": "160", "PATH": os.pathsep.join(places)}
    return Folder(folder, Path(sys.executable), os.environ | told).follow(page)


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.stem)
def test_a_page_does_what_it_says(page: Path, tmp_path: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert any(step.kind in ("sh", "python") and not step.name for step in steps(text))
    assert followed(text, tmp_path) is None


def test_the_manual_leads_to_every_page() -> None:
    manual = (ROOT / "src/motionfmu/README.md").read_text(encoding="utf-8")
    assert [p.name for p in PAGES if f"](../../docs/how-to/{p.name})" not in manual] == []


@pytest.mark.parametrize(
    ("page", "told"),
    [
        ("# A\n\n```sh\nfalse\n```\n", "exit status 1"),
        ("# A\n\n```sh\nfalse\necho on\n```\n", "exit status 1"),
        ("# A\n\n```sh\necho a; echo b\n```\n\n```text\nb\na\n```\n", "did not print: a"),
        ("# A\n\n```python\nprint(1)\n```\n\n```text\n2\n```\n", "did not print: 2"),
        ("In `a.txt`:\n\n```csv\nx\n```\n\n```sh\ngrep y a.txt\n```\n", "exit status 1"),
        ("In `a.yml`:\n\n```yaml\njob:\n  script: [exit 2]\n```\n", "exit status 2"),
    ],
)
def test_what_is_otherwise_is_told(page: str, told: str, tmp_path: Path) -> None:
    assert told in (followed(page, tmp_path) or "")


def test_a_good_page_is_followed(tmp_path: Path) -> None:
    page = (
        "In `b/a.toml`:\n\n```toml\nx = 1\n```\n\n```sh\ncat b/a.toml\n```\n\n```text\nx = 1\n```\n"
    )
    assert followed(page, tmp_path) is None


def test_a_block_that_is_neither_file_nor_output_is_refused() -> None:
    for page in ("Words.\n\n```toml\nx = 1\n```\n", "Words.\n\n```text\na\n```\n"):
        with pytest.raises(AssertionError):
            steps(page)
