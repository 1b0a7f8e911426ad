"""Reads the description of an FMU: its `fmu.toml`."""

import re
from pathlib import Path

from motionfmu.errors import InputError
from motionfmu.fmu.describe import CAUSALITIES, Description, variable
from motionfmu.fmu.head import check_head, line_of, matches
from motionfmu.toml_lines import shown, tables_of, text_of

HEAD = {"name", "description", "tick_ns", "experiment", "cores"}
MAY = {"grid"}
_CORE = r"[a-z][a-z0-9_]{0,63}"


def parse(text: str, file: str = "fmu.toml") -> Description:
    """Read the text of an fmu.toml; anything wrong is a ValueError, ``file:line: what``."""
    doc = tables_of(text, file)
    rows = []
    for causality in CAUSALITIES:
        table = doc.pop(causality, {})
        if not isinstance(table, dict):
            where = line_of(text, causality)
            raise InputError(f"{file}:{where}: {causality} = {shown(table)} is no table")
        rows += [(causality, name, row) for name, row in table.items()]
    if unknown := sorted(set(doc) - HEAD - MAY):
        raise InputError(f"{file}:{line_of(text, unknown[0])}: unknown key {unknown[0]!r}")
    if missing := sorted(HEAD - set(doc)):
        raise InputError(f"{file}: {missing[0]!r} is missing")
    check_head(doc, text, file)
    for core in doc["cores"] if isinstance(doc["cores"], list) else [doc["cores"]]:
        if not isinstance(doc["cores"], list) or not matches(_CORE, core):
            told = f"cores {shown(doc['cores'])}: names of folders wanted"
            raise InputError(f"{file}:{line_of(text, 'cores')}: {told}")
    variables, names = [], set()
    for causality, name, row in rows:
        try:
            variables.append(variable(name, causality, row))
        except ValueError as error:
            raise InputError(f"{file}:{line_of(text, name)}: {error}") from None
        if name in names:
            raise InputError(f"{file}:{line_of(text, name)}: {name} is described twice")
        names.add(name)
    periods = [v.name for v in variables if v.causality == "parameter" and v.type == "f64"]
    if "grid" in doc and doc["grid"] not in periods:
        told = f"grid {shown(doc['grid'])}: the name of a parameter of type f64 wanted"
        raise InputError(f"{file}:{line_of(text, 'grid')}: {told}")
    return Description(**{**doc, "cores": tuple(doc["cores"])}, variables=tuple(variables))


def names_modelica(text: str) -> bool:
    """Whether the text of an fmu.toml takes its variables from a Modelica class."""
    return re.search(r"^modelica\s*=", text, re.MULTILINE) is not None


def load(path: str | Path) -> Description:
    """Read the description in an fmu.toml, or of the Modelica class that it names."""
    text = text_of(path)
    if names_modelica(text):
        from motionfmu.fmu.modelica import description

        return description.from_modelica(Path(path))
    return parse(text, str(path))
