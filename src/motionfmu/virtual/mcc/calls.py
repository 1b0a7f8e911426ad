"""Conversion of Python values to the arguments of C calls."""

import ctypes
from collections.abc import Iterable, Sequence
from typing import Any

from motionfmu.base.binding import library, real, whole
from motionfmu.base.errors import InputError
from motionfmu.virtual.mcc.library import AXES, MccError

Numbers = Sequence[float]


def doubles(values: Numbers, count: int = AXES) -> Any:
    """Make a C array of exactly so many doubles."""
    return _array(ctypes.c_double, [real(v) for v in _several(values, count)], count)


def integers(values: Sequence[int], count: int = AXES) -> Any:
    """Make a C array of exactly so many int32."""
    return _array(ctypes.c_int32, [whole(v) for v in _several(values, count)], count)


def letters(values: str, count: int = AXES) -> Any:
    """Make a C array of exactly so many characters."""
    return _array(ctypes.c_char, [letter(v) for v in _several(values, count)], count)


def letter(value: str) -> Any:
    """Make a C character of one letter."""
    if not isinstance(value, str) or len(value) != 1 or not value.isascii():
        raise InputError(f"{value!r}: one letter wanted")
    return ctypes.c_char(value.encode())


def _several(values: Any, count: int) -> Any:
    """Refuse a value that is no sequence of elements."""
    if not isinstance(values, Iterable):
        raise InputError(f"{values!r}: {count} values wanted")
    return values


def _array(kind: Any, values: list[Any], count: int) -> Any:
    if len(values) != count:
        raise InputError(f"{values!r}: {count} values wanted")
    return (kind * count)(*values)


class Calls:
    """Calls of C functions by name on a library's state, which its owner keeps alive."""

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
