"""How a file of measured data is laid out, as far as it does not say so itself."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields
from typing import Any

from motionfmu.base.errors import InputError, suggestion
from motionfmu.base.toml_lines import shown

DUPLICATES = ("refuse", "first", "last", "mean")
DECIMALS = (".", ",")
RATE_MAX = 1e9  # [Hz] times are whole ns
TIME_MAX = 2.0**62 / 1e9  # [s] 146 years
# Keys of the table of a column.
COLUMN_KEYS = ("column", "unit", "scale", "zero", "round")


@dataclass(frozen=True)
class Layout:
    """What a caller says of a file that does not say it itself.

    Attributes
    ----------
    columns : mapping
        By a name of one's own: the column's name in the file, a list of names, which become the
        elements of one column, or a table ``{column, unit, scale, zero, round}``: the value is
        scale (value - zero), with round = true the nearest whole number.
    time : str or None
        Name of the column of times.
    time_unit : str or None
        Its unit.
    rate : float or None
        Samples a second [Hz], of a file without times.
    offset : float or "start"
        Added to all times [s]; ``start``: the first sample is at 0.
    delimiter, decimal, encoding : str or None
        Of a text.
    skip : int
        Lines at the top that are passed over.
    names : sequence of str or None
        Of all columns of the file, if it has none, or others.
    duplicates : str
        Of samples of one time with other values: refuse, first, last or mean.
    missing : sequence of str
        Texts that stand for no value, beside an empty field, NaN, NA and the like.
    """

    columns: Mapping[str, Any] = field(default_factory=dict)
    time: str | None = None
    time_unit: str | None = None
    rate: float | None = None
    offset: float | str = 0.0
    delimiter: str | None = None
    decimal: str | None = None
    encoding: str | None = None
    skip: int = 0
    names: tuple[str, ...] | None = None
    duplicates: str = "refuse"
    missing: tuple[str, ...] = ()

    @classmethod
    def of(cls, given: Mapping[str, Any]) -> "Layout":
        """Make a layout of options by their names.

        Parameters
        ----------
        given : mapping
            None stands for an option that is not given.

        Raises
        ------
        InputError
            There is no such option, or its value is wrong.
        """
        known = [f.name for f in fields(cls)]
        for name in given:
            if name not in known:
                raise InputError(f"record: no option {name!r}{suggestion(name, known)}")
        found: dict[str, Any] = {
            k: tuple(v) if isinstance(v, list) else v for k, v in given.items()
        }
        made = cls(**{k: v for k, v in found.items() if v is not None})
        for told in _wrong(made):
            raise InputError(f"record: {told}")
        return made


def _wrong(x: Layout) -> list[str]:
    """What is wrong with a layout, the worst first."""
    told = []
    for key in ("time", "time_unit", "delimiter", "decimal", "encoding"):
        value = getattr(x, key)
        if value is not None and not (isinstance(value, str) and value):
            told.append(f"{key} = {shown(value)}: a text wanted")
    if told:
        return told
    told = [*_of_times(x), *_of_text(x)]
    if not isinstance(x.columns, Mapping):
        return [*told, f"columns = {shown(x.columns)}: columns by name wanted"]
    for name, column in x.columns.items():
        if text := _column(column):
            told.append(f"columns: {name} = {shown(column)}: {text}")
    return told


def _of_times(x: Layout) -> Iterator[str]:
    """What is wrong with what is said of times."""
    if x.rate is not None and not (_number(x.rate) and 0 < x.rate <= RATE_MAX):
        yield f"rate = {shown(x.rate)}: samples a second wanted, up to {RATE_MAX:g}"
    elif x.rate is not None and x.time is not None:
        yield f"rate = {x.rate:g} Hz and time = {x.time!r}: one of them"
    if x.offset != "start" and not (_number(x.offset) and abs(float(x.offset)) <= TIME_MAX):
        yield f'offset = {shown(x.offset)}: seconds or "start" wanted'
    if x.duplicates not in DUPLICATES:
        yield f"duplicates = {shown(x.duplicates)}: {', '.join(DUPLICATES)} wanted"


def _of_text(x: Layout) -> Iterator[str]:
    """What is wrong with what is said of a text."""
    if x.delimiter is not None and len(x.delimiter) != 1:
        yield f"delimiter = {x.delimiter!r}: one character wanted"
    if x.decimal is not None and x.decimal not in DECIMALS:
        yield f'decimal = {x.decimal!r}: "." or "," wanted'
    if x.decimal == x.delimiter == ",":
        yield 'delimiter and decimal are both ","'
    if isinstance(x.skip, bool) or not isinstance(x.skip, int) or x.skip < 0:
        yield f"skip = {shown(x.skip)}: a number of lines wanted"
    for key in ("names", "missing"):
        texts = getattr(x, key)
        if texts is not None and not _texts(texts):
            yield f"{key} = {shown(texts)}: a list of texts wanted"


def _texts(x: Any) -> bool:
    return isinstance(x, tuple | list) and all(isinstance(t, str) for t in x)


def _number(x: Any) -> bool:
    return isinstance(x, int | float) and not isinstance(x, bool) and math.isfinite(x)


# CCN 16: a rule for each key of a column, which know nothing of each other.
def _column(given: Any) -> str:
    """What is wrong with the entry of a column; else empty."""
    if isinstance(given, str) or (_texts(given) and given):
        return ""
    if not isinstance(given, Mapping):
        return "a column's name, a list of names or a table wanted"
    for key, value in given.items():
        if key not in COLUMN_KEYS:
            return f"unknown key {key!r}{suggestion(key, COLUMN_KEYS)}"
        if key in ("scale", "zero") and not _number(value):
            return f"{key} = {shown(value)}: a number wanted"
        if key == "round" and not isinstance(value, bool):
            return f"round = {shown(value)}: true or false wanted"
        if key == "unit" and not isinstance(value, str):
            return f"unit = {shown(value)}: a text wanted"
    if "column" not in given or _column(given["column"]) or isinstance(given["column"], Mapping):
        return "column = the name in the file is missing"
    return ""
