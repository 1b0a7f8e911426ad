"""The arm's FMU driven by the torques of a record and held to its motion by a loop at each motor.

Torques alone would let the arm drift away: a double integrator keeps no place. So each motor has a
loop of position and speed of a few Hz, and what the loops have to add is what the model lacks:

    torque = record + J (2 pi f)^2 (angle of the record - angle) + 2 J 2 pi f (its speed - speed)
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.identify.arm_dynamics.arm_identification import IdentifiedArm
from motionfmu.identify.arm_dynamics.arm_plant import ArmPlant
from motionfmu.identify.arm_dynamics.joint_equation import joint_motion, states
from motionfmu.identify.arm_dynamics.torque_laws import BASE, LAWS, OFFSET
from motionfmu.identify.arm_dynamics.zero_phase import low_pass
from motionfmu.run.engines.slave import Slave
from motionfmu.scenarios import fmus
from motionfmu.scenarios.values import settings

Array = NDArray[np.float64]
# [Hz] of the loops, [s] between two of their steps at most, and from when on the arm is compared:
# it begins at rest, the record need not.
_LOOP, _STEP, _SETTLED = 2.0, 1e-3, 1.0
_FMI = 3


@dataclass(frozen=True)
class HeldArm:
    """Signals of the FMU along a record, as its rotors turn.

    Attributes
    ----------
    time : array of shape (n,)
        [s] of the record.
    recorded, added : arrays of shape (n, joints)
        Torques of the record, and what the loops add, both through the low pass of the fit [N.m].
    windup, windup_run : arrays of shape (n, joints)
        Motor over ratio less link, of the record and of the FMU [rad].
    shares : array of shape (joints,)
        RMS of `added` over RMS of `recorded` about its mean.
    windup_shares : array of shape (joints,)
        RMS of the difference of wind-ups over that of the record about its mean; NaN without an
        encoder behind the gear.
    settled : float
        From here on [s] both are compared.
    """

    time: Array
    recorded: Array
    added: Array
    windup: Array
    windup_run: Array
    shares: Array
    windup_shares: Array
    settled: float


def held_arm(
    found: IdentifiedArm,
    set: Mapping[str, Any] | None = None,
    span: tuple[float, float] | None = None,
    progress: Callable[[float], None] = lambda share: None,
) -> HeldArm:
    """Run the FMU of the arm along a record.

    Parameters
    ----------
    found : IdentifiedArm
    set : mapping, optional
        Values by ``component.variable``; those found if not given.
    span : tuple of float, optional
        Part of the record [s]; the part kept back if not given.
    progress : callable, optional
        Called with the share done.

    Returns
    -------
    HeldArm
    """
    plant, whole = found.plant, found.record
    low, high = span or ((1.0 - found.keep) * float(whole.time[-1]), float(whole.time[-1]))
    first, last = np.searchsorted(whole.time, [low, high + 1e-9])
    record = whole.part(int(first), int(last))
    values = dict(plant.given) | (dict(found.settings) if set is None else dict(set))
    corner = found.equation.corner
    motion = joint_motion(record, plant.ratio, corner)
    outside = _outside(found, record.link, motion)
    angle = low_pass(record.motor, record.rate, corner)
    speed = motion.motors[1] * plant.ratio
    inertia = _seen(found)
    run = _Driven(plant, values, angle[0])
    try:
        wanted = record.torque - outside, angle, speed
        added, motor, link = _along(run, record.time, wanted, inertia, progress)
    finally:
        run.close()
    stretch = found.equation.stretch
    torque, more = (low_pass(x, record.rate, stretch) for x in (record.torque, added))
    there = record.time - record.time[0] >= min(_SETTLED, 0.3 * (high - low))
    there &= record.time <= record.time[-1] - min(_SETTLED, 0.3 * (high - low))
    windup, windup_run = record.motor / plant.ratio - record.link, motor / plant.ratio - link
    scale = np.sqrt(np.mean((torque - torque[there].mean(axis=0))[there] ** 2, axis=0))
    wound = np.std(windup[there], axis=0)
    off = np.sqrt(np.mean((windup_run - windup)[there] ** 2, axis=0))
    with np.errstate(divide="ignore", invalid="ignore"):
        gears = np.where(record.seen, off / wound, np.nan)
        shares = np.sqrt(np.mean(more[there] ** 2, axis=0)) / scale
    return HeldArm(
        record.time, torque, more, windup, windup_run, shares, gears, float(record.time[there][0])
    )


def _outside(found: IdentifiedArm, link: Array, motion: Any) -> Array:
    """Torques at the motors of laws that the class of the arm does not have."""
    plant, equation = found.plant, found.equation
    outside = np.zeros_like(link)
    own = states(plant, motion)
    n = len(equation.base.kept)
    for column, value in zip(
        equation.of_joints(found.fit.places), found.fit.values[n:], strict=True
    ):
        if column.law == "stribeck" or not (column.law or column.term == OFFSET):
            continue
        law = LAWS[column.law] if column.law else BASE
        place = [term for term, _ in law.terms].index(column.term)
        outside[:, column.joint] += float(value) * law.columns(own[column.joint])[place]
    return np.asarray(outside / plant.ratio)


def _seen(found: IdentifiedArm) -> Array:
    """Inertia that each motor feels, about the middle of the motion [kg.m2]."""
    equation, base = found.equation, found.equation.base
    from motionfmu.identify.arm_dynamics.link_regressor import regressor

    plant = found.plant
    n = plant.count
    q = np.median(found.record.link, axis=0)[None].repeat(n, axis=0)
    zero = np.zeros((n, n))
    columns = regressor(plant.axes, plant.origins, 0.0, (q, zero, np.eye(n)))
    whole = np.concatenate([columns, np.eye(n)[:, :, None] * np.eye(n)[:, None, :]], axis=2)
    mass = whole[:, :, base.kept] @ found.fit.values[: len(base.kept)]
    own = plant.of(plant.table.motors.inertia)
    assert equation.plant is plant
    return np.maximum(np.diagonal(mass) / plant.ratio**2, own)


class _Driven:
    """The FMU of an arm with values set, at the beginning of its motion."""

    def __init__(self, plant: ArmPlant, values: Mapping[str, Any], angle: Array) -> None:
        self._plant = plant
        name, signals = plant.component, plant.table.signals
        start = plant.sign * (angle / plant.ratio + plant.offset)
        given = {**values, plant.signal(plant.table.start): np.degrees(start).tolist()}
        source = fmus.runnable(plant.fmu, _FMI)
        self._slave = slave = Slave(name, source, _FMI, [], logging=False)
        try:
            for s in settings(plant.scenario.resolver, given):
                if s.end.component == name and s.end.port.causality == "parameter":
                    slave.assign(s.end.port.type, slave.references[s.end.port.name], s.values)
            slave.initialize()
            slave.start()
            n = plant.count
            self._torque, self._motor, self._speed, self._link = (
                slave.buffer("Float64", n) for _ in range(4)
            )
            self._set = slave.access(
                "Set", "Float64", slave.references[signals.torque], self._torque
            )
            self._get = [
                slave.access("Get", "Float64", slave.references[v], b)
                for v, b in (
                    (signals.motor, self._motor),
                    (signals.speed, self._speed),
                    (signals.link, self._link),
                )
            ]
        except BaseException:
            slave.free()
            raise

    def read(self) -> tuple[Array, Array, Array]:
        """Angle and speed of the rotors, inner angle of the links."""
        for get in self._get:
            get()
        plant = self._plant
        motor = plant.sign * np.array(self._motor) - plant.ratio * plant.offset
        speed = plant.sign * np.array(self._speed)
        return motor, speed, plant.sign * np.array(self._link) - plant.offset

    def step(self, time: float, size: float, torque: Array) -> None:
        """Advance under torques of the rotors."""
        self._torque[:] = (self._plant.sign * torque).tolist()
        self._set()
        self._slave.step(time, size)

    def close(self) -> None:
        """Free the FMU."""
        self._slave.free()


def _along(
    run: _Driven,
    time: Array,
    record: tuple[Array, Array, Array],
    inertia: Array,
    progress: Callable[[float], None],
) -> tuple[Array, Array, Array]:
    """What the loops add, motors and links at the samples."""
    torque = record[0]
    parts = max(1, int(np.ceil((time[1] - time[0]) / _STEP - 1e-9)))
    size = (time[-1] - time[0]) / ((len(time) - 1) * parts)
    size = round(size * 1e9) / 1e9
    w = 2.0 * np.pi * _LOOP
    stiff, damp = inertia * w**2, 2.0 * inertia * w
    added, motor, link = (np.zeros_like(torque) for _ in range(3))
    step = 0
    for k in range(len(time)):
        for j in range(parts if k + 1 < len(time) else 1):
            a, v, b = run.read()
            share = j / parts
            here = [x[k] + share * (x[min(k + 1, len(time) - 1)] - x[k]) for x in record]
            more = stiff * (here[1] - a) + damp * (here[2] - v)
            if j == 0:
                added[k], motor[k], link[k] = more, a, b
            if k + 1 < len(time):
                run.step(step * size, size, here[0] + more)
                step += 1
        if k % 500 == 0:
            progress(k / len(time))
    return added, motor, link
