"""What the controller of a scenario, run without its machine, plans of its program."""

import contextlib
import tempfile
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError
from motionfmu.run.engines import lean
from motionfmu.run.engines.slave import Slave
from motionfmu.run.run_plan import Options, RunPlan
from motionfmu.scenarios import fmus
from motionfmu.scenarios.body import PLANNED
from motionfmu.scenarios.system import End, Setting
from motionfmu.scenarios.values import Values, values_in

PROGRAM, FILE = "program", "plan_file"
FMI = 3
# How many times its planned time a program may take on a machine.
LONGER = 2.0


@dataclass(frozen=True)
class Controller:
    """The component of a run that plans its program, and the values that the run sets."""

    name: str
    fmu: str
    given: Mapping[str, Values]  # by ``component.variable``

    def values(self, variable: str) -> Values:
        """One per element."""
        return values_in(self.given, self.name, fmus.ports(self.fmu)[variable])


def controller_of(scenario: RunPlan, set: Mapping[str, Any]) -> Controller:
    """The first component that can plan a program and has one; an InputError if none does."""
    return controller_in(scenario, scenario.resolved(Options(set=set)).settings)


def controller_in(scenario: RunPlan, settings: Iterable[Setting]) -> Controller:
    """The same with the settings of a run."""
    given = {s.end.name: s.values for s in settings}
    for name, fmu in scenario.document.body.component.items():
        plans = fmus.is_ours(fmu) and FILE in fmus.ports(fmu)
        if plans and given.get(f"{name}.{PROGRAM}", ("",)) != ("",):
            return Controller(name, fmu, given)
    raise InputError(f"{scenario.name}: none of its components plans a part program")


def plan_rows(scenario: RunPlan, set: Mapping[str, Any]) -> NDArray[Any]:
    """Rows of the commanded motion, as the FMU writes them; it refuses a program by InputError."""
    system = scenario.resolved(Options(set=set))
    controller = controller_in(scenario, system.settings)
    name, fmu = controller.name, controller.fmu
    ports = fmus.ports(fmu)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "plan.npy"
        slave = Slave(name, lean.unpacked(fmu, FMI), FMI, [])
        try:
            own = [s for s in system.settings if s.end.component == name]
            for s in (*own, Setting(End(name, ports[FILE]), (str(file),))):
                slave.assign(s.end.port.type, s.end.port.reference, s.values)
            slave.initialize()
            slave.start()
        except InputError as error:
            raise scenario.located(error, system, set) from None
        finally:
            slave.free()
        rows: NDArray[Any] = np.load(file, mmap_mode="r").view(np.ndarray)
        return rows  # a file that is mapped stays until it is let go


def bounded(scenario: RunPlan, options: Options) -> Options:
    """The options with the longest run, where that depends on the planned time of the program."""
    if scenario.document.body.limit != PLANNED or options.stop is not None:
        return options
    usual = scenario.stop_limit
    with contextlib.suppress(InputError):  # no part program, or one that the run will refuse
        rows = plan_rows(scenario, options.set)
        if len(rows):
            usual = max(usual, LONGER * float(rows["time"][-1]))
    return replace(options, limit=float(np.ceil(usual)))
