"""How an arm follows its program in a run: its tool beside the way at rest, its joints, torques."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis import linear
from motionfmu.analysis.linear.tuning_parts import linearised
from motionfmu.arm_machines.machine_arm import CONTROLLER
from motionfmu.run import Result
from motionfmu.study.arm_gains.joint_loops import JOINTS, JointLoops

Array = NDArray[np.float64]
# The way at rest is computed at so many commands; between them what sags bends little.
PLACES = 300
# A tool is compared with the way that far before and behind its command [s].
WINDOW = 1.0
# Drives start without torque: the arm sinks until their integrals hold it [s].
SINKING = 1.0
# What no gain changes, and what would hide what gains do: it is off in the runs that are compared.
HIDING = ("lost_motion", "transmission_error_1", "transmission_error_2")


@dataclass(frozen=True)
class ArmFollow:
    """What a run shows."""

    time: Array  # (n,) [s]
    deviation: Array  # (n,) [mm] of the tool from its way at rest
    lag: Array  # (6,) [deg] most that links are behind their commands
    torque: Array  # (6,) largest share of the torque limit
    alarm: bool
    result: Result

    @property
    def rms(self) -> float:
        """Root mean square of the deviation, while the tool is commanded to move [mm]."""
        return float(np.sqrt(np.mean(self.deviation**2)))

    @property
    def max(self) -> float:
        """Largest deviation [mm]."""
        return float(self.deviation.max(initial=0.0))


def signals(loops: JointLoops) -> list[str]:
    """Signals that are read of a run."""
    soft, drives, arm = loops.names[CONTROLLER], loops.drives, loops.arm
    return [
        *(f"{soft}.{n}" for n in ("joint_command", "tool_position")),
        *(f"{drives}.{n}" for n in ("torque", "following_error", "alarm")),
        *(f"{arm}.{n}" for n in ("link_angle", "tool_position")),
    ]


class RestWay:
    """Where the tool would be if the program went infinitely slowly: sag and all."""

    def __init__(self, loops: JointLoops, set_: dict[str, Any], result: Result) -> None:
        command = np.asarray(result[f"{loops.names[CONTROLLER]}.joint_command"])
        axis = linear.model(loops.scenario, 1, set=set_)  # with its lost motion
        parts, p = linearised(axis, loops.arm)
        names = [d.name for d in parts.ode.parameters]
        at = [names.index(f"start_joint[{k}]") for k in JOINTS]
        inputs = [d.name for d in parts.ode.inputs]
        free = [n for n in inputs if n.startswith("torque[")]
        held = [f"motor_phase[{k}]" for k in JOINTS]
        left = {n: 0.0 for n in inputs if n not in free}
        moved = np.abs(np.diff(command, axis=0)).sum(axis=1)
        way = np.concatenate([[0.0], np.cumsum(moved)])
        marks = np.unique(np.searchsorted(way, np.linspace(0.0, way[-1], PLACES)))
        marks = np.unique(np.append(marks, (0, len(command) - 1)))
        rows = []
        for k in marks:
            p[at] = np.degrees(command[k])
            values = parts.rest(p, (held, free), {}, left).values
            rows.append([values[f"tool_position[{i}]"] for i in (1, 2, 3)])
        places = np.array(rows)
        nominal = np.asarray(result[f"{loops.names[CONTROLLER]}.tool_position"])
        aside = places - nominal[marks]
        bent = np.stack([np.interp(way, way[marks], aside[:, i]) for i in range(3)], axis=1)
        self.points: Array = 1e3 * (nominal + bent)  # [mm]

    def distance(self, time: Array, tool: Array) -> Array:
        """Distance (n,) [mm] of tools (n, 3) [mm] from the way about their command."""
        pitch = float(time[1] - time[0])
        span = round(WINDOW / pitch)
        found = np.empty(len(tool))
        for k, place in enumerate(tool):
            low = max(0, k - span)
            part = self.points[low : k + span // 4 + 2]
            found[k] = _beside(part, place)
        return found


def _beside(way: Array, place: Array) -> float:
    """Distance of a place from a chain of straight lines."""
    begin, along = way[:-1], np.diff(way, axis=0)
    square = (along**2).sum(axis=1)
    to = place - begin
    share = np.clip((to * along).sum(axis=1) / np.where(square > 0.0, square, 1.0), 0.0, 1.0)
    return float(np.sqrt(((to - share[:, None] * along) ** 2).sum(axis=1).min()))


def followed(loops: JointLoops, way: RestWay, result: Result) -> ArmFollow:
    """What a run shows beside the way at rest, without the time in which the arm sinks."""
    soft, drives, arm = loops.names[CONTROLLER], loops.drives, loops.arm
    command = np.asarray(result[f"{soft}.joint_command"])
    part = slice(int(np.searchsorted(result.time, SINKING)), None)
    most = np.array(result.parameter(f"{drives}.torque_limit"), dtype=float)
    tool = 1e3 * np.asarray(result[f"{arm}.tool_position"])
    behind = np.asarray(result[f"{arm}.link_angle"]) - command
    return ArmFollow(
        result.time[part],
        way.distance(result.time, tool)[part],
        np.degrees(np.abs(behind[part]).max(axis=0)),
        np.abs(result[f"{drives}.torque"][part]).max(axis=0) / most,
        bool(np.any(result[f"{drives}.alarm"])),
        result,
    )
