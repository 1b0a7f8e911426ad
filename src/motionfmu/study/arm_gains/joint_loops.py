"""The six loops of an arm's drives at poses, as frequency responses."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis import linear
from motionfmu.analysis.linear.axis import AxisModel
from motionfmu.analysis.linear.linear_form import Gain
from motionfmu.analysis.linear.parts import elements
from motionfmu.analysis.linear.pointwise import Quick
from motionfmu.analysis.linear.tuning_parts import linearised, matrices
from motionfmu.arm_machines.machine_arm import BY_LENGTHS, CONTROLLER, DRIVES
from motionfmu.base.errors import InputError
from motionfmu.run import Scenario

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
JOINTS = range(1, 7)
GAINS = ("position_gain", "velocity_gain", "velocity_time")
# A joint counts as moving slowly under its load: friction that holds it would damp, and a gear in
# its lost motion has no stiffness at all. No paper holds the pen.
MOVING = {"lost_motion": 0.0, "motor_coulomb": 0.0, "motor_static": 0.0, "paper_height": -10.0}
# Frequencies: from this on [Hz], to this share of half the drives' sampling rate.
LOWEST, TOP, COUNT = 0.3, 0.9, 360


def arm_names(scenario: Scenario) -> dict[str, str] | None:
    """Component by FMU of a scenario with an arm, its drives and its controller; else None."""
    names = {fmu: name for name, fmu in scenario.document.body.component.items()}
    wanted = (BY_LENGTHS, DRIVES, CONTROLLER)
    return {fmu: names[fmu] for fmu in wanted} if names.keys() >= set(wanted) else None


@dataclass(frozen=True)
class PoseResponses:
    """An arm at poses, without its drives: responses to the torques of its motors."""

    poses: Array  # (n, 6) [deg]
    motor: Complex  # (n, f, 6, 6): line periods of each encoder per torque
    link: Complex  # (n, f, 6, 6): links' angles [rad] per torque
    inertia: Array  # (n, 6) [kg.m2] that each motor moves if gears are rigid and others stand

    def __len__(self) -> int:
        return len(self.poses)

    def of(self, which: Sequence[int]) -> "PoseResponses":
        """Some of the poses."""
        k = list(which)
        return PoseResponses(self.poses[k], self.motor[k], self.link[k], self.inertia[k])

    def and_(self, other: "PoseResponses") -> "PoseResponses":
        """The poses of both."""
        fields = ("poses", "motor", "link", "inertia")
        return PoseResponses(
            *(np.concatenate([getattr(self, f), getattr(other, f)]) for f in fields)
        )


class JointLoops:
    """Loops of a scenario's six joints, whose gains are variables."""

    def __init__(self, scenario: Scenario, set_: dict[str, Any]) -> None:
        names = arm_names(scenario)
        if names is None:
            told = f"{BY_LENGTHS}, {DRIVES} and {CONTROLLER} are wanted among the components"
            raise InputError(f"{scenario.document.file}: no arm: {told}")
        self.scenario, self.names = scenario, names
        self.arm, self.drives = names[BY_LENGTHS], names[DRIVES]
        still = {f"{self.arm}.{n}": v for n, v in MOVING.items()}
        # Feed-forward moves no pole: what it adds to the swing is the command's.
        still[f"{self.drives}.feed_forward"] = 0.0
        self.given, self.set = dict(set_), {**set_, **still}
        self.axes = {k: linear.model(scenario, k, set=self.set) for k in JOINTS}
        first = self.axes[1]
        values = first.values(self.drives)
        self.period = float(values["period"])
        low, high = 2.0 * math.pi * LOWEST, TOP * math.pi / self.period
        self.omega: Array = np.geomspace(low, high, COUNT)
        self.z: Complex = np.exp(1j * self.omega * self.period)
        self._laws = [_DriveLaw(self.axes[k], self.drives) for k in JOINTS]
        # Links' angles per command are compared with the way that the gears alone would give them.
        own = [self.axes[k].values(self.arm)["gear_ratio"] for k in JOINTS]
        pulses = [self.axes[k].values(self.drives)["pulses_per_turn"] for k in JOINTS]
        self.scale = np.array(own) * np.array(pulses, dtype=float) / (2.0 * math.pi)
        self.ratio = np.array(own)

    @property
    def present(self) -> Array:
        """Gains (3, 6) as the scenario has them: of position, of velocity, its integral time."""
        return np.array([[self.axes[k].value(f"{self.drives}.{n}") for k in JOINTS] for n in GAINS])

    def settings(self, gains: Array) -> dict[str, list[float]]:
        """Gains as the drives take them."""
        return {f"{self.drives}.{n}": row.tolist() for n, row in zip(GAINS, gains, strict=True)}

    def at(self, pose: Array, joint: int, gains: Array | None = None) -> AxisModel:
        """The linear model of a joint in a pose [deg]."""
        given = {} if gains is None else self.settings(gains)
        start = {f"{self.arm}.start_joint": np.asarray(pose, float).tolist()}
        return self.axes[joint].changed({**given, **start})

    def responses(self, poses: Array) -> PoseResponses:
        """An arm's responses at poses (n, 6) [deg]."""
        found = [self._pose(pose) for pose in poses]
        motor, link, inertia = (np.array(rows) for rows in zip(*found, strict=True))
        return PoseResponses(np.array(poses, dtype=float), motor, link, inertia)

    def _pose(self, pose: Array) -> tuple[Complex, Complex, Array]:
        axis = self.at(pose, 1)
        ends = elements(axis.others)
        torques = [f"{self.arm}.torque{n}" for n in ends]
        shown = [f"{self.arm}.{v}{n}" for v in ("motor_phase", "link_angle") for n in ends]
        found = matrices(axis, torques, shown, [f"{self.drives}.phase{n}" for n in ends])
        a, b, c, d = found.a, found.b, found.c, found.d
        for _ in range(round(self.period / found.period_ns * 1e9) - 1):  # the drives' period
            a, b = found.a @ a, found.a @ b + found.b
        # In modal coordinates a response is a sum: no equations at each frequency.
        poles, modes = np.linalg.eig(a)
        right, left = c @ modes, np.linalg.solve(modes, b.astype(complex))
        plant = (right[None] / (self.z[:, None, None] - poles)) @ left + d
        return plant[:, :6], plant[:, 6:], self._inertia(axis)

    def _inertia(self, axis: AxisModel) -> Array:
        """Inertia that each motor moves [kg.m2]."""
        parts, p = linearised(axis, self.arm)
        point, own = axis.points[self.arm], axis.values(self.arm)
        a, _, c, _ = parts.matrices(point.x, point.u, p)
        states = [s.name for s in parts.ode.states]
        outputs = [y.name for y in parts.ode.outputs]
        rotors = [states.index(f"rotor[{k}].angle") for k in JOINTS]
        speeds = [states.index(f"link[{k}].speed") for k in JOINTS]
        torques = [outputs.index(f"gear_torque[{k}]") for k in JOINTS]
        # Acceleration of links per gear torque is the inverse of the mass matrix.
        sides = a[np.ix_(speeds, rotors)], c[np.ix_(torques, rotors)]
        mass = np.linalg.inv(sides[0] @ np.linalg.inv(sides[1]))
        motors = np.array([own[f"motor_inertia[{k}]"] for k in JOINTS])
        return np.asarray(motors + np.diag(mass) / self.ratio**2)

    def drive(self, joint: int, gains: Array) -> tuple[Complex, Complex]:
        """Torque of a drive per line period measured, with its sign turned, and per pulse."""
        return self._laws[joint - 1](gains, self.z)

    def alone(self, arm: PoseResponses, gains: Array, joint: int) -> tuple[Complex, Complex]:
        """Motor and link of a joint per its own torque, the other loops closed: (n, f) each."""
        k = joint - 1
        back = np.array([self.drive(j, gains[:, j - 1])[0] for j in JOINTS]).T
        closed = np.eye(6) + back[:, :, None] * arm.motor
        closed[:, :, k] = np.eye(6)[k]
        unit = np.broadcast_to(np.eye(6)[:, k : k + 1], (*closed.shape[:-1], 1))
        torque = np.linalg.solve(closed, unit)[..., 0]
        sides = arm.motor[:, :, k], arm.link[:, :, k]
        motor, link = ((side * torque).sum(axis=-1) for side in sides)
        return motor, np.asarray(link * self.scale[k])

    def peaks(self, sides: tuple[Complex, Complex], joint: int, own: Array) -> tuple[Array, Array]:
        """Peaks of |1/(1 + L)| and of |link/command| in each pose, of what `alone` gives."""
        s, link = self.curves(sides, joint, own)
        return s.max(axis=1), link.max(axis=1)

    def curves(self, sides: tuple[Complex, Complex], joint: int, own: Array) -> tuple[Array, Array]:
        """|1/(1 + L)| and |link/command| over frequency in each pose: (n, f) each."""
        back, command = self.drive(joint, own)
        s = 1.0 / (1.0 + back * sides[0])
        return np.abs(s), np.abs(s * sides[1] * command)

    def all_peaks(self, arm: PoseResponses, gains: Array) -> Array:
        """Both peaks of every joint in every pose: (2, n, 6)."""
        found = np.empty((2, len(arm), 6))
        for j in JOINTS:
            found[:, :, j - 1] = self.peaks(self.alone(arm, gains, j), j, gains[:, j - 1])
        return found


class _DriveLaw:
    """The law that a drive's FMU carries, as a function of its gains."""

    def __init__(self, axis: AxisModel, drives: str) -> None:
        symbols = [ca.SX.sym(n) for n in GAINS]
        names = [f"{drives}.{n}" for n in GAINS]
        given = {n: Gain(axis.value(n), s) for n, s in zip(names, symbols, strict=True)}
        opened = axis.changed(given)
        ports = [f"{drives}.phase", f"{drives}.pulse_count"]
        cut = [f"{drives}.phase{n}" for n in elements(axis.others)]
        found = matrices(opened, ports, [f"{drives}.torque"], cut)
        parts = [ca.SX(ca.vertcat(*(ca.horzcat(*r) for r in m.tolist()))) for m in
                 (found.a, found.b, found.c, found.d)]  # fmt: skip
        self._matrices = Quick("law", [ca.vertcat(*symbols)], parts)

    def __call__(self, gains: Array, z: Complex) -> tuple[Complex, Complex]:
        a, b, c, d = self._matrices(gains)
        inner = z[:, None, None] * np.eye(len(a)) - a
        sides = np.broadcast_to(b.astype(complex), (len(z), *b.shape))
        found: Complex = np.asarray(c @ np.linalg.solve(inner, sides) + d, dtype=np.complex128)
        return -found[:, 0, 0], found[:, 0, 1]
