"""A measured tool position in place of a run's: its contour, its figures after ISO 9283."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.contour import ContourResult, Path
from motionfmu.analysis.contour.tool_record import ToolRecord, analyse_record
from motionfmu.analysis.iso9283 import Evaluation
from motionfmu.base.errors import InputError, NoNumber
from motionfmu.records import Record
from motionfmu.run.iso9283_of import evaluation_of
from motionfmu.run.planned_text import PlannedText
from motionfmu.run.result import Result
from motionfmu.scenarios.record_signals import in_unit_of
from motionfmu.scenarios.system import Resolver

AXES = "XYZ"
Array = NDArray[Any]


def record_contour(
    run: Result, measured: Record, over: Mapping[str, str] | None = None
) -> ContourResult:
    """Find a measured tool's contour error against a run's program.

    Parameters
    ----------
    run : Result
        Of a scenario with a [contour], which gives the exact path.
    measured : Record
        Of the whole program, with X, Y and Z, or what `over` names.
    over : mapping, optional
        The record's column by ``X``, ``Y``, ``Z``, by the signal of [contour], or by its elements;
        if not given what [record_file] says.

    Raises
    ------
    InputError
        A column is missing or has no unit of length, or the scenario has no [contour] table.
    NoNumber
        The record is not of this program.
    """
    contour = run.resolver.document.body.contour
    if contour is None:
        raise InputError(f"{run.name}: the scenario has no [contour] table")
    known = run.contour()
    path = known.run.path
    points, axes = _tool(measured, contour.position, _over(run.resolver, over), path)
    try:
        return analyse_record(ToolRecord(measured.time, points, axes), path, known.window)
    except (ValueError, ArithmeticError) as error:
        raise NoNumber(f"{measured.name}: no contour: {error}") from None


def _over(resolver: Resolver, over: Mapping[str, str] | None) -> Mapping[str, str]:
    table = resolver.document.body.record_file
    return over if over is not None else table.over if table is not None else {}


# CCN 17: the names that an axis may have, the stronger first.
def _tool(
    measured: Record, signal: str, over: Mapping[str, str], path: Path
) -> tuple[Array, tuple[int, ...]]:
    """Positions (n, 3) [mm] of a record, and the axes that the program moves."""
    whole = over.get(signal, signal if signal in measured else "")
    c = path.segments.columns
    ends = np.concatenate([c.start, path.segments.ends])
    points = np.empty((len(measured.ns), 3))
    moved = []
    for i, axis in enumerate(AXES):
        names = (over.get(axis), over.get(f"{signal}[{i + 1}]"), axis, axis.lower())
        name = next((n for n in names if n and n in measured), None)
        missing = next((n for n in names[:2] if n and n not in measured), None)
        if missing is not None:
            measured[missing]  # tells what may be meant
        if whole:
            name = f"{whole}[{i + 1}]" if f"{whole}[{i + 1}]" in measured else None
        still = np.ptp(ends[:, i]) == 0.0 and not _turns(path, i)
        if not still:
            moved.append(i)
        if name is not None:
            points[:, i] = measured.in_unit(name, "mm")
        elif still:
            points[:, i] = ends[0, i]
        else:
            told = f"no column {axis}, which the program moves: say which it is"
            raise InputError(f"{measured.name}: {told} (there are: {', '.join(measured)})")
    bad = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if len(bad):
        raise InputError(f"{measured.place(int(bad[0]))}: the tool has no position")
    return points, tuple(moved)


def _turns(path: Path, axis: int) -> bool:
    """Whether an arc or a curve leaves the plane of its ends along an axis."""
    arcs, curves = path.segments.arcs, path.segments.columns.curves
    round_ = bool(len(arcs.radius)) and bool((np.abs(arcs.axes[:, :2, axis]) > 1e-9).any())
    return round_ or any(np.ptp(c.control[:, axis]) > 0 for c in curves.values())


@dataclass
class RecordedTool:
    """A record under the names that a scenario gives to its signals."""

    run: Result
    time: NDArray[np.float64]  # (n,) [s]
    signals: Mapping[str, Array]
    planned: PlannedText | None = None

    @property
    def resolver(self) -> Resolver:
        """The scenario's FMUs and file."""
        return self.run.resolver

    def __getitem__(self, name: str) -> Array:
        return self.signals[name]

    def parameter(self, name: str) -> Any:
        """Value of a parameter in the run."""
        return self.run.parameter(name)


def record_iso9283(
    run: Result, measured: Record, over: Mapping[str, str] | None = None
) -> Evaluation:
    """Find a measured tool's figures after ISO 9283.

    Parameters
    ----------
    run : Result
        Of a scenario with an [iso9283] table; a command that is a signal is the run's.
    measured : Record
        Its times are those of the table's cycles; columns are named as the table's signals, or as
        `over` says, a tool position also X, Y and Z.
    over : mapping, optional
        The record's column by signal, or element of one; if not given what [record_file] says.

    Raises
    ------
    InputError
        A column is missing or has another unit, or the scenario has no [iso9283] table.
    NoNumber
        The record has no such figures.
    """
    table = run.resolver.document.body.iso9283
    if table is None:
        raise InputError(f"{run.name}: the scenario has no [iso9283] table")
    names = _over(run.resolver, over)
    signals = {}
    for name in (table.position, table.quaternion, table.during):
        if name is not None:
            signals[name] = _columns(run.resolver, measured, name, names)
    path = run.iso9283().path.given.path if table.command is not None else None
    return evaluation_of(RecordedTool(run, measured.time, signals), path)


def _columns(resolver: Resolver, measured: Record, signal: str, over: Mapping[str, str]) -> Array:
    """The columns of a signal in its unit; of a position the first three elements."""
    port = resolver.end(signal, "iso9283", "position").port
    whole = over.get(signal, signal)
    if whole in measured:
        return in_unit_of(measured, whole, port)
    count = min(port.count, 4 if port.shape == (4,) else 3)
    parts = []
    for i in range(count):
        names = [over.get(f"{signal}[{i + 1}]"), over.get(AXES[i]) if i < 3 else None]
        names += [AXES[i], AXES[i].lower()] if count == 3 else []
        name = next((n for n in names if n and n in measured), None)
        if name is None:
            told = f"no column for {signal}[{i + 1}] (there are: {', '.join(measured)})"
            raise InputError(f"{measured.name}: {told}")
        parts.append(in_unit_of(measured, name, port))
    return np.column_stack(parts)
