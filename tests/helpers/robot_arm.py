"""The arm's class and parameters as other people's code wants them: pinocchio, DH, numbers."""

from functools import cache
from pathlib import Path
from typing import Any

import casadi as ca
import numpy as np
import pinocchio

from motionfmu.fmu.modelica import causal
from motionfmu.fmu.modelica.ode import Ode

PACKAGE = Path(__file__).resolve().parents[2] / "modelica" / "MotionControl"
AXES = "zyyzyz"
EXACT = {"lost_motion": 0.0, "transmission_error_1": 0.0, "transmission_error_2": 0.0,
         "zero_error": 0.0, "origin_error": 0.0}  # fmt: skip


@cache
def arm(name: str = "SixAxisArm", package: Path = PACKAGE) -> Ode:
    """A Modelica class of arms, flattened once."""
    return causal.load(package, f"MotionControl.{name}")


class Arm:
    """The equation with some parameters changed, a value for a whole array or an array."""

    class_name = "SixAxisArm"
    package = PACKAGE

    def __init__(self, **changed: Any) -> None:
        self.ode = arm(self.class_name, self.package)
        self.p = np.array(self.ode.p0)
        for name, value in changed.items():
            places = [k for k, d in enumerate(self.ode.parameters) if d.port == name]
            assert places, name
            self.p[places] = np.broadcast_to(np.ravel(value), len(places))
        self._f = self.ode.function()
        self.states = [d.name for d in self.ode.states]
        self.start = self.ode.initial(self.p)

    def parameter(self, name: str) -> np.ndarray:
        """Value of a parameter, a whole array of it."""
        found = [(d, v) for d, v in zip(self.ode.parameters, self.p, strict=True) if d.port == name]
        return np.array([v for _, v in found]).reshape(found[0][0].dims or ())

    def places(self, state: str) -> list[int]:
        """Index of a state of the joints, for example link.angle."""
        part, name = state.split(".")
        return [self.states.index(f"{part}[{k}].{name}") for k in range(1, 7)]

    def state(self, **joints: Any) -> np.ndarray:
        """State with values of the joints, by names such as link_angle; others 0."""
        x = np.zeros(len(self.states))
        for name, value in joints.items():
            x[self.places(name.replace("_", ".", 1))] = value
        return x

    def rates(self, x: np.ndarray, u: np.ndarray) -> np.ndarray:
        """dx/dt."""
        return np.array(self._f(x, u, self.p)[0].full()).ravel()

    def outputs(self, x: np.ndarray, u: np.ndarray) -> dict[str, np.ndarray]:
        """Outputs by the names of their ports."""
        y = np.array(self._f(x, u, self.p)[1].full()).ravel()
        found: dict[str, list[float]] = {}
        for d, v in zip(self.ode.outputs, y, strict=True):
            found.setdefault(d.port, []).append(v)
        return {n: np.array(v) for n, v in found.items()}

    def stepped(self, h: float, steps: int) -> ca.Function:
        """Runge-Kutta steps of h as the FMU makes them: (x, u) -> all states and outputs."""
        x, u = ca.MX.sym("x", len(self.states)), ca.MX.sym("u", len(self.ode.inputs))
        k1 = self._f(x, u, self.p)[0]
        k2 = self._f(x + h / 2 * k1, u, self.p)[0]
        k3 = self._f(x + h / 2 * k2, u, self.p)[0]
        k4 = self._f(x + h * k3, u, self.p)[0]
        one = ca.Function("one", [x, u], [x + h / 6 * (k1 + 2 * (k2 + k3) + k4)])
        return one.mapaccum(steps)


class ByAxes(Arm):
    """The equation of an arm by its axes."""

    class_name = "AxesArm"


class OtherAxes(Arm):
    """The class with lengths as a copy of its package has it, whose axes are others."""

    def __init__(self, package: Path, **changed: Any) -> None:
        self.package = package
        super().__init__(**changed)


class LevelLinks(ByAxes):
    """The same with links and a hand that a linkage keeps level."""

    class_name = "LevelArm"


def axes_of(a: Arm) -> tuple[np.ndarray, np.ndarray]:
    """Origins of the joints, each from the one before, and axes; frames as at inner 0."""
    if isinstance(a, ByAxes):
        axes = a.parameter("axis_direction")
        axes = axes / np.linalg.norm(axes, axis=1)[:, None]
        return a.parameter("axis_origin") + a.parameter("origin_error"), axes
    c1, a1, b, c2, a2, c3, c4 = (float(a.parameter(n)) for n in "c1 a1 b c2 a2 c3 c4".split())
    rows = [[0, 0, c1], [a1, b, 0], [0, 0, c2], [a2, 0, 0], [0, 0, c3], [0, 0, c4]]
    return np.array(rows) + a.parameter("origin_error"), np.eye(3)[["xyz".index(n) for n in AXES]]


def urdf(a: Arm) -> str:
    """The arm as a URDF, payload on the last link, frames as at inner 0."""
    kind = kinds_of(a)
    joints = "".join(
        joint_line(f"j{k + 1}", kind[k], (f"l{k}", f"l{k + 1}"), o, axis)
        for k, (o, axis) in enumerate(zip(*axes_of(a), strict=True))
    )
    fixed = joint_line("held", "fixed", ("l6", "load"), np.zeros(3), np.ones(3))
    return f'<robot name="arm"><link name="l0"/>{bodies_of(a)}{joints}{fixed}</robot>'


def bodies_of(a: Arm) -> str:
    """Its links l1 .. l6 and the payload as elements of a URDF."""
    names = ("mass", "center", "inertia", "product")
    rows = zip(*(a.parameter(n) for n in names), strict=True)
    bodies = [(f"l{k}", *row) for k, row in enumerate(rows, 1)]
    payload = ("load", *(a.parameter(f"payload_{n}") for n in ("mass", "center", "inertia")))
    return "".join(body(*row) for row in [*bodies, payload])


def joint_line(name: str, kind: str, ends: tuple[str, str], origin: Any, axis: Any) -> str:
    """A joint of a URDF, its ends parent and child."""
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{ends[0]}"/><child link="{ends[1]}"/>'
        f'<origin xyz="{_numbers(origin)}" rpy="0 0 0"/><axis xyz="{_numbers(axis)}"/>'
        '<limit lower="-9" upper="9" effort="1e6" velocity="1e3"/></joint>'
    )


def kinds_of(a: Arm) -> list[str]:
    """Of each place whether its joint turns, slides or is none."""
    if not isinstance(a, ByAxes):
        return ["revolute"] * 6
    slides, count = a.parameter("joint_slides"), int(a.parameter("joints"))
    found = ["prismatic" if s else "revolute" for s in slides[:count]]
    return [*found, *["fixed"] * (6 - count)]


def _numbers(v: Any) -> str:
    return " ".join(repr(float(x)) for x in np.ravel(v))


def body(name: str, mass: Any, center: Any, inertia: Any, product: Any = (0, 0, 0)) -> str:
    """A link of a URDF."""
    xx, yy, zz = (repr(float(v)) for v in inertia)
    xy, yz, zx = (repr(float(v)) for v in product)
    return (
        f'<link name="{name}"><inertial><origin xyz="{_numbers(center)}" rpy="0 0 0"/>'
        f'<mass value="{float(mass)!r}"/><inertia ixx="{xx}" iyy="{yy}" izz="{zz}" '
        f'ixy="{xy}" ixz="{zx}" iyz="{yz}"/></inertial></link>'
    )


class Pinocchio:
    """The links of an arm in pinocchio, at inner angles."""

    def __init__(self, a: Arm) -> None:
        self.model = pinocchio.buildModelFromXML(urdf(a))
        self.model.gravity.linear = np.array([0.0, 0.0, -float(a.parameter("gravity"))])
        self.data = self.model.createData()

    def inverse(self, q: np.ndarray, v: np.ndarray, acceleration: np.ndarray) -> np.ndarray:
        """Torques of the joints."""
        return np.array(pinocchio.rnea(self.model, self.data, q, v, acceleration))

    def forward(self, q: np.ndarray, v: np.ndarray, torque: np.ndarray) -> np.ndarray:
        """Accelerations of the joints."""
        return np.array(pinocchio.aba(self.model, self.data, q, v, torque))

    def gravity(self, q: np.ndarray) -> np.ndarray:
        """Torques that hold the arm."""
        return self.inverse(q, np.zeros(len(q)), np.zeros(len(q)))

    def inertia(self, q: np.ndarray) -> np.ndarray:
        """Mass matrix."""
        half = np.triu(pinocchio.crba(self.model, self.data, q))
        return half + np.triu(half, 1).T

    def energy(self, q: np.ndarray, v: np.ndarray) -> float:
        """Kinetic and potential energy."""
        kinetic = pinocchio.computeKineticEnergy(self.model, self.data, q, v)
        return float(kinetic + pinocchio.computePotentialEnergy(self.model, self.data, q))
