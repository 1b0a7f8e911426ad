"""Linear difference equations over many steps, with their derivatives."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import matrix_balance, svd

Array = NDArray[np.float64]
# A transient below this share of its start is over.
_FORGOTTEN = 1e-12
_ROUNDS_MAX = 40
# Share of a matrix that is rounding.
_NOTHING = 1e-13


def scan(a: Array, v: Array) -> Array:
    """States (..., n, count) of x[k + 1] = A x[k] + v[k], x[0] = 0.

    The sum over past inputs is doubled round by round, A^1, A^2, A^4 ..., until what is older
    is forgotten. States at the beginning on which nothing depends are left to the end.
    """
    first = int(np.argmax(a.any(axis=0))) if a.any() else len(a)
    x = np.zeros_like(v)
    x[..., 1:] = v[..., :-1]
    power, reach, rest = a[first:, first:], 1, x[..., first:, :]
    for _ in range(_ROUNDS_MAX):
        if reach >= x.shape[-1] or not np.abs(power).max(initial=0.0) > _FORGOTTEN:
            break
        rest[..., reach:] += power @ rest[..., :-reach]
        power, reach = power @ power, 2 * reach
    if first:
        x[..., :first, 1:] += a[:first, first:] @ rest[..., :-1]
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

    def turned(self, to: Array, back: Array) -> "Lifted":
        """The same in the states of `forgotten`, x = `to` times them."""
        a = back @ self.a @ to
        small = np.abs(a).max(axis=0) < _NOTHING * np.abs(a).max()
        a[:, small] = 0.0
        begin, end, dbegin, dend = (
            back @ m for m in (self.begin, self.end, self.dbegin, self.dend)
        )
        return Lifted(a, begin, end, back @ self.da @ to, dbegin, dend)

    def inputs(self, which: slice) -> "Lifted":
        """The same with some of its inputs."""
        moved = self.begin, self.end, self.dbegin, self.dend
        begin, end, dbegin, dend = (m[..., which] for m in moved)
        return Lifted(self.a, begin, end, self.da, dbegin, dend)

    def states(self, u: Array) -> Array:
        """States (n, count) driven by an input (m, count)."""
        return scan(self.a, _driven(self.begin, self.end, u))

    def slopes(self, x: Array, u: Array) -> Array:
        """Derivatives (g, n, count) of states to gains."""
        return scan(self.a, self.da @ x + _driven(self.dbegin, self.dend, u))


def _driven(begin: Array, end: Array, u: Array) -> Array:
    """What an input adds, as one product of matrices: those of one column are slow."""
    both = np.concatenate([u, np.roll(u, -1, axis=-1)], axis=-2)
    found: Array = np.concatenate([begin, end], axis=-1) @ both
    return found


def forgotten(a: Array) -> tuple[Array, Array]:
    """T and its inverse: T^-1 A T has first what is forgotten after one step: columns of 0.

    Several periods together leave nothing of what was delayed by some. T is orthogonal in balanced
    states, so no digits are lost.
    """
    balanced, (scale, _) = matrix_balance(a, permute=False, separate=True)
    turn = svd(balanced)[2][::-1].T
    return scale[:, None] * turn, turn.T / scale


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
