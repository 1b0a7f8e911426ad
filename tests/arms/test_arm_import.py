"""A URDF becomes a machine that runs, and comes back from it."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
from made_arm import told

from motionfmu import run
from motionfmu.arm_machines import arm_machine
from motionfmu.arms import opw_geometry, urdf_arm
from motionfmu.base.errors import InputError

SMALL = Path(__file__).parent / "small_arm.urdf"


@pytest.fixture(scope="module")
def file() -> Path:
    """The small arm."""
    return SMALL


def test_what_was_taken_for_granted_is_listed(arm_folder):
    shown = (arm_folder.parent / "told").read_text(encoding="utf-8")
    assert "small_arm to flange, six joints, reach 0.731 m, 21.8 kg" in shown
    for what in ("acceleration: ", "gear ratio: 81, ", "payload: ", "start pose: ", "motors, ",
                 "stiffness", "range of joints 6", "errors of its geometry", "gains of the drives",
                 "torque: "):  # fmt: skip
        assert what in shown
        assert what in (arm_folder / "README.md").read_text(encoding="utf-8").replace("\n", " ")
    assert "mass, centre" not in shown and "speed of joints" not in shown
    assert f"next: motionfmu run {arm_folder}/example.job --machine {arm_folder}" in shown


@pytest.mark.parametrize("low, high", [(-2.0, 0.03), (-0.03, 2.0), (-2.0, -1.2), (-0.04, 0.06)])
def test_the_start_is_beside_the_singular_place(low: float, high: float, tmp_path: Path) -> None:
    text = SMALL.read_text(encoding="utf-8")
    pitch = 'lower="-2" upper="2" velocity="6"'
    assert text.count(pitch) == 1
    file = tmp_path / "short.urdf"
    file.write_text(text.replace(pitch, f'lower="{low}" upper="{high}" velocity="6"'))
    told("import", file, "-o", tmp_path / "short")
    machine = tomllib.loads((tmp_path / "short/machine.toml").read_text(encoding="utf-8"))
    fifth = np.radians(machine["set"]["*.start_joint"][4])
    rounded = np.radians(1e-6)  # as the file has all angles
    assert low - rounded <= fifth <= high + rounded
    geometry = opw_geometry(urdf_arm(SMALL))
    inner = geometry.signs[4] * np.array([fifth, low, high]) - geometry.offsets[4]
    most = np.abs(np.sin(inner))
    assert most[0] >= min(0.1, most[1:].max()) - rounded


def test_each_value_of_the_geometry_is_written_once(arm_folder):
    given = tomllib.loads((arm_folder / "machine.toml").read_text(encoding="utf-8"))["set"]
    assert {"*.a1", "*.c3", "*.joint_sign", "*.gear_ratio", "*.start_joint"} <= given.keys()
    assert not {"soft.a1", "arm.a1", "soft.gear_ratio", "arm.start_joint"} & given.keys()
    machine = run.machine(arm_folder)
    assert machine.plan().disagreements({}) == []
    (apart,) = machine.plan().disagreements({"arm.c3": 0.4})
    assert "both mean arm.c3" in apart


def test_a_line_and_joint_moves_run_within_the_limits(arm_run, arm_folder):
    assert arm_run.ok
    own = arm_machine(run.machine(arm_folder))
    limits = own.arm.joints
    q = arm_run["soft.joint_command"]
    rate = np.abs(arm_run["soft.joint_rate"]) / [j.speed for j in limits]
    assert 0.2 < rate.max() <= 1.0 + 1e-6
    assert (q >= [j.low - 1e-9 for j in limits]).all()
    assert (q <= [j.high + 1e-9 for j in limits]).all()
    assert np.abs(q[-1] - q[0]).max() < 1e-6, "home again"
    assert np.ptp(arm_run["soft.tool_position"], axis=0).max() > 0.1


def test_controller_and_plant_have_the_tip_of_the_urdf(arm_run):
    """Commanded, and of the links behind their gears: place and attitude, to 1e-9."""
    arm = urdf_arm(SMALL)
    commanded = arm.forward(arm_run["soft.joint_command"])
    assert arm_run["soft.tool_position"] == pytest.approx(commanded[:, :3, 3], abs=1e-9)
    real = arm.forward(arm_run["arm.link_angle"])
    assert arm_run["arm.tool_position"] == pytest.approx(real[:, :3, 3], abs=1e-9)
    w, x, y, z = arm_run["arm.tool_quaternion"].T
    ahead = np.column_stack([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)])
    assert ahead == pytest.approx(real[:, :3, 0], abs=1e-9)


def test_the_plant_weighs_what_the_urdf_says(arm_folder):
    """Torques of the machine's arm at 200 random states: whole tensors, to nine digits."""
    arm, own = urdf_arm(SMALL), arm_machine(run.machine(arm_folder)).arm
    q, v, a = np.random.default_rng(1).uniform(-3.0, 3.0, (3, 200, 6))
    torque = arm.inverse_dynamics(q, v, a)
    assert own.inverse_dynamics(q, v, a) == pytest.approx(torque, abs=1e-8 * np.abs(torque).max())
    assert own.forward(q) == pytest.approx(arm.forward(q), abs=1e-9)


def test_an_exported_urdf_is_the_same_arm(arm_folder, tmp_path):
    shown = told("export", arm_folder, "--urdf", "-o", tmp_path / "again.urdf")
    assert "6 joints, 21.8 kg, tip tool0" in shown
    again, own = urdf_arm(tmp_path / "again.urdf"), arm_machine(run.machine(arm_folder)).arm
    q, v, a = np.random.default_rng(2).uniform(-3.0, 3.0, (3, 50, 6))
    torque = own.inverse_dynamics(q, v, a)
    assert again.inverse_dynamics(q, v, a) == pytest.approx(
        torque, abs=1e-12 * np.abs(torque).max()
    )
    assert again.forward(q) == pytest.approx(own.forward(q), abs=1e-13)
    assert opw_geometry(again).deviation < 1e-12
    # What it says again needs no second guess: gears and torques come back.
    assert [j.ratio for j in again.joints] == [j.ratio for j in own.joints]
    assert "<mujoco" in _mjcf(arm_folder, tmp_path)


def _mjcf(arm_folder: Path, tmp_path: Path) -> str:
    told("export", arm_folder, "--mjcf", "--set", "arm.c3=0.5", "-o", tmp_path / "again.xml")
    return (tmp_path / "again.xml").read_text(encoding="utf-8")


def test_links_without_mass_and_a_known_torque(tmp_path):
    """What is missing is taken by size; a torque that does not bear the motion is told."""
    text = SMALL.read_text(encoding="utf-8")
    at = text.index("<inertial>", text.index('name="forearm"'))
    text = text[:at] + text[text.index("</inertial>", at) + len("</inertial>") :]
    text = text.replace('velocity="4" effort="0"', 'velocity="4" effort="5"')
    file = tmp_path / "other.urdf"
    file.write_text(text, encoding="utf-8")
    shown = told("import", file, "-o", tmp_path / "other")
    assert "mass, centre, inertia of forearm" in shown
    assert "the description's is too small: waist: 5 of " in shown
    given = tomllib.loads((tmp_path / "other/machine.toml").read_text(encoding="utf-8"))["set"]
    # robot6 has 9 kg there, at 1.65 m of reach: (0.73/1.65)^2.3 of it.
    assert given["arm.mass"][3] == pytest.approx(9 * (0.7314 / 1.6532) ** 2.3, rel=2e-3)


def refused(*words: str | Path) -> str:
    with pytest.raises(InputError) as error:
        told(*words)
    return str(error.value)


def test_what_cannot_be_driven_is_named(tmp_path, arm_folder):
    text = SMALL.read_text(encoding="utf-8")
    file = tmp_path / "slide.urdf"
    slide = 'name="waist" type="prismatic"'
    file.write_text(text.replace('name="waist" type="revolute"', slide), encoding="utf-8")
    shown = refused("import", file, "-o", tmp_path / "slide")
    assert "slide.urdf: small_arm is a chain of 6 joints (PRRRRR); missing: drives" in shown
    assert "it cannot be driven yet" in shown
    assert not (tmp_path / "slide").exists()
    assert "is there already" in refused("import", SMALL, "-o", arm_folder)
    assert refused("import", SMALL, "--step", "1e-3") == "--stop and --step are for an SSP"
    assert refused("import", "some.ssp", "--tip", "flange") == "--tip is for a URDF"
    assert "it has no arm" in refused("export", "mill3", "--urdf")
    assert "no link 'x'" in refused("import", SMALL, "--tip", "x")
