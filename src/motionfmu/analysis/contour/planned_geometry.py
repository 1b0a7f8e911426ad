"""Reading the planned geometry that the library wrote."""

import csv
import io
import math
from collections.abc import Callable
from itertools import islice
from pathlib import Path as File
from typing import TextIO

import numpy as np

from motionfmu.analysis.contour.arcs import EPS, Arcs, Array
from motionfmu.analysis.contour.geometry import Arc, Cubic, Label, norms
from motionfmu.analysis.contour.path import Path
from motionfmu.analysis.contour.segments import (
    ARC,
    CUBIC,
    KINDS,
    LINE,
    Index,
    SegmentColumns,
    Segments,
)

# Kinds of commands by their number in the file: index in KINDS, and shape.
TYPES = {0: "ptp", 1: "line", 2: "arc", 3: "arc", 4: "helix", 5: "helix", 14: "curve"}
SHAPES = {"ptp": LINE, "line": LINE, "arc": ARC, "helix": ARC, "curve": CUBIC}
DELAY = 6
AXES = "xyz"
COLUMNS = (
    ["command", "line", "type"]
    + [f"{what}_{axis}" for what in ("start", "end", "centre", "normal") for axis in AXES]
    + ["sweep", "feed"]
)
# Columns that a curve needs beside them: its inner control points.
INNER = [f"inner_{k}_{axis}" for k in (0, 1) for axis in AXES]
# End points as the library rounds them in the file must meet the arc it describes [mm]:
# far above the rounding of 9 digits, far below any error that matters.
MEETS = 1e-4
PIECE = 1 << 15  # lines of the file that are read at a time


class RowFault(ValueError):
    """A row that no geometry can have, with its number."""

    def __init__(self, row: int, what: str) -> None:
        super().__init__(what)
        self.row = row


def read_path(file: str | File) -> Path:
    """Read the planned geometry that the library wrote.

    Parameters
    ----------
    file : str or Path
        CSV with the columns of `COLUMNS`, in any order; further columns are not read.

    Raises
    ------
    ValueError
        A column is missing, or a value is wrong, as ``file:line: what``.
    """
    with open(file, newline="", encoding="utf-8") as stream:
        return path_of(stream, str(file))


def path_of(stream: TextIO, name: str) -> Path:
    """The planned geometry of an open file; `name` is what messages call it."""
    head = next(csv.reader([stream.readline()]), [])
    missing = sorted(set(COLUMNS) - set(head))
    if missing:
        raise ValueError(f"{name}:1: column {missing[0]!r} is missing")
    wanted = [c for c in (*COLUMNS, *INNER) if c in head]
    places = [head.index(c) for c in wanted]
    found, first = [], 2
    while lines := list(islice(stream, PIECE)):
        try:
            table = np.loadtxt(lines, delimiter=",", comments=None, usecols=places, ndmin=2)
            if not np.isfinite(table).all():
                raise ValueError
        except ValueError:
            table = _slowly(lines, (head, wanted), (name, first))
        moves = np.flatnonzero(table[:, wanted.index("type")].astype(np.int64) != DELAY)
        try:
            if len(moves):
                found.append(_columns(table[moves], wanted))
        except RowFault as error:
            raise ValueError(f"{name}:{int(moves[error.row]) + first}: {error}") from None
        first += len(lines)
    if not found:
        raise ValueError(f"{name}: no motion in the planned geometry")
    return Path(Segments(SegmentColumns.joined(found)))


def _slowly(
    lines: list[str], columns: tuple[list[str], list[str]], place: tuple[str, int]
) -> Array:
    """Read lines row by row, because a value in them is wrong and the message must name it."""
    reader = csv.DictReader(lines, columns[0])
    rows = []
    for row in reader:
        try:
            rows.append([_number(row, c) for c in columns[1]])
        except ValueError as error:
            told = f"{place[0]}:{reader.line_num + place[1] - 1}: {error}"
            raise ValueError(told) from None
    return np.array(rows).reshape(-1, len(columns[1]))


def _number(row: dict[str, str], name: str) -> float:
    try:
        value = float(row[name])
    except (KeyError, TypeError, ValueError):
        raise ValueError(f"{name} {row.get(name)!r} is not a number") from None
    if not math.isfinite(value):
        raise ValueError(f"{name} {row[name]!r} is not finite")
    return value


def _columns(table: Array, names: list[str]) -> SegmentColumns:
    """Segments of rows that are motion."""

    def triple(what: str) -> Array:
        return table[:, [names.index(f"{what}_{axis}") for axis in AXES]]

    def column(what: str) -> Array:
        return table[:, names.index(what)].copy()  # not the whole table for one column

    types = column("type").astype(np.int64)
    known = np.isin(types, list(TYPES))
    if not known.all():
        row = int(np.argmin(known))
        raise RowFault(row, f"type '{types[row]}' is none of 0 to {DELAY} and 14")
    kinds, shapes = np.zeros(15, dtype=np.int8), np.zeros(15, dtype=np.int8)
    for number, kind in TYPES.items():
        kinds[number], shapes[number] = KINDS.index(kind), SHAPES[kind]
    shape = shapes[types]
    command, line = column("command").astype(np.int64), column("line").astype(np.int64)
    feed = column("feed")
    start, end = triple("start"), triple("end")
    round_ = np.flatnonzero(shape == ARC)
    about = (triple("centre")[round_], triple("normal")[round_])
    try:
        turned = _turned((start[round_], end[round_]), about, column("sweep")[round_])
    except RowFault as error:
        raise RowFault(int(round_[error.row]), str(error)) from None
    curves = {}
    for i in np.flatnonzero(shape == CUBIC).tolist():
        if not set(INNER) <= set(names):
            missing = next(c for c in INNER if c not in names)
            raise RowFault(i, f"{missing} None is not a number")
        inner = table[i, [names.index(c) for c in INNER]].reshape(2, 3)
        own = Label(int(command[i]), int(line[i]), "curve", float(feed[i]))
        curves[i] = Cubic(own, np.array([start[i], *inner, end[i]]))
    return SegmentColumns(command, line, kinds[types], feed, shape, start, end, *turned, curves)


def make_arc(
    label: Label, ends: tuple[Array, Array], about: tuple[Array, Array], sweep: float
) -> Arc:
    """Arc or helix from its end points (start and end [mm]), centre and sweep.

    `about` is a point of the axis [mm] and the normal; the part of the way along the normal is the
    rise of a helix. The sweep [rad] is positive counter-clockwise about the normal. A ValueError
    says that the normal, the sweep or the radius is zero, or that the arc misses the end.
    """
    both, axis = (ends[0][None], ends[1][None]), (about[0][None], about[1][None])
    centre, normal, shape = _turned(both, axis, np.array([sweep]))
    return Arc(label, ends[0], centre[0], normal[0], *shape[0].tolist())


def _turned(
    ends: tuple[Array, Array], about: tuple[Array, Array], sweep: Array
) -> tuple[Array, Array, Array]:
    """Centre, axis, and angle, rise and growth of arcs as `make_arc` makes them, a row each."""

    def refuse(bad: Index, what: Callable[[int], str]) -> None:
        if bad.any():
            row = int(np.argmax(bad))
            raise RowFault(row, what(row))

    start, end = ends
    size = norms(about[1])
    refuse(size == 0.0, lambda row: "the normal of an arc is zero")
    refuse(sweep == 0.0, lambda row: "the sweep of an arc is zero")
    axis = about[1] / size[:, None]
    height = np.einsum("ij,ij->i", start - about[0], axis)
    centre = about[0] + height[:, None] * axis
    rise = np.einsum("ij,ij->i", end - start, axis)
    first = norms(start - centre)
    last = norms(end - centre - rise[:, None] * axis)
    refuse(first == 0.0, lambda row: "the radius of an arc is zero")
    growth = last - first
    noise = 8.0 * EPS * np.maximum(first, np.abs(end).max(axis=1, initial=0.0))
    growth[np.abs(growth) <= noise] = 0.0  # rounding of this subtraction itself
    sign = np.sign(sweep)
    axis *= sign[:, None]
    shape = np.stack([np.abs(sweep), rise * sign, growth], axis=1)
    arcs = Arcs.of(start, (centre, axis), tuple(shape.T))
    miss = norms(arcs.points(arcs.angle) - end)
    refuse(miss > MEETS, lambda row: f"the arc misses its end by {miss[row]:.6g} mm")
    return centre, axis, shape


def path_of_text(text: str, name: str) -> Path:
    """The planned geometry of a text."""
    # StringIO has four bytes for each character.
    return path_of(io.TextIOWrapper(io.BytesIO(text.encode()), "utf-8", newline=""), name)
