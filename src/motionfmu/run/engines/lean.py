"""FMUs with only what runs: most of an FMU's files are its C sources."""

import functools
import tempfile
import zipfile
from pathlib import Path

from motionfmu.scenarios import fmus

_UNUSED = ("sources/", "documentation/", "extra/")


def unpacked(name: str, fmi: int) -> Path:
    """A folder that holds an FMU, unpacked once for all runs of this process."""
    return _made(*_state(name, fmi))[0]


def packed(name: str, fmi: int) -> Path:
    """An archive of it, not compressed."""
    return _made(*_state(name, fmi))[1]


def _state(name: str, fmi: int) -> tuple[Path, int, int]:
    path = fmus.runnable(name, fmi)
    stat = path.stat()
    return path, stat.st_mtime_ns, stat.st_size


_held: list["tempfile.TemporaryDirectory[str]"] = []


@functools.cache
def _made(source: Path, *state: int) -> tuple[Path, Path]:
    _held.append(tempfile.TemporaryDirectory(prefix="motionfmu-"))
    folder, target = Path(_held[-1].name) / "fmu", Path(_held[-1].name) / source.name
    with zipfile.ZipFile(source) as whole, zipfile.ZipFile(target, "w") as part:
        for entry in whole.namelist():
            if not entry.startswith(_UNUSED):
                part.writestr(entry, whole.read(entry))
                whole.extract(entry, folder)
    return folder, target
