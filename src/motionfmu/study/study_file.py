"""The keys of a study: from its file and from the command line."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from motionfmu.errors import InputError, suggestion
from motionfmu.scenarios.body import Name, Names, Value
from motionfmu.toml_lines import Lines, is_file, shown, tables_of, text_of

FILE = "sweep.toml"
_STRICT = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)
# A path is part of messages.
Place = Annotated[str, Field(max_length=1000)]


class Body(BaseModel):
    """The keys of a study file."""

    model_config = _STRICT
    scenario: Place = "."
    sampling: Literal["grid", "random", "latin"] = "grid"
    runs: int | None = Field(default=None, ge=1)
    seed: int = Field(default=0, ge=0)
    stop: float | None = None
    step: float | None = None
    set: dict[str, Value] = Field(default_factory=dict)
    results: Names = Field(default_factory=list)
    cost: Name | None = None
    tuned: Place | None = None
    axis: dict[str, Any] = Field(default_factory=dict)


@dataclass(frozen=True)
class Origin:
    """Where a study is written, for messages."""

    file: Path | None  # None if it comes from the command line alone
    lines: Lines  # line numbers of its keys
    given: frozenset[str]  # keys that the command line gave

    def error(self, text: str, table: str = "", key: str = "") -> InputError:
        """The error for a key of the study, placed as in `Lines.of`."""
        if self.file is None or (table or key) in self.given:
            return InputError(f"sweep: {text}")
        return InputError(f"{self.file}:{self.lines.of(table, key)}: {text}")


def read(path: Path, given: Mapping[str, Any]) -> tuple[Origin, Body, str, Path]:
    """Read a study file, or a scenario's sweep.toml if there is one.

    With what its first line says, and its folder; keys given count instead of those written there.
    A wrong form is an InputError with file, line and value.
    """
    if is_file(path / FILE):
        path = path / FILE
    keys = dict(given)
    if is_file(path / "scenario.toml") or path.name == "scenario.toml" or path.is_dir():
        keys["scenario"] = str(path)
        origin = Origin(None, Lines(""), frozenset(keys))
        return origin, _body(origin, keys), "", Path()
    text = text_of(path)
    tables = tables_of(text, path)
    first = text.split("\n", 1)[0]
    if not first.startswith("#"):
        raise InputError(f"{path}:1: the first line is a comment that says what the study shows")
    origin = Origin(path.resolve(), Lines(text), frozenset(keys))
    return origin, _body(origin, tables | keys), first.lstrip("# "), path.resolve().parent


def _body(origin: Origin, keys: dict[str, Any]) -> Body:
    try:
        return Body.model_validate(keys)
    except ValidationError as error:
        found = error.errors()[0]
        key = str(found["loc"][0])
        place = (key, str(found["loc"][1])) if key == "set" and found["loc"][1:] else ("", key)
        if found["type"] == "extra_forbidden":
            raise origin.error(
                f"unknown key {key!r}{suggestion(key, Body.model_fields)}", "", key
            ) from None
        name = ".".join(str(x) for x in found["loc"][:2]) if key == "set" else key
        text = f"{name} = {shown(found['input'])}: {found['msg'].lower()}"
        raise origin.error(text, *place) from None
