"""Values of a machine for an arm: what its description says, and what is taken where it is silent.

What is taken is that of another machine's arm in the proportion of the two: masses by size, torques
and what bears them by the torque that the arm's own motion asks for, motors by its inertia.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.arm_machines.bent_pose import bent_pose
from motionfmu.arm_machines.machine_arm import (
    DRIVES,
    LENGTHS,
    PLANT,
    ArmMachine,
    in_degrees,
)
from motionfmu.arms.arm_axes import ArmGeometry, AxesGeometry
from motionfmu.arms.arm_description import (
    ArmDescription,
    ArmJoint,
    RigidLink,
    angles_of,
    joined,
    placed,
)
from motionfmu.base.errors import InputError

Array = NDArray[np.float64]
SIX = 6
# Masses grow with this power of the reach: an IRB 120 has 25 kg at 0.58 m, an IRB 2600 has 272 kg
# at 1.65 m.
MASS_POWER = 2.3
RATIOS = (30, 50, 80, 100, 120, 160)  # of strain wave gears
MOTOR_SPEED = 4500.0 / 60.0 * 2.0 * math.pi  # [rad/s] at a joint's highest speed, at most
ENDLESS = math.radians(3600.0)  # what the controller takes for a joint without ends
SPARE = 3.0  # torque limit of a motor per what the motion asks for, as servo motors bear at peak
LEADS = (5, 10, 16, 20, 25, 32, 40, 50, 63, 80)  # [mm] of ball screws
# Of a ball screw at a slide: lost motion, errors once and twice per turn, where its zero is [m].
SCREW = {"lost_motion": 1e-5, "transmission_error_1": 3e-6, "transmission_error_2": 1e-6}
SCREW_ZERO = 1e-4
SLIDE_SPEED = 1.0  # [m/s] of a slide whose file has none
EXACT = 10  # digits of geometry in degrees
STATES, SEED = 400, 1  # random states for largest torques and inertias
# Inner angles at the start: upper arm upright, forearm level, hand down.
START = np.radians([0.0, 0.0, 90.0, 0.0, 90.0, 0.0])


@dataclass(frozen=True)
class TakenValue:
    """A value that is not in the description, and why it is this."""

    what: str
    names: str  # of the parameters
    value: str  # shown
    why: str


@dataclass(frozen=True)
class ArmValues:
    """Values of [set] by group, and what is taken for granted."""

    arm: ArmDescription  # with what was taken
    groups: dict[str, dict[str, Any]]
    taken: list[TakenValue]
    start: list[float]  # joints [deg], that slide [mm], of all six places
    reach: float  # [m]

    @property
    def controller(self) -> dict[str, Any]:
        """What the controller knows of the arm, by its parameters."""
        rows = self.groups["what controller and arm share"] | self.groups["limits"]
        return {n.partition(".")[2]: v for n, v in rows.items() if not n.startswith("arm.")}


def arm_values(arm: ArmDescription, geometry: ArmGeometry, like: ArmMachine) -> ArmValues:
    """Values for an arm of known lengths, in the proportion of another machine's arm."""
    return _Values(arm, geometry, like).all()


class _Values:
    """Makes the values group by group; each group needs those before it."""

    def __init__(self, arm: ArmDescription, geometry: ArmGeometry, like: ArmMachine) -> None:
        self.geometry, self.like = geometry, like
        self.taken: list[TakenValue] = []
        self.size = geometry.reach / like.geometry.reach
        self.slides = getattr(geometry, "sliding", [])
        self.levels = getattr(geometry, "levels", ())
        self.count = len(arm.driven)
        self.arm = self._moving(self._massive(arm))

    def all(self) -> ArmValues:
        """All groups."""
        start = self._start()
        groups = {
            "what controller and arm share": self._shared(start),
            "limits": self._limits(),
            "links": self._links(),
            "payload": self._payload(),
        }
        groups |= self._drive()
        shown = groups["what controller and arm share"]["*.start_joint"]
        return ArmValues(self.arm, groups, self.taken, shown, self.geometry.reach)

    def _told(self, values: Sequence[float] | Array, digits: int = 6) -> list[float]:
        """Joints as people give them: degrees, of those that slide mm."""
        found = in_degrees(np.asarray(values, dtype=float), digits)
        for k in self.slides:
            found[k] = round(1e3 * float(values[k]), digits) + 0.0
        return found

    def _six(self, values: Sequence[Any], other: Any) -> list[Any]:
        """Values of all places, of which an arm has the first ones."""
        return [*values, *[other] * (SIX - self.count)]

    def _take(self, what: str, names: str, value: Any, why: str) -> None:
        self.taken.append(TakenValue(what, names, _shown(value), why))

    def _massive(self, arm: ArmDescription) -> ArmDescription:
        """With masses for links that have none: those of the other arm by size."""
        joints = list(arm.driven)
        bare = [k for k, j in enumerate(joints) if j.link.mass <= 0.0]
        if not bare:
            return arm
        share = self.size**MASS_POWER
        frames = self._frames(arm)
        masses = []
        for k in bare:
            link = self.like.arm.joints[k].link
            back = np.linalg.inv(frames[k])  # from the plant's link to the description's
            center, tensor = self.size * link.center, link.tensor
            if isinstance(self.geometry, AxesGeometry):  # whose frames lie otherwise
                ways = (*self.geometry.origins[1:], self.geometry.flange[:3, 3])
                center, tensor = ways[k] / 2.0, np.eye(3) * np.trace(link.tensor) / 3.0
            own = replace(
                link,
                name=joints[k].link.name,
                mass=round(share * link.mass, 3),
                center=center,
                tensor=share * self.size**2 * tensor,
            )
            shapes = joints[k].link.shapes
            moved = joined(own.name, [(own, np.asarray(back, dtype=np.float64))])
            joints[k] = replace(joints[k], link=replace(moved, shapes=shapes))
            masses.append(own.mass)
        names = ", ".join(joints[k].link.name for k in bare)
        why = f"kg; of {self.like.machine.name} by the reach to the power of {MASS_POWER}"
        if isinstance(self.geometry, AxesGeometry):
            why += ", in the middle of the link"
        parameters = "arm.mass, arm.center, arm.inertia"
        self._take(f"mass, centre, inertia of {names}", parameters, masses, why)
        return _with_driven(arm, joints)

    # CCN 19: each kind of number that a joint lacks is taken and told by itself.
    def _moving(self, arm: ArmDescription) -> ArmDescription:
        """With speeds, ranges, accelerations and gears for joints that have none."""
        joints = [self._limited(k, j) for k, j in enumerate(arm.driven)]
        name = self.like.machine.name
        if bare := [k for k, j in enumerate(arm.driven) if math.isinf(j.speed)]:
            speeds = self._told([j.speed for j in joints])
            what = f"speed of joints {_numbered(bare)}"
            unit = "°/s, mm/s" if self.slides else "°/s"
            self._take(what, "soft.joint_speed", speeds, f"{unit}; of {name}")
        if any(j.acceleration is None for j in arm.driven):
            found = self._told([float(j.acceleration or 0.0) for j in joints])
            unit = "°/s², mm/s²" if self.slides else "°/s²"
            why = f"{unit}; full speed in the time of {name}, 0.25 to 0.35 s"
            self._take("acceleration", "soft.joint_acc", found, why)
        if endless := [k for k, j in enumerate(arm.driven) if math.isinf(j.low)]:
            what = f"range of joints {_numbered(endless)}, which have none"
            self._take(what, "soft.joint_low", math.degrees(ENDLESS), "° both ways")
        if any(j.ratio is None for j in arm.driven):
            why = "the highest of strain wave gears with 4500 rpm at full speed"
            if self.slides:
                why += "; of what slides rad/m of the shortest lead that allows it"
            names = "soft.gear_ratio, arm.gear_ratio"
            self._take("gear ratio", names, [j.ratio for j in joints], why)
        return _with_driven(arm, joints)

    def _limited(self, k: int, joint: ArmJoint) -> ArmJoint:
        known = self.like.arm.joints[k]
        speed = known.speed if math.isinf(joint.speed) else joint.speed
        ratios: tuple[float, ...] = RATIOS
        if joint.slides:
            speed = min(speed, SLIDE_SPEED) if math.isinf(joint.speed) else speed
            ratios = tuple(2.0 * math.pi / (1e-3 * lead) for lead in reversed(LEADS))
        fits = [n for n in ratios if n * speed <= MOTOR_SPEED]
        ratio = fits[-1] if fits else max(1, int(MOTOR_SPEED / speed))
        time = known.speed / float(known.acceleration or 1.0)
        return replace(
            joint,
            speed=speed,
            low=max(joint.low, -ENDLESS),
            high=min(joint.high, ENDLESS),
            acceleration=joint.acceleration or speed / time,
            ratio=float(joint.ratio or ratio),
        )

    def _frames(self, arm: ArmDescription) -> list[Array]:
        """Frames of the driven links of a description in those of the plant."""
        geometry = self.geometry
        back = np.linalg.inv(geometry.base)
        found = zip(arm.joints, arm.frames(geometry.straight), strict=True)
        frames = [frame for joint, frame in found if joint.follows is None]
        return [
            np.linalg.inv(placed(place)) @ back @ frame
            for place, frame in zip(geometry.places, frames, strict=True)
        ]

    def _start(self) -> Array:
        """The start pose as joint angles within their ranges."""
        if isinstance(self.geometry, AxesGeometry):
            start = bent_pose(self.geometry, self.arm)
            unit = "°, mm" if self.slides else "°"
            why = f"{unit}; far from singular, the hand down if the ranges let it"
            self._take("start pose", "soft.start_joint, arm.start_joint", self._told(start), why)
            return start
        signs, offsets = np.asarray(self.geometry.signs), np.asarray(self.geometry.offsets)
        wanted = signs * (START + offsets)
        found = []

        def singular(fifth: float) -> float:
            """0 where joints 4 and 6 are in line."""
            return abs(math.sin(signs[4] * fifth - offsets[4]))

        for joint, angle in zip(self.arm.driven, wanted, strict=True):
            turns = [angle + 2.0 * math.pi * n for n in (0, -1, 1, -2, 2)]
            within = [a for a in turns if joint.low <= a <= joint.high]
            margin = 0.05 * (joint.high - joint.low)
            nearest = min(max(angle, joint.low + margin), joint.high - margin)
            found.append(min(within, key=abs) if within else nearest)
        start = np.array(found)
        if singular(start[4]) < 0.1:
            joint = self.arm.driven[4]
            beside = [min(max(start[4] + by, joint.low), joint.high) for by in (0.5, -0.5)]
            start[4] = max(beside, key=singular)
        self._take("start pose", "soft.start_joint, arm.start_joint", in_degrees(start),
                   "°; upper arm upright, forearm level, hand down, within the ranges")  # fmt: skip
        return start

    def _shared(self, start: Array) -> dict[str, Any]:
        geometry = self.geometry
        flange = geometry.flange
        angles = in_degrees(np.array(angles_of(flange[:3, :3])), EXACT)
        place = [round(float(x), 12) + 0.0 for x in flange[:3, 3]]
        tip = [*(round(1e3 * x, 9) + 0.0 for x in place), *angles]
        by: dict[str, Any]
        if isinstance(geometry, AxesGeometry):
            by, none = {"soft.arm_by": 1}, SIX - self.count
            if self.count < SIX or self.slides:
                by["*.joints"] = self.count
                slides = [int(k in self.slides) for k in range(self.count)]
                by["*.joint_slides"] = self._six(slides, 0)
            if self.levels:
                by["*.joint_level"] = self._six(self.levels, 0)
                by["*.hand_offset"] = geometry.hand.tolist()
            by |= {
                "*.axis_origin": geometry.origins.ravel().tolist() + [0.0, 0.0, 0.0] * none,
                "*.axis_direction": geometry.axes.ravel().tolist() + [0.0, 0.0, 1.0] * none,
                "soft.flange": tip,
                "soft.joint_offset": [0.0] * SIX,
            }
        else:
            by = {f"*.{n}": v for n, v in zip(LENGTHS, geometry.lengths, strict=True)}
            by["*.joint_sign"] = list(geometry.signs)
            by["*.joint_offset"] = in_degrees(np.array(geometry.offsets), EXACT)
            by["soft.tool"] = tip
        return {
            **by,
            "*.gear_ratio": self._six([j.ratio for j in self.arm.driven], 1.0),
            "*.start_joint": self._six(self._told(start), 0.0),
            "arm.tool_place": place,
            "arm.tool_turn": angles,
            "arm.tool_length": 0.0,
        }

    def _limits(self) -> dict[str, Any]:
        joints = self.arm.driven
        return {
            "soft.joint_low": self._six(self._told([j.low for j in joints]), -1.0),
            "soft.joint_high": self._six(self._told([j.high for j in joints]), 1.0),
            "soft.joint_speed": self._six(self._told([j.speed for j in joints]), 1.0),
            "soft.joint_acc": self._six(
                self._told([float(j.acceleration or 0.0) for j in joints]), 1.0
            ),
        }

    def _links(self) -> dict[str, Any]:
        """Masses, centres and tensors in the plant's frames, flat as its parameters are."""
        masses, centers, moments, products = [], [], [], []
        for joint, frame in zip(self.arm.driven, self._frames(self.arm), strict=True):
            link = joined("", [(joint.link, frame)])
            masses.append(round(link.mass, 9))
            centers += [_round(x) for x in link.center]
            moments += [_round(link.tensor[k, k]) for k in range(3)]
            products += [_round(link.tensor[i, j]) for i, j in ((0, 1), (1, 2), (2, 0))]
        none = [0.0] * 3 * (SIX - self.count)
        return {
            "arm.mass": self._six(masses, 0.0),
            "arm.center": centers + none,
            "arm.inertia": [max(0.0, x) for x in moments] + none,
            "arm.product": products + none,
            **self._hand(),
        }

    def _hand(self) -> dict[str, Any]:
        """What a linkage keeps level before the last joint, from its pivot, of a palletizer."""
        if not isinstance(self.geometry, AxesGeometry) or not self.geometry.linkage:
            return {}
        geometry, linkage = self.geometry, self.geometry.linkage
        frames = self.arm.frames(geometry.straight)
        back = np.linalg.inv(placed(geometry.places[-1] - geometry.hand))
        parts = [(self.arm.joints[k].link, back @ frames[k]) for k in linkage.pivots]
        hand = joined("", parts)
        beside = [
            self.arm.joints[k].link.name
            for k in (*linkage.plates, *linkage.pivots[:-1])
            if self.arm.joints[k].link.mass > 0.0
        ]
        if beside:
            raise InputError(
                f"{self.arm.name}: {', '.join(beside)}: a link between joints of the linkage has "
                "no place in the plant; its mass belongs to the links before and behind it"
            )
        return {
            "arm.hand_mass": round(hand.mass, 9),
            "arm.hand_center": [_round(x) for x in hand.center],
            "arm.hand_inertia": [max(0.0, _round(hand.tensor[k, k])) for k in range(3)],
            "arm.hand_product": [_round(hand.tensor[i, j]) for i, j in ((0, 1), (1, 2), (2, 0))],
        }

    def _payload(self) -> dict[str, Any]:
        mass, center, inertia = self._own_payload()
        self._take("payload", "arm.payload_mass", mass,
                   f"kg; of {self.like.machine.name} by the arm's mass")  # fmt: skip
        return {
            "arm.payload_mass": mass,
            "arm.payload_center": [_round(x) for x in center],
            "arm.payload_inertia": [_round(x) for x in inertia],
        }

    def _drive(self) -> dict[str, dict[str, Any]]:
        """Motors, gears, friction and gains in proportion to torques and inertias."""
        like = self.like
        loaded = self._loaded(self.arm, self.geometry, self._own_payload())
        known = self._loaded(like.arm, like.geometry, self._payload_of(like))
        torque, inertia = _demands(loaded)
        torque_like, inertia_like = _demands(known)
        none = np.zeros(SIX - self.count)  # of joints that are not there, all is as of the other's
        torque = np.concatenate([torque, torque_like[self.count :]])
        t, m = torque / torque_like, np.concatenate([inertia, none]) / inertia_like
        m[self.count :] = 1.0
        ratio = np.array([j.ratio for j in self.arm.driven], dtype=float)
        ratio = np.concatenate([ratio, like.of(PLANT, "gear_ratio")[self.count :]])
        geared = like.of(PLANT, "gear_ratio") / ratio
        motor, friction, stiff = m * geared**2, t * geared, np.maximum(t, m)
        slow = np.maximum(1.0, friction / motor)  # keeps friction no steeper than the other's

        def scaled(fmu: str, name: str, share: Array) -> list[float]:
            values = share * like.of(fmu, name)
            return [float(f"{x:.4g}") for x in values]

        motors = {
            "arm.motor_inertia": scaled(PLANT, "motor_inertia", motor),
            "arm.motor_coulomb": scaled(PLANT, "motor_coulomb", friction),
            "arm.motor_static": scaled(PLANT, "motor_static", friction),
            "arm.motor_viscous": scaled(PLANT, "motor_viscous", motor),
            "arm.motor_rest_speed": scaled(PLANT, "motor_rest_speed", slow),
        }
        gears = {
            **{f"arm.stiffness_{k}": scaled(PLANT, f"stiffness_{k}", stiff) for k in (1, 2, 3)},
            **{f"arm.knee_{k}": scaled(PLANT, f"knee_{k}", t) for k in (1, 2)},
            "arm.gear_damping": scaled(PLANT, "gear_damping", stiff),
            "arm.link_viscous": scaled(PLANT, "link_viscous", t),
        }
        moved = self.size * like.of(PLANT, "origin_error")
        moved[self.count :] = 0.0
        errors = {"arm.origin_error": [_round(x) for x in moved.ravel()]}
        if self.slides or self.count < SIX:
            errors |= self._screw_errors()
        if any(j.damping for j in self.arm.driven):
            usual = gears["arm.link_viscous"]
            given = [j.damping or v for j, v in zip(self.arm.driven, usual, strict=False)]
            gears["arm.link_viscous"] = [*given, *usual[self.count :]]
        gains = {
            "drives.velocity_gain": scaled(DRIVES, "velocity_gain", motor),
            "drives.torque_limit": self._six(self._torque_limits(torque, motors), 1.0),
        }
        speeds = np.array([j.speed for j in self.arm.driven]) * ratio[: self.count]
        speeds *= 60.0 / (2.0 * math.pi)
        if max(speeds) > 5000.0:
            wanted = [float(round(max(5000.0, 1.1 * s))) for s in speeds]
            gains["drives.speed_limit"] = self._six(wanted, 5000.0)
        name = like.machine.name
        self._take("motors, their friction", "arm.motor_*", motors["arm.motor_inertia"],
                   f"kg·m²; of {name} by inertia and torque of this arm's own motion")  # fmt: skip
        self._take("stiffness, lost motion, friction of gears", "arm.stiffness_*, arm.lost_motion",
                   gears["arm.stiffness_1"], f"N·m/rad; of {name} by torque; 3 arcmin")  # fmt: skip
        self._take("errors of its geometry", "arm.origin_error, arm.zero_error", "",
                   f"of {name} by size; 0 makes it exact")  # fmt: skip
        self._take("gains of the drives", "drives.velocity_gain", gains["drives.velocity_gain"],
                   f"N·m·s/rad; of {name} by the motors' inertia, for margins")  # fmt: skip
        return {"motors": motors, "gears": gears, "errors": errors, "drives": gains}

    def _screw_errors(self) -> dict[str, list[float]]:
        """Errors of gears where some joints have ball screws, and some are not there."""
        found = {}
        for name, value in (SCREW | {"zero_error": SCREW_ZERO}).items():
            values = self.like.of(PLANT, name).copy()
            values[self.slides] = value
            if name == "zero_error":
                values[self.count :] = 0.0
            found[f"arm.{name}"] = [_round(x) for x in values]
        if self.slides:
            shown = [1e6 * SCREW["lost_motion"]]
            self._take("errors of the ball screws", ", ".join(found), shown,
                       "µm of lost motion; usual ones")  # fmt: skip
        return found

    def _torque_limits(self, torque: Array, motors: dict[str, list[float]]) -> list[float]:
        """Torque limits of the motors: of the description if they bear the motion."""
        found, weak = [], []
        for k, joint in enumerate(self.arm.driven):
            ratio, acceleration = float(joint.ratio or 1.0), float(joint.acceleration or 0.0)
            rotor = motors["arm.motor_inertia"][k] * ratio * acceleration
            need = torque[k] / ratio + rotor + motors["arm.motor_static"][k]
            own = joint.effort / ratio
            if own >= need:
                found.append(float(f"{own:.4g}"))
                continue
            found.append(float(f"{SPARE * need:.4g}"))
            if joint.effort:
                unit = "N" if joint.slides else "N·m"
                weak.append(f"{joint.name}: {joint.effort:g} of {need * ratio:.4g} {unit}")
        if weak:
            why = f"N·m of the motors; the description's is too small: {', '.join(weak)}"
            what = "torque that bears payload and accelerations"
            self._take(what, "drives.torque_limit", found, why)
        elif not all(j.effort for j in self.arm.driven):
            self._take("torque", "drives.torque_limit", found,
                       "N·m of the motors; three times what the motion asks for")  # fmt: skip
        return found

    def _own_payload(self) -> tuple[float, Array, Array]:
        share = self.arm.mass / self.like.arm.mass
        mass, center, inertia = self._payload_of(self.like)
        if isinstance(self.geometry, AxesGeometry):  # whose flange is beside the last link's frame
            turn, place = self.geometry.flange[:3, :3], self.geometry.flange[:3, 3]
            center = turn @ center + place / self.size
            inertia = np.diag(turn @ np.diag(inertia) @ turn.T)
        return round(share * mass, 3), self.size * center, share * self.size**2 * inertia

    @staticmethod
    def _payload_of(like: ArmMachine) -> tuple[float, Array, Array]:
        names = ("payload_mass", "payload_center", "payload_inertia")
        mass, center, inertia = (like.of(PLANT, n) for n in names)
        return float(mass), center, inertia

    def _loaded(
        self, arm: ArmDescription, geometry: ArmGeometry, payload: tuple[float, Array, Array]
    ) -> ArmDescription:
        """The arm with a payload on its flange, which lies before the tip by the tool's frame."""
        flange = arm.tip_frame @ np.linalg.inv(geometry.flange)
        mass, center, inertia = payload
        load = RigidLink("payload", mass, center, np.diag(inertia))
        last = arm.joints[-1]
        link = joined(last.link.name, [(last.link, np.eye(4)), (load, flange)])
        return replace(arm, joints=(*arm.joints[:-1], replace(last, link=link)))


def _with_driven(arm: ArmDescription, driven: Sequence[ArmJoint]) -> ArmDescription:
    """An arm with other driven joints, those that follow them as they were."""
    left = iter(driven)
    joints = tuple(next(left) if j.follows is None else j for j in arm.joints)
    return replace(arm, joints=joints)


def _demands(arm: ArmDescription) -> tuple[Array, Array]:
    """Largest torque of each joint at its limits, and largest inertia that it feels."""
    random = np.random.default_rng(SEED)
    joints = arm.driven
    count = len(joints)
    q = random.uniform(-math.pi, math.pi, (STATES, count))
    for k, joint in enumerate(joints):
        if joint.slides:  # its range for the turn
            q[:, k] = joint.low + (q[:, k] / math.pi + 1.0) / 2.0 * (joint.high - joint.low)
    sign = random.choice([-1.0, 1.0], (2, STATES, count))
    v = sign[0] * np.array([j.speed for j in joints])
    acceleration = sign[1] * np.array([j.acceleration for j in joints], dtype=float)
    torque = np.abs(arm.inverse_dynamics(q, v, acceleration)).max(axis=0)
    still = np.zeros_like(q)
    inertia = [
        arm.inverse_dynamics(q, still, still + np.eye(count)[k], (0, 0, 0))[:, k].max()
        for k in range(count)
    ]
    found = np.array(inertia)
    if min(found) <= 0.0 or min(torque) <= 0.0:
        told = f"{arm.name}: joint {int(np.argmin(found)) + 1} moves no inertia"
        raise InputError(f"{told}: its links have masses without size")
    return torque, found


def _round(value: float) -> float:
    return float(f"{float(value):.10g}") + 0.0


def _numbered(places: Sequence[int]) -> str:
    return ", ".join(str(k + 1) for k in places)


def _shown(value: Any) -> str:
    if isinstance(value, list):
        return ", ".join(_shown(x) for x in value)
    return f"{value:.5g}" if isinstance(value, int | float) else str(value)
