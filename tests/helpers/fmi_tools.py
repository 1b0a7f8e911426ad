"""An FMU of either FMI version, called by the names of its variables; every message is kept."""

import ctypes
import functools
import math
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from fmpy import extract, fmi2, fmi3, read_model_description
from fmpy.fmi1 import FMICallException

from motionfmu.scenarios.fmus import fmu_path

OK, WARNING, ERROR = 0, 1, 3
_FOLDERS: list[tempfile.TemporaryDirectory[str]] = []
_TYPE = {"Real": "f64", "Float64": "f64", "Integer": "i32", "Int32": "i32"}
_CALL: dict[str, tuple[Any, ...]] = {
    "f64": ("Real", "Float64", ctypes.c_double, ctypes.c_double),
    "i32": ("Integer", "Int32", ctypes.c_int, ctypes.c_int32),
    "Boolean": ("Boolean", "Boolean", ctypes.c_int, ctypes.c_bool),
    "String": ("String", "String", ctypes.c_char_p, ctypes.c_char_p),
}


class Variable:
    """One variable (an array is one), from the description of either version."""

    def __init__(self, first: Any, refs: list[int], count: int) -> None:
        self.type = _TYPE.get(first.type, first.type)
        self.causality, self.variability = first.causality, first.variability
        self.refs, self.count = refs, count
        self.min = None if first.min is None else float(first.min)
        self.max = None if first.max is None else float(first.max)


@functools.cache
def unpacked(name: str, fmi: int) -> tuple[Any, str, dict[str, Variable]]:
    """Description, folder and variables of an FMU, unpacked once."""
    _FOLDERS.append(tempfile.TemporaryDirectory())
    folder = extract(str(fmu_path(name, fmi)), unzipdir=_FOLDERS[-1].name)
    description = read_model_description(folder, validate=False)  # a test of its own does
    groups: dict[str, list[Any]] = {}
    for v in description.modelVariables:
        if v.causality != "independent":
            groups.setdefault(v.name.split("[")[0], []).append(v)
    variables = {}
    for key, group in groups.items():
        refs = [v.valueReference for v in group]
        dims = [int(d.start) for d in group[0].dimensions or []]
        variables[key] = Variable(group[0], refs, len(refs) * math.prod(dims))
    return description, folder, variables


class Instance:
    """An instance whose calls return the status instead of raising."""

    def __init__(self, name: str, fmi: int, resources: str | None = None, **wrong: Any) -> None:
        self.fmi = fmi
        self.description, folder, self.variables = unpacked(name, fmi)
        self.messages: list[tuple[int, str, str]] = []
        self.time = 0.0
        arguments = {
            "guid": self.description.guid,
            "modelIdentifier": self.description.coSimulation.modelIdentifier,
            "unzipDirectory": folder,
        }
        where = str(Path(folder, "resources")) if resources is None else resources
        token = wrong.get("token", self.description.guid).encode()
        title = wrong.get("title", "one").encode()
        if fmi == 2:
            self.fmu = fmi2.FMU2Slave(**arguments)
            self._functions = fmi2.fmi2CallbackFunctions()
            self._functions.logger = fmi2.fmi2CallbackLoggerTYPE(self._log2)
            self.fmu.component = self.fmu.fmi2Instantiate(
                title,
                wrong.get("kind", fmi2.fmi2CoSimulation),
                token,
                where.encode(),
                ctypes.byref(self._functions),
                0,
                0,
            )
        else:
            self.fmu = fmi3.FMU3Slave(**arguments)
            self._logger = fmi3.fmi3LogMessageCallback(self._log3)
            self.fmu.component = self.fmu.fmi3InstantiateCoSimulation(
                title,
                token,
                where.encode(),
                False,
                False,
                wrong.get("event_mode", False),
                True,
                None,
                0,
                None,
                self._logger,
                fmi3.fmi3IntermediateUpdateCallback(),
            )

    def _log2(self, _: Any, name: bytes, status: int, category: bytes, message: bytes) -> None:
        self.messages.append((status, category.decode(), message.decode().replace("%%", "%")))

    def _log3(self, _: Any, status: int, category: bytes, message: bytes) -> None:
        self.messages.append((status, category.decode(), message.decode()))

    @property
    def said(self) -> str:
        """The latest message."""
        return self.messages[-1][2] if self.messages else ""

    def call(self, function: str, *arguments: Any) -> int:
        """Status of fmi2<function> or fmi3<function>."""
        try:
            method = getattr(self.fmu, f"fmi{self.fmi}{function}")
            return int(method(self.fmu.component, *arguments) or 0)
        except FMICallException as error:
            return int(error.status)

    def _access(self, verb: str, name: str, values: Any) -> int:
        v = self.variables[name]
        refs = (ctypes.c_uint32 * len(v.refs))(*v.refs)
        function = verb + _CALL[v.type][self.fmi - 2]
        counts = (len(v.refs), values) if self.fmi == 2 else (len(v.refs), values, v.count)
        return self.call(function, refs, *counts)

    def set(self, name: str, value: Any) -> int:
        """Set a variable, all elements of an array, to one value or to a list."""
        v = self.variables[name]
        values = list(value) if isinstance(value, list | tuple | np.ndarray) else [value] * v.count
        if v.type == "String":
            values = [x if isinstance(x, bytes) else x.encode() for x in values]
        array = (_CALL[v.type][self.fmi] * v.count)(*values)
        return self._access("Set", name, array)

    def status_of_get(self, name: str) -> int:
        """Status of a get call; the value is dropped."""
        v = self.variables[name]
        return self._access("Get", name, (_CALL[v.type][self.fmi] * v.count)())

    def get(self, name: str) -> list[Any]:
        """The elements of a variable."""
        v = self.variables[name]
        array = (_CALL[v.type][self.fmi] * v.count)()
        assert self._access("Get", name, array) == OK, self.said
        return [bool(x) if v.type == "Boolean" else x for x in array]

    def enter(self, start: float = 0.0, stop: float | None = None) -> int:
        """Set up the experiment and enter Initialization Mode."""
        self.time = start
        has_stop, stop = stop is not None, stop or 0.0
        if self.fmi == 3:
            return self.call("EnterInitializationMode", False, 0.0, start, has_stop, stop)
        status = self.call("SetupExperiment", 0, 0.0, start, has_stop, stop)
        return status or self.call("EnterInitializationMode")

    def initialize(self, values: dict[str, Any]) -> "Instance":
        """Set start values and go to Step Mode."""
        for name, value in values.items():
            assert self.set(name, value) == OK, self.said
        assert self.enter() == OK, self.said
        assert self.call("ExitInitializationMode") == OK, self.said
        return self

    def step(self, size: float, time: float | None = None) -> int:
        """One communication step; `time` if not where the last one ended."""
        point = self.time if time is None else time
        if self.fmi == 2:
            status = self.call("DoStep", point, size, 1)
        else:
            flags = [ctypes.byref(ctypes.c_bool()) for _ in range(3)]
            status = self.call("DoStep", point, size, True, *flags, ctypes.byref(ctypes.c_double()))
        if status == OK:
            self.time = point + size
        return status

    def save(self) -> ctypes.c_void_p:
        """An FMU state."""
        state = ctypes.c_void_p()
        assert self.call(self._state("Get"), ctypes.byref(state)) == OK, self.said
        return state

    def restore(self, state: ctypes.c_void_p, time: float) -> int:
        """Set an FMU state that was saved at `time`."""
        self.time = time
        return self.call(self._state("Set"), state)

    def free_state(self, state: ctypes.c_void_p) -> int:
        """Free an FMU state."""
        return self.call(self._state("Free"), ctypes.byref(state))

    def serialize(self, state: ctypes.c_void_p) -> bytes:
        """The bytes of an FMU state."""
        return bytes(self.fmu.serializeFMUState(state))

    def deserialize(self, data: bytes) -> tuple[int, ctypes.c_void_p]:
        """Status and FMU state of bytes."""
        state = ctypes.c_void_p()
        name = "DeSerializeFMUstate" if self.fmi == 2 else "DeserializeFMUState"
        buffer = ctypes.create_string_buffer(data, len(data))
        pointer = buffer if self.fmi == 2 else ctypes.cast(buffer, ctypes.POINTER(ctypes.c_uint8))
        return self.call(name, pointer, len(data), ctypes.byref(state)), state

    def _state(self, verb: str) -> str:
        return verb + ("FMUstate" if self.fmi == 2 else "FMUState")

    def free(self) -> None:
        """Free the instance; a new one can be made."""
        self.fmu.fmi2FreeInstance(self.fmu.component) if self.fmi == 2 else (
            self.fmu.fmi3FreeInstance(self.fmu.component)
        )
        self.fmu.component = None

    def names(self, accept: Callable[[Variable], bool]) -> list[str]:
        """Names of the variables that are accepted."""
        return [n for n, v in self.variables.items() if accept(v)]

    def outputs(self) -> dict[str, list[Any]]:
        """Every output and local variable."""
        calculated = self.names(lambda v: v.causality in ("output", "local"))
        return {name: self.get(name) for name in calculated}


# A host that has published nothing has a DDA length of 0; one of 1 to 9 is refused with a message.
REFUSED_BELOW = {"host_dda_length": 10, "host_dda_divider": 1}


def random_inputs(instance: Instance, seed: int, count: int) -> list[dict[str, list[Any]]]:
    """Values for every input at `count` instants, within the limits of the description."""
    random = np.random.default_rng(seed)
    rows = []
    for _ in range(count):
        row: dict[str, list[Any]] = {}
        for name in instance.names(lambda v: v.causality == "input" and v.type != "String"):
            v = instance.variables[name]
            low = REFUSED_BELOW.get(name, -10.0 if v.min is None else v.min)
            high = max(low, 10.0) if v.max is None else v.max
            if v.type == "f64":
                row[name] = random.uniform(low, high, v.count).tolist()
            elif v.type == "i32":
                row[name] = random.integers(int(low), int(high) + 1, v.count).tolist()
            else:
                row[name] = random.integers(0, 2, v.count).astype(bool).tolist()
        rows.append(row)
    return rows


def start_values(name: str, folder: Path) -> dict[str, Any]:
    """Files that an FMU needs to run, by the names of its string parameters."""
    variables = unpacked(name, 3)[2]
    values: dict[str, Any] = {}
    if "program" in variables:
        program = folder / "program.nc"
        program.write_text("G91 G0 X0 Y0\nG1 X5 Y3 F3000\nG2 I2 J0\nM2\n")
        values["program"] = str(program)
    if "file" in variables:
        values["file"] = str(folder / "trace")
    return values


def run(instance: Instance, inputs: list[dict[str, list[Any]]], size: float) -> list[str]:
    """Step through the inputs; all outputs after each step, as text that shows every bit."""
    seen = []
    for row in inputs:
        for name, values in row.items():
            assert instance.set(name, values) == OK, instance.said
        assert instance.step(size) == OK, instance.said
        seen.append(repr(instance.outputs()))
    return seen
