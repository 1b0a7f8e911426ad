"""Arms written and read back: URDF by our reader and pinocchio, MJCF by MuJoCo."""

import itertools
import math
from dataclasses import replace

import mujoco
import numpy as np
import pytest
from random_arms import RandomArm, worst_differences
from scipy.spatial.transform import Rotation

from motionfmu import run
from motionfmu.arm_machines import arm_machine
from motionfmu.arms import ArmDescription, RigidLink, mjcf_text, urdf_text
from motionfmu.arms.arm_description import angles_of, turn_of
from motionfmu.arms.mjcf_text import LEAST_INERTIA, LEAST_MASS, quaternion
from motionfmu.arms.urdf_reader import urdf_text_arm


def random_arms(count: int, mimics: bool = False) -> list[ArmDescription]:
    rng = np.random.default_rng(9)
    kinds = ("revolute", "continuous", "prismatic")
    made = [RandomArm(rng, kinds, int(rng.integers(2, 8)), mimics) for _ in range(count)]
    return [urdf_text_arm(r.text(), "random.urdf", f"l{r.joints}") for r in made]


def told(arm: ArmDescription) -> list[tuple]:
    """All of an arm's joints but frames and masses."""
    return [
        (
            j.name,
            j.kind,
            j.low,
            j.high,
            j.speed,
            j.effort,
            j.ratio,
            j.damping,
            j.friction,
            j.follows,
        )
        for j in arm.joints
    ]


@pytest.mark.parametrize("arm", [*random_arms(5), *random_arms(5, mimics=True), "robot6"])
def test_a_urdf_is_read_back_as_it_was(arm):
    """By our reader: all it says; and by pinocchio, which reads it by itself."""
    arm = arm_machine(run.machine(arm)).arm if isinstance(arm, str) else arm
    text = urdf_text(arm)
    again = urdf_text_arm(text, "again.urdf", arm.tip)
    assert (told(again), again.tip, again.name) == (told(arm), arm.tip, arm.name)
    rng = np.random.default_rng(4)
    q, v, a = rng.uniform(-3.0, 3.0, (3, 30, len(arm.driven)))
    assert again.forward(q) == pytest.approx(arm.forward(q), abs=1e-13)
    torque = arm.inverse_dynamics(q, v, a)
    assert again.inverse_dynamics(q, v, a) == pytest.approx(
        torque, abs=1e-12 * np.abs(torque).max()
    )
    place, apart = worst_differences(text, arm, 30, rng)
    assert place < 1e-12 and apart < 1e-12


def test_bodies_are_written_as_they_were():
    bodies = (
        '<visual><origin xyz="0 0 1"/><geometry><box size="1 2 3"/></geometry></visual>'
        '<collision><geometry><cylinder radius="0.1" length="2"/></geometry></collision>'
        '<collision><geometry><sphere radius="0.3"/></geometry></collision>'
        '<visual><geometry><mesh filename="package://a/b.stl" scale="1 1 0.1"/></geometry></visual>'
    )
    text = (f'<robot name="r"><link name="a"/><link name="b">{bodies}</link><joint name="j" '
            'type="continuous"><parent link="a"/><child link="b"/></joint></robot>')  # fmt: skip
    arm = urdf_text_arm(text, "r.urdf")
    again = urdf_text_arm(urdf_text(arm), "again.urdf")
    for one, other in zip(arm.joints[0].link.shapes, again.joints[0].link.shapes, strict=True):
        assert (one.use, one.kind, one.size, one.mesh) == (
            other.use, other.kind, other.size, other.mesh
        )  # fmt: skip
        assert one.origin.tolist() == other.origin.tolist()
    assert len(arm.joints[0].link.shapes) == 4
    geoms = mujoco.MjModel.from_xml_string(mjcf_text(arm)).geom_size
    assert geoms == pytest.approx(np.array([[0.5, 1, 1.5], [0.1, 1, 0], [0.3, 0, 0]]))


def test_quaternions_are_scipy_s():
    """Of length 1, whichever element is the largest, up to the sign that both may have."""
    for turn in Rotation.random(200, np.random.default_rng(4)):
        theirs = turn.as_quat()[[3, 0, 1, 2]]
        found = quaternion(turn.as_matrix())
        assert found * np.sign(found @ theirs) == pytest.approx(theirs, abs=1e-14)


def test_every_quarter_turn_is_written_and_read_back():
    """The 24 turns of a cube, among them pitches of 90 deg, where roll and yaw are one."""
    right = math.pi / 2
    for angles in itertools.product(range(4), repeat=3):
        turn = turn_of(*(right * k for k in angles)).round()  # without digits that tell the angles
        assert turn_of(*angles_of(turn)) == pytest.approx(turn, abs=1e-15)
    rng = np.random.default_rng(3)
    for roll, yaw in rng.uniform(-3.0, 3.0, (20, 2)):
        for pitch in (-right, right, right - 1e-12):
            turn = turn_of(roll, pitch, yaw)
            assert turn_of(*angles_of(turn)) == pytest.approx(turn, abs=2e-12)


def weighed(arm: ArmDescription) -> ArmDescription:
    """With a milligram for a link without mass, for MuJoCo takes none."""
    bare = RigidLink("", LEAST_MASS, tensor=LEAST_INERTIA * np.eye(3))
    joints = [j if j.link.mass else replace(j, link=bare) for j in arm.joints]
    return replace(arm, joints=tuple(joints))


@pytest.mark.parametrize("arm", [*random_arms(5), "robot6"])
def test_mujoco_moves_the_arm_alike(arm):
    arm = arm_machine(run.machine(arm)).arm if isinstance(arm, str) else arm
    model = mujoco.MjModel.from_xml_string(mjcf_text(arm))
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_LIMIT
    assert model.dof_damping.tolist() == [j.damping or 0.0 for j in arm.joints]
    limited = [[j.low, j.high] for j in arm.joints if not np.isinf(j.low)]
    assert model.jnt_range[model.jnt_limited == 1].tolist() == limited
    model.dof_damping[:] = 0.0
    data = mujoco.MjData(model)
    rng = np.random.default_rng(6)
    states = rng.uniform(-3.0, 3.0, (20, 3, model.nv))
    for q, v, a in states:
        data.qpos[:], data.qvel[:], data.qacc[:] = q, v, a
        mujoco.mj_inverse(model, data)
        torque = weighed(arm).inverse_dynamics(q, v, a)
        size = np.abs(torque).max()
        assert data.qfrc_inverse == pytest.approx(torque, abs=1e-11 * size)
        site, frame = data.site(arm.tip), arm.forward(q)
        assert site.xpos == pytest.approx(frame[:3, 3], abs=1e-10)
        assert site.xmat.reshape(3, 3) == pytest.approx(frame[:3, :3], abs=1e-10)
