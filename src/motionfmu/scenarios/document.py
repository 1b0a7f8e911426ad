"""A scenario file: which FMUs, how they are wired, set, driven, recorded and judged."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError

from motionfmu.errors import InputError
from motionfmu.scenarios.analyses import Iso9283, View, Waveform
from motionfmu.toml_lines import KEY_MAX, Lines, is_file, shown, tables_of, text_of

Value = bool | int | float | str | list[bool] | list[int] | list[float] | list[str]
Pair = tuple[float, float]
_STRICT = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)
# Each is an FMU with a library and a folder of its own.
COMPONENTS_MAX = 64
# The name becomes that of an instance and of a file; the recorder's own begin with "_".
Component = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]{0,63}$")]
# Names and patterns are looked up in all variables of all components.
LISTED_MAX = 1000
FIGURES_MAX = 100  # a picture each
Name = Annotated[str, Field(max_length=KEY_MAX)]
Names = Annotated[list[Name], Field(max_length=LISTED_MAX)]


class Drive(BaseModel):
    """An input that steps to given values at given times [s]."""

    model_config = _STRICT
    input: Name
    at: list[float] = Field(min_length=1)
    value: list[Value] = Field(min_length=1)


class Check(BaseModel):
    """Bounds of one signal or figure; each one given must hold."""

    model_config = _STRICT
    min: float | Pair | None = None
    max: float | Pair | None = None
    absmax: float | Pair | None = None
    peak: Pair | None = None
    rms: Pair | None = None
    final: bool | float | Pair | None = None
    changes: float | Pair | None = None
    order: tuple[float, ...] | None = Field(default=None, min_length=1, max_length=LISTED_MAX)
    rate: float | None = None
    at: float | None = None
    windows: tuple[Pair, ...] | None = Field(default=None, min_length=1)


class Contrary(BaseModel):
    """Values that switch off a claim; the checks named must fail."""

    model_config = _STRICT
    off: str = Field(min_length=1)
    set: dict[str, Value] = Field(min_length=1)
    fails: Names = Field(min_length=1)


class Contour(BaseModel):
    """Which signals hold the actual position and the pulses put out."""

    model_config = _STRICT
    position: Name
    pulses: Name


class Record(BaseModel):
    """What is recorded: names or patterns of outputs, at every step or every so many."""

    model_config = _STRICT
    every: int = Field(default=1, ge=1, le=1_000_000)  # [steps]
    signals: Names = Field(min_length=1)


class Plot(BaseModel):
    """One panel of a figure: signals, and how they are shown."""

    model_config = _STRICT
    signals: Names = Field(min_length=1)
    label: str = Field(min_length=1)
    steps: bool = False
    rate: float | None = None
    scale: float = 1.0
    levels: dict[str, float] = Field(default_factory=dict)
    names: list[str] | None = None


class Figure(BaseModel):
    """Panels above each other that share the time axis [s]."""

    model_config = _STRICT
    title: str = Field(min_length=1)
    note: str = ""
    window: list[float] | None = Field(default=None, min_length=2, max_length=2)
    plot: list[Plot] = Field(min_length=1, max_length=FIGURES_MAX)


def _listed(x: Any) -> Any:
    """One table of bounds, or several."""
    return tuple(x) if isinstance(x, list | tuple) else (x,)


Checks = Annotated[
    tuple[Check, ...], BeforeValidator(_listed), Field(min_length=1, max_length=LISTED_MAX)
]


class Body(BaseModel):
    """The tables of a scenario.toml."""

    model_config = _STRICT
    stop: float = Field(gt=0)
    step: float = Field(gt=0)
    component: dict[Component, Name] = Field(min_length=1, max_length=COMPONENTS_MAX)
    connect: dict[str, Name] = Field(default_factory=dict, max_length=LISTED_MAX)
    set: dict[str, Value] = Field(default_factory=dict)
    drive: list[Drive] = Field(default_factory=list, max_length=LISTED_MAX)
    leave: Names = Field(default_factory=list)
    record: Record
    contour: Contour | None = None
    iso9283: Iso9283 | None = None
    view: View = View()
    figure: list[Figure] = Field(default_factory=list, max_length=FIGURES_MAX)
    waveform: list[Waveform] = Field(default_factory=list, max_length=FIGURES_MAX)
    check: dict[str, Checks] = Field(default_factory=dict, max_length=LISTED_MAX)
    contrary: list[Contrary] = Field(default_factory=list, max_length=LISTED_MAX)

    @property
    def stop_limit(self) -> float:
        """When a run ends at the latest [s]."""
        return self.stop


@dataclass(frozen=True)
class Document:
    """A scenario as read: tables, file and line numbers."""

    file: Path  # the scenario.toml
    about: str  # what its first line says
    body: Body
    lines: Lines  # line numbers of the keys

    def error(self, text: str, table: str = "", key: str = "") -> InputError:
        """Make the error for a key of this file; where it stands as in `Lines.of`."""
        return InputError(f"{self.file}:{self.lines.of(table, key)}: {text}")


def scenario_file(path: str | Path) -> Path:
    """The scenario.toml, absolute, that a user's path means: itself or the folder that holds it."""
    file = Path(path)
    file = file / "scenario.toml" if is_file(file / "scenario.toml") else file
    if not is_file(file):
        raise InputError(f"{file}: no such scenario")
    return file.resolve()


def read(path: str | Path) -> Document:
    """Read a scenario.toml, or the folder that holds it, and check its keys and their types."""
    file = scenario_file(path)
    text = text_of(file)
    tables = tables_of(text, file)
    lines = Lines(text)
    first = text.split("\n", 1)[0]
    if not first.startswith("#"):
        raise InputError(f"{file}:1: the first line is a comment that says what the scenario shows")
    try:
        body = Body.model_validate(_floats(tables))
    except ValidationError as error:
        raise InputError(_first(error, file, lines)) from None
    return Document(file, first.lstrip("# "), body, lines)


def _floats(tables: dict[str, Any]) -> dict[str, Any]:
    """Whole numbers where a time or a bound is meant; pairs become tuples."""

    def number(x: Any) -> Any:
        if isinstance(x, list):
            return tuple(number(y) for y in x)
        return float(x) if isinstance(x, int) and not isinstance(x, bool) else x

    out = dict(tables)
    for key in ("stop", "step"):
        if key in out:
            out[key] = number(out[key])
    for row in out.get("drive", []) if isinstance(out.get("drive"), list) else []:
        if isinstance(row, dict) and isinstance(row.get("at"), list):
            row["at"] = [number(x) for x in row["at"]]
    checks = out.get("check", {})
    for rows in checks.values() if isinstance(checks, dict) else []:
        for row in rows if isinstance(rows, list) else [rows]:
            for key, x in list(row.items()) if isinstance(row, dict) else []:
                row[key] = number(x)
    return out


def _first(error: ValidationError, file: Path, lines: Lines) -> str:
    """One line for the first thing pydantic found."""
    found = error.errors()[0]
    place = [str(p) for p in found["loc"]]
    if place[0] == "check":
        del place[2:3]  # number of the table: the key names them all
    if found["type"] == "missing" and len(place) == 1:
        return f"{file}: {place[0]} is missing"
    table, key = _place(place)
    if found["type"] == "missing" and isinstance(found["loc"][-1], int):
        what, few = ".".join(place[:-1]), list(found["input"])
        return f"{file}:{lines.of(table, key)}: {what} = {shown(few)}: too few values"
    if found["type"] == "missing":
        return f"{file}:{lines.of(table)}: {place[-1]} is missing"
    name = ".".join(place[1:] if place[0] == "set" else place)
    if found["type"] == "extra_forbidden":
        return f"{file}:{lines.of(table, key)}: unknown key {place[-1]!r}"
    value = "..." if isinstance(found["input"], dict) and found["input"] else found["input"]
    value = list(value) if isinstance(value, tuple) else value
    return f"{file}:{lines.of(table, key)}: {name} = {shown(value)}: {found['msg'].lower()}"


def _place(place: list[str]) -> tuple[str, str]:
    """Table and key that `Lines` knows, of a place that pydantic names."""
    if len(place) == 1:
        return "", place[0]
    depth = 1
    if place[0] in ("drive", "figure", "waveform", "contrary"):
        depth = 4 if place[2:3] == ["plot"] and len(place) > 3 else 2
    return ".".join(place[:depth]), place[depth] if len(place) > depth else ""
