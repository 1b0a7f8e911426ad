"""Settings of a card: their numbers on the wire, their values in a configuration, their words."""

import functools
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from pydantic.fields import FieldInfo

from motionfmu.base.binding import dtype
from motionfmu.base.units import spelled
from motionfmu.cards.config_tables import AXES, CardAxis, CardMotion, Fifo, Input, Pulse, Tasks
from motionfmu.cards.fields import Is, Table, choices, described
from motionfmu.cards.views import ConfigurationResult

if TYPE_CHECKING:
    from motionfmu.cards.config import CardConfig

Key = tuple[str, int]  # name in src/controllers/netcard/card_settings.h, element
TABLES: tuple[type[Table], ...] = (CardMotion, Pulse, Fifo, Tasks, CardAxis, Input)
# Settings that are an upper bound of another one: they are raised before it and lowered after it.
_UPPER = ("speed_max", "position_high")
# Settings that the card copies at power-up only.
_COPIED = {"speed_min", "fifo_depth", "pulse_width_ns", "dir_setup_ns", "dir_hold_ns"}


@functools.cache
def numbers() -> dict[str, tuple[int, int]]:
    """Number on the wire and elements of each setting."""
    of = dtype("netcard_sim")
    names = of.names or ()
    names = names[: names.index("key")]
    return {name: (i, of[name].shape[0] if of[name].shape else 1) for i, name in enumerate(names)}


def asked(config: "CardConfig") -> dict[Key, int]:
    """Whole numbers of a card's settings in a configuration, without the card's id."""
    found: dict[Key, int] = {}
    for name, value in config.as_parameters().items():
        if name != "card_id":
            row = value if isinstance(value, list) else [value]
            found |= {(name, i): int(one) for i, one in enumerate(row)}
    return found


def in_order(wanted: Mapping[Key, int], has: Mapping[Key, int]) -> list[Key]:
    """The settings that differ, in an order in which all fit together after each one."""

    def turn(key: Key) -> int:
        return 1 if key[0] not in _UPPER else 0 if wanted[key] > has[key] else 2

    return sorted((k for k in wanted if wanted[k] != has[k]), key=turn)


def at_power_up(name: str) -> bool:
    """Whether a setting acts from the next power-up on only."""
    return name in _COPIED or name.startswith(("priority_", "in_"))


@functools.cache
def fields() -> dict[str, tuple[type[Table], FieldInfo, Is]]:
    """Table, field and words of each setting that a configuration has."""
    return {
        what.parameter: (table, field, what)
        for table in TABLES
        for field, what in described(table).values()
        if what.parameter
    }


def shown(name: str, whole: int, pulses_per_m: int) -> str:
    """Text of a setting in the unit of the configuration's file."""
    _, field, what = fields()[name]
    if words := choices(field):
        return words[whole] if 0 <= whole < len(words) else str(whole)
    if field.annotation is bool:
        return "yes" if whole else "no"
    scale = what.factor * (pulses_per_m / 1e3 if what.pulses else 1.0)
    return f"{whole / scale:.10g}" if scale else f"{whole} pulses"


def words(name: str, index: int) -> str:
    """The name of a setting in words."""
    table, _, what = fields()[name]
    of = {CardAxis: f"Axis {AXES[index % 4]}: ", Input: f"Input {index}: ", Tasks: "Priority: "}
    return of.get(table, "") + what.words


def lines(wanted: Mapping[Key, int], end: ConfigurationResult) -> Iterator[str]:
    """A line for each setting that was sent, with its result."""
    before = {(s.name, s.index): s.before for s in end.changed}
    for s in end.changed:
        scale: Any = ("pulses_per_m", s.index)
        new = wanted.get(scale, 1)
        unit = spelled(fields()[s.name][2].unit)
        change = f"{shown(s.name, s.before, before.get(scale, new))} -> "
        change += f"{shown(s.name, s.value, new)} {unit}".rstrip()
        later = ", acts from the next power-up on" if s.later and s.result.ok else ""
        yield f"{words(s.name, s.index)}: {change}: {s.result.text}{later}"
