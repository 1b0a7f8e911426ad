"""Tutorials do what they say: each cell runs in an empty folder and prints what stands below it.

They run with the checkout's package, and with that of the wheel alone.
"""

import os
import re
import sys
from pathlib import Path

import nbformat
import pytest
from conftest import FMUS, ROOT
from few_cases import few
from followed_pages import Folder
from installed_wheel import Installed
from matplotlib.figure import Figure
from page_cells import alike, cells_printed
from site_pages import tutorials

pytestmark = pytest.mark.more

PAGES = sorted((ROOT / "docs/tutorials").glob("*.md"))
ENVIRON = {**os.environ, "MOTIONFMU_FMUS": str(FMUS)}
WHEEL = pytest.mark.xdist_group("wheel")
CHECKOUT = [pytest.param(page, "checkout", id=f"{page.stem}-checkout") for page in PAGES]
INSTALLED = [pytest.param(p, "wheel", marks=WHEEL, id=f"{p.stem}-wheel") for p in PAGES]


def printed(cells: list[str], folder: Path) -> list[str]:
    """What cells print in an empty folder, with the checkout's package and FMUs."""
    return cells_printed(cells, folder, Path(sys.executable), ENVIRON)


@pytest.mark.parametrize(("page", "where"), CHECKOUT + few(INSTALLED, 2, pytest.mark.long))
def test_a_tutorial_prints_what_it_says(
    page: Path, where: str, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    text = page.read_text(encoding="utf-8")
    code = [cell for cell in tutorials.cells(text) if cell.kind == "code"]
    assert len(code) > 4 and sum(bool(cell.prints) for cell in code) > 3
    texts = [cell.text for cell in code]
    if where == "wheel":
        bench: Installed = request.getfixturevalue("workbench")
        found = cells_printed(texts, tmp_path, bench.python, bench.environ)
        folder = Folder(tmp_path, bench.python, bench.environ)
    else:
        found = printed(texts, tmp_path)
        path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
        folder = Folder(tmp_path, Path(sys.executable), {**ENVIRON, "PATH": path})
    for cell, out in zip(code, found, strict=True):
        assert out.split("\n") == cell.prints.split("\n"), cell.text
    assert "assert " in code[-1].text
    drawn = re.findall(r'savefig\("(.+?)"\)', text)
    assert drawn == re.findall(r"^!\[.+?\]\((.+?)\)$", text, re.MULTILINE)
    assert [name for name in drawn if not alike(tmp_path / name, page.parent / name)] == []
    shell = re.findall(r"^```sh\n.*?^```\n", text, re.MULTILINE | re.DOTALL)
    assert folder.follow("".join(shell)) is None


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.stem)
def test_all_code_of_a_tutorial_is_in_blocks_that_run(page: Path) -> None:
    words = re.sub(r"^```.*?^```\n", "", page.read_text(encoding="utf-8"), flags=re.M | re.S)
    assert [line for line in words.splitlines() if line.startswith("    ")] == []


def test_another_picture_is_found(tmp_path: Path) -> None:
    for name, end in (("a", 1.0), ("b", 1.1)):
        figure = Figure()
        figure.subplots().plot([0.0, 1.0, 2.0], [0.0, end, 0.5])
        figure.savefig(tmp_path / f"{name}.png")
    assert alike(tmp_path / "a.png", tmp_path / "a.png")
    assert not alike(tmp_path / "a.png", tmp_path / "b.png")


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.stem)
def test_a_tutorial_is_a_notebook(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    made = nbformat.reads(tutorials.notebook(text), as_version=4)
    nbformat.validate(made)
    assert [c.source for c in made.cells] == [c.text for c in tutorials.cells(text)]
    assert sum(len(c.outputs) for c in made.cells if c.cell_type == "code") > 3


def test_cells_are_told_from_words() -> None:
    text = (
        "# A\n\nWords.\n\n```python\nprint(1)\n```\n\n```text\n1\n```\n\nMore.\n\n```text\na\n```\n"
    )
    kinds = [("markdown", ""), ("code", "1\n"), ("markdown", ""), ("markdown", "")]
    assert [(c.kind, c.prints) for c in tutorials.cells(text)] == kinds


def test_a_page_that_takes_too_long_is_told(tmp_path: Path) -> None:
    own, childs = (
        "sum(range(10**7))",
        "import subprocess, sys\nsubprocess.run([sys.executable, '-V'])",
    )
    for cell, limit in ((own, 0.02), (childs, 0.001)):
        with pytest.raises(AssertionError, match="s of processor time"):
            cells_printed([cell], tmp_path, Path(sys.executable), ENVIRON, limit)


def test_a_wrong_number_is_found(tmp_path: Path) -> None:
    assert printed(["a = 2", "print(a + 1)"], tmp_path) == ["", "3\n"]
