"""FMUs reduced to what a run needs: most of an FMU's files are its C sources."""

import _ctypes
import ctypes
import functools
import re
import shutil
import tempfile
import zipfile
from pathlib import Path
from xml.etree import ElementTree

from motionfmu.base.compiler import compiler
from motionfmu.base.errors import InputError
from motionfmu.fused import layer
from motionfmu.run.engines.fmu_messages import ERROR
from motionfmu.scenarios import fmus

_FUNCTION = re.compile(r"^#define (fmi[23]\w+) +fmi[23]FullName", re.MULTILINE)
# Functions that an FMU of FMI 2 for co-simulation does not have.
_OTHERS = re.compile(r"for FMI2 for Model Exchange.*?for FMI2 for Co-Simulation", re.DOTALL)
DESCRIPTION = "modelDescription.xml"
_UNUSED = ("sources/", "documentation/", "extra/", "terminalsAndIcons/", "model.png")


def unpacked(name: str, fmi: int) -> Path:
    """The folder of an unpacked FMU, which all runs of this process share."""
    return _made(*_state(name, fmi))[0]


def packed(name: str, fmi: int) -> Path:
    """An uncompressed archive of the reduced FMU."""
    return _made(*_state(name, fmi))[1]


def _state(name: str, fmi: int) -> tuple[Path, str, int, int, int]:
    path = fmus.runnable(name, fmi)
    stat = path.stat()
    foreign = fmus.library(name) if fmus.is_foreign(name) else ""
    return path, foreign, fmus.version(name, fmi), stat.st_mtime_ns, stat.st_size


_held: list["tempfile.TemporaryDirectory[str]"] = []


@functools.cache
def _made(source: Path, foreign: str, fmi: int, *state: int) -> tuple[Path, Path]:
    _held.append(tempfile.TemporaryDirectory(prefix="motionfmu-"))
    folder, target = Path(_held[-1].name) / "fmu", Path(_held[-1].name) / source.name
    with zipfile.ZipFile(source) as whole:
        whole.extractall(folder, [n for n in whole.namelist() if not n.startswith(_UNUSED)])
    if foreign:
        _simplify(folder / DESCRIPTION)
        _complete(source, folder / foreign, fmi)
    with zipfile.ZipFile(target, "w") as part:
        for file in sorted(f for f in folder.rglob("*") if f.is_file()):
            part.write(file, file.relative_to(folder))
    return folder, target


def _simplify(description: Path) -> None:
    """Take out of a description what the container would use though no run has it, or refuses.

    It would enter event mode if an FMU has one. Arrays get the sizes that structural parameters
    give.
    """
    tree = ElementTree.parse(description)
    starts = {
        v.get("valueReference"): v.get("start", "") for v in tree.iterfind("ModelVariables/*")
    }
    sizes = [d for d in tree.iter("Dimension") if "valueReference" in d.attrib]
    for size in sizes:
        size.set("start", starts[size.attrib.pop("valueReference")])
    modes = [e for e in tree.iterfind("CoSimulation") if e.attrib.pop("hasEventMode", "")]
    if sizes or modes:
        tree.write(description, encoding="UTF-8", xml_declaration=True)


def _complete(source: Path, library: Path, fmi: int) -> None:
    """Put a library with all functions in the place of one that lacks some, for masters want all.

    The new library calls the old one; functions that the old one lacks return an error.
    """
    loaded = ctypes.CDLL(str(library))
    header = (layer.folders()[-1] / f"fmi{fmi}Functions.h").read_text(encoding="utf-8")
    wanted = sorted(set(_FUNCTION.findall(_OTHERS.sub("", header))))
    lacking = [n for n in wanted if not hasattr(loaded, n)]
    _ctypes.dlclose(loaded._handle)
    if not lacking:
        return
    cc = compiler()
    if cc is None:
        text = f"its library has no {lacking[0]}, and there is no C compiler that adds it"
        raise InputError(f"{source}: {text}")
    inner = library.parent / "inner"
    shutil.copytree(library.parent, inner)
    library.unlink()
    code = library.parent / "lacking.c"
    code.write_text("".join(f"int {n}(void) {{ return {ERROR}; }}\n" for n in lacking))
    flags = ["-shared", "-fPIC", "-Wl,--no-as-needed", "-Wl,-rpath,$ORIGIN/inner", "-Linner"]
    cc.run([*flags, code.name, f"-l:{library.name}", "-o", library.name], library.parent)
    code.unlink()
