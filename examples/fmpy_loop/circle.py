"""The circle on the card, its drives and axes, by FMPy and numpy alone: a master of one's own.

python circle.py [FMUS [PROGRAM]]: their folder, a part program; writes circle.npz where you stand.
"""

import math
import sys
import tempfile
from pathlib import Path

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi3 import FMU3Slave

root = Path(__file__).resolve().parents[2]
place = Path(sys.argv[1] if len(sys.argv) > 1 else root / "build/fmus")
program = Path(sys.argv[2] if len(sys.argv) > 2 else root / "scenarios/circle/circle.ngc")
step, steps = 1e-4, 80_000  # [s]
fmus = {"mcc": "mcc", "card": "epcio", "drives": "servo_drives", "machine": "ball_screw_axes"}
wires = {  # input: output; * is what the names of both have in common
    "card.host_*": "mcc.card_*",
    "mcc.card_*": "card.*",
    "card.enc_phase": "machine.motor_phase",
    "drives.dac": "card.dac",
    "drives.phase": "machine.motor_phase",
    "machine.torque_command": "drives.torque",
}
given = {f"{name}.active": [True] * 2 + [False] * 4 for name in fmus}
given |= {"mcc.program": [str(program.resolve())], "mcc.p_gain": [200] * 6}
recorded = ["mcc.line", "mcc.path_feed", "mcc.done", "mcc.error"]
recorded += ["card.underflows", "machine.table_position"]

unpacked = tempfile.TemporaryDirectory()  # goes when the script ends
slaves, variables = {}, {}
for name, fmu in fmus.items():
    folder = extract(place / f"{fmu}.fmi3.fmu", Path(unpacked.name, name))
    model = read_model_description(folder)
    variables |= {f"{name}.{v.name}": v for v in model.modelVariables}
    token, library = model.instantiationToken, model.coSimulation.modelIdentifier
    slaves[name] = FMU3Slave(
        guid=token, modelIdentifier=library, unzipDirectory=folder, instanceName=name
    )
    slaves[name].instantiate()


def access(verb, names):
    """FMPy's method for variables of one FMU and type, their references, how many elements."""
    slave = slaves[names[0].partition(".")[0]]
    several = [variables[name] for name in names]
    count = sum(math.prod(int(d.start) for d in v.dimensions) for v in several)
    return getattr(slave, verb + several[0].type), [v.valueReference for v in several], count


groups = {}  # wires of one type between two FMUs are read in one call and written in one
for left, right in wires.items():
    for target in (n for n in variables if n.startswith(left.rstrip("*"))):
        source = right.rstrip("*") + target.removeprefix(left.rstrip("*"))
        if source in variables and variables[target].causality == "input":
            kind = source.partition(".")[0], target.partition(".")[0], variables[source].type
            groups.setdefault(kind, []).append((source, target))
plan = [
    (access("get", [a for a, _ in ends]), access("set", [b for _, b in ends]))
    for ends in groups.values()
]


def exchange():
    """Read all outputs before an input is written, so that no FMU sees the next step of another."""
    found = [get(sources, nValues=count) for (get, sources, count), _ in plan]
    for (_, (put, targets, _)), values in zip(plan, found, strict=True):
        put(targets, values)


for name, values in given.items():
    put, references, _ = access("set", [name])
    put(references, values)
for slave in slaves.values():
    slave.enterInitializationMode()
exchange()
for slave in slaves.values():
    slave.exitInitializationMode()

reads = {name: access("get", [name]) for name in recorded}
trace = {name: np.empty((steps, count)) for name, (_, _, count) in reads.items()}
for k in range(steps):
    exchange()
    for name, (get, references, count) in reads.items():
        trace[name][k] = get(references, nValues=count)
    for slave in slaves.values():
        slave.doStep(k * step, step)
for slave in slaves.values():
    slave.terminate()
    slave.freeInstance()
np.savez("circle.npz", **trace)

# What the checks of the scenario ask: on time, and inside R 50 by the servo lag.
feed, table = trace["mcc.path_feed"][:, 0], trace["machine.table_position"] * 1e3  # [mm/s], [mm]
radius = np.hypot(table[:, 0], table[:, 1])
arcs = np.isin(trace["mcc.line"][:, 0], (6, 8)) & (feed > 99.9)
largest = np.abs(radius[arcs] - 50).max()
print(f"feed {feed[8000:10000].max():.3f} mm/s, largest contour error {largest * 1e3:.1f} µm")
assert trace["mcc.done"][-1, 0] and not trace["mcc.error"].any()
assert not trace["card.underflows"].any()
assert abs(feed[8000:10000].max() - 100) < 0.1 and 0.0440 < largest < 0.0470
