"""A circle that a ballbar has measured: its deviation over its angle, one way or both."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.analysis.contour.arcs import TURN, Array
from motionfmu.analysis.contour.circles import (
    COVERAGE_MIN,
    SAMPLES_MIN,
    CirclePass,
    CircularTest,
    plane_axes,
)
from motionfmu.analysis.contour.iso230 import both_ways, reading
from motionfmu.base.errors import InputError
from motionfmu.records import Record, readers
from motionfmu.records.raw_table import NoTimes

# Normal of each plane, as G17, G18 and G19 have it.
PLANES = {"XY": (0.0, 0.0, 1.0), "ZX": (0.0, 1.0, 0.0), "YZ": (1.0, 0.0, 0.0)}


@dataclass(frozen=True)
class BallbarRecord:
    """What a ballbar has measured.

    Attributes
    ----------
    angle : ndarray, shape (n,)
        From the plane's first axis [rad]; it increases counter-clockwise.
    deviation : ndarray, shape (n,)
        Measured less nominal radius [mm].
    time : ndarray, shape (n,), optional
        [s]; None if it is unknown.
    """

    angle: Array
    deviation: Array
    time: Array | None = None


def ballbar_of(
    file: Path, radius: float, over: Mapping[str, str], layout: Mapping[str, Any]
) -> tuple[Record, BallbarRecord]:
    """Read a ballbar's record: its angle, and its deviation or radius.

    Parameters
    ----------
    file : Path
    radius : float
        Nominal [mm].
    over : mapping
        Columns by ``angle``, ``deviation`` and ``radius``, where they have other names.
    layout : mapping
        What the file does not say, as of `motionfmu.record`.

    Returns
    -------
    record : Record
    measured : BallbarRecord

    Raises
    ------
    InputError
        What is wrong, with file, line and character.
    """
    timed = True
    try:
        found = readers.record(file, **layout)
    except NoTimes:
        found, timed = readers.record(file, **layout, rate=1.0), False
    lower = {n.lower(): n for n in found}

    def column(*names: str) -> str | None:
        wanted = [over.get(n) for n in names] + [lower.get(n) for n in names]
        return next((n for n in wanted if n is not None), None)

    angle = column("angle", "winkel", "phi")
    size = column("deviation", "radius", "abweichung", "error")
    if angle is None or size is None:
        told = f"angle and deviation or radius wanted (there are: {', '.join(found)})"
        raise InputError(f"{file}: {told}: --map angle=COLUMN --map deviation=COLUMN")
    data = found.in_unit(size, "mm")
    whole = size == column("radius") and size != column("deviation")
    if whole:
        data = data - radius
    bad = found.missing(angle) | found.missing(size)
    if bad.any():
        raise InputError(f"{found.place(int(bad.argmax()))}: a value is missing")
    time = found.time if timed else None
    return found, BallbarRecord(found.in_unit(angle, "rad"), data, time)


def ballbar_test(
    records: Iterable[BallbarRecord],
    radius: float,
    plane: str = "XY",
    feed: float | None = None,
) -> CircularTest:
    """Make the circular test of a ballbar's records.

    Parameters
    ----------
    records : iterable of BallbarRecord
        One with both ways, or one for each.
    radius : float
        Nominal [mm].
    plane : str
        ``XY``, ``ZX`` or ``YZ``.
    feed : float, optional
        Along the circle [mm/s]; else by the records' times; 0 if they have none.

    Returns
    -------
    CircularTest
        Of each way the longest stretch, of which the middle whole turns count: what a ballbar
        travels before and behind them is left out.

    Raises
    ------
    ValueError
        No stretch covers enough of the circle, or the plane is unknown.
    """
    if plane not in PLANES:
        raise ValueError(f"plane {plane!r}: {', '.join(PLANES)} are known")
    normal = np.array(PLANES[plane])
    test = CircularTest(0, np.zeros(3), normal, radius, plane_axes(normal))
    best: dict[str, tuple[float, CirclePass]] = {}
    most = 0.0
    for record in records:
        angle = np.unwrap(record.angle)
        for part in _stretches(angle):
            turned = float(angle[part][-1] - angle[part][0])
            most = max(most, abs(turned))
            if abs(turned) < COVERAGE_MIN or part.stop - part.start < SAMPLES_MIN:
                continue
            name = "ccw" if turned > 0 else "cw"
            if name not in best or best[name][0] < abs(turned):
                best[name] = (abs(turned), _pass(record, angle, part, (radius, feed)))
    if not best:
        wanted = math.degrees(COVERAGE_MIN)
        told = f"{math.degrees(most):.0f}° of the circle in one direction"
        raise ValueError(f"{told}, {wanted:.0f}° wanted")
    ways = {name: way for name, (_, way) in best.items()}
    found = replace(test, ccw=ways.get("ccw"), cw=ways.get("cw"))
    if found.ccw and found.cw:
        both = both_ways(found.ccw.points, found.cw.points, radius)
        found = replace(found, both=both)
    return found


def _stretches(angle: Array) -> list[slice]:
    """Parts between the least and the largest angle, in each of which it goes one way."""
    cuts = sorted({0, int(np.argmin(angle)), int(np.argmax(angle)), len(angle) - 1})
    return [slice(a, b + 1) for a, b in pairwise(cuts)]


def _pass(
    record: BallbarRecord, angle: Array, part: slice, known: tuple[float, float | None]
) -> CirclePass:
    radius, feed = known
    way = np.abs(angle[part] - angle[part][0])
    turns = math.floor(float(way[-1]) / TURN + 1e-9)
    over = 0.5 * (float(way[-1]) - turns * TURN) if turns else 0.0
    rows = part.start + np.flatnonzero((way >= over) & (way <= way[-1] - over))
    own = angle[rows]
    size = radius + record.deviation[rows]
    points = np.column_stack([size * np.cos(own), size * np.sin(own)])
    time = np.zeros(len(rows)) if record.time is None else record.time[rows]
    covered = float(abs(own[-1] - own[0]))
    speed = feed
    if speed is None:
        took = float(time[-1] - time[0])
        speed = covered * radius / took if took > 0.0 else 0.0
    return CirclePass(
        first=0,
        last=0,
        lines=(0, 0),
        points=points,
        time=time,
        coverage=covered,
        steady=bool(turns),
        speed=speed,
        reading=reading(points, radius),
    )
