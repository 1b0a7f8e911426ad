"""The planned path: exact segments in the order of the program."""

import csv
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from pathlib import Path as File

import numpy as np
from numpy.typing import NDArray

from motionfmu.contour.geometry import TURN, Arc, Array, Cubic, Label, Line, Lines, Segment

KINDS = {0: "ptp", 1: "line", 2: "arc", 3: "arc", 4: "helix", 5: "helix", 14: "curve"}
DELAY = 6
AXES = "xyz"
COLUMNS = (
    ["command", "line", "type"]
    + [f"{what}_{axis}" for what in ("start", "end", "centre", "normal") for axis in AXES]
    + ["sweep", "feed"]
)
# Columns that a curve needs beside them: its inner control points.
INNER = ("inner_0", "inner_1")
# End points as the library rounds them in the file must meet the arc it describes [mm]:
# far above the rounding of 9 digits, far below any error that matters.
MEETS = 1e-4
# A move lies in a plane if it leaves it by less than this [mm]; a tenth of the finest pulse.
FLAT = 1e-5


@dataclass(frozen=True)
class Path:
    """All segments of a program.

    Attributes
    ----------
    segments : tuple of Segment
        In the order of travel; delays are not among them.
    """

    segments: tuple[Segment, ...]

    def __post_init__(self) -> None:
        if not self.segments:
            raise ValueError("the path has no segments")
        numbers = [s.label.command for s in self.segments]
        for before, after in pairwise(numbers):
            if after <= before:
                raise ValueError(f"command {after} follows command {before} in the path")

    @cached_property
    def commands(self) -> NDArray[np.int64]:
        """Command index of each segment."""
        return np.array([s.label.command for s in self.segments])

    @cached_property
    def straight(self) -> NDArray[np.bool_]:
        """Which segments are lines."""
        return np.array([isinstance(s, Line) for s in self.segments])

    @cached_property
    def lines(self) -> Lines:
        """The straight segments in their order."""
        return Lines([s for s in self.segments if isinstance(s, Line)])

    @cached_property
    def offsets(self) -> Array:
        """Length before each segment, and the whole length [mm]."""
        return np.concatenate([[0.0], np.cumsum([s.length for s in self.segments])])

    @cached_property
    def normal(self) -> Array | None:
        """Unit normal of the working plane; None for a path in space.

        All cutting moves run in the plane or, as plunges do, along its normal. It is that of G17,
        G18 or G19 where one of them fits, else that of an oblique plane, and points to the
        positive side of its largest component.
        """
        moves = [s for s in self.segments if s.label.kind != "ptp"] or list(self.segments)
        ways = np.concatenate([_ways(s) for s in moves])
        straight = np.concatenate([np.full(len(_ways(s)), isinstance(s, Line)) for s in moves])
        for axis in (2, 1, 0):
            normal = np.eye(3)[axis]
            plunge = np.abs(ways - np.outer(ways @ normal, normal)).max(axis=1) <= FLAT
            rest = ways[~(plunge & straight)]
            if len(rest) and np.abs(rest @ normal).max() <= FLAT:
                return normal
        rows = np.linalg.svd(ways)[2]
        normal = rows[2]
        if np.abs(ways @ rows[1]).max() <= FLAT:  # one direction: any plane through it will do
            normal = np.eye(3)[int(np.argmin(np.abs(rows[0])))]
            normal = normal - (normal @ rows[0]) * rows[0]
            normal /= np.linalg.norm(normal)
        if np.abs(ways @ normal).max() > FLAT:
            return None
        return np.array(normal * np.sign(normal[np.argmax(np.abs(normal))]))

    def segment_of(self, command: NDArray[np.int64]) -> NDArray[np.int64]:
        """Segment that a command index stands for.

        Parameters
        ----------
        command : ndarray of int, shape (n,)
            Command indices; a delay stands for the segment before it.
        """
        found = np.searchsorted(self.commands, command, side="right") - 1
        return np.clip(found, 0, len(self.segments) - 1)


def outline(segments: Sequence[Segment], steps: int = 90) -> Array:
    """Points (n, 3) [mm] to draw a path: `steps` per turn or curve."""
    parts = []
    for segment in segments:
        count = 2
        if isinstance(segment, Arc):
            count = max(2, math.ceil(segment.angle / TURN * steps) + 1)
        if isinstance(segment, Cubic):
            count = steps + 1
        parts.append(segment.at(np.linspace(0.0, segment.length, count)))
    return np.concatenate(parts)


def _ways(segment: Segment) -> Array:
    """Vectors that span what the segment covers [mm]."""
    if isinstance(segment, Line):
        return np.array([segment.end - segment.start])
    if isinstance(segment, Cubic):
        return np.diff(segment.control, axis=0)
    spoke = segment.start - segment.centre
    return np.array([spoke, np.cross(segment.axis, spoke), segment.rise * segment.axis])


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
    segments: list[Segment] = []
    with open(file, newline="") as stream:
        reader = csv.DictReader(stream)
        missing = sorted(set(COLUMNS) - set(reader.fieldnames or ()))
        if missing:
            raise ValueError(f"{file}:1: column {missing[0]!r} is missing")
        for row in reader:
            try:
                segment = _segment(row)
            except ValueError as error:
                raise ValueError(f"{file}:{reader.line_num}: {error}") from None
            if segment is not None:
                segments.append(segment)
    if not segments:
        raise ValueError(f"{file}: no motion in the planned geometry")
    return Path(tuple(segments))


def _segment(row: dict[str, str]) -> Segment | None:
    value = {name: _number(row, name) for name in COLUMNS}
    kind = int(value["type"])
    if kind == DELAY:
        return None
    if kind not in KINDS:
        raise ValueError(f"type {row['type']!r} is none of 0 to {DELAY} and 14")
    label = Label(int(value["command"]), int(value["line"]), KINDS[kind], value["feed"])
    start, end, centre, normal = (
        np.array([value[f"{what}_{axis}"] for axis in AXES])
        for what in ("start", "end", "centre", "normal")
    )
    if KINDS[kind] in ("ptp", "line"):
        return Line(label, start, end)
    if KINDS[kind] == "curve":
        inner = [[_number(row, f"{which}_{axis}") for axis in AXES] for which in INNER]
        return Cubic(label, np.array([start, *inner, end]))
    return make_arc(label, (start, end), (centre, normal), value["sweep"])


def make_arc(
    label: Label, ends: tuple[Array, Array], about: tuple[Array, Array], sweep: float
) -> Arc:
    """Arc or helix from its end points (start and end [mm]), centre and sweep.

    `about` is a point of the axis [mm] and the normal; the part of the way along the normal is the
    rise of a helix. The sweep [rad] is positive counter-clockwise about the normal. A ValueError
    says that the normal, the sweep or the radius is zero, or that the arc misses the end.
    """
    start, end = ends
    size = float(np.linalg.norm(about[1]))
    if size == 0.0:
        raise ValueError("the normal of an arc is zero")
    if sweep == 0.0:
        raise ValueError("the sweep of an arc is zero")
    axis = about[1] / size
    centre = about[0] + ((start - about[0]) @ axis) * axis
    rise = float((end - start) @ axis)
    first = float(np.linalg.norm(start - centre))
    last = float(np.linalg.norm(end - centre - rise * axis))
    if first == 0.0:
        raise ValueError("the radius of an arc is zero")
    arc = Arc(label, start, centre, axis * math.copysign(1.0, sweep), abs(sweep))
    growth = last - first
    if abs(growth) <= 8.0 * float(np.finfo(float).eps) * max(first, float(np.abs(end).max())):
        growth = 0.0  # rounding of this subtraction itself
    arc = Arc(label, start, centre, arc.axis, arc.angle, rise * math.copysign(1.0, sweep), growth)
    miss = float(np.linalg.norm(arc.end - end))
    if miss > MEETS:
        raise ValueError(f"the arc misses its end by {miss:.6g} mm")
    return arc


def _number(row: dict[str, str], name: str) -> float:
    try:
        value = float(row[name])
    except (KeyError, TypeError, ValueError):
        raise ValueError(f"{name} {row.get(name)!r} is not a number") from None
    if not math.isfinite(value):
        raise ValueError(f"{name} {row[name]!r} is not finite")
    return value
