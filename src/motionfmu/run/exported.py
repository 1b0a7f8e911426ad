"""A scenario's system as one FMU file, for any importer of FMI 2 or 3."""

import json
import os
import re
import zipfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from motionfmu import fused
from motionfmu.errors import InputError
from motionfmu.fmu.pack import RESOURCES, write_whole
from motionfmu.run.prepared import Options, Prepared
from motionfmu.scenarios.fmus import fmu_path
from motionfmu.scenarios.system import Setting
from motionfmu.toml_lines import is_file

PROGRAM = "program.json"  # what a run here reads instead of the description
_LEFT = (PROGRAM, "sources/")  # C text without the parts that it needs
_LICENCE = "documentation/LICENSE"


def export(scenario: Prepared, target: Path, fmi: int, given: Mapping[str, Any]) -> int:
    """Write the system as an FMU; values of the scenario, and those given, are its start values.

    Files that they name become resources. Returns the number of its variables.
    """
    if fmi not in (2, 3):
        raise InputError(f"FMI {fmi!r}: 2 or 3")
    system = scenario.resolved(Options(set=given))
    files: dict[str, Path] = {}
    settings = tuple(_inside(s, files) for s in system.settings)
    try:
        program = fused.exported(
            replace(system, settings=settings), scenario.ends, fmi, identifier(scenario.name)
        )
    except fused.NotFused as why:
        raise InputError(f"{scenario.name} cannot be one FMU: {why}") from None
    packed = {
        name: f
        for f in program.folder.rglob("*")
        if f.is_file() and not (name := str(f.relative_to(program.folder))).startswith(_LEFT)
    }
    packed |= {f"{RESOURCES}/{name}": file for name, file in files.items()}
    readme = scenario.document.file.parent / "README.md"
    if is_file(readme):
        packed["documentation/README.md"] = readme
    licence = _licence(next(iter(system.components.values())))
    write_whole(target, {n: f.read_bytes() for n, f in packed.items()} | {_LICENCE: licence})
    return len(json.loads((program.folder / PROGRAM).read_bytes())["variables"])


def identifier(name: str) -> str:
    """A scenario's name as a model identifier: two_cards is TwoCards."""
    words = re.findall(r"[A-Za-z0-9]+", name)
    joined = "".join(word[:1].upper() + word[1:] for word in words)
    return joined if joined[:1].isalpha() else f"System{joined}"


def _inside(setting: Setting, files: dict[str, Path]) -> Setting:
    """The setting with files as resources, which are added to those there are."""
    values = list(setting.values)
    for k, value in enumerate(values):
        if not (isinstance(value, str) and os.path.isabs(value) and is_file(Path(value))):
            continue
        file, name = Path(value), Path(value).name
        if files.get(name, file) != file:
            name = f"{setting.end.component}.{name}"
        files[name] = file
        values[k] = f"resource:{name}"
    return replace(setting, values=tuple(values))


def _licence(fmu: str) -> bytes:
    """That of the parts, as an FMU carries it."""
    with zipfile.ZipFile(fmu_path(fmu)) as archive:
        return archive.read(_LICENCE)
