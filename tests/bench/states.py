"""What it costs to save and restore an FMU, for masters that go back."""

import ctypes
import time

from medians import Medians

from motionfmu.run.engines import lean
from motionfmu.run.engines.slave import Slave

CALLS = 2000


class States:
    """An FMU at rest: bytes of its state, time of a call that saves or restores it [s]."""

    def __init__(self, fmu: str) -> None:
        self._slave = Slave(fmu, lean.unpacked(fmu, 3), 3, [], logging=False)
        self._slave.initialize()
        self._slave.start()
        library = self._slave._library
        component = library.instance
        get, put = library.function("GetFMUState"), library.function("SetFMUState")
        self._state, size = ctypes.c_void_p(), ctypes.c_size_t()
        self._save = lambda: get(component, ctypes.byref(self._state))
        self._restore = lambda: put(component, self._state)
        if self._save() or self._restore():
            raise RuntimeError(f"{fmu}: its state is not saved and restored")
        library.call("SerializedFMUStateSize", self._state, ctypes.byref(size))
        self.size, self.rounds = size.value, Medians()

    def __call__(self) -> None:
        """Time both again; a call from Python is in it, 0.2 us."""
        for name in ("save", "restore"):
            call = getattr(self, f"_{name}")
            begin = time.process_time()
            for _ in range(CALLS):
                call()
            self.rounds.add(name, (time.process_time() - begin) / CALLS)
