"""Reads the description of an FMU: its `fmu.toml`."""

import math
import re
from pathlib import Path
from typing import Any

from motionfmu.describe import CAUSALITIES, Description, variable
from motionfmu.errors import InputError
from motionfmu.toml_lines import shown, tables_of, text_of

HEAD = {"name", "description", "tick_ns", "experiment", "cores"}
MAY = {"grid"}
TICK_MAX = 1_000_000_000  # [ns]
_NAME = r"[A-Z][A-Za-z0-9]{0,63}"  # it is part of the name of C functions and of files
_CORE = r"[a-z][a-z0-9_]{0,63}"


def parse(text: str, file: str = "fmu.toml") -> Description:
    """Read the text of an fmu.toml.

    Parameters
    ----------
    text : str
        TOML.
    file : str
        Name used in messages.

    Returns
    -------
    Description

    Raises
    ------
    ValueError
        Anything wrong, as ``file:line: what``.
    """
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
        if not isinstance(doc["cores"], list) or not _matches(_CORE, core):
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


def check_head(doc: dict[str, Any], text: str, file: str) -> None:
    """Check what an fmu.toml says about the FMU as a whole.

    Parameters
    ----------
    doc : dict
        With name, description, tick_ns and experiment.
    text, file : str
        For the line and the name of the file in messages.

    Raises
    ------
    InputError
        ``file:line: what``.
    """

    def refuse(key: str, what: str) -> InputError:
        return InputError(f"{file}:{line_of(text, key)}: {key} {shown(doc[key])} {what}")

    if not _matches(_NAME, doc["name"]):
        raise refuse("name", "is not CamelCase")
    if not isinstance(doc["description"], str) or not doc["description"].isprintable():
        raise refuse("description", "is not a line of text")
    tick = doc["tick_ns"]
    if not isinstance(tick, int) or isinstance(tick, bool) or not 1 <= tick <= TICK_MAX:
        raise refuse("tick_ns", f"is not a positive integer, {TICK_MAX} at most")
    experiment = doc["experiment"]
    good = isinstance(experiment, dict) and set(experiment) == {"stop", "step"}
    if not good or not all(_positive(x) for x in experiment.values()):
        raise refuse("experiment", "is not { stop = seconds, step = seconds }")


def _positive(x: Any) -> bool:
    number = isinstance(x, float | int) and not isinstance(x, bool)
    return number and 0.0 < x < math.inf


def _matches(pattern: str, x: Any) -> bool:
    return isinstance(x, str) and re.fullmatch(pattern, x) is not None


def line_of(text: str, key: str) -> int:
    """Line of a key or table.

    Parameters
    ----------
    text : str
        The file.
    key : str

    Returns
    -------
    int
        0 if there is none.
    """
    for number, line in enumerate(text.split("\n"), 1):
        if re.match(rf"\s*\[?[\"']?{re.escape(key)}[\"']?\s*[=\].]", line):
            return number
    return 0


def names_modelica(text: str) -> bool:
    """Whether an fmu.toml takes its variables from a Modelica class.

    Parameters
    ----------
    text : str
        The file's text.

    Returns
    -------
    bool
    """
    return re.search(r"^modelica\s*=", text, re.MULTILINE) is not None


def load(path: str | Path) -> Description:
    """Read the description of the FMU whose fmu.toml is at `path`.

    Parameters
    ----------
    path : str or Path
        An fmu.toml; one that names a Modelica class takes its variables from there.

    Returns
    -------
    Description

    Raises
    ------
    ValueError
        Anything wrong with the file, as ``file:line: what``.
    """
    text = text_of(path)
    if names_modelica(text):
        from motionfmu.modelica import description

        return description.from_modelica(Path(path))
    return parse(text, str(path))
