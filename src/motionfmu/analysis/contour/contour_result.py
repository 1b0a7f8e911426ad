"""Input and result of a contour analysis."""

import math
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.contour.arcs import Array
from motionfmu.analysis.contour.circles import CircularTest
from motionfmu.analysis.contour.instants import Instants
from motionfmu.analysis.contour.kinds import AXES, Corner, Statistics
from motionfmu.analysis.contour.path import Path
from motionfmu.analysis.contour.ranges import largest, parts
from motionfmu.analysis.contour.scaled_values import ScaledValues, blocks, finite
from motionfmu.analysis.contour.segments import KINDS
from motionfmu.analysis.contour.track import Track
from motionfmu.base.columns import forget, room
from motionfmu.base.errors import NoNumber

# Most commands, and most corners, that `ContourResult.numbers` has.
LISTED = 10_000
# What is known of the error on a command: lengths [mm], time of the largest error [s].
COMMANDS = [("command", "i8"), ("line", "i8"), ("kind", "U5")]
COMMANDS += [(name, "f8") for name in ("length", "max", "rms", "time")]


@dataclass(frozen=True)
class Trace:
    """A further signal for the report.

    Attributes
    ----------
    name, unit : str
        For the axis title.
    values : ndarray, shape (n,) or (n, 6)
        One column per axis, or one for all.
    """

    name: str
    unit: str
    values: Array


@dataclass(frozen=True)
class ContourInput:
    """What a run gives to the contour analysis.

    Attributes
    ----------
    path : Path
        The planned geometry.
    time : ndarray, shape (n,)
        [s], increasing.
    actual, commanded : ndarray or ScaledValues, shape (n, 6)
        Position of the tool, and pulses put out over pulses per mm [mm]; memory maps are read in
        parts.
    command : ndarray of int, shape (n,)
        Command whose points were written to the card last; of two that are mixed, the older.
    newest : ndarray of int, shape (n,), optional
        The same; of two that are mixed, the newer. None: no two are.
    stock : ndarray, shape (n,) or (n, 6), optional
        FIFO stock [commands].
    interrupts : ndarray, shape (n,), optional
        Number of interrupts so far.
    feed : ndarray, shape (n,), optional
        Commanded speed along the path as the library states it [mm/s].
    axes : tuple of int
        Axes in use, 0 to 5.
    dda_time : float
        Time of one FIFO command [s].
    window : float, optional
        How long a segment stays a candidate after the pulses have left it [s]; None takes five
        servo lags, found from the run.
    run_in : float, optional
        Angle left out at both ends of a circle [rad]; None leaves out what is not steady.
    traces : tuple of Trace
        Further signals for the report, such as voltages and torques.
    """

    path: Path
    time: Array
    actual: Array | ScaledValues
    commanded: Array | ScaledValues
    command: NDArray[np.int64]
    newest: NDArray[np.int64] | None = None
    stock: Array | None = None
    interrupts: Array | None = None
    feed: Array | None = None
    axes: tuple[int, ...] = (0, 1, 2)
    dda_time: float = 1e-3
    window: float | None = None
    run_in: float | None = None
    traces: tuple[Trace, ...] = field(default=())

    @cached_property
    def instants(self) -> Instants:
        """The times of the samples."""
        return Instants(self.time)

    def __post_init__(self) -> None:
        count = len(self.time)
        steps = (np.diff(self.time[own.start : own.stop + 1]) for own in blocks(count, self.time))
        if count < 2 or not all((step > 0.0).all() for step in steps):
            raise ValueError("time must have two samples or more and increase")
        shapes = {"actual": (count, 6), "commanded": (count, 6), "command": (count,)}
        if self.newest is not None:
            shapes["newest"] = (count,)
        for name, shape in shapes.items():
            values = getattr(self, name)
            if values.shape != shape:
                raise ValueError(f"{name} has the shape {values.shape} instead of {shape}")
            for own in blocks(count, values):
                good = finite(values, own)
                if not good.all():
                    bad = own.start + np.argwhere(~good)[0, 0] * (good.ndim > 1)
                    raise ValueError(f"{name} is not finite at {self.time[bad]:g} s")


@dataclass(frozen=True, repr=False)
class ContourResult:
    """Contour error of a run.

    Attributes
    ----------
    run : ContourInput
        What was analysed.
    track, command_track : Track
        Nearest points of the tool, and of the pulses put out, on the exact path.
    cutting : ndarray of bool, shape (n,)
        Samples in motion on a line, arc or helix: those that the statistics count.
    lag, window : float
        Following distance over speed; how long a segment stays a candidate [s].
    error, command_error : Statistics
        Of the tool, and of the pulses (chord error, rounding to pulses, blending).
    circles : tuple of CircularTest
    corners : tuple of Corner
    missing : dict
        Why a circle of the path has no circular test, by ``circles.<place>.<way>``.
    """

    run: ContourInput
    track: Track
    command_track: Track
    cutting: NDArray[np.bool_]
    lag: float
    window: float
    error: Statistics
    command_error: Statistics
    circles: tuple[CircularTest, ...]
    corners: tuple[Corner, ...]
    missing: dict[str, str] = field(default_factory=dict)

    @property
    def following(self) -> Array:
        """Commanded minus actual position, shape (n, 6) [mm]."""
        return np.subtract(self.run.commanded, self.run.actual)

    def __repr__(self) -> str:
        error = self.error
        parts = f"{len(self.circles)} circles, {len(self.corners)} corners"
        return f"<ContourResult: max {error.max:.4g} mm, RMS {error.rms:.4g} mm, {parts}>"

    def numbers(self) -> dict[str, Any]:
        """Every number of the analysis, ready for JSON; mm, s, rad.

        Of more than `LISTED` commands or corners those with the largest errors are there, in their
        order, and how many are not: ``left_out``.
        """
        found = {name: self._group(name) for name in GROUPS}
        left_out = {}
        for name, errors in (
            ("commands", self.commands["max"]),
            ("corners", np.array([c.error for c in self.corners])),
        ):
            if len(errors) > LISTED:
                worst = np.sort(np.argsort(-errors, kind="stable")[:LISTED]).tolist()
                found[name] = [found[name][i] for i in worst]
                left_out[name] = len(errors) - LISTED
            found[name] = list(found[name])
        return found | ({"left_out": left_out} if left_out else {})

    @cached_property
    def _known(self) -> dict[str, Any]:
        """Groups of numbers that were computed already, by name."""
        return {}

    def _group(self, name: str) -> Any:
        """One of `GROUPS`, computed once, for checks ask for its numbers one by one."""
        if name not in self._known:
            self._known[name] = GROUPS[name](self)
        return self._known[name]

    def _error(self) -> dict[str, Any]:
        least = most = None
        if (right := self.track.right) is not None:
            least, most = math.inf, -math.inf
            for own in blocks(len(right), right, self.track.distance):
                signed = np.where(right[own], -self.track.distance[own], self.track.distance[own])
                signed = signed[self.cutting[own]]
                least = min(least, float(signed.min(initial=math.inf)))
                most = max(most, float(signed.max(initial=-math.inf)))
        return asdict(self.error) | {"signed_min": least, "signed_max": most}

    def _following(self) -> dict[str, Any]:
        axes, count = list(self.run.axes), int(self.cutting.sum())
        top, square = np.zeros(len(axes)), np.zeros(len(axes))
        for own in blocks(len(self.cutting), self.run.commanded, self.run.actual):
            gap = np.subtract(self.run.commanded[own], self.run.actual[own])
            gap = gap[self.cutting[own]][:, axes]
            top = np.maximum(top, np.abs(gap).max(axis=0, initial=0.0))
            square += np.einsum("ij,ij->j", gap, gap)
        rms = np.sqrt(square / count)
        rows = zip(axes, top.tolist(), rms.tolist(), strict=True)
        return {AXES[i]: {"max": a, "rms": b} for i, a, b in rows}

    def _circles(self) -> list[dict[str, Any] | None]:
        """Circles by their number in the path, so that a name means one circle in all runs."""
        found = {c.place: c.numbers() for c in self.circles}
        known = {*found, *(int(name.split(".")[1]) for name in self.missing)}
        return [found.get(i) for i in range(1 + max(known, default=-1))]

    @cached_property
    def commands(self) -> NDArray[Any]:
        """A row for each segment on which the tool cuts, in order.

        A structured array with the fields of `COMMANDS`: command, line of the program, kind,
        length, largest and RMS error [mm], time of the largest [s].
        """
        path = self.run.path
        segment, distance = self.track.segment, self.track.distance
        count, last, filled = int(np.count_nonzero(self.cutting)), -1, 0
        found, begins, firsts = room(count, np.int64, distance), [], []
        for block in blocks(len(segment), segment, found):
            places = block.start + np.flatnonzero(self.cutting[block])
            owners = segment[places]
            first = np.flatnonzero(np.diff(owners, prepend=last))
            begins.append(filled + first)
            firsts.append(owners[first])
            found[filled : filled + len(places)] = places
            filled, last = filled + len(places), owners[-1] if len(owners) else last
        cuts = np.concatenate([*begins, [count]])
        rows = np.empty(len(cuts) - 1, dtype=COMMANDS)
        own = np.concatenate(firsts)
        rows["command"], rows["line"] = path.commands[own], path.lines[own]
        rows["kind"] = np.array(KINDS)[path.segments.columns.kind[own]]
        rows["length"] = path.lengths[own]
        for some, samples, first in parts(cuts[:-1], cuts[1:]):
            size = distance[found[samples]]
            rows["max"][some], worst = largest(size, first)
            square = np.add.reduceat(size * size, first) / np.diff(first, append=len(size))
            rows["rms"][some] = np.sqrt(square)
            rows["time"][some] = self.run.time[found[samples[worst]]]
            for array in (found, distance, self.run.time):
                forget(array)
        return rows

    def number(self, name: str) -> float:
        """One number by its dotted name.

        Parameters
        ----------
        name : str
            As in `numbers`, list items by index: ``error.max``, ``circles.0.ccw.g``.

        Raises
        ------
        NoNumber
            There is no such number; the message gives the reason, or names what is there.
        """
        parts = name.split(".")
        value: Any = self._group(parts[0]) if parts[0] in GROUPS else GROUPS
        for part in parts[1:] if parts[0] in GROUPS else parts:
            if isinstance(value, Sequence):
                there = int(part) if part.isdecimal() else len(value)
                if there >= len(value):
                    value = {str(i): None for i in range(len(value))}
                    raise NoNumber(f"contour number {name!r}: {self._why(name, part, value)}")
                value = value[there]
                continue
            if not isinstance(value, dict) or part not in value:
                raise NoNumber(f"contour number {name!r}: {self._why(name, part, value)}")
            value = value[part]
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise NoNumber(f"contour number {name!r} is not a number but {value!r}")
        return float(value)

    def _why(self, name: str, part: str, value: Any) -> str:
        """Why there is no such number: the analysis' reason, else the names that exist."""
        for place, reason in self.missing.items():
            if name.startswith((f"{place}.", f"{place.rpartition('.')[0]}.both.")):
                return reason
        there = ", ".join(value) if isinstance(value, dict) else ""
        return f"no {part!r}, there is {there}" if there else "the run has none"


@dataclass(frozen=True, eq=False)
class _Rows(Sequence[dict[str, Any]]):
    """A sequence of rows, each of which is computed when it is read."""

    size: int
    make: Callable[[int], dict[str, Any]]

    def __len__(self) -> int:
        return self.size

    def __getitem__(self, i: Any) -> Any:
        return self.make(range(self.size)[i])


def _row(row: Any) -> dict[str, Any]:
    return dict(zip(row.dtype.names, row.item(), strict=True))


# Groups of the numbers, and how each is made.
GROUPS: dict[str, Callable[[ContourResult], Any]] = {
    "units": lambda r: {"length": "mm", "time": "s", "angle": "rad", "speed": "mm/s"},
    "samples": lambda r: len(r.run.time),
    "samples_cutting": lambda r: int(r.cutting.sum()),
    "lag": lambda r: r.lag,
    "window": lambda r: r.window,
    "error": ContourResult._error,
    "command_error": lambda r: asdict(r.command_error),
    "following": ContourResult._following,
    "circles": ContourResult._circles,
    "corners": lambda r: _Rows(len(r.corners), lambda i: dict(vars(r.corners[i]))),
    "commands": lambda r: _Rows(len(r.commands), lambda i: _row(r.commands[i])),
}
