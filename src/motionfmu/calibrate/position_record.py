"""A positioning test of an axis (ISO 230-2) as software of laser interferometers writes it."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.positioning import PositioningTest
from motionfmu.base.errors import InputError
from motionfmu.base.toml_lines import text_of
from motionfmu.base.units import parse
from motionfmu.records.quantities import name_and_unit, quantity

Array = NDArray[np.float64]
# Names of columns, in small letters.
TARGETS = ("target", "nominal", "soll", "sollposition", "zielposition")
PLACES = ("position", "measured", "actual", "reading", "ist", "istposition", "laser")
DEVIATIONS = ("deviation", "error", "abweichung", "dev")
DIRECTIONS = ("direction", "approach", "dir", "richtung")
RUNS = ("run", "cycle", "series", "lauf", "repetition")
UP = ("+", "+1", "1", "up", "u", "pos", "positive", "forward", "fwd", "↑", "auf", "vor")
DOWN = ("-", "-1", "2", "down", "d", "neg", "negative", "backward", "reverse", "↓", "ab", "zurück")
MM, MICRON = parse("mm"), 1e-3  # of lengths; [mm]
# No axis is this far from its target [mm]: the unit is not what it seems.
FARTHEST = 5.0
SAME = 1e-6  # [mm] targets that differ by less are one
FEWEST_TARGETS = 3
_AXIS = re.compile(r"^\W*axis(?:\s+name)?\s*[:=;,\t ]\s*\"?([A-Za-z]\d?)\b", re.IGNORECASE)
_SECTION = re.compile(r"^([A-Z][A-Z0-9 -]*)::")


@dataclass(frozen=True)
class PositionRecord:
    """A positioning test that a file holds.

    Attributes
    ----------
    name : str
        Of the file.
    axis : str
        Name of the axis, if the file says it; else empty.
    test : PositioningTest
        Deviations [mm].
    notes : tuple of str
        What was taken for granted.
    """

    name: str
    axis: str
    test: PositioningTest
    notes: tuple[str, ...] = ()


@dataclass
class _Readings:
    """Deviations [mm] by target and direction, in the order of the file."""

    file: Path
    at: dict[tuple[float, int], list[float]] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)

    def add(self, target: float, way: int, deviation: float, line: int) -> None:
        """Take one reading."""
        if abs(deviation) > FARTHEST:
            told = f"{deviation:.6g} mm beside its target {target:g} mm"
            wanted = "are these millimetres? [µm] in the heading says otherwise"
            raise InputError(f"{self.file}: line {line}: {told}: {wanted}")
        same = next((t for t, _ in self.at if abs(t - target) < SAME), target)
        self.at.setdefault((same, way), []).append(deviation)

    def test(self) -> PositioningTest:
        """All of them as a test."""
        targets = sorted({t for t, _ in self.at})
        if len(targets) < FEWEST_TARGETS:
            told = f"{len(targets)} targets, {FEWEST_TARGETS} at least wanted"
            raise InputError(f"{self.file}: {told}")
        counts = {(t, w): len(self.at.get((t, w), ())) for t in targets for w in (1, -1)}
        usual = max(set(counts.values()), key=list(counts.values()).count)
        for (target, way), count in counts.items():
            if count != usual or count < 2:
                side = "upwards" if way > 0 else "downwards"
                told = f"target {target:g} mm is approached {side} {count} times"
                wanted = f"{usual} as most are" if usual >= 2 else "two at least"
                raise InputError(f"{self.file}: {told}, {wanted} wanted")
        both = [np.array([self.at[t, w] for t in targets]).T for w in (1, -1)]
        return PositioningTest(np.array(targets), *both)


def position_record(file: str | Path) -> PositionRecord:
    """Read a positioning test.

    Parameters
    ----------
    file : str or Path
        A table with a row a reading: target, position or deviation, and a direction or the order in
        which targets follow. Or one with a row a target and a column an approach (``1 up``,
        ``1 down``, ...). Or an .rtl of Renishaw's laser software.

    Returns
    -------
    PositionRecord

    Raises
    ------
    InputError
        What is wrong, with file, line and value.
    """
    path = Path(file)
    text = text_of(path).lstrip("\ufeff")
    lines = text.splitlines()
    readings = _Readings(path)
    if any(_SECTION.match(line.strip()) for line in lines):
        _rtl(readings, lines)
    else:
        _table(readings, lines)
    axis = next((m[1].upper() for line in lines[:60] if (m := _AXIS.match(line))), "")
    return PositionRecord(str(path), axis, readings.test(), tuple(readings.notes))


def is_position_record(file: Path) -> bool:
    """Whether a file has targets, as no other record here has."""
    if not file.is_file() or file.suffix.lower() in (".parquet", ".mat"):
        return False
    lines = text_of(file).lstrip("\ufeff").splitlines()
    if any(_SECTION.match(line.strip()) for line in lines):
        return True
    return _head(lines) is not None


def _cells(line: str, mark: str) -> list[str]:
    parts = line.split(mark) if mark != " " else line.split()
    return [p.strip().strip('"') for p in parts]


def _head(lines: Sequence[str]) -> tuple[int, str, list[str]] | None:
    """Row of the headings, what separates cells, and the headings; None if there are none."""
    for row, line in enumerate(lines):
        for mark in (";", "\t", ",", "|", " "):
            cells = _cells(line.lstrip("# "), mark)
            if mark == " " and line.startswith("#"):
                continue  # a sentence
            if len(cells) > 1 and any(_name(c) in TARGETS for c in cells):
                return row, mark, cells
    return None


def _name(heading: str) -> str:
    """A heading without its unit, in small letters."""
    return name_and_unit(heading)[0].strip(" _").lower()


def _unit(file: Path, heading: str, line: int) -> float:
    """Factor to mm of a heading's unit; without one it is mm."""
    name = name_and_unit(heading)[1] or MM.name
    try:
        found = quantity(name)
    except ValueError:
        found = None
    if found is None or found.exponents != MM.exponents:
        raise InputError(f"{file}: line {line}: {heading!r}: {name!r} is no length")
    return float(found.factor / MM.factor)


def _number(file: Path, line: int, text: str, comma: bool) -> float:
    shown = text.replace(",", ".") if comma else text
    try:
        value = float(shown.replace("\u2212", "-"))
    except ValueError:
        raise InputError(f"{file}: line {line}: {text!r} is no number") from None
    if not np.isfinite(value):
        raise InputError(f"{file}: line {line}: {text!r} is no finite number")
    return value


def _table(readings: _Readings, lines: Sequence[str]) -> None:
    """Read a table with headings."""
    found = _head(lines)
    file = readings.file
    if found is None:
        first = next((line.strip() for line in lines if line.strip()), "")
        told = f"it begins with {first[:60]!r}" if first else "nothing is in it"
        raise InputError(
            f"{file}: no column of targets: {', '.join(TARGETS)} or .rtl wanted; {told}"
        )
    row, mark, heads = found
    names = [_name(h) for h in heads]
    rows = [
        (n, _cells(line, mark))
        for n, line in enumerate(lines[row + 1 :], row + 2)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    for n, cells in rows:
        if len(cells) != len(heads):
            told = f"{len(cells)} cells under {len(heads)} headings"
            raise InputError(f"{file}: line {n}: {told}: {lines[n - 1].strip()!r}")
    if not rows:
        raise InputError(f"{file}: line {row + 1}: nothing below the headings")
    value = next((k for k, n in enumerate(names) if n in (*DEVIATIONS, *PLACES)), None)
    if value is None:
        _matrix(readings, (row + 1, heads, names), rows, mark != ",")
    else:
        _list(readings, (row + 1, heads, names), rows, mark != ",")


Heads = tuple[int, list[str], list[str]]  # line, headings, their names
Rows = list[tuple[int, list[str]]]  # line and cells of each


def _place(names: Sequence[str], *kinds: Sequence[str]) -> int | None:
    """The first column whose name is of the first kind that there is."""
    every = (k for kind in kinds for k, n in enumerate(names) if n in kind)
    return next(every, None)


def _list(readings: _Readings, head: Heads, rows: Rows, comma: bool) -> None:
    """A row a reading."""
    line, heads, names = head
    file = readings.file
    target, value = _place(names, TARGETS), _place(names, DEVIATIONS, PLACES)
    told = _place(names, DIRECTIONS)
    assert target is not None and value is not None
    factors = _unit(file, heads[target], line), _unit(file, heads[value], line)
    targets = np.array([factors[0] * _number(file, n, c[target], comma) for n, c in rows])
    if told is None:
        ways = _by_order(file, rows, targets)
        readings.notes.append("directions are those in which its targets follow one another")
    else:
        ways = [_way(file, n, c[told]) for n, c in rows]
    for (n, cells), at, way in zip(rows, targets.tolist(), ways, strict=True):
        size = factors[1] * _number(file, n, cells[value], comma)
        readings.add(at, way, size - (0.0 if names[value] in DEVIATIONS else at), n)


def _way(file: Path, line: int, text: str) -> int:
    small = text.lower()
    if small in UP:
        return 1
    if small in DOWN:
        return -1
    raise InputError(f"{file}: line {line}: direction {text!r}: up or down, + or - wanted")


def _by_order(file: Path, rows: Rows, targets: Array) -> list[int]:
    """Directions by the order of targets: one that comes twice is approached from behind."""
    steps = np.sign(np.diff(targets, prepend=np.nan))
    if len(targets) < 2 or targets[1] == targets[0]:
        raise InputError(f"{file}: line {rows[0][0]}: no direction can be told of its first target")
    steps[0] = np.sign(targets[1] - targets[0])
    ways: list[int] = []
    for step in steps.tolist():
        ways.append(int(step) if step else -ways[-1])
    return ways


def _matrix(readings: _Readings, head: Heads, rows: Rows, comma: bool) -> None:
    """A row a target, a column an approach."""
    line, heads, names = head
    file = readings.file
    target = _place(names, TARGETS)
    assert target is not None
    scale = _unit(file, heads[target], line)
    columns = [
        (k, _heading_way(file, heading, line), _unit(file, heading, line))
        for k, heading in enumerate(heads)
        if k != target and heading
    ]
    numbers = [[_number(file, n, c, comma) for c in cells] for n, cells in rows]
    targets = np.array([scale * r[target] for r in numbers])
    values = np.array([[f * r[k] for k, _, f in columns] for r in numbers])
    # Positions grow with their targets, deviations do not.
    span = float(np.ptp(targets))
    places = bool(span > 0.0 and (np.ptp(values, axis=0) > 0.5 * span).all())
    readings.notes.append(f"its cells are {'positions' if places else 'deviations'}")
    for r, (n, _) in enumerate(rows):
        at = float(targets[r])
        for c, (_, way, _) in enumerate(columns):
            readings.add(at, way, float(values[r, c]) - (at if places else 0.0), n)


def _heading_way(file: Path, heading: str, line: int) -> int:
    """Direction that the heading of a column says, such as ``1 up``."""
    words = re.split(r"[\s_.:#]+|(?<=\d)(?=[^\d\s])", _name(heading))
    ways = [way for word in words if (way := _word_way(word))]
    if len(ways) != 1:
        told = f"heading {heading!r} says no direction: '1 up', '1 down' wanted"
        raise InputError(f"{file}: line {line}: {told}")
    return ways[0]


def _word_way(word: str) -> int:
    """Direction that a word of a heading says; 0 for none. A bare number is that of a run."""
    if word.isdigit():
        return 0
    if word in UP or (word.startswith("+") and word[1:].isdigit()):
        return 1
    return -1 if word in DOWN or (word.startswith("-") and word[1:].isdigit()) else 0


# CCN 21: a section after another, each with the rows that it has.
def _rtl(readings: _Readings, lines: Sequence[str]) -> None:
    """An .rtl: sections with targets [mm], and run, number of the target, deviation [µm]."""
    file = readings.file
    section, listed = "", ""
    targets: list[float] = []
    runs: dict[int, list[tuple[int, float, int]]] = {}
    for n, line in enumerate(lines, 1):
        text = line.strip()
        if found := _SECTION.match(text):
            section, listed = found[1].strip(), ""
        elif ":" in text:
            listed = text.partition(":")[0].strip().lower()
        elif section == "TARGET DATA" and listed == "targets":
            targets += [_number(file, n, word, False) for word in text.split()]
        elif section == "DEVIATIONS" and listed == "run target data" and text:
            words = text.split()
            if len(words) != 3:
                raise InputError(f"{file}: line {n}: {text!r}: run, target, deviation wanted")
            run, number, value = (_number(file, n, w, False) for w in words)
            if not 1 <= number <= len(targets):
                told = f"target {number:g} of {len(targets)}"
                raise InputError(f"{file}: line {n}: {told}")
            runs.setdefault(int(run), []).append((int(number), value, n))
    if not runs:
        raise InputError(f"{file}: no rows below 'Run Target Data:' of DEVIATIONS::")
    readings.notes.append("targets in mm, deviations in µm, odd runs in the order of targets")
    for run, rows in sorted(runs.items()):
        # runs go there and back; rows that stand in the order of their time say it themselves
        numbers = [number for number, _, _ in rows]
        way = 1 if run % 2 else -1
        if numbers == sorted(numbers, reverse=True) and len(numbers) > 1:
            way = -1
        if targets[-1] < targets[0]:
            way = -way
        for number, value, n in rows:
            readings.add(targets[number - 1], way, MICRON * value, n)
