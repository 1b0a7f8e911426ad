"""FMUs by ecos, through its Python package."""

import array
import ctypes

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
    if any(v.count > 1 for v in task.values):
        return "it reads no arrays of FMI 3"
    with EcosSimulationStructure() as structure:
        structure.add_model("one", task.fmu)
        with (
            EcosSimulation(structure=structure, step_size=task.step) as simulation,
            task.out.open("wb") as out,
        ):
            simulation.init()
            read = [
                (getattr(simulation, f"get_{KINDS[v.type]}"), f"one::{v.name}") for v in task.values
            ]
            for k in range(task.steps + 1):
                if k:
                    simulation.step(1)
                array.array("d", [float(get(name)) for get, name in read]).tofile(out)
            simulation.terminate()
    return None


EcosLib.set_log_level("off")
main(run)
