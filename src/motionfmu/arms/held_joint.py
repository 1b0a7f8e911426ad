"""An arm of which a joint is held: what is behind it is fixed to what is before it."""

import math
from dataclasses import replace

import numpy as np

from motionfmu.arms.arm_description import ArmDescription, joined, moved
from motionfmu.base.errors import InputError, suggestion

SEVEN = 7
THIRD = 2  # the joint that is held of seven, if no other one is asked for


def held(arm: ArmDescription, hold: str | None = None) -> ArmDescription:
    """Hold a joint of an arm of seven, or the one asked for.

    Parameters
    ----------
    arm : ArmDescription
    hold : str, optional
        Name of a joint, or ``name=angle`` [deg], of one that slides [mm]. Of seven joints that turn
        the third, if none is given; at 0, or where its range leaves that out in the middle of it.

    Returns
    -------
    ArmDescription
        With one joint less and a note that says so; the same if nothing is to be held.

    Raises
    ------
    InputError
        There is no such joint, it is not free, or the angle is none of its range.
    """
    if hold is None:
        turning = not any(j.slides or j.follows is not None for j in arm.joints)
        if len(arm.joints) != SEVEN or not turning:
            return arm
        hold = arm.joints[THIRD].name
    name, _, value = hold.partition("=")
    names = [j.name for j in arm.joints]
    if name not in names:
        raise InputError(f"--hold {hold}: {arm.name} has no joint {name}{suggestion(name, names)}")
    k = names.index(name)
    if any(j.follows is not None for j in arm.joints):
        raise InputError(f"--hold {hold}: joints of {arm.name} follow others")
    joint = arm.joints[k]
    unit, told = (1e-3, "mm") if joint.slides else (math.radians(1.0), "°")
    ends = f"{joint.low / unit:.6g} .. {joint.high / unit:.6g} {told}"
    at = 0.0 if joint.low <= 0.0 <= joint.high else (joint.low + joint.high) / 2.0
    if value:
        try:
            at = unit * float(value)
        except ValueError:
            raise InputError(f"--hold {hold}: {value!r} is no number") from None
    if not joint.low <= at <= joint.high:
        raise InputError(f"--hold {hold}: beyond the range of {name}, {ends}")
    note = f"joint {name} is held at {at / unit:.6g} {told}: controller and card drive six joints"
    return _folded(arm, k, at, note)


def _folded(arm: ArmDescription, k: int, at: float, note: str) -> ArmDescription:
    joint, joints = arm.joints[k], list(arm.joints)
    frame = joint.origin @ moved(joint, np.array(at))
    base, tip = arm.base, arm.tip_frame
    before = joints[k - 1].link if k > 0 else base
    link = joined(before.name, [(before, np.eye(4)), (joint.link, frame)])
    if k > 0:
        joints[k - 1] = replace(joints[k - 1], link=link)
    else:
        base = link
    if k + 1 < len(joints):
        joints[k + 1] = replace(joints[k + 1], origin=frame @ joints[k + 1].origin)
    else:
        tip = frame @ tip
    del joints[k]
    notes = (*arm.notes, note)
    return replace(arm, base=base, joints=tuple(joints), tip_frame=tip, notes=notes)
