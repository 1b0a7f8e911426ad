"""Where the FMUs are and what they declare."""

import _ctypes
import ctypes
import functools
import math
import os
import tempfile
import zipfile
import zlib
from dataclasses import dataclass
from pathlib import Path

from fmpy import read_model_description

from motionfmu.errors import InputError
from motionfmu.fmu.pack import platform_folder
from motionfmu.toml_lines import is_file

PACKAGE = Path(__file__).resolve().parents[1]


@dataclass(frozen=True)
class Port:
    """One variable of an FMU as its description declares it."""

    name: str
    type: str  # Float64, Int32, Boolean or String
    causality: str  # as FMI says
    tunable: bool  # a parameter that may change during a run
    doc: str
    shape: tuple[int, ...]  # empty for a scalar
    unit: str | None
    reference: int  # the first value reference; elements take successive ones
    start: str | None  # values as written in the description
    low: float  # limits, infinite if not declared
    high: float

    @property
    def count(self) -> int:
        """Number of elements."""
        return math.prod(self.shape)


def folder() -> Path:
    """Folder of the built FMUs: ``$MOTIONFMU_FMUS``, the installed package's or ``build/fmus``."""
    if named := os.environ.get("MOTIONFMU_FMUS"):
        return Path(named)
    installed = PACKAGE / "fmus"
    return installed if installed.is_dir() else PACKAGE.parent.parent / "build" / "fmus"


def fmu_names() -> list[str]:
    """Names of the FMUs that are built, sorted: the folder names under fmus/."""
    return sorted(p.name.removesuffix(".fmi3.fmu") for p in folder().glob("*.fmi3.fmu"))


def fmu_path(name: str, fmi: int = 3) -> Path:
    """Find a built FMU by its folder's name under fmus/; else the message lists what there is."""
    path = folder() / f"{name}.fmi{fmi}.fmu"
    if "/" in name or not is_file(path):
        known = ", ".join(fmu_names()) or "none is built; run make build"
        raise InputError(f"no FMU {name!r} for FMI {fmi} in {folder()} (there are: {known})")
    return path


def runnable(name: str, fmi: int) -> Path:
    """Find a built FMU whose library loads on this machine; else an InputError with file and cause.

    A master loads it, too, but where it cannot, it says nothing of the cause or ends the process.
    """
    path = fmu_path(name, fmi)
    try:
        stat = path.stat()
        if told := _refused(path, fmi, (stat.st_mtime_ns, stat.st_size)):
            raise InputError(f"{path}: {told}")
    except OSError as error:
        raise InputError(f"{path}: {error.strerror or error}") from None
    return path


@functools.cache
def _refused(path: Path, fmi: int, state: tuple[int, int]) -> str:
    """Why the library in this state of a file does not load; empty if it does."""
    folder = f"binaries/{platform_folder(fmi)}/"
    try:
        with zipfile.ZipFile(path) as archive:
            inside = [n for n in archive.namelist() if n.startswith(folder) and n[-1] != "/"]
            code = archive.read(inside[0]) if inside else b""
    except (zipfile.BadZipFile, zlib.error) as error:
        return f"not a whole archive ({error})"
    if not inside:
        return f"no library for this machine ({folder} is empty)"
    with tempfile.TemporaryDirectory(prefix="motionfmu-") as place:
        library = Path(place) / Path(inside[0]).name
        library.write_bytes(code)
        try:
            loaded = ctypes.CDLL(str(library))
        except OSError as error:
            return f"{inside[0]} does not load: {str(error).removeprefix(f'{library}: ')}"
    wanted = "fmi2Instantiate" if fmi == 2 else "fmi3InstantiateCoSimulation"
    there = hasattr(loaded, wanted)
    _ctypes.dlclose(loaded._handle)
    return "" if there else f"{inside[0]} does not load: it has no {wanted}"


@functools.cache
def ports(name: str) -> dict[str, Port]:
    """Variables of an FMU by name, from the FMI 3 description, without the independent variable."""
    path = fmu_path(name)
    try:
        description = read_model_description(str(path))
    except Exception as error:  # of zipfile, lxml or FMPy: the file is not one of ours
        told = str(error.args[0]) if error.args else type(error).__name__
        raise InputError(f"{path}: no readable modelDescription.xml ({told})") from None
    found = {}
    for v in description.modelVariables:
        if v.causality == "independent":
            continue
        start = " ".join(v.start) if isinstance(v.start, list) else v.start
        low, high = (
            side if limit is None else float(limit)
            for limit, side in ((v.min, -math.inf), (v.max, math.inf))
        )
        found[v.name] = Port(
            v.name,
            v.type,
            v.causality,
            v.variability == "tunable",
            v.description or "",
            tuple(int(d.start) for d in v.dimensions),
            v.unit,
            v.valueReference,
            start,
            low,
            high,
        )
    return found
