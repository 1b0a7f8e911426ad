"""Recognition of arms with a spherical wrist out of any chain of joints, and why not."""

import math
from dataclasses import replace

import numpy as np
import pytest
from py_opw_kinematics import KinematicModel, Robot

from motionfmu.arms import ArmDescription, NoOpwGeometry, OpwGeometry, kind_of, opw_geometry
from motionfmu.arms.arm_description import ArmJoint, RigidLink, about, placed, turn_of
from motionfmu.arms.arm_geometry import ANGLE, MEET

UP = np.eye(4)


def arm_of(geometry: OpwGeometry) -> ArmDescription:
    """The chain of an arm's lengths, frames as they are."""
    joints = []
    for k, (origin, axis) in enumerate(geometry.joint_frames, 1):
        before = geometry.base if k == 1 else UP
        joints.append(
            ArmJoint(f"j{k}", "revolute", before @ origin, axis, -3.0, 3.0, 1.0, RigidLink(f"l{k}"))
        )
    return ArmDescription("arm", RigidLink("base"), tuple(joints), "tip", geometry.flange)


def shuffled(arm: ArmDescription, rng: np.random.Generator) -> ArmDescription:
    """The same motion with other frames: each joint's own anywhere on its axis, turned."""
    joints, before = [], UP
    for joint in arm.joints:
        along = placed(rng.uniform(-1.0, 1.0) * joint.axis, turn_of(*rng.uniform(-3.0, 3.0, 3)))
        joints.append(
            replace(joint, origin=before @ joint.origin @ along, axis=along[:3, :3].T @ joint.axis)
        )
        before = np.linalg.inv(along)
    return replace(arm, joints=tuple(joints), tip_frame=before @ arm.tip_frame)


def random_geometry(rng: np.random.Generator) -> OpwGeometry:
    """Lengths of either sign, also 0, offsets, signs, a tip turned and beside the flange."""
    a1, a2, b, c4 = rng.uniform(-0.4, 0.4, 4) * rng.integers(0, 2, 4)
    c1, c2, c3 = rng.uniform([-0.3, 0.1, 0.1], [1.0, 1.5, 1.5])
    tip = (
        UP
        if rng.random() < 0.5
        else placed(rng.uniform(-0.2, 0.2, 3), turn_of(*rng.uniform(-3, 3, 3)))
    )
    base = (
        UP if rng.random() < 0.5 else placed(rng.uniform(-1, 1, 3), turn_of(*rng.uniform(-3, 3, 3)))
    )
    return OpwGeometry(
        (a1, a2, b, c1, c2, c3, c4),
        tuple(int(s) for s in rng.choice([-1, 1], 6)),
        tuple(rng.uniform(-3.0, 3.0, 6)),
        base,
        tip,
    )  # fmt: skip


def test_any_frames_of_an_arm_give_its_motion_back():
    """300 random arms, frames shuffled: the lengths move the tip as the chain does, to 1e-9."""
    rng = np.random.default_rng(11)
    worst = 0.0
    for _ in range(300):
        arm = shuffled(arm_of(random_geometry(rng)), rng)
        found = opw_geometry(arm)
        q = rng.uniform(-3.0, 3.0, (20, 6))
        worst = max(worst, float(np.abs(found.forward(q) - arm.forward(q)).max()))
        assert found.deviation < 1e-9
        assert found.lengths[4] > 0.0 and found.lengths[5] > 0.0
    print(f"worst {worst:.1e}")
    assert worst < 1e-9


# a1, a2, b, c1, c2, c3, c4, offsets [deg], signs, by their makers and ROS-Industrial.
KNOWN = {
    "ABB IRB 2400": ([0.1, -0.135, 0, 0.615, 0.705, 0.755, 0.085], [0, 0, -90, 0, 0, 0], [1] * 6),
    "KUKA KR 6 R900": (
        [0.025, -0.035, 0, 0.4, 0.455, 0.42, 0.08], [0, -90, 0, 0, 0, 0], [-1, 1, 1, -1, 1, -1]
    ),
    "Staubli TX60": ([0, 0, 0.02, 0.375, 0.29, 0.31, 0.07], [0] * 6, [1] * 6),
}  # fmt: skip


@pytest.mark.parametrize("name", KNOWN)
def test_known_arms_have_their_published_lengths(name):
    """And their joints, as py-opw-kinematics solves them, reach where the chain says."""
    lengths, offsets, signs = KNOWN[name]
    given = OpwGeometry(tuple(lengths), tuple(signs), tuple(np.radians(offsets)), UP, UP)
    rng = np.random.default_rng(2)
    arm = shuffled(arm_of(given), rng)
    found = opw_geometry(arm)
    assert found.lengths == pytest.approx(lengths, abs=1e-12)
    assert np.degrees(found.offsets) == pytest.approx(offsets, abs=1e-9)
    assert list(found.signs) == signs
    names = ("a1", "a2", "b", "c1", "c2", "c3", "c4")
    own = dict(zip(names, found.lengths, strict=True))
    model = KinematicModel(
        **own, offsets=found.offsets, flip_axes=tuple(s < 0 for s in found.signs)
    )
    q = rng.uniform(-1.5, 1.5, (50, 6))
    theirs = np.array([Robot(model, degrees=False).forward(row).as_matrix() for row in q])
    assert theirs == pytest.approx(arm.forward(q), abs=1e-9)


def straight() -> ArmDescription:
    lengths = (0.1, -0.1, 0.0, 0.4, 0.5, 0.6, 0.1)
    return arm_of(OpwGeometry(lengths, (1,) * 6, (0.0,) * 6, UP, UP))


def other(k: int, **changed) -> ArmDescription:
    """The arm with something else about one joint, numbered from 1."""
    arm = straight()
    joints = list(arm.joints)
    joints[k - 1] = replace(joints[k - 1], **changed)
    return replace(arm, joints=tuple(joints))


def moved(k: int, place) -> ArmDescription:
    return other(k, origin=straight().joints[k - 1].origin @ placed(place))


NOT = {
    "wrist beside": (
        moved(5, [0.02, 0, 0]),
        "an arm of six joints; axes 4, 5, 6 do not meet in a point: apart are 4 and 5 20 mm",
    ),
    "axis 2 askew": (
        other(2, axis=about(np.array([1.0, 0, 0]), 0.1)[:, 1]),
        "axes 2 and 3 are 5.73° from parallel",
    ),
    "axis 4 askew": (
        other(4, axis=about(np.array([1.0, 0, 0]), 0.1)[:, 2]),
        "axes 3 and 4 are at 84.27°, 90° wanted",
    ),
    "three parallel axes": (
        other(4, axis=np.array([0.0, 1.0, 0.0])),
        "an arm with three parallel axes; axes 3 and 4 are at 0°, 90° wanted",
    ),
    "no upper arm": (moved(3, [0, 0, -0.5]), "axes 2 and 3 are in line"),
}


@pytest.mark.parametrize("name", NOT)
def test_what_is_in_the_way_is_told(name):
    arm, told = NOT[name]
    with pytest.raises(NoOpwGeometry) as error:
        opw_geometry(arm)
    assert told in str(error.value)


def test_rounded_angles_are_an_arm_and_the_deviation_is_known():
    """1.57 for a quarter turn, as some files have it: 0.8 mrad, a millimetre at the tip."""
    arm = straight()
    bent = turn_of(1.57 - math.pi / 2, 0.0, 0.0)
    joints = list(arm.joints)
    joints[3] = replace(joints[3], origin=joints[3].origin @ placed([0, 0, 0], bent))
    found = opw_geometry(replace(arm, joints=tuple(joints)))
    assert 1e-5 < found.deviation < 2e-3
    with pytest.raises(NoOpwGeometry):
        opw_geometry(other(4, axis=about(np.array([1.0, 0, 0]), 2 * ANGLE)[:, 2]))
    assert opw_geometry(moved(5, [0.5 * MEET, 0, 0])).deviation > 1e-6


def test_a_wrist_a_quarter_round_is_told_alike_whatever_the_last_digit():
    """Axis 5 along x: one of two signs fits as well as the other, and rounding must not choose."""
    found = []
    for little in (-1e-12, 1e-12):
        for quarter in (-math.pi / 2, math.pi / 2):
            lengths = (0.1, -0.1, 0.0, 0.4, 0.5, 0.6, 0.1)
            offsets = (0.0, 0.0, 0.0, quarter + little, 0.0, 0.0)
            own = opw_geometry(arm_of(OpwGeometry(lengths, (1,) * 6, offsets, UP, UP)))
            found.append((own.signs[4], round(own.offsets[3], 9)))
    assert found[:2] == found[2:]
    assert len({offset for _, offset in found}) == 1


def test_kinds_of_arms_have_names():
    arm = straight()
    z = np.array([0.0, 0.0, 1.0])

    def chain(kinds: str) -> ArmDescription:
        rows = [
            ArmJoint(f"j{k}", "prismatic" if c == "P" else "revolute", placed([0.1, 0, 0]), z, -1.0,
                     1.0, 1.0, RigidLink(f"l{k}"))
            for k, c in enumerate(kinds)
        ]  # fmt: skip
        return replace(arm, joints=tuple(rows))

    assert kind_of(arm) == "an arm of six joints"
    assert kind_of(chain("RRPR")) == kind_of(chain("RRRP")) == "a SCARA"
    assert kind_of(chain("PPPRRR")) == "a gantry with a wrist"
    assert kind_of(chain("PRRRRRR")) == "an arm of six joints on a linear track"
    assert kind_of(chain("R" * 7)) == "an arm of seven joints"
    four = "an arm of four joints whose tool no linkage keeps level"
    assert kind_of(replace(arm, joints=arm.joints[:4])) == four
    assert kind_of(chain("RR")) == "a chain of 2 joints (RR)"
    tied = list(arm.joints)
    tied[3] = replace(tied[3], follows=(1, -1.0, 0.0))
    assert "(following joints: j4)" in kind_of(replace(arm, joints=tuple(tied)))
