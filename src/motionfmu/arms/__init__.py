"""Arms of any maker: read from URDF and tables, recognized, moved, written as URDF and MJCF."""

from motionfmu.arms.arm_axes import ArmGeometry, AxesGeometry, axes_geometry, driven_geometry
from motionfmu.arms.arm_description import ArmDescription, ArmJoint, LinkShape, RigidLink
from motionfmu.arms.arm_geometry import NoOpwGeometry, OpwGeometry, kind_of, opw_geometry
from motionfmu.arms.arm_table import table_arm
from motionfmu.arms.held_joint import held
from motionfmu.arms.mjcf_text import mjcf_text
from motionfmu.arms.urdf_reader import urdf_arm
from motionfmu.arms.urdf_text import urdf_text

__all__ = [
    "ArmDescription",
    "ArmGeometry",
    "ArmJoint",
    "AxesGeometry",
    "LinkShape",
    "NoOpwGeometry",
    "OpwGeometry",
    "RigidLink",
    "axes_geometry",
    "driven_geometry",
    "held",
    "kind_of",
    "mjcf_text",
    "opw_geometry",
    "table_arm",
    "urdf_arm",
    "urdf_text",
]
