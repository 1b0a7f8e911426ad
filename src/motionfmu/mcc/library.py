"""The shared library of station, card and MCC library, and its structs by name."""

import ctypes
import difflib
import functools
from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.errors import InputError

PACKAGE = Path(__file__).resolve().parent.parent
AXES = 6
# Clocks of the card in a second.
CLOCK_HZ = 40_000_000

# Return codes of the library: name and meaning.
CODES = {
    -1: ("INITIAL_MOTION", "init_motion has not been called"),
    -2: ("COMMAND_BUFFER_FULL", "the command ring is full: let the task run"),
    -3: ("COMMAND_NOTACCEPTED", "not accepted now: a part program runs, or axes are moved by hand"),
    -4: ("COMMAND_NOTFINISHED", "allowed at standstill only"),
    -5: ("PARAMETER", "a value is out of range, or the axis is not used"),
    -6: ("GROUP_PARAMETER", "no such group"),
    -7: ("FEED_RATE", "the feed is out of range or drives an axis above its safe speed"),
    -9: ("VOLTAGE_COMMAND_CHANNEL", "the DAC is the voltage command of an axis"),
    -10: ("HOME_COMMAND_NOTCALLED", "no search of the origin has been started"),
    -11: ("HOLD_ILLEGAL", "nothing moves that could be held"),
    -12: ("CONTI_ILLEGAL", "nothing is held"),
    -13: ("ABORT_ILLEGAL", "nothing moves that could be dropped"),
    -14: ("RUN_TIME", "a run-time error waits for clear_error, or its cause lasts"),
    -15: ("ABORT_NOT_FINISH", "an abort is still ramping to rest"),
    -16: ("GROUP_RAN_OUT", "there are no more groups"),
}


class MccError(RuntimeError):
    """A call the library has refused; it has changed nothing.

    Attributes
    ----------
    call : str
        Name of the function.
    code : int
        Its return code, below 0; a key of ``CODES``.
    """

    def __init__(self, call: str, code: int) -> None:
        name, meaning = CODES.get(code, ("", "unknown code"))
        super().__init__(f"{call} returns {code} {name}: {meaning}")
        self.call, self.code = call, code


class _Field(ctypes.Structure):
    """One row of a table in src/python/binding.c."""

    _fields_ = (
        ("name", ctypes.c_char * 24),
        ("unit", ctypes.c_char * 16),
        ("kind", ctypes.c_int32),
        ("offset", ctypes.c_int32),
        ("count", ctypes.c_int32),
        ("stride", ctypes.c_int32),
    )


def library_path() -> Path:
    """Where the shared library is: in the installed package, or the source tree's ``build/lib``."""
    name = Path("lib") / "motionfmu_mcc.so"
    for folder in (PACKAGE, PACKAGE.parent.parent / "build"):
        if (folder / name).is_file():
            return folder / name
    raise InputError(f"{name.name} is not built; run make build")


@functools.cache
def library() -> ctypes.CDLL:
    """Load the shared library once."""
    c = ctypes.CDLL(str(library_path()))
    c.binding_fields.restype = ctypes.POINTER(_Field)
    c.binding_mcc.restype = c.binding_machine.restype = ctypes.c_void_p
    c.fault_text.restype = ctypes.c_char_p
    for name in ("acc_step", "dec_step", "dda", "over_spd", "ptp_ospd"):
        getattr(c, f"MCC_get_{name}").restype = ctypes.c_double
    for name in ("acc_type", "dec_type"):
        getattr(c, f"MCC_get_{name}").restype = ctypes.c_char
    return c


@functools.cache
def _table(of: str) -> tuple[int, dict[str, _Field]]:
    """Size of a struct [byte] and its members."""
    count, size = ctypes.c_int32(), ctypes.c_int64()
    rows = library().binding_fields(of.encode(), ctypes.byref(count), ctypes.byref(size))
    return size.value, {rows[i].name.decode(): rows[i] for i in range(count.value)}


_TYPES: dict[str, Any] = {
    "i": np.int32,
    "l": np.int64,
    "u": np.uint32,
    "d": np.float64,
    "?": np.bool_,
    "c": "S1",
}


class Struct:
    """A struct of the C library; ``s["name"]`` reads and writes.

    Its name is one of binding.c: config, reading, station, report, mcc, param or comp; without `at`
    it has memory of its own.
    """

    def __init__(self, of: str, at: ctypes.c_void_p | None = None) -> None:
        size, self._fields = _table(of)
        kind = ctypes.c_char * size
        self._memory = kind() if at is None else kind.from_address(at.value or 0)

    @property
    def pointer(self) -> ctypes.c_void_p:
        """Its address, to hand to the library."""
        return ctypes.c_void_p(ctypes.addressof(self._memory))

    @property
    def units(self) -> dict[str, str]:
        """Unit of each member, empty if it has none."""
        return {name: f.unit.decode() for name, f in self._fields.items()}

    def _view(self, name: str) -> np.ndarray:
        if name not in self._fields:
            near = difflib.get_close_matches(name, self._fields, 1)
            hint = f"; did you mean {near[0]!r}?" if near else ""
            raise InputError(f"no {name!r} here{hint} (there are: {', '.join(self._fields)})")
        f = self._fields[name]
        kind: np.dtype = np.dtype(_TYPES[chr(f.kind)])
        memory: Any = self._memory
        return np.ndarray((f.count,), kind, memory, f.offset, (f.stride,))

    def __getitem__(self, name: str) -> Any:
        view = self._view(name)
        if len(view) > 1:
            return view.copy()
        value = view[0].item()
        return value.decode() if isinstance(value, bytes) else value

    def __setitem__(self, name: str, value: Any) -> None:
        view = self._view(name)
        kind = view.dtype.kind
        try:
            given = np.asarray(value.encode() if kind == "S" else value)
            accepted = "iu" if kind in "iu" else kind if kind in "bS" else "iuf"
            fits = given.dtype.kind in accepted
            if not (fits and given.ndim <= 1 and given.size in (1, len(view))):
                raise ValueError
            if kind in "iu" and not np.array_equal(given.astype(view.dtype), given):
                raise ValueError
            if kind == "S" and len(value) != 1:
                raise ValueError
        except (ValueError, TypeError, AttributeError):
            wanted = {"i": "whole number", "u": "whole number", "f": "number", "b": "truth value"}
            shape = f" or {len(view)} of them" if len(view) > 1 else ""
            kind_name = wanted.get(kind, "letter")
            raise InputError(f"{name} = {value!r}: one {kind_name}{shape} wanted") from None
        view[:] = given

    def __contains__(self, name: str) -> bool:
        return name in self._fields

    def __iter__(self) -> Any:
        return iter(self._fields)
