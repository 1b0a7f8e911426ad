"""Where things stand: the folders of the root, and the way of the data through the package."""

import ast
import graphlib
import re
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import ROOT

PACKAGE = ROOT / "src/motionfmu"
Graph = dict[str, set[str]]


def modules() -> dict[str, Path]:
    """File of each module by its name, a folder's own file by the folder's."""
    names = {f: f.relative_to(PACKAGE.parent).with_suffix("").parts for f in PACKAGE.rglob("*.py")}
    return {".".join(p for p in parts if p != "__init__"): f for f, parts in names.items()}


def imported(text: str) -> Iterator[tuple[str, str]]:
    """Every import of a module, those inside functions too: from where, and which name."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            yield from ((a.name, "") for a in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "a relative import"
            yield from ((node.module or "", a.name) for a in node.names)


def by_name(text: str) -> list[str]:
    """What a module imports by a text that says which."""
    calls = [n for n in ast.walk(ast.parse(text)) if isinstance(n, ast.Call)]
    made = [c.args[0] for c in calls if "import_module" in ast.unparse(c.func)]
    return [ast.unparse(what) for what in made]


def graph(texts: dict[str, str]) -> Graph:
    """Which modules each module of the package imports."""
    return {
        name: {
            f"{where}.{what}" if f"{where}.{what}" in texts else where
            for where, what in imported(text)
            if where in texts
        }
        for name, text in texts.items()
    }


def circle(found: Graph) -> list[str]:
    """Modules that import each other in turn; empty if none do."""
    try:
        graphlib.TopologicalSorter(found).prepare()
    except graphlib.CycleError as error:
        return list(error.args[1])
    return []


def way() -> list[str]:
    """Modules and folders of the package in the order of the table in its README."""
    table = re.search(r"## The way of the data\n[^|]*((?:\|.*\n)+)", README)
    assert table
    cells = [row.split("|")[1] for row in table[1].splitlines()[2:]]
    return [name for cell in cells for name in re.findall(r"`(\w+(?:/\w+)?)/?`", cell)]


def against(found: Graph, order: list[str]) -> list[str]:
    """Imports from a later place of the way; the package's own front is its end."""
    place = {name: k for k, name in enumerate(order)}

    def rank(module: str) -> int:
        parts = module.split(".")[1:]
        found = [place.get("/".join(parts[:n])) for n in (2, 1) if len(parts) >= n]
        return next((k for k in found if k is not None), len(order))

    return [f"{m} imports {n}" for m, ns in found.items() for n in sorted(ns) if rank(n) > rank(m)]


README = (PACKAGE / "README.md").read_text()
IMPORTS = graph({name: file.read_text() for name, file in modules().items()})


def test_no_modules_import_each_other_in_a_circle() -> None:
    assert circle(IMPORTS) == []


def test_no_module_imports_what_comes_later_on_the_way() -> None:
    assert against(IMPORTS, way()) == []


def test_every_part_of_the_package_has_its_place_on_the_way() -> None:
    groups = {name.split("/")[0] for name in way() if "/" in name} - set(way())
    inner = [f for group in groups for f in (PACKAGE / group).glob("*/__init__.py")]
    own = {str(f.parent.relative_to(PACKAGE)) for f in (*PACKAGE.glob("*/__init__.py"), *inner)}
    assert own - groups == {
        name for name in way() if "/" not in name or name.split("/")[0] in groups
    }
    assert {f.stem for f in PACKAGE.glob("*.py")} == {"__init__", "__main__"}
    assert all((PACKAGE / name).is_dir() for name in way())


def test_only_what_shows_an_object_is_imported_by_name() -> None:
    found = {name: told for name, f in modules().items() if (told := by_name(f.read_text()))}
    assert found == {
        "motionfmu": ["f'motionfmu.{name}'"],
        "motionfmu.cli": ["f'{__name__}.{name}'"],
        "motionfmu.base.shown_by": ["f'motionfmu.report.{module}'"],
    }


@pytest.mark.parametrize("line", ["from p.b import y", "def f():\n    from p import b"])
def test_a_circle_and_an_import_of_what_is_later_are_found(line: str) -> None:
    found = graph({"p": "", "p.a": line, "p.b": "import p.a"})
    assert sorted(set(circle(found))) == ["p.a", "p.b"]
    assert against(found, ["a", "b"]) == ["p.a imports p.b"]


def listed() -> list[str]:
    """Names of all files that belong to the project."""
    return subprocess.run(
        ["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout.splitlines()


def opening(folder: Path) -> str:
    """What a folder says it is: its package's docstring, or what its README begins with."""
    if (module := folder / "__init__.py").exists():
        return ast.get_docstring(ast.parse(module.read_text())) or ""
    readme = folder / "README.md"
    title, _, rest = (readme.read_text() if readme.exists() else "").partition("\n\n")
    return rest if re.fullmatch("# .+", title) else ""


def is_sentence(text: str) -> bool:
    """Whether a text begins with a sentence: some words in plain text, and what ends them."""
    first = text.split("\n\n")[0]
    ends = re.search(r"[.:](\s|$)", first) is not None
    return ends and re.match(r"[A-Z`\[]", first) is not None and len(first.split()) >= 4


def test_every_folder_of_the_sources_says_in_a_sentence_what_it_is() -> None:
    folders = {ROOT / Path(name).parent for name in listed() if name.startswith("src/")}
    folders -= {ROOT / "src"}
    assert len(folders) > 60
    assert {str(f.relative_to(ROOT)) for f in folders if not is_sentence(opening(f))} == set()


def test_a_folder_that_does_not_say_what_it_is_is_found(tmp_path: Path) -> None:
    assert not is_sentence(opening(tmp_path))
    for text, says in (
        ("# Drive\n\nA digital servo drive of one motor, with alarms.\n", True),
        ("# Drive\n\n`drive_tick` is called once a period: it has no clock.\n", True),
        ("# Drive\n\n| file | does |\n|---|---|\n", False),
        ("# Drive\n\n## What is installed\n\nA drive is one. It is.\n", False),
        ("# Drive\n\nDrive.\n", False),
        ("A digital servo drive of one motor.\n", False),
    ):
        (tmp_path / "README.md").write_text(text)
        assert is_sentence(opening(tmp_path)) == says
    (tmp_path / "__init__.py").write_text('"""How a scenario runs, and what a run gave."""\n')
    assert is_sentence(opening(tmp_path))


def test_the_root_holds_the_folders_it_was_designed_with() -> None:
    folders = {n.split("/")[0] for n in listed() if "/" in n and not n.startswith(".")}
    assert folders == {"docs", "examples", "fmus", "modelica", "scenarios", "src", "tests"}
