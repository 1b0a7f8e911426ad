"""An arm as a URDF."""

import math
from collections.abc import Iterable, Iterator
from xml.sax.saxutils import quoteattr

import numpy as np

from motionfmu.arms.arm_description import (
    ArmDescription,
    ArmJoint,
    Array,
    LinkShape,
    RigidLink,
    angles_of,
)


def urdf_text(arm: ArmDescription) -> str:
    """Write an arm as a URDF.

    A gear ratio is a transmission; an acceleration has no place in a URDF.

    Parameters
    ----------
    arm : ArmDescription

    Returns
    -------
    str
    """
    lines = ['<?xml version="1.0"?>', f"<robot name={quoteattr(arm.name)}>"]
    lines += _link(arm.base)
    before = arm.base.name
    for joint in arm.joints:
        lines += _link(joint.link)
        lines += _joint(joint, before, arm)
        before = joint.link.name
    if arm.tip not in {arm.base.name, *(j.link.name for j in arm.joints)}:
        lines += [f"  <link name={quoteattr(arm.tip)}/>"]
        name = f"{before}-{arm.tip}"
        lines += [
            f'  <joint name={quoteattr(name)} type="fixed">',
            f"    {_origin(arm.tip_frame)}",
            f"    <parent link={quoteattr(before)}/>",
            f"    <child link={quoteattr(arm.tip)}/>",
            "  </joint>",
        ]
    for joint in arm.joints:
        if joint.ratio is not None:
            lines += _transmission(joint)
    return "\n".join([*lines, "</robot>"]) + "\n"


def numbers(values: Iterable[float] | Array) -> str:
    """Numbers with all their digits."""
    return " ".join(repr(float(x) + 0.0) for x in np.ravel(np.asarray(values, dtype=float)))


def _origin(frame: Array) -> str:
    return f'<origin xyz="{numbers(frame[:3, 3])}" rpy="{numbers(angles_of(frame[:3, :3]))}"/>'


def _link(link: RigidLink) -> Iterator[str]:
    if not link.mass and not link.shapes:
        yield f"  <link name={quoteattr(link.name)}/>"
        return
    yield f"  <link name={quoteattr(link.name)}>"
    if link.mass:
        (xx, xy, xz), (_, yy, yz), (_, _, zz) = link.tensor
        values = {"ixx": xx, "ixy": xy, "ixz": xz, "iyy": yy, "iyz": yz, "izz": zz}
        given = " ".join(f'{k}="{numbers([v])}"' for k, v in values.items())
        yield "    <inertial>"
        yield f'      <origin xyz="{numbers(link.center)}" rpy="0 0 0"/>'
        yield f'      <mass value="{numbers([link.mass])}"/>'
        yield f"      <inertia {given}/>"
        yield "    </inertial>"
    for shape in link.shapes:
        yield f"    <{shape.use}>"
        yield f"      {_origin(shape.origin)}"
        yield f"      <geometry>{_geometry(shape)}</geometry>"
        yield f"    </{shape.use}>"
    yield "  </link>"


def _geometry(shape: LinkShape) -> str:
    if shape.kind == "box":
        return f'<box size="{numbers(shape.size)}"/>'
    if shape.kind == "sphere":
        return f'<sphere radius="{numbers(shape.size)}"/>'
    if shape.kind == "cylinder":
        radius, length = shape.size
        return f'<cylinder radius="{numbers([radius])}" length="{numbers([length])}"/>'
    return f'<mesh filename={quoteattr(shape.mesh)} scale="{numbers(shape.size)}"/>'


def _joint(joint: ArmJoint, before: str, arm: ArmDescription) -> Iterator[str]:
    yield f'  <joint name={quoteattr(joint.name)} type="{joint.kind}">'
    yield f"    {_origin(joint.origin)}"
    yield f"    <parent link={quoteattr(before)}/>"
    yield f"    <child link={quoteattr(joint.link.name)}/>"
    yield f'    <axis xyz="{numbers(joint.axis)}"/>'
    limits = {"lower": joint.low, "upper": joint.high, "effort": joint.effort}
    limits["velocity"] = 0.0 if math.isinf(joint.speed) else joint.speed
    given = " ".join(f'{k}="{numbers([v])}"' for k, v in limits.items() if not math.isinf(v))
    yield f"    <limit {given}/>"
    if joint.damping or joint.friction:
        damping, friction = joint.damping or 0.0, joint.friction or 0.0
        yield f'    <dynamics damping="{numbers([damping])}" friction="{numbers([friction])}"/>'
    if joint.follows is not None:
        leader, factor, offset = joint.follows
        name = quoteattr(arm.joints[leader].name)
        given = f'multiplier="{numbers([factor])}" offset="{numbers([offset])}"'
        yield f"    <mimic joint={name} {given}/>"
    yield "  </joint>"


def _transmission(joint: ArmJoint) -> Iterator[str]:
    name = quoteattr(joint.name)
    ratio = numbers([joint.ratio or 1.0])
    yield f"  <transmission name={quoteattr(f'{joint.name}_gear')}>"
    yield "    <type>transmission_interface/SimpleTransmission</type>"
    yield f"    <joint name={name}/>"
    yield f"    <actuator name={quoteattr(f'{joint.name}_motor')}>"
    yield f"      <mechanicalReduction>{ratio}</mechanicalReduction>"
    yield "    </actuator>"
    yield "  </transmission>"
