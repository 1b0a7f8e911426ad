"""FMUs by FMPy's own classes, step by step: what the other importers are compared with."""

import array
import math
import shutil

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave
from fmpy.ssp.simulation import simulate_ssp
from jobs import Task, main


def coupled(task: Task) -> None:
    """Run a system, of which FMPy shows what follows each step."""
    stop = (task.steps - 0.5) * task.step
    found = simulate_ssp(task.fmu, stop_time=stop, step_size=task.step)
    with task.out.open("wb") as out:
        array.array("d", [math.nan] * len(task.values)).tofile(out)
        for row in found[task.every - 1 :: task.every]:
            array.array("d", [float(row[v.name]) for v in task.values]).tofile(out)


def run(task: Task) -> None:
    """Run one job."""
    if task.ssp:
        coupled(task)
        return
    model = read_model_description(task.fmu, validate=False)
    folder = extract(task.fmu)
    make = FMU2Slave if task.fmi == 2 else FMU3Slave
    slave = make(
        guid=model.guid if task.fmi == 2 else model.instantiationToken,
        unzipDirectory=folder,
        modelIdentifier=model.coSimulation.modelIdentifier,
        instanceName="one",
    )
    groups: dict[str, list[tuple[int, int, int]]] = {}
    width = 0
    for value in task.values:
        groups.setdefault(value.type, []).append((value.reference, width, value.count))
        width += value.count
    plans = [
        (
            getattr(slave, f"get{kind}"),
            [reference for reference, _, _ in rows],
            [place + i for _, place, count in rows for i in range(count)],
        )
        for kind, rows in groups.items()
    ]
    row = array.array("d", [0.0] * width)
    slave.instantiate()
    if task.fmi == 2:
        slave.setupExperiment(startTime=0.0)
        slave.enterInitializationMode()
    else:
        slave.enterInitializationMode(startTime=0.0)
    slave.exitInitializationMode()
    with task.out.open("wb") as out:
        for k in range(task.steps + 1):
            if k:
                slave.doStep((k - 1) * task.step, task.step)
            if k % task.every:
                continue
            for get, references, places in plans:
                sized = {} if task.fmi == 2 else {"nValues": len(places)}
                for place, value in zip(places, get(references, **sized), strict=True):
                    row[place] = value
            row.tofile(out)
    slave.terminate()
    slave.freeInstance()
    shutil.rmtree(folder, ignore_errors=True)


main(run)
