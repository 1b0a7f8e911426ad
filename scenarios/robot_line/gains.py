"""Published gains of joint drives against gains tuned over three poses: the table of the README.

    .venv/bin/python scenarios/robot_line/gains.py

Margins are those of each joint's loop with the five others closed by their drives, at rest under
gravity. The joint counts as moving slowly and loaded: no Coulomb friction, which would only add
damping, and the gear on one side of its lost motion.
"""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import minimize

import motionfmu
from motionfmu.analysis import linear
from motionfmu.analysis.linear import AxisModel
from motionfmu.analysis.linear.stability import closed_poles, margins, moving
from motionfmu.analysis.linear.tuning_parts import linearised, matrices

HERE = Path(__file__).parent
# Pen down at the middle of the line; arm nearly straight; forearm folded back.
POSES = {
    "line": [0.0, 47.7, -15.2, 0.0, 57.5, 0.0],
    "stretched": [0.0, 75.0, -80.0, 0.0, 95.0, 0.0],
    "folded": [0.0, -10.0, 70.0, 0.0, 30.0, 0.0],
}
MOVING = {"arm.lost_motion": 0.0, "arm.motor_coulomb": 0.0, "arm.motor_static": 0.0,
          "arm.paper_height": -10.0}  # fmt: skip
# Position gain [1/s], velocity loop [Hz], integral time [s]. MINAS A4 and A5: recalled factory
# settings. Yaskawa's guidance for harmonic drives and articulated robots: 10 to 20 1/s, 10 to 20
# Hz, 50 to 100 ms.
RULES = {
    "MINAS A4": (63.0, 35.0, 0.016),
    "MINAS A5": (48.0, 27.0, 0.021),
    "Yaskawa, upper": (20.0, 20.0, 0.050),
    "Yaskawa, lower": (10.0, 10.0, 0.100),
}
# What a tuning keeps in all poses: peaks of |S| and of |link/command| of each joint.
PEAK_S, PEAK_LINK = 1.7, 1.3
Gains = np.ndarray[Any, np.dtype[np.float64]]  # (3, 6): position, velocity gain, integral time


def at(pose: str, gains: Gains | None = None, axis: int = 1) -> AxisModel:
    """The model of a joint in a pose."""
    start = {"arm.start_joint": list(POSES[pose])}
    given = {} if gains is None else settings(gains)
    return linear.model(HERE, axis, set={**MOVING, **start, **given})


def settings(gains: Gains) -> dict[str, list[float]]:
    """Gains as the drives take them."""
    names = "position_gain", "velocity_gain", "velocity_time"
    return {f"drives.{n}": row.tolist() for n, row in zip(names, gains, strict=True)}


def inertia(pose: str) -> Gains:
    """Inertia that each motor moves if gears are rigid and the other joints stand [kg·m²]."""
    axis = at(pose)
    parts, p = linearised(axis, "arm")
    point, own = axis.points["arm"], axis.values("arm")
    a, _, c, _ = parts.matrices(point.x, point.u, p)
    states = [s.name for s in parts.ode.states]
    rotors, speeds = ([states.index(f"{n}[{k}].{s}") for k in range(1, 7)]
                      for n, s in (("rotor", "angle"), ("link", "speed")))  # fmt: skip
    outputs = [y.name for y in parts.ode.outputs]
    torques = [outputs.index(f"gear_torque[{k}]") for k in range(1, 7)]
    # acceleration of links per gear torque is the inverse of the mass matrix
    mass = np.linalg.inv(a[np.ix_(speeds, rotors)] @ np.linalg.inv(c[np.ix_(torques, rotors)]))
    ratio = np.array([own[f"gear_ratio[{k}]"] for k in range(1, 7)])
    return np.array([own[f"motor_inertia[{k}]"] for k in range(1, 7)]) + np.diag(mass) / ratio**2


def rule(kp: float, hertz: float, integral: float, moved: Gains) -> Gains:
    """Gains of a cascade; the drives know the inertia that they move on the line."""
    return np.array([np.full(6, kp), 2.0 * math.pi * hertz * moved, np.full(6, integral)])


class Pose:
    """All six loops of a pose at some frequencies, without their drives."""

    def __init__(self, pose: str) -> None:
        axis = at(pose)
        names = ["", *(f"[{k}]" for k in range(2, 7))]
        cut = [f"drives.phase{n}" for n in names]
        torques = [f"arm.torque{n}" for n in names]
        shown = [f"arm.{v}{n}" for v in ("motor_phase", "link_angle") for n in names]
        found = matrices(axis, torques, shown, cut)
        values = axis.values("drives")
        self.period = values["period"]
        a, b, c, d = found.a, found.b, found.c, found.d
        for _ in range(round(self.period / found.period_ns * 1e9) - 1):  # the drive's period
            a, b = found.a @ a, found.a @ b + found.b
        low, high = 2.0 * math.pi * 0.3, 0.9 * math.pi / self.period
        modes = np.log(np.linalg.eigvals(a)) / self.period
        near = [abs(m) * np.linspace(0.7, 1.4, 25) for m in modes if 0.0 < m.imag < 1000.0]
        omega = np.unique(np.concatenate([np.geomspace(low, high, 160), *near]))
        self.z = np.exp(1j * omega[(omega > low) & (omega < high)] * self.period)
        resolvent = self.z[:, None, None] * np.eye(len(a)) - a
        plant = d + c @ np.linalg.solve(resolvent, np.broadcast_to(b, (len(self.z), *b.shape)))
        self.motor, self.link = plant[:, :6], plant[:, 6:]
        self.line = 2.0 * math.pi / values["encoder_lines"]  # [rad] of a line period
        self.forward, self.filter = values["feed_forward"], values["feed_forward_time"]
        arm = axis.values("arm")
        self.ratio = np.array([arm[f"gear_ratio[{k}]"] for k in range(1, 7)])

    def drives(self, gains: Gains) -> tuple[Any, Any]:
        """Torque per line period measured, and per rad of command; (frequencies, 6)."""
        kp, kv, ti = gains
        z, t = self.z[:, None], self.period
        loop = kv * (1.0 + t / ti * z / (z - 1.0)) / z
        change = (1.0 - 1.0 / z) / t
        smooth = t / (self.filter + t)
        forward = self.forward * change * smooth / (1.0 - (1.0 - smooth) / z)
        return loop * (kp + change) * self.line, loop * (kp + forward)

    def peaks(self, gains: Gains) -> Gains:
        """Peaks of |S| and of |link/command| of each joint, the others closed; (2, 6)."""
        back, command = self.drives(gains)
        closed = np.linalg.inv(np.eye(6) + back[:, :, None] * self.motor)
        # one loop opened, the others closed: 1/(1 + L) is the element of the whole's inverse
        s = np.abs(np.diagonal(closed, axis1=1, axis2=2))
        link = np.diagonal(self.link @ (closed * command[:, None, :]), axis1=1, axis2=2)
        return np.array([s.max(axis=0), (np.abs(link) * self.ratio).max(axis=0)])


def tuned(start: Gains, poses: list[Pose], rounds: int = 4) -> Gains:
    """Joint by joint, with the peaks kept in all poses.

    Least is the product of the lag behind a ramp, 1/Kp, and of what the time integral of the error
    after a step of load is, Ti/(Kp Kv).
    """
    gains = start.copy()

    def cost(x: Gains, k: int) -> float:
        tried = gains.copy()
        tried[:, k] = np.exp(x)
        peaks = np.max([p.peaks(tried) for p in poses], axis=0)
        over = np.maximum(peaks / np.array([[PEAK_S], [PEAK_LINK]]) - 1.0, 0.0).sum()
        return float(
            x[2] - 2.0 * x[0] - x[1] + 200.0 * over + 10.0 * max(0.0, math.log(2e-3) - x[2])
        )

    for _ in range(rounds):
        for k in range(6):
            found = minimize(cost, np.log(gains[:, k]), (k,), "Nelder-Mead",
                             options={"maxfev": 150, "xatol": 1e-3, "fatol": 1e-3})  # fmt: skip
            gains[:, k] = np.exp(found.x)
    return gains


def pose_cells(pose: str, gains: Gains) -> list[str]:
    """Worst margins and bandwidth of the six loops, peak of the links, least damped mode."""
    axes = [at(pose, gains, k) for k in range(1, 7)]
    loops = [axis.loop("drives.phase") for axis in axes]
    found = [margins(loop) for loop in loops]
    poles = np.log(moving(closed_poles(loops[0]))) / loops[0].dt
    poles = poles[(poles.imag > 0.0) & (poles.imag < 1000.0)]
    mode = poles[np.argmin(-poles.real / np.abs(poles))]
    stable = all(m.stable for m in found)
    return [
        pose if stable else f"{pose}: unstable",
        f"{min(m.gain for m in found):.1f}",
        f"{min(m.phase for m in found):.0f}",
        f"{max(m.sensitivity for m in found):.2f}",
        f"{min(m.bandwidth for m in found) / (2.0 * math.pi):.0f}",
        f"{Pose(pose).peaks(gains)[1].max():.1f}",
        f"{abs(mode) / (2.0 * math.pi):.1f}",
        f"{-mode.real / abs(mode):.3f}",
    ]


def line_cells(gains: Gains) -> list[str]:
    """Following error of axis 1 and how straight the first 90 mm are, from a run of the FMUs."""
    run = motionfmu.load(HERE).run(set=settings(gains), stop=14.0)
    if np.any(run["drives.alarm"]):
        return ["alarm", "alarm"]
    k = run.time > 5.0
    x, y, _ = run["arm.tool_position"][k].T
    beside = x - np.polyval(np.polyfit(y, x, 1), y)
    error = run["drives.following_error[1]"][k].mean() * run.parameter("drives.pulses_per_turn")[0]
    return [f"{error:.1f}", f"{1e6 * beside.std():.0f}"]


def table(told: Callable[[str], None] = print) -> None:
    """Print the tables of the README."""
    moved = inertia("line")
    rows = {name: rule(*given, moved) for name, given in RULES.items()}
    rows["tuned"] = tuned(rows["Yaskawa, upper"], [Pose(p) for p in POSES])
    told("| gains | pose | gain margin | phase margin [°] | peak S |"
         " bandwidth [Hz] | peak of a link | mode [Hz] | damping |"
         " lag [units] | line [µm] |")  # fmt: skip
    told("|" + "---|" * 11)
    for name, gains in rows.items():
        line = line_cells(gains)
        for k, pose in enumerate(POSES):
            ends = line if k == 0 else ["", ""]
            cells = ["" if k else name, *pose_cells(pose, gains), *ends]
            told("| " + " | ".join(cells) + " |")
    told("")
    told("| tuned | 1 | 2 | 3 | 4 | 5 | 6 |\n|" + "---|" * 7)
    kp, kv, ti = rows["tuned"]
    hertz = kv / moved / (2.0 * math.pi)
    for what, values in (("Kp [1/s]", kp), ("Kv [Hz]", hertz), ("Ti [ms]", 1e3 * ti)):
        told(f"| {what} | " + " | ".join(f"{v:.3g}" for v in values) + " |")


if __name__ == "__main__":
    table()
