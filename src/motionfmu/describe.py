"""The description of an FMU: what `fmu.toml` says, parsed and checked."""

import hashlib
import itertools
import json
import math
import re
import tomllib
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from motionfmu import units

TYPES = ("f64", "i32", "bool", "string")
CAUSALITIES = ("parameter", "input", "output", "local")
STRING_MAX = 1024  # bytes of a string variable with its end mark; the state is one struct
_KEYS = {"type", "dims", "unit", "start", "min", "max", "nominal", "tunable", "doc"}
_HEAD = {"name", "description", "tick_ns", "experiment", "cores"}

Scalar = float | int | bool | str


@dataclass(frozen=True)
class Variable:
    """One variable of an FMU.

    Attributes
    ----------
    name, causality, type, doc : str
        Name (snake_case), one of `CAUSALITIES`, one of `TYPES`, description.
    dims : tuple of int
        Array dimensions, empty for a scalar.
    unit : str or None
        See `motionfmu.units.parse`; f64 only.
    start : list or None
        Start values, one per element (row-major); None for outputs and locals.
    min, max, nominal : float, int or None
        Limits that a set call must keep, and the usual size.
    tunable : bool
        A parameter that may change while running.
    continuous : bool
        An f64 that changes between communication points (plants); else discrete.
    """

    name: str
    causality: str
    type: str
    doc: str
    dims: tuple[int, ...] = ()
    unit: str | None = None
    start: list[Any] | None = None
    min: float | int | None = None
    max: float | int | None = None
    nominal: float | None = None
    tunable: bool = False
    continuous: bool = False

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
        """Structured names of the elements: ``x[1]``, ``x[1,2]``."""
        if not self.dims:
            return [self.name]
        ranges = [range(1, d + 1) for d in self.dims]
        return [f"{self.name}[{','.join(map(str, index))}]" for index in itertools.product(*ranges)]


@dataclass(frozen=True)
class Description:
    """All that an importing tool may know about an FMU.

    Attributes
    ----------
    name, description : str
        Model name (CamelCase, also the model identifier) and what it is.
    tick_ns : int
        Every communication step is a whole multiple of it [ns].
    experiment : dict
        Default ``stop`` and ``step`` [s].
    cores : tuple of str
        Folders under src/ whose C files the model needs.
    variables : tuple of Variable
    """

    name: str
    description: str
    tick_ns: int
    experiment: dict[str, float]
    cores: tuple[str, ...] = ()
    variables: tuple[Variable, ...] = field(default=())

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


def _check_value(variable: Variable, value: Any) -> Scalar:
    kinds: dict[str, tuple[type, ...]] = {
        "f64": (float, int),
        "i32": (int,),
        "bool": (bool,),
        "string": (str,),
    }
    if not isinstance(value, kinds[variable.type]) or (
        isinstance(value, bool) and variable.type != "bool"
    ):
        raise ValueError(f"start {value!r} is not of type {variable.type}")
    if isinstance(value, float | int) and not isinstance(value, bool):
        low = -math.inf if variable.min is None else variable.min
        high = math.inf if variable.max is None else variable.max
        if not low <= value <= high:
            raise ValueError(f"start {value!r} is outside {low} .. {high}")
        return float(value) if variable.type == "f64" else int(value)
    return bool(value) if variable.type == "bool" else str(value)


def variable(name: str, causality: str, row: dict[str, Any]) -> Variable:
    """Make a Variable from one row of a description.

    Parameters
    ----------
    name : str
        Variable name.
    causality : str
        One of `CAUSALITIES`.
    row : dict
        Keys as in fmu.toml.

    Returns
    -------
    Variable

    Raises
    ------
    ValueError
        A key, type, unit, start or limit is wrong; the message names the variable and the value.
    """
    try:
        if unknown := sorted(set(row) - _KEYS - {"continuous"}):
            raise ValueError(f"unknown key {unknown[0]!r}")
        if row.get("type") not in TYPES:
            raise ValueError(f"type {row.get('type')!r} is not one of {', '.join(TYPES)}")
        if not re.fullmatch(r"[a-z][a-z0-9_]*", name):
            raise ValueError("a name is snake_case")
        if not row.get("doc"):
            raise ValueError("doc is missing")
        if row.get("unit") is not None:
            if row["type"] != "f64":
                raise ValueError(f"unit {row['unit']!r} on type {row['type']}")
            units.parse(row["unit"])
        dims = tuple(row.get("dims", ()))
        bare = Variable(name, causality, **{**row, "dims": dims, "start": None})
        start = row.get("start")
        if causality in ("output", "local"):
            if start is not None:
                raise ValueError("it is calculated and has no start")
            return bare
        if start is None:
            raise ValueError("start is missing")
        values = list(start) if isinstance(start, list) else [start] * bare.count
        if len(values) != bare.count:
            raise ValueError(f"start has {len(values)} values for {bare.count} elements")
        checked = [_check_value(bare, v) for v in values]
        return Variable(name, causality, **{**row, "dims": dims, "start": checked})
    except ValueError as error:
        raise ValueError(f"{causality} {name}: {error}") from None


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
    try:
        doc = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ValueError(f"{file}: {error}") from None
    rows = [(c, n, r) for c in CAUSALITIES for n, r in doc.pop(c, {}).items()]
    if unknown := sorted(set(doc) - _HEAD):
        raise ValueError(f"{file}:{_line(text, unknown[0])}: unknown key {unknown[0]!r}")
    if missing := sorted(_HEAD - set(doc)):
        raise ValueError(f"{file}: {missing[0]!r} is missing")
    if not isinstance(doc["tick_ns"], int) or doc["tick_ns"] < 1:
        raise ValueError(
            f"{file}:{_line(text, 'tick_ns')}: tick_ns {doc['tick_ns']!r} is not a positive integer"
        )
    variables = []
    for causality, name, row in rows:
        try:
            variables.append(variable(name, causality, row))
        except ValueError as error:
            raise ValueError(f"{file}:{_line(text, name)}: {error}") from None
    names = [v.name for v in variables]
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f"{file}:{_line(text, name)}: {name} is described twice")
    return Description(**{**doc, "cores": tuple(doc["cores"])}, variables=tuple(variables))


def _line(text: str, key: str) -> int:
    for number, line in enumerate(text.splitlines(), 1):
        if re.match(rf"\s*{re.escape(key)}\s*=", line):
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
    text = Path(path).read_text()
    if names_modelica(text):
        from motionfmu.modelica import description

        return description.from_modelica(Path(path))
    return parse(text, str(path))
