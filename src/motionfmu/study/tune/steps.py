"""Linear difference equations over many steps, with their derivatives."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
# Steps of a chunk.
_CHUNK = 32
# Steps from each input of a chunk to each output; an output before the input has the last index,
# where the response is 0.
_LATE = np.subtract.outer(np.arange(_CHUNK), np.arange(_CHUNK))
_LATE[_LATE < 0] = _CHUNK
# A transient has ended when it is below this share of its start.
_FORGOTTEN = 1e-12


@dataclass(frozen=True)
class ArrayWithSlopes:
    """An array and its derivatives to the gains, along their first axis; there may be no gain."""

    value: Any
    slopes: Any

    def __matmul__(self, other: "ArrayWithSlopes") -> "ArrayWithSlopes":
        slopes = self.slopes @ other.value + self.value @ other.slopes
        return ArrayWithSlopes(self.value @ other.value, slopes)

    def __add__(self, other: "ArrayWithSlopes") -> "ArrayWithSlopes":
        return ArrayWithSlopes(self.value + other.value, self.slopes + other.slopes)

    def __sub__(self, other: "ArrayWithSlopes") -> "ArrayWithSlopes":
        return ArrayWithSlopes(self.value - other.value, self.slopes - other.slopes)

    def __getitem__(self, rows: slice) -> "ArrayWithSlopes":
        return ArrayWithSlopes(self.value[rows], self.slopes[:, rows])

    @property
    def alone(self) -> "ArrayWithSlopes":
        """The array without derivatives."""
        return ArrayWithSlopes(self.value, self.slopes[:0])

    def beside(self, other: "ArrayWithSlopes") -> "ArrayWithSlopes":
        """Both arrays joined along the last axis."""
        pairs = (self.value, other.value), (self.slopes, other.slopes)
        return ArrayWithSlopes(*(np.concatenate(pair, axis=-1) for pair in pairs))

    def above(self, other: "ArrayWithSlopes") -> "ArrayWithSlopes":
        """Both arrays joined along the first axis."""
        value = np.concatenate([self.value, other.value])
        return ArrayWithSlopes(value, np.concatenate([self.slopes, other.slopes], axis=1))

    def columns(self, part: slice) -> "ArrayWithSlopes":
        """A slice along the last axis."""
        return ArrayWithSlopes(self.value[..., part], self.slopes[..., part])


def blocks(rows: list[list[Any]], gains: int) -> ArrayWithSlopes:
    """A matrix of blocks, some of which have derivatives to so many gains."""
    values = [[b.value if isinstance(b, ArrayWithSlopes) else b for b in row] for row in rows]
    change = [
        [b.slopes if isinstance(b, ArrayWithSlopes) else np.zeros((gains, *b.shape)) for b in row]
        for row in rows
    ]
    return ArrayWithSlopes(np.block(values), np.block(change))


def power(a: ArrayWithSlopes, count: int) -> ArrayWithSlopes:
    """A^count, count > 0, by repeated squaring."""
    found = None
    while True:
        if count % 2:
            found = a if found is None else found @ a
        count //= 2
        if not count:
            assert found is not None
            return found
        a = a @ a


def lifted(
    a: ArrayWithSlopes, b: ArrayWithSlopes, count: int
) -> tuple[ArrayWithSlopes, ArrayWithSlopes, ArrayWithSlopes]:
    """Matrices of `count` periods as one, over which the input changes linearly.

    Returns the state matrix, and the input matrices of the values at the beginning and at the end.
    """
    # The states, the input, and what it grows by over all periods.
    (n, m), gains = b.value.shape, len(b.slopes)
    one, none = np.eye(m), np.zeros((m, m))
    rows: list[list[Any]] = [
        [a, b, np.zeros((n, m))],
        [np.zeros((m, n)), one, one / count],
        [np.zeros((m, n)), none, one],
    ]
    whole = power(blocks(rows, gains), count)[:n]
    end = whole.columns(slice(n + m, None))
    return whole.columns(slice(n)), whole.columns(slice(n, n + m)) - end, end


def scan(a: Array, v: Array) -> Array:
    """States (..., n, count) of x[k + 1] = A x[k] + v[k], x[0] = 0.

    The sum over past inputs is doubled round by round, A^1, A^2, A^4 ..., until what is older
    is forgotten.
    """
    x = np.zeros_like(v)
    x[..., 1:] = v[..., :-1]
    power, reach = a, 1
    while reach < x.shape[-1] and np.abs(power).max(initial=0.0) > _FORGOTTEN:
        x[..., reach:] += power @ x[..., :-reach]
        power, reach = power @ power, 2 * reach
    return x


@dataclass(frozen=True)
class DifferenceEquations:
    """x[k + 1] = A x[k] + B u[k], y[k] = C x[k] + D u[k], in chunks of c steps.

    The outputs of a chunk are one product of matrices with its inputs and the state before it.
    """

    step: ArrayWithSlopes  # (n, n) the state matrix of a chunk
    feed: ArrayWithSlopes  # (n, c m) from the inputs of a chunk to the state after it
    show: ArrayWithSlopes  # (p, c, c m + n) from its inputs and the state before it to its outputs

    def driven(self, u: Array, du: Array | None = None) -> "DrivenEquations":
        """Drive the system from rest by inputs (m, count), with derivatives (g, m, count)."""
        inputs = _chunks(u)
        x = scan(self.step.value, self.feed.value @ inputs.T)
        change = self.step.slopes @ x + self.feed.slopes @ inputs.T
        if du is None:
            moved = scan(self.step.value, change).swapaxes(-1, -2)
        else:
            dinputs = _chunks(du)
            change += self.feed.value @ dinputs.swapaxes(-1, -2)
            dx = scan(self.step.value, change).swapaxes(-1, -2)
            moved = np.concatenate([dinputs, dx], axis=-1)
        return DrivenEquations(self.show, np.hstack([inputs, x.T]), moved, u.shape[-1])


@dataclass(frozen=True)
class DrivenEquations:
    """A system with its inputs, from which outputs are computed as they are needed."""

    show: ArrayWithSlopes
    known: Array  # (chunks, c m + n) inputs of each chunk and the state before it
    moved: Array  # (g, chunks, w) derivatives of the last of these
    count: int

    def outputs(self, rows: slice, slopes: bool = True) -> ArrayWithSlopes:
        """Some outputs (p, count)."""
        show = self.show[rows] if slopes else self.show[rows].alone
        moved = self.moved[: len(show.slopes)]
        p, c, w = show.value.shape
        value = self.known @ show.value.reshape(p * c, w).T
        change = self.known @ show.slopes.reshape(len(moved), p * c, w).swapaxes(-1, -2)
        last = moved.shape[-1]
        change += moved @ show.value[..., w - last :].reshape(p * c, last).T
        return ArrayWithSlopes(*(self._along(v, p, c) for v in (value, change)))

    def _along(self, found: Array, p: int, c: int) -> Array:
        """Outputs (..., p, count) in order from outputs of chunks (..., chunks, p c)."""
        *g, chunks, _ = found.shape
        rows = found.reshape(*g, chunks, p, c).swapaxes(-2, -3).reshape(*g, p, chunks * c)
        return rows[..., : self.count]

    def at(self, row: int, k: int) -> ArrayWithSlopes:
        """One output at one step."""
        chunk, place = divmod(k, self.show.value.shape[1])
        known, moved = self.known[chunk], self.moved[:, chunk]
        value, change = self.show.value[row, place], self.show.slopes[:, row, place]
        return ArrayWithSlopes(
            value @ known, change @ known + moved @ value[len(value) - moved.shape[-1] :]
        )


def _chunks(u: Array) -> Array:
    """Inputs (..., m, count) as those of chunks (..., chunks, c m); zeros fill the last chunk."""
    *g, m, count = u.shape
    chunks = -(-count // _CHUNK)
    wide = np.zeros((*g, m, chunks * _CHUNK))
    wide[..., :count] = u
    split = wide.reshape(*g, m, chunks, _CHUNK)
    return np.moveaxis(split, -3, -1).reshape(*g, chunks, _CHUNK * m)


def system(
    a: ArrayWithSlopes, b: ArrayWithSlopes, c: ArrayWithSlopes, d: ArrayWithSlopes
) -> DifferenceEquations:
    """Make the matrices of chunks from those of single steps."""
    (n, m), p = b.value.shape, len(c.value)
    x, y, step = b, c, a  # A^k B side by side and C A^k one above the other: twice as many a round
    for _ in range(_CHUNK.bit_length() - 1):
        x, y, step = x.beside(step @ x), y.above(y @ step), step @ step
    answers = c @ x
    feed, show = [], []
    parts = ((v.value, v.slopes) for v in (x, y, answers, d))
    for of_x, of_y, answer, direct in zip(*parts, strict=True):
        *g, _, _ = of_x.shape
        feed.append(of_x.reshape(*g, n, _CHUNK, m)[..., ::-1, :].reshape(*g, n, _CHUNK * m))
        each = np.zeros((*g, p, _CHUNK + 1, m))  # the last one is none
        each[..., 0, :] = direct
        each[..., 1:-1, :] = answer.reshape(*g, p, _CHUNK, m)[..., :-1, :]
        from_inputs = each[..., _LATE, :].reshape(*g, p, _CHUNK, _CHUNK * m)
        from_state = of_y.reshape(*g, _CHUNK, p, n).swapaxes(-2, -3)
        show.append(np.concatenate([from_inputs, from_state], axis=-1))
    return DifferenceEquations(step, ArrayWithSlopes(*feed), ArrayWithSlopes(*show))
