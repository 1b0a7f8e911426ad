"""A record of an arm in units of the SI and inner angles, on even instants."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError, suggestion
from motionfmu.base.units import spelled
from motionfmu.identify.arm_dynamics.arm_options import ArmColumn
from motionfmu.identify.arm_dynamics.arm_plant import ArmPlant
from motionfmu.records import Record
from motionfmu.records.quantities import quantity

Array = NDArray[np.float64]
# A motor that turns by the ratio times the joint does so within this share; encoders on the joint
# see the bending of the gear, too.
_LIKE = 0.02
# Link and motor are the same encoder if they differ by less than this share of the motion.
_SAME = 1e-7
# [rad] a joint that moves less stands.
_STILL = 1e-3
_FEWEST = 200


@dataclass(frozen=True)
class ArmRecord:
    """Signals of the joints as the equation of the arm has them."""

    name: str
    time: Array  # (n,) from the first sample on [s]
    torque: Array  # (n, joints) of the motors [N·m]
    motor: Array  # (n, joints) of the motors [rad], 0 where the inner angle is
    link: Array  # (n, joints) inner angles [rad]; those of the motors where no encoder is
    seen: NDArray[np.bool_]  # (joints,) whether an encoder is behind the gear
    notes: tuple[str, ...]

    @property
    def rate(self) -> float:
        """Samples a second [Hz]."""
        return float((len(self.time) - 1) / (self.time[-1] - self.time[0]))

    def part(self, begin: int, end: int) -> "ArmRecord":
        """Samples [begin, end)."""
        here = slice(begin, end)
        return replace(
            self,
            time=self.time[here],
            torque=self.torque[here],
            motor=self.motor[here],
            link=self.link[here],
        )


# CCN 17: a record has motors, links or both, by angles or by encoder.
def arm_record(plant: ArmPlant, record: Record, columns: Mapping[str, ArmColumn]) -> ArmRecord:
    """Take the columns of a record."""
    names = plant.table.signals
    wanted = {plant.signal(v): v for v in (names.torque, names.motor, names.link, names.phase)}
    taken: dict[str, tuple[str, Array]] = {}
    for column, use in columns.items():
        if use.signal not in wanted:
            known = ", ".join(wanted)
            told = suggestion(use.signal, wanted) or f"; there are: {known}"
            raise InputError(f"columns.{column} = {use.signal!r}: no signal of the arm{told}")
        variable = wanted[use.signal]
        if variable in taken:
            both = f"{taken[variable][0]} and {column}"
            raise InputError(f"columns: {both} are both {use.signal}")
        unit = {names.torque: "N·m", names.phase: "1"}.get(variable, "rad")
        taken[variable] = column, _column(record, column, use, (unit, plant.count))
    if names.torque not in taken:
        raise InputError(f"{record.name}: no column is {plant.signal(names.torque)}")
    _refuse_uneven(record)
    notes = list(record.notes)
    time = record.time - record.time[0]
    torque = plant.sign * taken[names.torque][1]
    link = taken[names.link][1] if names.link in taken else None
    motor = taken[names.motor][1] if names.motor in taken else None
    if motor is None and names.phase in taken:
        motor = taken[names.phase][1] * (2.0 * np.pi / plant.of(names.lines))
    if motor is None and link is None:
        raise InputError(
            f"{record.name}: no column is {plant.signal(names.motor)}, {plant.signal(names.phase)}"
            f" or {plant.signal(names.link)}"
        )
    seen = np.zeros(plant.count, dtype=bool)
    if motor is None:
        assert link is not None
        notes.append("No angle of a motor is recorded: gears are taken as stiff.")
        motor = link * plant.ratio
    elif link is not None:
        motor, seen = _compared(plant, record.name, (motor, link), notes)
    turned = plant.sign * motor - plant.ratio * plant.offset
    inner = turned / plant.ratio
    behind = inner.copy()
    if link is not None:
        own = plant.sign * link - plant.offset
        behind[:, seen] = own[:, seen]
    if not (np.ptp(inner, axis=0) > _STILL).any():
        raise InputError(f"{record.name}: no joint moves")
    return ArmRecord(record.name, time, torque, turned, behind, seen, tuple(notes))


def _refuse_uneven(record: Record) -> None:
    if record.rate is None:
        k = int(np.argmax(np.diff(record.ns)))
        raise InputError(
            f"{record.place(k + 1)}: samples are {(record.ns[k + 1] - record.ns[k]) / 1e9:g} s"
            f" apart, {record.step_ns / 1e9:g} s elsewhere: even instants wanted"
        )
    if len(record.ns) < _FEWEST:
        raise InputError(f"{record.name}: {len(record.ns)} samples, {_FEWEST} at least wanted")


def _column(record: Record, name: str, use: ArmColumn, of: tuple[str, int]) -> Array:
    """A column in the unit wanted, (n, joints), with a value everywhere."""
    unit, count = of
    data = np.asarray(record[name], dtype=np.float64)
    if data.ndim != 2 or data.shape[1] != count:
        has = f"{data.shape[1]} values" if data.ndim == 2 else "one value"
        raise InputError(
            f"{record.name}: {name} has {has} a sample, {use.signal} has {count}: name them"
            f" {name}[1] to {name}[{count}], or list their columns in [record]"
        )
    bad = np.argwhere(~np.isfinite(data))
    if len(bad):
        row, joint = (int(k) for k in bad[0])
        raise InputError(
            f"{record.place(row)}: {name}[{joint + 1}] = {data[row, joint]}: a number wanted"
        )
    if use.scale is not None:
        scale = np.asarray(use.scale, dtype=np.float64)
        if scale.ndim and len(scale) != count:
            raise InputError(f"columns.{name}: scale has {len(scale)} values, not {count}")
        return np.asarray(data * scale)
    written = use.unit or record.units.get(name)
    if written is None:
        raise InputError(
            f"{record.name}: {name} has no unit; [{spelled(unit)}] wanted: say unit or scale"
        )
    try:
        own, wanted = quantity(written), quantity(unit)
    except ValueError as error:
        raise InputError(f"{record.name}: {name}: {error}") from None
    if own.exponents != wanted.exponents:
        raise InputError(
            f"{record.name}: {name} is in [{spelled(own.name)}], [{spelled(unit)}] wanted"
        )
    return np.asarray(data * (own.factor / wanted.factor))


def _compared(
    plant: ArmPlant, name: str, both: tuple[Array, Array], notes: list[str]
) -> tuple[Array, NDArray[np.bool_]]:
    """Motors in their own angles, and which joints have an encoder of their own."""
    motor, link = both[0].copy(), both[1]
    seen = np.zeros(plant.count, dtype=bool)
    at_joint, single = [], []
    for k in range(plant.count):
        a, b = motor[:, k] - motor[:, k].mean(), link[:, k] - link[:, k].mean()
        if np.ptp(b) < _STILL:
            continue
        slope, ratio = float(a @ b / (b @ b)), float(plant.ratio[k])
        if abs(slope - 1.0) < _LIKE and abs(ratio - 1.0) > _LIKE:
            at_joint.append(k + 1)
            motor[:, k] *= ratio
        elif abs(slope / ratio - 1.0) > _LIKE:
            raise InputError(
                f"{name}: motor {k + 1} turns {slope:.6g} times as far as its joint,"
                f" {plant.signal(plant.table.ratio)}[{k + 1}] = {ratio:.6g}: another ratio, unit"
                " or sign"
            )
        rest = motor[:, k] / ratio - link[:, k]
        seen[k] = np.ptp(rest) > _SAME * np.ptp(link[:, k])
        if not seen[k]:
            single.append(k + 1)
    if at_joint:
        notes.append(f"Angles of motors {_listed(at_joint)} are written as angles of the joints.")
    if single:
        notes.append(
            f"Joints {_listed(single)} have one encoder: what is written for the link is the"
            " motor's angle over the gear ratio."
        )
    return motor, seen


def _listed(joints: list[int]) -> str:
    return ", ".join(map(str, joints))
