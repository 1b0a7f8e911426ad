"""FMUs with only what runs: most of an FMU's files are its C sources."""

import _ctypes
import ctypes
import functools
import shutil
import tempfile
import zipfile
from pathlib import Path

from motionfmu.compiler import compiler
from motionfmu.errors import InputError
from motionfmu.run.engines.messages import ERROR
from motionfmu.scenarios import fmus

_UNUSED = ("sources/", "documentation/", "extra/", "terminalsAndIcons/", "model.png")


def unpacked(name: str, fmi: int) -> Path:
    """A folder that holds an FMU, unpacked once for all runs of this process."""
    return _made(*_state(name, fmi))[0]


def packed(name: str, fmi: int) -> Path:
    """An archive of it, not compressed."""
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
        _complete(source, folder / foreign, fmi)
    with zipfile.ZipFile(target, "w") as part:
        for file in sorted(f for f in folder.rglob("*") if f.is_file()):
            part.write(file, file.relative_to(folder))
    return folder, target


def _complete(source: Path, library: Path, fmi: int) -> None:
    """Put a library with all functions in the place of one that lacks some: masters want each.

    It depends on the one that was there; what that lacks answers with an error.
    """
    from fmpy.fmi2 import FMU2Slave
    from fmpy.fmi3 import FMU3Slave

    loaded = ctypes.CDLL(str(library))
    wanted = [n for n in dir(FMU2Slave if fmi == 2 else FMU3Slave) if n.startswith(f"fmi{fmi}")]
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
