"""Quantities of a machine that several FMUs describe: the variable that states each of them."""

from collections.abc import Sequence
from typing import Any

from motionfmu.base.errors import Faults, InputError, suggestion
from motionfmu.base.toml_lines import shown
from motionfmu.fmu.describe import Variable

SAYS = ("parameter", "output")


def read(table: Any, variables: Sequence[Variable]) -> list[tuple[str, str | float]]:
    """Quantities of the tables ``[agree.THING]`` of an fmu.toml: a variable, or a value [SI].

    ``[agree.arm]`` with ``start = "start_joint"`` says that this FMU takes its parameter
    start_joint as the quantity arm.start, ``level = 0`` that it has no other level than 0.
    An output would state the quantity over time.
    An InputError has a line for each fault.
    """
    if not isinstance(table, dict):
        raise InputError(f"agree {shown(table)} is no table")
    faults, found = Faults(), []
    numbers = [v.name for v in variables if v.causality in SAYS and v.type in ("f64", "i32")]
    for thing, row in table.items():
        if not isinstance(row, dict) or not row:
            faults.lines.append(f"agree {thing}: {shown(row)}: variables by quantity wanted")
            continue
        for quantity, name in row.items():
            fixed = isinstance(name, int | float) and not isinstance(name, bool)
            if not fixed and name not in numbers:
                told = f"agree {thing}: {quantity} = {shown(name)}: no such numeric parameter"
                told += " or output"
                faults.lines.append(told + suggestion(str(name), numbers))
            found.append((f"{thing}.{quantity}", name))
    faults.tell()
    return found
