"""A joint trajectory as a job of a robot's controller."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError
from motionfmu.run.joint_trajectory import JointTrajectory

Array = NDArray[np.float64]
MOST = 16000  # points, of the positions and instructions that a job has
STILL = 1e-9  # [rad] a joint that goes no farther rests
SLOWEST = 0.01  # [%] VJ
SPARE = 1e-6  # share by which a joint may seem faster than its limit, by rounding
LONGEST = 655.35  # [s] of a TIMER
CORNER = 1  # PL of a point that is passed


@dataclass(frozen=True)
class TrajectoryJob:
    """The text of a job, the line of the trajectory's file of each of its lines, what is told."""

    text: str
    lines: list[int]
    notes: tuple[str, ...]


def job_of(
    trajectory: JointTrajectory, file: Path, axes: Sequence[str], speeds: Array
) -> TrajectoryJob:
    """The job that takes the joints from point to point in their times; speeds in deg/s."""
    order, notes = _order(trajectory.joints, file, axes)
    joints = np.degrees(trajectory.position[:, order])
    if len(joints) > MOST:
        told = f"{len(joints)} points, at most {MOST} fit a job"
        raise InputError(f"{file}: line {trajectory.lines[MOST]}: {told}")
    head = ["//NAME TRAJECTORY", "//POS", "///POSTYPE JOINT"]
    text = head + [f"C{k:05d}=" + ",".join(f"{x:.9f}" for x in q) for k, q in enumerate(joints)]
    text += ["//INST", "MOVJ C00000"]
    lines = [trajectory.lines[0]] * len(head) + trajectory.lines + [trajectory.lines[0]] * 2
    passed = _passed(trajectory)
    for k in range(1, len(joints)):
        spent = trajectory.time[k] - trajectory.time[k - 1]
        way = np.abs(joints[k] - joints[k - 1])
        place = f"{file}: line {trajectory.lines[k]}: point {k}"
        _refuse_fast(way, spent, speeds, axes, place)
        done = _segment(k, way, spent, speeds, passed[k])
        text += done
        lines += [trajectory.lines[k]] * len(done)
    notes.append("the first point is gone to at the controller's own speed, the times count there")
    return TrajectoryJob("\n".join((*text, "END")) + "\n", [*lines, lines[-1]], tuple(notes))


def _order(joints: Sequence[str], file: Path, axes: Sequence[str]) -> tuple[list[int], list[str]]:
    """The column of each axis: by its name, or as they stand if no name is an axis'."""
    if len(joints) != len(axes):
        told = f"{len(joints)} joints ({', '.join(joints)}), the machine has {len(axes)}"
        raise InputError(f"{file}: {told}: {', '.join(axes)}")
    if set(joints) == set(axes):
        return [list(joints).index(name) for name in axes], []
    if known := set(joints) & set(axes):
        strange = [name for name in joints if name not in known]
        raise InputError(f"{file}: joint {strange[0]!r}: {', '.join(axes)} wanted, or other names")
    pairs = ", ".join(f"{name} is {axis}" for name, axis in zip(joints, axes, strict=True))
    return list(range(len(axes))), [f"joints as they stand: {pairs}"]


def _passed(trajectory: JointTrajectory) -> list[bool]:
    """Whether each point is passed in motion: not the last, none whose velocities are all 0."""
    count = len(trajectory.time)
    moving = [True] * count
    if trajectory.velocity is not None:
        moving = [bool(row.any()) for row in trajectory.velocity]
    return [moving[k] and k + 1 < count for k in range(count)]


def _segment(k: int, way: Array, spent: float, speeds: Array, passed: bool) -> list[str]:
    """Lines that take the joints a way [deg] to point k in a time [s], none faster than that."""
    if way.max() <= np.degrees(STILL):
        whole, rest = divmod(spent, LONGEST)
        return [f"TIMER T={t:.9f}" for t in [LONGEST] * int(whole) + [rest]]
    percent = min(100.0, max(SLOWEST, 100.0 * float((way / (speeds * spent)).max())))
    return [f"MOVJ C{k:05d} VJ={percent:.6f} PL={CORNER if passed else 0}"]


def _refuse_fast(way: Array, spent: float, speeds: Array, axes: Sequence[str], place: str) -> None:
    """Refuse a joint that is asked to be faster than its limit."""
    share = way / (speeds * spent)
    fast = int(share.argmax())
    if share[fast] > 1.0 + SPARE:
        told = f"{axes[fast]} at {way[fast] / spent:.6g} °/s, its limit is {speeds[fast]:.6g} °/s"
        raise InputError(f"{place}: {told}")
