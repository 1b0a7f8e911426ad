"""A program on a machine written as a scenario of its own."""

import filecmp
import os
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from motionfmu.analysis.gcode.subprogram_files import called
from motionfmu.base.errors import InputError
from motionfmu.base.new_folder import new_folder
from motionfmu.run.program_translation import GCODE
from motionfmu.run.run_plan import Options, RunPlan
from motionfmu.scenarios import package_files, record_signals
from motionfmu.scenarios.system import Resolver
from motionfmu.scenarios.table_sources import OF_A_SIGNAL
from motionfmu.scenarios.toml_text import document_lines


def save_scenario(plan: RunPlan, folder: Path, options: Options) -> None:
    """Write a scenario.toml and the files that it reads; the folder must not be there."""
    document = plan.document
    tables = _tables(document.sources[0].tables, options)
    machine = Path(tables.pop("machine"))
    tables.pop("drawing", None)  # it is in the program that was made
    with new_folder(folder) as part:
        tables = copied_files(plan, tables, part, folder)
        top = {"machine": _machine_name(machine, folder.absolute())}
        lines = [f"# {document.about}.", *document_lines(top | tables)]
        (part / package_files.SCENARIO).write_text("\n".join(lines) + "\n", encoding="utf-8")


def copied_files(
    plan: RunPlan, tables: Mapping[str, Any], part: Path, folder: Path
) -> dict[str, Any]:
    """Copy the files that tables name into a part of a folder; the tables with their names."""
    values = tables.get("set", {})
    files = read_files(plan.resolver, values)
    found = {**tables, "set": {**values, **{name: file.name for name, file in files.items()}}}
    if begin := tables.get("begin"):
        files["begin"] = plan.document.beside(begin) or Path(begin)
        found["begin"] = files["begin"].name
    if "record_file" in tables:
        files["record_file"] = record_file(plan.resolver)
        found["record_file"] = {**tables["record_file"], "file": files["record_file"].name}
    for file in [*files.values(), *(c for f in files.values() for c in _called(f))]:
        if not (part / file.name).exists():
            shutil.copyfile(file, part / file.name)
        elif not filecmp.cmp(file, part / file.name, False):
            raise InputError(f"{folder}: two files {file.name} would stand there")
    return found


def record_file(resolver: Resolver) -> Path:
    """The file of a record that goes with a copy; the folder of a result does not."""
    file = record_signals.file_of(resolver)
    if file.is_dir():
        raise InputError(f"{file}: a result's folder does not go with a copy: save its record")
    return file


def _tables(own: Mapping[str, Any], options: Options) -> dict[str, Any]:
    """The tables of a scenario that runs as these options say."""
    tables = {k: v for k, v in own.items() if options.stop is None or k not in OF_A_SIGNAL}
    tables["set"] = {**own.get("set", {}), **options.set}
    given = {"stop": options.stop, "step": options.step}
    tables |= {k: v for k, v in given.items() if v is not None}
    if options.every is not None:
        tables["record"] = {**own.get("record", {}), "every": options.every}
    return tables


def _machine_name(file: Path, folder: Path) -> str:
    """How a scenario in a folder names a machine: by its name in the library, else by its path."""
    if file.parent.parent in (package_files.MACHINES, package_files.RIGS):
        return file.parent.name
    return os.path.relpath(file.parent, folder)


def _called(file: Path) -> list[Path]:
    """Files that a part program calls."""
    return called(file) if file.suffix.lower() in GCODE else []


def read_files(resolver: Resolver, values: Mapping[str, Any]) -> dict[str, Path]:
    """Files that values name and FMUs read, by the names of the values."""
    found = {}
    for name, value in values.items():
        whole, _ = resolver.split(name)
        end = resolver.end(whole, "set", name)
        file = resolver.document.beside(value) if isinstance(value, str) else None
        if end.port.file == "read" and file:
            found[name] = file
    return found
