"""The memory of this process in C's heap."""

import ctypes
import sys

# Numbers of glibc's malloc.h: what is free at the heap's end stays up to a size, and blocks up to a
# size are of the heap, each with the largest value that glibc takes [byte].
_TRIM_THRESHOLD, _TRIM_MOST = -1, (1 << 31) - 1
_MMAP_THRESHOLD, _MMAP_MOST = -3, 1 << 25


def keep_freed() -> None:
    """Let this process keep memory that it has freed, and use it again.

    Otherwise large arrays go back to the system, which clears each page that it hands out anew. It
    is meant for a process that does the same work over and over. It does nothing without glibc.
    """
    if sys.platform == "linux" and hasattr(own := ctypes.CDLL(None), "gnu_get_libc_version"):
        own.mallopt(_TRIM_THRESHOLD, _TRIM_MOST)
        own.mallopt(_MMAP_THRESHOLD, _MMAP_MOST)
