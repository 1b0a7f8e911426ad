"""Poses and a path of a robot, after ISO 9283."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.data_sheet.sheet_runs import SheetMachine, sound
from motionfmu.analysis.iso9283 import (
    CommandPath,
    Cycle,
    Cycles,
    Evaluation,
    analyse,
    pose_performance,
)
from motionfmu.analysis.iso9283.turn import deviation, unit
from motionfmu.base import units
from motionfmu.base.errors import NoNumber
from motionfmu.run.runner import Scenario

Array = NDArray[np.float64]
# Five poses on a diagonal plane of a cube (ISO 9283:1998, 6.8), a tenth of the diagonal inside its
# corners, and a line between two of them, as the standard has it for paths.
SIDE, INSIDE = 400.0, 0.8  # [mm] of the cube; share of its half diagonal
CORNERS = ((0, 0, 0), (-1, -1, 1), (-1, 1, 1), (1, 1, -1), (1, -1, -1))
LINE = (1, 3)  # from the second pose to the fourth
SPEED, PATH_SPEED = 500.0, 250.0  # [mm/s] to poses, along the line
# The standard wants thirty poses; what is simulated repeats itself, and ten tell it as well.
CYCLES, REST = 10, 0.5  # [s] at a pose
# What the controller does while a timer runs, and how long a job may last [s].
WAITING, LONGEST = 3, 600.0
NEEDED = {"points", "status", "tool_position", "tool_quaternion"}


@dataclass(frozen=True)
class RobotSheet:
    """What ISO 9283 says of a robot.

    Attributes
    ----------
    poses : ndarray, shape (5, 3)
        Commanded positions [mm].
    found : Evaluation
        Pose accuracy and repeatability AP and RP of each, path accuracy and repeatability AT and RT
        of the line.
    """

    poses: Array
    found: Evaluation

    @property
    def ap(self) -> float:
        """Largest pose accuracy [mm]."""
        return max(p.AP_P for p in self.found.poses)

    @property
    def rp(self) -> float:
        """Largest pose repeatability [mm]."""
        return max(p.RP_l or 0.0 for p in self.found.poses)

    def numbers(self) -> dict[str, Any]:
        """The same for JSON."""
        told = {"side": SIDE, "cycles": CYCLES, "speed": SPEED, "path_speed": PATH_SPEED}
        told |= {"AP_P": self.ap, "RP_l": self.rp}
        return told | {"commanded": self.poses.tolist()} | self.found.numbers()


def robot_test(tested: SheetMachine) -> RobotSheet | None:
    """Go to the poses and along the line; None if the controller takes no jobs with points."""
    plan = tested.machine.plan()
    soft = (tested.machine.signals.program or "").partition(".")[0]
    if not NEEDED <= plan.resolver.ports.get(soft, {}).keys():
        return None
    arm = _arm(plan, soft)
    names = [f"{soft}.{n}" for n in ("status", "tool_position", "tool_quaternion")]
    names += [f"{arm}.tool_position", f"{arm}.tool_quaternion"]
    record = {"signals": names, "every": 20}
    begun = tested.machine.plan(stop=0.1, set=tested.set, record=record).run(stop=0.1)
    turn = begun[f"{soft}.tool_quaternion"][0]
    length = 1e3 * tested.value(f"{arm}.tool_length")
    flange = _mm(plan, f"{soft}.tool_position", begun[f"{soft}.tool_position"])[0]
    centre = np.round(flange + length * _forward(turn), 1)
    poses = centre + 0.5 * SIDE * INSIDE * np.array(CORNERS)
    (tested.folder / "iso9283.points").write_text(_points(poses, turn, length), encoding="utf-8")
    scenario = _job(tested, soft, record)
    result = sound(scenario.run(), "iso9283.job")
    rests = _rests(result.time, result[f"{soft}.status"])
    if len(rests) != CYCLES * (len(poses) + 2):
        raise NoNumber(f"iso9283.job: {len(rests)} rests instead of {CYCLES * (len(poses) + 2)}")
    tool = _mm(plan, f"{arm}.tool_position", result[f"{arm}.tool_position"])
    turns = result[f"{arm}.tool_quaternion"]
    ends = rests[: CYCLES * len(poses), 1].reshape(CYCLES, len(poses))
    command = np.tile(turn, (len(poses), 1))
    reached = pose_performance(tool[ends], poses, turns[ends], command)
    ways = [slice(a, b + 1) for a, b in _ways(rests[CYCLES * len(poses) :])]
    cycles = [Cycle(result.time[w], tool[w], turns[w]) for w in ways]
    path = CommandPath.of(poses[list(LINE)], command[: len(LINE)])
    try:
        line = analyse(Cycles(cycles, path, PATH_SPEED))
    except ValueError as error:
        raise NoNumber(f"iso9283.job: {error}") from None
    return RobotSheet(poses, Evaluation(line, reached))


def _arm(plan: Scenario, soft: str) -> str:
    """The component that shows where the tool is and knows how long it is."""
    wanted = {"tool_position", "tool_quaternion", "tool_length"}
    found = [c for c, ports in plan.resolver.ports.items() if c != soft and wanted <= ports.keys()]
    if not found:
        raise NoNumber(f"no component shows {', '.join(sorted(wanted))}")
    return found[0]


def _mm(plan: Scenario, name: str, values: Array) -> Array:
    unit = units.parse(plan.resolver.end(name, "signals", name).port.unit or "1")
    return np.asarray(values * (unit.factor / units.parse("mm").factor))


def _points(poses: Array, turn: Array, length: float) -> str:
    """The points file: tool 1 and the poses."""
    a, b, c = deviation(unit(turn), np.array([1.0, 0.0, 0.0, 0.0]))
    lines = [f"TOOL 1 X=0 Y=0 Z={length:g} A=0 B=0 C=0"]
    lines += [
        f"P{k:03d} X={x:.3f} Y={y:.3f} Z={z:.3f} A={a:.6f} B={b:.6f} C={c:.6f} TOOL=1"
        for k, (x, y, z) in enumerate(poses, 1)
    ]
    return "\n".join([*lines, ""])


def _job(tested: SheetMachine, soft: str, record: dict[str, Any]) -> Scenario:
    """The job: all poses ten times, then the line ten times."""
    timer = f"TIMER T={REST:.2f}"
    first, last = (f"P{k + 1:03d}" for k in LINE)
    # Each pose is approached from the same side in all cycles.
    lines = ["//ISO9283", f"MOVL P{len(CORNERS):03d} V={SPEED:.1f} PL=0", f"LOOP {CYCLES}"]
    for k in range(1, len(CORNERS) + 1):
        lines += [f"MOVL P{k:03d} V={SPEED:.1f} PL=0", timer]
    lines += ["ENDLOOP", f"MOVL {last} V={SPEED:.1f} PL=0", f"LOOP {CYCLES}"]
    lines += [f"MOVL {first} V={SPEED:.1f} PL=0", timer]
    lines += [f"MOVL {last} V={PATH_SPEED:.1f} PL=0", timer, "ENDLOOP", "END", ""]
    file = tested.folder / "iso9283.job"
    file.write_text("\n".join(lines), encoding="utf-8")
    points = {f"{soft}.points": str(tested.folder / "iso9283.points")}
    return tested.machine.scenario(file, limit=LONGEST, set={**tested.set, **points}, record=record)


def _rests(time: Array, status: NDArray[np.int32]) -> NDArray[np.intp]:
    """First and last sample of each wait for a timer (n, 2)."""
    edges = np.flatnonzero(np.diff(np.r_[False, status == WAITING, False])).reshape(-1, 2)
    edges[:, 1] -= 1
    return edges[time[edges[:, 1]] - time[edges[:, 0]] > 0.5 * REST]


def _ways(rests: NDArray[np.intp]) -> list[tuple[int, int]]:
    """From the end of each rest at the begin of the line to the end of the next."""
    return [(int(a[1]), int(b[1])) for a, b in zip(rests[::2], rests[1::2], strict=True)]


def _forward(q: Array) -> Array:
    """The z axis of a frame with this orientation, in base axes."""
    w, x, y, z = unit(q)
    return np.array([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])
