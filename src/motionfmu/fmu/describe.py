"""The description of an FMU: its variables, checked."""

import hashlib
import itertools
import json
import math
import re
from collections.abc import Iterator
from dataclasses import asdict, dataclass, field, replace
from typing import Any

from motionfmu.base import units
from motionfmu.base.errors import InputError, suggestion
from motionfmu.base.toml_lines import shown

TYPES = ("f64", "i32", "bool", "string")
CAUSALITIES = ("parameter", "input", "output", "local")
STRING_MAX = 1024  # bytes of a string variable with its end mark; the state is one struct
COUNT_MAX = 65536  # elements of a variable; all of them are in that struct
I32 = 2**31
_KEYS = {"type", "dims", "unit", "start", "min", "max", "nominal", "tunable", "doc"}
_KEYS |= {"values", "file"}
# Generation tool in descriptions, by which FMUs and SSPs of ours are recognised.
TOOL = "motionfmu"
# Reverse domain name before names that no standard has: kinds of terminals, folders.
DOMAIN = "org.motionfmu"
# Type definitions of texts that name a file, by the key `file`: name and meaning.
FILES = {
    "read": (
        "InputFile",
        "File that is read: a path, file:///PATH with percent-encoded UTF-8, or resource:NAME, "
        "which is NAME in the FMU's resources",
    ),
    "written": (
        "OutputFile",
        "File that is written: a path, or file:///PATH with percent-encoded UTF-8",
    ),
}

Scalar = float | int | bool | str
STRICT, BEGIN = "strict_step", "begin_state"
COMMON = STRICT, BEGIN  # parameters that every FMU has


def element_names(name: str, dims: tuple[int, ...]) -> list[str]:
    """Structured names of a variable's elements: ``x[1]``, ``x[1,2]``; of a scalar its own."""
    if not dims:
        return [name]
    ranges = [range(1, d + 1) for d in dims]
    return [f"{name}[{','.join(map(str, index))}]" for index in itertools.product(*ranges)]


@dataclass(frozen=True)
class Variable:
    """One variable of an FMU."""

    name: str  # snake_case
    causality: str  # one of `CAUSALITIES`
    type: str  # one of `TYPES`
    doc: str
    dims: tuple[int, ...] = ()  # empty for a scalar
    unit: str | None = None  # see `motionfmu.base.units.parse`; f64 only
    start: list[Any] | None = None  # one per element (row-major); None for outputs and locals
    min: float | int | None = None  # limits that a set call must keep
    max: float | int | None = None
    nominal: float | None = None  # the usual size
    tunable: bool = False  # a parameter that may change while running
    # an f64 that changes between communication points (plants); else discrete
    continuous: bool = False
    declared: tuple[str, str] | None = None  # its type: name and meaning, of files and of numbers

    @property
    def count(self) -> int:
        """Number of elements."""
        return math.prod(self.dims)

    @property
    def variability(self) -> str:
        """FMI variability."""
        if self.causality == "parameter":
            return "tunable" if self.tunable else "fixed"
        return "continuous" if self.continuous and self.type == "f64" else "discrete"

    @property
    def initial(self) -> str | None:
        """FMI attribute `initial`; inputs have none."""
        return {"parameter": "exact", "output": "calculated", "local": "calculated"}.get(
            self.causality
        )

    def element_names(self) -> list[str]:
        """Structured names of the elements."""
        return element_names(self.name, self.dims)


@dataclass(frozen=True)
class Terminal:
    """Variables that are connected together with those of the same names of another FMU."""

    name: str  # snake_case
    kind: str  # what it can be connected to; both sides have the same word
    doc: str
    members: tuple[tuple[str, str], ...]  # name of the member, variable
    every: bool = True  # both sides have the same members; else one may have fewer


@dataclass(frozen=True)
class Description:
    """All that an importing tool may know about an FMU."""

    name: str  # CamelCase, also the model identifier
    description: str
    tick_ns: int  # its steps are whole multiples of this [ns]
    experiment: dict[str, float]  # default `stop` and `step` [s]
    cores: tuple[str, ...] = ()  # folders under src/ whose C files the model needs
    # name of the parameter that is the grid on which it reads inputs and shows outputs; or empty
    grid: str = ""
    variables: tuple[Variable, ...] = field(default=())
    terminals: tuple[Terminal, ...] = field(default=())
    # quantities that other FMUs of a system describe, too, such as arm.a1, and their parameters
    agree: tuple[tuple[str, str | float], ...] = ()

    @property
    def step(self) -> float:
        """The default grid on which the FMU reads inputs and changes outputs [s]."""
        periods = [v.start[0] for v in self.variables if v.name == self.grid and v.start]
        return float(periods[0]) if periods else self.tick_ns * 1e-9

    @property
    def strict(self) -> str:
        """Name of the parameter that `strict_step` made."""
        return next(v.name for v in self.variables if v.name.rpartition(".")[2] == STRICT)

    @property
    def begin(self) -> str | None:
        """Name of the parameter that names a state to begin in; a system has none."""
        return next((v.name for v in self.variables if v.name == BEGIN), None)

    @property
    def token(self) -> str:
        """GUID / instantiation token: a hash of the parsed description."""
        text = json.dumps(asdict(self), sort_keys=True)
        h = hashlib.sha256(text.encode()).hexdigest()
        return f"{{{h[:8]}-{h[8:12]}-{h[12:16]}-{h[16:20]}-{h[20:32]}}}"

    def references(self) -> list[int]:
        """First value reference of each variable (one per element)."""
        return [0, *itertools.accumulate(v.count for v in self.variables)][:-1]

    @property
    def reference_count(self) -> int:
        """Number of value references, that is of elements."""
        return sum(v.count for v in self.variables)


def strict_step(unit: str, otherwise: str, name: str = STRICT) -> Variable:
    """The parameter of FMUs and systems that says whether steps must be multiples of a unit."""
    doc = f"Refuse communication steps that are no whole multiple of {unit}; else {otherwise}"
    return Variable(name, "parameter", "bool", doc, start=[False])


def common(tick_ns: int) -> tuple[Variable, ...]:
    """The parameters that every FMU has, which follow its own variables."""
    strict = strict_step(f"{tick_ns} ns", "each runs to the nearest, and the next ones catch up")
    doc = "File with a serialized FMU state in which it begins, its time startTime; empty: at rest"
    begin = Variable(BEGIN, "parameter", "string", doc, start=[""], declared=FILES["read"])
    return strict, begin


_KINDS: dict[str, tuple[type, ...]] = {
    "f64": (float, int),
    "i32": (int,),
    "bool": (bool,),
    "string": (str,),
}


def _of_type(kind: str, what: str, value: Any) -> Any:
    """A value of one type; `what` is for the message."""
    fits = isinstance(value, _KINDS[kind]) and (kind == "bool" or not isinstance(value, bool))
    if not fits:
        raise ValueError(f"{what} {shown(value)} is not of type {kind}")
    if kind == "i32" and not -I32 <= value < I32:
        raise ValueError(f"{what} {value!r} is not within 32 bits")
    if kind == "string" and ("\0" in value or len(value.encode()) >= STRING_MAX):
        raise ValueError(f"{what} {shown(value)} is not a text of less than {STRING_MAX} bytes")
    kinds: dict[str, Any] = {"f64": float, "i32": int, "bool": bool, "string": str}
    return kinds[kind](value)


def _check_value(variable: Variable, value: Any) -> Scalar:
    checked = _of_type(variable.type, "start", value)
    if isinstance(checked, float | int) and not isinstance(checked, bool):
        low = -math.inf if variable.min is None else variable.min
        high = math.inf if variable.max is None else variable.max
        if not low <= checked <= high:
            raise ValueError(f"start {value!r} is outside {low} .. {high}")
    return checked


def _dims(given: Any) -> tuple[int, ...]:
    """Check array dimensions; an array may not be too large for the FMU's state."""
    if given == ():
        return ()
    whole = isinstance(given, list | tuple) and all(type(n) is int and n >= 1 for n in given)
    if not whole or len(given) > 2 or math.prod(given) > COUNT_MAX:
        text = f"one or two positive numbers, {COUNT_MAX} elements at most, wanted"
        raise ValueError(f"dims {shown(given)}: {text}")
    return tuple(given)


# CCN 17: a row of rules that know nothing of each other, each with its message.
def _wrong(causality: str, name: str, row: dict[str, Any]) -> Iterator[str]:
    """Faults of a row, apart from its start values and from names that stand twice."""
    for key in sorted(set(row) - _KEYS - {"continuous"}):
        yield f"unknown key {key!r}{suggestion(key, _KEYS)}"
    if not re.fullmatch(r"[a-z][a-z0-9_]*", name):
        yield "a name is snake_case"
    if not row.get("doc"):
        if not any("'doc'?" in suggestion(key, _KEYS) for key in set(row) - _KEYS):
            yield "doc is missing"
    elif not isinstance(row["doc"], str) or not row["doc"].isprintable():
        yield f"doc {shown(row['doc'])} is not a line of text"
    for key in ("tunable", "continuous"):
        if not isinstance(row.get(key, False), bool):
            yield f"{key} {shown(row[key])} is not true or false"
    if causality in ("output", "local") and row.get("start") is not None:
        yield "it is calculated and has no start"
    if row.get("type") not in TYPES:
        kind = row.get("type")
        close = suggestion(kind, TYPES) if isinstance(kind, str) else ""
        yield f"type {shown(kind)} is not one of {', '.join(TYPES)}{close}"
        return
    checks = (_check_unit, _check_limits, _check_nominal, _check_values, _check_file)
    for check in (*checks, lambda r: _dims(r.get("dims") or ())):
        try:
            check(row)
        except ValueError as error:
            yield str(error)


def _check_unit(row: dict[str, Any]) -> None:
    if row.get("unit") is not None:
        if row["type"] != "f64" or not isinstance(row["unit"], str):
            raise ValueError(f"unit {shown(row['unit'])} on type {row['type']}")
        units.parse(row["unit"])


def _check_limits(row: dict[str, Any]) -> None:
    """Refuse limits that are no numbers of the variable's type."""
    for key in ("min", "max"):
        if row.get(key) is not None:
            if row["type"] not in ("f64", "i32"):
                raise ValueError(f"{key} {shown(row[key])} on type {row['type']}")
            if not math.isfinite(_of_type(row["type"], key, row[key])):
                raise ValueError(f"{key} {row[key]!r} is not finite")


def _check_nominal(row: dict[str, Any]) -> None:
    """Refuse a nominal value that is not positive, or of a variable that is no f64."""
    if (nominal := row.get("nominal")) is not None:
        size = _of_type("f64", "nominal", nominal)
        if row["type"] != "f64" or not 0.0 < float(size) < math.inf:
            raise ValueError(f"nominal {shown(nominal)} is not a positive size of an f64")


def _meanings(row: dict[str, Any]) -> dict[int, str]:
    """The meaning of each number, from a list that counts from 0, or from a table."""
    given = row.get("values")
    rows = enumerate(given) if isinstance(given, list) else (given or {}).items()
    return {int(number): text for number, text in rows}


def _check_values(row: dict[str, Any]) -> None:
    """Refuse meanings that are no texts, or of a variable that is no i32 without limits."""
    if (given := row.get("values")) is None:
        return
    if row["type"] != "i32" or {"min", "max"} & set(row):
        raise ValueError("values are those of an i32, in place of min and max")
    table = isinstance(given, dict) and all(re.fullmatch(r"-?\d{1,9}", key) for key in given)
    texts = given if isinstance(given, list) else given.values() if table else []
    if not texts or not all(isinstance(x, str) and x and x.isprintable() for x in texts):
        raise ValueError(f"values {shown(given)}: texts wanted, a list from 0 on or by numbers")


def _check_file(row: dict[str, Any]) -> None:
    if (given := row.get("file")) is not None and (row["type"], given in FILES) != ("string", True):
        raise ValueError(f"file {shown(given)} on type {row['type']}: a string is read or written")


def _typed(name: str, causality: str, row: dict[str, Any]) -> dict[str, Any]:
    """A row in which the type that `values` or `file` declare stands in place of them."""
    plain = {k: v for k, v in row.items() if k not in ("values", "file")}
    if "file" in row:
        plain["declared"] = FILES[row["file"]]
    if meanings := _meanings(row):
        text = ", ".join(f"{number} {word}" for number, word in sorted(meanings.items()))
        plain["declared"] = "".join(part.capitalize() for part in name.split("_")), text
        plain["doc"] = f"{row['doc']}: {text}"
        if causality in ("parameter", "input"):
            plain |= {"min": min(meanings), "max": max(meanings)}
    return plain


def variable(name: str, causality: str, row: dict[str, Any]) -> Variable:
    """Make a Variable from a row as in fmu.toml.

    An InputError has a line for each fault, with the variable, the reason and the value.
    """
    if not isinstance(row, dict):
        raise InputError(f"{causality} {name}: {shown(row)} is no table")
    told = list(_wrong(causality, name, row))
    found: Variable | None = None
    if not told:
        own = _typed(name, causality, row)
        bare = Variable(
            name, causality, **{**own, "dims": tuple(row.get("dims") or ()), "start": None}
        )
        try:
            found = bare if causality in ("output", "local") else _started(bare, row.get("start"))
        except ValueError as error:
            told = [str(error)]
    if found is None:
        raise InputError(*(f"{causality} {name}: {text}" for text in told))
    return found


def _started(bare: Variable, start: Any) -> Variable:
    """A variable with its start values."""
    if start is None:
        raise ValueError("start is missing")
    values = list(start) if isinstance(start, list) else [start] * bare.count
    if len(values) != bare.count:
        raise ValueError(f"start has {len(values)} values for {bare.count} elements")
    return replace(bare, start=[_check_value(bare, v) for v in values])
