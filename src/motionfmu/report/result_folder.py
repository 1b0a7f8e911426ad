"""The folder that a run leaves on disk: its signals, its numbers and its report."""

import contextlib
import json
import os
import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.base.columns import in_blocks, write
from motionfmu.base.errors import InputError, NoNumber
from motionfmu.run.recorded_trajectory import recorded_trajectory
from motionfmu.run.result import Result
from motionfmu.run.result_files import NUMBERS, SIGNALS, TRACK, json_of, numbers, track

TABLE, TRAJECTORY, PAGE = "signals.csv", "trajectory.csv", "report.html"


def _write_csv(result: Result, file: Path) -> None:
    names, columns = ["time"], [result.time]
    for name, data in result.signals.items():
        wide = data.reshape(len(data), -1)
        for i in range(wide.shape[1]):
            names.append(f"{name}[{i + 1}]" if data.ndim == 2 else name)
            columns.append(wide[:, i])
    with file.open("w", encoding="utf-8") as table:
        table.write(",".join(names) + "\n")
        for blocks in in_blocks(*columns):
            np.savetxt(table, np.column_stack(blocks), delimiter=",", fmt="%.17g")


def near(folder: Path) -> Path:
    """The nearest folder above a result's folder that exists already."""
    return next(p for p in folder.resolve().parents if p.is_dir())


def usable(folder: Path) -> Path:
    """The absolute path of a folder in which a result may be written."""
    # It is new, empty, or holds an older result; anything else is an InputError.
    folder = folder.resolve()
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{folder} is a file, not a folder")
    if folder.exists() and not (folder / NUMBERS).is_file() and any(folder.iterdir()):
        raise InputError(f"{folder} holds no earlier result; it is left as it is")
    return folder


@dataclass(frozen=True)
class Kept:
    """The files that are kept of a result beside its report."""

    csv: bool = False
    signals: bool = True
    pictures: bool = False
    trajectory: bool = False


def all_numbers(result: Result) -> dict[str, Any]:
    """The numbers of a result as its result.json has them."""
    from motionfmu.report.run_summary import summary_of

    contour = None
    if result.scenario.document.body.contour is not None and not result.no_contour:
        contour = result.contour()
    return numbers(result) | summary_of(result, contour).numbers()


def save(
    result: Result,
    folder: Path,
    kept: Kept = Kept(),
    told: Callable[[str], None] = lambda what: None,
) -> Path:
    """Write a run's folder, whole or not at all; give the report."""
    # An older result is replaced; anything else in the folder is an InputError.
    # Each part takes long after a long run, so `told` is called before it begins.
    with whole(folder) as part:
        if kept.signals:
            told("signals")
            write(part / SIGNALS, result.signals, result.time)
        from motionfmu.report.run_page import ReportFiles, write_files
        from motionfmu.report.run_summary import summary_of

        told("analyses")
        contour = None
        if result.scenario.document.body.contour is not None:
            with contextlib.suppress(NoNumber):
                contour = result.contour(lambda share: told(f"contour {share:.0%}"))
        ran = summary_of(result, contour)
        told("verdict")
        found = numbers(result) | ran.numbers()
        (part / NUMBERS).write_text(json_of(found) + "\n", encoding="utf-8")
        if kept.csv:
            told(TABLE)
            _write_csv(result, part / TABLE)
        if kept.trajectory:
            (part / TRAJECTORY).write_text(recorded_trajectory(result), encoding="utf-8")
        if contour is not None:
            way = track(contour)
            write(part / TRACK, way, way.pop("time"))
        told("report")
        wanted = ReportFiles(kept.pictures, kept.signals)
        shown = write_files(result, contour, part, ran, wanted).name
    return folder.resolve() / shown


def write_result(
    part: Path, page: str, found: Any, default: Callable[[Any], Any] | None = None
) -> None:
    """Write a page and its numbers, all finite; `default` as of json.dumps."""
    (part / PAGE).write_text(page, encoding="utf-8")
    text = json.dumps(found, indent=1, allow_nan=False, default=default)
    (part / NUMBERS).write_text(text + "\n", encoding="utf-8")


@contextlib.contextmanager
def whole(folder: Path) -> Iterator[Path]:
    """Write a folder of results whole or not at all."""
    # Yields the folder to write into; the file `NUMBERS` must be written there.
    # An older result is replaced; anything else in the folder is an InputError.
    folder = usable(folder)
    part = folder.with_name(f".{folder.name}.part{os.getpid()}")
    old = folder.with_name(f".{folder.name}.old{os.getpid()}")
    new_parents = [p for p in part.parents if not p.exists()]
    try:
        part.mkdir(parents=True)
        yield part
        if folder.exists():
            folder.rename(old)
        part.rename(folder)
    except OSError as error:
        raise InputError(f"cannot write {folder}: {error.strerror or error}") from None
    finally:
        shutil.rmtree(part, ignore_errors=True)
        shutil.rmtree(old, ignore_errors=True)
        for parent in new_parents:
            with contextlib.suppress(OSError):
                parent.rmdir()  # refused where the result stands
