"""One FMU opened with FMPy, with fast access to its variables."""

import ctypes
import re
import shutil
import tempfile
from collections.abc import Callable, Iterable
from ctypes import byref
from pathlib import Path
from typing import Any

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.fmi3 import FMU3Slave
from fmpy.logging import addLoggerProxy

from motionfmu.errors import InputError
from motionfmu.fmu import describe
from motionfmu.run.engines import messages
from motionfmu.run.engines.ending import Ending
from motionfmu.scenarios.system import End, System

_C = {"Float64": ctypes.c_double, "Float32": ctypes.c_float, "Boolean": ctypes.c_bool} | {
    f"{sign}Int{bits}": getattr(ctypes, f"c_{sign.lower()}int{bits}")
    for sign in ("", "U")
    for bits in (8, 16, 32, 64)
}
_FMI2 = {"Float64": "Real", "Int32": "Integer", "Boolean": "Boolean", "String": "String"}
# fmucontainer puts "mcc.fmu: " before the message of a component, which may name itself again.
_INNER = re.compile(r"^(\w+)\.fmu: (?:(?:\w+\.)*\w+\.fmu: |\1: )?")


def element_names(end: End) -> list[str]:
    """FMI 2 names of the elements of a port, in order."""
    return describe.element_names(end.port.name, end.port.shape)


def exposed(end: End, fmi: int) -> list[str]:
    """Names of a port in a container, by element in FMI 2."""
    return [end.port.name] if fmi == 3 else element_names(end)


class Slave:
    """A co-simulation FMU of either version, from an .fmu or a folder that holds an unpacked one.

    `errors` receives what the FMU logs with a status of Error or worse; `warnings` holds what it
    or the FMUs inside warned of, each once, as ``component: what``; without `logging`
    there are errors only.
    """

    def __init__(
        self, name: str, source: Path, fmi: int, errors: list[str], logging: bool = True
    ) -> None:
        self.name, self.fmi, self.errors, self._logging = name, fmi, errors, logging
        self.warnings: list[str] = []
        self._own: str | None = None
        if source.is_dir():
            folder = str(source)
        else:
            folder = self._own = tempfile.mkdtemp(prefix="motionfmu-")
            extract(str(source), folder)
        self.description = read_model_description(folder, validate=False)
        cosimulation = self.description.coSimulation
        assert cosimulation, "every FMU here is made for co-simulation"
        self.references = {v.name: v.valueReference for v in self.description.modelVariables}
        keys = {
            "guid": self.description.guid or self.description.instantiationToken,
            "unzipDirectory": folder,
            "modelIdentifier": cosimulation.modelIdentifier,
            "instanceName": name,
        }
        self.slave: Any = FMU3Slave(**keys) if fmi == 3 else FMU2Slave(**keys)
        self._instantiate()

    def _instantiate(self) -> None:
        if self.fmi == 3:
            self._do("instantiate", logMessage=self._log3, loggingOn=self._logging)
            return
        callbacks = fmi2CallbackFunctions()
        self._log = fmi2CallbackLoggerTYPE(self._log2)
        callbacks.logger = self._log
        addLoggerProxy(byref(callbacks))  # formats the message; Python cannot
        self._do("instantiate", callbacks=callbacks, loggingOn=self._logging)

    def _log3(self, environment: Any, status: int, category: bytes, message: bytes) -> None:
        self._keep(status, message)

    def _log2(self, environment: Any, name: Any, status: int, category: Any, text: Any) -> None:
        told = text if isinstance(text, bytes) else str(text).encode()
        if messages.unnamed(told.decode(errors="replace")) and b".fmu: " not in told:
            told = name + b": " + told
        self._keep(status, told)

    def _keep(self, status: int, message: bytes) -> None:
        """Keep an error or a warning; one from inside a container gets its component's name."""
        if status >= messages.WARNING:
            text = _INNER.sub(r"\1: ", message.decode(errors="replace").strip())
            messages.keep(status, text, self.errors, self.warnings)

    def _do(self, call: str, **arguments: Any) -> None:
        """Call a method of FMPy's slave; what it raises becomes the FMU's own message."""
        try:
            getattr(self.slave, call)(**arguments)
        except Exception as error:
            raise self.failure(call) from error

    def failure(self, call: str) -> InputError:
        """The error for a call that failed: what the first component to tell one says."""
        return messages.failure(self.name, call, self.errors)

    def buffer(self, kind: str, count: int) -> Any:
        """Memory for values of Float64, Int32 or Boolean, as the FMU has them."""
        c: Any = ctypes.c_int32 if self.fmi == 2 and kind == "Boolean" else _C[kind]
        return (c * count)()

    def access(self, verb: str, kind: str, reference: int, buffer: Any, *further: int) -> Any:
        """A function without arguments that gets or sets one variable through its buffer.

        The verb is ``Get`` or ``Set``; the function raises InputError when the FMU refuses. The
        buffer may hold the values of further variables, one after the other.
        """
        count = len(buffer)
        if self.fmi == 3:
            call = getattr(self.slave.dll, f"fmi3{verb}{kind}")
            all_of = (ctypes.c_uint32 * (1 + len(further)))(reference, *further)
            sizes = ctypes.c_size_t(len(all_of)), ctypes.c_size_t(count)
            arguments: tuple[Any, ...] = (self.slave.component, all_of, sizes[0], buffer, sizes[1])
        else:
            call = getattr(self.slave.dll, f"fmi2{verb}{_FMI2[kind]}")
            listed = (reference, *further) if further else range(reference, reference + count)
            references = (ctypes.c_uint32 * count)(*listed)
            arguments = (self.slave.component, references, ctypes.c_size_t(count), buffer)

        def run() -> None:
            if call(*arguments) >= messages.ERROR:
                raise self.failure(f"{verb}{kind}")

        return run

    def assign(self, kind: str, reference: int, values: Iterable[Any]) -> None:
        """Set a variable of any kind, by its first reference, once."""
        listed = list(values)
        if kind == "String":
            references = (
                [reference] if self.fmi == 3 else [*range(reference, reference + len(listed))]
            )
            self._do("setString", vr=references, **{"values" if self.fmi == 3 else "value": listed})
            return
        buffer = self.buffer(kind, len(listed))
        buffer[:] = listed
        self.access("Set", kind, reference, buffer)()

    def initialize(self) -> None:
        """Enter Initialization Mode at time 0."""
        if self.fmi == 2:
            self._do("setupExperiment", startTime=0.0)
            self._do("enterInitializationMode")
        else:
            self._do("enterInitializationMode", startTime=0.0)

    def start(self) -> None:
        """Leave Initialization Mode."""
        self._do("exitInitializationMode")

    def step(self, time: float, size: float) -> None:
        """Advance from a communication point by one step [s]."""
        self._do("doStep", currentCommunicationPoint=time, communicationStepSize=size)

    def stepper(self, size: float) -> Callable[[float], None]:
        """A quick `step` of one size [s]: a function of the communication point [s]."""
        call = getattr(self.slave.dll, f"fmi{self.fmi}DoStep")
        instance, length = self.slave.component, ctypes.c_double(size)
        if self.fmi == 3:
            flags = [byref(ctypes.c_bool()) for _ in range(3)]
            rest: tuple[Any, ...] = (ctypes.c_bool(True), *flags, byref(ctypes.c_double()))
        else:
            rest = (ctypes.c_int(1),)

        def advance(time: float) -> None:
            if call(instance, ctypes.c_double(time), length, *rest) >= messages.ERROR:
                raise self.failure("doStep")

        return advance

    def end(self) -> None:
        """Terminate: the FMU writes its files."""
        self._do("terminate")

    def renew(self) -> None:
        """Take a new instance; the library stays loaded."""
        old, self.slave.component = self.slave.component, None
        if old:
            getattr(self.slave, f"fmi{self.fmi}FreeInstance")(old)
        self.errors.clear()
        self.warnings.clear()
        self._instantiate()

    def free(self) -> None:
        """Free the instance, the library and the unpacked files."""
        try:
            if self.slave.component:
                self.slave.freeInstance()
            else:
                self.slave.freeLibrary()
        finally:
            if self._own:
                shutil.rmtree(self._own, ignore_errors=True)


def ending_of(container: Slave, system: System, fmi: int) -> Ending:
    """Where a container's run ends; the signal is one of its outputs. `fmi` is that of our FMUs."""
    if system.until is None:
        return Ending(system)
    end = system.until.end
    inner = exposed(end, system.version(end.component, fmi))
    names = (f"{end.component}.{n}" for n in inner)
    first, *further = (container.references[n] for n in names)
    values = container.buffer(end.port.type, end.port.count)
    return Ending(system, container.access("Get", end.port.type, first, values, *further), values)
