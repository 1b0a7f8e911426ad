"""What a user of motionfmu may name: variables, options, keys, names in files, in Python and in C.

``python tests/helpers/promised_surface.py > tests/house/promised.toml`` writes what the built
project has, at a release.
"""

import ast
import dataclasses
import enum
import hashlib
import importlib
import inspect
import io
import json
import math
import pkgutil
import re
import subprocess
import sys
import tempfile
import textwrap
import zipfile
from collections import defaultdict
from collections.abc import Iterable, Iterator
from contextlib import chdir, redirect_stderr, redirect_stdout, suppress
from functools import cached_property
from pathlib import Path
from types import UnionType
from typing import Any, Union, get_args, get_origin
from xml.etree import ElementTree

import typer.main
from pydantic import BaseModel

import motionfmu.cli
from motionfmu.cards.config import CardConfig
from motionfmu.cli import common
from motionfmu.scenarios import fmus
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
STATUSES = ("FAILED", "WRONG", "STOPPED")
# Tables in results whose names a scenario chooses.
CHOSEN = {
    *("units", "figures", "options.set", "run.components", "run.fmus", "run.wires", "run.files"),
    *("run.settings", "run.drives"),
}
LONGEST = 60  # characters of a start value that are listed
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
        "start": {name: _starts(name) for name in _fmus()},
        "range": {name: _ranges(name) for name in _fmus()},
        "terminal": {name: _terminals(name) for name in _fmus()},
        "command": {name: {"options": found} for name, found in _commands()},
        "status": {"motionfmu": {str(getattr(common, n)): [n] for n in STATUSES}},
        "environment": {"motionfmu": {"variables": _environment()}},
        "file": {name: {"keys": sorted(_keys(model))} for name, model in FILES.items()},
        "written": {name: {"names": found} for name, found in _written().items()},
        "python": {name: {"names": found} for name, found in _packages()},
        "c": {"mccl.h": {"functions": _functions(ROOT / "build/include/motionfmu/mccl.h")}},
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


def _starts(fmu: str) -> dict[str, list[str]]:
    """Names of an FMU's variables by the value that they start with; long arrays by their hash."""
    found = defaultdict(list)
    for port in fmus.ports(fmu).values():
        if port.start is None or port.causality not in ("parameter", "input"):
            continue
        values = [port.start] if port.type == "String" else port.start.split()
        text = " ".join(values if len({*values}) > 1 else values[:1])
        if len(text) > LONGEST:
            short = hashlib.sha256(text.encode()).hexdigest()[:8]
            text = f"{len(values)} numbers, sha256 {short}"
        found[text].append(port.name)
    return {said: sorted(names) for said, names in sorted(found.items())}


def _ranges(fmu: str) -> dict[str, list[str]]:
    """Names of an FMU's parameters by their range, where they have one."""
    found = defaultdict(list)
    for port in fmus.ports(fmu).values():
        bounded = math.isfinite(port.low) or math.isfinite(port.high)
        if port.causality == "parameter" and bounded:
            found[f"{port.low!r} to {port.high!r}"].append(port.name)
    return {said: sorted(names) for said, names in sorted(found.items())}


def _terminals(fmu: str) -> dict[str, list[str]]:
    """Members of an FMU's terminals, and their variables, by terminal and kind."""
    return {
        f"{t.name}, {t.kind}": sorted(f"{member}={variable}" for member, variable in t.members)
        for t in fmus.terminals_of(fmu)
    }


def _environment() -> list[str]:
    """The project's own variables of the environment that the package reads."""
    text = "".join(f.read_text() for f in (ROOT / "src/motionfmu").rglob("*.py"))
    return sorted(set(re.findall(r'"(MOTIONFMU_[A-Z]+)"', text)))


def _written() -> dict[str, list[str]]:
    """Names in what commands write and print of the demo and its program."""
    demo = str(ROOT / "scenarios/circle")
    with tempfile.TemporaryDirectory() as place, chdir(place):
        _motionfmu("run", demo, "--engine", "native", "-o", "a", "-q")
        files = {name: Path("a", name).read_text() for name in ("result.json", "contour.json")}
        files["check --json"] = _motionfmu(
            "check", demo, "--engine", "native", "--json", "--junit", "a.xml"
        )
        files["compare --json"] = _motionfmu("compare", "a", "a", "--json", "-o", "b")
        read = _motionfmu("gcode", f"{demo}/circle.ngc", "--json", "-o", "c")
        files["gcode --json"] = json.dumps([*json.loads(read).values()])
        found = {name: _names(json.loads(text)) for name, text in files.items()}
        junit = ElementTree.parse("a.xml").iter()
        words = {w for e in junit for w in (e.tag, *(f"{e.tag}.{a}" for a in e.attrib))}
        return found | {"check --junit": sorted(words)}


def _motionfmu(*line: str) -> str:
    """What a command prints."""
    told = io.StringIO()
    with redirect_stdout(told), redirect_stderr(io.StringIO()), suppress(SystemExit):
        motionfmu.cli.app(line)
    return told.getvalue()


def _names(value: Any) -> list[str]:
    """Names in JSON, those of an inner table behind a dot; tables by chosen names are left out."""

    def inner(value: Any, path: str) -> Iterator[str]:
        for item in value if isinstance(value, list) else ():
            yield from inner(item, path)
        for key, item in value.items() if isinstance(value, dict) else ():
            whole = f"{path}.{key}".removeprefix(".")
            if path not in CHOSEN:
                yield whole
                yield from inner(item, whole)

    return sorted(set(inner(value, "")))


def _functions(header: Path) -> list[str]:
    """Functions of a header with the names of the published library, those of macros, too."""
    command = ["cc", "-E", "-dD", "-I", str(header.parent), str(header)]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    name = r"(MCC_[A-Z]\w*[a-z]\w*)"
    return sorted(
        {*re.findall(rf"\b{name}\(", text), *re.findall(rf"^#define {name} ", text, re.M)}
    )


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
                package = ".".join(file.parent.relative_to(ROOT / "src").parts)
                listed = [n for n in ast.literal_eval(line.value) if not n.startswith("_")]
                module = importlib.import_module(package)
                members = (f"{n}.{m}" for n in listed for m in _members(getattr(module, n)))
                yield package, [*listed, *members]


def _members(of: Any) -> list[str]:
    """Methods with a docstring and fields of a class of ours, those inherited from ours, too."""
    if not inspect.isclass(of):
        return []
    found: set[str] = set()
    for kind in of.__mro__:
        if kind.__module__.partition(".")[0] == "motionfmu":
            found |= {n for n, member in vars(kind).items() if _told(member)}
    if dataclasses.is_dataclass(of):
        found |= {f.name for f in dataclasses.fields(of)}
    if issubclass(of, enum.Enum):
        found |= {*of.__members__}
    found |= {*getattr(of, "model_fields", ()), *getattr(of, "_fields", ())}
    return sorted(n for n in found if not n.startswith("_"))


def _told(member: Any) -> bool:
    kinds = (property, cached_property, classmethod, staticmethod)
    called = inspect.isfunction(member) or isinstance(member, kinds)
    return called and bool(getattr(member, "__doc__", None))


def missing(promised: Surface, there: Surface) -> list[str]:
    """What was promised and is not there: kind, place, what was said of it, name."""
    return [
        f"{kind} {place}: {name} ({said})"
        for kind, places in promised.items()
        for place, rows in places.items()
        for said, names in rows.items()
        for name in sorted({*names} - {*_kept(kind, said, there.get(kind, {}).get(place, {}))})
    ]


def _kept(kind: str, said: str, rows: dict[str, list[str]]) -> Iterable[str]:
    """Names of which that is still true; a range may grow, or go."""
    if kind != "range":
        return rows.get(said, [])
    low, high = map(float, said.split(" to "))
    return [n for now, names in rows.items() if _holds(now, low, high) for n in names]


def _holds(now: str, low: float, high: float) -> bool:
    least, most = map(float, now.split(" to "))
    return least <= low and high <= most


def written(found: Surface) -> str:
    """As TOML."""
    lines = ["# What 0.2 has that docs/stability.md promises; tests/helpers/promised_surface.py."]
    for kind, places in found.items():
        for place, rows in sorted(places.items()):
            lines.append(f'\n[{kind}."{place}"]')
            for said, names in rows.items():
                listed = ", ".join(json.dumps(name, ensure_ascii=False) for name in names)
                head = json.dumps(said, ensure_ascii=False)
                one = f"{head} = [{listed}]"
                many = textwrap.fill(listed, 96, **_AS_A_LIST)
                lines.append(one if len(one) <= 100 else f"{head} = [\n{many},\n]")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.stdout.write(written(surface()))
