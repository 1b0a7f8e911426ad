"""Figures of a part program: time, lengths, extents and tools."""

import ctypes
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.gcode.program import AXES, TYPES, Program
from motionfmu.base.binding import library

# Largest angle of an arc between two points [rad]; number of points of a curve.
STEP, CURVE = 0.05, 41
MOTIONS = ("line", "cw_arc", "ccw_arc", "cw_helix", "ccw_helix", "curve")


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


def _kinds(commands: np.ndarray) -> NDArray[np.str_]:
    return np.array(TYPES)[commands["type"]]


def tools_of(commands: np.ndarray) -> NDArray[np.int64]:
    """The tool in the spindle at each command."""
    kinds = _kinds(commands)
    known = (kinds == "outputs") | commands["changes"]
    last = np.maximum.accumulate(np.where(known, np.arange(len(commands)), -1))
    found = np.where(last >= 0, commands["tool"][np.maximum(last, 0)], 0)
    return found.astype(np.int64)


def _extents(commands: np.ndarray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Smallest and largest coordinates of each path [mm], exact."""
    low = np.minimum(commands["start"], commands["end"])
    high = np.maximum(commands["start"], commands["end"])
    low, high = np.ascontiguousarray(low), np.ascontiguousarray(high)
    for i in np.flatnonzero(commands["arc"] | commands["cubic"]):
        library().binding_gcode_extent(
            ctypes.c_void_p(commands[i : i + 1].ctypes.data),
            ctypes.c_void_p(low[i].ctypes.data),
            ctypes.c_void_p(high[i].ctypes.data),
        )
    return low, high


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
    c = program.commands
    kinds, tools, seconds = _kinds(c), tools_of(c), program.seconds()
    feed, rapid = np.isin(kinds, MOTIONS), np.isin(kinds, ("rapid", "rapid_joints"))
    low, high = _extents(c)
    uses = []
    for tool in dict.fromkeys(tools[feed | rapid].tolist()):
        own = tools == tool
        cut = own & feed
        uses.append(
            Use(
                int(tool),
                float(seconds[own].sum()),
                float(c["length"][cut].sum()),
                *(_bounds(low[cut], high[cut])),
            )
        )
    moves = feed | rapid
    feeds = c["feed"][feed] * 60.0
    return Summary(
        time=float(seconds.sum()),
        feed_way=float(c["length"][feed].sum()),
        rapid_way=float(c["length"][rapid].sum()),
        **dict(zip(("low", "high"), _bounds(low[moves], high[moves]), strict=True)),
        feeds=(float(feeds.min()), float(feeds.max())) if feed.any() else (0.0, 0.0),
        tools=uses,
        commands=len(c),
        stops=int((kinds == "stop").sum()),
    )


def _bounds(
    low: NDArray[np.float64], high: NDArray[np.float64]
) -> tuple[tuple[float, ...], tuple[float, ...]]:
    if not len(low):
        return (0.0,) * AXES, (0.0,) * AXES
    return tuple(map(float, low.min(axis=0))), tuple(map(float, high.max(axis=0)))


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
    kinds, tools = _kinds(program.commands), tools_of(program.commands)
    moves = np.isin(kinds, (*MOTIONS, "rapid", "rapid_joints"))
    raw = program.commands.view(np.uint8).reshape(len(kinds), -1)[moves]
    c: np.ndarray = raw.ravel().view(program.commands.dtype)  # whole structs
    if not len(c):
        return
    rapid, tools = np.isin(_kinds(c), ("rapid", "rapid_joints")), tools[moves]
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
