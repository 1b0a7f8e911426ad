"""The arm of a machine, from the values of its controller and its plant."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.arms.arm_axes import ArmGeometry, AxesGeometry
from motionfmu.arms.arm_description import (
    PRISMATIC,
    ArmDescription,
    ArmJoint,
    RigidLink,
    placed,
    turn_of,
)
from motionfmu.arms.arm_geometry import OpwGeometry
from motionfmu.arms.linkage import tied_joints
from motionfmu.base import units
from motionfmu.base.errors import InputError
from motionfmu.run import Machine
from motionfmu.scenarios.values import settings, start_values

Array = NDArray[np.float64]
CONTROLLER, DRIVES = "soft_controller", "servo_drives"
PLANT, BY_LENGTHS, BY_AXES, LEVEL = "plant", "robot_arm", "axes_arm", "level_arm"
LENGTHS = ("a1", "a2", "b", "c1", "c2", "c3", "c4")


@dataclass(frozen=True)
class ArmMachine:
    """A machine with an arm, and values of its parameters in SI units.

    Attributes
    ----------
    machine : Machine
    tables : mapping
        Of its file.
    names : mapping
        Component by FMU.
    values : mapping
        By FMU and variable, such as ``servo_drives.torque_limit``; of the plant ``plant.mass``.
    arm : ArmDescription
        Without the payload.
    geometry : OpwGeometry or AxesGeometry
    """

    machine: Machine
    tables: Mapping[str, Any]
    names: Mapping[str, str]
    values: Mapping[str, Array]
    arm: ArmDescription
    geometry: ArmGeometry

    def of(self, fmu: str, variable: str) -> Array:
        """Value of a parameter.

        Parameters
        ----------
        fmu, variable : str
            The plant is ``plant``, whichever it is.

        Returns
        -------
        ndarray
            In SI units, in its shape.
        """
        return self.values[f"{fmu}.{variable}"]


def arm_machine(machine: Machine, set: Mapping[str, Any] | None = None) -> ArmMachine:
    """Read the arm of a machine.

    Parameters
    ----------
    machine : Machine
    set : mapping, optional
        Values by ``component.variable``, stronger than the machine's.

    Returns
    -------
    ArmMachine

    Raises
    ------
    InputError
        It has no arm, or no controller of one; or a value is wrong.
    """
    plan = machine.plan()
    names = {fmu: name for name, fmu in plan.document.body.component.items()}
    plant = next((fmu for fmu in (BY_AXES, LEVEL) if fmu in names), BY_LENGTHS)
    for fmu in (plant, CONTROLLER, DRIVES):
        if fmu not in names:
            raise InputError(f"{machine.file}: no {fmu} among its components: it has no arm")
    names[PLANT] = names[plant]
    given = {s.end.name: s.values for s in settings(plan.resolver, set or {})}
    values = {}
    for fmu in (PLANT, CONTROLLER, DRIVES):
        for port in plan.resolver.ports[names[fmu]].values():
            if port.causality == "parameter" and port.type in ("Float64", "Int32"):
                own = given.get(f"{names[fmu]}.{port.name}") or start_values(port)
                factor = units.parse(port.unit or "1").factor
                found = np.array(own, dtype=np.float64)
                if found.size == 1:
                    found = np.full(port.count, found[0])
                values[f"{fmu}.{port.name}"] = factor * found.reshape(port.shape)
    geometry = _geometry(values)
    arm = _arm(machine.name, geometry, values)
    return ArmMachine(machine, plan.document.tables, names, values, arm, geometry)


def _geometry(values: Mapping[str, Array]) -> ArmGeometry:
    turn = values[f"{PLANT}.tool_turn"]
    frame = placed(values[f"{PLANT}.tool_place"], turn_of(*turn))
    tip = frame @ placed([0.0, 0.0, float(values[f"{PLANT}.tool_length"])])
    if f"{PLANT}.axis_origin" in values:
        count = int(values[f"{PLANT}.joints"])
        axes = values[f"{PLANT}.axis_direction"][:count]
        axes = axes / np.linalg.norm(axes, axis=1, keepdims=True)
        slides = tuple(bool(s) for s in values[f"{PLANT}.joint_slides"][:count])
        origins = values[f"{PLANT}.axis_origin"][:count]
        levels = tuple(int(n) for n in values.get(f"{PLANT}.joint_level", ())[:count])
        if not any(levels):
            return AxesGeometry(origins, axes, tip, slides=slides)
        hand = values[f"{PLANT}.hand_offset"]
        return AxesGeometry(origins, axes, tip, slides=slides, levels=levels, hand=hand)
    lengths = tuple(float(values[f"{PLANT}.{n}"]) for n in LENGTHS)
    signs = tuple(int(s) for s in values[f"{PLANT}.joint_sign"])
    offsets = tuple(float(x) for x in values[f"{PLANT}.joint_offset"])
    return OpwGeometry(lengths, signs, offsets, np.eye(4), tip)


def _arm(name: str, geometry: ArmGeometry, values: Mapping[str, Array]) -> ArmDescription:
    """Links as the plant has them, limits as the controller has them."""
    joints = []
    sliding = geometry.sliding if isinstance(geometry, AxesGeometry) else []
    for k, (origin, axis) in enumerate(geometry.joint_frames):
        ratio = float(values[f"{PLANT}.gear_ratio"][k])
        unit = 1e-3 / math.radians(1.0) if k in sliding else 1.0  # mm where others have degrees
        joints.append(
            ArmJoint(
                name=f"joint_{k + 1}",
                kind=PRISMATIC if k in sliding else "revolute",
                origin=origin,
                axis=axis,
                low=unit * float(values[f"{CONTROLLER}.joint_low"][k]),
                high=unit * float(values[f"{CONTROLLER}.joint_high"][k]),
                speed=unit * float(values[f"{CONTROLLER}.joint_speed"][k]),
                link=RigidLink(
                    f"link_{k + 1}",
                    float(values[f"{PLANT}.mass"][k]),
                    values[f"{PLANT}.center"][k],
                    _tensor(values[f"{PLANT}.inertia"][k], values[f"{PLANT}.product"][k]),
                ),
                effort=ratio * float(values[f"{DRIVES}.torque_limit"][k]),
                acceleration=unit * float(values[f"{CONTROLLER}.joint_acc"][k]),
                ratio=ratio,
                damping=float(values[f"{PLANT}.link_viscous"][k]),
            )
        )
    chain = tuple(joints)
    if isinstance(geometry, AxesGeometry) and geometry.levels:
        mass, center, inertia, product = (
            values[f"{PLANT}.hand_{n}"] for n in ("mass", "center", "inertia", "product")
        )
        hand = RigidLink("hand", float(mass), center, _tensor(inertia, product))
        chain = tied_joints(chain, geometry.levels, hand, geometry.hand)
    return ArmDescription(name, RigidLink("base_link"), chain, "tool0", geometry.flange)


def _tensor(moments: Array, products: Array) -> Array:
    """The inertia tensor of moments xx, yy, zz and products xy, yz, zx."""
    (xx, yy, zz), (xy, yz, zx) = moments, products
    return np.array([[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]])


def in_degrees(values: Array, digits: int = 6) -> list[float]:
    """Angles in degrees without the digits of the arithmetic."""
    return [round(math.degrees(float(x)), digits) + 0.0 for x in np.ravel(values)]
