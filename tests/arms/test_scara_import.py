"""A SCARA's URDF becomes a machine of four joints, one of which slides, and its job runs."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
import robot_settings
from random_arms import PinocchioChain
from typer.testing import CliRunner

from motionfmu import run
from motionfmu.analysis.collisions.arm_parts import ArmParts
from motionfmu.arm_machines import arm_machine
from motionfmu.arms import AxesGeometry, driven_geometry, urdf_arm
from motionfmu.cli import app
from motionfmu.report.view.scene import scene_of
from motionfmu.virtual.robot import Kinematics, RobotError, VirtualRobot

SCARA = Path(__file__).parent / "small_scara.urdf"
MM, SLIDE = 1e-3, 2


@pytest.fixture(scope="module")
def file() -> Path:
    """The SCARA."""
    return SCARA


@pytest.fixture(scope="module")
def settings(arm_folder: Path) -> dict:
    """What the machine's controller knows of the arm."""
    given = tomllib.loads((arm_folder / "machine.toml").read_text(encoding="utf-8"))["set"]
    wanted = ("joints", "axis_", "flange", "joint_", "gear_ratio", "start_joint", "arm_by")
    rows = {n.partition(".")[2]: v for n, v in given.items() if n.startswith(("soft.", "*."))}
    return {n: v for n, v in rows.items() if n.startswith(wanted)}


def test_the_machine_has_four_joints(arm_folder: Path) -> None:
    shown = (arm_folder.parent / "told").read_text(encoding="utf-8")
    assert "small_scara to flange, four joints" in shown
    assert "driven by its axes, as a SCARA" in shown
    tables = tomllib.loads((arm_folder / "machine.toml").read_text(encoding="utf-8"))
    given = tables["set"]
    assert given["*.joints"] == 4 and given["*.joint_slides"] == [0, 0, 1, 0, 0, 0]
    assert given["soft.joint_high"][SLIDE] == pytest.approx(180.0)  # mm
    assert given["soft.joint_speed"][SLIDE] == pytest.approx(900.0)
    assert given["*.gear_ratio"][SLIDE] == pytest.approx(2 * np.pi / 0.016)  # a lead of 16 mm
    assert [a["kind"] for a in tables["axis"]] == ["rotary", "rotary", "linear", "rotary"]
    # The file's upside-down frame of joint 3 has four digits; its axes are exactly in parallel.
    axes = np.reshape(given["*.axis_direction"], (6, 3))
    assert (np.abs(axes) == [0.0, 0.0, 1.0]).all() and (axes[:4, 2] == [1, 1, -1, -1]).all()


def test_poses_are_pinocchio_s() -> None:
    arm = urdf_arm(SCARA)
    geometry, oracle = driven_geometry(arm), PinocchioChain(SCARA.read_text(), arm)
    assert isinstance(geometry, AxesGeometry)
    for q in np.random.default_rng(2).uniform(-0.15, 0.15, (20, 4)):
        tip = geometry.frames(q)[-1] @ geometry.flange
        assert tip == pytest.approx(oracle.tip(q), abs=2e-5)  # digits of the file: 7e-6 rad
        there, back = (geometry.frames(q + s * 1e-6 * np.eye(4))[-1] for s in (1.0, -1.0))
        slope = ((there - back) @ geometry.flange)[:, :3, 3].T / 2e-6
        assert geometry.jacobian(q)[:3] == pytest.approx(slope, abs=1e-8)


@pytest.mark.more
def test_its_job_runs_within_the_limits(arm_run, arm_folder: Path) -> None:
    assert arm_run.ok
    machine = arm_machine(run.machine(arm_folder))
    joints = machine.arm.joints
    assert [j.kind for j in joints] == ["revolute", "revolute", "prismatic", "revolute"]
    q, rate = arm_run["soft.joint_command"], arm_run["soft.joint_rate"]
    assert (np.abs(rate[:, :4]) <= np.array([j.speed for j in joints]) * (1 + 1e-6)).all()
    assert (q[:, :4] <= np.array([j.high for j in joints]) + 1e-9).all()
    assert (q[:, 4:] == 0.0).all() and np.abs(arm_run["arm.link_angle"][:, 4:]).max() < 1e-12
    assert (arm_run["card.pulse_count"][:, 4:] == 0).all()
    # Commanded tip by the geometry, and the arm's own with the slack of its gears.
    geometry = machine.geometry
    tips = (geometry.frames(q[:, :4])[-1] @ geometry.flange)[:, :3, 3]
    assert arm_run["soft.tool_position"] == pytest.approx(tips, abs=1e-9)
    apart = np.linalg.norm(arm_run["arm.tool_position"] - tips, axis=1)
    assert 1e-5 < apart[-1] < 2e-3


def test_its_picture_slides(arm_run) -> None:
    scene = scene_of(arm_run)
    assert scene is not None and scene.arm is not None
    assert [row[2] for row in scene.arm.axes] == [False, False, True, False]
    assert scene.joints is not None and scene.joints.shape[1] >= 4


def test_bars_for_collisions_are_where_the_links_are(settings: dict) -> None:
    """Each joint's, by the arm's frames, and the flange by the controller's own kinematics."""
    geometry = driven_geometry(urdf_arm(SCARA))
    assert isinstance(geometry, AxesGeometry)
    joints = np.zeros((50, 6))
    joints[:, :4] = np.random.default_rng(5).uniform(-150, 150, (50, 4))
    q = np.radians(joints[:, :4])
    q[:, SLIDE] = MM * joints[:, SLIDE]
    points = ArmParts.of(robot_settings.settings(**settings)).points(joints, np.zeros((50, 3)))
    for k, frame in enumerate(geometry.frames(q), 1):
        assert points[:, k] == pytest.approx(1e3 * frame[:, :3, 3], abs=1e-6)
    flange = Kinematics(**settings).forward(joints)[:, :3, 3]
    assert points[:, 7] == pytest.approx(flange, abs=1e-6)


def at_rest(robot: VirtualRobot) -> None:
    for _ in range(100):
        if robot.run(0.1).rests:
            return
    raise AssertionError("it moves on")


def test_calls_count_the_slide_in_mm(settings: dict) -> None:
    robot = VirtualRobot(**settings)
    robot.move_joints([10, 40, 60, -20, 0, 0])
    at_rest(robot)
    now = robot.read()
    assert now.joint == pytest.approx([10, 40, 60, -20, 0, 0], abs=4e-3)
    pose = now.pose_command.copy()
    assert abs(pose[3]) == 180.0 and pose[4] == 0.0
    pose[2] -= 30.0
    robot.move_line(pose)
    at_rest(robot)
    down = robot.read().joint
    assert down[SLIDE] == pytest.approx(90.0, abs=4e-3)
    assert down[:2] == pytest.approx([10, 40], abs=4e-3)
    with pytest.raises(RobotError, match="limit 180 mm") as error:
        robot.move_joints([10, 40, 200, 0, 0, 0])
    assert (error.value.value, error.value.limit) == pytest.approx((200.0, 180.0))
    with pytest.raises(RobotError, match="no such joint: joint 5, the arm has 4"):
        robot.move_joints([10, 40, 60, 0, 1, 0])
    pose[3] -= 2.0
    with pytest.raises(RobotError, match="2 deg from the tilt that its tool keeps") as error:
        robot.move_line(pose)
    assert error.value.status == "TILTED" and error.value.value == pytest.approx(2.0)


def test_a_job_is_refused_with_its_line(arm_folder: Path) -> None:
    """A pose that asks for another tilt, and a joint that is not there."""
    points = (arm_folder / "example.points").read_text(encoding="utf-8")
    job = "//TILT\nMOVJ P000 VJ=50.00\nMOVL P002 V=100.0\nEND\n"
    (arm_folder / "tilt.job").write_text(job, encoding="utf-8")
    for point, why in (
        ("P002 X=400 Y=100 Z=200 A=177 B=0 C=0\n", "turns the tool so: 3 deg from the tilt"),
        ("P002 J1=0 J2=40 J3=50 J4=0 J5=9 J6=0\n", "no such joint: joint 5, the arm has 4"),
    ):
        (arm_folder / "tilt.points").write_text(points + point, encoding="utf-8")
        shown = CliRunner().invoke(
            app, ["job", str(arm_folder / "tilt.job"), "--machine", str(arm_folder)]
        )
        text = " ".join(f"{shown.output} {shown.exception}".split())
        assert "line 3: " in text and why in text
