"""A pose in which an arm by its axes can begin: hand down, every joint far from singular."""

import math
from itertools import product

import numpy as np

from motionfmu.arms.arm_axes import AxesGeometry
from motionfmu.arms.arm_description import ArmDescription, ArmJoint, Array
from motionfmu.base.errors import InputError

EIGHTHS = math.pi / 4.0 * np.arange(-4, 5)  # [rad] tried at joints 2 to 5
DOWN = math.cos(math.radians(1.0))  # of the hand's axis from the vertical
LEAST = 1e-3  # singular value of the Jacobian, lengths in reaches, of an arm that moves at all


def bent_pose(geometry: AxesGeometry, arm: ArmDescription) -> Array:
    """Joint angles, of eighths of a turn within the ranges [rad].

    Of poses whose Jacobian has half the largest least singular value, the hand down in them if any
    has it so, the one that keeps elbow and hand highest. An InputError says that all are singular.
    """
    choices = [_choices(k, j, len(arm.driven) - 1) for k, j in enumerate(arm.driven)]
    q = np.array(list(product(*choices)))
    frames = geometry.frames(q)
    tip = frames[-1] @ geometry.flange
    jacobian = geometry.jacobian(q)
    jacobian[:, :3] /= geometry.reach
    least = np.linalg.svd(jacobian, compute_uv=False)[:, -1]
    if least.max() < LEAST:
        ways = "six" if len(arm.driven) == 6 else str(len(arm.driven))
        told = f"its axes leave the hand fewer than {ways} ways to move, wherever the joints are"
        raise InputError(f"{arm.name}: {told}")
    free = least > max(LEAST, 0.5 * least.max())
    heights = np.min([*(f[:, 2, 3] for f in frames[2:]), tip[:, 2, 3]], axis=0)
    down = -tip[:, 2, 2] > DOWN
    fits = free & down if (free & down).any() else free
    turned = np.abs(q).max(axis=1)
    order = np.lexsort((turned.round(6), -heights.round(6), ~fits))
    return np.asarray(q[order[0]])


def _choices(k: int, joint: ArmJoint, last: int) -> list[float]:
    """Angles tried of a joint; the first turns all of the arm, the last the hand alone."""
    low, high = joint.low, joint.high
    if joint.slides:
        return [(low + high) / 2.0]
    middle = min(max(0.0, low), high)
    if k in (0, last):
        return [middle if low < middle < high else (low + high) / 2.0]
    margin = 0.05 * (high - low)
    within = [float(a) for a in EIGHTHS if low + margin <= a <= high - margin]
    return within or [(low + high) / 2.0]
