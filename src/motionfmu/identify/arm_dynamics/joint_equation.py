"""The equation of all joints over a record: torque = columns times what is looked for.

Torques are those of the joints, the motors' times the gear ratio, after which the elasticity of
gears is nowhere in the equation: links take the angles behind the gears, motors their own. Columns
and torque go through one low pass, so what is filtered is filtered on both sides.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from motionfmu.identify.arm_dynamics.arm_plant import ArmPlant
from motionfmu.identify.arm_dynamics.arm_record import ArmRecord
from motionfmu.identify.arm_dynamics.base_parameters import BaseParameters, base_parameters
from motionfmu.identify.arm_dynamics.link_regressor import NAMES, UNITS, regressor
from motionfmu.identify.arm_dynamics.torque_laws import BASE, LAWS, JointState
from motionfmu.identify.arm_dynamics.zero_phase import ENDS, fastest, low_pass

Array = NDArray[np.float64]
# Corner of the low pass of angles: so many times the fastest motion, within limits [Hz] and below a
# share of the rate.
_FASTER, _BETWEEN, _OF_RATE = 40.0, (20.0, 30.0), 0.4
# That of both sides of the equation: so far below that reversals, which are fast, are seen alike on
# both sides; the share of the other corner, the least [Hz], and the most as a share.
_EQUATION, _SLOW, _CLOSE = 0.2, 4.0, 0.5
# Samples a period of the corner at which links are computed, and at which rows are kept.
_COMPUTED, _KEPT = 8.0, 4.0
# Speeds below this share of a joint's largest tell of rest, not of friction in motion.
_MOVING = 0.02
# Random states by which base parameters are told.
_STATES = 200


@dataclass(frozen=True)
class JointColumn:
    """A column that belongs to one joint."""

    joint: int  # from 0
    law: str  # empty for the law that is always there
    term: str
    unit: str

    @property
    def name(self) -> str:
        """For tables."""
        return f"{self.term} {self.joint + 1}"


@dataclass(frozen=True)
class JointMotion:
    """Filtered motion at some samples, (samples, joints) each."""

    links: tuple[Array, Array, Array]  # angle, speed, acceleration behind the gears [rad, s]
    motors: tuple[Array, Array, Array]  # likewise of the motors, over the ratio


@dataclass(frozen=True)
class JointEquation:
    """Rows at even instants."""

    plant: ArmPlant
    base: BaseParameters
    columns: tuple[JointColumn, ...]  # behind those of the base parameters
    time: Array  # (rows,) [s]
    matrix: Array  # (rows, joints, base and columns)
    torque: Array  # (rows, joints) [N.m]
    moving: NDArray[np.bool_]  # (rows, joints) rows that count
    motion: JointMotion  # at the rows
    corner: float  # of angles [Hz]
    stretch: float  # of the equation [Hz]

    @property
    def rate(self) -> float:
        """Rows a second."""
        return float((len(self.time) - 1) / (self.time[-1] - self.time[0]))

    def chosen(self, laws: Sequence[tuple[str, int]]) -> NDArray[np.int64]:
        """Places of the base parameters, and of the columns of these laws of these joints."""
        n = len(self.base.kept)
        there = [n + k for k, c in enumerate(self.columns) if not c.law or (c.law, c.joint) in laws]
        return np.array([*range(n), *there], dtype=np.int64)

    def of_joints(self, places: NDArray[np.int64]) -> tuple[JointColumn, ...]:
        """The columns of joints among some places."""
        n = len(self.base.kept)
        return tuple(self.columns[int(p) - n] for p in places if p >= n)

    def name(self, place: int) -> str:
        """Of what a column is multiplied with."""
        n = len(self.base.kept)
        if place >= n:
            return self.columns[place - n].name
        return self.base.names[self.base.kept[place]]

    def unit(self, place: int) -> str:
        """Its unit."""
        n = len(self.base.kept)
        if place >= n:
            return self.columns[place - n].unit
        return self.base.units[self.base.kept[place]]


def base_of(plant: ArmPlant) -> BaseParameters:
    """Base parameters of an arm: of ten of each link, and the inertia of each motor."""
    rng = np.random.default_rng(0)
    n = plant.count
    q, v, a = rng.uniform(-3.0, 3.0, (3, _STATES, n))
    motion = q, v, a
    links = regressor(plant.axes, plant.origins, plant.gravity, motion)
    motors = np.eye(n)[None] * motion[2][:, None, :]
    names = [f"{s}{k + 1}" for k in range(n) for s in NAMES] + [f"J{k + 1}" for k in range(n)]
    units = [u for _ in range(n) for u in UNITS] + ["kg·m²"] * n
    # masses last: what they do is told by moments of the links before
    order = [10 * k + i for k in range(n) for i in range(1, 10)]
    order += [*range(10 * n, 11 * n), *(10 * k for k in range(n))]
    matrix = np.concatenate([links, motors], axis=2).reshape(-1, 11 * n)
    return base_parameters(matrix, tuple(names), tuple(units), np.array(order))


def joint_motion(record: ArmRecord, ratio: Array, corner: float, every: int = 1) -> JointMotion:
    """Angles, speeds and accelerations of links and motors, at every so many samples."""

    def of(values: Array) -> tuple[Array, Array, Array]:
        found = (low_pass(values, record.rate, corner, k)[::every] for k in range(3))
        return tuple(found)  # type: ignore[return-value]

    links, motors = of(record.link), of(record.motor / ratio)
    return JointMotion(links, motors)


def corner_of(record: ArmRecord, asked: float | None) -> float:
    """Corner of the low pass of angles [Hz]."""
    most = _OF_RATE * record.rate
    if asked is not None:
        return min(asked, most)
    return float(min(np.clip(_FASTER * fastest(record.link, record.rate), *_BETWEEN), most))


def joint_equation(
    plant: ArmPlant, record: ArmRecord, base: BaseParameters, low: float | None
) -> JointEquation:
    """Make it of a record, with the columns of all laws."""
    corner = corner_of(record, low)
    stretch = min(max(_EQUATION * corner, _SLOW), _CLOSE * corner)
    rate = record.rate
    first = max(1, int(rate / (_COMPUTED * corner)))  # samples between two that are computed
    then = max(1, int(rate / first / (_KEPT * stretch)))
    motion = joint_motion(record, plant.ratio, corner, first)
    links = regressor(plant.axes, plant.origins, plant.gravity, motion.links)
    n = plant.count
    motors = np.eye(n)[None] * motion.motors[2][:, None, :]
    whole = np.concatenate([links, motors], axis=2)[:, :, base.kept]
    inertial = low_pass(whole, rate / first, stretch)[::then]
    every = first * then
    columns, friction = _friction(plant, record, corner)
    rows = len(inertial)
    torque = low_pass(record.torque * plant.ratio, rate, stretch)[::every]
    torque = torque - low_pass(_apart(plant, base, motion), rate / first, stretch)[::then]
    own = low_pass(friction, rate, stretch)[::every]
    matrix = np.zeros((rows, n, len(base.kept) + len(columns)))
    matrix[:, :, : len(base.kept)] = inertial
    for k, column in enumerate(columns):
        matrix[:, column.joint, len(base.kept) + k] = own[:, k]
    kept = _every(motion, then)
    speed = kept.motors[1]
    moving = np.abs(speed) > _MOVING * np.abs(speed).max(axis=0)
    time = record.time[::every][:rows]
    cut = min(int(ENDS * rate / every / stretch), rows // 10)
    moving[:cut] = False
    moving[rows - cut :] = False
    return JointEquation(plant, base, columns, time, matrix, torque, moving, kept, corner, stretch)


def dropped(plant: ArmPlant, base: BaseParameters) -> NDArray[np.bool_]:
    """Joints whose motor's inertia is a part of another base parameter."""
    return np.array([10 * plant.count + k not in base.kept for k in range(plant.count)])


def _apart(plant: ArmPlant, base: BaseParameters, motion: JointMotion) -> Array:
    """What motors take whose inertia counts as their links', as their gears give way."""
    own = plant.of(plant.table.motors.inertia) * plant.ratio**2
    apart = motion.motors[2] - motion.links[2]
    return np.asarray(np.where(dropped(plant, base), own, 0.0) * apart)


def _every(motion: JointMotion, every: int) -> JointMotion:
    def few(three: tuple[Array, Array, Array]) -> tuple[Array, Array, Array]:
        return tuple(m[::every] for m in three)  # type: ignore[return-value]

    return JointMotion(few(motion.links), few(motion.motors))


def states(plant: ArmPlant, motion: JointMotion) -> list[JointState]:
    """What the laws of each joint are functions of."""
    slow = plant.of(plant.table.motors.stribeck) / plant.ratio
    angle, speed = motion.links[0], motion.motors[1]
    return [
        JointState(angle[:, k], speed[:, k], np.sign(speed[:, k]), float(slow[k]))
        for k in range(plant.count)
    ]


def _friction(
    plant: ArmPlant, record: ArmRecord, corner: float
) -> tuple[tuple[JointColumn, ...], Array]:
    """Columns of all laws of all joints at all samples, before the low pass of the equation."""
    motion = JointMotion(
        (low_pass(record.link, record.rate, corner), *2 * (record.link[:0],)),
        (
            record.motor[:0],
            low_pass(record.motor / plant.ratio, record.rate, corner, 1),
            record.motor[:0],
        ),
    )
    columns, values = [], []
    for k, state in enumerate(states(plant, motion)):
        for name, law in (("", BASE), *LAWS.items()):
            for (term, unit), column in zip(law.terms, law.columns(state), strict=True):
                columns.append(JointColumn(k, name, term, unit))
                values.append(column)
    return tuple(columns), np.column_stack(values)
