"""A robot's program and its points while somebody edits them: read, judged, saved whole."""

import os
import re
import shutil
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.analysis.collisions import Cell
from motionfmu.analysis.dry_run import DryRun, InputChange, dry_run, program_files
from motionfmu.base.errors import InputError
from motionfmu.base.program_endings import ROBOT_JOBS
from motionfmu.report.jobs.dry_scene import dry_scene
from motionfmu.report.style import dark_colors
from motionfmu.report.view_section import view_data
from motionfmu.run import Scenario

PATIENCE = 20.0  # [s] on the wall for a program to be judged
LONGEST = 4_000_000  # characters of a text
_LINE = re.compile(r"line (\d+): ")


@dataclass(frozen=True)
class JobTexts:
    """A program and its points as they stand in their files.

    Attributes
    ----------
    job : str
    points : str
        Empty if the program has no file of points.
    """

    job: str
    points: str = ""


@dataclass(frozen=True)
class _Opened:
    """A file, its bytes as they were read or written last, and the ends of its lines."""

    file: Path
    known: bytes
    ends: str

    @classmethod
    def read(cls, file: Path) -> "_Opened":
        found = _bytes(file)
        return cls(file, found, "\r\n" if b"\r\n" in found else "\n")

    @property
    def text(self) -> str:
        try:
            return self.known.decode("utf-8").replace("\r\n", "\n")
        except UnicodeDecodeError as error:
            raise InputError(f"{self.file}: {error}") from None

    def bytes_of(self, text: str) -> bytes:
        return text.replace("\r\n", "\n").replace("\n", self.ends).encode("utf-8")


class EditedJob:
    """A program of a scenario while somebody edits it.

    Parameters
    ----------
    scenario : Scenario
        With a soft controller that has a program.
    set : mapping, optional
        Values by ``component.variable``, stronger than the scenario's.
    inputs : sequence of InputChange, optional
        Instead of what the scenario drives.
    cell : Cell, optional
        What stands around the arm.

    Raises
    ------
    InputError
        There is no program, or it cannot be read.
    """

    def __init__(
        self,
        scenario: Scenario,
        set: Mapping[str, Any] | None = None,
        inputs: Sequence[InputChange] = (),
        cell: Cell | None = None,
    ) -> None:
        self._scenario, self._set = scenario, dict(set or {})
        self._inputs, self._cell = inputs, cell
        self._component, job, points = program_files(scenario, self._set)
        self._job = _Opened.read(job)
        self._points = None if points is None else _Opened.read(points)
        self.texts  # noqa: B018  (a file that is no text is told at once)

    @property
    def files(self) -> tuple[Path, Path | None]:
        """The program, and its points."""
        return self._job.file, self._points.file if self._points else None

    @property
    def texts(self) -> JobTexts:
        """As they stand in the files, lines ended by a line feed."""
        return JobTexts(self._job.text, self._points.text if self._points else "")

    def judge(self, texts: JobTexts, going_on: Callable[[], bool] = lambda: True) -> dict[str, Any]:
        """Run texts dry that are not saved.

        Parameters
        ----------
        texts : JobTexts
        going_on : callable, optional
            Asked now and then; False ends it.

        Returns
        -------
        dict
            ``faults`` with their lines in program or points (0: of none), ``time`` [s],
            ``steps`` with line, times, joints [deg] and tool [mm] at the end, and ``view`` for the
            moving picture.

        Raises
        ------
        InputError
            A text is too long.
        """
        _check(texts)
        began = time.monotonic()

        def told(seconds: float) -> None:
            if not going_on():
                raise InputError("something newer is to be judged")
            if time.monotonic() - began > PATIENCE:
                raise InputError(
                    f"judged for {seconds:.0f} s of its time, and it is not at its end"
                )

        with tempfile.TemporaryDirectory(prefix="motionfmu-job-") as name:
            folder = Path(name)
            values = self._set | self._written(folder, texts)
            try:
                run = dry_run(self._scenario, self._inputs, values, told, self._cell)
            except InputError as error:
                return {"faults": [_fault(_short(str(error), folder))], "time": 0.0, "steps": []}
        return _judged(run, folder)

    def _written(self, folder: Path, texts: JobTexts) -> dict[str, Any]:
        """Texts in a folder with the jobs that the program may call; the values that name them."""
        file = self._job.file
        for beside in file.parent.iterdir():
            if beside.suffix.lower() in ROBOT_JOBS and beside.is_file() and beside != file:
                shutil.copyfile(beside, folder / beside.name)
        found = {f"{self._component}.program": str(folder / file.name)}
        (folder / file.name).write_bytes(self._job.bytes_of(texts.job))
        if self._points is not None:
            place = folder / f"points-{self._points.file.name}"
            place.write_bytes(self._points.bytes_of(texts.points))
            found[f"{self._component}.points"] = str(place)
        return found

    def save(self, texts: JobTexts, over: bool = False) -> None:
        """Write the files, each whole: it is the old one or the new one.

        Parameters
        ----------
        texts : JobTexts
        over : bool
            Also over a file that somebody else has changed meanwhile.

        Raises
        ------
        InputError
            A file has changed on the disk, or cannot be written; then none is.
        """
        _check(texts)
        wanted = [(self._job, texts.job)]
        wanted += [] if self._points is None else [(self._points, texts.points)]
        changed = [(f, f.bytes_of(text)) for f, text in wanted if f.bytes_of(text) != f.known]
        for opened, _ in changed:
            if not over and _bytes(opened.file) != opened.known:
                raise InputError(f"{opened.file}: it has been changed by somebody else meanwhile")
        replace_files({opened.file: data for opened, data in changed})
        self._job = _Opened.read(self._job.file)
        self._points = self._points and _Opened.read(self._points.file)


def replace_files(files: Mapping[Path, bytes]) -> None:
    """Write files that are there, all beside their places first, then each in one step."""
    parts: dict[Path, Path] = {}
    try:
        for file, data in files.items():
            place = file.resolve()
            part = place.with_name(f".{place.name}.part{os.getpid()}")
            parts[part] = place
            with part.open("wb") as stream:
                stream.write(data)
                stream.flush()
                os.fsync(stream.fileno())
            shutil.copymode(place, part)
        for part, place in parts.items():
            os.replace(part, place)
    except OSError as error:
        raise InputError(f"cannot save {error.filename}: {error.strerror or error}") from None
    finally:
        for part in parts:
            part.unlink(missing_ok=True)


def _bytes(file: Path) -> bytes:
    try:
        return file.read_bytes()
    except OSError as error:
        raise InputError(f"{file}: {error.strerror or error}") from None


def _check(texts: JobTexts) -> None:
    if max(len(texts.job), len(texts.points)) > LONGEST:
        raise InputError(f"a text of more than {LONGEST} characters")


def _short(text: str, folder: Path) -> str:
    """A message without the folder in which the texts were judged."""
    return text.replace(f"{folder}{os.sep}points-", "").replace(f"{folder}{os.sep}", "")


def _fault(text: str) -> dict[str, Any]:
    found = _LINE.search(text)
    line = int(found[1]) if found else 0
    of_points = text.startswith("points: ")
    lines = {"line": 0 if of_points else line, "points_line": line if of_points else 0}
    return lines | {"text": text}


def _judged(run: DryRun, folder: Path) -> dict[str, Any]:
    faults = [_fault(_short(text, folder)) for text in run.faults]
    found: dict[str, Any] = {"faults": faults, "time": run.time, "waits": run.waits}
    found["steps"] = []
    for move in run.moves:
        row = run.samples[
            min(int(np.searchsorted(run.samples["time"], move.end)), len(run.samples) - 1)
        ]
        found["steps"].append(
            {
                "line": move.line,
                "begin": move.begin,
                "end": move.end,
                "joint": [round(float(q), 3) for q in row["joint"]],
                "place": [round(float(x), 3) for x in row["place"]],
            }
        )
    scene = dry_scene(run)
    if scene is not None:
        fast = scene.speed if scene.rapid is None else scene.speed[~scene.rapid]
        fastest = float(np.percentile(fast, 99.5)) or 1.0
        found["view"] = view_data(scene, fastest) | {"begin": None}
        found["dark"] = dark_colors()
    return found
