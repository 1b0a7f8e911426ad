"""A name of the package means one thing: no two classes or modules share it, and it is a noun."""

import ast
from collections import defaultdict
from collections.abc import Iterator, Mapping
from pathlib import PurePosixPath

import pytest
from conftest import ROOT

SOURCE = ROOT / "src/motionfmu"
TEXTS = {f.relative_to(SOURCE).as_posix(): f.read_text() for f in SOURCE.rglob("*.py")}
# What was done to a thing does not say what the thing is.
PARTICIPLES = set(
    "asked called carried chosen commanded coupled driven found given imported kept listed made"
    " measured opened packed planned prepared ran recorded scaled scoped shipped shown stored taken"
    " told used wanted wired written".split()
)
Places = dict[str, list[str]]


def bare(name: str) -> str:
    """A name as it is compared: a leading or trailing underscore makes no other one."""
    return name.strip("_")


def classes(texts: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """Every class by its name, those inside functions too, and its file."""
    for file, text in texts.items():
        found = (n.name for n in ast.walk(ast.parse(text)) if isinstance(n, ast.ClassDef))
        yield from ((bare(name), file) for name in found)


def modules(texts: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """Every module by its name, a folder's own file by the folder's, and its file."""
    for file in map(PurePosixPath, texts):
        name = file.parent.name if file.name == "__init__.py" else file.stem
        yield bare(name), str(file)


def twice(named: Iterator[tuple[str, str]]) -> Places:
    """Names that several have, with the files in which they stand."""
    places: Places = defaultdict(list)
    for name, file in named:
        places[name].append(file)
    return {name: sorted(files) for name, files in places.items() if len(files) > 1}


def is_command(name: str, files: list[str]) -> bool:
    """Whether they are a package and the console command of its name, which shows it to a user."""
    command = f"cli/{name}.py"
    return len(files) == 2 and command in files and any(f.endswith("/__init__.py") for f in files)


def participles(texts: Mapping[str, str]) -> set[str]:
    """Files of modules whose name ends in a participle."""
    return {file for name, file in modules(texts) if name.rpartition("_")[2] in PARTICIPLES}


def test_no_two_classes_share_a_name() -> None:
    assert twice(classes(TEXTS)) == {}


def test_no_two_modules_share_a_name_but_a_command_and_its_package() -> None:
    assert {n: f for n, f in twice(modules(TEXTS)).items() if not is_command(n, f)} == {}


def test_a_module_has_a_noun_for_a_name() -> None:
    assert participles(TEXTS) == set()


@pytest.mark.parametrize(
    ("texts", "found"),
    [
        ({"a.py": "class Run: ...", "b.py": "class _Run: ..."}, {"Run": ["a.py", "b.py"]}),
        ({"a.py": "class Run: ...\ndef f():\n    class Run: ..."}, {"Run": ["a.py", "a.py"]}),
        ({"a.py": "class Run: ...", "b.py": "class Runs: ..."}, {}),
    ],
)
def test_a_class_that_stands_twice_is_found(texts: dict[str, str], found: Places) -> None:
    assert twice(classes(texts)) == found


@pytest.mark.parametrize(
    ("files", "found"),
    [
        (["cli/run.py", "run/__init__.py"], []),
        (["cli/run.py", "study/run/__init__.py"], []),
        (["cli/run.py", "study/run.py"], ["run"]),
        (["run/__init__.py", "run/run.py"], ["run"]),
        (["cli/run.py", "run/__init__.py", "report/run.py"], ["run"]),
        (["a/import_.py", "b/import.py"], ["import"]),
        (["a/run.py", "b/runs.py"], []),
    ],
)
def test_a_module_that_stands_twice_is_found(files: list[str], found: list[str]) -> None:
    places = twice(modules(dict.fromkeys(files, "")))
    assert [n for n, f in places.items() if not is_command(n, f)] == found


def test_a_participle_is_found_at_the_end_of_a_name() -> None:
    names = ("run/wired.py", "run/run_wired.py", "run/wired_runs.py", "given/__init__.py")
    found = participles(dict.fromkeys(names, ""))
    assert found == {"run/wired.py", "run/run_wired.py", "given/__init__.py"}
