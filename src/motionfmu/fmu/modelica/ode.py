"""A class as an ordinary differential equation in CasADi."""

from dataclasses import dataclass

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from motionfmu.fmu.modelica.flat import Declaration

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Ode:
    """The model of a class for C text and linear models alike: xdot(x, u, p) and y(x, u, p)."""

    name: str  # of the class
    description: str
    # what the elements of the vectors are, with unit and description
    states: tuple[Declaration, ...]
    inputs: tuple[Declaration, ...]
    parameters: tuple[Declaration, ...]
    outputs: tuple[Declaration, ...]
    x: ca.SX  # columns of symbols; an Integer or a Boolean (0 or 1) is a real number here
    u: ca.SX
    p: ca.SX
    xdot: ca.SX  # columns of expressions of x, u and p
    y: ca.SX
    start: ca.SX  # initial x, of p
    checks: tuple[tuple[ca.SX, str], ...]  # asserts: conditions on p, with their messages
    # what is large for each state, of p: its attribute nominal, else 1; all 1 where the equation
    # was read from an FMU
    sizes: ca.SX
    u0: tuple[float, ...]  # start values of inputs and parameters
    p0: tuple[float, ...]
    # minimum, maximum and nominal value by name, None where not declared
    limits: dict[str, tuple[float | None, float | None, float | None]]

    def function(self) -> ca.Function:
        """(x, u, p) -> (xdot, y) as a CasADi function."""
        names = ["x", "u", "p"], ["xdot", "y"]
        return ca.Function("ode", [self.x, self.u, self.p], [self.xdot, self.y], *names)

    def values(self, **changed: float) -> Vector:
        """Parameter vector (n_p,), some values changed by name; a KeyError for unknown ones."""
        names = [d.name for d in self.parameters]
        p = np.array(self.p0)
        for name, value in changed.items():
            if name not in names:
                raise KeyError(f"{self.name} has no parameter {name}")
            p[names.index(name)] = value
        return p

    def initial(self, p: Vector) -> Vector:
        """Initial state (n_x,)."""
        return np.array(ca.Function("start", [self.p], [self.start])(p)).ravel()

    def linear(self, x: Vector, u: Vector, p: Vector) -> tuple[Vector, Vector, Vector, Vector]:
        """Matrices A, B, C, D at a point: d xdot/d x, d xdot/d u, d y/d x, d y/d u."""
        parts = [ca.jacobian(e, v) for e in (self.xdot, self.y) for v in (self.x, self.u)]
        a, b, c, d = ca.Function("abcd", [self.x, self.u, self.p], parts)(x, u, p)
        return np.array(a), np.array(b), np.array(c), np.array(d)
