"""The library of an FMU of ours, called without FMPy, whose import takes longer than a run."""

import _ctypes
import ctypes
from collections.abc import Callable, Iterable, Sequence
from ctypes import byref, c_bool, c_char_p, c_double, c_int, c_int32, c_size_t, c_uint32, c_void_p
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from motionfmu.run.engines.messages import ERROR

Log = Callable[[int, str], None]  # status and message

# Types and their values, by version; FMI 2 names elements, FMI 3 arrays.
_NAMES = {"Float64": "Real", "Int32": "Integer", "Boolean": "Boolean", "String": "String"}
_VALUES: dict[str, Any] = {
    "Float64": c_double,
    "Int32": c_int32,
    "Boolean": c_bool,
    "String": c_char_p,
}
_LOG = {
    2: ctypes.CFUNCTYPE(None, c_void_p, c_char_p, c_int, c_char_p, c_char_p),
    3: ctypes.CFUNCTYPE(None, c_void_p, c_int, c_char_p, c_char_p),
}


class _Callbacks(ctypes.Structure):
    """fmi2CallbackFunctions; memory is the FMU's own."""

    _fields_ = (
        ("logger", _LOG[2]),
        ("allocate", c_void_p),
        ("free", c_void_p),
        ("finished", c_void_p),
        ("environment", c_void_p),
    )


@dataclass(frozen=True)
class Variable:
    """Where a value is: its type of FMI 3, its first reference, its elements."""

    type: str
    reference: int
    count: int


class Refused(Exception):
    """A call that the FMU refused; what it says of it went to the log."""


class Library:
    """A loaded library, and one instance at a time."""

    def __init__(self, file: Path, fmi: int) -> None:
        self.fmi, self._instance = fmi, c_void_p()
        self._dll: ctypes.CDLL | None = ctypes.CDLL(str(file))

    def _function(self, name: str) -> Any:
        return getattr(self._dll, f"fmi{self.fmi}{name}")

    def call(self, name: str, *arguments: Any) -> None:
        """Call a function of the instance."""
        if self._function(name)(self._instance, *arguments) >= ERROR:
            raise Refused(name)

    def instantiate(self, name: str, token: str, resources: Path, log: Log) -> None:
        """Make the instance, in the place of one before; it tells warnings and errors."""
        self.release()
        texts: list[Any] = [text.encode() for text in (name, token)]
        rest: tuple[Any, ...]
        if self.fmi == 3:
            self._log = _LOG[3](lambda _, status, __, text: log(status, _read(text)))
            make, given = self._function("InstantiateCoSimulation"), f"{resources}/".encode()
            off, nothing = c_bool(False), c_void_p()
            rest = (off, off, off, off, nothing, c_size_t(0), nothing, self._log, nothing)
        else:
            self._log = _LOG[2](
                lambda _, __, status, ___, text: log(status, _read(text).replace("%%", "%"))
            )
            self._callbacks = _Callbacks(self._log)
            make, given = self._function("Instantiate"), resources.as_uri().encode()
            texts.insert(1, c_int(1))  # for co-simulation
            rest = (byref(self._callbacks), c_int(0), c_int(0))
        make.restype = c_void_p
        self._instance = c_void_p(make(*texts, given, *rest))
        if not self._instance:
            raise Refused("instantiate")
        categories = (c_char_p * 1)(b"logStatusWarning")
        self.call("SetDebugLogging", c_bool(True), c_size_t(1), categories)

    def _several(self, variables: Iterable[Variable]) -> Any:
        """References of variables; in FMI 2 one for each element."""
        elements = 1 if self.fmi == 3 else None
        found = [v.reference + i for v in variables for i in range(elements or v.count)]
        return (c_uint32 * len(found))(*found)

    def _values(self, kind: str, values: Sequence[Any]) -> tuple[Any, ...]:
        """An array of values, and in FMI 3 its length."""
        c = c_int if (self.fmi, kind) == (2, "Boolean") else _VALUES[kind]
        array = (c * len(values))(*values)
        return (array, c_size_t(len(values))) if self.fmi == 3 else (array,)

    def _access(self, verb: str, kind: str, variables: Sequence[Variable], values: Any) -> None:
        references = self._several(variables)
        name = kind if self.fmi == 3 else _NAMES[kind]
        self.call(f"{verb}{name}", references, c_size_t(len(references)), *values)

    def set(self, values: Iterable[tuple[Variable, Sequence[Any]]]) -> None:
        """Set variables: a call for each type."""
        by_kind: dict[str, list[tuple[Variable, Sequence[Any]]]] = {}
        for variable, given in values:
            by_kind.setdefault(variable.type, []).append((variable, given))
        for kind, several in by_kind.items():
            flat = [x.encode() if kind == "String" else x for _, given in several for x in given]
            self._access("Set", kind, [v for v, _ in several], self._values(kind, flat))

    def get(self, variable: Variable) -> list[Any]:
        """Elements of a number."""
        values = self._values(variable.type, [0] * variable.count)
        self._access("Get", variable.type, [variable], values)
        return list(values[0])

    def initialize(self) -> None:
        """Go through Initialization Mode, at time 0."""
        none, zero = c_int(0), c_double(0.0)
        if self.fmi == 2:
            self.call("SetupExperiment", none, zero, zero, none, zero)
            self.call("EnterInitializationMode")
        else:
            self.call("EnterInitializationMode", c_bool(False), zero, zero, c_bool(False), zero)
        self.call("ExitInitializationMode")

    def step(self, time: float, size: float) -> None:
        """Advance from a communication point by one step [s]."""
        flags = [byref(c_bool()) for _ in range(3)]
        rest = (c_bool(True), *flags, byref(c_double())) if self.fmi == 3 else (c_int(1),)
        self.call("DoStep", c_double(time), c_double(size), *rest)

    def terminate(self) -> None:
        """End the run: files are written."""
        self.call("Terminate")

    def release(self) -> None:
        """Free the instance, if there is one."""
        if self._instance:
            self._function("FreeInstance")(self._instance)
            self._instance = c_void_p()

    def close(self) -> None:
        """Free the instance and the library."""
        self.release()
        if self._dll is not None:
            _ctypes.dlclose(self._dll._handle)
            self._dll = None


def _read(text: bytes) -> str:
    return text.decode(errors="replace")
