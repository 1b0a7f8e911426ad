"""How Python values become the arguments of a C call."""

import ctypes
from collections.abc import Sequence
from typing import Any

from motionfmu.binding import library, whole
from motionfmu.errors import InputError
from motionfmu.mcc.library import AXES, MccError

Numbers = Sequence[float]


def doubles(values: Numbers, count: int = AXES) -> Any:
    """Make a C array of doubles, of just so many."""
    return _array(ctypes.c_double, [float(v) for v in values], count)


def integers(values: Sequence[int], count: int = AXES) -> Any:
    """Make a C array of int32, of just so many."""
    return _array(ctypes.c_int32, [whole(v) for v in values], count)


def letters(values: str, count: int = AXES) -> Any:
    """Make a C array of characters, of just so many letters."""
    return _array(ctypes.c_char, [v.encode() for v in values], count)


def _array(kind: Any, values: list[Any], count: int) -> Any:
    if len(values) != count:
        raise InputError(f"{values!r}: {count} values wanted")
    return (kind * count)(*values)


class Calls:
    """A library state by its address, with functions called by name; the owner keeps it alive."""

    def __init__(self, pointer: ctypes.c_void_p, owner: object) -> None:
        self._pointer, self._owner, self._library = pointer, owner, library()

    def _do(self, name: str, *arguments: Any) -> int:
        """Call a function that returns a code; a float is passed as a double."""
        converted = [ctypes.c_double(a) if isinstance(a, float) else a for a in arguments]
        code = getattr(self._library, name)(self._pointer, *converted)
        if code < 0:
            raise MccError(name, code)
        return code

    def _get(self, name: str, kind: Any = ctypes.c_int32) -> list[Any]:
        """Call a function that fills six values."""
        six = (kind * AXES)()
        self._do(name, six)
        return list(six)

    def _one(self, name: str) -> Any:
        """Call a function that returns a value instead of a code."""
        return getattr(self._library, name)(self._pointer)
