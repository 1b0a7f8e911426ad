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

# Whether files have permission bits and folders can be opened, as on POSIX.
POSIX = fcntl is not None


def lock(file: int, place: Path, taken: str, wait: bool = False) -> None:
    """Lock an open file for this process alone, until it is closed.

    The InputError is `taken` if another process has the lock and `wait` is false, or any other
    fault.
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
    """Lock the first byte of a file, for Windows locks ranges of bytes only."""
    mode: int = msvcrt.LK_LOCK if wait else msvcrt.LK_NBLCK  # type: ignore[attr-defined]
    os.lseek(file, 0, os.SEEK_SET)
    while True:
        try:
            msvcrt.locking(file, mode, 1)  # type: ignore[attr-defined]
            return
        except OSError as error:
            if error.errno != errno.EDEADLK:  # Windows gives up after 10 s
                raise


def open_folder(folder: Path) -> int:
    """Open a folder to lock it; on Windows, which opens no folders, a file in it."""
    if POSIX:
        return os.open(folder, os.O_RDONLY)
    return os.open(folder / ".lock", os.O_RDWR | os.O_CREAT, 0o600)
