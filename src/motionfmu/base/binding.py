"""The C library for Python: its structs, and stations that run on the clock of a card."""

import contextlib
import ctypes
import functools
from collections.abc import Collection, Iterable
from pathlib import Path
from typing import Any, Generic, TypeVar

import numpy as np

from motionfmu.base.errors import InputError, suggestion
from motionfmu.base.platforms import here

PACKAGE = Path(__file__).resolve().parents[1]
# Clocks of the cards in a second [Hz].
CLOCK_HZ = 40_000_000
# Longest time [s] that one call runs, as long as a scenario may be: more than a day.
_SECONDS_MAX = 100_000
# Clocks that are run without looking whether Ctrl-C was pressed: some 2 s of work.
_PIECE = 100 * CLOCK_HZ
# Most clocks that a setting in seconds may come to.
_CLOCKS_MAX = 2.0**62
_MILLISECOND = CLOCK_HZ // 1000


class _FieldRow(ctypes.Structure):
    """One row of a table in src/python."""

    _fields_ = (
        ("name", ctypes.c_char * 24),
        ("unit", ctypes.c_char * 16),
        ("kind", ctypes.c_int32),
        ("offset", ctypes.c_int32),
        ("count", ctypes.c_int32),
        ("stride", ctypes.c_int32),
        ("times", ctypes.c_int32),
        ("over", ctypes.c_int32),
    )


def library_path() -> Path:
    """Path of the shared library: in the installed package, or the source tree's ``build/lib``."""
    name = "motionfmu_stations.so"
    own = PACKAGE / "lib"
    for folder in (own / here().name, own, PACKAGE.parent.parent / "build/lib"):
        if (folder / name).is_file():
            return folder / name
    if own.is_dir():
        there = ", ".join(sorted(p.name for p in own.iterdir() if p.is_dir()))
        raise InputError(f"{name}: none for {here().name} in {own} (there are: {there})")
    raise InputError(f"{name} is not built; run make build")


@functools.cache
def library() -> ctypes.CDLL:
    """Load the shared library once."""
    c = ctypes.CDLL(str(library_path()))
    c.binding_fields.restype = ctypes.POINTER(_FieldRow)
    c.binding_mcc.restype = c.binding_machine.restype = ctypes.c_void_p
    c.fault_text.restype = ctypes.c_char_p
    c.netcard_receive.restype = c.netcard_send.restype = ctypes.c_size_t
    c.netcard_wants_connection.restype = c.binding_netcard_start.restype = ctypes.c_bool
    c.binding_bench.restype = ctypes.c_bool
    c.binding_netcard_card.restype = ctypes.c_void_p
    c.binding_robot_trace.restype = ctypes.c_int64
    for name in ("acc_step", "dec_step", "dda", "over_spd", "ptp_ospd"):
        getattr(c, f"MCC_get_{name}").restype = ctypes.c_double
    for name in ("acc_type", "dec_type"):
        getattr(c, f"MCC_get_{name}").restype = ctypes.c_char
    return c


@functools.cache
def _table(of: str) -> tuple[int, dict[str, _FieldRow]]:
    """Size of a struct [byte] and its members."""
    count, size = ctypes.c_int32(), ctypes.c_int64()
    rows = library().binding_fields(of.encode(), ctypes.byref(count), ctypes.byref(size))
    return size.value, {rows[i].name.decode(): rows[i] for i in range(count.value)}


_TYPES: dict[str, Any] = {
    "i": np.int32,
    "l": np.int64,
    "u": np.uint32,
    "B": np.uint8,
    "d": np.float64,
    "?": np.bool_,
    "c": "S1",
}


def dtype(of: str) -> np.dtype:
    """Type of numpy arrays whose rows are structs of C."""
    size, fields = _table(of)
    rows = {name: (_TYPES[chr(f.kind)], f.count, f.offset, f.stride) for name, f in fields.items()}
    return np.dtype(
        {
            "names": list(rows),
            "formats": [(t, n) if n > 1 else t for t, n, _, _ in rows.values()],
            "offsets": [at for _, _, at, _ in rows.values()],
            "itemsize": size,
        }
    )


class Struct:
    """A struct of the C library; ``s["name"]`` reads and writes.

    Its name is one of a table in src/python; without `at` it has memory of its own.
    """

    def __init__(self, of: str, at: ctypes.c_void_p | None = None) -> None:
        size, self._fields = _table(of)
        kind = ctypes.c_char * size
        self._memory = kind() if at is None else kind.from_address(at.value or 0)

    @property
    def pointer(self) -> ctypes.c_void_p:
        """Address of the struct, for calls of the library."""
        return ctypes.c_void_p(ctypes.addressof(self._memory))

    def saved(self) -> bytes:
        """All of it as it is, for `restore`."""
        return bytes(self._memory)

    def restore(self, saved: bytes) -> None:
        """Back to how it was when it was saved."""
        ctypes.memmove(self._memory, saved, len(saved))

    @property
    def units(self) -> dict[str, str]:
        """Unit of each member, empty if it has none."""
        return {name: f.unit.decode() for name, f in self._fields.items()}

    def _view(self, name: str) -> np.ndarray:
        if name not in self._fields:
            hint = suggestion(name, self._fields) or _there_are(self._fields)
            raise InputError(f"no setting {name!r}{hint}")
        f = self._fields[name]
        kind: np.dtype = np.dtype(_TYPES[chr(f.kind)])
        memory: Any = self._memory
        return np.ndarray((f.count,), kind, memory, f.offset, (f.stride,))

    def _given(self, name: str) -> np.ndarray:
        """A member in the units in which a user gives it."""
        view, f = self._view(name), self._fields[name]
        if f.times == f.over:
            return view
        return ~view if view.dtype.kind == "b" else view * float(f.over) / f.times

    def __getitem__(self, name: str) -> Any:
        view = self._given(name)
        if len(view) > 1:
            return view.copy()
        value = view[0].item()
        return value.decode() if isinstance(value, bytes) else value

    # CCN 20: each kind of member refuses what it cannot hold, and one message tells of them all.
    def __setitem__(self, name: str, value: Any) -> None:
        view, f = self._view(name), self._fields[name]
        kind = view.dtype.kind if f.times == f.over or view.dtype.kind == "b" else "f"
        try:
            given = np.asarray(value.encode() if kind == "S" else value)
            accepted = {"i": "iu", "u": "iu", "b": "biu", "S": "S"}.get(kind, "iuf")
            fits = given.dtype.kind in accepted
            if not (fits and given.ndim <= 1 and given.size in (1, len(view))):
                raise ValueError
            if kind == "b" and not np.isin(given, (0, 1)).all():
                raise ValueError
            if view.dtype.kind in "iu" and kind == "f":
                with np.errstate(over="ignore", invalid="ignore"):  # told below
                    given = np.rint(given * float(f.times) / f.over)
                if not (np.abs(given) < _CLOCKS_MAX).all():
                    raise ValueError
            elif f.times != f.over:
                with np.errstate(over="ignore"):  # without end, which its user refuses
                    given = given == 0 if kind == "b" else given * float(f.times) / f.over
            if kind in "iu" and not np.array_equal(given.astype(view.dtype), given):
                raise ValueError
            if kind == "S" and len(value) != 1:
                raise ValueError
        except (ValueError, TypeError, AttributeError, OverflowError):
            wanted = {"i": "whole number", "u": "whole number", "f": "number", "b": "truth value"}
            shape = f" or {len(view)} of them" if len(view) > 1 else ""
            kind_name = wanted.get(kind, "letter")
            raise InputError(f"{name} = {value!r:.80}: one {kind_name}{shape} wanted") from None
        view[:] = given

    def __contains__(self, name: str) -> bool:
        return name in self._fields

    def __iter__(self) -> Any:
        return iter(self._fields)


def whole(value: float) -> int:
    """Convert a value to a whole number of 32 bits; an InputError if it is none."""
    if isinstance(value, int | float | np.number) and -(2**31) <= value < 2**31:
        if value == int(value):
            return int(value)
    raise InputError(f"{value!r:.80}: a whole number of 32 bits wanted")


def real(value: float) -> float:
    """Convert a value to a float; an InputError if it is no number."""
    if isinstance(value, int | float | np.number) and not isinstance(value, bool):
        with contextlib.suppress(OverflowError):  # an int that is beyond all floats
            return float(value)
    raise InputError(f"{value!r:.80}: a number wanted")


def text(value: str) -> bytes:
    """Convert a text to bytes for C; an InputError if it is no text."""
    if isinstance(value, str):
        return value.encode()
    raise InputError(f"{value!r:.80}: a text wanted")


class Reading:
    """The state of a station at one clock, as attributes; `time` is the clock in seconds."""

    def __init__(self, values: dict[str, Any]) -> None:
        self.__dict__.update(values, time=values["clock"] / CLOCK_HZ)

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(unread(name, self.__dict__))

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{k}={v}' for k, v in self.__dict__.items())})"


def unread(name: str, known: Collection[str]) -> str:
    """The message about a reading that does not exist."""
    return f"no reading {name!r}" + (suggestion(name, known) or _there_are(known))


def _there_are(known: Iterable[str]) -> str:
    return f" (there are: {', '.join(known)})"


def _check_length(seconds: float, name: str) -> None:
    """Refuse what is no length of time, or longer than one call runs."""
    if not 0 <= real(seconds) <= _SECONDS_MAX:
        raise InputError(f"{name} = {seconds} s: 0 to {_SECONDS_MAX} s wanted")


R = TypeVar("R", bound=Reading)


class Station(Generic[R]):
    """A control with its card and machine on one clock.

    What `motionfmu.virtual.mcc.VirtualCard` and `motionfmu.virtual.robot.VirtualRobot` share.
    """

    # Name of the reading that is true when nothing is left to do.
    _at_rest: str

    def _advance(self, until: ctypes.c_int64) -> None:
        raise NotImplementedError

    def read(self) -> R:
        """What there is to see now.

        Returns
        -------
        Reading
        """
        raise NotImplementedError

    @property
    def clock(self) -> int:
        """Everything up to here has happened [25 ns]."""
        return int(self.read().clock)

    def run_to(self, clock: int) -> R:
        """Run up to and including a clock.

        Parameters
        ----------
        clock : int
            [25 ns], 100,000 s from now at most; nothing happens if it has passed.

        Returns
        -------
        Reading
            What there is to see then.

        Raises
        ------
        CardError
            A virtual card takes no frame any more, or a motor is beyond what an encoder can follow.
        """
        if not isinstance(clock, int | np.integer):
            raise InputError(f"clock {clock!r}: a whole number of 25 ns wanted")
        now, last = self.clock, max(int(clock), 0)
        if last - now > _SECONDS_MAX * CLOCK_HZ:
            at = now / CLOCK_HZ
            raise InputError(f"clock {clock}: at most {_SECONDS_MAX} s beyond {at:.9g} s wanted")
        for until in (*range(now + _PIECE, last, _PIECE), last):
            self._advance(ctypes.c_int64(until))
        return self.read()

    def run(self, seconds: float) -> R:
        """Run on.

        Parameters
        ----------
        seconds : float
            [s], rounded to 25 ns; 100,000 at most.

        Raises
        ------
        InputError
            It is no length of time, or a longer one.
        CardError
            See `run_to`.
        """
        _check_length(seconds, "seconds")
        return self.run_to(self.clock + round(seconds * CLOCK_HZ))

    def run_until_stop(self, limit: float = 60.0) -> R:
        """Run until nothing is left to do and every pulse is out.

        Parameters
        ----------
        limit : float
            [s] at most.

        Returns
        -------
        Reading
            At the first millisecond at which it has stopped, or at the limit.

        Raises
        ------
        CardError
            See `run_to`.
        """
        _check_length(limit, "limit")
        last = self.clock + round(limit * CLOCK_HZ)
        reading = self.run_to(min(last, self.clock + _MILLISECOND))
        while not getattr(reading, self._at_rest) and reading.clock < last:
            reading = self.run_to(min(last, reading.clock + _MILLISECOND))
        return reading

    def record(self, seconds: float, step: float, *names: str) -> dict[str, np.ndarray]:
        """Run on and keep readings.

        Parameters
        ----------
        seconds : float
            [s]
        step : float
            [s] between two readings, rounded to 25 ns.
        *names : str
            Attributes of the reading.

        Returns
        -------
        dict
            ``time`` (n,) [s] and an array for each name, a row a reading, the first before
            anything runs.

        Raises
        ------
        InputError
            There is no such reading, or no such time.
        CardError
            See `run_to`.
        """
        _check_length(seconds, "seconds")
        _check_length(step, "step")
        clocks = round(step * CLOCK_HZ)
        if clocks < 1:
            raise InputError(f"step = {step} s: 25 ns or more wanted")
        first = self.read()
        if unknown := [n for n in names if not isinstance(n, str) or n not in first.__dict__]:
            raise InputError(unread(text(unknown[0]).decode(), first.__dict__))
        rows = [first]
        for k in range(1, round(seconds * CLOCK_HZ) // clocks + 1):
            rows.append(self.run_to(first.clock + k * clocks))
        return {n: np.array([getattr(r, n) for r in rows]) for n in ("time", *names)}
