"""Importers of other people run FMUs; what they read is compared bit for bit. See README.md."""

import fnmatch
import json
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path

import numpy as np
from fmpy import read_model_description

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
BUILT = ROOT / "build" / "importers"
EQUAL, PASSED = "equal bits", "no complaint"
STEPS = 200
_TIME_MAX = 600  # [s] for all jobs of a tool together
_NO_NUMBER = ("String", "Binary", "Clock")


@dataclass(frozen=True)
class Tool:
    """A folder here: what the tool is, how it is installed and run."""

    folder: str
    name: str
    version: str
    fmi: list[int]  # versions it can
    run: list[str]
    install: list[list[str]] = field(default_factory=list)
    needs: list[str] = field(default_factory=list)  # programs that must be there
    platform: str = "x86_64-linux"  # of the FMUs' libraries
    checks: bool = False  # it looks at archives and runs nothing
    known: list[str] = field(default_factory=list)  # its own faults: verdicts, or patterns
    quick: bool = True  # it is in make test, where it is installed

    def knows(self, verdict: str) -> bool:
        """Whether a verdict is a fault of its own."""
        return any(fnmatch.fnmatchcase(verdict, pattern) for pattern in self.known)

    def _words(self, command: Sequence[str]) -> list[str]:
        places = {
            "here": HERE / self.folder,
            "build": BUILT / self.folder,
            "python": sys.executable,
            "root": ROOT,
        }
        return [word.format(**places) for word in command]

    def missing(self) -> str:
        """The first program that it needs and that is not there; empty if all are."""
        return next((n for n in self.needs if shutil.which(n) is None), "")

    def installed(self) -> bool:
        """Whether `make importers` has installed this version of it."""
        mark = BUILT / self.folder / "installed"
        return mark.is_file() and mark.read_text() == self._made_of()

    def _made_of(self) -> str:
        return "".join(
            f.read_text(errors="replace")
            for f in sorted((HERE / self.folder).iterdir())
            if f.is_file()
        )

    def set_up(self) -> None:
        """Install it."""
        folder = BUILT / self.folder
        folder.mkdir(parents=True, exist_ok=True)
        for command in self.install:
            subprocess.run(self._words(command), check=True, cwd=folder)
        (folder / "installed").write_text(self._made_of())

    def told(self, jobs: Sequence["Job"]) -> dict[Path, str]:
        """Run jobs: for each "ok" or why not; a job that ends the process has the next ones run."""
        found: dict[Path, str] = {}
        waiting = [j.file for j in jobs]
        while waiting:
            with tempfile.TemporaryDirectory(prefix="importers-") as place:
                ran = subprocess.run(
                    [*self._words(self.run), *map(str, waiting)],
                    capture_output=True,
                    text=True,
                    errors="replace",
                    cwd=place,
                    timeout=_TIME_MAX,
                    env=os.environ | {"PYTHONPATH": str(HERE)},
                )
            for line in ran.stdout.splitlines():
                name, tab, text = line.partition("\t")
                if tab and Path(name) in waiting:
                    found[Path(name)] = text.strip()
            left = [f for f in waiting if f not in found]
            if left:
                last = (ran.stderr.strip().splitlines() or ["no message"])[-1][:200]
                found[left[0]] = f"the process ended with status {ran.returncode}: {last}"
            waiting = left[1:]
        return found


def tools() -> list[Tool]:
    """Every tool that has a folder, by name."""
    found = []
    for file in sorted(HERE.glob("*/tool.toml")):
        found.append(Tool(folder=file.parent.name, **tomllib.loads(file.read_text())))
    return found


def tool(folder: str) -> Tool:
    """The tool of a folder."""
    return next(t for t in tools() if t.folder == folder)


@dataclass(frozen=True)
class Job:
    """One FMU to be run with its start values, and where the rows go."""

    file: Path
    fmu: Path
    fmi: int
    out: Path
    names: list[str]  # of the elements of a row
    steps: int

    def rows(self) -> np.ndarray:
        """What a tool has read, a row each communication point from the start."""
        return np.fromfile(self.out).reshape(self.steps + 1, len(self.names))


def job(fmu: Path, folder: Path, steps: int = STEPS) -> Job:
    """A job for an FMU: all its outputs that are numbers, after each of so many steps.

    The files of a job are in the folder. FMI 2 names types Real, Integer, Boolean; FMI 3 those of
    the functions that get them.
    """
    model = read_model_description(str(fmu), validate=False)
    fmi = int(model.fmiVersion[0])
    name = fmu.name.removesuffix(".fmu")
    out = folder / f"{name}.bin"
    size = model.defaultExperiment.stepSize
    lines = [f"fmu\t{fmu}", f"fmi\t{fmi}", f"step\t{float(size)!r}", f"steps\t{steps}"]
    names: list[str] = []
    for v in model.modelVariables:
        if v.causality != "output" or v.type in _NO_NUMBER:
            continue
        count = int(np.prod([d.start for d in v.dimensions], dtype=int)) if fmi == 3 else 1
        kind = {"Enumeration": "Integer" if fmi == 2 else "Int64"}.get(v.type, v.type)
        lines.append(f"value\t{kind}\t{v.valueReference}\t{count}\t{v.name}")
        names += (
            [f"{v.name}[{i + 1}]" for i in range(count)] if fmi == 3 and count > 1 else [v.name]
        )
    lines.append(f"out\t{out}")
    file = folder / f"{name}.job"
    file.write_text("\n".join(lines) + "\n")
    return Job(file, fmu, fmi, out, names, steps)


@dataclass(frozen=True)
class Verdict:
    """One cell of the matrix, one line of results.jsonl."""

    fmu: str
    fmi: int
    tool: str
    version: str  # of the tool
    platform: str
    verdict: str  # EQUAL, PASSED, a figure or a reason
    folder: str  # of the tool

    @property
    def good(self) -> bool:
        """Whether there is nothing to tell."""
        return self.verdict in (EQUAL, PASSED)

    def line(self) -> str:
        """As JSON."""
        return json.dumps(asdict(self), ensure_ascii=False)


def compared(rows: np.ndarray, expected: np.ndarray, names: Sequence[str]) -> str:
    """EQUAL, or where rows differ most; a first row without numbers was not to be had."""
    if rows.shape != expected.shape:
        return f"{rows.shape} values for {expected.shape}"
    begin = 1 if len(rows) > 1 and np.isnan(rows[0]).all() else 0
    a, b = rows[begin:].view(np.uint64), expected[begin:].view(np.uint64)
    if np.array_equal(a, b):
        return EQUAL
    columns = np.flatnonzero((a != b).any(axis=0))
    k = int(np.flatnonzero((a != b).any(axis=1))[0])
    gap = np.nanmax(np.abs(rows[begin:, columns] - expected[begin:, columns]))
    some = ", ".join(names[i] for i in columns[:3])
    return f"{len(columns)} outputs differ by up to {gap:.3g} from row {k + begin} on: {some}"


def verdicts(
    tool: Tool, fmus: Sequence[Path], expected: dict[Path, np.ndarray]
) -> Iterator[Verdict]:
    """Run FMUs, whose rows are expected to be these, in a tool."""
    with tempfile.TemporaryDirectory(prefix="importers-") as name:
        can = [f for f in fmus if version(f) in tool.fmi]
        jobs = [job(f, Path(name), len(expected[f]) - 1) for f in can]
        told = tool.told(jobs)
        for one in jobs:
            text = told[one.file]
            if text == "ok":
                text = PASSED if tool.checks else compared(one.rows(), expected[one.fmu], one.names)
            title = one.fmu.name.removesuffix(".fmu").removesuffix(f".fmi{one.fmi}")
            yield Verdict(title, one.fmi, tool.name, tool.version, tool.platform, text, tool.folder)


def version(fmu: Path) -> int:
    """FMI version of an archive, as its name says."""
    return 2 if ".fmi2." in fmu.name else 3


def reference(fmus: Sequence[Path], steps: int = STEPS) -> dict[Path, np.ndarray]:
    """Rows of FMUs as FMPy reads them."""
    fmpy = tool("fmpy")
    with tempfile.TemporaryDirectory(prefix="importers-") as name:
        jobs = [job(f, Path(name), steps) for f in fmus]
        told = fmpy.told(jobs)
        for one in jobs:
            if told[one.file] != "ok":
                raise AssertionError(f"FMPy, {one.fmu.name}: {told[one.file]}")
        return {one.fmu: one.rows() for one in jobs}
