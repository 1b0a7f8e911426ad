"""The joints of a robot's run as a joint trajectory."""

import numpy as np

from motionfmu.base.errors import InputError
from motionfmu.run.joint_trajectory import thinned, trajectory_text
from motionfmu.run.result import Result
from motionfmu.run.runner import Scenario

COMMAND = ".joint_command"  # of a robot's controller [rad]
TOLERANCE = 1e-4  # [rad] by which a straight line over time leaves no sample


def refuse_unrecorded(scenario: Scenario) -> None:
    """Refuse a run that will have no commanded joints, before it begins."""
    asked = scenario.document.body.record.signals
    if not any(name.endswith(COMMAND) or "*" in name for name in asked):
        raise InputError(f"{scenario.name}: [record] signals has no commanded joints (*{COMMAND})")


def recorded_trajectory(result: Result) -> str:
    """The commanded joints of a run as CSV: as few samples as tell the others."""
    found = [name for name in result.signals if name.endswith(COMMAND)]
    if not found:
        raise InputError(f"{result.name}: no commanded joints (*{COMMAND}) are recorded")
    position = np.asarray(result[found[0]], dtype=float)
    time = np.asarray(result.time, dtype=float) - float(result.time[0])
    names = [axis.name for axis in result.scenario.document.axes]
    if len(names) != position.shape[1]:
        names = [f"joint_{i + 1}" for i in range(position.shape[1])]
    kept = thinned(time, position, TOLERANCE)
    return trajectory_text(names, time[kept], position[kept])
