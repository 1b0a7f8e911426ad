"""How far a tool is from where its controller commands it at the same instant."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base import units
from motionfmu.run.decimate import Read, blocks, reader
from motionfmu.run.run_record import RunRecord
from motionfmu.scenarios.tool_signals import Tool, outputs, tools

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Size:
    """Largest and RMS value of a distance or an angle over a run."""

    largest: float
    at: float  # [s]
    rms: float

    def numbers(self) -> dict[str, float]:
        """The same for JSON."""
        return {"max": self.largest, "at": self.at, "rms": self.rms}


@dataclass(frozen=True)
class ToolGap:
    """Distance and angle between a tool and its command at the same instants."""

    tool: Tool
    distance: Read  # (n,) [mm]
    angle: Read | None  # (n,) [deg]; None if attitudes are unknown
    sizes: tuple[Size, Size | None]

    def numbers(self) -> dict[str, Any]:
        """Names of both signals, distance [mm] and angle [deg], for JSON."""
        (command, actual), (distance, angle) = self.tool.position, self.sizes
        return {
            "command": command,
            "actual": actual,
            "distance": distance.numbers(),
            "angle": None if angle is None else angle.numbers(),
        }


def tool_gaps(run: RunRecord) -> list[ToolGap]:
    """Each tool whose command and place were recorded, as numbers, throughout."""
    found = []
    for tool in tools(run.resolver):
        names = outputs(tool)
        reads = [reader(run.signals[n]) for n in names if n in run.signals]
        finite = all(np.isfinite(b).all() for r in reads for b in blocks(len(run.time), r))
        if len(reads) == len(names) and finite:
            distance = _distance(run, tool)
            angle = None if tool.attitude is None else _angle(run, tool.attitude)
            sizes = _size(run.time, distance), angle and _size(run.time, angle)
            found.append(ToolGap(tool, distance, angle, sizes))
    return found


def _distance(run: RunRecord, tool: Tool) -> Read:
    command, actual = (in_mm(run, name) for name in tool.position)
    base = in_mm(run, tool.base) if tool.base else None

    def distance(first: int, last: int) -> Array:
        gap = actual(first, last) - command(first, last)
        if base is not None:
            gap = gap + base(first, last)
        return np.asarray(np.linalg.norm(gap, axis=1))

    return distance


def in_mm(run: RunRecord, name: str) -> Read:
    """A recorded signal in mm, block by block."""
    component, _, variable = name.partition(".")
    unit = run.resolver.ports[component][variable].unit
    factor, read = units.parse(unit or "1").factor / units.parse("mm").factor, reader(run[name])
    return lambda first, last: np.asarray(factor * read(first, last))


def _angle(run: RunRecord, pair: tuple[str, str]) -> Read:
    """The angle of the turn from one quaternion to the other, exact near 0 as well."""
    command, actual = (reader(run[name]) for name in pair)

    def angle(first: int, last: int) -> Array:
        p, q = command(first, last), actual(first, last)
        p = np.where((p * q).sum(axis=1, keepdims=True) < 0.0, -p, p)
        half = np.linalg.norm(q - p, axis=1), np.linalg.norm(q + p, axis=1)
        return np.asarray(np.degrees(4.0 * np.arctan2(*half)))

    return angle


def _size(time: Array, read: Read) -> Size:
    largest, at, squares, before = -1.0, 0, 0.0, 0
    for block in blocks(len(time), read):
        k = int(np.argmax(block))
        if block[k] > largest:
            largest, at = float(block[k]), before + k
        squares += float((block**2).sum())
        before += len(block)
    return Size(largest, float(time[at]), float(np.sqrt(squares / len(time))))
