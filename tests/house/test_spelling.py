"""One spelling of units wherever a user reads them: µm, °, mm/s², N·m."""

import ast
import re
import tomllib
from collections.abc import Iterator
from typing import Any

from conftest import ROOT

# A unit as FMI names it and `units.spelled` no longer does. A name in quotes is FMI's.
RAW = re.compile(r"(?<![\w.\"])(um|us|deg|Ohm)\b|/s\^?[23]\b|(?<![\w.\"])(N\.m|kg\.m2)\b")
MAYBE = re.compile(r"\b(um|us|deg|Ohm)\b|/s\^?[23]|N\.m|kg\.m2")  # worth a look
# Files whose texts name units for FMI or for data: spelled when they are shown.
NAMES = {
    "src/motionfmu/base/units.py",  # the units themselves
    "src/motionfmu/scenarios/machine_limits.py",  # units of signals, looked up
    "src/motionfmu/records/quantities.py",  # what other spellings of them mean
    "src/motionfmu/analysis/iso9283/evaluation.py",  # keys of result.json
    "src/motionfmu/cards/config_tables.py",  # also for comments of C headers, in ASCII
    "scenarios/compensation/study.py",  # a comment of the table it writes, in ASCII
}


def raw(texts: Iterator[str]) -> list[str]:
    """Texts that have a unit in FMI's spelling."""
    return [text for text in texts if RAW.search(text)]


def texts_of(value: Any) -> Iterator[str]:
    """Keys and texts of a TOML file."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield key
            yield from texts_of(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from texts_of(inner)
    elif isinstance(value, str):
        yield value


def docs_of(text: str) -> Iterator[str]:
    """What an fmu.toml says of its variables; units beside it are for FMI."""
    tables = tomllib.loads(text)
    yield tables["description"]
    for kind in ("parameter", "input", "output", "local"):
        yield from (row["doc"] for row in tables.get(kind, {}).values())


def shown(text: str) -> Iterator[str]:
    """String literals of a module that are no docstrings, but those of console commands."""
    tree = ast.parse(text)
    quiet = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
            first = node.body[0] if node.body else None
            decorators = [] if isinstance(node, ast.Module) else node.decorator_list
            if isinstance(first, ast.Expr) and not any(
                ".command" in ast.unparse(d) for d in decorators
            ):
                quiet.add(id(first.value))
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in quiet:
            yield node.value


def found() -> Iterator[tuple[str, list[str]]]:
    """Every file with its texts that are wrong."""
    kinds = {
        "toml": ("scenarios/**/*.toml", "examples/**/*.toml"),
        "fmu.toml": ("fmus/*/fmu.toml",),
        "py": ("src/motionfmu/**/*.py", "scenarios/**/*.py", "examples/**/*.py"),
        "md": ("*.md", "src/**/*.md", "fmus/*/*.md", "scenarios/*/*.md", "examples/*/*.md"),
    }
    for kind, patterns in kinds.items():
        for file in sorted(f for p in patterns for f in ROOT.glob(p) if f.name != "CHANGELOG.md"):
            if not MAYBE.search(text := file.read_text()):
                continue
            texts = {
                "toml": lambda t: texts_of(tomllib.loads(t)),
                "fmu.toml": docs_of,
                "py": shown,
                "md": lambda t: iter(t.splitlines()),
            }[kind](text)
            if wrong := raw(texts):
                yield str(file.relative_to(ROOT)), wrong


def test_units_are_spelled_alike() -> None:
    """In labels, titles and notes, on pages and the console, in READMEs; data keep FMI's names."""
    wrong = dict(found())
    assert wrong.keys() >= NAMES, "a file that is named as an exception needs it no more"
    assert {name: texts for name, texts in wrong.items() if name not in NAMES} == {}


def test_a_raw_unit_is_found() -> None:
    """FMI's names are; words that hold them, names in quotes and right units are not."""
    for text in ("error [um]", "5 us", "17 deg/s", "mm/s^2", "N.m", " deg, limit "):
        assert raw(iter([text])), text
    for text in ("sum", "degrees", 'unit = "um"', "µm", "°/s", "mm/s²", "N·m", "numpy.deg2rad"):
        assert not raw(iter([text])), text
