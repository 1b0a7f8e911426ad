"""A result as files: its numbers, what the run was made of, the error along the path."""

import hashlib
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from motionfmu.analysis.contour.scaled_values import places
from motionfmu.base.columns import LazyArray, forget
from motionfmu.base.toml_lines import is_file
from motionfmu.run import record_matches
from motionfmu.run.result import Result
from motionfmu.scenarios import fmus
from motionfmu.scenarios.system import wires

if TYPE_CHECKING:
    from motionfmu.analysis.contour import ContourResult

SIGNALS, NUMBERS, TRACK = "signals", "result.json", "contour"
DEPTH = 1  # tables in tables of result.json that have lines of their own
DIGITS = 16  # of a file's SHA-256: enough to tell two files apart


def json_of(found: Any, level: int = 0) -> str:
    """Numbers as JSON, a row of a table in a line: there may be one for each line of a program."""
    # Python's encoder that indents costs ten times as much as the one that does not.
    pad = "\n" + " " * (level + 1)
    if isinstance(found, dict) and found and level <= DEPTH:
        rows = [f"{json.dumps(key)}: {json_of(value, level + 1)}" for key, value in found.items()]
        return "{" + pad + f",{pad}".join(rows) + pad[:-1] + "}"
    if isinstance(found, list) and found and isinstance(found[0], dict):
        rows = [json.dumps(row, allow_nan=False) for row in found]
        return "[" + pad + f",{pad}".join(rows) + pad[:-1] + "]"
    return json.dumps(found, allow_nan=False)


def numbers(result: Result) -> dict[str, Any]:
    """The numbers of a result, and what the run was made of, for JSON."""
    body = result.scenario.document.body
    found: dict[str, Any] = {
        "scenario": result.name,
        "about": result.about,
        "options": dict(result.options),
        "samples": len(result.time),
        "ok": result.ok,
        "overrides": list(result.overrides),
        "stopped": result.stopped,
        "done_at": result.done_at,
        "warnings": list(result.warnings),
        "as_written": result.as_written,
        "checks": [v.numbers() for v in result.checks],
    }
    if body.contour is not None:
        found["contour"] = None if result.no_contour else result.contour().numbers()
        found["no_contour"] = result.no_contour
    if body.iso9283 is not None:
        found["iso9283"] = None if result.no_iso9283 else result.iso9283().numbers()
        found["no_iso9283"] = result.no_iso9283
    if body.record_file is not None:
        found["record"] = None if result.no_record else result.record_matches().numbers()
        found["no_record"] = result.no_record
    found["units"] = result.units
    found["figures"] = [figure.model_dump() for figure in body.figure]
    return found | {"run": _made(result)}


# CCN 19: a table of what a run depends on, a comprehension for each row.
def _made(result: Result) -> dict[str, Any]:
    """All that a run depends on, and in which two runs may differ."""
    document, library = result.scenario.document, result.scenario.library()
    options = result.options
    folder, body = document.file.parent, document.body
    own = f"{library}.path_file"
    given = {n: list(v) for n, v in sorted(result.parameters.items()) if n != own}
    named = [x for v in given.values() for x in v if isinstance(x, str) and x and is_file(Path(x))]
    record = record_matches.made_of(result.resolver)
    return ({} if record is None else {"record": record}) | {
        "components": {c: _beside(name, folder) for c, name in body.component.items()},
        "fmus": {
            _beside(name, folder): _digest(fmus.fmu_path(name))
            for name in sorted({*body.component.values()})
        },
        "wires": {w.target.name: w.source.name for w in wires(result.resolver)},
        "settings": {n: [_beside(x, folder) for x in v] for n, v in given.items()},
        "files": {_beside(x, folder): _digest(Path(x)) for x in named},
        "drives": [drive.model_dump() for drive in body.drive],
        "step": options.get("step") or body.step,
        "every": options.get("every") or body.record.every,
        "stop": options.get("stop") or body.stop,
    }


def _digest(file: Path) -> str:
    return hashlib.sha256(file.read_bytes()).hexdigest()[:DIGITS]


def _beside(value: Any, folder: Path) -> Any:
    """A value in which the path of a file beside the scenario is its name alone."""
    path = Path(value) if isinstance(value, str) and value else None
    return str(path.relative_to(folder)) if path and path.is_relative_to(folder) else value


def track(contour: "ContourResult") -> dict[str, Any]:
    """The contour error along the path, and the ways round its circles, as arrays."""
    # Time [s]; position along the path, error, nearest point and distance to it [mm], NaN where
    # nothing is cut; a row for each command; of circle i, for each direction round it, angle [rad]
    # and radial deviation [mm]. Arrays with a row for each sample are computed in parts.
    way, cut, actual = contour.track, contour.cutting, contour.run.actual
    count = len(cut)

    def error(rows: slice) -> Any:
        forget(way.distance)
        size = way.distance[rows]
        size = size if way.right is None else np.where(way.right[rows], -size, size)
        return np.where(cut[rows], size, np.nan)

    def foot(rows: slice) -> Any:
        for array in (way.segment, way.along):
            forget(array)
        return way.feet(rows)

    def gap(rows: slice) -> Any:
        forget(actual)
        return np.where(cut[rows, None], places(actual, rows) - foot(rows), np.nan)

    found: dict[str, Any] = {
        "time": contour.run.time,
        "along": way.along,
        "error": LazyArray((count,), np.dtype("f8"), error),
        "foot": LazyArray((count, 3), np.dtype("f4"), foot),
        "gap": LazyArray((count, 3), np.dtype("f4"), gap),
        "commands": contour.commands,
    }
    for test in contour.circles:
        for name, one in (("ccw", test.ccw), ("cw", test.cw)):
            if one is not None:
                x, y = one.points.T
                found[f"circles.{test.place}.{name}.angle"] = np.arctan2(y, x)
                found[f"circles.{test.place}.{name}.deviation"] = np.hypot(x, y) - test.radius
    return found
