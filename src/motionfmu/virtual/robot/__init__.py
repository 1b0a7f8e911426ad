"""A robot's soft controller, its card and its kinematics, from Python.

The same C code as in the FMUs; see robot_controller/README.md and robot_station/README.md in
src/controllers.
Lengths are mm and angles deg, as in programs; joints are numbered from 0. Poses are X Y Z A B C
with R = Rz(C) Ry(B) Rx(A), or 4x4 matrices.
"""

from motionfmu.base.binding import CLOCK_HZ, Station
from motionfmu.virtual.robot.kinematics import Kinematics, matrix_of, pose_of
from motionfmu.virtual.robot.refusal import RobotError
from motionfmu.virtual.robot.virtual_robot import (
    BASE,
    DELAY,
    ERROR,
    HOLD,
    IDLE,
    JOG,
    JOINTS,
    PAUSED,
    RUNNING,
    STOPPED,
    TOOL,
    WAITING,
    RobotReading,
    VirtualRobot,
    defaults,
)

__all__ = [
    "BASE",
    "CLOCK_HZ",
    "DELAY",
    "ERROR",
    "HOLD",
    "IDLE",
    "JOG",
    "JOINTS",
    "PAUSED",
    "RUNNING",
    "STOPPED",
    "TOOL",
    "WAITING",
    "Kinematics",
    "RobotError",
    "RobotReading",
    "Station",
    "VirtualRobot",
    "defaults",
    "matrix_of",
    "pose_of",
]
