"""An arm as a model of MuJoCo, MJCF."""

import math
from collections.abc import Iterator
from xml.sax.saxutils import quoteattr

import numpy as np

from motionfmu.arms.arm_description import ArmDescription, ArmJoint, Array, G, RigidLink
from motionfmu.arms.urdf_text import numbers

# MuJoCo refuses a body that moves without mass or inertia.
LEAST_MASS, LEAST_INERTIA = 1e-6, 1e-9
WORLD = "world"  # what MuJoCo calls the body around all
_GEOMS = {"box": "box", "sphere": "sphere", "cylinder": "cylinder"}


def mjcf_text(arm: ArmDescription) -> str:
    """Write an arm as MJCF.

    Motors of torque drive the joints; meshes, which MuJoCo wants beside the file, are left out.

    Parameters
    ----------
    arm : ArmDescription

    Returns
    -------
    str
    """
    lines = [f"<mujoco model={quoteattr(arm.name)}>"]
    lines.append('  <compiler angle="radian" autolimits="true" balanceinertia="false"/>')
    lines.append(f'  <option gravity="0 0 {numbers([-G])}" integrator="implicitfast"/>')
    lines.append("  <worldbody>")
    base = "base" if arm.base.name == WORLD else arm.base.name
    lines.append(f"    <body name={quoteattr(base)}>")
    lines += _indented(3, [*_inertial(arm.base, False), *_geoms(arm.base)])
    for depth, joint in enumerate(arm.joints):
        lines += _indented(3 + depth, _body(joint))
    depth = 3 + len(arm.joints)
    site = f"<site name={quoteattr(arm.tip)} {_frame(arm.tip_frame)}/>"
    lines += _indented(depth, [site])
    lines += ["  " * k + "</body>" for k in range(depth - 1, 1, -1)]
    lines.append("  </worldbody>")
    lines += _equalities(arm)
    lines.append("  <actuator>")
    for joint in arm.driven:
        limit = f' ctrlrange="{numbers([-joint.effort, joint.effort])}"' if joint.effort else ""
        lines.append(f"    <motor joint={quoteattr(joint.name)}{limit}/>")
    return "\n".join([*lines, "  </actuator>", "</mujoco>"]) + "\n"


def _indented(depth: int, lines: list[str]) -> list[str]:
    return ["  " * depth + line for line in lines]


def _body(joint: ArmJoint) -> list[str]:
    """The start of a body and all in it but the next one."""
    kind = "slide" if joint.slides else "hinge"
    given = [f'name={quoteattr(joint.name)} type="{kind}" axis="{numbers(joint.axis)}"']
    if not math.isinf(joint.low):
        given.append(f'range="{numbers([joint.low, joint.high])}"')
    if joint.damping:
        given.append(f'damping="{numbers([joint.damping])}"')
    if joint.friction:
        given.append(f'frictionloss="{numbers([joint.friction])}"')
    inner = [f"<joint {' '.join(given)}/>", *_inertial(joint.link, True), *_geoms(joint.link)]
    name = quoteattr(joint.link.name)
    return [f"<body name={name} {_frame(joint.origin)}>", *(f"  {line}" for line in inner)]


def _inertial(link: RigidLink, moves: bool) -> Iterator[str]:
    mass, tensor = link.mass, link.tensor
    if not mass and not moves:
        return
    if mass < LEAST_MASS or np.linalg.eigvalsh(tensor)[0] < LEAST_INERTIA:
        mass, tensor = max(mass, LEAST_MASS), tensor + LEAST_INERTIA * np.eye(3)
    elements = [tensor[i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]
    given = f'pos="{numbers(link.center)}" mass="{numbers([mass])}"'
    yield f'<inertial {given} fullinertia="{numbers(elements)}"/>'


def _geoms(link: RigidLink) -> Iterator[str]:
    for shape in link.shapes:
        if shape.kind not in _GEOMS or min(shape.size) <= 0.0:
            continue
        size = shape.size
        if shape.kind == "box":
            size = tuple(x / 2.0 for x in size)
        elif shape.kind == "cylinder":
            size = (size[0], size[1] / 2.0)
        seen = ' contype="0" conaffinity="0" group="2"' if shape.use == "visual" else ' group="3"'
        kind = _GEOMS[shape.kind]
        yield f'<geom type="{kind}" size="{numbers(size)}" {_frame(shape.origin)} mass="0"{seen}/>'


def _frame(frame: Array) -> str:
    return f'pos="{numbers(frame[:3, 3])}" quat="{numbers(quaternion(frame[:3, :3]))}"'


def quaternion(turn: Array) -> Array:
    """w, x, y, z of a rotation, by its largest element (Shepperd 1978)."""
    squares = np.array([
        1.0 + turn[0, 0] + turn[1, 1] + turn[2, 2], 1.0 + turn[0, 0] - turn[1, 1] - turn[2, 2],
        1.0 - turn[0, 0] + turn[1, 1] - turn[2, 2], 1.0 - turn[0, 0] - turn[1, 1] + turn[2, 2],
    ])  # fmt: skip
    a, b, c = (turn[2, 1], turn[1, 2]), (turn[0, 2], turn[2, 0]), (turn[1, 0], turn[0, 1])
    less, more = (lambda p: p[0] - p[1]), (lambda p: p[0] + p[1])
    rows = (
        (squares[0], less(a), less(b), less(c)),
        (less(a), squares[1], more(c), more(b)),
        (less(b), more(c), squares[2], more(a)),
        (less(c), more(b), more(a), squares[3]),
    )
    found = np.array(rows[int(np.argmax(squares))])
    return np.asarray(found / np.linalg.norm(found))


def _equalities(arm: ArmDescription) -> Iterator[str]:
    followers = [(j.name, *j.follows) for j in arm.joints if j.follows is not None]
    if not followers:
        return
    yield "  <equality>"
    for name, leader, factor, offset in followers:
        names = f"joint1={quoteattr(name)} joint2={quoteattr(arm.joints[leader].name)}"
        yield f'    <joint {names} polycoef="{numbers([offset, factor, 0, 0, 0])}"/>'
    yield "  </equality>"
