"""One FMU, from its archive or unpacked, with fast access to its variables."""

import contextlib
import re
import shutil
import tempfile
import zipfile
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from motionfmu.base.errors import InputError
from motionfmu.base.platforms import here
from motionfmu.fmu import describe
from motionfmu.run.engines import fmu_messages
from motionfmu.run.engines.ending import Ending
from motionfmu.run.engines.fmu_library import FmuRefusal, Library, ValuePlace
from motionfmu.scenarios.system import End, System

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

    `errors` receives messages of the FMU with status Error or worse. `warnings` holds its warnings,
    and those of FMUs inside it, each once, as ``component: what``. Without `logging` there are
    errors only.
    """

    loads = Library

    def __init__(
        self, name: str, source: Path, fmi: int, errors: list[str], logging: bool = True
    ) -> None:
        self.name, self.fmi, self.errors, self._logging = name, fmi, errors, logging
        self.warnings: list[str] = []
        self._own: Path | None = None
        if not source.is_dir():
            self._own = Path(tempfile.mkdtemp(prefix="motionfmu-"))
            with zipfile.ZipFile(source) as archive:
                archive.extractall(self._own)
        self._folder = self._own or source
        root = ElementTree.parse(self._folder / "modelDescription.xml").getroot()
        kind = root.find("CoSimulation")
        assert kind is not None, "every FMU here is made for co-simulation"
        self._token = root.get("guid") or root.get("instantiationToken") or ""
        rows = root.iterfind("ModelVariables/*")
        self.references = {row.attrib["name"]: int(row.attrib["valueReference"]) for row in rows}
        machine = here()
        file = f"binaries/{machine.folder(fmi)}/{kind.attrib['modelIdentifier']}{machine.suffix}"
        self._library = self.loads(self._folder.absolute() / file, fmi)
        self._instantiate()

    def _instantiate(self) -> None:
        place = self._folder.absolute() / "resources"
        with self._told():
            self._library.instantiate(self.name, self._token, place, self._log, self._logging)

    def _log(self, status: int, told: str) -> None:
        if self.fmi == 2 and fmu_messages.unnamed(told) and ".fmu: " not in told:
            told = f"{self.name}: {told}"
        self._keep(status, told)

    def _keep(self, status: int, message: str) -> None:
        """Keep an error or a warning; one from inside a container is named by its component."""
        if status >= fmu_messages.WARNING:
            text = _INNER.sub(r"\1: ", message.strip())
            fmu_messages.keep(status, text, self.errors, self.warnings)

    @contextlib.contextmanager
    def _told(self) -> Iterator[None]:
        """Raise the FMU's own message in place of the library's refusal."""
        try:
            yield
        except FmuRefusal as refused:
            raise self.refusal(str(refused)) from None

    def refusal(self, call: str) -> InputError:
        """The error for a call that failed: the message of the first component that gave one."""
        return fmu_messages.failure(self.name, call, self.errors)

    def _telling(self, call: Callable[..., None]) -> Callable[..., None]:
        """The function with the effect of `_told`, whose context takes longer than the call."""

        def run(*arguments: Any) -> None:
            try:
                call(*arguments)
            except FmuRefusal as refused:
                raise self.refusal(str(refused)) from None

        return run

    def buffer(self, kind: str, count: int) -> Any:
        """Memory for values of a numeric type, laid out as the FMU has them."""
        return self._library.buffer(kind, count)

    def access(self, verb: str, kind: str, reference: int, buffer: Any, *further: int) -> Any:
        """A function without arguments that gets or sets one variable through its buffer.

        The verb is ``Get`` or ``Set``; the function raises InputError when the FMU refuses. The
        buffer may hold the values of further variables, one after the other.
        """
        count = 1 if further else len(buffer)
        several = [ValuePlace(kind, r, count) for r in (reference, *further)]
        return self._telling(self._library.access(verb, several, buffer))

    def address(self, name: str) -> tuple[Any, Any]:
        """Addresses of an FMI function, named without its version, and of the instance."""
        return self._library.address(name), self._library.instance.value

    def assign(self, kind: str, reference: int, values: Iterable[Any]) -> None:
        """Set a variable of any kind, by its first reference, once."""
        listed = list(values)
        with self._told():
            self._library.set([(ValuePlace(kind, reference, len(listed)), listed)])

    def initialize(self, time: float = 0.0) -> None:
        """Enter Initialization Mode at a time [s]."""
        with self._told():
            self._library.enter(time)

    def start(self) -> None:
        """Leave Initialization Mode."""
        with self._told():
            self._library.leave()

    def step(self, time: float, size: float) -> None:
        """Advance from a communication point by one step [s]."""
        self.stepper(size)(time)

    def stepper(self, size: float) -> Callable[[float], None]:
        """A quick `step` of one size [s]: a function of the communication point [s]."""
        return self._telling(self._library.stepper(size))

    def end(self) -> None:
        """Terminate: the FMU writes its files."""
        with self._told():
            self._library.terminate()

    def share(self, warnings: list[str]) -> None:
        """Keep warnings in a list that other FMUs fill, too, in the order in which all warn."""
        warnings += self.warnings
        self.warnings = warnings

    def renew(self) -> None:
        """Take a new instance; the library stays loaded."""
        self._library.release()
        self.errors.clear()
        self.warnings.clear()
        self._instantiate()

    def free(self) -> None:
        """Free the instance, the library and the unpacked files."""
        try:
            self._library.close()
        finally:
            if self._own:
                shutil.rmtree(self._own, ignore_errors=True)


def ending_of(container: Slave, system: System, fmi: int) -> Ending:
    """The `Ending` of a container's run, of which the signals are outputs.

    Its parts that are ours have FMI version `fmi`, by which elements of arrays are named.
    """
    read = []
    for end in system.ending:
        inner = exposed(end, system.version(end.component, fmi))
        names = (f"{end.component}.{n}" for n in inner)
        first, *further = (container.references[n] for n in names)
        values = container.buffer(end.port.type, end.port.count)
        read.append((container.access("Get", end.port.type, first, values, *further), values))
    return Ending(system, read)
