"""A boom slides on a turning column, which feels it by m r^2: what its motor is chosen for."""

from dataclasses import replace

import numpy as np
import pytest

from motionfmu.arm_machines.arm_values import _demands
from motionfmu.arms.urdf_reader import urdf_text_arm

MASS, LOW, HIGH = 12.0, 0.4, 1.2  # [kg] [m]
SPEED, CHANGE = (2.0, 1.0), (5.0, 3.0)  # of turn and slide
COLUMN = 0.1  # [kg.m^2]
BOOM = f"""<robot name="boom"><link name="foot"/>
<link name="column"><inertial><mass value="20"/>
<inertia ixx="0.4" iyy="0.4" izz="{COLUMN}" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="end"><inertial><mass value="{MASS}"/>
<inertia ixx="1e-9" iyy="1e-9" izz="1e-9" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="turn" type="revolute"><parent link="foot"/><child link="column"/>
<axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="{SPEED[0]}" effort="0"/></joint>
<joint name="slide" type="prismatic"><parent link="column"/><child link="end"/>
<origin xyz="0 0 0.5"/><axis xyz="1 0 0"/>
<limit lower="{LOW}" upper="{HIGH}" velocity="{SPEED[1]}" effort="0"/></joint></robot>"""


def test_what_a_turning_joint_feels_of_one_that_slides() -> None:
    """Found at 400 places, the farthest of which is a percent from the end of its range."""
    arm = urdf_text_arm(BOOM, "boom.urdf")
    joints = tuple(replace(j, acceleration=a) for j, a in zip(arm.joints, CHANGE, strict=True))
    torque, inertia = _demands(replace(arm, joints=joints))
    felt = COLUMN + MASS * HIGH**2
    assert 0.98 * felt < inertia[0] <= felt + 1e-6
    assert inertia[1] == pytest.approx(MASS)
    # It turns faster while the boom goes out, and the boom's end wants to the middle.
    turn = felt * CHANGE[0] + 2 * MASS * HIGH * SPEED[0] * SPEED[1]
    slide = MASS * (CHANGE[1] + HIGH * SPEED[0] ** 2)
    most = np.array([turn, slide])
    assert (0.97 * most < torque).all() and (torque <= most + 1e-6).all()
