"""How a text of columns is written: its delimiter, its decimal sign, where its numbers begin."""

import contextlib
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from motionfmu.base.errors import InputError
from motionfmu.records.layout import Layout

# A text is judged by so many lines at its top; heads are shorter.
LOOKED_AT = 400
COMMENTS = ("#", "%", "!", "//")
_POINT = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eEdD][+-]?[0-9]+)?")
_COMMA = re.compile(r"[+-]?(?:[0-9]+(?:,[0-9]+)?|,[0-9]+)(?:[eEdD][+-]?[0-9]+)?")
NUMBERS = {".": _POINT, ",": _COMMA}
HEX = re.compile(r"(?:0[xX]|16#)[0-9a-fA-F]+")
# A time of day, with or without a date before it: 2026-11-27T09:01:53.125, 27.11.2026 09:01:53,125.
STAMP = re.compile(
    r"(?:(?:(\d{4})[-/.](\d{1,2})[-/.](\d{1,2})|(\d{1,2})\.(\d{1,2})\.(\d{4}))[T ]+)?"
    r"(\d{1,2}):(\d{2}):(\d{2})(?:[.,](\d{1,9}))?Z?"
)
# What stands for no value. A scope writes an infinity where its range was not enough.
MISSING = {
    "",
    "nan",
    "na",
    "n/a",
    "#n/a",
    "null",
    "none",
    "-",
    "--",
    "missing",
    "no data",
    "nodata",
}
MISSING |= {"inf", "+inf", "-inf", "∞", "-∞", "+∞", "1.#qnan", "1.#ind", "-1.#ind", "-nan(ind)"}
MISSING |= {"infinity", "-infinity", "undefined", "bad", "overflow", "***", "?"}
BOOLEANS = {"true": 1.0, "false": 0.0, "on": 1.0, "off": 0.0}


@dataclass(frozen=True)
class Dialect:
    """How columns are parted and numbers written."""

    delimiter: str | None  # None: runs of blanks
    decimal: str

    @property
    def words(self) -> str:
        """The delimiter as a reader knows it."""
        known = {None: "blanks", "\t": "tab", ";": "semicolon", ",": "comma"}
        return known.get(self.delimiter, repr(self.delimiter))


@dataclass(frozen=True)
class Field:
    """One entry of a line, and the character at which it begins, from 1."""

    text: str
    column: int


class OpenQuote(ValueError):
    """A quote that is not closed on its line; the character at which it begins, from 1."""

    def __init__(self, column: int) -> None:
        super().__init__(f"column {column}")
        self.column = column


def fields(line: str, delimiter: str | None) -> list[Field]:
    """The entries of a line, without quotes and blanks around them."""
    if delimiter is None:
        return [Field(m[0].strip('"'), m.start() + 1) for m in re.finditer(r'"[^"]*"|\S+', line)]
    found: list[Field] = []
    place = 0
    while True:
        begin = place
        while begin < len(line) and line[begin] in " \t" and line[begin] != delimiter:
            begin += 1
        if begin < len(line) and line[begin] == '"':
            text, place = _quoted(line, begin)
            end = line.find(delimiter, place)
            text += line[place : end if end >= 0 else len(line)].rstrip()
        else:
            end = line.find(delimiter, place)
            text = line[place : end if end >= 0 else len(line)].strip()
        found.append(Field(text, begin + 1))
        if end < 0:
            return found
        place = end + 1


def _quoted(line: str, begin: int) -> tuple[str, int]:
    """A text in quotes, and the place behind it; two quotes in it are one."""
    place, parts = begin + 1, []
    while True:
        end = line.find('"', place)
        if end < 0:
            raise OpenQuote(begin + 1)
        parts.append(line[place:end])
        if line[end + 1 : end + 2] != '"':
            return '"'.join(parts), end + 1
        place = end + 2


def is_comment(line: str) -> bool:
    """Whether a line is a comment."""
    return line.lstrip().startswith(COMMENTS)


def is_cell(text: str, decimal: str, missing: Sequence[str] = ()) -> bool:
    """Whether an entry may stand among numbers."""
    return is_value(text, decimal) or text.lower() in MISSING or text in missing


def is_value(text: str, decimal: str) -> bool:
    """Whether an entry is a number, a Boolean or a time of day."""
    return bool(
        NUMBERS[decimal].fullmatch(text)
        or text.lower() in BOOLEANS
        or HEX.fullmatch(text)
        or STAMP.fullmatch(text)
    )


def width(line: str, dialect: Dialect, layout: Layout) -> int:
    """How many columns a line of numbers has; 0 if it is none."""
    try:
        found = fields(line, dialect.delimiter)
    except OpenQuote:
        return 0
    cells = [is_cell(f.text, dialect.decimal, layout.missing) for f in found]
    values = [is_value(f.text, dialect.decimal) for f in found]
    return len(found) if all(cells) and any(values) else 0


def candidates(layout: Layout) -> Iterator[Dialect]:
    """What a text may be written in, the more likely first."""
    signs = [layout.decimal] if layout.decimal else [".", ","]
    wanted = [layout.delimiter] if layout.delimiter else ["\t", ";", ",", "|", None]
    for delimiter in wanted:
        for sign in signs:
            blank = None if delimiter == " " else delimiter
            # A comma that parts columns and is the decimal sign: only numbers in quotes have both.
            yield Dialect(blank, sign)


@dataclass(frozen=True)
class NumberBlock:
    """Where the numbers of a text begin, and how many columns they have."""

    first: int  # line, from 0
    width: int
    rows: int  # lines of the block among those that were looked at


def block(lines: Sequence[str], dialect: Dialect, layout: Layout) -> NumberBlock:
    """The longest run of lines of numbers with as many columns, among the first lines."""
    best, first, count, wide = NumberBlock(0, 0, 0), 0, 0, 0
    for number, line in enumerate(lines[: layout.skip + LOOKED_AT]):
        if number < layout.skip or not line.strip() or is_comment(line):
            continue
        own = width(line, dialect, layout)
        if own and own == wide:
            count += 1
        else:
            first, count, wide = number, bool(own), own
        if count > best.rows:
            best = NumberBlock(first, wide, int(count))
    return best


def found_in(lines: Sequence[str], layout: Layout, name: str) -> tuple[Dialect, NumberBlock]:
    """How a text is written; an InputError if it has no numbers, or may be read in two ways."""
    pairs = [(d, block(lines, d, layout)) for d in candidates(layout)]
    most = max(b.rows for _, b in pairs)
    if most == 0:
        raise InputError(_nothing(lines, layout, name))
    long = [(d, b) for d, b in pairs if b.rows == most]
    widest = max(b.width for _, b in long)
    dialect, chosen = next(p for p in long if p[1].width == widest)
    others = [(d, b) for d, b in long if b.width != widest and d.decimal != dialect.decimal]
    if dialect.delimiter == "," and others:
        return _of_two((dialect, chosen), others, lines, name)
    return dialect, chosen


def _of_two(
    comma: tuple[Dialect, NumberBlock],
    others: list[tuple[Dialect, NumberBlock]],
    lines: Sequence[str],
    name: str,
) -> tuple[Dialect, NumberBlock]:
    """Whole numbers and commas: columns, or decimals? The head tells by how many names it has."""
    for pair in (comma, *others):
        dialect, found = pair
        above = [s for s in lines[: found.first] if s.strip()]
        if above:
            with contextlib.suppress(OpenQuote):
                names = fields(above[-1].lstrip("#%! "), dialect.delimiter)
                if len(names) == found.width and (dialect.delimiter or found.width == 1):
                    return pair
    first = comma[1].first
    one, two = comma[1].width, others[0][1].width
    told = f"{lines[first].strip()!r} is {one} columns, or {two} with decimal commas"
    raise InputError(f"{name}:{first + 1}:1: {told}: say delimiter, or decimal")


def _nothing(lines: Sequence[str], layout: Layout, name: str) -> str:
    """Why a text has no numbers."""
    below = [(k, s) for k, s in enumerate(lines) if k >= layout.skip and s.strip()]
    if not below:
        return f"{name}: nothing in it"
    told = f"no line of numbers among the first {min(len(lines), LOOKED_AT)}"
    if layout.delimiter or layout.decimal:
        given = {"delimiter": layout.delimiter, "decimal": layout.decimal}
        shown = ", ".join(f"{k} = {v!r}" for k, v in given.items() if v)
        return f"{name}: {told} with {shown}"
    row, line = below[-1]
    return f"{name}:{row + 1}:1: {told}; the last one is {line.strip()[:60]!r}"
