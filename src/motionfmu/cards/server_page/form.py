"""The form of the configuration: what the page asks for, from the one description."""

from typing import Any, get_args, get_origin

from annotated_types import Ge, Gt, Le, Lt
from pydantic_core import PydanticUndefined

from motionfmu.base.units import spelled
from motionfmu.cards.config_tables import (
    CardAxis,
    CardMotion,
    Fifo,
    Input,
    Network,
    Pen,
    Pulse,
    Tasks,
)
from motionfmu.cards.fields import Is, Table, choices, described

PARTS: tuple[tuple[str, str, type[Table]], ...] = (
    ("network", "Network", Network),
    ("axes", "Axis", CardAxis),
    ("motion", "Motion", CardMotion),
    ("motion.pen", "Pen", Pen),
    ("pulse", "Pulses", Pulse),
    ("fifo", "Buffer", Fifo),
    ("tasks", "Priorities", Tasks),
    ("inputs", "Inputs", Input),
)


def form() -> list[dict[str, Any]]:
    """Sections of the form: place in the file, title, fields with words, unit, kind, range."""
    found = []
    for place, title, table in PARTS:
        rows = [_field(name, table) for name in described(table)]
        found.append({"place": place, "title": title, "about": table.__doc__ or "", "fields": rows})
    return found


def _field(name: str, table: type[Table]) -> dict[str, Any]:
    field, what = described(table)[name]
    kind: Any = field.annotation
    row: dict[str, Any] = {"name": name, "words": what.words, "unit": spelled(what.unit)}
    row["default"] = None if field.default is PydanticUndefined else field.default
    if words := choices(field):
        return row | {"kind": "choice", "choices": words}
    if kind is str or (get_origin(kind) is not None and str in get_args(kind)):
        return row | {"kind": "text"}
    low, high = _range(field.metadata, what)
    kinds = {int: "whole", bool: "yes"}
    return row | {"kind": kinds.get(kind, "number"), "low": low, "high": high}


def _range(marks: list[Any], what: Is) -> tuple[float | None, float | None]:
    """Range in the unit of the file; None where it depends on pulses/mm or is told by a check."""
    if what.macro and not what.pulses:
        return what.low / what.factor, what.high / what.factor
    bounds = {type(m): m for m in marks}
    low = bounds.get(Ge, bounds.get(Gt))
    high = bounds.get(Le, bounds.get(Lt))
    return (
        getattr(low, "ge", getattr(low, "gt", None)),
        getattr(high, "le", getattr(high, "lt", None)),
    )
