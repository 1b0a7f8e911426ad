"""The keys of a study, read from its file and from the command line."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from motionfmu.base.errors import Faults, InputError, suggestion
from motionfmu.base.toml_lines import Lines, is_file, ordered, shown, tables_of, text_of
from motionfmu.scenarios import package_files
from motionfmu.scenarios.body import Name, Names, Value
from motionfmu.scenarios.table_sources import scenario_file

FILE = "sweep.toml"
ABOUT = "the first line is a comment that says what the study shows"
VALUE = "a number, a text, true or false, or a list of one of these wanted"
_STRICT = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)
# Longest path, for messages have it in them.
Place = Annotated[str, Field(max_length=1000)]


class StudyBody(BaseModel):
    """The keys of a study file."""

    model_config = _STRICT
    scenario: Place = "."  # folder, from this file
    machine: Place | None = None  # in place of a scenario: the machine of a program
    program: Place | None = None  # part program of the machine
    # how points are chosen: all, at random, Latin hypercube
    sampling: Literal["grid", "random", "latin"] = "grid"
    runs: int | None = Field(default=None, ge=1)  # how many; not for a grid
    seed: int = Field(default=0, ge=0)  # of the draws
    stop: float | None = None  # [s] instead of the scenario's
    step: float | None = None  # [s] instead of the scenario's
    set: dict[str, Value] = Field(default_factory=dict)  # values for all runs
    results: Names = Field(default_factory=list)  # numbers of a run that the table keeps
    cost: Name | None = None  # of the results, what is to be small
    tuned: Place | None = None  # file of gains that the picture marks
    # what varies: a range, a distribution or a list by component.variable
    axis: dict[str, Any] = Field(default_factory=dict)


@dataclass(frozen=True)
class Origin:
    """Where a study's keys are written, for messages."""

    file: Path | None  # None if it comes from the command line alone
    lines: Lines  # line numbers of its keys
    given: frozenset[str]  # keys that the command line gave

    def error(self, text: str, table: str = "", key: str = "") -> InputError:
        """The error for a key of the study, placed as in `Lines.of`."""
        if self.file is None or (table or key) in self.given:
            return InputError(f"sweep: {text}")
        return InputError(f"{self.file}:{self.lines.of(table, key)}: {text}")

    def refuse(self, faults: Faults) -> None:
        """Raise an InputError with all faults in the order of their lines, if there are any."""
        Faults(ordered(faults.lines, [str(self.file)])).tell()


@dataclass(frozen=True)
class StudyFile:
    """A study as written, its keys and their types checked."""

    origin: Origin
    body: StudyBody
    about: str  # what the first line says; empty from the command line
    folder: Path  # what it names lies here
    damaged: frozenset[str]  # keys with faults, which the body does not have


def read(path: Path, given: Mapping[str, Any], faults: Faults) -> StudyFile:
    """Read a study file, or a scenario's sweep.toml if there is one.

    Keys given count instead of those written there. What is wrong with keys and their types goes to
    the faults, with file, line and value; a file that cannot be read is an InputError.
    """
    if "machine" in given:
        keys = {**given, "program": str(path)}
        origin = Origin(None, Lines(""), frozenset(keys))
        body, damaged = _body(origin, keys, faults)
        return StudyFile(origin, body, "", Path(), damaged)
    if package_files.is_name(path) and not path.suffix:
        path = scenario_file(path).parent
    if is_file(path / FILE):
        path = path / FILE
    keys = dict(given)
    if is_file(path / "scenario.toml") or path.name == "scenario.toml" or path.is_dir():
        keys["scenario"] = str(path)
        origin = Origin(None, Lines(""), frozenset(keys))
        body, damaged = _body(origin, keys, faults)
        return StudyFile(origin, body, "", Path(), damaged)
    text = text_of(path)
    tables = tables_of(text, path)
    file, first = path.resolve(), text.split("\n", 1)[0]
    if not first.startswith("#"):
        faults.lines.append(f"{file}:1: {ABOUT}")
    origin = Origin(file, Lines(text), frozenset(keys))
    body, damaged = _body(origin, tables | keys, faults)
    return StudyFile(origin, body, first.lstrip("# "), file.parent, damaged)


def _body(origin: Origin, keys: dict[str, Any], faults: Faults) -> tuple[StudyBody, frozenset[str]]:
    """The body without the keys that have faults, and those keys."""
    try:
        return StudyBody.model_validate(keys), frozenset()
    except ValidationError as error:
        found = error.errors()
    damaged = {str(one["loc"][0]) for one in found}
    rest = {key: value for key, value in keys.items() if key not in damaged}
    for one in found:
        text, *place = _told(one)
        faults.lines += origin.error(text, *place).args
        if one["type"] == "extra_forbidden":  # a key that is meant by another is not missing
            damaged |= {name for name in StudyBody.model_fields if text.endswith(f"mean {name!r}?")}
            damaged |= {"axis"} if isinstance(one["input"], dict) else set()
    return StudyBody.model_validate(rest), frozenset(damaged)


def _told(found: Any) -> tuple[str, str, str]:
    """Words, table and key of a fault."""
    key, value = str(found["loc"][0]), found["input"]
    if found["type"] == "extra_forbidden":
        what = f"table [{key}]" if isinstance(value, dict) else f"key {key!r}"
        return f"unknown {what}{suggestion(key, StudyBody.model_fields)}", "", key
    if key == "set" and found["loc"][1:]:
        name = str(found["loc"][1])
        return f"set.{name} = {shown(value)}: {VALUE}", key, name
    return f"{key} = {shown(value)}: {found['msg'].lower()}", "", key
