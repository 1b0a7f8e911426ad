"""Signals in NumPy's files: mapped when needed, read in blocks, deleted with their owner."""

import contextlib
import mmap
import os
import shutil
import tempfile
import weakref
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError

# Rows of a block; a block of six numbers each is 6 MB.
ROWS = 1 << 17
# Arrays of so many bytes and more are made in a file.
LARGE = 1 << 24
# The folder of each such file that is in use.
_ROOMS: "weakref.WeakKeyDictionary[mmap.mmap, Path]" = weakref.WeakKeyDictionary()
TIME, ENDING = "time", ".npy"


@dataclass(frozen=True)
class ArrayPlace:
    """Where an array stands: a file, or columns of it."""

    file: Path
    columns: slice | int | None = None  # None: the whole file
    boolean: bool = False  # the array is Boolean, though its file holds whole numbers


@dataclass(frozen=True, eq=False)
class LazyArray:
    """An array whose rows are computed when they are asked for."""

    shape: tuple[int, ...]
    dtype: np.dtype[Any]
    make: Callable[[slice], NDArray[Any]]

    def __len__(self) -> int:
        return self.shape[0]

    def __getitem__(self, rows: slice) -> NDArray[Any]:
        return self.make(rows).astype(self.dtype, copy=False)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        return np.asarray(self[:], dtype=dtype)


class Columns(Mapping[str, NDArray[Any]]):
    """Read-only arrays by name, with a row for each sample."""

    # An array is mapped as long as somebody refers to it. The folder `own` is deleted with this
    # object.

    def __init__(self, parts: Mapping[str, ArrayPlace], own: Path | None = None) -> None:
        self._parts = dict(parts)
        self._heads: dict[Path, tuple[Any, ...]] = {}
        self._mapped: weakref.WeakValueDictionary[Any, NDArray[Any]] = weakref.WeakValueDictionary()
        self._time = self._parts.pop(TIME, None)
        if own is not None:
            weakref.finalize(self, _remove, own, os.getpid())

    @classmethod
    def of(cls, folder: Path, order: Iterable[str] = (), own: bool = False) -> "Columns":
        """The arrays in all files of a folder, by name; names in `order` come first."""
        there = {f.stem: f for f in sorted(folder.iterdir()) if f.suffix == ENDING}
        first = dict.fromkeys(n for n in order if n in there)
        return cls({n: ArrayPlace(there[n]) for n in first | there}, folder if own else None)

    @classmethod
    def taken(cls, folder: Path, order: Iterable[str] = ()) -> "Columns":
        """The arrays of a folder that is moved elsewhere and deleted with this object."""
        own = Path(tempfile.mkdtemp(prefix="motionfmu-", dir=folder.parent.parent))
        folder.rename(own)
        return cls.of(own, order, own=True)

    @property
    def time(self) -> NDArray[Any] | None:
        """Times of the rows [s], if they have a file."""
        return None if self._time is None else self._array(self._time)

    def __getitem__(self, name: str) -> NDArray[Any]:
        return self._array(self._parts[name])

    def __contains__(self, name: object) -> bool:
        return name in self._parts

    def __iter__(self) -> Iterator[str]:
        return iter(self._parts)

    def __len__(self) -> int:
        return len(self._parts)

    def _array(self, part: ArrayPlace) -> NDArray[Any]:
        key = part.file, str(part.columns), part.boolean
        found = self._mapped.get(key)
        if found is None:
            whole = self._map(part.file)
            found = whole if part.columns is None else whole[:, part.columns]
            if part.boolean:
                found = found.astype(bool)
                found.flags.writeable = False
            self._mapped[key] = found
        return found

    def _map(self, file: Path) -> NDArray[Any]:
        if file not in self._heads:
            self._heads[file] = _head(file)
        kind, shape, offset = self._heads[file]
        return np.memmap(file, kind, "r", offset, shape).view(np.ndarray)

    def files(self) -> dict[str, Path] | None:
        """The file of each array and of the time; None if one has no file for itself."""
        parts = self._parts | ({} if self._time is None else {TIME: self._time})
        whole = all(p.columns is None for p in parts.values())
        return {name: p.file for name, p in parts.items()} if whole else None


def temporary(place: Path | None) -> tempfile.TemporaryDirectory[str]:
    """A folder for the files of runs, in `place` or in the system's temporary folder."""
    try:
        return tempfile.TemporaryDirectory(prefix="motionfmu-", dir=place)
    except OSError as error:
        told = error.strerror or error
        raise InputError(f"cannot write {place or tempfile.gettempdir()}: {told}") from None


def kept(folder: Path, files: Iterable[str]) -> Path:
    """Move files to a new folder beside the one they are in."""
    own = Path(tempfile.mkdtemp(prefix="motionfmu-", dir=folder.parent))
    for file in files:
        (folder / file).rename(own / file)
    return own


def _remove(folder: Path, process: int) -> None:
    """Delete a folder, unless this process was forked from the one that made it."""
    if os.getpid() == process:
        shutil.rmtree(folder, ignore_errors=True)


def _head(file: Path) -> tuple[Any, ...]:
    """Type, shape and offset of a file's data; a ValueError if the file is none of NumPy's."""
    with file.open("rb") as opened:
        version = np.lib.format.read_magic(opened)
        read = np.lib.format.read_array_header_1_0
        if version != (1, 0):
            raise ValueError(f"format version {version[0]}.{version[1]}")
        shape, fortran, kind = read(opened)
        if fortran or kind.hasobject:
            raise ValueError("not rows of numbers")
        return kind, shape, opened.tell()


def in_blocks(*arrays: NDArray[Any], back: int = 0) -> Iterator[tuple[NDArray[Any], ...]]:
    """The same rows of all arrays, block by block; a block begins with `back` rows of the last."""
    # Mapped pages of a file count as memory of the process, so pages that were read are let go.
    for first in range(0, len(arrays[0]), ROWS):
        yield tuple(x[max(0, first - back) : first + ROWS] for x in arrays)
        for x in arrays:
            forget(x)


def forget(array: Any) -> None:
    """Let go the memory pages of a mapped array; they are read again when needed."""
    base = array
    while (inner := getattr(base, "base", None)) is not None:
        base = inner
    if isinstance(base, mmap.mmap) and hasattr(base, "madvise"):
        base.madvise(mmap.MADV_DONTNEED)


def room(count: int, dtype: Any, beside: Any) -> NDArray[Any]:
    """An array (n,) to be filled; a large one that is made of a mapped file is mapped, too.

    Its file has no name and stands beside that one. Whoever passes the array in blocks lets its
    pages go by `forget`, as those of a recorded signal.
    """
    kind = np.dtype(dtype)
    size = count * kind.itemsize
    folder = _folder(beside) if size >= LARGE else None
    if folder is None:
        return np.empty(count, kind)
    try:
        with tempfile.TemporaryFile(dir=folder) as file:
            os.posix_fallocate(file.fileno(), 0, size)
            mapped = mmap.mmap(file.fileno(), size)
        _ROOMS[mapped] = folder
        return np.ndarray((count,), kind, mapped)
    except (OSError, AttributeError):  # a full disk, another system
        return np.empty(count, kind)


def _folder(array: Any) -> Path | None:
    """The folder of the file in which an array is mapped, or of which `room` made it."""
    while array is not None:
        if isinstance(array, mmap.mmap):
            return _ROOMS.get(array)
        if isinstance(array, np.memmap) and array.filename is not None:
            return Path(array.filename).parent
        array = getattr(array, "base", None)
    return None


def write(folder: Path, signals: Mapping[str, NDArray[Any]], time: NDArray[Any]) -> None:
    """Write a folder with a file for each signal, and one for the times."""
    # A signal that has a file already gets a hard link to it, which costs nothing, or else a copy.
    folder.mkdir()
    there = signals.files() if isinstance(signals, Columns) else None
    for name, file in (there or {}).items():
        target = folder / f"{name}{ENDING}"
        try:
            os.link(file, target)
        except OSError:
            shutil.copyfile(file, target)
    rest = {} if there is not None else dict(signals)
    if there is None or TIME not in there:
        rest[TIME] = time
    with contextlib.ExitStack() as stack:
        opened = {}
        for name, data in rest.items():
            opened[name] = stack.enter_context((folder / f"{name}{ENDING}").open("wb"))
            descr = np.lib.format.dtype_to_descr(data.dtype)
            head = {"descr": descr, "fortran_order": False, "shape": data.shape}
            np.lib.format.write_array_header_1_0(opened[name], head)
        for first in range(0, max(map(len, rest.values()), default=0), ROWS):
            for name, data in rest.items():
                np.ascontiguousarray(data[first : first + ROWS]).tofile(opened[name])
                forget(data)
