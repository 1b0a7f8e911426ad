"""The engine of FMPy: its `FMU2Slave` and `FMU3Slave` call the FMUs, in the reference master."""

from ctypes import c_void_p
from pathlib import Path
from typing import Any

from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions
from fmpy.fmi3 import FMU3Slave

from motionfmu.run.engines.engine_job import EngineJob
from motionfmu.run.engines.fmu_library import BindingLog, FmuRefusal, Library, Log, read
from motionfmu.run.engines.reference import Master
from motionfmu.run.engines.slave import Slave


class FmpyLibrary(Library):
    """A library that FMPy loads and calls: a slave of FMPy for each instance."""

    def __init__(self, file: Path, fmi: int) -> None:
        self.fmi, self.instance = fmi, c_void_p()
        self._file = file
        self._slave: Any = None

    def function(self, name: str) -> Any:
        """A function of the standard, called through FMPy; its exception becomes a status."""
        # getFloat64() and its like are not used: they make new lists and arrays, which takes five
        # times as long.
        method = getattr(self._slave, f"fmi{self.fmi}{name}")

        def call(*arguments: Any) -> Any:
            try:
                return method(*arguments)
            except FMICallException as told:
                return told.status

        return call

    def instantiate(
        self, name: str, token: str, resources: Path, log: Log, everything: bool = False
    ) -> None:
        """Make a new instance in the place of an older one; it logs errors, or everything."""
        self.release()
        # FMU3Slave finds the library by itself; FMU2Slave does not know every processor's folder.
        self._slave = (FMU3Slave if self.fmi == 3 else FMU2Slave)(
            guid=token,
            modelIdentifier=self._file.stem,
            unzipDirectory=str(resources.parent),
            instanceName=name,
            libraryPath=str(self._file),
        )
        given: dict[str, Any] = {"loggingOn": everything}
        if self.fmi == 3:
            given["logMessage"] = lambda _, status, __, text: log(status, read(text))
        else:
            # FMPy has one logger of FMI 2 for the process, which cannot say whose message it is.
            self._log = BindingLog.to(log)
            given["callbacks"] = fmi2CallbackFunctions.from_buffer(self._log.callbacks())
        try:
            self._slave.instantiate(**given)
        except Exception:  # FMPy has no class of its own for this one
            if self._slave.component:
                raise
            self._slave.freeLibrary()
            self._slave = None
            raise FmuRefusal("instantiate") from None
        self.instance = c_void_p(self._slave.component)

    def release(self) -> None:
        """Free the instance, if there is one, and with it the library."""
        if self._slave is not None:
            self._slave.freeInstance()
            self._slave, self.instance = None, c_void_p()

    def close(self) -> None:
        """Free the instance and the library."""
        self.release()


class FmpySlave(Slave):
    """A co-simulation FMU that FMPy calls."""

    loads = FmpyLibrary


def opened(job: EngineJob) -> Master:
    """Make the engine of a job."""
    return Master(job, "fmpy", FmpySlave)
