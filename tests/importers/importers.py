"""Importers of other people run FMUs; what they read is compared bit for bit. See README.md."""

import fnmatch
import io
import json
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
import zipfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from fmpy import read_model_description

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
BUILT = ROOT / "build" / "importers"
EQUAL, PASSED, READ, NOT_RUN = "equal bits", "no complaint", "read", "not run"
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
    passed: str = PASSED  # what it says of a good one then
    ssp: bool = False  # it runs an SSP of FMI 2, too
    known: dict[str, str] = field(default_factory=dict)  # its own faults: verdict or pattern, why
    quick: bool = True  # it is in make test-more, where it is installed

    def why(self, verdict: str) -> str:
        """What is known of a verdict that is a fault of its own; empty if it is none."""
        found = (why for k, why in self.known.items() if fnmatch.fnmatchcase(verdict, k))
        return next(found, "")

    def can(self, case: "Case") -> bool:
        """Whether a case is one for it."""
        if case.file.suffix == ".ssp":
            return self.ssp
        return case.fmi in self.fmi and (case.size is None or not self.checks)

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
        """Run jobs: for each "ok", and a remark, or why not.

        A job that ends the process has the next ones run.
        """
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
class Case:
    """What all tools run: a row of the page."""

    title: str
    fmi: int
    file: Path  # an FMU, or an SSP of FMI 2
    size: float | None = None  # communication step [s]; that of the default experiment
    # Of the values that are asked for: of an SSP component.variable; of an FMU all if none.
    names: tuple[str, ...] = ()


@dataclass(frozen=True)
class Job:
    """One case to be run with its start values, and where the rows go."""

    file: Path
    case: Case
    out: Path
    names: list[str]  # of the elements of a row
    steps: int
    every: int = 1  # steps from row to row

    def rows(self) -> np.ndarray:
        """What a tool has read, a row each communication point from the start."""
        return np.fromfile(self.out).reshape(self.steps // self.every + 1, len(self.names))


def _value(v: Any, name: str, fmi: int) -> tuple[str, list[str]]:
    """A line for a variable that is read, and the names of its elements.

    FMI 2 names types Real, Integer, Boolean; FMI 3 those of the functions that get them.
    """
    count = int(np.prod([d.start for d in v.dimensions], dtype=int)) if fmi == 3 else 1
    kind = {"Enumeration": "Integer" if fmi == 2 else "Int64"}.get(v.type, v.type)
    elements = [f"{name}[{i + 1}]" for i in range(count)] if count > 1 else [name]
    return f"value\t{kind}\t{v.valueReference}\t{count}\t{name}", elements


def _inside(ssp: Path, component: str) -> Any:
    """Description of a component's FMU."""
    with zipfile.ZipFile(ssp) as archive:
        return read_model_description(
            io.BytesIO(archive.read(f"resources/{component}.fmu")), validate=False
        )


def job(case: Case, folder: Path, steps: int = STEPS, every: int = 1) -> Job:
    """A job for a case: all outputs of an FMU that are numbers, or what is named.

    The files of a job are in the folder. A row each so many steps is for drivers in Python.
    """
    found: list[tuple[str, list[str]]] = []
    if case.file.suffix == ".ssp":
        parts = {name.partition(".")[0] for name in case.names}
        models = {part: _inside(case.file, part) for part in parts}
        by = {f"{p}.{v.name}": v for p, m in models.items() for v in m.modelVariables}
        found = [_value(by[name], name, case.fmi) for name in case.names]
        size = case.size
    else:
        model = read_model_description(str(case.file), validate=False)
        size = case.size or float(model.defaultExperiment.stepSize)
        found = [
            _value(v, v.name, case.fmi)
            for v in model.modelVariables
            if v.causality == "output" and v.type not in _NO_NUMBER
            if not case.names or v.name in case.names
        ]
    stem = f"{case.title}.fmi{case.fmi}".replace(" ", "_").replace("/", "_")
    out = folder / f"{stem}.bin"
    head = [f"fmu\t{case.file}", f"fmi\t{case.fmi}", f"step\t{size!r}", f"steps\t{steps}"]
    if every > 1:
        head.append(f"every\t{every}")
    file = folder / f"{stem}.job"
    file.write_text("\n".join([*head, *(line for line, _ in found), f"out\t{out}"]) + "\n")
    return Job(file, case, out, [name for _, names in found for name in names], steps, every)


@dataclass(frozen=True)
class Verdict:
    """One cell of the matrix."""

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
        return self.verdict in (EQUAL, PASSED, READ)

    def line(self) -> str:
        """As JSON."""
        return json.dumps(asdict(self), ensure_ascii=False)


def compared(rows: np.ndarray, expected: np.ndarray, names: Sequence[str], remark: str = "") -> str:
    """EQUAL, or where rows differ most; a first row without numbers was not to be had.

    Behind a remark columns without numbers were not, either.
    """
    if rows.shape != expected.shape:
        return f"{rows.shape} values for {expected.shape}"
    begin = 1 if len(rows) > 1 and np.isnan(rows[0]).all() else 0
    blank = np.isnan(rows).all(axis=0)
    if remark and blank.any() and not blank.all():
        rows, expected = (np.ascontiguousarray(x[:, ~blank]) for x in (rows, expected))
        names = [name for name, left in zip(names, blank, strict=True) if not left]
    a, b = rows[begin:].view(np.uint64), expected[begin:].view(np.uint64)
    if np.array_equal(a, b):
        return f"{EQUAL} {remark}".strip()
    columns = np.flatnonzero((a != b).any(axis=0))
    k = int(np.flatnonzero((a != b).any(axis=1))[0])
    gap = np.abs(rows[begin:, columns] - expected[begin:, columns])
    gap = np.inf if np.isnan(gap).any() else gap.max()
    some = ", ".join(names[i] for i in columns[:3])
    return f"{len(columns)} outputs differ by up to {gap:.3g} from row {k + begin} on: {some}"


def column(ran: Any, name: str) -> np.ndarray:
    """An element, named as in a job, of a signal of our own run."""
    whole, _, rest = name.partition("[")
    element = int(rest.removesuffix("]")) - 1 if rest else 0
    values = np.asarray(ran[whole], dtype=float)
    return values.reshape(len(values), -1)[:, element]


def verdicts(tool: Tool, expected: Mapping[Case, np.ndarray]) -> Iterator[Verdict]:
    """Run the cases that are for a tool; rows are expected to be these."""
    with tempfile.TemporaryDirectory(prefix="importers-") as name:
        jobs = [job(c, Path(name), len(x) - 1) for c, x in expected.items() if tool.can(c)]
        told = tool.told(jobs)
        for one in jobs:
            text, _, remark = told[one.file].partition("\t")
            if text == "ok":
                rows = expected[one.case]
                text = tool.passed
                if not tool.checks:
                    text = compared(one.rows(), rows, one.names, remark)
            case = one.case
            yield Verdict(
                case.title, case.fmi, tool.name, tool.version, tool.platform, text, tool.folder
            )


def fmus(folder: Path) -> list[Case]:
    """The FMUs of a folder."""
    found = []
    for fmi in (2, 3):
        found += [
            Case(file.name.removesuffix(f".fmi{fmi}.fmu"), fmi, file)
            for file in sorted(folder.glob(f"*.fmi{fmi}.fmu"))
        ]
    return found


def reference(cases: Sequence[Case], steps: int = STEPS) -> list[np.ndarray]:
    """Rows of FMUs as FMPy reads them."""
    fmpy = tool("fmpy")
    with tempfile.TemporaryDirectory(prefix="importers-") as name:
        jobs = [job(case, Path(name), steps) for case in cases]
        told = fmpy.told(jobs)
        for one in jobs:
            if told[one.file] != "ok":
                raise AssertionError(f"FMPy, {one.case}: {told[one.file]}")
        return [one.rows() for one in jobs]
