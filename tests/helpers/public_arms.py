"""Arms of several makers by their public descriptions, as ours and as pinocchio's."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import pinocchio
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

Array = NDArray[np.float64]
Row = tuple[float, float, float]
HALF = np.pi / 2


@dataclass(frozen=True)
class Joint:
    """A joint as a URDF has it: its frame in the one before it, and its axis in its own."""

    xyz: tuple[float, float, float]
    rpy: tuple[float, float, float] = (0.0, 0.0, 0.0)
    axis: tuple[float, float, float] = (0.0, 0.0, 1.0)
    slides: bool = False
    level: int = 0

    def turn(self) -> Array:
        return Rotation.from_euler("xyz", self.rpy).as_matrix()


@dataclass(frozen=True)
class PublicArm:
    """Joints from the base on, and the flange behind the last one; lengths in m."""

    joints: tuple[Joint, ...]
    flange: Joint = field(default_factory=lambda: Joint((0.0, 0.0, 0.0)))

    def straight(self) -> tuple[Array, Array, Array, Array]:
        """Origins and axes of joints, place and turn of the flange, all at zero by the base."""
        turn = np.eye(3)
        origins, axes = [], []
        for joint in self.joints:
            origins.append(turn @ joint.xyz)
            turn = turn @ joint.turn()
            axes.append(turn @ joint.axis)
        return (
            np.array(origins),
            np.array(axes),
            turn @ self.flange.xyz,
            turn @ self.flange.turn(),
        )

    def model(self) -> tuple[pinocchio.Model, Array]:
        """The same arm of pinocchio, frame by frame, and its joints by those of the arm.

        A linkage that keeps a link level is a joint more, which turns back what others turn.
        """
        model = pinocchio.Model()
        parent, rows = 0, []
        for number, joint in enumerate(self.joints):
            place = pinocchio.SE3(joint.turn(), np.array(joint.xyz))
            own = np.eye(len(self.joints))[number]
            if joint.level:
                back = self.joints[number - 1]
                linkage = pinocchio.JointModelRevoluteUnaligned(-np.array(back.axis))
                parent = model.addJoint(parent, linkage, place, f"linkage {number}")
                rows.append(sum(np.eye(len(self.joints))[number - joint.level : number]))
                place = pinocchio.SE3.Identity()
            kind = (
                pinocchio.JointModelPrismaticUnaligned
                if joint.slides
                else pinocchio.JointModelRevoluteUnaligned
            )
            parent = model.addJoint(parent, kind(np.array(joint.axis)), place, f"joint {number}")
            rows.append(own)
        end = pinocchio.SE3(self.flange.turn(), np.array(self.flange.xyz))
        model.addFrame(pinocchio.Frame("flange", parent, 0, end, pinocchio.FrameType.OP_FRAME))
        return model, np.array(rows)


def turned_at_zero(
    axes: Array, ways: Sequence[Row], flange: Row, at_zero: Sequence[float]
) -> PublicArm:
    """An arm by axes along x, y, z and ways at angles `at_zero` of its joints [rad]."""
    joints = [
        Joint(way, tuple(-angle * np.abs(axis)), tuple(axis))
        for axis, way, angle in zip(axes, ways, at_zero, strict=True)
    ]
    return PublicArm(tuple(joints), Joint(flange))


def by_dh(rows: tuple[tuple[float, float, float], ...]) -> PublicArm:
    """An arm of turning joints by its Denavit-Hartenberg table: d, a [m], alpha [rad] of each."""
    joints = []
    xyz, roll = (0.0, 0.0, 0.0), 0.0
    for d, a, alpha in rows:
        joints.append(Joint(xyz, (roll, 0.0, 0.0)))
        xyz, roll = (a, 0.0, d), alpha
    return PublicArm(tuple(joints), Joint(xyz, (roll, 0.0, 0.0)))


def universal(d: tuple[float, float, float, float], a: tuple[float, float]) -> PublicArm:
    """An arm of Universal Robots: d1, d4, d5, d6 and a2, a3 [m], as ur_description has it."""
    (d1, d4, d5, d6), (a2, a3) = d, a
    right = 1.570796327
    return PublicArm(
        (
            Joint((0, 0, d1)),
            Joint((0, 0, 0), (right, 0, 0)),
            Joint((a2, 0, 0)),
            Joint((a3, 0, d4)),
            Joint((0, -d5, -2.044881182297852e-11), (right, 0, 0)),
            Joint((0, d6, -2.042830148012698e-11), (1.570796326589793, np.pi, np.pi)),
        ),
        Joint((0, 0, 0), (0, -HALF, -HALF)),
    )


# Sources: ur_description, iiwa_description, franka_description, and abb_irb2600_support,
# fanuc_lrmate200id_support, fanuc_crx10ia_support, kuka_kr6_support of ros-industrial; Puma 560:
# Corke, Robotics, Vision and Control; RH-6FH55 and IRB 460: data sheets.
ARMS = {
    "UR5e": universal((0.1625, 0.1333, 0.0997, 0.0996), (-0.425, -0.3922)),
    "UR10e": universal((0.1807, 0.17415, 0.11985, 0.11655), (-0.6127, -0.57155)),
    "KR 6 R700": PublicArm(
        (
            Joint((0, 0, 0.4), axis=(0, 0, -1)),
            Joint((0.025, 0, 0), axis=(0, 1, 0)),
            Joint((0.315, 0, 0), axis=(0, 1, 0)),
            Joint((0, 0, 0.035), axis=(-1, 0, 0)),
            Joint((0.365, 0, 0), axis=(0, 1, 0)),
            Joint((0.08, 0, 0), axis=(-1, 0, 0)),
        ),
        Joint((0, 0, 0), (0, HALF, 0)),
    ),
    "IRB 2600": PublicArm(
        (
            Joint((0, 0, 0.445)),
            Joint((0.15, 0, 0), axis=(0, 1, 0)),
            Joint((0, 0, 0.7), axis=(0, 1, 0)),
            Joint((0, 0, 0.115), axis=(1, 0, 0)),
            Joint((0.795, 0, 0), axis=(0, 1, 0)),
            Joint((0.085, 0, 0), axis=(1, 0, 0)),
        ),
        Joint((0, 0, 0), (0, HALF, 0)),
    ),
    "LR Mate 200iD": PublicArm(
        (
            Joint((0, 0, 0.33)),
            Joint((0.05, 0, 0), axis=(0, 1, 0)),
            Joint((0, 0, 0.44), axis=(0, -1, 0)),
            Joint((0, 0, 0.035), axis=(-1, 0, 0)),
            Joint((0.42, 0, 0), axis=(0, -1, 0)),
            Joint((0.08, 0, 0), axis=(-1, 0, 0)),
        ),
        Joint((0, 0, 0), (np.pi, -HALF, 0)),
    ),
    "Puma 560": by_dh(
        (
            (0, 0, HALF),
            (0, 0.4318, 0),
            (0.15005, 0.0203, -HALF),
            (0.4318, 0, HALF),
            (0, 0, -HALF),
            (0, 0, 0),
        )
    ),
    "RH-6FH55": PublicArm(
        (
            Joint((0, 0, 0.4)),
            Joint((0.325, 0, 0)),
            Joint((0.225, 0, 0), axis=(0, 0, -1), slides=True),
            Joint((0, 0, 0), axis=(0, 0, -1)),
        )
    ),
    "IRB 460": PublicArm(
        (
            Joint((0, 0, 0.7425)),
            Joint((0.26, 0, 0), axis=(0, 1, 0)),
            Joint((0, 0, 0.945), axis=(0, 1, 0)),
            Joint((1.025, 0, 0), axis=(0, 0, -1), level=2),
        ),
        Joint((0.22, 0, -0.2825)),
    ),
    "iiwa 7": PublicArm(
        (
            Joint((0, 0, 0.15)),
            Joint((0, 0, 0.19), (HALF, 0, np.pi)),
            Joint((0, 0.21, 0), (HALF, 0, np.pi)),
            Joint((0, 0, 0.19), (HALF, 0, 0)),
            Joint((0, 0.21, 0), (-HALF, np.pi, 0)),
            Joint((0, 0.0607, 0.19), (HALF, 0, 0)),
            Joint((0, 0.081, 0.0607), (-HALF, np.pi, 0)),
        ),
        Joint((0, 0, 0.045)),
    ),
    "Panda": PublicArm(
        (
            Joint((0, 0, 0.333)),
            Joint((0, 0, 0), (-HALF, 0, 0)),
            Joint((0, -0.316, 0), (HALF, 0, 0)),
            Joint((0.0825, 0, 0), (HALF, 0, 0)),
            Joint((-0.0825, 0.384, 0), (-HALF, 0, 0)),
            Joint((0, 0, 0), (HALF, 0, 0)),
            Joint((0.088, 0, 0), (HALF, 0, 0)),
        ),
        Joint((0, 0, 0.107)),
    ),
    "CRX-10iA": PublicArm(
        (
            Joint((0, 0, 0.245)),
            Joint((0, 0, 0), axis=(0, 1, 0)),
            Joint((0, 0, 0.71), axis=(0, -1, 0)),
            Joint((0, 0, 0), axis=(-1, 0, 0)),
            Joint((0.54, 0, 0), axis=(0, -1, 0)),
            Joint((0.16, -0.15, 0), axis=(-1, 0, 0)),
        ),
        Joint((0, 0, 0), (np.pi, -HALF, 0)),
    ),
    "gantry": PublicArm(
        (
            Joint((0, 0, 2.0), axis=(1, 0, 0), slides=True),
            Joint((0.1, 0, 0.2), axis=(0, 1, 0), slides=True),
            Joint((0, 0.1, -0.3), axis=(0, 0, -1), slides=True),
            Joint((0, 0, -0.2)),
            Joint((0, 0.05, -0.1), axis=(0, 1, 0)),
            Joint((0, 0, -0.15)),
        ),
        Joint((0, 0, -0.1)),
    ),
    "gantry of four": PublicArm(
        (
            Joint((0, 0, 2.0), axis=(1, 0, 0), slides=True),
            Joint((0.1, 0, 0.2), axis=(0, 1, 0), slides=True),
            Joint((0, 0.1, -0.3), axis=(0, 0, -1), slides=True),
            Joint((0.2, 0, -0.2)),
        ),
        Joint((0.1, 0, -0.1)),
    ),
}
