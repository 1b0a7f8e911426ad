"""A plant's equation with the derivatives that identification needs, at many points at once."""

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.linear.pointwise import Quick
from motionfmu.fmu.modelica.ode import Ode

Array = NDArray[np.float64]
# Largest step of the integrator times the fastest rate: the error of a mode is 1 % of its own
# there, and the method is stable to 2.785.
_H_LAMBDA = 1.25
# Largest step times the usual fastest rate of a motion where contact opens and closes, since there
# the error is of the step's first order.
_H_CONTACT = 0.125


@dataclass(frozen=True)
class Places:
    """Where the nonzero elements of a matrix stand."""

    rows: NDArray[np.int64]
    columns: NDArray[np.int64]

    @classmethod
    def of(cls, sparsity: ca.Sparsity) -> "Places":
        """The places of CasADi's pattern, in its order of elements."""
        rows, columns = sparsity.get_triplet()
        return cls(np.array(rows, dtype=np.int64), np.array(columns, dtype=np.int64))


def _elements(m: ca.SX) -> ca.SX:
    """The nonzero elements of a matrix as a column."""
    nonzeros: list[Any] = m.nonzeros()
    return ca.SX(ca.vertcat(*nonzeros))


class PlantRates:
    """Rates and shown outputs of a plant, with their derivatives.

    `rates` is (x, u, p) -> xdot and the elements of its derivatives to x, u and the parameters
    named; `shows` the same of the outputs named.
    """

    def __init__(self, ode: Ode, outputs: Sequence[str], moved: Sequence[str]) -> None:
        self.ode, self.outputs, self.moved = ode, tuple(outputs), tuple(moved)
        shown = [d.name for d in ode.outputs]
        known = [d.name for d in ode.parameters]
        self.places_of_moved = np.array([known.index(n) for n in moved], dtype=np.int64)
        q = ode.p[self.places_of_moved.tolist()] if moved else ca.SX(0, 1)
        y = ode.y[np.array([shown.index(n) for n in outputs], dtype=np.int64).tolist()]
        arguments = [ode.x, ode.u, ode.p]
        parts = {}
        for name, e in (("rates", ode.xdot), ("shows", y)):
            slopes = [ca.jacobian(e, v) for v in (ode.x, ode.u, q)]
            made = [ca.densify(e), *(_elements(m) for m in slopes)]
            parts[name] = (
                ca.Function(name, arguments, made),
                tuple(Places.of(m.sparsity()) for m in slopes),
            )
        self.rates, self.rate_places = parts["rates"]
        self.shows, self.show_places = parts["shows"]
        self.start = Quick("start", [ode.p], [ode.start])
        self.width = ode.x.numel(), ode.u.numel(), ode.p.numel(), len(self.moved), len(self.outputs)
        self._mapped = functools.cache(lambda name, n: getattr(self, name).map(n))

    def at(self, name: str, x: Array, u: Array, p: Array) -> list[Array]:
        """`rates` or `shows` at points x, u of shape (n_x or n_u, points), one p for all."""
        points = x.shape[1]
        every = np.repeat(p[:, None], points, axis=1)
        return [np.array(r).reshape(-1, points) for r in self._mapped(name, points)(x, u, every)]

    def dense(self, name: str, found: list[Array]) -> tuple[Array, Array, Array]:
        """Derivatives to x, u and the moved parameters as (points, rows, columns)."""
        places = self.rate_places if name == "rates" else self.show_places
        rows = self.width[0] if name == "rates" else self.width[4]
        made = []
        wide = (self.width[0], self.width[1], self.width[3])
        for elements, place, columns in zip(found[1:], places, wide, strict=True):
            whole = np.zeros((found[0].shape[1], rows, columns))
            whole[:, place.rows, place.columns] = elements.T
            made.append(whole)
        return made[0], made[1], made[2]

    def fastest(self, x: Array, u: Array, p: Array) -> Array:
        """Largest |eigenvalue| [1/s] of the rates at each point, then at rest."""
        points, inputs = (
            np.column_stack([x, self.start(p)[0].ravel()]),
            np.column_stack([u, u[:, :1]]),
        )
        slopes = self.dense("rates", self.at("rates", points, inputs, p))[0]
        slopes = slopes[np.isfinite(slopes).all(axis=(1, 2))]
        return np.asarray(np.abs(np.linalg.eigvals(slopes)).max(axis=1, initial=0.0))

    def steps(self, span: float, fastest: Array, contact: bool = False) -> int:
        """Steps within a time [s] for rates [1/s] at points; `contact`: for one that opens."""
        needed = span * fastest.max(initial=0.0) / _H_LAMBDA
        if contact and len(fastest):
            needed = max(needed, span * float(np.median(fastest)) / _H_CONTACT)
        return max(1, math.ceil(needed))
