"""Options of an identification as a file has them: identify.toml beside a scenario."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from motionfmu.base.errors import InputError
from motionfmu.base.toml_lines import tables_of, text_of
from motionfmu.identify.ground import IdentifyOptions
from motionfmu.identify.recorded_loop import ColumnUse

FILE = "identify.toml"


class _UseTable(BaseModel):
    """A column of the record, by its name; a text alone is its signal."""

    model_config = ConfigDict(extra="forbid", strict=True)
    signal: str  # component.variable: an input is driven by the column, an output compared with it
    scale: float | None = None  # the signal's unit per unit of the column; else units say it
    offset: float = 0.0  # added behind the scale


class AxisTables(BaseModel):
    """Which axis is identified, and what of it."""

    model_config = ConfigDict(extra="forbid", strict=True)
    columns: dict[str, str | _UseTable] = Field(default_factory=dict)
    axis: int = Field(default=1, ge=1)  # of the scenario, from 1
    free: list[str] | None = None  # parameters to find, instead of those that the plant proposes
    fix: list[str] = Field(default_factory=list)  # parameters that stay as the scenario has them
    # extensions of the friction law that are taken, instead of those that validation chooses
    laws: list[str] | None = None
    # share of the record, at its end, that is kept back for validation
    keep: float = Field(default=0.3, gt=0.05, lt=0.8)
    controller: bool = True  # gains of the controller may be taken from the record


def read(path: Path) -> dict[str, Any]:
    """Tables of an identify.toml."""
    return tables_of(text_of(path), str(path))


def options(tables: Mapping[str, Any], place: str) -> IdentifyOptions:
    """Check tables and make options of them; `place` is named in messages."""
    try:
        asked = AxisTables.model_validate(dict(tables))
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(p) for p in first["loc"] if not str(p).startswith("_"))
        raise InputError(f"{place}: {where} = {first['input']!r}: {first['msg'].lower()}") from None
    if not asked.columns:
        raise InputError(f"{place}: [columns] must say what the columns of the record are")
    uses = {
        name: ColumnUse(use) if isinstance(use, str) else ColumnUse(**use.model_dump())
        for name, use in asked.columns.items()
    }
    signals = [u.signal for u in uses.values()]
    for name, use in uses.items():
        if signals.count(use.signal) > 1:
            raise InputError(
                f"{place}: columns.{name} = {use.signal!r}: two columns are that signal"
            )
    more = {k: getattr(asked, k) for k in ("axis", "free", "fix", "laws", "keep", "controller")}
    return IdentifyOptions(uses, **more)


def with_columns(tables: Mapping[str, Any], texts: Sequence[str]) -> dict[str, Any]:
    """Tables with columns of the command line, each instead of the file's column of that signal."""
    given = dict(map(column, texts))
    signals = {_signal(use) for use in given.values()}
    columns = tables.get("columns", {})
    if isinstance(columns, Mapping):
        kept = {n: use for n, use in columns.items() if _signal(use) not in signals}
        return {**tables, "columns": {**kept, **given}} if given else dict(tables)
    return dict(tables)


def _signal(use: Any) -> Any:
    return use.get("signal") if isinstance(use, Mapping) else use


def column(text: str) -> tuple[str, str | dict[str, Any]]:
    """Read ``COLUMN=COMP.VAR`` or ``COLUMN=COMP.VAR*SCALE`` of the command line."""
    name, equals, rest = text.partition("=")
    signal, star, scale = rest.partition("*")
    if not equals or not name.strip() or "." not in signal:
        raise InputError(f"--column {text}: COLUMN=COMP.VAR or COLUMN=COMP.VAR*SCALE wanted")
    if not star:
        return name.strip(), signal.strip()
    try:
        return name.strip(), {"signal": signal.strip(), "scale": float(scale)}
    except ValueError:
        raise InputError(f"--column {text}: {scale!r} is no number") from None


__all__: Sequence[str] = ["FILE", "column", "options", "read", "with_columns"]
