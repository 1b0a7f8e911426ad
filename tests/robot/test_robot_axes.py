"""A UR5e under the robot controller: its moves by pinocchio, its FMU, and what is refused."""

from pathlib import Path

import numpy as np
import pinocchio
import pytest
from public_arms import ARMS
from test_virtual_robot import SCENARIO

import motionfmu
import motionfmu.virtual.robot as robots
from motionfmu.virtual.robot import Kinematics, RobotError, VirtualRobot

ARM = ARMS["UR5e"]
ORIGINS, AXES, _, TURN = ARM.straight()
START = [0.0, -90.0, 90.0, -90.0, -90.0, 0.0]
SETTINGS = {
    "arm_by": 1,
    "axis_origin": ORIGINS.ravel(),
    "axis_direction": AXES.ravel(),
    "flange": np.concatenate([np.zeros(3), robots.pose_of(np.block([
        [TURN, np.zeros((3, 1))], [np.zeros((1, 3)), np.ones((1, 1))]]))[3:]]),
    "joint_offset": [0.0] * 6,
    "joint_low": [-360.0] * 6,
    "joint_high": [360.0] * 6,
    "joint_speed": [180.0] * 6,
    "joint_acc": [800.0] * 6,
    "gear_ratio": [101.0] * 6,
    "start_joint": START,
}  # fmt: skip


def flange(joints: np.ndarray) -> pinocchio.SE3:
    model, motion = ARM.model()
    data = model.createData()
    pinocchio.framesForwardKinematics(model, data, motion @ np.radians(joints))
    return data.oMf[model.nframes - 1]


def test_a_joint_move_and_a_line_lead_where_pinocchio_says() -> None:
    robot = VirtualRobot(**SETTINGS)
    start = flange(np.array(START))
    np.testing.assert_allclose(robot.read().pose_command[:3], start.translation * 1e3, atol=1e-6)
    joints = [20.0, -80.0, 100.0, -100.0, -80.0, 30.0]
    robot.move_joints(joints, share=0.5)
    there = robot.run_until_stop()
    np.testing.assert_allclose(there.joint_command, joints, atol=1e-9)
    pose = np.array(there.pose_command)
    pose[:3] += [50.0, -200.0, 60.0]
    robot.move_line(pose, feed=300)
    found = robot.record(2.0, 1e-3, "joint_command", "path_feed")
    places = np.array([flange(q).translation for q in found["joint_command"]]) * 1e3
    way = (places - places[0]) @ (pose[:3] - places[0]) / np.sum((pose[:3] - places[0]) ** 2)
    off = places - places[0] - way[:, None] * (pose[:3] - places[0])
    assert np.linalg.norm(off, axis=1).max() < 1e-6
    np.testing.assert_allclose(places[-1], pose[:3], atol=1e-6)
    turn = flange(np.array(joints)).rotation
    assert np.abs(flange(found["joint_command"][-1]).rotation - turn).max() < 1e-9
    assert found["path_feed"].max() == pytest.approx(300, rel=1e-6)
    rates = np.abs(np.diff(found["joint_command"], axis=0)).max() / 1e-3
    assert 5.0 < rates < 180.0


def test_all_branches_are_offered_and_can_be_moved_to() -> None:
    arm = Kinematics(**SETTINGS)
    matrix = arm.forward(START)
    np.testing.assert_allclose(matrix[:3, 3], flange(np.array(START)).translation * 1e3, atol=1e-9)
    branches = arm.inverse(matrix, START)
    assert np.isfinite(branches[:, 0]).sum() == 8
    np.testing.assert_allclose(arm.forward(branches), np.broadcast_to(matrix, (8, 4, 4)), atol=1e-9)
    factors, own = arm.singular(branches)
    np.testing.assert_array_equal(own, np.arange(8))
    assert np.abs(factors).min() > 1e-3


def test_the_fmu_does_the_same_to_the_bit(tmp_path: Path) -> None:
    program = "G21 G90\nG0 X400 Y-200 Z400 A180 B0 C90\nG1 X450 Y-150 F6000\nM2\n"
    (tmp_path / "a.ngc").write_text(program)
    lines = [f'"soft.{name}" = {np.asarray(v).tolist()}' for name, v in SETTINGS.items()]
    text = SCENARIO.format(stop=2.5, program="a.ngc", points="")
    text = text.replace("[record]", "\n".join(lines) + "\n\n[record]")
    (tmp_path / "scenario.toml").write_text(text)
    fmus = motionfmu.load(tmp_path).run()
    robot = VirtualRobot(**SETTINGS, irq_mean=4e-6, irq_longest=1e-4)
    robot.start(program, language="gcode")
    mine = robot.record(2.5, 1e-3, "pulses", "pose_command")
    rows = np.rint(fmus.time * 1e3).astype(int)
    np.testing.assert_array_equal(
        mine["pulses"][rows], np.asarray(fmus["card.pulse_count"]).reshape(-1, 6)
    )
    np.testing.assert_array_equal(
        mine["pose_command"][rows, :3] * 1e-3, np.asarray(fmus["soft.tool_position"])
    )
    np.testing.assert_allclose(mine["pose_command"][-1][:3], [450, -150, 400], atol=1e-6)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"axis_direction": [0.0] * 18}, "axis_direction.*without direction"),
        ({"joint_sign": [1, 1, -1, 1, 1, 1]}, "joint_sign.*axis_direction has the sign"),
        ({"singular": 2}, "singular.*not of an arm by its axes"),
    ],
)
def test_what_is_no_arm_is_refused(wrong: dict[str, object], words: str) -> None:
    with pytest.raises(RobotError, match=words):
        VirtualRobot(**(SETTINGS | wrong))
