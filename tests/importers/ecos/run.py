"""FMUs by ecos, through its Python package."""

import array
import ctypes
import math
from typing import Any

from jobs import Task, main, packages

# ecos comes without the library of threads that it needs.
ctypes.CDLL(str(packages() / "lib" / "libtbb.so.12"), mode=ctypes.RTLD_GLOBAL)

from ecospy import EcosLib, EcosSimulation, EcosSimulationStructure  # noqa: E402

KINDS = {
    "Real": "real",
    "Float64": "real",
    "Float32": "real",
    "Integer": "integer",
    "Int32": "integer",
    "Boolean": "bool",
}


def run(task: Task) -> str | None:
    """Run one job."""
    if unknown := {v.type for v in task.values} - set(KINDS):
        return f"it does not read {', '.join(sorted(unknown))}"
    if task.ssp:
        with EcosSimulation(ssp_path=task.fmu, step_size=task.step) as simulation:
            return through(task, simulation, [v.name.replace(".", "::", 1) for v in task.values])
    with EcosSimulationStructure() as structure:
        structure.add_model("one", task.fmu)
        with EcosSimulation(structure=structure, step_size=task.step) as simulation:
            return through(task, simulation, [f"one::{v.name}" for v in task.values])


def through(task: Task, simulation: Any, names: list[str]) -> str | None:
    """Step through a job; an array of FMI 3 is asked for as one number, so it stays blank."""
    simulation.init()
    read = [
        (getattr(simulation, f"get_{KINDS[v.type]}"), v, name)
        for v, name in zip(task.values, names, strict=True)
    ]
    with task.out.open("wb") as out:
        for k in range(0, task.steps + 1, task.every):
            if k:
                simulation.step(task.every)
            row = array.array("d")
            for get, v, name in read:
                row.extend([float(get(name))] if v.count == 1 else [math.nan] * v.count)
            row.tofile(out)
    simulation.terminate()
    arrays = [v.count > 1 for v in task.values]
    if all(arrays):
        return "it ran, but reads no array, and all outputs are arrays"
    return "ok\tof what is no array" if any(arrays) else None


EcosLib.set_log_level("off")
main(run)
