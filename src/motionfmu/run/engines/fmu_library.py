"""The shared library of an FMU, whose functions are called by ctypes."""

import _ctypes
import ctypes
from collections.abc import Callable, Iterable, Sequence
from ctypes import byref, c_bool, c_char_p, c_double, c_int, c_size_t, c_uint32, c_void_p
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from motionfmu.run.engines.fmu_messages import WARNING

Log = Callable[[int, str], None]  # status and message

# Types and the C types of their values, by version of FMI; in FMI 2 each element is a variable.
NAMES = {"Float64": "Real", "Int32": "Integer", "Boolean": "Boolean", "String": "String"}
_VALUES: dict[str, Any] = {
    "Float64": c_double,
    "Float32": ctypes.c_float,
    "Boolean": c_bool,
    "String": c_char_p,
    **{f"Int{bits}": getattr(ctypes, f"c_int{bits}") for bits in (8, 16, 32, 64)},
    **{f"UInt{bits}": getattr(ctypes, f"c_uint{bits}") for bits in (8, 16, 32, 64)},
}
_LOG3 = ctypes.CFUNCTYPE(None, c_void_p, c_int, c_char_p, c_char_p)


class _Callbacks(ctypes.Structure):
    """The struct fmi2CallbackFunctions."""

    _fields_ = tuple(
        (name, c_void_p) for name in ("logger", "allocate", "free", "finished", "environment")
    )


class BindingLog(ctypes.Structure):
    """The struct binding_log, environment of an instance of FMI 2, which must not outlive it."""

    _TOLD = ctypes.CFUNCTYPE(None, c_int, c_char_p)
    _fields_ = (("told", _TOLD),)

    @classmethod
    def to(cls, log: Log) -> "BindingLog":
        """A struct that passes messages to a log, with the values of their formats filled in."""
        return cls(cls._TOLD(lambda status, text: log(status, read(text))))

    def callbacks(self) -> _Callbacks:
        """The callbacks that the instance is given."""
        from motionfmu.base.binding import library

        system = ctypes.CDLL(None)
        functions = (library().binding_log, system.calloc, system.free)
        addresses = (ctypes.cast(function, c_void_p) for function in functions)
        return _Callbacks(*addresses, None, ctypes.cast(byref(self), c_void_p))


@dataclass(frozen=True)
class ValuePlace:
    """Where a value is: its type of FMI 3, its first value reference, its number of elements."""

    type: str
    reference: int
    count: int


class FmuRefusal(Exception):
    """A call that the FMU refused; its message went to the log."""


class Library:
    """A loaded library, and one instance at a time."""

    def __init__(self, file: Path, fmi: int) -> None:
        self.fmi, self.instance = fmi, c_void_p()
        self._dll: ctypes.CDLL | None = ctypes.CDLL(str(file))

    def function(self, name: str) -> Any:
        """A function of the standard, by its name without the version."""
        return getattr(self._dll, f"fmi{self.fmi}{name}")

    def address(self, name: str) -> int | None:
        """Where a function of the standard is in memory."""
        return ctypes.cast(self.function(name), c_void_p).value

    def own(self, name: str) -> Any:
        """A function of the library that is none of the standard's."""
        return getattr(self._dll, name)

    def call(self, name: str, *arguments: Any) -> None:
        """Call a function of the instance."""
        if self.function(name)(self.instance, *arguments) > WARNING:
            raise FmuRefusal(name)

    def instantiate(
        self, name: str, token: str, resources: Path, log: Log, everything: bool = False
    ) -> None:
        """Make a new instance in the place of an older one; it logs errors, or everything."""
        self.release()
        self.listen(log)
        texts: list[Any] = [text.encode() for text in (name, token)]
        rest: tuple[Any, ...]
        off, nothing = c_bool(False), c_void_p()
        if self.fmi == 3:
            self._log: Any = _LOG3(lambda _, status, __, text: self._tell(status, read(text)))
            make, given = self.function("InstantiateCoSimulation"), f"{resources}/".encode()
            told = (off, c_bool(everything), off, off)
            rest = (*told, nothing, c_size_t(0), nothing, self._log, nothing)
        else:
            self._log = BindingLog.to(lambda status, text: self._tell(status, text))
            self._callbacks = self._log.callbacks()
            make, given = self.function("Instantiate"), resources.as_uri().encode()
            texts.insert(1, c_int(1))  # for co-simulation
            rest = (byref(self._callbacks), c_int(0), c_int(everything))
        make.restype = c_void_p
        self.instance = c_void_p(make(*texts, given, *rest))
        if not self.instance:
            raise FmuRefusal("instantiate")

    def listen(self, log: Log) -> None:
        """Pass the messages of the instance to a log from now on."""
        self._tell = log

    def reset(self) -> None:
        """Bring the instance back to where it was made; its files are closed."""
        self.call("Reset")

    def warn(self) -> None:
        """Let one of our FMUs log its warnings as well as its errors."""
        categories = (c_char_p * 1)(b"logStatusWarning")
        self.call("SetDebugLogging", c_bool(True), c_size_t(1), categories)

    def _several(self, variables: Iterable[ValuePlace]) -> Any:
        """Value references of variables; in FMI 2 each element has one."""
        elements = 1 if self.fmi == 3 else None
        found = [v.reference + i for v in variables for i in range(elements or v.count)]
        return (c_uint32 * len(found))(*found)

    def set(self, values: Iterable[tuple[ValuePlace, Sequence[Any]]]) -> None:
        """Set variables: a call for each type."""
        by_kind: dict[str, list[tuple[ValuePlace, Sequence[Any]]]] = {}
        for variable, given in values:
            by_kind.setdefault(variable.type, []).append((variable, given))
        for kind, several in by_kind.items():
            flat = [x.encode() if kind == "String" else x for _, given in several for x in given]
            buffer = self.buffer(kind, len(flat))
            buffer[:] = flat
            self.access("Set", [v for v, _ in several], buffer)()

    def buffer(self, kind: str, count: int) -> Any:
        """Memory for values of a type, laid out as the FMU has them."""
        c = c_int if (self.fmi, kind) == (2, "Boolean") else _VALUES[kind]
        return (c * count)()

    def access(self, verb: str, variables: Sequence[ValuePlace], buffer: Any) -> Callable[[], None]:
        """A quick function that gets or sets variables of a type through their buffer."""
        kind, references = variables[0].type, self._several(variables)
        name = f"{verb}{kind if self.fmi == 3 else NAMES[kind]}"
        call, size = self.function(name), c_size_t(len(references))
        more = (c_size_t(len(buffer)),) if self.fmi == 3 else ()
        arguments = (self.instance, references, size, buffer, *more)

        def run() -> None:
            if call(*arguments) > WARNING:
                raise FmuRefusal(name)

        return run

    def get(self, variable: ValuePlace) -> list[Any]:
        """The elements of a numeric variable."""
        values = self.buffer(variable.type, variable.count)
        self.access("Get", [variable], values)()
        return list(values)

    def enter(self, time: float = 0.0) -> None:
        """Enter Initialization Mode, at a time [s]."""
        none, zero, start = c_int(0), c_double(0.0), c_double(time)
        if self.fmi == 2:
            self.call("SetupExperiment", none, zero, start, none, zero)
            self.call("EnterInitializationMode")
        else:
            self.call("EnterInitializationMode", c_bool(False), zero, start, c_bool(False), zero)

    def leave(self) -> None:
        """Leave Initialization Mode."""
        self.call("ExitInitializationMode")

    def step(self, time: float, size: float) -> None:
        """Advance from a communication point by one step [s]."""
        self.stepper(size)(time)

    def stepper(self, size: float) -> Callable[[float], None]:
        """A quick `step` of one size [s]: a function of the communication point [s]."""
        step, instance, length = self.function("DoStep"), self.instance, c_double(size)
        flags = [byref(c_bool()) for _ in range(3)]
        rest = (c_bool(True), *flags, byref(c_double())) if self.fmi == 3 else (c_int(1),)

        def advance(time: float) -> None:
            if step(instance, c_double(time), length, *rest) > WARNING:
                raise FmuRefusal("doStep")

        return advance

    def terminate(self) -> None:
        """End the run: files are written."""
        self.call("Terminate")

    def release(self) -> None:
        """Free the instance, if there is one."""
        if self.instance:
            self.function("FreeInstance")(self.instance)
            self.instance = c_void_p()

    def close(self) -> None:
        """Free the instance and the library."""
        self.release()
        if self._dll is not None:
            _ctypes.dlclose(self._dll._handle)
            self._dll = None


def read(text: bytes) -> str:
    """The Python text of a C string that an FMU gave."""
    return text.decode(errors="replace")
