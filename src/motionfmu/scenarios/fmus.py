"""Where the FMUs are and what they declare."""

import _ctypes
import contextlib
import ctypes
import functools
import math
import os
import tempfile
import zipfile
import zlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import IO, Any
from xml.etree import ElementTree

from motionfmu.base import disk_cache
from motionfmu.base.errors import InputError, suggestion
from motionfmu.base.platforms import here
from motionfmu.base.toml_lines import is_file
from motionfmu.fmu import terminals
from motionfmu.fmu.archive_names import EXTRA
from motionfmu.fmu.describe import Terminal
from motionfmu.scenarios import foreign
from motionfmu.scenarios.foreign import is_foreign
from motionfmu.scenarios.port import Port

_TYPES = "TypeDefinitions/*"
HEAD = 2000  # [bytes] of a description, in which its root stands
PACKAGE = Path(__file__).resolve().parents[1]


def folder() -> Path:
    """Folder of the built FMUs: ``$MOTIONFMU_FMUS``, the installed package's or ``build/fmus``."""
    if named := os.environ.get("MOTIONFMU_FMUS"):
        return Path(named)
    installed = PACKAGE / "fmus"
    return installed if installed.is_dir() else PACKAGE.parent.parent / "build" / "fmus"


def terminals_of(name: str) -> list[Terminal]:
    """The terminals of a built FMU: which of its variables are connected together."""
    with opened(name) as archive:
        there = terminals.XML in archive.namelist()
        return terminals.of(archive.read(terminals.XML)) if there else []


def icon_of(name: str) -> str:
    """The drawing of a built FMU; empty if it has none."""
    file = f"{terminals.ICON}.svg"
    with opened(name) as archive:
        return archive.read(file).decode() if file in archive.namelist() else ""


def fmu_names() -> list[str]:
    """Names of the FMUs that are built, sorted: the folder names under fmus/."""
    return sorted(p.name.removesuffix(".fmi3.fmu") for p in folder().glob("*.fmi3.fmu"))


def fmu_path(name: str, fmi: int = 3) -> Path:
    """Find a built FMU by its folder's name under fmus/, or a foreign one by its path.

    A foreign FMU has one version of FMI only. The message about an unknown name lists our FMUs.
    """
    if is_foreign(name):
        foreign.read(name)
        return Path(name)
    path = folder() / f"{name}.fmi{fmi}.fmu"
    if "/" in name or not is_file(path):
        names = fmu_names()
        known = ", ".join(names) or "none is built; run make build"
        text = f"no FMU {name!r} for FMI {fmi} in {folder()} (there are: {known})"
        raise InputError(text + suggestion(name, names))
    return path


def is_ours(name: str) -> bool:
    """Whether this package made an FMU: it has a name of ours, or is a file of FMI 3 like ours."""
    return not is_foreign(name) or foreign.read(name).ours


def version(name: str, fmi: int) -> int:
    """The FMI version in which an FMU runs; a foreign FMU has one version only."""
    return foreign.read(name).fmi if is_foreign(name) else fmi


@contextlib.contextmanager
def opened(name: str) -> Iterator[zipfile.ZipFile]:
    """The open archive of a built FMU of FMI 3; an InputError if it cannot be read."""
    path = fmu_path(name)
    try:
        with zipfile.ZipFile(path) as archive:
            yield archive
    except (OSError, zipfile.BadZipFile) as error:
        raise InputError(f"{path}: not a whole archive ({error})") from None


def extra(name: str, file: str) -> str | None:
    """Text of a file of ours beside an FMU's description; None if it carries none."""
    with opened(name) as archive:
        path = f"{EXTRA}/{file}"
        return archive.read(path).decode() if path in archive.namelist() else None


def digest(name: str) -> str:
    """A hash of all files in the archive of a built FMU, from the archive's own check sums."""
    return _digest(name, state(name))


FileState = tuple[str, int, int]


def state(name: str) -> FileState:
    """What tells that the file of a built FMU is another one: path, time of change, size."""
    path = fmu_path(name)
    stat = path.stat()
    return str(path), stat.st_mtime_ns, stat.st_size


@functools.cache
def _digest(name: str, state: FileState) -> str:
    with opened(name) as archive:
        rows = [f"{i.filename} {i.CRC:08x} {i.file_size}" for i in archive.infolist()]
    return disk_cache.key(*rows)


def runnable(name: str, fmi: int) -> Path:
    """Find a built FMU whose library loads on this machine; else an InputError with file and cause.

    A master that cannot load a library says nothing of the cause, or ends the process.
    """
    path = fmu_path(name, fmi)
    try:
        stat = path.stat()
        library = foreign.read(name).identifier if is_foreign(name) else ""
        if told := _refused(path, version(name, fmi), library, (stat.st_mtime_ns, stat.st_size)):
            raise InputError(f"{path}: {told}")
    except OSError as error:
        raise InputError(f"{path}: {error.strerror or error}") from None
    return path


@functools.cache
def _refused(path: Path, fmi: int, identifier: str, state: tuple[int, int]) -> str:
    """Why an FMU's library does not load; empty if it does. `state` is that of the FMU's file.

    The library is called `identifier`; if that is empty, it is the only file of its folder.
    """
    with tempfile.TemporaryDirectory(prefix="motionfmu-") as place:
        try:
            with zipfile.ZipFile(path) as archive:
                there = [
                    n for n in archive.namelist() if n.startswith("binaries/") and n[-1] != "/"
                ]
                name, told = _library(there, here().folder(fmi), identifier)
                if told:
                    return told
                folder = name.rpartition("/")[0] + "/"
                archive.extractall(place, [n for n in there if n.startswith(folder)])
        except (zipfile.BadZipFile, zlib.error) as error:
            return f"not a whole archive ({error})"
        library = Path(place) / name
        try:
            loaded = ctypes.CDLL(str(library))
        except OSError as error:
            return f"{name} does not load: {str(error).removeprefix(f'{library}: ')}"
    wanted = "fmi2Instantiate" if fmi == 2 else "fmi3InstantiateCoSimulation"
    has = hasattr(loaded, wanted)
    _ctypes.dlclose(loaded._handle)
    return "" if has else f"{name} does not load: it has no {wanted}"


def library(name: str) -> str:
    """The path of a foreign FMU's library in its archive."""
    found = foreign.read(name)
    with zipfile.ZipFile(name) as archive:
        return _library(archive.namelist(), here().folder(found.fmi), found.identifier)[0]


def _library(there: list[str], folder: str, identifier: str) -> tuple[str, str]:
    """The library among the files under binaries/, or why there is none."""
    inside = [n for n in there if n.startswith(f"binaries/{folder}/")]
    if not inside:
        others = sorted({n.split("/")[1] for n in there if n.count("/") > 1})
        has = f"; it has {', '.join(others)}" if others else ""
        return "", f"no library for this machine (binaries/{folder}/ is empty{has})"
    found = [n for n in inside if not identifier or Path(n).stem == identifier]
    if not found:
        return "", f"no library {identifier} in binaries/{folder}/"
    return found[0], ""


@contextlib.contextmanager
def _description(name: str, fmi: int = 3) -> Iterator[IO[bytes]]:
    """The open modelDescription.xml of a built FMU; an InputError if it cannot be read."""
    path = fmu_path(name, fmi)
    try:
        with zipfile.ZipFile(path) as archive, archive.open("modelDescription.xml") as stream:
            yield stream
    except (OSError, zipfile.BadZipFile, zlib.error, SyntaxError, KeyError, ValueError) as error:
        told = error.args[0] if error.args else type(error).__name__
        raise InputError(f"{path}: no readable modelDescription.xml ({told})") from None


def description_text(name: str, fmi: int = 3) -> str:
    """The modelDescription.xml of a built FMU."""
    with _description(name, fmi) as stream:
        return stream.read().decode()


def about(name: str) -> str:
    """What an FMU is, in the words of its own description."""
    if is_foreign(name):
        return foreign.read(name).about
    with _description(name) as stream:
        parser: Any = ElementTree.XMLPullParser(("start",))
        while text := stream.read(HEAD):
            parser.feed(text)
            for _, root in parser.read_events():
                return str(root.get("description", ""))
        parser.close()
    return ""


def ports(name: str) -> Mapping[str, Port]:
    """Variables of an FMU by name, without the independent one; for our FMUs those of FMI 3."""
    return foreign.read(name).ports if is_foreign(name) else _ports(name)


@functools.cache
def _ports(name: str) -> dict[str, Port]:
    # Not FMPy's reader: to import it and to look at the schema takes longer than most commands.
    with _description(name) as stream:
        tree = ElementTree.parse(stream)
        types = {row.get("name"): row.get("description", "") for row in tree.iterfind(_TYPES)}
        found = [_port(row, types) for row in tree.iterfind("ModelVariables/*")]
    return {port.name: port for port in found if port.causality != "independent"}


def _port(row: ElementTree.Element, types: Mapping[str | None, str]) -> Port:
    name = row.get("declaredType")
    texts = [start.get("value", "") for start in row.findall("Start")]
    return Port(
        row.attrib["name"],
        row.tag,
        row.get("causality", "local"),
        row.get("variability") == "tunable",
        row.get("description", ""),
        tuple(int(size.attrib["start"]) for size in row.findall("Dimension")),
        row.get("unit"),
        int(row.attrib["valueReference"]),
        " ".join(texts) if texts else row.get("start"),
        float(row.get("min", -math.inf)),
        float(row.get("max", math.inf)),
        row.get("variability") == "continuous",
        float(row.attrib["nominal"]) if "nominal" in row.attrib else None,
        (name, types.get(name, "")) if name else None,
    )
