"""A palletizer's URDF becomes a machine of four joints with a level hand, and its job runs."""

import tomllib
from pathlib import Path

import mujoco
import numpy as np
import pytest
from random_arms import PinocchioChain
from typer.testing import CliRunner

from motionfmu import run
from motionfmu.analysis.collisions.arm_parts import ArmParts
from motionfmu.arm_machines import arm_machine
from motionfmu.arms import (
    AxesGeometry,
    NoOpwGeometry,
    driven_geometry,
    kind_of,
    mjcf_text,
    table_arm,
    urdf_arm,
    urdf_text,
)
from motionfmu.arms.linkage import linkage_of
from motionfmu.arms.urdf_reader import urdf_text_arm
from motionfmu.base.errors import InputError
from motionfmu.cli import app

# Joint, axis, way from the one before [m], range [deg], mass [kg], leader and multiplier.
SERIAL = [
    ("turn", "0 0 1", "0 0 0.4", 180, 60, None),
    ("shoulder", "0 1 0", "0.26 0 0.34", 60, 40, None),
    ("elbow", "0 1 0", "0 0 0.9", 70, 30, None),
    ("rod", "0 1 0", "1.0 0 0", 0, 0, ("shoulder", -1.0)),
    ("wrist", "0 -1 0", "0 0.05 0", 0, 12, ("elbow", 1.0)),
    ("flange", "0 0 -1", "0.2 0 -0.1", 350, 3, None),
]
# The forearm driven from the base: its joint counts from the level, upwards.
DRIVEN = [
    *SERIAL[:2],
    ("plate", "0 1 0", "0 0 0.9", 0, 0, ("shoulder", -1.0)),
    ("fore", "0 -1 0", "0 0 0", 35, 30, None),
    ("wrist", "0 1 0", "1.0 0 0", 0, 12, ("fore", 1.0)),
    SERIAL[5],
]
KINDS = {"serial": SERIAL, "driven": DRIVEN}


def urdf(rows: list) -> str:
    """Links have masses beside their joints, and whole tensors."""
    text, before = '<robot name="pal"><link name="base"/>', "base"
    for name, axis, way, most, mass, leader in rows:
        body = (
            f'<inertial><origin xyz="0.1 0.02 0.05"/><mass value="{mass}"/><inertia ixx="0.8" '
            'iyy="0.9" izz="0.5" ixy="0.02" ixz="0.03" iyz="-0.01"/></inertial>'
        )
        tied = f'<mimic joint="{leader[0]}" multiplier="{leader[1]}"/>' if leader else ""
        end = np.radians(most or 200)
        text += (
            f'<link name="{name}_link">{body if mass else ""}</link>'
            f'<joint name="{name}" type="revolute"><parent link="{before}"/>'
            f'<child link="{name}_link"/><origin xyz="{way}"/><axis xyz="{axis}"/>'
            f'<limit lower="{-end}" upper="{end}" velocity="1.8" effort="0"/>{tied}</joint>'
        )
        before = f"{name}_link"
    tip = '<joint name="end" type="fixed"><parent link="flange_link"/><child link="tool0"/>'
    end = '<origin xyz="0.03 0 -0.15" rpy="3.141592653589793 0 0"/></joint></robot>'
    return f'{text}<link name="tool0"/>{tip}{end}'


@pytest.fixture(scope="module", params=KINDS)
def file(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The URDF of each kind."""
    place = tmp_path_factory.mktemp("palletizer") / f"{request.param}.urdf"
    place.write_text(urdf(KINDS[request.param]), encoding="utf-8")
    return place


def test_poses_are_pinocchio_s(file: Path) -> None:
    arm = urdf_arm(file)
    geometry, oracle = driven_geometry(arm), PinocchioChain(file.read_text(), arm)
    assert kind_of(arm) == "a palletizer" and isinstance(geometry, AxesGeometry)
    for q in np.random.default_rng(3).uniform(-3, 3, (1000, 4)):
        tip = geometry.frames(q)[-1] @ geometry.flange
        assert tip == pytest.approx(oracle.tip(arm.all_joints(q)), abs=1e-10)
        assert tip[:3, 2] == pytest.approx([0, 0, -1], abs=1e-10)
    there, back = (geometry.frames(q + s * 1e-6 * np.eye(4))[-1] for s in (1.0, -1.0))
    slope = ((there - back) @ geometry.flange)[:, :3, 3].T / 2e-6
    assert geometry.jacobian(q)[:3] == pytest.approx(slope, abs=1e-8)
    # Joints 1 and 4 alone turn the tool.
    assert geometry.jacobian(q)[3:] == pytest.approx(np.outer([0, 0, 1], [1, 0, 0, -1]), abs=1e-12)


def test_the_machine_says_what_the_file_says(file: Path, arm_folder: Path) -> None:
    shown = (arm_folder.parent / "told").read_text(encoding="utf-8")
    assert "pal to tool0, four joints" in shown and "driven by its axes, as a palletizer" in shown
    given = tomllib.loads((arm_folder / "machine.toml").read_text(encoding="utf-8"))["set"]
    assert given["*.joints"] == 4
    assert given["*.joint_level"] == [0, 0, int(file.stem == "driven"), 2, 0, 0]
    assert given["*.hand_offset"] == pytest.approx([0.2, 0, -0.1]) and given["arm.hand_mass"] == 12
    # Torques of what the machine has are those of the file.
    own, arm = arm_machine(run.machine(arm_folder)).arm, urdf_arm(file)
    random = np.random.default_rng(4)
    q, v, a = random.uniform(-3, 3, (3, 1000, 4))
    torque, wanted = own.inverse_dynamics(q, v, a), arm.inverse_dynamics(q, v, a)
    assert torque == pytest.approx(wanted, abs=1e-8 * np.abs(wanted).max())
    assert own.forward(q) == pytest.approx(arm.forward(q), abs=1e-9)
    assert [j.low for j in own.driven] == pytest.approx([j.low for j in arm.driven], abs=1e-7)


@pytest.mark.more
def test_its_job_runs_level(arm_folder: Path) -> None:
    """All four joints by a joint move and lines; the tool keeps level whatever its gears do."""
    points = (arm_folder / "example.points").read_text(encoding="utf-8")
    there = "P002 J1=25 J2=20 J3=-12 J4=40 J5=0 J6=0\n"
    (arm_folder / "all.points").write_text(points + there, encoding="utf-8")
    job = "//ALL\nMOVJ P002 VJ=50.00\nMOVL P000 V=400.0\nMOVL P001 V=400.0\nEND\n"
    (arm_folder / "all.job").write_text(job, encoding="utf-8")
    result = (
        run.machine(arm_folder)
        .scenario(arm_folder / "all.job", set={"arm.origin_error": 0.0})
        .run()
    )
    assert result.ok
    machine = arm_machine(run.machine(arm_folder))
    joints, geometry = machine.arm.driven, machine.geometry
    q, rate = result["soft.joint_command"], result["soft.joint_rate"]
    assert (np.abs(rate[:, :4]) <= np.array([j.speed for j in joints]) * (1 + 1e-6)).all()
    assert (q[:, :4] <= np.array([j.high for j in joints]) + 1e-9).all()
    assert np.ptp(q[:, :4], axis=0).min() > 0.2
    assert (q[:, 4:] == 0.0).all() and (result["card.pulse_count"][:, 4:] == 0).all()
    tips = (geometry.frames(q[:, :4])[-1] @ geometry.flange)[:, :3, 3]
    assert result["soft.tool_position"] == pytest.approx(tips, abs=1e-9)
    apart = np.linalg.norm(result["arm.tool_position"] - tips, axis=1)
    assert 1e-5 < apart[-1] < 4e-3
    w, x, y, z = result["arm.tool_quaternion"].T
    assert 2.0 * np.hypot(w * x + y * z, x * z - w * y).max() < 1e-12
    here = geometry.frames(result["arm.link_angle"][:, :4])[-1] @ geometry.flange
    assert result["arm.tool_position"] == pytest.approx(here[:, :3, 3], abs=1e-9)


def test_bars_for_collisions_are_where_the_links_are(arm_folder: Path) -> None:
    machine = arm_machine(run.machine(arm_folder))
    given = tomllib.loads((arm_folder / "machine.toml").read_text(encoding="utf-8"))["set"]
    rows = {n.partition(".")[2]: v for n, v in given.items() if not n.startswith("arm.")}
    parts = ArmParts.of({**rows, "joint_sign": [1] * 6})
    q = np.zeros((50, 6))
    q[:, :4] = np.random.default_rng(5).uniform(-3, 3, (50, 4))
    points = parts.points(np.degrees(q), np.zeros((50, 3)))
    for k, frame in enumerate(machine.geometry.frames(q[:, :4]), 1):
        assert points[:, k] == pytest.approx(1e3 * frame[:, :3, 3], abs=1e-9)


def test_another_tilt_is_refused_with_its_line(arm_folder: Path) -> None:
    points = (arm_folder / "example.points").read_text(encoding="utf-8")
    job = "//TILT\nMOVJ P000 VJ=50.00\nMOVL P002 V=100.0\nEND\n"
    (arm_folder / "tilt.job").write_text(job, encoding="utf-8")
    wrong = "P002 X=900 Y=100 Z=600 A=177 B=0 C=0\n"
    (arm_folder / "tilt.points").write_text(points + wrong, encoding="utf-8")
    shown = CliRunner().invoke(
        app, ["job", str(arm_folder / "tilt.job"), "--machine", str(arm_folder)]
    )
    text = " ".join(f"{shown.output} {shown.exception}".split())
    assert "line 3: " in text and "turns the tool so: 3 deg from the tilt" in text


def test_written_and_read_back(file: Path, arm_folder: Path) -> None:
    own = arm_machine(run.machine(arm_folder)).arm
    again = urdf_text_arm(urdf_text(own), "again.urdf")
    q = np.random.default_rng(6).uniform(-3, 3, (20, 4))
    assert again.forward(q) == pytest.approx(own.forward(q), abs=1e-12)
    assert driven_geometry(again).levels == driven_geometry(own).levels
    model = mujoco.MjModel.from_xml_string(mjcf_text(own))
    assert (model.nu, model.neq, model.nv) == (4, 2, 6)
    data = mujoco.MjData(model)
    for row in q:
        data.qpos[:] = own.all_joints(row)
        mujoco.mj_forward(model, data)
        assert data.site_xpos[0] == pytest.approx(own.forward(row)[:3, 3], abs=1e-9)
        assert np.abs(data.efc_pos[:2]).max() < 1e-12  # what follows is where the rods have it


def test_tables_say_it_too(tmp_path: Path) -> None:
    """The same arm by Denavit and Hartenberg and modified, without masses."""
    rows = {
        "dh": "d=740 a=260 alpha=-90|a=900 theta=-90|a=1000 theta=90|F2|F3 d=50 a=200 alpha=90"
        "|d=-100",
        "modified_dh": "d=740|a=260 alpha=-90 theta=-90|a=900 theta=90|a=1000 F2|F3 d=50"
        "|a=200 alpha=90 d=-100",
    }
    wanted = driven_geometry(urdf_text_arm(urdf(SERIAL), "serial.urdf"))
    q = np.random.default_rng(7).uniform(-3, 3, (20, 4))
    for convention, joints in rows.items():
        text = f'name = "pal"\nconvention = "{convention}"\n'
        for row in joints.split("|"):
            text += "[[joint]]\nlow = -170\nhigh = 170\nspeed = 100\n"
            for word in row.split():
                name, _, value = word.partition("=")
                text += f'follows = "joint_{word[1]}"\n' if not value else f"{name} = {value}\n"
        file = tmp_path / f"{convention}.toml"
        file.write_text(text, encoding="utf-8")
        found = driven_geometry(table_arm(file))
        assert isinstance(found, AxesGeometry) and found.levels == (0, 0, 0, 2)
        place = (found.frames(q)[-1] @ found.flange)[:, :3, 3]
        assert place == pytest.approx(wanted.frames(q)[-1][:, :3, 3], abs=1e-9)
        file.write_text(text.replace("joint_3", "joint_9"), encoding="utf-8")
        with pytest.raises(InputError, match="follows 'joint_9': no free joint before it"):
            table_arm(file)


WRONG = {
    "rod, wrist: what is behind tilts by 0.5 of shoulder": (3, 5, ("shoulder", -0.5)),
    "rod, wrist: what is behind tilts by 1 of elbow": (4, 5, ("elbow", 0.0)),
    "axes of joints 1 and 2 are at 45°, 90° wanted": (1, 1, "0 1 1"),
    "the axis of wrist is 90° from that of joint 3": (4, 1, "1 0 0"),
    "the axis of wrist is 30 mm beside that of rod": (4, 2, "0 0.05 0.03"),
    "missing: poses of 5 coordinates": (4, 5, None),
}


@pytest.mark.parametrize("why", WRONG)
def test_other_linkages_are_refused(why: str) -> None:
    place, column, value = WRONG[why]
    rows = [list(row) for row in SERIAL]
    rows[place][column] = value
    with pytest.raises(NoOpwGeometry, match=why.replace(".", r"\.")):
        driven_geometry(urdf_text_arm(urdf(rows), "wrong.urdf"))


def test_a_linkage_may_begin_at_an_angle() -> None:
    """What follows by an offset, too, keeps the hand as level as it was."""
    text = urdf(SERIAL).replace("<mimic ", '<mimic offset="0.1" ', 1)
    assert linkage_of(urdf_text_arm(text, "turned.urdf")).levels == (0, 0, 0, 2)


def test_a_link_between_pivots_has_no_mass(tmp_path: Path) -> None:
    rows = [list(row) for row in SERIAL]
    rows[3][4] = 2
    file = tmp_path / "rods.urdf"
    file.write_text(urdf(rows), encoding="utf-8")
    shown = CliRunner().invoke(app, ["import", str(file), "-o", str(tmp_path / "machine")])
    text = " ".join(f"{shown.output} {shown.exception}".split())
    assert "rod_link: a link between joints of the linkage has no place in the plant" in text
    assert not (tmp_path / "machine").exists()
