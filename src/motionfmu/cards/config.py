"""A card's configuration, one file for plans, C headers, the FMU and the page."""

import copy
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, Self, get_args

from pydantic import BaseModel, BeforeValidator, Field, ValidationError, model_validator

from motionfmu.base.errors import InputError, suggestion
from motionfmu.base.toml_lines import Lines, shown, tables_of, text_of
from motionfmu.cards.config_tables import (
    AXES,
    PINS,
    CardAxis,
    CardMotion,
    Fifo,
    Input,
    Network,
    Output,
    Pulse,
    Tasks,
    by_pins,
)
from motionfmu.cards.fields import STRICT, FieldFaults, Table, choices, described, numbers


class CardConfig(BaseModel):
    """Configuration of a network card.

    Attributes
    ----------
    network : Network
        Addresses of card and server.
    axes : list of CardAxis
        One to four, X first.
    motion : CardMotion
        How paths are planned and run.
    pulse : Pulse
        Shape of the pulses.
    fifo : Fifo
        The FPGA's buffer.
    tasks : Tasks
        Priorities.
    inputs : list of Input
        All sixteen, ``[inputs.3]`` in the file.
    outputs : list of str
        Names of all sixteen, empty for none; ``[outputs]`` with ``3 = "valve"`` in the file.
    """

    model_config = STRICT
    network: Network = Network()
    axes: Annotated[list[CardAxis], Field(min_length=1, max_length=len(AXES))]
    motion: CardMotion = CardMotion()
    pulse: Pulse = Pulse()
    fifo: Fifo = Fifo()
    tasks: Tasks = Tasks()
    inputs: Annotated[list[Input], BeforeValidator(by_pins({}))] = [Input()] * PINS
    outputs: Annotated[list[Output], BeforeValidator(by_pins(""))] = [""] * PINS

    @model_validator(mode="after")
    def _together(self) -> Self:
        found: list[tuple[tuple[str, ...], str]] = []
        names = [axis.name for axis in self.axes]
        if wrong := [k for k, name in enumerate(names) if name != AXES[k]]:
            k = wrong[0]
            found.append(((f"axes.{k}.name",), f"axis {k + 1} of a card is {AXES[k]}"))
        rate = 0.5 / self.pulse.width
        for k, axis in enumerate(self.axes):
            asked = axis.speed_max * axis.pulses_per_mm
            if asked > rate * (1 + 1e-9):
                told = (
                    f"{asked:.0f} pulses/s; a pulse.width of {self.pulse.width} s lets {rate:.0f}"
                )
                found.append(((f"axes.{k}.speed_max", "pulse.width"), told))
        pen = self.motion.pen
        if pen.kind == "axis" and pen.axis not in names:
            found.append((("motion.pen.axis",), "no such axis"))
        elif pen.kind == "axis" and pen.axis in "XY":
            found.append((("motion.pen.axis",), "X and Y draw"))
        for k, name in enumerate(self.outputs):
            if name and name in self.outputs[:k]:
                found.append(((f"outputs.{k}",), "two outputs of one name"))
        if found:
            raise FieldFaults(*found)
        return self

    def as_parameters(self) -> dict[str, Any]:
        """Values of the parameters of the FMU ``network_card``.

        Returns
        -------
        dict
            Value by name; a list of four for what each axis has, of sixteen for inputs. An axis
            that the card does not have stands still and has no home.
        """
        found: dict[str, Any] = {}
        spare = CardAxis(
            name="U", pulses_per_mm=1000.0, minimum=-1.0, maximum=1.0, speed_max=20.0,
            acceleration_max=1.0, home_order=0,
        )  # fmt: skip
        axes = self.axes + [spare] * (len(AXES) - len(self.axes))
        for table in (self.network, self.motion, self.pulse, self.fifo, self.tasks):
            found |= _parameters(table)
        for row in map(_parameters, [*axes, *self.inputs]):
            for name, value in row.items():
                found.setdefault(name, []).append(value)
        return found


def _parameters(table: Table) -> dict[str, Any]:
    """The FMU's parameters of a table; a choice of two words, or yes and no, is a Boolean."""
    found: dict[str, Any] = {}
    fields = described(table)
    for name, number in numbers(table).items():
        if number.what.parameter:
            two = isinstance(number.source, bool) or len(choices(fields[name][0])) == 2
            found[number.what.parameter] = bool(number.value) if two else number.value
    return found


def load(path: str | Path) -> CardConfig:
    """Read the configuration of a card.

    Parameters
    ----------
    path : str or Path
        A ``card.toml``.

    Returns
    -------
    CardConfig

    Raises
    ------
    InputError
        A line ``file:line: key = value: what is wrong`` for everything that is wrong in the file.
    """
    text = text_of(path)
    return read(text, path)


def read(text: str, file: str | Path) -> CardConfig:
    """Configuration of a text; `file` is its name in messages."""
    tables, lines = tables_of(text, file), Lines(text)
    try:
        return CardConfig.model_validate(tables)
    except ValidationError:
        told = []
        for place, value, why in faults(tables):
            named = f"{place} = {shown(value)}" if value is not None else place
            told.append((lines.of(place), f"{named}: {why}"))
        raise InputError(*(f"{file}:{line}: {text}" for line, text in sorted(told))) from None


def faults(tables: dict[str, Any]) -> list[tuple[str, Any, str]]:
    """All faults: place (``axes.0.speed_max``), value (None if not given) and words of each."""
    found: dict[str, tuple[Any, str]] = {}
    meant: set[str] = set()
    rest = copy.deepcopy(tables)
    while True:
        before = len(found)
        try:
            CardConfig.model_validate(rest)
        except ValidationError as error:
            told = list(_places(error))
            for (place, *_), why in told:  # a key that is meant by a misspelt one is not missing
                if why.startswith("unknown key") and why.endswith("?"):
                    meant.add(f"{place.rpartition('.')[0]}.{why.split(chr(39))[1]}".lstrip("."))
            known = found.keys() | meant
            for (place, *others), why in told:
                if not known & {place, *others}:
                    found.setdefault(place, (_value(tables, place), why))
                    _without(rest, place)
        if len(found) == before:
            return [(place, *told) for place, told in found.items()]


def _places(error: ValidationError) -> Iterator[tuple[list[str], str]]:
    """Places and words of each fault: first the wrong value's place, then those it depends on."""
    for one in error.errors():
        table = ".".join(map(str, one["loc"]))
        inner = one.get("ctx", {}).get("error")
        if isinstance(inner, FieldFaults):
            for keys, why in inner.found:
                yield [f"{table}.{key}".lstrip(".") for key in keys], why
        elif one["type"] == "extra_forbidden":
            yield [table], f"unknown key{_close(table)}"
        elif one["type"] == "literal_error":
            words = re.findall("'([^']*)'", one["ctx"]["expected"])
            yield [table], f"{_words(one)}{suggestion(str(one['input']), words)}"
        else:
            yield [table], str(inner) if inner else _words(one)


def _words(found: Any) -> str:
    """Pydantic's message, as the end of ours."""
    return str(found["msg"][0].lower() + found["msg"][1:])


def _close(place: str) -> str:
    """The end of a message that suggests another key for the last one of a place."""
    table: Any = CardConfig
    *around, key = place.split(".")
    for part in around:
        if field := table.model_fields.get(part):
            table = (get_args(field.annotation) or (field.annotation,))[0]
    return suggestion(key, getattr(table, "model_fields", ()))


def _holder(tables: Any, place: str) -> Any:
    """The table or list that holds the last key of a place."""
    for key in place.split(".")[:-1]:
        if isinstance(tables, list):
            tables = tables[int(key)] if key.isdigit() and int(key) < len(tables) else None
        else:
            tables = tables.get(key) if isinstance(tables, dict) else None
    return tables


def _value(tables: dict[str, Any], place: str) -> Any:
    """The value at a place of a file; None for a table or an empty place."""
    holder, key = _holder(tables, place), place.rpartition(".")[2]
    value = holder.get(key) if isinstance(holder, dict) else None
    return None if isinstance(value, dict | list) else value


def _without(tables: dict[str, Any], place: str) -> None:
    """Remove a wrong value, so that faults that it hides are found."""
    holder = _holder(tables, place)
    if isinstance(holder, dict):
        holder.pop(place.rpartition(".")[2], None)
