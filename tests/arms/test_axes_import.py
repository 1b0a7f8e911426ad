"""An arm without a spherical wrist becomes a machine by its axes, and comes back from it."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
from made_arm import told
from random_arms import PinocchioChain, RandomArm
from test_arm_import import SMALL, refused

from motionfmu import run
from motionfmu.arm_machines import arm_machine
from motionfmu.arms import (
    AxesGeometry,
    OpwGeometry,
    axes_geometry,
    driven_geometry,
    urdf_arm,
)
from motionfmu.arms.urdf_reader import urdf_text_arm

# The wrist of a cobot: axes 4, 5, 6 do not meet, and axis 6 is askew to axis 5.
BESIDE = ('<origin xyz="0 0 0.24"/>', '<origin xyz="0.04 0 0.24"/>')
ASKEW = ('<origin xyz="0 0 0.04"/><axis xyz="0 0 1"/>',
         '<origin xyz="0.03 0.05 0.04"/><axis xyz="0 0.6 0.8"/>')  # fmt: skip


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The small arm with such a wrist."""
    text = SMALL.read_text(encoding="utf-8")
    for before, after in (BESIDE, ASKEW):
        assert before in text
        text = text.replace(before, after)
    found = tmp_path_factory.mktemp("axes") / "cobot.urdf"
    found.write_text(text, encoding="utf-8")
    return found


def test_random_axes_are_where_pinocchio_has_them() -> None:
    """Tips of ten arms of six turning joints at 20 states each, joints beside the chain too."""
    rng = np.random.default_rng(3)
    for _ in range(10):
        text = RandomArm(rng, ("revolute", "continuous")).text()
        arm = urdf_text_arm(text, "random.urdf", "l6")
        geometry, oracle = axes_geometry(arm), PinocchioChain(text, arm)
        q = rng.uniform(-3.0, 3.0, (20, 6))
        tips = geometry.frames(q)[-1] @ geometry.flange
        assert tips == pytest.approx(np.array([oracle.tip(x) for x in q]), abs=1e-10)
        # Its Jacobian against differences of that tip.
        there, back = (geometry.frames(q[0] + s * 1e-6 * np.eye(6))[-1] for s in (1.0, -1.0))
        slope = ((there - back) @ geometry.flange)[:, :3, 3].T / 2e-6
        assert geometry.jacobian(q[0])[:3] == pytest.approx(slope, abs=1e-8)


def test_what_drives_an_arm(file: Path) -> None:
    small = driven_geometry(urdf_arm(SMALL))
    assert isinstance(small, OpwGeometry)
    # The same arm by its axes reaches as far: to the centre of the wrist, over the offset b.
    by_axes = axes_geometry(urdf_arm(SMALL))
    assert by_axes.reach == pytest.approx(np.hypot(small.reach, small.lengths[2]), rel=0.01)
    assert isinstance(driven_geometry(urdf_arm(file)), AxesGeometry)
    # Lengths that miss the tip by more than 1 mm are none: axis 5 is 0.1 degrees from upright.
    text = SMALL.read_text(encoding="utf-8").replace(
        '<axis xyz="0 1 0"/>', '<axis xyz="0 1 0.0018"/>'
    )
    text = text.replace('<origin xyz="0 0 0.04"/><axis', '<origin xyz="0 0 0.94"/><axis')
    rounded = driven_geometry(urdf_text_arm(text, "rounded.urdf", "flange"))
    assert isinstance(rounded, AxesGeometry)
    assert "its seven lengths are off by " in rounded.why


def test_the_machine_has_the_axes_once(arm_folder: Path) -> None:
    shown = (arm_folder.parent / "told").read_text(encoding="utf-8")
    assert "small_arm to flange, six joints" in shown
    assert "driven by its axes, as an arm of six joints; axes 5 and 6 are at 53.13°" in shown
    assert "start pose: " in shown and "far from singular" in shown
    tables = tomllib.loads((arm_folder / "machine.toml").read_text(encoding="utf-8"))
    assert tables["component"]["arm"] == "axes_arm"
    given = tables["set"]
    assert given["soft.arm_by"] == 1
    assert {"*.axis_origin", "*.axis_direction", "soft.flange"} <= given.keys()
    assert not {"*.a1", "soft.axis_origin", "arm.axis_origin", "soft.tool"} & given.keys()
    plan = run.machine(arm_folder).plan()
    assert plan.disagreements({}) == []
    moved = list(given["*.axis_origin"])
    moved[0] += 0.01
    (apart,) = plan.disagreements({"arm.axis_origin": moved})
    assert "both mean arm.axis_origin" in apart


def test_a_line_and_joint_moves_run_within_the_limits(arm_run, arm_folder: Path) -> None:
    assert arm_run.ok
    limits = arm_machine(run.machine(arm_folder)).arm.joints
    q = arm_run["soft.joint_command"]
    rate = np.abs(arm_run["soft.joint_rate"]) / [j.speed for j in limits]
    assert 0.2 < rate.max() <= 1.0 + 1e-6
    assert (q >= [j.low - 1e-9 for j in limits]).all()
    assert (q <= [j.high + 1e-9 for j in limits]).all()
    assert np.abs(q[-1] - q[0]).max() < 1e-6, "home again"
    assert np.ptp(arm_run["soft.tool_position"], axis=0).max() > 0.1


def test_controller_and_plant_have_the_tip_of_the_urdf(arm_run, file: Path) -> None:
    """Commanded, and of the links behind their gears: place and attitude, to 1e-9."""
    text = file.read_text(encoding="utf-8")
    oracle = PinocchioChain(text, urdf_arm(file))
    rows = slice(None, None, 50)
    commanded = np.array([oracle.tip(q) for q in arm_run["soft.joint_command"][rows]])
    assert arm_run["soft.tool_position"][rows] == pytest.approx(commanded[:, :3, 3], abs=1e-9)
    real = np.array([oracle.tip(q) for q in arm_run["arm.link_angle"][rows]])
    assert arm_run["arm.tool_position"][rows] == pytest.approx(real[:, :3, 3], abs=1e-9)
    w, x, y, z = arm_run["arm.tool_quaternion"][rows].T
    ahead = np.column_stack([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)])
    assert ahead == pytest.approx(real[:, :3, 0], abs=1e-9)


def test_the_plant_weighs_what_the_urdf_says(arm_folder: Path, file: Path) -> None:
    """Torques of the machine's arm at 100 random states against pinocchio, to nine digits."""
    arm, own = urdf_arm(file), arm_machine(run.machine(arm_folder)).arm
    oracle = PinocchioChain(file.read_text(encoding="utf-8"), arm)
    q, v, a = np.random.default_rng(1).uniform(-3.0, 3.0, (3, 100, 6))
    torque = np.array([oracle.torque(*row) for row in zip(q, v, a, strict=True)])
    found = own.inverse_dynamics(q, v, a, oracle.model.gravity.linear)
    assert found == pytest.approx(torque, abs=1e-8 * np.abs(torque).max())


def test_an_exported_urdf_is_the_same_arm(arm_folder: Path, tmp_path: Path) -> None:
    told("export", arm_folder, "--urdf", "-o", tmp_path / "again.urdf")
    again, own = urdf_arm(tmp_path / "again.urdf"), arm_machine(run.machine(arm_folder)).arm
    q, v, a = np.random.default_rng(2).uniform(-3.0, 3.0, (3, 50, 6))
    torque = own.inverse_dynamics(q, v, a)
    worst = 1e-12 * np.abs(torque).max()
    assert again.inverse_dynamics(q, v, a) == pytest.approx(torque, abs=worst)
    assert again.forward(q) == pytest.approx(own.forward(q), abs=1e-13)
    assert [j.ratio for j in again.joints] == [j.ratio for j in own.joints]
    told("import", tmp_path / "again.urdf", "-o", tmp_path / "again")
    once, twice = (
        tomllib.loads((f / "machine.toml").read_text(encoding="utf-8"))["set"]
        for f in (arm_folder, tmp_path / "again")
    )
    assert twice["*.axis_origin"] == pytest.approx(once["*.axis_origin"], abs=1e-11)
    assert twice["soft.flange"] == pytest.approx(once["soft.flange"], abs=1e-8)


def test_links_without_mass_have_it_in_their_middle(file: Path, tmp_path: Path) -> None:
    text = file.read_text(encoding="utf-8")
    at = text.index("<inertial>", text.index('name="forearm"'))
    text = text[:at] + text[text.index("</inertial>", at) + len("</inertial>") :]
    (tmp_path / "bare.urdf").write_text(text, encoding="utf-8")
    shown = told("import", tmp_path / "bare.urdf", "-o", tmp_path / "bare")
    assert "mass, centre, inertia of forearm" in shown and "in the middle of the link" in shown
    given = tomllib.loads((tmp_path / "bare/machine.toml").read_text(encoding="utf-8"))["set"]
    assert given["arm.center"][9:12] == pytest.approx(np.array(given["*.axis_origin"][12:15]) / 2)
    assert given["arm.inertia"][9] == pytest.approx(given["arm.inertia"][11])


@pytest.mark.parametrize(
    ("before", "after", "words"),
    [
        ('name="twist" type="continuous"', 'name="twist" type="fixed"',
         "missing: poses of 5 coordinates: a job asks for six"),
        ('name="waist" type="revolute"', 'name="waist" type="prismatic"',
         "missing: drives and links that slide, in mm (waist)"),
        ('<limit lower="-3.4"', '<mimic joint="shoulder"/><limit lower="-3.4"',
         "(following joints: bend); missing: poses of 5 coordinates: a job asks for six, the "
         "arm has 5; the linkage of a palletizer: a palletizer has four joints that turn, and"),
    ],
)  # fmt: skip
def test_what_other_arms_lack_is_named(before: str, after: str, words: str, tmp_path: Path) -> None:
    text = SMALL.read_text(encoding="utf-8").replace(before, after)
    (tmp_path / "other.urdf").write_text(text, encoding="utf-8")
    shown = refused("import", tmp_path / "other.urdf", "--tip", "flange", "-o", tmp_path / "other")
    assert words in shown
    assert "it cannot be driven yet: the controller moves six joints that turn" in shown
    assert not (tmp_path / "other").exists()


def test_axes_that_leave_no_pose_to_move_from_are_refused(tmp_path: Path) -> None:
    """All axes parallel: the hand only turns about one."""
    rows = "".join(
        f'<link name="l{k}"/><joint name="j{k}" type="revolute"><parent link="l{k - 1}"/>'
        f'<child link="l{k}"/><origin xyz="0.2 0 0.1"/><axis xyz="0 0 1"/>'
        '<limit lower="-2" upper="2" velocity="1" effort="0"/></joint>'
        for k in range(1, 7)
    )
    (tmp_path / "flat.urdf").write_text(f'<robot name="flat"><link name="l0"/>{rows}</robot>')
    shown = refused("import", tmp_path / "flat.urdf", "-o", tmp_path / "flat")
    assert "its axes leave the hand fewer than six ways to move" in shown
