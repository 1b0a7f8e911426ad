"""What the controller of a scenario, run without its machine, plans of its program."""

import contextlib
import tempfile
from collections.abc import Mapping
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError
from motionfmu.run import engines
from motionfmu.run.execution import Execution
from motionfmu.run.run_plan import Options, RunPlan
from motionfmu.scenarios import fmus
from motionfmu.scenarios.body import PLANNED
from motionfmu.scenarios.document import made
from motionfmu.scenarios.values import Values, values_in

PROGRAM, FILE = "program", "plan_file"
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
    given = {s.end.name: s.values for s in scenario.resolved(Options(set=set)).settings}
    for name, fmu in scenario.document.body.component.items():
        plans = fmus.is_ours(fmu) and FILE in fmus.ports(fmu)
        if plans and given.get(f"{name}.{PROGRAM}", ("",)) != ("",):
            return Controller(name, fmu, given)
    raise InputError(f"{scenario.name}: none of its components plans a part program")


def plan_rows(scenario: RunPlan, set: Mapping[str, Any]) -> NDArray[Any]:
    """Rows of the commanded motion, as the FMU writes them; it refuses a program by InputError."""
    found = controller_of(scenario, set)
    ports = fmus.ports(found.fmu)
    own = {n: v for n, v in found.given.items() if n.partition(".")[0] == found.name}
    values = {n: list(v) if ports[n.partition(".")[2]].shape else v[0] for n, v in own.items()}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        file = folder / "plan.npy"
        tables = {
            "component": {found.name: found.fmu},
            "step": 1e-3,
            "stop": 1e-3,
            "record": {"signals": [f"{found.name}.done"]},
            "leave": [f"{found.name}.*"],
            "set": values | {f"{found.name}.{FILE}": str(file)},
        }
        alone = RunPlan(made(tables, scenario.name, Path.cwd(), ""))
        options = Options(engine="python")  # the quickest to open
        execution = Execution.plan(alone, options, alone.ends, folder)
        with closing(engines.opened("python", execution.job(options.fmi))) as ready:
            execution.run(lambda system: ready.run(system, options.progress), options)
        return np.load(file)


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
