"""Runs the library of an FMU for any platform by itself (fmu_bits.c), under wine or qemu."""

import functools
import math
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from importlib import util
from pathlib import Path

import fmpy
from fmpy.model_description import ModelVariable
from starting import start

from motionfmu.base.platforms import Platform, here

SOURCE = Path(__file__).with_name("fmu_bits.c")
HEADERS = Path(fmpy.__file__).parent / "c-code"
# What starts a program of another platform here; the libraries of Debian's libc6-arm64-cross.
RUNNERS = {
    "x86_64-windows": ("wine",),
    "aarch64-linux": ("qemu-aarch64", "-L", "/usr/aarch64-linux-gnu"),
}
PACKAGES = {"wine": "wine wine64", "qemu-aarch64": "qemu-user libc6-arm64-cross"}
_FOLDERS: list["tempfile.TemporaryDirectory[str]"] = []


@dataclass(frozen=True)
class Job:
    """What is run: `steps` communication steps of `size` [s] after some start values."""

    steps: int
    size: float
    strings: Mapping[str, str] = field(default_factory=dict)
    reals: Mapping[str, Sequence[float]] = field(default_factory=dict)  # elements in FMI 3
    whole: Mapping[str, int] = field(default_factory=dict)  # Int32 and Boolean
    values: bool = False  # print them, too
    shown: Collection[str] = ()  # outputs; all if none are named


def missing(platform: Platform) -> str:
    """Why a platform's libraries cannot be run here; empty if they can."""
    if platform == here():
        return ""
    if platform.name not in RUNNERS:
        return f"nothing here runs {platform.name}"
    if not util.find_spec("ziglang"):
        return "there is no zig: make export installs it"
    program = RUNNERS[platform.name][0]
    return "" if shutil.which(program) else f"apt-get install {PACKAGES[program]}"


@functools.cache
def program(platform: Platform, source: Path = SOURCE) -> Path:
    """fmu_bits, or another driver, for a platform."""
    _FOLDERS.append(tempfile.TemporaryDirectory(prefix="motionfmu-"))
    target = Path(_FOLDERS[-1].name) / ("fmu_bits.exe" if platform.system == "windows" else "bits")
    zig = (sys.executable, "-m", "ziglang", "cc", "-target", platform.target)
    compiler = ("cc",) if platform == here() else zig
    options = ["-std=c11", "-D_DEFAULT_SOURCE", "-O1", "-Wall", "-Wextra", "-Werror"]
    libraries = [] if platform.system == "windows" else ["-ldl"]
    whole = [*compiler, *options, f"-I{HEADERS}", str(source), "-o", str(target), *libraries]
    subprocess.run(whole, check=True, capture_output=True)
    return target


def hashes(fmu: Path, platform: Platform, job: Job, folder: Path) -> list[str]:
    """A line for each communication point: its number and a hash of all outputs.

    Files that the job names stand in `folder`, where the run leaves what it writes. An error of the
    library is a CalledProcessError, whose stderr has its message.
    """
    place = folder / f".{fmu.name}.{platform.name}"
    with zipfile.ZipFile(fmu) as archive:
        archive.extractall(place)
    rows, fmi, identifier = job_rows(place, job)
    library = next((place / "binaries" / platform.folder(fmi)).glob(f"{identifier}.*"))
    (place / "job.txt").write_text(rows, encoding="utf-8")
    names = [str(f.relative_to(folder)) for f in (library, place / "job.txt")]
    return ran(program(platform), platform, [names[0], str(fmi), names[1]], folder)


def ran(made: Path, platform: Platform, arguments: Sequence[str], folder: Path) -> list[str]:
    """The lines that a program for a platform prints."""
    runner = () if platform == here() else RUNNERS[platform.name]
    whole = [*runner, str(made), *arguments]
    done = start(whole, folder)
    if done.returncode:
        told = done.stderr.decode(errors="replace")
        error = subprocess.CalledProcessError(done.returncode, whole, done.stdout, told)
        error.add_note(told)  # a test that fails shows it
        raise error
    return done.stdout.decode().splitlines()


def hash_of(data: bytes) -> str:
    """FNV-1a, as the programs print it."""
    found = 0xCBF29CE484222325
    for byte in data:
        found = (found ^ byte) * 0x100000001B3 % 2**64
    return f"{found:016x}"


def job_rows(place: Path, job: Job) -> tuple[str, int, str]:
    """The job file, the version of FMI and the model's identifier."""
    d = fmpy.read_model_description(str(place), validate=False)
    fmi = int(d.fmiVersion[0])
    resources = (place / "resources").as_uri() if fmi == 2 else f"{place / 'resources'}/"
    rows = [f"token {d.guid}", f"resources {resources}"]
    rows += ["values"] if job.values else []
    variables = {v.name: v for v in d.modelVariables}
    rows.append(f"steps {job.steps} {job.size!r}")
    rows += [f"string {variables[n].valueReference} {text}" for n, text in job.strings.items()]
    for name, x in job.reals.items():
        rows.append(f"real {variables[name].valueReference} {' '.join(map(repr, x))}")
    for name, n in job.whole.items():
        kind = {"i": "int", "b": "bool"}[_kind(variables[name].type)]
        rows.append(f"{kind} {variables[name].valueReference} {n}")
    for v in d.modelVariables:
        kind = _kind(v.type)
        if v.causality == "output" and kind and (not job.shown or v.name in job.shown):
            rows.append(f"show {kind} {v.valueReference} {elements(v)}")
    return "\n".join(rows) + "\n", fmi, str(d.coSimulation.modelIdentifier)


def elements(v: ModelVariable) -> int:
    """Number of elements of a variable."""
    return math.prod(int(size.start) for size in v.dimensions or [])


def _kind(name: str) -> str:
    kinds = {"Real": "d", "Float64": "d", "Integer": "i", "Int32": "i", "Enumeration": "i"}
    return kinds.get(name, "b" if name == "Boolean" else "")


def different(one: Sequence[str], other: Sequence[str]) -> str:
    """The first communication point at which two runs differ; empty if they do not."""
    pairs = zip(one, other, strict=False)
    first = next((a.split()[0] for a, b in pairs if a != b), "")
    return first or ("" if len(one) == len(other) else f"{len(one)} and {len(other)} lines")
