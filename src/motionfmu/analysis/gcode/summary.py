"""Figures of a part program: time, lengths, extents and tools."""

import ctypes
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.gcode.program import AXES, TYPES, Program, marked
from motionfmu.base.binding import library

# Largest angle of an arc between two points [rad]; number of points of a curve.
STEP, CURVE = 0.05, 41
MOTIONS = ("line", "cw_arc", "ccw_arc", "cw_helix", "ccw_helix", "curve")
RAPIDS = ("rapid", "rapid_joints")


@dataclass(frozen=True)
class Use:
    """The use of a tool.

    Attributes
    ----------
    tool : int
        0 before the first.
    time : float
        [s] rapids too.
    feed_way : float
        [mm] measured in X Y Z.
    low, high : tuple of float
        [mm] of its feed moves, by axis.
    """

    tool: int
    time: float
    feed_way: float
    low: tuple[float, ...]
    high: tuple[float, ...]


@dataclass(frozen=True)
class Summary:
    """Figures of a program.

    Attributes
    ----------
    time : float
        [s] with the accelerations given; stops and tool changes take none.
    feed_way, rapid_way : float
        [mm] measured in X Y Z.
    low, high : tuple of float
        [mm] of all motion, by axis, machine coordinates.
    feeds : tuple of float
        [mm/min] least and most of the feed moves; 0 without any.
    tools : list of Use
        In the order of their first use; 0 before the first tool.
    commands, stops : int
    """

    time: float
    feed_way: float
    rapid_way: float
    low: tuple[float, ...]
    high: tuple[float, ...]
    feeds: tuple[float, float]
    tools: list[Use]
    commands: int
    stops: int

    def numbers(self) -> dict[str, Any]:
        """The same for JSON.

        Returns
        -------
        dict
        """
        return asdict(self)


def _are(commands: np.ndarray, names: Sequence[str]) -> NDArray[np.bool_]:
    """Which commands are of some kinds."""
    return np.isin(np.array(TYPES), names)[commands["type"]]


def tools_of(commands: np.ndarray, before: int = 0) -> NDArray[np.int32]:
    """The tool in the spindle at each command, behind others that left one there."""
    known = _are(commands, ("outputs",)) | commands["changes"]
    last = np.maximum.accumulate(np.where(known, np.arange(len(commands)), -1))
    found = np.where(last >= 0, commands["tool"][np.maximum(last, 0)], before)
    return found.astype(np.int32)


def _extents(commands: np.ndarray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Smallest and largest coordinates of each path [mm], exact."""
    low, high = np.empty((len(commands), AXES)), np.empty((len(commands), AXES))
    library().binding_gcode_extents(
        ctypes.c_void_p(commands.ctypes.data),
        ctypes.c_int64(len(commands)),
        ctypes.c_void_p(low.ctypes.data),
        ctypes.c_void_p(high.ctypes.data),
    )
    return low, high


class _Box:
    """Smallest and largest coordinates of what was put into it, by axis."""

    def __init__(self) -> None:
        self._low, self._high = np.full(AXES, np.inf), np.full(AXES, -np.inf)

    def put(self, low: NDArray[np.float64], high: NDArray[np.float64]) -> None:
        np.minimum(self._low, low.min(axis=0, initial=np.inf), out=self._low)
        np.maximum(self._high, high.max(axis=0, initial=-np.inf), out=self._high)

    def ends(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Both of each axis; 0 if nothing was put into it."""
        if np.isinf(self._low).any():
            return (0.0,) * AXES, (0.0,) * AXES
        return tuple(map(float, self._low)), tuple(map(float, self._high))


def summarise(program: Program) -> Summary:
    """Work out the figures of a program.

    Parameters
    ----------
    program : Program
        Its commands up to the first fault count.

    Returns
    -------
    Summary
    """
    drive, tool, stops, every = program.drive(), 0, 0, _Box()
    boxes: dict[int, _Box] = {}  # of the moves with feed, by tool
    least, most = np.inf, -np.inf
    columns: list[tuple[NDArray[Any], ...]] = []
    for c, last in marked(program.blocks()):
        drive.take(c, last)
        feed, rapid = _are(c, MOTIONS), _are(c, RAPIDS)
        tools = tools_of(c, tool)
        tool = int(tools[-1]) if len(c) else tool
        low, high = _extents(c)
        every.put(low[feed | rapid], high[feed | rapid])
        for used in dict.fromkeys(tools[feed | rapid].tolist()):
            own = feed & (tools == used)
            boxes.setdefault(used, _Box()).put(low[own], high[own])
        feeds = c["feed"][feed] * 60.0
        least, most = min(least, feeds.min(initial=np.inf)), max(most, feeds.max(initial=-np.inf))
        stops += int(_are(c, ("stop",)).sum())
        columns.append((feed, rapid, tools, c["length"].copy()))
    feed, rapid, tools, length = (np.concatenate(parts) for parts in zip(*columns, strict=True))
    seconds = drive.seconds
    uses = []
    for used, box in boxes.items():
        own = tools == used
        way = float(length[own & feed].sum())
        uses.append(Use(used, float(seconds[own].sum()), way, *box.ends()))
    return Summary(
        time=float(seconds.sum()),
        feed_way=float(length[feed].sum()),
        rapid_way=float(length[rapid].sum()),
        **dict(zip(("low", "high"), every.ends(), strict=True)),
        feeds=(float(least), float(most)) if feed.any() else (0.0, 0.0),
        tools=uses,
        commands=len(feed),
        stops=stops,
    )


@dataclass(frozen=True)
class Stroke:
    """Moves in a row of one kind and tool, as points.

    Attributes
    ----------
    rapid : bool
    tool : int
        0 before the first.
    points : (n, 3) ndarray
        X Y Z [mm]; both ends of each move among them.
    feed : (n,) ndarray
        Of the point's move [mm/min].
    line : (n,) ndarray
        Of the program, likewise.
    """

    rapid: bool
    tool: int
    points: NDArray[np.float64]
    feed: NDArray[np.float64]
    line: NDArray[np.int64]


def strokes(program: Program, chord: float | None = None) -> Iterator[Stroke]:
    """The path in pieces of one kind and tool.

    Parameters
    ----------
    program : Program
    chord : float, optional
        The most that a chord is off its arc [mm]; else arcs have a point every 0.05 rad.

    Yields
    ------
    Stroke
    """
    waiting: list[Stroke] = []
    for piece in pieces(program, chord):
        if waiting and (piece.rapid, piece.tool) != (waiting[0].rapid, waiting[0].tool):
            yield _joined(waiting)
            waiting = []
        waiting.append(piece)
    if waiting:
        yield _joined(waiting)


def _joined(parts: Sequence[Stroke]) -> Stroke:
    if len(parts) == 1:
        return parts[0]
    columns = [np.concatenate([getattr(p, n) for p in parts]) for n in ("points", "feed", "line")]
    return Stroke(parts[0].rapid, parts[0].tool, *columns)


def pieces(program: Program, chord: float | None = None) -> Iterator[Stroke]:
    """The strokes as they come, each in one piece or several."""
    tool = 0
    for commands in program.blocks():
        tools = tools_of(commands, tool)
        tool = int(tools[-1]) if len(tools) else tool
        moves = _are(commands, (*MOTIONS, *RAPIDS))
        if moves.any():
            raw = commands.view(np.uint8).reshape(len(commands), -1)[moves]  # whole structs
            yield from _pieces(raw.ravel().view(commands.dtype), tools[moves], chord)


def _pieces(c: np.ndarray, tools: NDArray[np.int32], chord: float | None) -> Iterator[Stroke]:
    """The strokes of some moves."""
    rapid = _are(c, RAPIDS)
    step = np.full(len(c), STEP)
    if chord is not None:  # chord = r (1 - cos(step / 2)), nearly r step^2 / 8
        step = np.minimum(STEP, np.sqrt(8.0 * chord / np.maximum(c["radius"], chord)))
    count = np.where(c["arc"], np.ceil(np.abs(c["sweep"]) / step).astype(int) + 1, 2)
    count = np.where(c["cubic"], CURVE, count).astype(np.int64)
    begin = np.concatenate([[0], np.cumsum(count)]).astype(np.int64)
    points = np.empty((begin[-1], AXES))
    library().binding_gcode_points(
        ctypes.c_void_p(c.ctypes.data),
        ctypes.c_int64(len(c)),
        ctypes.c_void_p(begin.ctypes.data),
        ctypes.c_void_p(points.ctypes.data),
    )
    feed, line = np.repeat(c["feed"] * 60.0, count), np.repeat(c["line"], count)
    cuts = np.flatnonzero(np.diff(rapid) | (np.diff(tools) != 0)) + 1
    for a, b in zip([0, *cuts], [*cuts, len(c)], strict=True):
        own = slice(begin[a], begin[b])
        yield Stroke(bool(rapid[a]), int(tools[a]), points[own, :3], feed[own], line[own])
