"""A machine copied so that it stands alone: one file with all its values, and its README."""

import shutil
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from motionfmu.base.new_folder import new_folder
from motionfmu.base.units import spelled
from motionfmu.run.machine_program import Machine
from motionfmu.run.run_plan import RunPlan
from motionfmu.run.saved_scenario import read_files, record_file
from motionfmu.scenarios import package_files
from motionfmu.scenarios.foreign import is_foreign
from motionfmu.scenarios.machine_limits import BOUNDS
from motionfmu.scenarios.port import Port
from motionfmu.scenarios.toml_text import pair_lines, table_lines, value_text
from motionfmu.scenarios.values import start_values

# Keys of a scenario, which a machine's tables get to be checked.
_OF_A_RUN = ("machine", "stop")


def copy_machine(like: Machine, folder: Path) -> None:
    """Write a machine's tables, with what it extends, and its files into a new folder."""
    plan = like.plan()
    document = plan.document
    tables = {k: v for k, v in document.tables.items() if k not in _OF_A_RUN}
    foreign = {c: f for c, f in document.body.component.items() if is_foreign(f)}
    tables["component"] = {**tables["component"], **foreign}
    files = read_files(plan.resolver, tables.get("set", {}))
    tables["set"] = {**tables.get("set", {}), **{n: f.name for n, f in files.items()}}
    if "record_file" in tables:
        files["record_file"] = record_file(plan.resolver)
        tables["record_file"] = {**tables["record_file"], "file": files["record_file"].name}
    about = document.sources[1].about
    with new_folder(folder) as part:
        for file in files.values():
            shutil.copy(file, part)
        lines = [f"# {about}", *_machine_lines(plan, tables)]
        (part / package_files.MACHINE).write_text("\n".join(lines) + "\n", encoding="utf-8")
        text = "\n".join(_readme(plan, folder.name, like.name, about)) + "\n"
        (part / "README.md").write_text(text, encoding="utf-8")


def _machine_lines(plan: RunPlan, tables: Mapping[str, Any]) -> Iterator[str]:
    for key, value in tables.items():
        if not (isinstance(value, dict) or _rows(value)):
            yield from pair_lines(key, value)
    for name, table in tables.items():
        if name == "set":
            yield from _values(plan, table)
        elif isinstance(table, dict) or _rows(table):
            yield from table_lines(name, table)


def _rows(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and isinstance(value[0], dict)


def _values(plan: RunPlan, given: Mapping[str, Any]) -> Iterator[str]:
    """All parameters with their meaning; those that the machine leaves as they are are comments."""
    yield from ("", "# A value in a comment is the FMU's own; without the # it is the machine's.")
    yield "[set]"
    left = dict(given)
    for component, ports in plan.resolver.ports.items():
        yield f"# {component}: {plan.document.body.component[component]}"
        for port in ports.values():
            name = f"{component}.{port.name}"
            about = f"  # {_about(port)}"
            if name in left:
                yield f"{value_text(name)} = {value_text(left.pop(name))}{about}"
            elif port.causality == "parameter" and not port.file:
                yield f"# {value_text(name)} = {value_text(_start(port))}{about}"
        for name in [n for n in left if n.startswith(f"{component}.")]:  # elements of arrays
            yield f"{value_text(name)} = {value_text(left.pop(name))}"


def _about(port: Port) -> str:
    unit = spelled(port.unit)
    return f"[{unit}] {port.doc}" if unit else port.doc


def _start(port: Port) -> Any:
    """The start value, one for all elements if they are equal."""
    values = list(start_values(port))
    return values[0] if len(set(values)) == 1 else values


def _readme(plan: RunPlan, name: str, like: str, about: str) -> Iterator[str]:
    """A data sheet: the axes and what limits them."""
    yield from (f"# {name}", "", about, "")
    yield f"Made from {like} by `motionfmu new machine {name} --like {like}`; it stands alone, and"
    yield "all its values are in [machine.toml](machine.toml). `motionfmu machines` with its folder"
    yield "measures it: positioning, circles, margins and steps of its loops, or poses of a robot."
    rows = plan.axis_limits()
    axes = list(dict.fromkeys(x.axis.name for x in rows))
    if axes:
        yield from ("", f"| limit | {' | '.join(axes)} |", "|" + "---|" * (len(axes) + 1))
    for figure in dict.fromkeys(x.figure for x in rows):
        mine = [x for x in rows if x.figure == figure]
        for key in BOUNDS:
            values = [getattr(x, key) for x in mine]
            if any(v is not None for v in values):
                cells = ("" if v is None else f"{v:.6g}" for v in values)
                what = figure if key == "limit" else f"{figure}, {key}"
                yield f"| {what} [{spelled(mine[0].unit) or '1'}] | {' | '.join(cells)} |"
