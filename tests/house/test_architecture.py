"""Pages of docs/architecture: one screen each, drawings as the tree is, every folder named."""

import importlib.util
import re
import tomllib
from pathlib import Path
from types import ModuleType

import pytest
from conftest import ROOT
from test_decisions import MOST_COLUMNS, MOST_LINES
from test_house import PACKAGE, listed
from test_theory_pages import broken_links, defines

FOLDER = ROOT / "docs/architecture"
PAGES = sorted(FOLDER.glob("*.md"))
MANUAL, TESTS = PACKAGE / "README.md", ROOT / "tests/README.md"
# What leads to the pages.
LEADING = ("DESIGN.md", "CONTRIBUTING.md", "docs/site/index.md")


def loaded() -> ModuleType:
    """The script that makes the drawings."""
    spec = importlib.util.spec_from_file_location("drawings", FOLDER / "drawings.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


drawings = loaded()


@pytest.mark.parametrize("name", drawings.DRAWINGS)
def test_a_drawing_is_as_the_tree_is(name: str) -> None:
    made = drawings.DRAWINGS[name]()
    kept = (FOLDER / f"{name}.svg").read_text(encoding="utf-8")
    assert kept == made, "run docs/architecture/drawings.py"
    page = (FOLDER / f"{name}.md").read_text(encoding="utf-8")
    assert f"]({name}.svg)" in page


@pytest.mark.parametrize("page", PAGES, ids=lambda f: f.stem)
def test_a_page_is_one_screen_and_leads_somewhere(page: Path) -> None:
    assert page.stem in drawings.DRAWINGS
    text = page.read_text(encoding="utf-8")
    assert len(text.splitlines()) <= MOST_LINES
    assert [line for line in text.splitlines() if len(line) > MOST_COLUMNS] == []
    assert broken_links(text, FOLDER) == []


@pytest.mark.parametrize("name", LEADING)
def test_the_pages_are_linked(name: str) -> None:
    assert "architecture" in (ROOT / name).read_text(encoding="utf-8")


def test_every_part_that_is_drawn_is_a_folder() -> None:
    shown = [part for row in drawings.PARTS for part in row]
    assert all((ROOT / part.split(":")[0]).is_dir() for part in shown)
    storeys = {f"src/{f.parent.name}" for f in ROOT.glob("src/*/storey.toml")}
    code = {f"src/{Path(n).parts[1]}" for n in listed() if re.fullmatch(r"src/\w+/.+", n)}
    assert storeys < code
    assert code - {"src/cmake"} == {part for part in shown if part.startswith("src/")}


def test_an_fmu_is_of_one_of_the_kinds_that_are_drawn() -> None:
    files = sorted(ROOT.glob("fmus/*/fmu.toml"))
    plants = {f for f in files if "modelica" in tomllib.loads(f.read_text(encoding="utf-8"))}
    assert plants == {f for f in files if not f.with_name("model.c").is_file()}


def test_arrows_that_others_make_up_are_left_out() -> None:
    found = {"a": {"b", "c"}, "b": {"c"}, "c": set()}
    assert list(drawings.drawn(found)) == [("a", "b"), ("b", "c")]
    uses = drawings.uses()
    assert "src/base" in uses["src/controllers"] and "src/controllers" not in uses["src/fmi"]
    assert ("src/controllers", "src/base") not in set(drawings.drawn(uses))


def test_the_ways_through_the_package_go_by_what_the_table_says() -> None:
    makes = {name: made for names, made in drawings.table() for name in names}
    for file, steps in drawings.WAYS:
        assert list((ROOT / "scenarios").glob(f"*/{file}"))
        for part, thing in steps:
            words = re.findall(r"\w{5,}", thing)
            assert words and {word for word in words if word not in makes[part]} == set(), part


NAMED = [row[1:] for row in (*drawings.STEP, *drawings.INSIDE, *drawings.AFTER)]


@pytest.mark.parametrize(("name", "file"), NAMED)
def test_what_a_step_names_is_defined(name: str, file: str) -> None:
    assert defines(ROOT / file, name)


def folders(of: Path) -> set[str]:
    """Names of the folders right below one that hold files of the project."""
    base = of.relative_to(ROOT).as_posix() + "/"
    inner = (n.removeprefix(base) for n in listed() if n.startswith(base))
    return {name.split("/")[0] for name in inner if "/" in name}


def unnamed(page: str, names: set[str]) -> set[str]:
    """Folders that no first cell of a table and no link of a page names."""
    cells = [line.split("|")[1] for line in page.splitlines() if line.startswith("|")]
    told = {name for cell in cells for name in re.findall(r"[`(\[]([\w-]+)/", cell)}
    return names - told


def test_every_folder_of_the_package_and_of_the_tests_is_named() -> None:
    house = (ROOT / "DESIGN.md").read_text(encoding="utf-8")
    for page in (MANUAL, TESTS):
        assert f"]({page.relative_to(ROOT).as_posix()}" in house.split("## The house")[1]
        there = folders(page.parent)
        assert len(there) > 20
        assert unnamed(page.read_text(encoding="utf-8"), there) == set(), page


def test_a_folder_that_is_not_named_is_told() -> None:
    page = "| folder |\n|---|\n| `a/` | x |\n| [`b/`](b/README.md) | `c/` |\n"
    assert unnamed(page, {"a", "b", "c"}) == {"c"}
