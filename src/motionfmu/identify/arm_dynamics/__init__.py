"""From a record of an arm to its base parameters, its friction and its gears."""

from types import ModuleType
from typing import TYPE_CHECKING

from motionfmu.base.extras import at_first_use

if TYPE_CHECKING:
    from motionfmu.identify.arm_dynamics.arm_identification import IdentifiedArm, identify_arm
    from motionfmu.identify.arm_dynamics.arm_options import ArmColumn, ArmOptions
    from motionfmu.identify.arm_dynamics.arm_run import HeldArm, held_arm

__all__ = ["ArmColumn", "ArmOptions", "HeldArm", "IdentifiedArm", "held_arm", "identify_arm"]


def _modules() -> tuple[ModuleType, ...]:
    """Where the names are."""
    from motionfmu.identify.arm_dynamics import arm_identification, arm_options, arm_run

    return arm_identification, arm_options, arm_run


__getattr__ = at_first_use(__name__, __all__, _modules)


def __dir__() -> list[str]:
    """Names of `__all__`, though they are not imported yet."""
    return __all__
