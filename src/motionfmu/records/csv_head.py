"""The head of a text of columns: names and units, as drives and oscilloscopes write them."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from motionfmu.records.csv_dialect import Dialect, Field, OpenQuote, fields, is_comment, is_value
from motionfmu.records.quantities import is_unit, name_and_unit

# The first entries of lines of TwinCAT Scope's head; each channel has its own such line.
_SCOPE = "Name"
_SCOPE_ROWS = ("SymbolComment", "Data-Type", "SampleTime[ms]")


@dataclass(frozen=True)
class Head:
    """Names and units of columns; `places` are line and character of each, from 1."""

    names: list[str]
    units: list[str | None]
    places: list[tuple[int, int]]
    started: tuple[float, float] | None = None  # [s] start and step
    notes: list[str] = field(default_factory=list)
    times: tuple[int, ...] = ()  # columns of times, where a file has one for each channel


def nameless(k: int) -> str:
    """What a column is called that has no name, from 0."""
    return f"c{k + 1}"


# CCN 20: a chain of formats, then comprehensions over the columns.
def head_of(lines: Sequence[str], first: int, width: int, dialect: Dialect) -> Head:
    """The head above a block of numbers that begins at a line and has so many columns."""
    rows = [(k, _fields(lines[k], dialect)) for k in range(first) if lines[k].strip()]
    if found := _twincat(rows, width):
        return found
    if found := _rigol(rows, width):
        return found
    fits = [(k, row) for k, row in rows if _full(row, width) and not _numbers(row, dialect)]
    if not fits:
        names = [nameless(i) for i in range(width)]
        note = f"no line of names: columns are c1 to c{width}" if width > 1 else "no name: c1"
        return Head(names, [None] * width, [(first + 1, 1)] * width, notes=[note])
    number, row = fits[-1]
    below: list[Field] | None = None
    if len(fits) > 1 and fits[-2][0] < number and _only_units(row):
        below, (number, row) = row, fits[-2]
    names, units = [], []
    for i in range(width):
        name, unit = name_and_unit(row[i].text)
        if below is not None and below[i].text.strip():
            unit = below[i].text.strip().strip("[]()").strip() or unit
        names.append(name or nameless(i))
        units.append(unit)
    return Head(names, units, [(number + 1, row[i].column) for i in range(width)])


def _fields(line: str, dialect: Dialect) -> list[Field]:
    """The entries of a line of the head; a comment's without its sign."""
    bare = line.lstrip()
    cut = len(line) - len(bare)
    if is_comment(line):
        bare = bare.lstrip("#%!/")
        cut = len(line) - len(bare)
    try:
        found = fields(bare, dialect.delimiter)
    except OpenQuote:
        return []
    return [Field(f.text, f.column + cut) for f in found]


def _full(row: Sequence[Field], width: int) -> bool:
    """Whether a line has an entry for each column; empty ones at its end do not count."""
    while len(row) > width and not row[-1].text:
        row = row[:-1]
    return len(row) == width and any(f.text for f in row)


def _numbers(row: Sequence[Field], dialect: Dialect) -> bool:
    """Whether a line of the head is rather one of numbers."""
    return is_value(row[0].text, dialect.decimal)


def _only_units(row: Sequence[Field]) -> bool:
    """Whether a line under the names is one of units."""
    texts = [f.text for f in row if f.text.strip()]
    return bool(texts) and all(
        (t[0] in "[(" and t[-1] in "])") or is_unit(t) or t in ("Volt", "%") for t in texts
    )


# CCN 16: comprehensions over the columns of one kind of head.
def _twincat(rows: Sequence[tuple[int, list[Field]]], width: int) -> Head | None:
    """TwinCAT Scope: a line for each property, and a column of times headed by its name."""
    named = {row[0].text: (k, row) for k, row in rows if row}
    if _SCOPE not in named or not all(n in named for n in _SCOPE_ROWS):
        return None
    number, row = named[_SCOPE]
    row = row[:width] + [Field("", 1)] * (width - len(row))
    below = named.get("Unit", (0, []))[1]
    units: list[str | None] = []
    for i, entry in enumerate(row):
        written = below[i].text if i < len(below) else ""
        units.append("ms" if entry.text == _SCOPE else written if written != "(None)" else None)
    times = tuple(i for i, entry in enumerate(row) if entry.text == _SCOPE)
    names = ["time" if i in times else f.text or nameless(i) for i, f in enumerate(row)]
    return Head(names, units, [(number + 1, f.column) for f in row], times=times)


def _rigol(rows: Sequence[tuple[int, list[Field]]], width: int) -> Head | None:
    """Rigol: samples are counted, and start and step stand in the second line."""
    for (number, row), (_, below) in pairwise(rows):
        words = [f.text.lower() for f in row]
        if "start" not in words or "increment" not in words or len(below) < len(words[:1]):
            continue
        try:
            start, step = (float(below[words.index(w)].text) for w in ("start", "increment"))
        except (ValueError, IndexError):
            continue
        count = min(width, words.index("start"))
        names = [row[i].text if i < count else nameless(i) for i in range(width)]
        units: list[str | None] = [below[i].text if i < count else None for i in range(width)]
        units = [None if u == "Sequence" else u for u in units]
        places = [(number + 1, row[min(i, count - 1)].column) for i in range(width)]
        return Head(names, units, places, (start, step))
    return None
