"""What a user of motionfmu may name: variables of FMUs, options, keys of files, names in Python.

``python tests/helpers/promised_surface.py > tests/house/promised.toml`` writes what the built
project has, at a release.
"""

import ast
import importlib
import pkgutil
import sys
import textwrap
import zipfile
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from types import UnionType
from typing import Any, Union, get_args, get_origin
from xml.etree import ElementTree

import typer.main
from pydantic import BaseModel

import motionfmu.cli
from motionfmu.cards.config import CardConfig
from motionfmu.scenarios.body import Body
from motionfmu.study.study_file import StudyBody
from motionfmu.study.tune.problem import Problem

ROOT = Path(__file__).resolve().parents[2]
FILES: dict[str, type[BaseModel]] = {
    "scenario.toml": Body,
    "sweep.toml": StudyBody,
    "tune.toml": Problem,
    "card.toml": CardConfig,
}
_AS_A_LIST: dict[str, Any] = {
    "initial_indent": "  ",
    "subsequent_indent": "  ",
    "break_on_hyphens": False,
    "break_long_words": False,
}
# By kind, then by what it belongs to, then by what is said of the names: the names.
Surface = dict[str, dict[str, dict[str, list[str]]]]


def surface() -> Surface:
    """All of it, names sorted."""
    return {
        "fmu": {name: _variables(name) for name in _fmus()},
        "command": {name: {"options": found} for name, found in _commands()},
        "file": {name: {"keys": sorted(_keys(model))} for name, model in FILES.items()},
        "python": {name: {"names": found} for name, found in _packages()},
    }


def _fmus() -> list[str]:
    return sorted(p.parent.name for p in ROOT.glob("fmus/*/fmu.toml"))


def _variables(fmu: str) -> dict[str, list[str]]:
    """Names of an FMU's variables by causality, type, shape and unit."""
    with zipfile.ZipFile(ROOT / f"build/fmus/{fmu}.fmi3.fmu") as archive:
        root = ElementTree.fromstring(archive.read("modelDescription.xml"))
    found = defaultdict(list)
    for v in root.find("ModelVariables") or ():
        shape = "".join(f"[{d.get('start')}]" for d in v.iter("Dimension"))
        words = (v.get("causality", "local"), f"{v.tag}{shape}", v.get("unit", ""))
        found[" ".join(filter(None, words))].append(v.get("name", ""))
    return {said: sorted(names) for said, names in sorted(found.items())}


def _commands() -> Iterator[tuple[str, list[str]]]:
    for module in pkgutil.iter_modules(motionfmu.cli.__path__, "motionfmu.cli."):
        importlib.import_module(module.name)
    waiting: list[tuple[str, Any]] = [("", typer.main.get_command(motionfmu.cli.app))]
    while waiting:
        name, command = waiting.pop()
        inner = getattr(command, "commands", {})
        waiting += [(f"{name} {n}".strip(), c) for n, c in inner.items()]
        if not inner:
            shown = [p for p in command.params if not getattr(p, "hidden", False)]
            words = {word for p in shown for word in (*p.opts, *p.secondary_opts)}
            yield name, sorted(word for word in words if word.startswith("-"))


def _keys(model: type[BaseModel]) -> Iterator[str]:
    """Keys of a file, those of inner tables behind a dot."""
    for name, field in model.model_fields.items():
        key = field.alias or name
        yield key
        for inner in _models(field.annotation):
            yield from (f"{key}.{k}" for k in _keys(inner))


def _models(annotation: Any) -> Iterator[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    elif get_origin(annotation) in (list, tuple, dict, Union, UnionType):
        for inner in get_args(annotation):
            yield from _models(inner)
    elif hasattr(annotation, "__metadata__"):
        yield from _models(annotation.__origin__)


def _packages() -> Iterator[tuple[str, list[str]]]:
    for file in sorted((ROOT / "src/motionfmu").rglob("__init__.py")):
        for line in ast.parse(file.read_text()).body:
            named = isinstance(line, ast.Assign) and ast.unparse(line.targets[0]) == "__all__"
            if named and isinstance(line.value, ast.List):
                yield (
                    ".".join(file.parent.relative_to(ROOT / "src").parts),
                    [name for name in ast.literal_eval(line.value) if not name.startswith("_")],
                )


def missing(promised: Surface, there: Surface) -> list[str]:
    """What was promised and is not there: kind, place, what was said of it, name."""
    return [
        f"{kind} {place}: {name} ({said})"
        for kind, places in promised.items()
        for place, rows in places.items()
        for said, names in rows.items()
        for name in sorted({*names} - {*there.get(kind, {}).get(place, {}).get(said, [])})
    ]


def written(found: Surface) -> str:
    """As TOML."""
    lines = ["# What 0.2 has that docs/stability.md promises; tests/helpers/promised_surface.py."]
    for kind, places in found.items():
        for place, rows in sorted(places.items()):
            lines.append(f'\n[{kind}."{place}"]')
            for said, names in rows.items():
                listed = ", ".join(f'"{name}"' for name in names)
                one = f'"{said}" = [{listed}]'
                many = textwrap.fill(listed, 96, **_AS_A_LIST)
                lines.append(one if len(one) <= 100 else f'"{said}" = [\n{many},\n]')
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.stdout.write(written(surface()))
