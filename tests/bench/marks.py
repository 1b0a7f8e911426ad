"""What of this process counting.py counts by valgrind: from `begin` to `end`, if it asks for it."""

import ctypes
import os
import sys

_WHERE = os.environ.get("COUNT_HERE")
_HERE = ctypes.CDLL(_WHERE) if _WHERE else None


def begin() -> None:
    """Count from here."""
    if _HERE:
        _HERE.count_begin()


def end(share: float = 1.0) -> None:
    """Count up to here, which was this share of what a run of so many steps does."""
    if _HERE:
        _HERE.count_end()
        print("counted share", share, file=sys.stderr)
