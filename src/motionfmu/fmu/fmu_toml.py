"""Reads the description of an FMU: its `fmu.toml`."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

from motionfmu.base.errors import Faults, InputError, suggestion
from motionfmu.base.toml_lines import ordered, shown, tables_of, text_of
from motionfmu.fmu import agree, terminals
from motionfmu.fmu.describe import CAUSALITIES, COMMON, Description, Variable, common, variable
from motionfmu.fmu.head import line_of, matches, wrong_head, wrong_keys

HEAD = {"name", "description", "tick_ns", "experiment", "cores"}
MAY = {"grid", "terminal", "agree"}
_CORE = r"[a-z][a-z0-9_]{0,63}"


def _variables(
    rows: list[tuple[str, str, Any]],
) -> tuple[list[Variable], list[tuple[str, str]]]:
    """The variables of all rows, and what is wrong with rows, by name."""
    variables: list[Variable] = []
    wrong: list[tuple[str, str]] = []
    names: set[str] = set()
    for causality, name, row in rows:
        try:
            variables.append(variable(name, causality, row))
        except InputError as error:
            wrong += ((name, told) for told in error.args)
        if name in COMMON:
            wrong.append((name, f"the name {name} is taken: every FMU has it"))
        if name in names:
            wrong.append((name, f"{name} is described twice"))
        names.add(name)
    return variables, wrong


def parse(text: str, file: str = "fmu.toml") -> Description:
    """Read the text of an fmu.toml; an InputError has a line ``file:line: what`` for each fault."""
    doc, faults = tables_of(text, file), Faults()
    rows = []
    for causality in CAUSALITIES:
        table = doc.pop(causality, {})
        if isinstance(table, dict):
            rows += [(causality, name, row) for name, row in table.items()]
        else:
            where = line_of(text, causality)
            faults.lines.append(f"{file}:{where}: {causality} = {shown(table)} is no table")
    faults.lines += wrong_keys(doc, (HEAD, MAY, set(CAUSALITIES)), text, file)
    faults.lines += wrong_head(doc, text, file)
    cores = doc.get("cores", [])
    if not isinstance(cores, list) or not all(matches(_CORE, core) for core in cores):
        told = f"cores {shown(cores)}: names of folders wanted"
        faults.lines.append(f"{file}:{line_of(text, 'cores')}: {told}")
    variables, wrong = _variables(rows)
    faults.lines += (f"{file}:{line_of(text, name)}: {told}" for name, told in wrong)
    periods = {n for causality, n, row in rows if causality == "parameter" and _real(row)}
    if "grid" in doc and doc["grid"] not in periods:
        told = f"grid {shown(doc['grid'])}: the name of a parameter of type f64 wanted"
        told += suggestion(str(doc["grid"]), periods)
        faults.lines.append(f"{file}:{line_of(text, 'grid')}: {told}")
    joined = placed(faults, text, file, lambda: terminals.read(doc.pop("terminal", {}), variables))
    shared = placed(faults, text, file, lambda: agree.read(doc.pop("agree", {}), variables))
    Faults(ordered(faults.lines, [file])).tell()
    return Description(
        **{**doc, "cores": tuple(cores)},
        variables=(*variables, *common(doc["tick_ns"])),
        terminals=tuple(joined),
        agree=tuple(shared),
    )


def placed(faults: Faults, text: str, file: str, read: Callable[[], list[Any]]) -> list[Any]:
    """The result of a reader of tables, whose faults, ``table name: what``, get file and line."""
    try:
        return read()
    except InputError as error:
        for told in error.args:
            key = ".".join(told.partition(":")[0].split(" ")[:2])
            faults.lines.append(f"{file}:{line_of(text, key)}: {told}")
        return []


def _real(row: Any) -> bool:
    return isinstance(row, dict) and row.get("type") == "f64"


def names_modelica(text: str) -> bool:
    """Whether the text of an fmu.toml takes its variables from a Modelica class."""
    return re.search(r"^modelica\s*=", text, re.MULTILINE) is not None


def load(path: str | Path) -> Description:
    """Read the description in an fmu.toml, or of the Modelica class that it names."""
    text = text_of(path)
    if names_modelica(text):
        from motionfmu.fmu.modelica import class_description

        return class_description.from_modelica(Path(path))
    return parse(text, str(path))
