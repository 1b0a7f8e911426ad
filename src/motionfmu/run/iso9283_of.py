"""From a run to its figures after ISO 9283: cycles and command path, in mm."""

import functools
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.iso9283 import (
    CommandPath,
    Cycle,
    Cycles,
    Evaluation,
    analyse,
    pose_performance,
    read_points,
)
from motionfmu.analysis.iso9283.simplify import simplified
from motionfmu.base import units
from motionfmu.base.errors import InputError, NoNumber
from motionfmu.run.run_record import RunRecord
from motionfmu.scenarios.document import Document
from motionfmu.scenarios.system import Resolver

TABLE = "iso9283"
# When a recorded command is thinned out, a unit quaternion counts as so many mm; so turns of
# 1e-5 rad stay.
TURN_SCALE = 10.0


def written_path(document: Document) -> CommandPath | None:
    """The command path that the scenario gives as points or file; None for a signal."""
    table = document.body.iso9283
    if table is None:
        return None
    try:
        if table.points is not None:
            return CommandPath.of(np.array(table.points))
        if table.file is not None:
            return read_points(
                document.beside(table.file) or document.sources[0].folder / table.file
            )
    except ValueError as error:
        raise document.error(str(error), TABLE, "file" if table.file else "points") from None
    return None


def evaluation_of(run: RunRecord, path: CommandPath | None = None) -> Evaluation:
    """Evaluate a run, along another path than its own if one is given.

    Without an [iso9283] table there is an InputError, without such figures of the run NoNumber.
    """
    document = run.resolver.document
    table = document.body.iso9283
    if table is None:
        raise InputError(f"{document.file}: the scenario has no [iso9283] table")
    place = functools.partial(position, run.resolver)
    tool = place(table.position, run[table.position])
    turn = None if table.quaternion is None else run[table.quaternion]
    spans = _spans(run)
    try:
        if not spans:
            raise ValueError(f"{table.during} is never between {table.between}")
        parts = [slice(low, high) for low, high in spans]
        path = path or written_path(document) or _recorded_path(run, parts[0])
        cycles = [Cycle(run.time[p], tool[p], None if turn is None else turn[p]) for p in parts]
        normal = None if table.normal is None else np.array(table.normal)
        looked = (table.speed, normal, table.pen_width, table.planes, table.ramp, table.corner)
        return Evaluation(analyse(Cycles(cycles, path, *looked)), _poses(run, tool))
    except (ValueError, ArithmeticError) as error:
        raise NoNumber(f"no ISO 9283 figures: {error}") from None


def position(resolver: Resolver, name: str, values: NDArray[Any]) -> NDArray[np.float64]:
    """The first three elements of a recorded position (n, 3) [mm]."""
    unit = units.parse(resolver.end(name, TABLE, "position").port.unit or "1")
    return np.asarray(values[:, :3] * (unit.factor / units.parse("mm").factor))


def _spans(run: RunRecord) -> list[tuple[int, int]]:
    """First sample of each cycle and the one after its last."""
    table = run.resolver.document.body.iso9283
    assert table is not None
    if table.cycles is not None:
        return [
            (int(np.searchsorted(run.time, a - 1e-12)), int(np.searchsorted(run.time, b + 1e-12)))
            for a, b in table.cycles
        ]
    assert table.during is not None and table.between is not None
    values = np.asarray(run[table.during], dtype=float)
    inside = (values >= table.between[0]) & (values <= table.between[1])
    edges = np.flatnonzero(np.diff(np.r_[False, inside, False]))
    return [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]


def _recorded_path(run: RunRecord, part: slice) -> CommandPath:
    """The command of the first cycle as a polyline that is off by less than 0.1 um."""
    table = run.resolver.document.body.iso9283
    assert table is not None and table.command is not None
    points = position(run.resolver, table.command, run[table.command])[part]
    turn = None if table.command_quaternion is None else run[table.command_quaternion][part]
    kept = simplified(points if turn is None else np.hstack([points, TURN_SCALE * turn]))
    return CommandPath.of(points[kept], None if turn is None else turn[kept])


def _poses(run: RunRecord, tool: NDArray[np.float64]) -> Any:
    table = run.resolver.document.body.iso9283
    assert table is not None
    if not table.poses:
        return ()
    times = np.array(table.reached)
    if times.max() > run.time[-1]:
        raise ValueError(f"the run ends before {times.max():g} s, at which a pose is to be reached")
    return pose_performance(tool[np.searchsorted(run.time, times - 1e-12)], np.array(table.poses))
