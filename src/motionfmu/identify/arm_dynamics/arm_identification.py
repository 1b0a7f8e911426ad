"""From a record of an arm to its parameters."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline

from motionfmu.base.errors import InputError
from motionfmu.identify.arm_dynamics.arm_options import ArmOptions
from motionfmu.identify.arm_dynamics.arm_plant import ArmPlant, arm_plant
from motionfmu.identify.arm_dynamics.arm_record import ArmRecord, arm_record
from motionfmu.identify.arm_dynamics.gear_windup import GearFound, GearSamples, gear_found
from motionfmu.identify.arm_dynamics.joint_equation import (
    JointEquation,
    base_of,
    dropped,
    joint_equation,
    joint_motion,
)
from motionfmu.identify.arm_dynamics.link_regressor import regressor
from motionfmu.identify.arm_dynamics.possible_links import PossibleLinks, possible_links
from motionfmu.identify.arm_dynamics.torque_fit import TorqueFit, TriedLaw, choose, enough, fit
from motionfmu.identify.arm_dynamics.torque_laws import OFFSET
from motionfmu.identify.arm_dynamics.zero_phase import ENDS, low_pass
from motionfmu.records import Record
from motionfmu.run import Scenario

Array = NDArray[np.float64]
# A quantity whose standard deviation is above this share of itself is not told.
_TOLD = 0.3
# An error of a gear counts from so many deviations on.
_SURE = 4.0
# Passes: what the errors of gears do to torques is known from the second on.
_PASSES = 2
# Samples a period of the low pass at which links are computed for the gears.
_COMPUTED = 8.0
# Corners of the low pass that are tried for gears, over that of the equation; the most of the rate.
_CORNERS, _OF_RATE = (1.0, 2.0, 4.0), 0.25


@dataclass(frozen=True)
class ArmQuantity:
    """One quantity as the record tells it."""

    name: str
    text: str  # a base parameter as a sum
    unit: str
    before: float  # as the scenario has it; NaN if the plant has no such thing
    value: float
    deviation: float
    told: bool


@dataclass(frozen=True)
class IdentifiedArm:
    """What a record tells of an arm.

    Attributes
    ----------
    plant, record, equation :
        Of what.
    base : tuple of ArmQuantity
        Base parameters.
    joints : tuple of ArmQuantity
        Friction and extensions of its law, in N.m at the joint.
    gears : mapping
        `GearFound` by joint, from 0.
    links : PossibleLinks
        Masses, centres and inertias of the plant that make it.
    fit : TorqueFit
    tried, chosen :
        Laws, by the part kept back.
    kept : array of shape (joints,)
        RMS of the residual over that of the torque about its mean, on the part kept back, by what
        was found on the other part.
    settings : dict
        Value by ``component.variable`` for ``--set``.
    notes : tuple of str
        What is to be known, in words.
    """

    plant: ArmPlant
    record: ArmRecord
    equation: JointEquation
    base: tuple[ArmQuantity, ...]
    joints: tuple[ArmQuantity, ...]
    gears: Mapping[int, GearFound]
    links: PossibleLinks
    fit: TorqueFit
    tried: tuple[TriedLaw, ...]
    chosen: TriedLaw
    settings: Mapping[str, Any]
    notes: tuple[str, ...]
    keep: float

    @property
    def kept(self) -> Array:
        """Residuals on the part kept back."""
        return self.chosen.kept

    @property
    def modelled(self) -> Array:
        """Torques of the fit, (rows, joints) [N·m].

        Returns
        -------
        ndarray
        """
        return np.asarray(self.equation.matrix[:, :, self.fit.places] @ self.fit.values)

    def quantity(self, name: str) -> ArmQuantity:
        """A quantity by its name.

        Parameters
        ----------
        name : str
            Such as ``mz2`` or ``coulomb 1``.
        """
        return next(q for q in (*self.base, *self.joints) if q.name == name)


def identify_arm(
    scenario: Scenario,
    record: Record,
    options: ArmOptions,
    set: Mapping[str, Any] | None = None,
    progress: Callable[[str, float], None] = lambda what, share: None,
) -> IdentifiedArm:
    """Find what a record tells of the arm of a scenario.

    Parameters
    ----------
    scenario : Scenario
        One of its FMUs says that it is an arm.
    record : Record
        Torques of the motors, angles of the motors, of the links or of both.
    options : ArmOptions
    set : mapping, optional
        Values by ``component.variable`` instead of the scenario's.
    progress : callable, optional
        Called with what is done and the share done.

    Returns
    -------
    IdentifiedArm

    Raises
    ------
    InputError
        A column is wrong, or the record is too short.
    """
    plant = arm_plant(scenario, set or {})
    data = arm_record(plant, record, options.columns)
    base = base_of(plant)
    torque = data.torque
    gears: dict[int, GearFound] = {}
    for step in range(_PASSES):
        progress("torques", 0.1 + 0.4 * step)
        now = replace(data, torque=torque)
        equation = joint_equation(plant, now, base, options.low_pass)
        if not enough(equation):
            raise InputError(
                f"{record.name}: {data.time[-1] - data.time[0]:g} s of motion of up to"
                f" {equation.corner:.3g} Hz are too short for {equation.matrix.shape[2]} unknowns"
            )
        tried, chosen = choose(equation, options.keep, options.laws)
        found = fit(equation, chosen.laws)
        n = len(base.kept)
        gears, asked = _gears(plant, data, equation, found, options.keep)
        if not gears:
            break
        torque = _without_errors(plant, data, gears, asked)
    progress("links", 0.9)
    own = _motors_told(plant, equation, gears)
    links = possible_links(plant, base, (found.values[:n], found.with_others_fixed(n)), own)
    quantities = _quantities(plant, equation, found)
    settings = _settings(plant, equation, found, gears, links)
    told = _notes(plant, equation, (found, gears, links), chosen, data.seen)
    notes = (*data.notes, *told)
    return IdentifiedArm(
        plant, data, equation, quantities[:n], quantities[n:], gears, links, found,
        tuple(tried), chosen, settings, notes, options.keep,
    )  # fmt: skip


def _gears(
    plant: ArmPlant, data: ArmRecord, equation: JointEquation, found: TorqueFit, keep: float
) -> tuple[dict[int, GearFound], Array]:
    """All gears with encoders on both sides, and what the links ask of them at all samples.

    A gear swings faster than the arm moves: of several corners of the low pass that one counts with
    which least of a gear's wind-up is left.
    """
    gears: dict[int, GearFound] = {}
    slow = np.zeros_like(data.torque)
    if not data.seen.any():
        return gears, slow
    for factor in _CORNERS:
        corner = factor * equation.corner
        if factor > 1.0 and corner > _OF_RATE * data.rate:
            break
        every = max(1, int(data.rate / (_COMPUTED * corner)))
        motion = joint_motion(data, plant.ratio, corner, every)
        coarse = _asked(plant, equation, found, motion.links)
        fine = [_fine(data, x, every) for x in (coarse, *motion.links[1:])]
        slow = fine[0] if factor == 1.0 else slow
        for k in np.flatnonzero(data.seen):
            own = _gear(plant, data, equation, found, int(k), corner, fine)
            knees = sorted(float(plant.of(n)[k]) for n in plant.table.gears.knees)
            one = gear_found(own, knees, keep)
            if one is not None and (k not in gears or one.left < gears[int(k)].left):
                gears[int(k)] = one
    return gears, slow


def _fine(data: ArmRecord, values: Array, every: int) -> Array:
    """Values at every so many samples, at all samples."""
    if every == 1:
        return values
    return np.asarray(make_interp_spline(data.time[::every], values, k=3)(data.time))


def _gear(  # noqa: PLR0913  (all that a gear is between)
    plant: ArmPlant,
    data: ArmRecord,
    equation: JointEquation,
    found: TorqueFit,
    k: int,
    corner: float,
    fine: list[Array],
) -> GearSamples:
    asked, speed, acceleration = fine
    windup = data.motor[:, k] / plant.ratio[k] - data.link[:, k]
    cut = int(ENDS * data.rate / equation.corner)
    there = slice(cut, len(data.time) - cut)
    law = {
        (c.term, c.joint): float(v)
        for c, v in zip(equation.of_joints(found.places), _behind(equation, found), strict=True)
    }
    both = max(law["viscous", k], 0.0)
    before = float(plant.of(plant.table.links.viscous)[k])
    return GearSamples(
        windup=windup[there],
        torque=asked[there, k],
        rate=low_pass(windup, data.rate, corner, 1)[there],
        speed=speed[there, k],
        acceleration=acceleration[there, k],
        motor=data.motor[there, k],
        doubt=float(found.sizes[k]),
        merged=bool(dropped(plant, equation.base)[k]),
        begin=(min(before, both), float(plant.of(plant.table.gears.damping)[k])),
        most=both,
        lost=float(plant.of(plant.table.gears.lost)[k]),
        interval=1.0 / data.rate,
    )


def _behind(equation: JointEquation, found: TorqueFit) -> Array:
    """Values of the columns of joints."""
    return found.values[len(equation.base.kept) :]


def _asked(
    plant: ArmPlant,
    equation: JointEquation,
    found: TorqueFit,
    motion: tuple[Array, Array, Array],
) -> Array:
    """Torques that links ask of their gears, (samples, joints)."""
    base = equation.base
    places = base.kept[base.kept < 10 * plant.count]
    own = found.values[: len(base.kept)][base.kept < 10 * plant.count]
    columns = regressor(plant.axes, plant.origins, plant.gravity, motion)[:, :, places]
    motors = np.where(dropped(plant, equation.base), plant.of(plant.table.motors.inertia), 0.0)
    return np.asarray(columns @ own - motors * plant.ratio**2 * motion[2])


def _without_errors(
    plant: ArmPlant, data: ArmRecord, gears: Mapping[int, GearFound], asked: Array
) -> Array:
    """Torques of the motors without what the errors of their gears make of the links' torques.

    A gear whose error e turns the link by e' more a turn of the motor asks e' more torque.
    """
    torque = data.torque.copy()
    for k, gear in gears.items():
        m, slope = data.motor[:, k], np.zeros(len(data.time))
        for turn in (1, 2):
            size, deviation = gear.values[f"amplitude {turn}"]
            if size > _SURE * deviation:
                slope += turn * size * np.cos(turn * m + gear.values[f"phase {turn}"][0])
        torque[:, k] -= slope * asked[:, k]
    return torque


def _motors_told(
    plant: ArmPlant, equation: JointEquation, gears: Mapping[int, GearFound]
) -> dict[int, tuple[float, float]]:
    """Inertias of motors at the joint that only wind-up tells, with deviations."""
    merged = dropped(plant, equation.base)
    before = plant.of(plant.table.motors.inertia) * plant.ratio**2
    told = {}
    for k, gear in gears.items():
        if merged[k]:
            more, deviation = gear.values["inertia"]
            if 0.0 < deviation < _TOLD * before[k]:
                told[k] = float(before[k] - more), deviation
    return told


def _quantities(
    plant: ArmPlant, equation: JointEquation, found: TorqueFit
) -> tuple[ArmQuantity, ...]:
    from motionfmu.identify.arm_dynamics.possible_links import believed

    base, n = equation.base, len(equation.base.kept)
    before = base.combine @ believed(plant).standard(plant)
    rows = []
    for k, place in enumerate(found.places):
        value, deviation = float(found.values[k]), float(found.deviations[k])
        name = equation.name(int(place))
        was = float(before[k]) if k < n else _before(plant, equation, int(place))
        text = base.text(k) if k < n else ""
        told = 0.0 < deviation <= _TOLD * abs(value)
        rows.append(ArmQuantity(name, text, equation.unit(int(place)), was, value, deviation, told))
    return tuple(rows)


def _before(plant: ArmPlant, equation: JointEquation, place: int) -> float:
    """What the plant has for a column of a joint, at the joint."""
    column = equation.columns[place - len(equation.base.kept)]
    k, motors = column.joint, plant.table.motors
    ratio = float(plant.ratio[k])
    coulomb = float(plant.of(motors.coulomb)[k])
    values = {
        "coulomb": coulomb * ratio,
        "excess at rest": (float(plant.of(motors.static)[k]) - coulomb) * ratio,
        "viscous": float(plant.of(motors.viscous)[k]) * ratio**2
        + float(plant.of(plant.table.links.viscous)[k]),
    }
    return values.get(column.term, float("nan"))


def _settings(
    plant: ArmPlant,
    equation: JointEquation,
    found: TorqueFit,
    gears: Mapping[int, GearFound],
    links: PossibleLinks,
) -> dict[str, Any]:
    """Values of the plant's parameters, all elements of each."""
    table, ratio = plant.table, plant.ratio
    n = len(equation.base.kept)
    values = {
        table.links.mass: links.mass,
        table.links.center: links.center,
        table.links.inertia: links.inertia,
        table.motors.inertia: links.motor_inertia,
    }
    law: dict[tuple[str, int], float] = {}
    for place, value in zip(found.places[n:], found.values[n:], strict=True):
        column = equation.columns[int(place) - n]
        law[column.term, column.joint] = float(value)
    motors = table.motors
    coulomb, static = plant.of(motors.coulomb).copy(), plant.of(motors.static).copy()
    excess = static - coulomb
    viscous, behind = plant.of(motors.viscous).copy(), plant.of(table.links.viscous).copy()
    for k in range(plant.count):
        coulomb[k] = max(law["coulomb", k], 0.0) / ratio[k]
        more = law["excess at rest", k] / ratio[k] if ("excess at rest", k) in law else excess[k]
        static[k] = coulomb[k] + max(more, 0.0)
        both = max(law["viscous", k], 0.0)
        gear = gears.get(k)
        if gear is not None and gear.told("viscous"):
            behind[k] = float(np.clip(gear.values["viscous"][0], 0.0, both))
        behind[k] = min(behind[k], both)
        viscous[k] = (both - behind[k]) / ratio[k] ** 2
    values |= {motors.coulomb: coulomb, motors.static: static, motors.viscous: viscous}
    values |= {table.links.viscous: behind} | _of_gears(plant, gears)
    return {plant.signal(name): np.ravel(value).tolist() for name, value in values.items()}


def _of_gears(plant: ArmPlant, gears: Mapping[int, GearFound]) -> dict[str, Array]:
    """Parameters of the gears, of those joints whose gears are told."""
    if not gears:
        return {}
    table = plant.table.gears
    names = (*table.stiffness, *table.knees, table.lost, table.zero)
    names = (*names, *table.amplitudes, *table.phases)
    values = {name: plant.of(name).copy() for name in names}
    for k, gear in gears.items():
        for j, name in enumerate(table.stiffness):
            if gear.kind != "the plant's" or j < len(gear.stiffness):
                values[name][k] = gear.stiffness[min(j, len(gear.stiffness) - 1)]
        if gear.kind == "found":
            values[table.knees[0]][k] = gear.knees[0]
            for name in table.knees[1:]:
                values[name][k] = max(values[name][k], gear.knees[0])
        values[table.lost][k] = max(gear.values["lost"][0], 0.0)
        values[table.zero][k] = gear.values["zero"][0]
        for turn, (size, phase) in enumerate(zip(table.amplitudes, table.phases, strict=True), 1):
            amplitude, deviation = gear.values[f"amplitude {turn}"]
            sure = amplitude > _SURE * deviation
            values[size][k] = amplitude if sure else 0.0
            values[phase][k] = gear.values[f"phase {turn}"][0]
    return values


def _notes(
    plant: ArmPlant,
    equation: JointEquation,
    found: tuple[TorqueFit, Mapping[int, GearFound], PossibleLinks],
    chosen: TriedLaw,
    seen: NDArray[np.bool_],
) -> list[str]:
    """What is to be known, in words; `seen` are joints with an encoder behind the gear."""
    fitted, gears, links = found
    base = equation.base
    notes = []
    if base.none:
        notes.append(f"No torque depends on {', '.join(base.none)}.")
    n = len(base.kept)
    beside = {law for law, _ in chosen.laws} - {"stribeck"}
    for k, place in enumerate(fitted.places[n:], n):
        size, sure = abs(float(fitted.values[k])), _SURE * float(fitted.deviations[k])
        if equation.columns[int(place) - n].term == OFFSET and size > sure:
            beside.add(OFFSET)
    if beside:
        notes.append(
            f"The class of the arm has no such law: {', '.join(sorted(beside))}. It is left out of"
            " found.toml; the run along the record has it as a torque from outside."
        )
    bad = [k + 1 for k in range(plant.count) if not equation.moving[:, k].any()]
    if bad:
        notes.append(f"Joints {', '.join(map(str, bad))} do not move: nothing of them is told.")
    for k, place in enumerate(fitted.places[n:], n):
        column = equation.columns[int(place) - n]
        if column.term in ("coulomb", "viscous") and fitted.values[k] < -3.0 * fitted.deviations[k]:
            notes.append(
                f"{column.name} is {fitted.values[k]:.4g} {column.unit}: friction that drives. Is"
                " the torque recorded at the motor, and late or early?"
            )
    if links.misfit > 3.0:
        notes.append(
            f"No links of the plant's kind make all base parameters: one is off by"
            f" {links.misfit:.3g} of its deviations."
        )
    return [*notes, *_gear_notes(gears, seen)]


def _gear_notes(gears: Mapping[int, GearFound], seen: NDArray[np.bool_]) -> list[str]:
    notes = []
    bare = [str(k + 1) for k in np.flatnonzero(seen) if int(k) not in gears]
    if bare:
        notes.append(f"Joints {', '.join(bare)}: the record does not load the gear enough.")
    for k, gear in gears.items():
        if not np.isfinite(gear.values["lost"][1]):
            notes.append(
                f"Joint {k + 1} is loaded one way only: lost motion and the zeros of its encoders"
                " are not told apart."
            )
        if gear.values["lost"][0] < 0.0:
            notes.append(
                f"Joint {k + 1}: the gear is softer at small torques than a gap makes it; lost"
                " motion is set to 0."
            )
    return notes
