"""FMUs by libcosim, through its Python package."""

import array
import math

from jobs import Task, main, packages

packages()

from libcosimpy.CosimEnums import CosimExecutionState  # noqa: E402
from libcosimpy.CosimExecution import CosimExecution  # noqa: E402
from libcosimpy.CosimLogging import CosimLogLevel, log_output_level  # noqa: E402
from libcosimpy.CosimObserver import CosimObserver  # noqa: E402
from libcosimpy.CosimSlave import CosimLocalSlave  # noqa: E402

NS = 1e9


def run(task: Task) -> str | None:
    """Run one job; libcosim shows values after its first step only."""
    if task.ssp:
        execution = CosimExecution.from_ssp_file(task.fmu, round(task.step * NS))
        slaves = [
            execution.slave_index_from_instance_name(v.name.partition(".")[0]) for v in task.values
        ]
    else:
        execution = CosimExecution.from_step_size(round(task.step * NS))
        slaves = [execution.add_local_slave(CosimLocalSlave(task.fmu, "one"))] * len(task.values)
    if any(slave is None or slave < 0 for slave in slaves):
        return "a slave was refused"
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer)
    get = {
        "Real": observer.last_real_values,
        "Integer": observer.last_integer_values,
        "Boolean": observer.last_boolean_values,
    }
    groups: dict[tuple[str, int], tuple[list[int], list[int]]] = {}
    for place, (slave, value) in enumerate(zip(slaves, task.values, strict=True)):
        references, places = groups.setdefault((value.type, slave), ([], []))
        references.append(value.reference)
        places.append(place)
    row = array.array("d", [math.nan] * len(task.values))
    with task.out.open("wb") as out:
        row.tofile(out)
        for k in range(task.every, task.steps + 1, task.every):
            execution.step(task.every)
            if execution.status().state == CosimExecutionState.ERROR:
                return f"step {k} failed"
            for (kind, slave), (references, places) in groups.items():
                for place, x in zip(places, get[kind](slave, references), strict=True):
                    row[place] = x
            row.tofile(out)
    return None


log_output_level(CosimLogLevel.ERROR)
main(run)
