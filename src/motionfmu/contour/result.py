"""What a contour analysis takes and gives."""

from dataclasses import asdict, dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.contour.circles import CircularTest
from motionfmu.contour.corners import Corner
from motionfmu.contour.geometry import Array
from motionfmu.contour.path import Path
from motionfmu.contour.statistics import Statistics
from motionfmu.contour.track import Track
from motionfmu.errors import NoNumber

AXES = "xyzuvw"


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
        return self.run.commanded - self.run.actual

    def __repr__(self) -> str:
        error = self.error
        parts = f"{len(self.circles)} circles, {len(self.corners)} corners"
        return f"<ContourResult: max {error.max:.4g} mm, RMS {error.rms:.4g} mm, {parts}>"

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
            "circles": self._circles(),
            "corners": [dict(vars(c)) for c in self.corners],  # flat: asdict copies deeply
            "commands": self._per_command(),
        }

    @cached_property
    def _numbers(self) -> dict[str, Any]:
        """`numbers`, made once: a scenario's checks ask for one after the other."""
        return self.numbers()

    def _circles(self) -> list[dict[str, Any] | None]:
        """By their number in the path, so that a name means the same circle in every run."""
        found = {c.place: c.numbers() for c in self.circles}
        known = {*found, *(int(name.split(".")[1]) for name in self.missing)}
        return [found.get(i) for i in range(1 + max(known, default=-1))]

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
        value: Any = self._numbers
        for part in name.split("."):
            if isinstance(value, list):
                value = {str(i): item for i, item in enumerate(value)}
            if not isinstance(value, dict) or part not in value:
                raise NoNumber(f"contour number {name!r}: {self._why(name, part, value)}")
            value = value[part]
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise NoNumber(f"contour number {name!r} is not a number but {value!r}")
        return float(value)

    def _why(self, name: str, part: str, value: Any) -> str:
        """Why a number is not there: what the analysis left out, else what there is."""
        for place, reason in self.missing.items():
            if name.startswith((f"{place}.", f"{place.rpartition('.')[0]}.both.")):
                return reason
        there = ", ".join(value) if isinstance(value, dict) else ""
        return f"no {part!r}, there is {there}" if there else "the run has none"

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
