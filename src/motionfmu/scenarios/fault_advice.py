"""What to do about the numbers by which an FMU tells a fault: the advice.toml that it carries."""

import functools
import itertools
import re
import tomllib

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from motionfmu.base.errors import InputError
from motionfmu.scenarios import fmus
from motionfmu.scenarios.port import Port

FILE = "advice.toml"
# Meanings of numbers as a type's description has them: "0 running, 1 hold".
_MEANING = re.compile(r"(-?\d+) (.*?)(?=, -?\d+ |$)")
_NUMBERS = re.compile(r"(-?\d+)(?:\.\.(-?\d+))?")


def meanings(port: Port) -> dict[int, str]:
    """What the numbers of a variable mean, if its type says it."""
    if port.type != "Int32" or port.declared is None:
        return {}
    return {int(number): word for number, word in _MEANING.findall(port.declared[1])}


class VariableAdvice(BaseModel):
    """What to do, by the value of an output: a number, or a span `"62209..62214"`."""

    model_config = ConfigDict(extra="forbid", strict=True, populate_by_name=True)

    # another output, or one of another FMU (`mcc.error`): its advice holds where there is none here
    like: str | None = Field(None, alias="as")
    by_number: dict[int, str] = Field(default_factory=dict)

    @model_validator(mode="before")
    @classmethod
    def _spans(cls, table: dict[str, str]) -> dict[str, object]:
        by_number: dict[int, str] = {}
        for key, text in table.items():
            if key == "as":
                continue
            if (found := _NUMBERS.fullmatch(key)) is None:
                raise ValueError(f"{key}: neither a number nor a span of numbers, a..b")
            first = int(found[1])
            by_number |= dict.fromkeys(range(first, int(found[2] or first) + 1), text)
        return {"as": table.get("as"), "by_number": by_number}


@functools.cache
def _tables(fmu: str) -> dict[str, VariableAdvice]:
    text = fmus.extra(fmu, FILE)
    where = f"fmus/{fmu}/{FILE}"
    try:
        read = {} if text is None else tomllib.loads(text)
        tables = {name: VariableAdvice.model_validate(table) for name, table in read.items()}
    except (tomllib.TOMLDecodeError, ValidationError) as error:
        raise InputError(f"{where}: {' '.join(str(error).split())}") from None
    ports = fmus.ports(fmu)
    for name, table in tables.items():
        known = meanings(ports[name]) if name in ports else {}
        for number in table.by_number:
            if number not in known:
                raise InputError(f"{where}: {fmu} has no {name} with a meaning of {number}")
    return tables


@functools.cache
def advice(fmu: str) -> dict[str, dict[int, str]]:
    """What to do about each number that an FMU tells, by output; empty if it carries no advice."""
    ports = fmus.ports(fmu)
    found: dict[str, dict[int, str]] = {}
    for name in _tables(fmu):
        texts = _texts(fmu, name, f"fmus/{fmu}/{FILE}")
        found[name] = {n: texts[n] for n in meanings(ports[name]) if n in texts}
    return found


def _texts(fmu: str, name: str, where: str) -> dict[int, str]:
    """The advice of an output, and of those that it names."""
    texts: dict[int, str] = {}
    for _ in itertools.repeat(None, 8):
        table = _tables(fmu).get(name)
        if table is None:
            raise InputError(f"{where}: no advice on {fmu}.{name}")
        texts = table.by_number | texts
        if table.like is None:
            return texts
        other, dot, name = table.like.rpartition(".")
        fmu = other if dot else fmu
    raise InputError(f"{where}: {fmu}.{name} names itself by other tables")
