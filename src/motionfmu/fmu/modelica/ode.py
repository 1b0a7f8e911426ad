"""A class as an ordinary differential equation in CasADi."""

from dataclasses import dataclass

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from motionfmu.fmu.modelica.flat import Declaration

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Ode:
    """The one model: dx/dt = xdot(x, u, p), y = y(x, u, p).

    Attributes
    ----------
    name, description : str
        Of the class.
    states, inputs, parameters, outputs : tuple of Declaration
        What the elements of the vectors are, with unit and description.
    x, u, p : casadi.SX
        Columns of symbols; an Integer or a Boolean (0 or 1) is a real number here.
    xdot, y : casadi.SX
        Columns of expressions of x, u and p.
    start : casadi.SX
        Initial x, of p.
    checks : tuple of (casadi.SX, str)
        Asserts: conditions on p, with their messages.
    u0, p0 : tuple of float
        Start values of inputs and parameters.
    sizes : casadi.SX
        What is large for each state, of p: its attribute nominal, else 1. All 1 where the
        equation was read from an FMU.
    limits : dict
        Minimum, maximum and nominal value by name, None where not declared.
    """

    name: str
    description: str
    states: tuple[Declaration, ...]
    inputs: tuple[Declaration, ...]
    parameters: tuple[Declaration, ...]
    outputs: tuple[Declaration, ...]
    x: ca.SX
    u: ca.SX
    p: ca.SX
    xdot: ca.SX
    y: ca.SX
    start: ca.SX
    checks: tuple[tuple[ca.SX, str], ...]
    sizes: ca.SX
    u0: tuple[float, ...]
    p0: tuple[float, ...]
    limits: dict[str, tuple[float | None, float | None, float | None]]

    def function(self) -> ca.Function:
        """(x, u, p) -> (xdot, y) as a CasADi function."""
        names = ["x", "u", "p"], ["xdot", "y"]
        return ca.Function("ode", [self.x, self.u, self.p], [self.xdot, self.y], *names)

    def values(self, **changed: float) -> Vector:
        """Parameter vector with some values changed.

        Parameters
        ----------
        **changed : float
            By parameter name.

        Returns
        -------
        ndarray, shape (n_p,)

        Raises
        ------
        KeyError
            There is no such parameter.
        """
        names = [d.name for d in self.parameters]
        p = np.array(self.p0)
        for name, value in changed.items():
            if name not in names:
                raise KeyError(f"{self.name} has no parameter {name}")
            p[names.index(name)] = value
        return p

    def initial(self, p: Vector) -> Vector:
        """Initial state.

        Parameters
        ----------
        p : ndarray, shape (n_p,)

        Returns
        -------
        ndarray, shape (n_x,)
        """
        return np.array(ca.Function("start", [self.p], [self.start])(p)).ravel()

    def linear(self, x: Vector, u: Vector, p: Vector) -> tuple[Vector, Vector, Vector, Vector]:
        """Matrices A, B, C, D of the linearisation at a point.

        Parameters
        ----------
        x, u, p : ndarray
            State, input and parameter vectors.

        Returns
        -------
        tuple of ndarray
            d xdot/d x, d xdot/d u, d y/d x, d y/d u.
        """
        parts = [ca.jacobian(e, v) for e in (self.xdot, self.y) for v in (self.x, self.u)]
        a, b, c, d = ca.Function("abcd", [self.x, self.u, self.p], parts)(x, u, p)
        return np.array(a), np.array(b), np.array(c), np.array(d)
