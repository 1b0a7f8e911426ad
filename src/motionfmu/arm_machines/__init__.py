"""Arms as machines: a folder that runs from a description, a description from a machine."""

from motionfmu.arm_machines.arm_folder import (
    MadeMachine,
    joint_count,
    make_machine,
    taken_lines,
)
from motionfmu.arm_machines.arm_values import ArmValues, TakenValue
from motionfmu.arm_machines.machine_arm import ArmMachine, arm_machine

__all__ = [
    "ArmMachine",
    "ArmValues",
    "MadeMachine",
    "TakenValue",
    "arm_machine",
    "joint_count",
    "make_machine",
    "taken_lines",
]
