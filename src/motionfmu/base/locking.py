"""Locks on open files that end with their process, on POSIX and on Windows."""

import errno
import os
from pathlib import Path

from motionfmu.base.errors import InputError

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]
    import msvcrt

# Files have bits that say who may read them, and folders can be opened.
POSIX = fcntl is not None


def lock(file: int, place: Path, taken: str, wait: bool = False) -> None:
    """Lock an open file for this process alone, until it is closed.

    InputError: `taken`, if somebody else has it and is not waited for, or what else is wrong.
    """
    try:
        if POSIX:
            fcntl.flock(file, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
        else:
            _lock_byte(file, wait)
    except OSError as error:
        held = error.errno in (errno.EACCES, errno.EAGAIN)
        raise InputError(f"{place}: {taken if held else error.strerror}") from None


def _lock_byte(file: int, wait: bool) -> None:
    """Lock the first byte of a file: Windows locks nothing else."""
    mode: int = msvcrt.LK_LOCK if wait else msvcrt.LK_NBLCK  # type: ignore[attr-defined]
    os.lseek(file, 0, os.SEEK_SET)
    while True:
        try:
            msvcrt.locking(file, mode, 1)  # type: ignore[attr-defined]
            return
        except OSError as error:
            if error.errno != errno.EDEADLK:  # it gives up after 10 s
                raise


def open_folder(folder: Path) -> int:
    """A folder as a file to be locked; Windows opens none, but a file in it."""
    if POSIX:
        return os.open(folder, os.O_RDONLY)
    return os.open(folder / ".lock", os.O_RDWR | os.O_CREAT, 0o600)
