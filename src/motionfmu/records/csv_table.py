"""A text of columns, as drives, oscilloscopes and spreadsheets write it, as numbers."""

import codecs
import datetime
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError
from motionfmu.records.csv_dialect import (
    BOOLEANS,
    HEX,
    MISSING,
    NUMBERS,
    STAMP,
    Dialect,
    Field,
    OpenQuote,
    fields,
    found_in,
    is_comment,
)
from motionfmu.records.csv_head import Head, head_of, nameless
from motionfmu.records.layout import Layout
from motionfmu.records.raw_table import RawTable

Array = NDArray[Any]
# A text of this size takes ten times as much memory; what is larger is a Parquet file's business.
SIZE_MAX = 1 << 30  # [bytes]
_MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
_END = re.compile(r"\r\n|\n|\r")
_THOUSANDS = re.compile(r"[+-]?[0-9]{1,3}(?:[.,' ][0-9]{3})+(?:[.,][0-9]+)?")
_LAST = ("eof", "[eof]", "end", "#eof")  # what ends a text


@dataclass(frozen=True)
class NumberLines:
    """The lines of numbers of a text."""

    name: str
    lines: list[str]
    rows: Array  # numbers of the lines, from 0
    dialect: Dialect
    width: int  # with columns that are always empty
    kept: list[int]  # columns that may have numbers


# CCN 16: the steps of reading, each with what the caller may have said of it.
def csv_table(file: Path, layout: Layout) -> RawTable:
    """Read a text of columns; what is wrong is one InputError with line and character."""
    lines = _END.split(_text(file, layout))
    name = str(file)
    dialect, block = found_in(lines, layout, name)
    width = block.width
    above = _above(lines, block.first, (dialect, width), layout)
    head = head_of(lines[layout.skip :], (above or [block.first])[0] - layout.skip, width, dialect)
    short = bool(head.times) and dialect.delimiter is not None
    below = _rows(lines, block.first, (dialect, width, short), name)
    rows = np.array([*above, *below], dtype=np.int64)
    cells = fields(lines[block.first], dialect.delimiter)
    body = NumberLines(
        name, lines, rows, dialect, width, [k for k in range(width) if cells[k].text or not above]
    )
    values, stamps, kept = _columns(body, head, layout)
    body = NumberLines(name, lines, rows, dialect, width, kept)
    names = [head.names[k] for k in kept]
    units = [head.units[k] for k in kept]
    if layout.names is not None:
        if len(layout.names) != len(kept):
            told = f"names: {len(layout.names)} for {len(kept)} columns"
            raise InputError(f"{name}:{int(rows[0]) + 1}:1: {told}")
        pairs = [_named(n) for n in layout.names]
        names, units = (
            [n for n, _ in pairs],
            [u or v for (_, u), v in zip(pairs, units, strict=True)],
        )

    def where(row: int, column: int) -> str:
        k = kept[column]
        if row < 0:
            line, place = head.places[k]
            return f"{name}:{line + layout.skip}:{place}"
        line = int(rows[row])
        place = _row(body, line)[k].column
        return f"{name}:{line + 1}:{place}"

    found = RawTable(name, names, units, values, where, rows + 1, head.notes, stamps, head.started)
    return _one_of_times(found, [kept.index(k) for k in head.times if k in kept], layout)


def _named(text: str) -> tuple[str, str | None]:
    from motionfmu.records.quantities import name_and_unit

    return name_and_unit(text)


def _text(file: Path, layout: Layout) -> str:
    """The text of a file."""
    try:
        size = file.stat().st_size
        if size > SIZE_MAX:
            raise InputError(f"{file}: {size / 1e9:.3g} GB; {SIZE_MAX / 1e9:.3g} are the most")
        data = file.read_bytes()
    except OSError as error:
        raise InputError(f"{file}: {error.strerror}") from None
    if not data.strip():
        raise InputError(f"{file}: nothing in it")
    if layout.encoding is not None:
        return _decoded(file, data, layout.encoding)
    for mark, encoding in _MARKS:
        if data.startswith(mark):
            return _decoded(file, data, encoding)
    if b"\0" in data:
        raise InputError(f"{file}:{_place(data, data.index(0))}: no text, it has a NUL")
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        return data.decode("cp1252", errors="replace")


def _decoded(file: Path, data: bytes, encoding: str) -> str:
    try:
        return data.decode(encoding)
    except LookupError:
        raise InputError(f"record: encoding = {encoding!r}: no such encoding") from None
    except UnicodeError as error:
        start = getattr(error, "start", 0)
        told = f"no {encoding} text, byte {data[start]:#04x}"
        raise InputError(f"{file}:{_place(data, start)}: {told}") from None


def _place(data: bytes, byte: int) -> str:
    """Line and byte of the line, from 1, of a byte of a file."""
    before = data[:byte]
    line, begin = before.count(b"\n") + 1, before.rfind(b"\n")
    return f"{line}:{byte - begin}"


# CCN 16: what may stand between, above and behind lines of numbers, each with its rule.
def _rows(
    lines: Sequence[str], first: int, found: tuple[Dialect, int, bool], name: str
) -> list[int]:
    """Numbers of the lines of numbers, from 0; some may be short where channels end early."""
    dialect, width, short = found
    kept = []
    for number in range(first, len(lines)):
        line = lines[number]
        if not line.strip() or is_comment(line):
            continue
        if line.strip().strip('"').lower() in _LAST:
            break
        try:
            own = line.count(dialect.delimiter) + 1 if dialect.delimiter and '"' not in line else 0
            own = own or len(fields(line, dialect.delimiter))
        except OpenQuote as open_:
            told = "a quote that is not closed"
            raise InputError(f"{name}:{number + 1}:{open_.column}: {told}") from None
        if own != width and not (short and own < width):
            row = fields(line, dialect.delimiter)
            while len(row) > width and not row[-1].text:
                row.pop()
            if len(row) != width:
                place = row[width].column if len(row) > width else len(line.rstrip("\r")) + 1
                words = f"{len(row)} field{'s' * (len(row) != 1)}, {width} wanted"
                told = f"{words} (columns parted by {dialect.words})"
                raise InputError(f"{name}:{number + 1}:{place}: {told}")
        kept.append(number)
    return kept


def _above(
    lines: Sequence[str], first: int, found: tuple[Dialect, int], layout: Layout
) -> list[int]:
    """Lines above that have words of the head, and beside them numbers, as Tektronix has."""
    dialect, width = found
    empty = [k for k, f in enumerate(fields(lines[first], dialect.delimiter)) if not f.text]
    used = [k for k in range(width) if k not in empty]
    if not empty or not used or empty[0] != 0:
        return []
    number = NUMBERS[dialect.decimal]
    rows = []
    for k in range(layout.skip, first):
        try:
            row = fields(lines[k], dialect.delimiter)
        except OpenQuote:
            return []
        if len(row) == width and all(number.fullmatch(row[i].text) for i in used):
            rows.append(k)
    return rows if rows == list(range(layout.skip, first)) else []


def _columns(
    body: NumberLines, head: Head, layout: Layout
) -> tuple[list[Array], frozenset[int], list[int]]:
    """Values of the columns that are not empty, which are times of day, which are kept."""
    quick = _quick(body)
    if quick is not None:
        return [quick[:, k] for k in range(body.width)], frozenset(), list(range(body.width))
    rows = [_row(body, int(k)) for k in body.rows]
    values: list[Array] = []
    stamps: set[int] = set()
    kept: list[int] = []
    for k in range(body.width):
        column = [row[k] for row in rows]
        bare = head.names[k] == nameless(k) and not any(f.text for f in column)
        if bare or k not in body.kept:
            continue
        if any(STAMP.fullmatch(f.text) for f in column[:1]):
            stamps.add(len(kept))
            values.append(_stamped(body, k, column, head))
        else:
            values.append(_parsed(body, k, column, (head, layout)))
        kept.append(k)
    return values, frozenset(stamps), kept


def _row(body: NumberLines, number: int) -> list[Field]:
    """The entries of a line, as many as there are columns."""
    found = fields(body.lines[number], body.dialect.delimiter)
    return found + [Field("", len(body.lines[number]) + 1)] * (body.width - len(found))


def _quick(body: NumberLines) -> Array | None:
    """All numbers by numpy's own reader; None if there is anything but plain numbers."""
    delimiter, decimal = body.dialect.delimiter, body.dialect.decimal
    lines = [body.lines[int(k)] for k in body.rows]
    if decimal == ",":
        if delimiter == ",":
            return None
        lines = [line.replace(",", ".") for line in lines]
    text = "".join(lines[:1] + lines[-1:])
    if '"' in text:
        return None
    try:
        found = np.loadtxt(lines, delimiter=delimiter, comments=None, ndmin=2, quotechar=None)
    except (ValueError, OverflowError):
        return None
    good = found.shape[1] == body.width and bool(np.isfinite(found).all())
    if not good or (decimal == "," and any("." in body.lines[int(k)] for k in body.rows)):
        return None
    return found


def _parsed(body: NumberLines, k: int, column: Sequence[Field], told: tuple[Head, Layout]) -> Array:
    """The numbers of a column; what is none is an InputError."""
    head, layout = told
    number, swap = NUMBERS[body.dialect.decimal], body.dialect.decimal == ","
    found = np.empty(len(column))
    for row, entry in enumerate(column):
        text = entry.text
        if number.fullmatch(text):
            plain = text.replace(",", ".") if swap else text
            value = float(plain.replace("d", "e").replace("D", "e"))
            if not np.isfinite(value):
                raise _error(body, row, entry, f"{head.names[k]} = {text!r}: beyond all numbers")
            found[row] = value
        elif text.lower() in MISSING or text in layout.missing:
            found[row] = np.nan
        elif text.lower() in BOOLEANS:
            found[row] = BOOLEANS[text.lower()]
        elif HEX.fullmatch(text):
            found[row] = int(text[text.index("#") + 1 :] if "#" in text else text, 16)
        else:
            raise _error(body, row, entry, f"{head.names[k]} = {text!r}: {_why(text, body)}")
    return found


def _error(body: NumberLines, row: int, entry: Field, told: str) -> InputError:
    return InputError(f"{body.name}:{int(body.rows[row]) + 1}:{entry.column}: {told}")


def _why(text: str, body: NumberLines) -> str:
    """What is wrong with an entry that is no number."""
    sign = body.dialect.decimal
    other = "," if sign == "." else "."
    if _THOUSANDS.fullmatch(text):
        return "a number without signs between its thousands wanted"
    if NUMBERS[other].fullmatch(text):
        first = int(body.rows[0]) + 1
        return f'"{other}" where other numbers have "{sign}" (line {first}); say decimal'
    if STAMP.fullmatch(text):
        return "a time of day among numbers"
    return "a number wanted"


def _stamped(body: NumberLines, k: int, column: Sequence[Field], head: Head) -> Array:
    """Times of day [ns], since the first midnight or since 1970."""
    found = np.empty(len(column), dtype=np.int64)
    day, last = 0, -1
    for row, entry in enumerate(column):
        match = STAMP.fullmatch(entry.text)
        if match is None:
            raise _error(
                body, row, entry, f"{head.names[k]} = {entry.text!r}: a time of day wanted"
            )
        year, month, date, date_, month_, year_, hour, minute, second, part = match.groups()
        seconds = int(hour) * 3600 + int(minute) * 60 + int(second)
        if int(hour) > 23 or int(minute) > 59 or int(second) > 59:
            raise _error(body, row, entry, f"{head.names[k]} = {entry.text!r}: no time of day")
        dated = (year or year_, month or month_, date or date_)
        if dated[0]:
            try:
                since = datetime.date(*map(int, dated)) - datetime.date(1970, 1, 1)
            except ValueError as error:
                told = f"{head.names[k]} = {entry.text!r}: {error}"
                raise _error(body, row, entry, told) from None
            day = since.days
        ns = seconds * 10**9 + int((part or "").ljust(9, "0") or 0)
        if not dated[0] and ns < last - 43_200 * 10**9:  # midnight has passed
            day += 1
        last = ns
        found[row] = day * 86_400 * 10**9 + ns
    return found


# CCN 24: comprehensions over channels; there is one decision, which columns of times to keep.
def _one_of_times(table: RawTable, times: Sequence[int], layout: Layout) -> RawTable:
    """The columns that share one column of times; those of others are left out, or an error."""
    if not times:
        return table
    groups = [list(range(a, b)) for a, b in zip(times, [*times[1:], len(table.names)], strict=True)]
    asked = layout.time
    chosen = groups[0]
    if asked is not None:
        fits = [g for g in groups if asked in (table.names[k] for k in g)]
        if not fits:
            raise InputError(f"{table.name}: time = {asked!r}: no channel of this name")
        chosen = fits[0]
    first = table.values[chosen[0]]
    same = [g for g in groups if np.array_equal(table.values[g[0]], first, equal_nan=True)]
    others = [g for g in groups if g not in same]
    if others and asked is None:
        k = others[0][0]
        a, b = (table.names[g[1]] if len(g) > 1 else "" for g in (chosen, others[0]))
        told = f"{a!r} and {b!r} have times of their own"
        raise InputError(f"{table.where(-1, k)}: {told}: say time = one of them")
    keep = [chosen[0], *(k for g in same for k in g[1:])]
    rows = np.flatnonzero(~np.isnan(first))
    lines = None if table.lines is None else table.lines[rows]
    notes = [*table.notes, *([f"{len(others)} columns of other times left out"] if others else [])]
    return RawTable(
        table.name,
        [table.names[k] for k in keep],
        [table.units[k] for k in keep],
        [table.values[k][rows] for k in keep],
        lambda row, column: table.where(int(rows[row]) if row >= 0 else row, keep[column]),
        lines,
        notes,
        timed=0,
    )
