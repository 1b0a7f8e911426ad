"""The axes of a machine: which signals show their figures, and what limits these."""

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from motionfmu.base import units
from motionfmu.base.errors import Faults
from motionfmu.base.toml_lines import shown
from motionfmu.scenarios import recording
from motionfmu.scenarios.body import FigureLimit, MachineAxis
from motionfmu.scenarios.document import Document
from motionfmu.scenarios.system import End, Resolver, Setting
from motionfmu.scenarios.values import values_in

BOUNDS = ("limit", "low", "high", "continuous")
# Of a joint that slides among others that turn: mm for °, in m.
_OF_DEGREES = {"deg": 1e-3, "deg/s": 1e-3, "deg/s2": 1e-3}
_SLIDES = "joint_slides"  # parameter of who has such joints
# [°] for a row that counts in this
_DEGREES = {"m": 1e3, "mm": 1.0, "um": 1e-3, "rad": math.degrees(1.0)}
_SECOND = units.parse("s").exponents
_PER_TIME = re.compile(r"(.*)/s(\d*)")


@dataclass(frozen=True)
class AxisLimit:
    """A figure of one axis: its signal, and what limits it, in `unit`."""

    axis: MachineAxis
    figure: str  # a key of [limits]
    signal: End
    element: int | None  # of the signal, from 0; None if it has one value
    derivative: int  # of the signal by time, of which the figure is the value
    unit: str  # of the figure, as FMI spells it; "1" for a number
    limit: float | None = None  # of its size
    low: float | None = None
    high: float | None = None
    continuous: float | None = None  # of its RMS
    overload: float | None = None  # [s] that its size may stay above continuous at a time
    scale: float = 1.0  # of the signal's unit, to `unit`


def wanted(resolver: Resolver) -> list[str]:
    """Signals of the [limits] table, which are recorded; axes, names and units are checked."""
    document, faults = resolver.document, Faults()
    _check_axes(document, faults)
    faults.tell()
    found = []
    for figure, given in document.body.limits.items():
        with faults.each():
            found.append(_signal(resolver, figure).name)
            for key in (*BOUNDS, "overload", "when", "over"):
                with faults.each():
                    _check_bound(resolver, figure, key, getattr(given, key))
    faults.tell()
    return found


def axis_limits(resolver: Resolver, settings: Sequence[Setting]) -> list[AxisLimit]:
    """Each figure of each axis with the limits that a run with these settings has."""
    given = {s.end.name: s.values for s in settings}
    document = resolver.document
    return [
        _of_axis(resolver, figure, axis, place, given)
        for figure in document.body.limits
        for place, axis in enumerate(document.axes)
    ]


def _check_axes(document: Document, faults: Faults) -> None:
    """Refuse two axes of one name or row, and limits of no axis."""
    names: dict[Any, str] = {}
    for k, axis in enumerate(document.axes):
        for key, value in (("name", axis.name), ("row", axis.row)):
            with faults.each():
                if (key, value) in names:
                    text = f"{key} = {value!r}: axis {names[key, value]} has it, too"
                    raise document.error(text, f"axis.{k}", key)
            names.setdefault((key, value), axis.name)
    with faults.each():
        if document.body.limits and not document.body.axis:
            raise document.error("limits of which axes? [[axis]] is missing", "limits")


def _signal(resolver: Resolver, figure: str) -> End:
    """The signal of a figure, in which each axis has its element."""
    document, table = resolver.document, f"limits.{figure}"
    given = document.body.limits[figure]
    end = recording.output(resolver, given.signal, table, "signal")
    if end.port.type == "Boolean":
        raise document.error(f"{end.name} is Boolean: a number wanted", table, "signal")
    _check_rows(document, end, table, "signal")
    return end


def _check_rows(document: Document, end: End, table: str, key: str) -> None:
    """Refuse a variable in which an axis has no element; one value is for all."""
    if not end.port.shape:
        if key == "signal" and len(document.axes) > 1:
            text = f"{end.name} is a single value: an element for each axis wanted"
            raise document.error(text, table, key)
        return
    for k, axis in enumerate(document.axes):
        if axis.row and axis.row > end.port.count:
            text = f"{end.name} has {end.port.count} elements: axis {axis.name} is row {axis.row}"
            raise document.error(text, f"axis.{k}", "row")


def _check_bound(resolver: Resolver, figure: str, key: str, value: Any) -> None:
    """Refuse a list of another length, and a parameter that is none or has another unit."""
    document, table = resolver.document, f"limits.{figure}"
    count = len(document.axes)
    if isinstance(value, tuple) and len(value) != count:
        text = f"{key} = {shown(list(value))}: a number for each of {count} axes wanted"
        raise document.error(text, table, key)
    if not isinstance(value, str):
        return
    end = resolver.end(value, table, key)
    if end.port.causality not in ("parameter", "input"):
        text = f"{value} is no parameter ({end.port.causality})"
        raise document.error(text, table, key)
    if end.port.type == "String" or (end.port.type == "Boolean" and key != "when"):
        raise document.error(f"{value} is {end.port.type}: a number wanted", table, key)
    _check_rows(document, end, table, key)
    if key == "over" and units.parse(end.port.unit or "1").exponents != _SECOND:
        raise document.error(f"{value} is no time", table, key)
    if key in BOUNDS:
        _factor(resolver, figure, key, end)


def _figure_unit(resolver: Resolver, figure: str) -> str:
    """Unit of a figure: its signal's, per time for each derivative."""
    given = resolver.document.body.limits[figure]
    unit = _signal(resolver, figure).port.unit or "1"
    if not given.derivative:
        return unit
    base, power = unit, 0
    if found := _PER_TIME.fullmatch(unit):
        base, power = found[1], int(found[2] or 1)
    power += given.derivative
    return f"{base}/s{power if power > 1 else ''}"


def _factor(resolver: Resolver, figure: str, key: str, end: End) -> float:
    """What a parameter's value is multiplied with; one without unit is in the figure's."""
    wanted, own = _figure_unit(resolver, figure), end.port.unit
    over = resolver.document.body.limits[figure].over
    if key == "limit" and over is not None and own is not None:
        own += f"/{resolver.end(over, f'limits.{figure}', 'over').port.unit}"
    if own is None or own == wanted:
        return 1.0
    try:
        there, here = units.parse(own), units.parse(wanted)
        if there.exponents == here.exponents:
            return there.factor / here.factor
    except ValueError:  # a unit that only a foreign FMU knows
        pass
    text = f"{end.name} [{own}] limits {figure} [{wanted}]: units differ"
    raise resolver.document.error(text, f"limits.{figure}", key)


def _of_axis(
    resolver: Resolver, figure: str, axis: MachineAxis, place: int, given: Mapping[str, Any]
) -> AxisLimit:
    """A figure of one axis with its limits."""
    source: FigureLimit = resolver.document.body.limits[figure]
    end, row = _signal(resolver, figure), (axis.row or 1) - 1
    element = row if end.port.shape else None
    found: dict[str, float] = {}
    acts = source.when is None or bool(_value(resolver.end(source.when, "", ""), row, given))
    for key, value in _bounds(source) if acts else ():
        if isinstance(value, str):
            other = resolver.end(value, f"limits.{figure}", key)
            factor = _factor(resolver, figure, key, other)
            found[key] = float(_value(other, row, given)) * _of_a_slide(axis, other, factor)
        else:
            found[key] = value[place] if isinstance(value, tuple) else value
    if "limit" in found and source.over is not None:
        time = float(_value(resolver.end(source.over, "", ""), row, given))
        limit = found.pop("limit")
        found |= {"limit": limit / time} if time else {}
    among_turning = _SLIDES in resolver.ports[end.component]
    unit, scale = _shown_as(axis, _figure_unit(resolver, figure), among_turning)
    found = {key: value * scale for key, value in found.items()} | {"scale": scale}
    if acts and source.overload is not None:
        times = source.overload
        found["overload"] = times[place] if isinstance(times, tuple) else times
    return AxisLimit(axis, figure, end, element, source.derivative, unit, **found)


def _of_a_slide(axis: MachineAxis, other: End, factor: float) -> float:
    """The factor of a limit in degrees, which a joint that slides has in mm."""
    slides = axis.kind == "linear" and other.port.unit in _OF_DEGREES
    return _OF_DEGREES[other.port.unit or ""] if slides else factor


def _shown_as(axis: MachineAxis, unit: str, among_turning: bool) -> tuple[str, float]:
    """Unit in which a figure of an axis is shown, and its size in that.

    1 mm is 1° of a turn; among joints that turn, one that slides has m for rad.
    """
    base, slash, time = unit.partition("/")
    if among_turning and axis.kind == "linear" and base == "rad":
        return f"mm{slash}{time}", 1e3
    if axis.kind != "rotary" or base not in _DEGREES:
        return unit, 1.0
    return f"deg{slash}{time}", _DEGREES[base]


def _bounds(source: FigureLimit) -> Iterator[tuple[str, Any]]:
    pairs = ((key, getattr(source, key)) for key in BOUNDS)
    return ((key, value) for key, value in pairs if value is not None)


def _value(end: End, row: int, given: Mapping[str, Any]) -> Any:
    """A parameter's value for an axis: the run's, else the FMU's."""
    return values_in(given, end.component, end.port)[row if end.port.shape else 0]
