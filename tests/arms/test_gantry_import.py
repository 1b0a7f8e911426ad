"""A gantry's URDF becomes a machine whose first three joints slide, and its job runs."""

from pathlib import Path

import numpy as np
import pytest
from few_cases import few
from made_arm import told
from random_arms import PinocchioChain

from motionfmu import run
from motionfmu.arm_machines import arm_machine
from motionfmu.arms import AxesGeometry, driven_geometry, urdf_arm

# Axis, way from the joint before [m], range [m] and mass [kg] of what slides.
SLIDES = [("1 0 0", "0 0 1.2", "0", "1.5", 30), ("0 1 0", "0 0 0.1", "-0.4", "0.4", 15),
          ("0 0 -1", "0 0 -0.2", "0", "0.5", 8)]  # fmt: skip


def gantry(wrist: list[str]) -> str:
    """The URDF of a gantry with the axes of its wrist."""
    rows = SLIDES + [(axis, "0 0 -0.1", "-3", "3", 1.5) for axis in wrist]
    text = '<robot name="gantry"><link name="l0"/>'
    for k, (axis, way, low, high, mass) in enumerate(rows, 1):
        kind = "prismatic" if k < 4 else "revolute"
        text += (
            f'<link name="l{k}"><inertial><origin xyz="0.01 0 0.02"/><mass value="{mass}"/>'
            '<inertia ixx="0.1" iyy="0.1" izz="0.08" ixy="0" ixz="0" iyz="0"/></inertial></link>'
            f'<joint name="j{k}" type="{kind}"><parent link="l{k - 1}"/><child link="l{k}"/>'
            f'<origin xyz="{way}"/><axis xyz="{axis}"/>'
            f'<limit lower="{low}" upper="{high}" velocity="1" effort="0"/></joint>'
        )
    end = f'<link name="tool0"/><joint name="end" type="fixed"><parent link="l{len(rows)}"/>'
    down = '<child link="tool0"/><origin xyz="0 0 -0.05" rpy="3.141592653589793 0 0"/></joint>'
    return f"{text}{end}{down}</robot>"


WRISTS = [[], ["0 0 1"], ["0 0 1", "0 1 0", "0 0 1"]]


@pytest.mark.parametrize("wrist", few(WRISTS, WRISTS[2:]))
def test_a_gantry_runs(wrist: list[str], tmp_path: Path) -> None:
    file, folder = tmp_path / "gantry.urdf", tmp_path / "machine"
    file.write_text(gantry(wrist), encoding="utf-8")
    shown = told("import", file, "-o", folder)
    assert "driven by its axes, as a gantry" in shown
    arm = urdf_arm(file)
    geometry, oracle = driven_geometry(arm), PinocchioChain(file.read_text(), arm)
    assert isinstance(geometry, AxesGeometry) and geometry.sliding == [0, 1, 2]
    count = 3 + len(wrist)
    for q in np.random.default_rng(5).uniform(-0.4, 0.4, (10, count)):
        tip = geometry.frames(q)[-1] @ geometry.flange
        assert tip == pytest.approx(oracle.tip(q), abs=1e-10)
    result = run.machine(folder).scenario(folder / "example.job").run()
    assert result.ok
    joints = arm_machine(run.machine(folder)).arm.joints
    q, rate = result["soft.joint_command"], np.abs(result["soft.joint_rate"])
    assert len(joints) == count and (q[:, count:] == 0.0).all()
    assert (rate[:, :count] <= np.array([j.speed for j in joints]) * (1 + 1e-6)).all()
    assert (q[:, :count] <= np.array([j.high for j in joints]) + 1e-9).all()
    assert rate[:, :3].max() > 0.05  # m/s: it moves by what slides
    tips = (geometry.frames(q[:, :count])[-1] @ geometry.flange)[:, :3, 3]
    assert result["soft.tool_position"] == pytest.approx(tips, abs=1e-9)
