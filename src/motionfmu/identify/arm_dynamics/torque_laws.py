"""What a joint's torque has beside the links: friction, and extensions that validation may take.

All are linear in what is looked for. Torques are those of the joint, that is the motor's times the
gear ratio; w is the speed of the motor, q the inner angle of the joint.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Half of what Coulomb friction is more forwards than backwards; also what a brake or a zero is off.
OFFSET = "offset"


@dataclass(frozen=True)
class JointState:
    """What a law is a function of, each (samples,)."""

    angle: Array  # of the joint [rad]
    speed: Array  # of the joint [rad/s]
    direction: Array  # sign of the speed
    stribeck: float  # speed of the joint at which half of the excess at rest is left [rad/s]


@dataclass(frozen=True)
class TorqueLaw:
    """Columns of a joint's regressor."""

    title: str
    terms: tuple[tuple[str, str], ...]  # name and unit of each column
    columns: Callable[[JointState], Sequence[Array]]


BASE = TorqueLaw(
    "Coulomb friction, more one way by an offset, and viscous friction",
    (("coulomb", "N·m"), ("viscous", "N·m·s/rad"), (OFFSET, "N·m")),
    lambda s: (s.direction, s.speed, np.ones_like(s.speed)),
)
LAWS = {
    "direction": TorqueLaw(
        "viscous friction that differs by direction",
        (("viscous difference", "N·m·s/rad"),),
        lambda s: (np.abs(s.speed),),
    ),
    "stribeck": TorqueLaw(
        "Stribeck",
        (("excess at rest", "N·m"),),
        lambda s: (s.direction / (1.0 + (s.speed / s.stribeck) ** 2),),
    ),
    "degressive": TorqueLaw(
        "friction that rises less at speed",
        (("cube root", "N·m"),),
        lambda s: (np.cbrt(s.speed),),
    ),
    "balancer": TorqueLaw(
        "springs or cylinders that balance a joint",
        (
            *(("sine", "N·m"), ("cosine", "N·m")),
            *(("sine twice", "N·m"), ("cosine twice", "N·m")),
        ),
        lambda s: (
            *(np.sin(s.angle), np.cos(s.angle)),
            *(np.sin(2.0 * s.angle), np.cos(2.0 * s.angle)),
        ),
    ),
}
