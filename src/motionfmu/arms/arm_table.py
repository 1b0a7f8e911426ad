"""An arm from a table of its geometry: Denavit and Hartenberg, modified, or lengths of OPW.

    name       = "irb120"
    convention = "dh"                # dh, modified_dh, opw; lengths [mm], angles [deg]

    [[joint]]                        # from the base on
    d = 290                          # also a, alpha, theta, which are 0 if not given
    alpha = -90
    low = -165
    high = 165
    speed = 250

DH is T = Rz(theta + q) Tz(d) Tx(a) Rx(alpha), modified DH (Craig) is T = Rx(alpha) Tx(a)
Rz(theta + q) Tz(d), of a prismatic joint with d + q. OPW has its lengths in a table [opw] instead.
A joint with follows = "joint_2" has no q of its own: it is multiplier (-1) times that of a joint
before it. So a linkage keeps the hand of a palletizer level.
"""

import math
from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, model_validator

from motionfmu.arms.arm_description import (
    PRISMATIC,
    ArmDescription,
    ArmJoint,
    Array,
    RigidLink,
    about,
    joined,
    placed,
    turn_of,
)
from motionfmu.arms.arm_geometry import OpwGeometry
from motionfmu.base.toml_lines import model_of

MM = 1e-3
_X, _, _Z = np.eye(3)
Six = tuple[float, float, float, float, float, float]


class _TableKeys(BaseModel):
    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)


class _JointRow(_TableKeys):
    name: str | None = None  # what messages call it
    kind: Literal["revolute", "continuous", "prismatic"] = "revolute"  # how it moves
    a: float = 0.0  # [mm] length along x
    alpha: float = 0.0  # [deg] turn about x
    d: float = 0.0  # [mm] length along z
    theta: float = 0.0  # [deg] turn about z at angle 0
    sign: Literal[1, -1] = 1  # of the joint's angle
    follows: str | None = None  # name of the joint whose angle it has, multiplied
    multiplier: float = -1.0  # of that angle
    low: float | None = None  # [deg, mm] least angle or way
    high: float | None = None  # [deg, mm] largest angle or way
    speed: float | None = Field(default=None, gt=0.0)  # [deg/s, mm/s] largest
    acceleration: float | None = Field(default=None, gt=0.0)  # [deg/s2, mm/s2] largest
    torque: float = Field(default=0.0, ge=0.0)  # [N.m]
    ratio: float | None = Field(default=None, gt=0.0)  # turns of the motor for one of the joint
    mass: float = Field(default=0.0, ge=0.0)  # [kg]
    center: tuple[float, float, float] = (0.0, 0.0, 0.0)  # [mm] of mass, in the link's frame
    inertia: Six = (0.0,) * 6  # [kg.m2] xx, yy, zz, xy, yz, zx about the centre

    @model_validator(mode="after")
    def _ranged(self) -> "_JointRow":
        free = self.follows is None and self.kind != "continuous"
        if free and (self.low is None or self.high is None):
            raise ValueError("low and high are missing")
        if self.low is not None and self.high is not None and self.low >= self.high:
            raise ValueError(f"low = {self.low:g} is not below high = {self.high:g}")
        return self


class _OpwRow(_TableKeys):
    a1: float  # [mm] from axis 1 to axis 2, forward
    a2: float  # [mm] from axis 3 to axis 4
    b: float = 0.0  # [mm] sideways
    c1: float  # [mm] height of axis 2
    c2: float = Field(gt=0.0)  # [mm] upper arm
    c3: float = Field(gt=0.0)  # [mm] forearm
    c4: float  # [mm] from the wrist to the flange
    offset: Six = (0.0,) * 6  # [deg] of each joint
    sign: tuple[int, int, int, int, int, int] = (1,) * 6  # of each joint, 1 or -1

    @model_validator(mode="after")
    def _signed(self) -> "_OpwRow":
        if any(abs(s) != 1 for s in self.sign):
            raise ValueError("sign: 1 or -1 wanted")
        return self


class _TableFile(_TableKeys):
    name: str  # of the arm
    convention: Literal["dh", "modified_dh", "opw"]  # how the lengths are meant
    base: Six = (0.0,) * 6  # X Y Z A B C of the first frame
    tool: Six = (0.0,) * 6  # of the tip in the last one
    opw: _OpwRow | None = None
    joint: list[_JointRow] = Field(min_length=1)

    @model_validator(mode="after")
    def _tied(self) -> "_TableFile":
        leaders: list[str] = []
        for number, row in enumerate(self.joint, 1):
            name = row.name or f"joint_{number}"
            if row.follows is None:
                leaders.append(name)
            elif self.opw is not None:
                raise ValueError(f"{name}: joints of opw follow no other")
            elif row.follows not in leaders:
                known = ", ".join(leaders) or "none"
                raise ValueError(
                    f"{name}: follows {row.follows!r}: no free joint before it ({known})"
                )
        return self

    @model_validator(mode="after")
    def _consistent(self) -> "_TableFile":
        if (self.opw is None) == (self.convention == "opw"):
            raise ValueError("a table [opw] and convention = 'opw' belong together")
        if self.opw is not None and len(self.joint) != len(self.opw.sign):
            raise ValueError(f"{len(self.joint)} tables [[joint]], opw has 6")
        return self


def table_arm(file: str | Path) -> ArmDescription:
    """Read an arm from a table in a TOML file.

    Parameters
    ----------
    file : str or Path

    Returns
    -------
    ArmDescription

    Raises
    ------
    InputError
        Something in it is wrong; the message has its line and value.
    """
    table = model_of(file, _TableFile)
    return _opw_arm(table) if table.opw is not None else _dh_arm(table)


def _dh_arm(table: _TableFile) -> ArmDescription:
    joints: list[ArmJoint] = []
    before = _frame(table.base)
    for number, row in enumerate(table.joint, 1):
        turned = placed([0, 0, 0], about(_Z, math.radians(row.theta)))
        along = placed([MM * row.a, 0, 0], about(_X, math.radians(row.alpha)))
        out = placed([0, 0, MM * row.d])
        link = _link(row, number)
        if table.convention == "dh":
            origin, after = before @ turned, out @ along
        else:  # a and alpha of this row come before the joint, about the same x
            origin, after = before @ along @ turned @ out, np.eye(4)
        joint = _joint(row, number, origin, joined(link.name, [(link, after)]))
        if row.follows is not None:
            leader = [j.name for j in joints].index(row.follows)
            joint = replace(joint, follows=(leader, row.multiplier, 0.0))
        joints.append(joint)
        before = after
    tip = before @ _frame(table.tool)
    return ArmDescription(table.name, RigidLink("base_link"), tuple(joints), "tool0", tip)


def _opw_arm(table: _TableFile) -> ArmDescription:
    """Links have frames that are parallel to the base at inner 0; the last one is the flange's."""
    row = table.opw
    assert row is not None
    lengths = tuple(MM * x for x in (row.a1, row.a2, row.b, row.c1, row.c2, row.c3, row.c4))
    offsets = tuple(math.radians(x) for x in row.offset)
    tip = _frame(table.tool)
    geometry = OpwGeometry(lengths, row.sign, offsets, np.eye(4), tip)
    joints = []
    for number, (own, (origin, axis)) in enumerate(
        zip(table.joint, geometry.joint_frames, strict=True), 1
    ):
        before = _frame(table.base) if number == 1 else np.eye(4)
        joints.append(_joint(own, number, before @ origin, _link(own, number), axis))
    return ArmDescription(table.name, RigidLink("base_link"), tuple(joints), "tool0", tip)


def _joint(
    row: _JointRow, number: int, origin: Array, link: RigidLink, axis: Array = _Z
) -> ArmJoint:
    unit = MM if row.kind == PRISMATIC else math.pi / 180.0
    endless = row.low is None or row.high is None or row.kind == "continuous"
    return ArmJoint(
        name=row.name or f"joint_{number}",
        kind=row.kind,
        origin=origin,
        axis=row.sign * axis,
        low=-math.inf if endless else unit * float(row.low or 0.0),
        high=math.inf if endless else unit * float(row.high or 0.0),
        speed=math.inf if row.speed is None else unit * row.speed,
        link=link,
        effort=row.torque,
        acceleration=None if row.acceleration is None else unit * row.acceleration,
        ratio=row.ratio,
    )


def _link(row: _JointRow, number: int) -> RigidLink:
    xx, yy, zz, xy, yz, zx = row.inertia
    tensor = np.array([[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]])
    return RigidLink(f"link_{number}", row.mass, MM * np.array(row.center), tensor)


def _frame(pose: Six) -> Array:
    """X Y Z [mm], A B C [deg] as a frame [m]."""
    return placed([MM * x for x in pose[:3]], turn_of(*np.radians(pose[3:])))
