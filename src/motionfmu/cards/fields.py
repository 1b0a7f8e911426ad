"""Fields of a card's configuration: words, unit, and the whole number that the card gets."""

from dataclasses import dataclass, replace
from typing import Any, ClassVar, Literal, Self, get_args, get_origin

from pydantic import BaseModel, ConfigDict, model_validator
from pydantic.fields import FieldInfo

from motionfmu.base.units import spelled

STRICT = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False, frozen=True)
# A rule: field, "<" or "<=", field of the same table. The card's numbers must keep it as well.
Rule = tuple[str, str, str]
# Farther from 0 than any field allows.
FAR = 1e30


@dataclass(frozen=True)
class Is:
    """Words and unit of a field, its macro in the card's headers, its parameter of the FMU.

    A macro and a parameter have the whole number: the value times `factor`, and times pulses/mm
    where `pulses` is set; the place of a word among its choices; a byte each of an address.
    """

    words: str
    unit: str = ""  # of the value in the file
    macro: str = ""  # behind MC_, for an axis behind MC_X_; empty: none
    counts: str = ""  # unit of the whole number
    low: int = 0
    high: int = 2**32 - 1
    suffix: str = "UL"  # L where it may be negative, ULL where it has 64 bits
    factor: float = 1.0
    pulses: bool = False
    step: int = 1  # the whole number is a multiple of this
    exact: bool = False  # the value must give the whole number without rounding
    parameter: str = ""


@dataclass(frozen=True)
class WholeNumber:
    """The whole number of a field."""

    what: Is
    value: int
    source: Any  # the value in the file

    def wrong(self) -> str:
        """The number's fault in words; empty if it has none."""
        w = self.what
        told = f"{self.value} {spelled(w.counts)}".rstrip()
        if not w.low <= self.value <= w.high:
            return f"that is {told}; {w.low} .. {w.high} wanted"
        if self.value % w.step:
            return f"that is {told}; a multiple of {w.step} wanted"
        exactly = self.source * w.factor if w.exact else self.value
        return f"no whole number of {spelled(w.counts)}" if abs(exactly - self.value) > 1e-6 else ""


class FieldFaults(ValueError):
    """Faults of a table's fields: keys of the wrong field and those it depends on, and words."""

    def __init__(self, *found: tuple[tuple[str, ...], str]) -> None:
        super().__init__("; ".join(text for _, text in found))
        self.found = found


class Table(BaseModel):
    """A table of the file; an axis has pulses/mm."""

    model_config = STRICT
    RULES: ClassVar[tuple[Rule, ...]] = ()

    @model_validator(mode="after")
    def _fits(self) -> Self:
        known = numbers(self).items()
        found: list[tuple[tuple[str, ...], str]] = [((k,), w) for k, n in known if (w := n.wrong())]
        for left, sign, right in self.RULES:
            a, b = getattr(self, left), getattr(self, right)
            if not (a < b or (sign == "<=" and a == b)):
                found.append(((left, right), f"{a} is not {sign} {right} = {b}"))
        if found:
            raise FieldFaults(*found)
        return self


def described(table: type[Table] | Table) -> dict[str, tuple[FieldInfo, Is]]:
    """Fields of a table that are values, by their names."""
    kind = table if isinstance(table, type) else type(table)
    return {
        name: (field, what)
        for name, field in kind.model_fields.items()
        for what in field.metadata
        if isinstance(what, Is)
    }


def choices(field: FieldInfo) -> tuple[str, ...]:
    """Words that a field may have; empty if it is no choice."""
    kind: Any = field.annotation
    return get_args(kind) if get_origin(kind) is Literal else ()


def numbers(table: Table) -> dict[str, WholeNumber]:
    """Whole numbers of a table's fields, by their names; texts have none."""
    found = {}
    pulses_per_mm = getattr(table, "pulses_per_mm", 1.0)
    for name, (field, what) in described(table).items():
        value = getattr(table, name)
        words = choices(field)
        if words:
            of_words = replace(what, low=0, high=len(words) - 1, suffix="U")
            found[name] = WholeNumber(of_words, words.index(value), value)
        elif not isinstance(value, str):
            scale = what.factor * (pulses_per_mm if what.pulses else 1.0)
            near = max(-FAR, min(FAR, value))  # a whole number may have any size
            found[name] = WholeNumber(what, round(near * scale), value)
    return found
