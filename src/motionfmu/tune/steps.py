"""Linear difference equations over many steps, with their derivatives."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
# A transient below this share of its start is over.
_FORGOTTEN = 1e-12
_ROUNDS_MAX = 40


def scan(a: Array, v: Array) -> Array:
    """States (..., n, count) of x[k + 1] = A x[k] + v[k], x[0] = 0.

    The sum over past inputs is doubled round by round, A^1, A^2, A^4 ..., until what is older
    is forgotten.
    """
    x = np.zeros_like(v)
    x[..., 1:] = v[..., :-1]
    power, reach = a, 1
    for _ in range(_ROUNDS_MAX):
        if reach >= x.shape[-1] or not np.abs(power).max(initial=0.0) > _FORGOTTEN:
            break
        x[..., reach:] += power @ x[..., :-reach]
        power, reach = power @ power, 2 * reach
    return x


@dataclass(frozen=True)
class Lifted:
    """Several periods at once, and the derivatives to the gains.

    The input goes straight from its value at the beginning to that at the end.
    """

    a: Array  # (n, n) state matrix
    begin: Array  # (n, m) input matrix of the value at the beginning
    end: Array  # (n, m) of that at the end
    da: Array  # (g, n, n) derivatives to the gains, and so on
    dbegin: Array
    dend: Array

    def states(self, u: Array) -> Array:
        """States (n, count) driven by an input (m, count)."""
        return scan(self.a, self.begin @ u + self.end @ np.roll(u, -1, axis=-1))

    def slopes(self, x: Array, u: Array, du: Array | None = None) -> Array:
        """Derivatives (g, n, count) of states to gains; du: of the input."""
        later = np.roll(u, -1, axis=-1)
        v = self.da @ x + self.dbegin @ u + self.dend @ later
        if du is not None:
            v += self.begin @ du + self.end @ np.roll(du, -1, axis=-1)
        return scan(self.a, v)


def lifted(a: Array, b: Array, da: Array, db: Array, count: int) -> Lifted:
    """Put several periods together, with derivatives (g, ...)."""
    n = len(a)
    power, dpower = np.eye(n), np.zeros_like(da)
    begin, end = np.zeros_like(b), np.zeros_like(b)
    dbegin, dend = np.zeros_like(db), np.zeros_like(db)
    for k in range(count - 1, -1, -1):  # A^(count - 1 - k) B u[k]
        part, dpart = power @ b, dpower @ b + power @ db
        share = k / count
        begin += (1.0 - share) * part
        end += share * part
        dbegin += (1.0 - share) * dpart
        dend += share * dpart
        power, dpower = a @ power, da @ power + a @ dpower
    return Lifted(power, begin, end, dpower, dbegin, dend)
