"""The linkage of a palletizer: joints that follow others keep its hand level, and its forearm.

    joint 2 ── upper arm ── (plate) joint 3 ── forearm ── pivots ── hand ── joint 4

A URDF's joint mimics one other, so a hand behind a forearm that turns against the upper arm has two
pivots in a line: one turns back what joint 2 turns, one what joint 3 does. Where the forearm is
driven from the base, the plate before joint 3 turns back joint 2, and one pivot is left.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from motionfmu.arms.arm_description import ArmDescription, ArmJoint, Array, RigidLink, placed
from motionfmu.arms.joint_axes import MEET, joint_axes

FOUR = 4
EXACT = 1e-6  # that sums of multipliers may be off


class NoLinkage(ValueError):
    """Joints follow others otherwise than in a palletizer, and the text says which and how."""


@dataclass(frozen=True)
class Linkage:
    """Where the joints of a palletizer are in its chain."""

    driven: tuple[int, int, int, int]
    plates: tuple[int, ...]  # between joints 2 and 3
    pivots: tuple[int, ...]  # between joints 3 and 4; the last one's link is the hand

    @property
    def levels(self) -> tuple[int, int, int, int]:
        """So many joints before each do not tilt its link."""
        return (0, 0, int(bool(self.plates)), 2)


def linkage_of(arm: ArmDescription) -> Linkage:
    """The linkage that keeps an arm's hand level; NoLinkage says what is otherwise."""
    joints = arm.joints
    driven = [k for k, j in enumerate(joints) if j.follows is None]
    if len(driven) != FOUR or any(j.slides for j in joints) or len(joints) == FOUR:
        raise NoLinkage("a palletizer has four joints that turn, and others that follow them")
    first, second, third, fourth = driven
    plates = tuple(range(second + 1, third))
    pivots = tuple(range(third + 1, fourth))
    for k, joint in enumerate(joints):
        if k not in (*driven, *plates, *pivots):
            raise NoLinkage(f"{joint.name} follows another joint, but not between joints 2 and 4")
    axes = joint_axes(arm)
    if not axes.upright(first + 1, second + 1):
        told = f"{math.degrees(axes.angle(first + 1, second + 1)):.4g}°"
        raise NoLinkage(f"axes of joints 1 and 2 are at {told}, 90° wanted")
    for k in (second, *plates, *pivots):
        if not axes.parallel(k + 1, third + 1):
            told = f"{math.degrees(axes.angle(k + 1, third + 1)):.4g}°"
            raise NoLinkage(f"the axis of {joints[k].name} is {told} from that of joint 3")
    for k in (*plates, *pivots):
        line = third if k in plates else pivots[0]
        if (apart := axes.apart(k + 1, line + 1)) > MEET:
            told = f"{1e3 * apart:.4g} mm beside that of {joints[line].name}"
            raise NoLinkage(f"the axis of {joints[k].name} is {told}")
    _levelled(arm, Linkage((first, second, third, fourth), plates, pivots), axes.along)
    return Linkage((first, second, third, fourth), plates, pivots)


def _levelled(arm: ArmDescription, linkage: Linkage, along: Array) -> None:
    """Refuse joints that follow others by multipliers which leave a link tilted."""
    zero = np.zeros(FOUR)
    turned = arm.all_joints(np.eye(FOUR)) - arm.all_joints(zero)  # by joint, of all in the chain
    third = along[linkage.driven[2]]
    tilt = np.array([np.sign(a @ third) for a in along])[:, None] * turned.T
    names = [j.name for j in arm.driven]
    for behind, levels in ((linkage.plates, [1]), (linkage.pivots, [1, 2])):
        if not behind:
            continue
        left = tilt[linkage.driven[1] : behind[-1] + 1].sum(axis=0)
        for k in levels:
            if abs(left[k]) > EXACT:
                told = ", ".join(arm.joints[n].name for n in behind)
                raise NoLinkage(f"{told}: what is behind tilts by {left[k]:.6g} of {names[k]}")
    if not linkage.pivots:
        raise NoLinkage("no joint before the last one keeps the hand level")


def tied_joints(
    joints: tuple[ArmJoint, ...], levels: tuple[int, ...], hand: RigidLink, offset: Array
) -> tuple[ArmJoint, ...]:
    """The joints of a palletizer, all parallel at zero, with those that follow them."""
    return tuple(_tied(joints, levels, hand, offset))


def _tied(
    joints: tuple[ArmJoint, ...], levels: tuple[int, ...], hand: RigidLink, offset: Array
) -> Iterator[ArmJoint]:
    first, second, third, fourth = joints
    axis = third.axis
    along = 1.0 if second.axis @ axis > 0.0 else -1.0

    def follower(name: str, at: ArmJoint | None, leader: int, factor: float) -> ArmJoint:
        return ArmJoint(
            name=name, kind="continuous", origin=np.eye(4) if at is None else at.origin, axis=axis,
            low=-math.inf, high=math.inf, speed=math.inf, link=RigidLink(f"{name}_link"),
            follows=(leader, factor, 0.0),
        )  # fmt: skip

    yield from (first, second)
    if levels[2]:
        yield follower("plate", third, 1, -along)
        yield replace(third, origin=np.eye(4))
        pivot = follower("pivot", fourth, 3, -1.0)
    else:
        yield third
        yield follower("pivot_2", fourth, 1, -along)
        pivot = follower("pivot_3", None, 2, -1.0)
    yield replace(pivot, link=hand)
    yield replace(fourth, origin=placed(offset))
