"""Columns as a file has them, and the record that is made of them."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base import units as si
from motionfmu.base.errors import InputError, suggestion
from motionfmu.base.units import spelled
from motionfmu.records.layout import TIME_MAX, Layout
from motionfmu.records.quantities import fmi_name, quantity
from motionfmu.records.signal_record import Record, grouped

Array = NDArray[Any]
# Names of a column of times, without regard to case.
TIMES = {"time", "t", "zeit", "timestamp", "time stamp", "x-axis", "second", "seconds", "sekunden"}
TIMES |= {"tout", "temps", "time_s", "zeitstempel", "abs time", "rel. time", "elapsed time"}
NS_MAX = TIME_MAX * 1e9  # [ns]
_SECOND = si.parse("s").exponents


@dataclass(frozen=True)
class RawTable:
    """Columns of a file.

    `where` says for a row and a column, from 0, where that stands: ``file:line:column``; for row -1
    the column's head. `stamps` are columns of times of day, whose values are ns.
    """

    name: str
    names: list[str]
    units: list[str | None]
    values: list[Array]
    where: Callable[[int, int], str]
    lines: Array | None = None
    notes: list[str] = field(default_factory=list)
    stamps: frozenset[int] = frozenset()
    started: tuple[float, float] | None = None  # [s] start and step that the head of a file tells
    timed: int | None = None  # the column of times, if that is known


class NoTimes(InputError):
    """A file has no column of times, and nobody has said a rate."""


def record_of(table: RawTable, layout: Layout) -> Record:
    """The record of a file's columns, laid out as a caller says."""
    notes = list(table.notes)
    table = _single(table, layout, notes)
    time = _time_column(table, layout)
    if time is None:
        ns, rows = _by_rate(table, layout, notes), np.arange(len(table.values[0]))
    else:
        ns = _times(table, time, layout, notes)
        ns, rows, table = _increasing(table, time, ns, layout, notes)
    if len(rows) < 2:
        raise InputError(f"{table.name}: {len(rows)} sample{'s' * (len(rows) != 1)}, two wanted")
    if layout.offset == "start":
        ns = ns - ns[0]
    elif abs(float(ns[-1])) + abs(float(layout.offset)) * 1e9 > NS_MAX:
        raise InputError(f"{table.name}: offset = {layout.offset:g} s: beyond all times here")
    elif layout.offset:
        ns = ns + round(float(layout.offset) * 1e9)
    others = [k for k in range(len(table.names)) if k != time]
    if not others:
        raise InputError(f"{table.name}: no column beside the times")
    names, values, units = _mapped(table, layout, others, rows)
    columns, told = grouped(names, values, units)
    lines = None if table.lines is None else table.lines[rows]
    return Record(table.name, ns, columns, told, lines, tuple(notes))


def _single(table: RawTable, layout: Layout, notes: list[str]) -> RawTable:
    """The table without columns that another of the same name repeats; others are an error."""
    first: dict[str, int] = {}
    keep = []
    for k, name in enumerate(table.names):
        if name not in first:
            first[name] = k
            keep.append(k)
            continue
        one, other = table.values[first[name]], table.values[k]
        if np.array_equal(one, other, equal_nan=True):
            notes.append(f"column {name!r} is there twice, with the same values")
            continue
        place = table.where(-1, k)
        if _is_time(name):
            told = "has other times than the first one: say names, and time"
        else:
            told = "is the name of two columns: say names"
        raise InputError(f"{place}: {name!r} {told}")
    if len(keep) == len(table.names):
        return table

    def where(row: int, column: int) -> str:
        return table.where(row, keep[column])

    return replace(
        table,
        names=[table.names[k] for k in keep],
        units=[table.units[k] for k in keep],
        values=[table.values[k] for k in keep],
        where=where,
        stamps=frozenset(keep.index(k) for k in table.stamps if k in keep),
        timed=None if table.timed is None else keep.index(table.timed),
    )


def _is_time(name: str) -> bool:
    return name.strip().lower() in TIMES


def _named(table: RawTable, name: str, key: str) -> int:
    """Number of a column by its name."""
    if name in table.names:
        return table.names.index(name)
    told = suggestion(name, table.names) or f" (there are: {', '.join(table.names)})"
    raise InputError(f"{table.name}: {key} = {name!r}: no such column{told}")


def _time_column(table: RawTable, layout: Layout) -> int | None:
    """Number of the column of times; None if a rate stands for it."""
    if table.timed is not None:
        return table.timed
    if layout.time is not None:
        return _named(table, layout.time, "time")
    if layout.rate is not None:
        return None
    known = [k for k, n in enumerate(table.names) if _is_time(n) and _lasts(table.units[k])]
    known += sorted(table.stamps)
    known += [k for k in range(len(table.names)) if table.units[k] and _lasts(table.units[k])]
    if known:
        return known[0]
    if table.started is not None:
        return None
    for k, name in enumerate(table.names):
        if _is_time(name):  # it has a unit that is none of time
            unit = table.units[k]
            raise InputError(f"{table.where(-1, k)}: {name!r} is in [{unit}], no unit of time")
    names = ", ".join(table.names)
    told = "say time, or rate"
    raise NoTimes(f"{table.where(-1, 0)}: no column of times ({names}): {told}")


def _lasts(unit: str | None) -> bool:
    """Whether a unit is one of time, or unknown."""
    if unit is None or not unit.strip():
        return True
    try:
        return quantity(unit).exponents == _SECOND
    except ValueError:
        return False


def _by_rate(table: RawTable, layout: Layout, notes: list[str]) -> Array:
    """Times [ns] of so many samples a second."""
    count = np.arange(len(table.values[0]))
    if layout.rate is not None:
        return _whole(table, count * (1e9 / layout.rate))
    assert table.started is not None
    start, step = table.started
    notes.append(f"times by the file's head: from {start:.9g} s, every {step:.9g} s")
    if step * 1e9 < 1.0:
        raise InputError(f"{table.name}: a sample every {step:.3g} s: times are whole ns here")
    return _whole(table, 1e9 * (start + step * count))


def _whole(table: RawTable, ns: Array) -> Array:
    """Times as whole numbers."""
    if not np.abs(ns).max() <= NS_MAX:
        raise InputError(f"{table.name}: times to {ns[-1] / 1e9:.3g} s are beyond all times here")
    return np.round(ns).astype(np.int64)


def _times(table: RawTable, column: int, layout: Layout, notes: list[str]) -> Array:
    """Times [ns] of all rows; NaN where a row has none."""
    values, unit = table.values[column], layout.time_unit or table.units[column]
    name = table.names[column]
    if column in table.stamps:
        return values
    if not unit or not unit.strip():
        notes.append(f"{name!r} has no unit: taken as seconds")
        unit = "s"
    try:
        scale = quantity(unit)
    except ValueError as error:
        raise InputError(f"{table.where(-1, column)}: {name!r}: {error}") from None
    if scale.exponents != _SECOND:
        raise InputError(f"{table.where(-1, column)}: {name!r} is in [{unit}], no unit of time")
    per = round(scale.factor * 1e9)
    if values.dtype.kind in "iu" and float(np.abs(values).max()) * per <= NS_MAX:
        return np.asarray(values.astype(np.int64) * per)
    return np.asarray(values * per)


# CCN 19: what may be wrong with times, each with its message, and three ways out of duplicates.
def _increasing(
    table: RawTable, column: int, ns: Array, layout: Layout, notes: list[str]
) -> tuple[Array, Array, RawTable]:
    """Times [ns] that increase, their rows, and the table without repeated samples."""
    name = table.names[column]
    if len(bad := np.flatnonzero(~(np.abs(ns) <= NS_MAX))):
        row = int(bad[0])
        if np.isnan(float(ns[row])):
            raise InputError(f"{table.where(row, column)}: {name} has no value")
        far = f"{ns[row] / 1e9:.6g} s is beyond all times here"
        raise InputError(f"{table.where(row, column)}: {name}: {far}")
    whole = ns if ns.dtype.kind in "iu" else np.rint(ns).astype(np.int64)
    if len(back := np.flatnonzero(np.diff(whole) < 0)):
        row = int(back[0]) + 1
        now, then = (f"{whole[r] / 1e9:.9g} s" for r in (row, row - 1))
        raise InputError(f"{table.where(row, column)}: {name}: {now} comes after {then}")
    same = np.flatnonzero(np.diff(whole) == 0) + 1
    rows = np.arange(len(whole))
    if not len(same):
        return whole, rows, table
    others = [k for k in range(len(table.names)) if k != column]
    for row in same.tolist() if layout.duplicates == "refuse" else ():
        for k in others:
            a, b = table.values[k][row - 1], table.values[k][row]
            if a != b and not (np.isnan(a) and np.isnan(b)):
                at = f"{whole[row] / 1e9:.9g} s"
                told = f"{table.names[k]} has two values at {at}, {a:g} and {b:g}"
                raise InputError(f"{table.where(row, k)}: {told}: say duplicates")
    notes.append(f"{len(same)} sample{'s' * (len(same) != 1)} of a time that was there already")
    starts = np.setdiff1d(rows, same)
    if layout.duplicates == "mean":
        count = np.diff(np.append(starts, len(rows)))
        values = [np.add.reduceat(x.astype(np.float64), starts) / count for x in table.values]
        lines = None if table.lines is None else table.lines[starts]
        made = RawTable(table.name, table.names, table.units, values, table.where, lines)
        return whole[starts], np.arange(len(starts)), made
    if layout.duplicates == "last":
        return whole[starts], np.append(starts[1:], len(rows)) - 1, table
    return whole[starts], starts, table


def _mapped(
    table: RawTable, layout: Layout, others: Sequence[int], rows: Array
) -> tuple[list[str], list[Array], list[str | None]]:
    """Names, values and units of the columns, those that a caller maps under their new names."""
    names: list[str] = []
    values: list[Array] = []
    units: list[str | None] = []
    taken: set[int] = set()
    for own, given in layout.columns.items():
        asked: Mapping[str, Any] = given if isinstance(given, Mapping) else {"column": given}
        listed = asked["column"]
        parts = [listed] if isinstance(listed, str) else list(listed)
        found = [_named(table, name, f"columns: {own}") for name in parts]
        taken |= set(found)
        unit = _unit(table, own, found, asked)
        for i, k in enumerate(found):
            names.append(own if isinstance(listed, str) else f"{own}[{i + 1}]")
            scale, zero = asked.get("scale", 1.0), asked.get("zero", 0.0)
            data = table.values[k][rows]
            if (scale, zero) != (1.0, 0.0):
                data = scale * (data - zero)
            if asked.get("round"):
                data = np.round(data)
            values.append(data)
            units.append(unit)
    for k in (k for k in others if k not in taken):
        if table.names[k] in layout.columns:
            raise InputError(
                f"{table.where(-1, k)}: columns: {table.names[k]!r} is another column's name here"
            )
        names.append(table.names[k])
        values.append(table.values[k][rows])
        units.append(fmi_name(table.units[k]))
    return names, values, units


def _unit(table: RawTable, own: str, found: Sequence[int], asked: Mapping[str, Any]) -> str | None:
    """The unit of a mapped column: the caller's, else the file's."""
    if "unit" in asked:
        try:
            return quantity(asked["unit"]).name
        except ValueError as error:
            raise InputError(f"columns: {own}: {error}") from None
    units = [fmi_name(table.units[k]) for k in found]
    if len(set(units)) > 1:
        told = " and ".join(
            f"{table.names[k]!r} [{spelled(u) or '1'}]" for k, u in zip(found, units, strict=True)
        )
        raise InputError(f"{table.where(-1, found[-1])}: columns: {own}: {told}: one unit wanted")
    if not math.isclose(asked.get("scale", 1.0), 1.0):
        return None  # the file's unit is that of the numbers before
    return units[0]
