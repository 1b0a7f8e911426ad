"""Contour error: every sample against the exact commanded geometry."""

from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.contour.assign import Index, assign
from motionfmu.contour.circles import CircularTest, circular_tests
from motionfmu.contour.corners import Corner, find_corners
from motionfmu.contour.geometry import TURN, Arc, Array
from motionfmu.contour.path import Path
from motionfmu.contour.statistics import Statistics, statistics
from motionfmu.contour.track import Track

AXES = "xyzuvw"
# The tool is within exp(-5) = 0.7 % of a corner's following distance after five servo lags.
LAGS = 5.0
# Shortest servo window [s]: a loop with full feed-forward has no lag but still settles.
WINDOW_MIN = 0.05
# The tool may run ahead of the command by this part of the window: overshoot, feed-forward.
AHEAD = 0.2
# A circle counts when this many windows have passed since its start: exp(-10) of a transient.
SETTLE = 2.0
FIFO_DEPTH = 63
# Commands under way beside the FIFO stock: one in the DDA, one transaction of 16, one spare.
UNDER_WAY = 18


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
    actual, commanded : ndarray, shape (n, 6)
        Position of the tool, and pulses put out over pulses per mm [mm].
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
    actual: Array
    commanded: Array
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

    def __post_init__(self) -> None:
        count = len(self.time)
        if count < 2 or not (np.diff(self.time) > 0.0).all():
            raise ValueError("time must have two samples or more and increase")
        shapes = {"actual": (count, 6), "commanded": (count, 6), "command": (count,)}
        if self.newest is not None:
            shapes["newest"] = (count,)
        for name, shape in shapes.items():
            values = getattr(self, name)
            if values.shape != shape:
                raise ValueError(f"{name} has the shape {values.shape} instead of {shape}")
            if not np.isfinite(values).all():
                bad = np.argwhere(~np.isfinite(values))[0]
                raise ValueError(f"{name} is not finite at {self.time[bad[0]]:g} s")


@dataclass(frozen=True)
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

    @property
    def following(self) -> Array:
        """Commanded minus actual position, shape (n, 6) [mm]."""
        return self.run.commanded - self.run.actual

    def numbers(self) -> dict[str, Any]:
        """Every number of the analysis, ready for JSON; mm, s, rad."""
        signed = self.track.signed
        following = self.following
        moved = self.cutting
        return {
            "units": {"length": "mm", "time": "s", "angle": "rad", "speed": "mm/s"},
            "samples": len(self.run.time),
            "samples_cutting": int(moved.sum()),
            "lag": self.lag,
            "window": self.window,
            "error": asdict(self.error)
            | {
                "signed_min": None if signed is None else float(signed[moved].min()),
                "signed_max": None if signed is None else float(signed[moved].max()),
            },
            "command_error": asdict(self.command_error),
            "following": {
                AXES[i]: {
                    "max": float(np.abs(following[moved, i]).max()),
                    "rms": float(np.sqrt(np.mean(following[moved, i] ** 2))),
                }
                for i in self.run.axes
            },
            "circles": [c.numbers() for c in self.circles],
            "corners": [asdict(c) for c in self.corners],
            "commands": self._per_command(),
        }

    def number(self, name: str) -> float:
        """One number by its dotted name.

        Parameters
        ----------
        name : str
            As in `numbers`, list items by index: ``error.max``, ``circles.0.ccw.g``.

        Returns
        -------
        float

        Raises
        ------
        KeyError
            There is no such number; the message names what is there.
        """
        value: Any = self.numbers()
        for part in name.split("."):
            if isinstance(value, list):
                value = {str(i): item for i, item in enumerate(value)}
            if not isinstance(value, dict) or part not in value:
                there = ", ".join(value) if isinstance(value, dict) and value else "nothing"
                raise KeyError(f"contour number {name!r}: no {part!r}, there is {there}")
            value = value[part]
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise KeyError(f"contour number {name!r} is not a number but {value!r}")
        return float(value)

    def _per_command(self) -> list[dict[str, Any]]:
        rows = []
        segments = self.run.path.segments
        found = np.flatnonzero(self.cutting)
        owners = self.track.segment[found]
        cuts = np.searchsorted(owners, np.arange(len(segments) + 1))
        for s, segment in enumerate(segments):
            own = found[cuts[s] : cuts[s + 1]]
            if not len(own):
                continue
            size = self.track.distance[own]
            label = segment.label
            rows.append(
                {
                    "command": label.command,
                    "line": label.line,
                    "kind": label.kind,
                    "length": segment.length,
                    "max": float(size.max()),
                    "rms": float(np.sqrt(np.mean(size**2))),
                    "time": float(self.run.time[own[np.argmax(size)]]),
                }
            )
        return rows


def analyse(run: ContourInput) -> ContourResult:
    """Find the contour error of a run against the exact geometry.

    First the pulses put out are followed along the path: each sample may lie on the segments
    whose points were written to the card within the time a command can wait in the FIFO, where
    two commands are mixed on both from the begin of the newer to the end of the older. Then
    the tool: it may lie on the segments where the pulses have been within the servo window.
    Both advance along the path and never return, see `motionfmu.contour.assign`.

    Parameters
    ----------
    run : ContourInput
        Geometry and signals.

    Returns
    -------
    ContourResult

    Raises
    ------
    ValueError
        The run never moves on a line, arc or helix.
    """
    path, time = run.path, run.time
    older = path.segment_of(np.maximum.accumulate(run.command))
    newer = older if run.newest is None else path.segment_of(np.maximum.accumulate(run.newest))
    newer = np.maximum(older, newer)
    wait = run.dda_time * (UNDER_WAY + (FIFO_DEPTH if run.stock is None else np.max(run.stock)))
    first, last = older[_at(time, -wait)], newer[_at(time, wait)]
    owners = assign(run.commanded[:, :3], path.segments, first, last)
    command_track = _follow(run.commanded, path, owners)
    lag = servo_lag(time, run.commanded[:, :3], run.actual[:, :3])
    window = max(LAGS * lag, WINDOW_MIN) if run.window is None else run.window
    back, ahead = _at(time, -window), _at(time, AHEAD * window)
    owners = assign(run.actual[:, :3], path.segments, owners[back], owners[ahead])
    track = _follow(run.actual, path, owners)
    tracks = (track, command_track)
    steps = np.any(np.diff(run.commanded[:, :3], axis=0) != 0.0, axis=1)
    count = np.concatenate([[0], np.cumsum(steps)])
    kinds = np.array([s.label.kind != "ptp" for s in path.segments])
    cutting = (count > count[back]) & kinds[track.segment]
    if not cutting.any():
        raise ValueError("the run never moves on a line, arc or helix: it has no contour")
    return ContourResult(
        run,
        track,
        command_track,
        cutting,
        lag,
        window,
        statistics(path, time, track, cutting),
        statistics(path, time, command_track, cutting & kinds[command_track.segment]),
        circular_tests(path, (time, run.actual[:, :3]), tracks, SETTLE * window, run.run_in),
        find_corners(path, time, tracks, cutting, window),
    )


def servo_lag(time: Array, commanded: Array, actual: Array) -> float:
    """Following distance over speed, in the least-squares sense.

    Parameters
    ----------
    time : ndarray, shape (n,)
        [s].
    commanded, actual : ndarray, shape (n, 3)
        [mm].

    Returns
    -------
    float
        [s]; 0 if nothing moves or the tool leads.
    """
    span = min(max(1, round(0.002 / float(np.median(np.diff(time))))), len(time) - 1)
    speed = (commanded[span:] - commanded[:-span]) / (time[span:] - time[:-span])[:, None]
    gap = (commanded - actual)[span:]
    power = float(np.sum(speed * speed))
    return max(0.0, float(np.sum(speed * gap)) / power) if power > 0.0 else 0.0


def _at(time: Array, shift: float) -> Index:
    """Sample that holds at each time plus a shift."""
    found = np.searchsorted(time, time + shift, side="right") - 1
    return np.clip(found, 0, len(time) - 1)


def _follow(positions: Array, path: Path, owners: Index) -> Track:
    """Nearest points on the segments the samples belong to."""
    points = positions[:, :3]
    foot, along = np.empty_like(points), np.empty(len(points))
    distance, tangent = np.empty(len(points)), np.empty_like(points)
    cuts = np.searchsorted(owners, np.arange(len(path.segments) + 1))
    for s in np.unique(owners).tolist():
        own = slice(int(cuts[s]), int(cuts[s + 1]))
        segment = path.segments[s]
        near = segment.foot(points[own])
        foot[own], distance[own] = near.point, near.distance
        tangent[own] = segment.tangent(near.along)
        way = near.along
        if isinstance(segment, Arc) and segment.rise == 0.0:
            way = _unwrap(segment, way)
        along[own] = path.offsets[s] + way
    signed = None
    if path.normal is not None:
        left = np.cross(path.normal, tangent)
        side = np.sum((points - foot) * left, axis=1)
        signed = np.where(side < 0.0, -distance, distance)
    return Track(owners, along, foot, distance, signed)


def _unwrap(arc: Arc, along: Array) -> Array:
    """Way along a circle that may be run through more than once."""
    turn = TURN / arc.angle * arc.length
    way = np.unwrap(along, period=turn)
    return np.clip(way - turn * np.round(way[0] / turn), 0.0, arc.length)
