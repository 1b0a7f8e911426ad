"""From a record of an arm to its base parameters, its friction and its gears."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from motionfmu.identify.arm_dynamics.arm_identification import IdentifiedArm, identify_arm
    from motionfmu.identify.arm_dynamics.arm_options import ArmColumn, ArmOptions
    from motionfmu.identify.arm_dynamics.arm_run import HeldArm, held_arm

__all__ = ["ArmColumn", "ArmOptions", "HeldArm", "IdentifiedArm", "held_arm", "identify_arm"]


def __getattr__(name: str) -> Any:
    """Import what identifies when it is first used, as it needs the extra `tune`."""
    if name not in __all__:
        raise AttributeError(f"module 'motionfmu.identify.arm_dynamics' has no attribute {name!r}")
    from motionfmu.base.extras import needed

    needed("tune")
    from motionfmu.identify.arm_dynamics import arm_identification, arm_options, arm_run

    places = (arm_identification, arm_options, arm_run)
    return next(getattr(place, name) for place in places if hasattr(place, name))


def __dir__() -> list[str]:
    """Names of `__all__`, though they are not imported yet."""
    return __all__
