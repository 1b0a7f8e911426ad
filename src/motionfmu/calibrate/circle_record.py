"""A circular test (ISO 230-4) as a file has it: of a ballbar, or X and Y of a circle."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.analysis.contour.circles import CircularTest
from motionfmu.analysis.explain import BallbarRecord, ballbar_of, ballbar_test
from motionfmu.base.errors import InputError
from motionfmu.records import readers
from motionfmu.records.raw_table import NoTimes

# The nominal centre of a circle of places is the fitted one on this grid [mm].
GRID = 0.1


@dataclass(frozen=True)
class CircleChoice:
    """What the file of a circle does not say.

    Attributes
    ----------
    radius : float, optional
        Nominal [mm].
    feed : float, optional
        Along the circle [mm/min]; else by the record's times.
    over : mapping
        Columns by ``angle``, ``deviation``, ``radius``, or by the two axes, that have other names.
    layout : mapping
        As of `motionfmu.record`.
    """

    radius: float | None = None
    feed: float | None = None
    over: Mapping[str, str] = field(default_factory=dict)
    layout: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class CircleRecord:
    """A circular test that files hold.

    Attributes
    ----------
    name : str
        Of the first file.
    plane : str
        ``XY``, ``ZX`` or ``YZ``.
    test : CircularTest
        Both ways round.
    centre : tuple of float, optional
        Nominal centre in the plane [mm], where the record has places of the machine.
    """

    name: str
    plane: str
    test: CircularTest
    centre: tuple[float, float] | None = None


def circle_record(files: Sequence[Path], plane: str, choice: CircleChoice) -> CircleRecord:
    """Read a circular test, of one file or one for each way.

    Parameters
    ----------
    files : sequence of Path
    plane : str
        ``XY``, ``ZX`` or ``YZ``.
    choice : CircleChoice

    Returns
    -------
    CircleRecord

    Raises
    ------
    InputError
        What is wrong, with file, line and value.
    """
    radius = choice.radius
    if radius is None or not radius > 0.0:
        told = "--radius, the nominal one [mm], wanted"
        raise InputError(
            f"{files[0]}: a circle: {told}" + ("" if radius is None else f": {radius}")
        )
    parts, centre = [], None
    for file in files:
        own, middle = _one(file, plane, radius, choice)
        parts.append(own)
        centre = centre or middle
    feed = None if choice.feed is None else choice.feed / 60.0
    try:
        test = ballbar_test(parts, radius, plane, feed)
    except (ValueError, ArithmeticError) as error:
        raise InputError(f"{files[0]}: {error}") from None
    if test.ccw is None or test.cw is None:
        way = "clockwise" if test.cw is None else "counter-clockwise"
        told = f"no circle {way}: geometry and lag are told apart by both ways"
        raise InputError(f"{files[0]}: {told}")
    return CircleRecord(str(files[0]), plane, test, centre)


def _one(
    file: Path, plane: str, radius: float, choice: CircleChoice
) -> tuple[BallbarRecord, tuple[float, float] | None]:
    """One file: of a ballbar, or of places, whose centre is given back, too."""
    try:
        found = readers.record(file, **choice.layout)
        timed = True
    except NoTimes:
        found, timed = readers.record(file, **choice.layout, rate=1.0), False
    lower = {n.lower(): n for n in found}
    names = [choice.over.get(a, lower.get(a.lower())) for a in plane]
    if None in names:
        return ballbar_of(file, radius, choice.over, choice.layout)[1], None
    places = []
    for name in names:
        assert name is not None
        bad = found.missing(name)
        if bad.any():
            raise InputError(f"{found.place(int(bad.argmax()))}: a value is missing")
        places.append(found.in_unit(name, "mm"))
    x, y = places
    # a circle by least squares: x² + y² = 2 a x + 2 b y + c
    rows = np.column_stack([x, y, np.ones_like(x)])
    a, b, c = np.linalg.lstsq(rows, x**2 + y**2, rcond=None)[0]
    size = math.sqrt(max(float(c) + 0.25 * float(a) ** 2 + 0.25 * float(b) ** 2, 0.0))
    if abs(size - radius) > 0.1 * radius:
        raise InputError(f"{file}: a circle of R {size:.4g} mm, --radius says {radius:g}")
    centre = (round(0.5 * float(a) / GRID) * GRID, round(0.5 * float(b) / GRID) * GRID)
    u, v = x - centre[0], y - centre[1]
    measured = BallbarRecord(
        np.arctan2(v, u), np.hypot(u, v) - radius, found.time if timed else None
    )
    return measured, (round(centre[0], 1), round(centre[1], 1))
