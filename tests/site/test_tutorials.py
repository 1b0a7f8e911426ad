"""Tutorials do what they say: each cell runs in an empty folder and prints what stands below it."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import nbformat
import numpy as np
import pytest
from conftest import FMUS, ROOT
from matplotlib.figure import Figure
from matplotlib.image import imread
from site_pages import tutorials

pytestmark = pytest.mark.more

# Share of the points of a picture that may be others; a curve that is moved takes more.
POINTS = 1e-3
PAGES = sorted((ROOT / "docs/tutorials").glob("*.md"))
# Runs the cells in one namespace and writes what each printed.
RUNNER = """
import contextlib, io, json, sys
found, space = [], {}
for text in json.load(open("cells.json", encoding="utf-8")):
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        exec(compile(text, "<cell>", "exec"), space)
    found.append(out.getvalue())
json.dump(found, open("printed.json", "w", encoding="utf-8"))
"""


def printed(cells: list[str], folder: Path) -> list[str]:
    """What cells print in a new process that stands in an empty folder."""
    (folder / "cells.json").write_text(json.dumps(cells), encoding="utf-8")
    line = [sys.executable, "-c", RUNNER]
    told = {**os.environ, "MOTIONFMU_FMUS": str(FMUS)}
    done = subprocess.run(line, cwd=folder, env=told, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[-2000:]
    return json.loads((folder / "printed.json").read_text(encoding="utf-8"))


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.stem)
def test_a_tutorial_prints_what_it_says(page: Path, tmp_path: Path) -> None:
    text = page.read_text(encoding="utf-8")
    code = [cell for cell in tutorials.cells(text) if cell.kind == "code"]
    assert len(code) > 4 and sum(bool(cell.prints) for cell in code) > 3
    found = printed([cell.text for cell in code], tmp_path)
    for cell, out in zip(code, found, strict=True):
        assert out.split("\n") == cell.prints.split("\n"), cell.text
    assert "assert " in code[-1].text
    drawn = re.findall(r'savefig\("(.+?)"\)', text)
    assert drawn == re.findall(r"^!\[.+?\]\((.+?)\)$", text, re.MULTILINE)
    assert [name for name in drawn if not alike(tmp_path / name, page.parent / name)] == []


def alike(made: Path, kept: Path) -> bool:
    """Whether a picture is the one that the page shows: hardly a point is another one."""
    new, old = imread(made), imread(kept)
    return new.shape == old.shape and float(np.mean(np.abs(new - old) > 0.1)) < POINTS


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


def test_a_wrong_number_is_found(tmp_path: Path) -> None:
    assert printed(["a = 2", "print(a + 1)"], tmp_path) == ["", "3\n"]
