"""The description of an FMU made from a Modelica class."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from motionfmu.base.errors import Faults
from motionfmu.base.toml_lines import ordered, shown, tables_of, text_of
from motionfmu.fmu import agree, describe, terminals
from motionfmu.fmu.head import line_of, matches, wrong_head, wrong_keys
from motionfmu.fmu.modelica import causal
from motionfmu.fmu.modelica.flat import Declaration
from motionfmu.fmu.modelica.ode import Ode

_TYPES = {"Real": "f64", "Integer": "i32", "Boolean": "bool"}
_KEYS = ("name", "description", "tick_ns", "experiment", "modelica", "instances", "micro_step")
_OPTIONAL = ("tolerance", "tunable", "terminal", "agree")
INSTANCES_MAX = 64


@dataclass(frozen=True)
class Packing:
    """What fmu.toml says about a Modelica FMU."""

    name: str  # of the FMU
    description: str
    tick_ns: int  # its steps are whole multiples of this [ns]
    experiment: dict[str, float]  # default `stop` and `step` [s]
    modelica: str  # full class name
    instances: int  # copies of the class, one per axis; a single one has scalars instead of arrays
    micro_step: float  # default grid of the integrator [s]
    package: Path  # folder of the Modelica package
    # error of one integrator step, as a share of what is large for a state: the steps follow it.
    # None: equal steps
    tolerance: float | None = None
    tunable: list[str] = field(default_factory=list)  # Real parameters that may change in a run
    terminal: dict[str, Any] = field(default_factory=dict)  # as in every fmu.toml
    agree: dict[str, Any] = field(default_factory=dict)  # likewise


def read(toml: Path) -> Packing:
    """Read an fmu.toml with a key ``modelica``; faults are lines ``file:line: what``."""
    text = text_of(toml)
    doc, faults = tables_of(text, toml), Faults()
    faults.lines += wrong_keys(doc, (_KEYS, _OPTIONAL), text, str(toml))
    faults.lines += wrong_head(doc, text, str(toml))

    def look(key: str, good: Callable[[Any], bool], what: str) -> bool:
        if key in doc and not good(doc[key]):
            told = f"{key} {shown(doc[key])} {what}"
            faults.lines.append(f"{toml}:{line_of(text, key)}: {told}")
        return key in doc and good(doc[key])

    whole = f"is not a positive integer, {INSTANCES_MAX} at most"
    look("instances", lambda x: type(x) is int and 1 <= x <= INSTANCES_MAX, whole)
    look("micro_step", _step, "is not a positive number")
    look("tolerance", _tolerance, "is not a number from 1e-12 to 0.01")
    look("tunable", _names, "is not a list of names, each once")
    if look("modelica", lambda x: matches(r"\w+(\.\w+)+", x), "is not a class name"):
        top = doc["modelica"].split(".")[0]
        places = [p / "modelica" / top for p in toml.resolve().parents]
        package = next((p for p in places if (p / "package.mo").is_file()), None)
        if package is not None and not faults.lines:
            return Packing(**doc, package=package)
        if package is None:
            told = f"there is no package modelica/{top} above this file"
            faults.lines.append(f"{toml}:{line_of(text, 'modelica')}: {told}")
    Faults(ordered(faults.lines, [str(toml)])).tell()
    raise AssertionError("a file without a class is refused")


def _step(x: Any) -> bool:
    return type(x) in (float, int) and math.isfinite(x) and x > 0


def _names(x: Any) -> bool:
    good = isinstance(x, list) and all(isinstance(n, str) for n in x)
    return good and len(set(x)) == len(x)


def _tolerance(x: Any) -> bool:
    return isinstance(x, float) and 1e-12 <= x <= 1e-2


def from_modelica(toml: Path) -> describe.Description:
    """Make the description of the Modelica FMU of an fmu.toml; see `describe_class`."""
    packing = read(toml)
    return describe_class(toml, packing, causal.load(packing.package, packing.modelica))


def describe_class(toml: Path, packing: Packing, ode: Ode) -> describe.Description:
    """Describe a Modelica FMU; its fmu.toml is named in messages.

    Its parameters ``active`` and ``micro_step``, then all that the class declares, one element per
    instance (if there is one instance, as the class has it).
    """
    own: list[tuple[str, str, dict[str, Any]]] = [
        ("active", "parameter", _active(packing.instances)),
        ("micro_step", "parameter", _micro_step(packing)),
    ]
    shown = (None,) * len(ode.outputs)
    for group, values in ((ode.parameters, ode.p0), (ode.inputs, ode.u0), (ode.outputs, shown)):
        for name in dict.fromkeys(d.port for d in group):
            elements = [
                (d, value) for d, value in zip(group, values, strict=True) if d.port == name
            ]
            row = _row(ode, elements, packing.instances)
            tuned = {"tunable": True} if name in packing.tunable else {}
            own.append((name, elements[0][0].kind, row | tuned))
    names = [name for name, _, _ in own]
    try:
        _check_tunable(packing, ode)
        kept = dict.fromkeys(describe.COMMON, 0)
        for name, most in ({"active": 1, "micro_step": 1} | kept).items():
            if names.count(name) > most:
                raise ValueError(f"the name {name} is taken: every plant has it")
        variables = tuple(describe.variable(*row) for row in own)
        joined = terminals.read(packing.terminal, variables)
        shared = agree.read(packing.agree, variables)
    except ValueError as error:
        raise ValueError(f"{toml}: {packing.modelica}: {error}") from None
    return describe.Description(
        packing.name,
        packing.description,
        packing.tick_ns,
        packing.experiment,
        grid="micro_step",
        variables=(*variables, *describe.common(packing.tick_ns)),
        terminals=tuple(joined),
        agree=tuple(shared),
    )


def _check_tunable(packing: Packing, ode: Ode) -> None:
    real = {d.port for d in ode.parameters if d.type == "Real"}
    if unknown := [n for n in packing.tunable if n not in real]:
        raise ValueError(f"tunable: it has no Real parameter {unknown[0]!r}")


def _dims(instances: int) -> list[int]:
    """Array dimensions of a variable; empty for a single copy of the class."""
    return [instances] if instances > 1 else []


def _active(instances: int) -> dict[str, Any]:
    doc = "Axis is used; an unused axis costs nothing and its outputs stay 0"
    return {"type": "bool", "dims": _dims(instances), "start": True, "doc": doc}


def _micro_step(packing: Packing) -> dict[str, Any]:
    return {
        "type": "f64",
        "unit": "s",
        "start": packing.micro_step,
        "min": packing.tick_ns * 1e-9,
        "doc": f"Fixed grid of the integrator; a whole number of {packing.tick_ns} ns",
    }


def _row(
    ode: Ode, elements: list[tuple[Declaration, float | None]], instances: int
) -> dict[str, Any]:
    """A variable, from its elements and their start values, as a row of fmu.toml."""
    d = elements[0][0]
    dims = [*_dims(instances), *d.dims]
    row: dict[str, Any] = {"type": _TYPES[d.type], "dims": dims, "doc": d.description}
    kind = {"Real": float, "Integer": int, "Boolean": bool}[d.type]
    starts = [kind(value) for _, value in elements if value is not None]
    if starts:
        row["start"] = starts * math.prod(_dims(instances)) if d.dims else starts[0]
    if d.type == "Real":
        if not d.unit:
            raise ValueError(f"{ode.name}: {d.name} has no unit")
        row["unit"] = None if d.unit == "1" else d.unit
        row["continuous"] = d.kind != "parameter"
    limits = ode.limits[d.name]
    for other, _ in elements:
        if ode.limits[other.name] != limits:
            what = f"{other.name} has other limits than {d.name}: one port has one minimum"
            raise ValueError(f"{ode.name}: {what}")
    if d.type != "Boolean":
        for key, value in zip(("min", "max", "nominal"), limits, strict=True):
            if value is not None and (key != "nominal" or d.type == "Real"):
                row[key] = kind(value)
    return row
