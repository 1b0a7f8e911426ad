"""Weighted least squares of the equation of all joints, and the choice of its laws.

Each joint's rows are weighted by its own residuals (Gautier 1997). Everything that is tried is a
part of the same columns, so the products of columns with each other are computed once for each
joint, for the part that is fitted and for the part kept back.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from motionfmu.identify.arm_dynamics.joint_equation import JointEquation
from motionfmu.identify.arm_dynamics.torque_laws import LAWS
from motionfmu.identify.spread import autocorrelation

Array = NDArray[np.float64]
Laws = tuple[tuple[str, int], ...]  # name and joint, from 0
# A law must explain so much of what a joint leaves of the part kept back to be taken.
_WORTH = 0.95
# One taken before goes again if a joint's residual rises by no more without it.
_IDLE = 1.01
_WEIGHINGS = 5
# Scaled columns whose share of the information is below this are not told by the record at all.
_NOTHING = 1e-12
# Lags of Newey and West: the most, as a share of the rows.
_MOST = 0.05
_ROWS = 10  # rows a column at least


@dataclass(frozen=True)
class TorqueFit:
    """What least squares found."""

    places: NDArray[np.int64]  # columns of the equation that were fitted
    values: Array
    covariance: Array  # Newey and West, for residuals that are not white
    sizes: Array  # deviation of the residuals of each joint [N·m]
    condition: float  # of the weighted columns, each scaled to length 1
    lag: int  # rows up to which residuals count as one another's

    def with_others_fixed(self, count: int) -> Array:
        """Covariance of the first values where all others are as they were found."""
        unit = np.sqrt(np.diag(self.covariance))
        information = np.linalg.pinv(self.covariance / np.outer(unit, unit), hermitian=True)
        own = np.linalg.pinv(information[:count, :count], hermitian=True)
        return np.asarray(own * np.outer(unit[:count], unit[:count]))

    @property
    def deviations(self) -> Array:
        """Standard deviations."""
        return np.sqrt(np.diag(self.covariance))


@dataclass(frozen=True)
class TriedLaw:
    """How well a set of laws explains the part kept back."""

    laws: Laws
    fitted: Array  # (joints,) RMS of the residual over that of the torque about its mean
    kept: Array


@dataclass(frozen=True)
class _Products:
    """Products of columns over some rows, for each joint."""

    columns: Array  # (joints, c, c)
    torque: Array  # (joints, c)
    square: Array  # (joints,)
    about: Array  # (joints,) of the torque about its mean
    rows: Array  # (joints,)

    def rest(self, places: NDArray[np.int64], values: Array) -> Array:
        """Squares of residuals, by joint."""
        inside = self.columns[:, places[:, None], places]
        crossed = self.torque[:, places] @ values
        found = self.square - 2.0 * crossed + np.einsum("i,jik,k->j", values, inside, values)
        return np.asarray(np.maximum(found, 0.0))

    def shares(self, places: NDArray[np.int64], values: Array) -> Array:
        """RMS of residuals over that of torques about their means, by joint."""
        return np.sqrt(self.rest(places, values) / np.maximum(self.about, 1e-300))


def _products(equation: JointEquation, rows: slice) -> _Products:
    found: list[list[Array]] = []
    for j in range(equation.torque.shape[1]):
        good = equation.moving[rows, j]
        w, y = equation.matrix[rows, j][good], equation.torque[rows, j][good]
        about = np.sum((y - y.mean()) ** 2) if len(y) else 0.0
        found.append([w.T @ w, w.T @ y, y @ y, about, np.asarray(float(len(y)))])  # type: ignore[list-item]
    return _Products(*(np.array(part) for part in zip(*found, strict=True)))


def _solved(of: _Products, places: NDArray[np.int64], weights: Array) -> tuple[Array, Array, float]:
    """Values, inverse of the information, condition of the scaled columns."""
    matrix = np.einsum("j,jik->ik", weights, of.columns[:, places[:, None], places])
    right = weights @ of.torque[:, places]
    scale = np.sqrt(np.maximum(np.diag(matrix), 1e-300))
    with threadpool_limits(1):  # small matrices: threads only wait for each other
        s, v = np.linalg.eigh(matrix / np.outer(scale, scale))
    told = s > _NOTHING * s[-1]
    inverse = (v * np.where(told, 1.0 / np.where(told, s, 1.0), 0.0)) @ v.T / np.outer(scale, scale)
    lowest = max(float(s[0]), 1e-300)
    return inverse @ right, inverse, float(np.sqrt(s[-1] / lowest))


def _weighed(
    of: _Products, places: NDArray[np.int64], begin: Array | None = None
) -> tuple[Array, Array]:
    """Values and the deviations of each joint's residuals, each weighted by these.

    Weights begin with given deviations, which then are near enough to be taken once.
    """
    some = of.rows > 0
    sizes = np.sqrt(of.square / np.maximum(of.rows, 1.0)) if begin is None else begin
    values = np.zeros(len(places))
    least = 1e-9 * np.sqrt(of.square.max() / of.rows.max())
    for _ in range(_WEIGHINGS if begin is None else 1):
        weights = np.where(some, 1.0 / np.maximum(sizes, least) ** 2, 0.0)
        values, _, _ = _solved(of, places, weights)
        sizes = np.sqrt(of.rest(places, values) / np.maximum(of.rows, 1.0))
    return values, np.maximum(sizes, least)


# CCN 17: what may come, what counts of it, and what may go then, in one loop.
def choose(
    equation: JointEquation, keep: float, laws: Sequence[str] | None
) -> tuple[list[TriedLaw], TriedLaw]:
    """Try laws on the part kept back, and add the one that explains most while one does."""
    cut = int((1.0 - keep) * len(equation.time))
    early, late = _products(equation, slice(0, cut)), _products(equation, slice(cut, None))
    joints = range(equation.plant.count)

    _, sizes = _weighed(early, equation.chosen(()))

    def tried(taken: Laws) -> TriedLaw:
        places = equation.chosen(taken)
        values, _ = _weighed(early, places, sizes)
        return TriedLaw(taken, early.shares(places, values), late.shares(places, values))

    if laws is not None:
        only = tried(tuple((name, j) for name in laws for j in joints))
        return [only], only
    chosen = tried(())
    rows = [chosen]
    while True:
        looks = [
            tried((*chosen.laws, (name, j)))
            for name in LAWS
            for j in joints
            if (name, j) not in chosen.laws and late.rows[j] > 0
        ]
        gains = [
            float(look.kept[look.laws[-1][1]] / max(chosen.kept[look.laws[-1][1]], 1e-300))
            if look.kept.sum() <= chosen.kept.sum()
            else 1.0
            for look in looks
        ]
        if not looks or min(gains) >= _WORTH:
            return rows, chosen
        chosen = looks[int(np.argmin(gains))]
        rows.append(chosen)
        for law in chosen.laws[:-1]:  # what the new one explains as well goes
            look = tried(tuple(x for x in chosen.laws if x != law))
            if look.kept[law[1]] <= _IDLE * chosen.kept[law[1]]:
                chosen = look
                rows.append(look)
        _, sizes = _weighed(early, equation.chosen(chosen.laws))


def fit(equation: JointEquation, laws: Laws) -> TorqueFit:
    """Fit all of the record."""
    of = _products(equation, slice(None))
    places = equation.chosen(laws)
    values, sizes = _weighed(of, places)
    weights = np.where(of.rows > 0, 1.0 / sizes**2, 0.0)
    values, inverse, condition = _solved(of, places, weights)
    columns = equation.matrix[:, :, places]
    rest = (equation.torque - columns @ values) * equation.moving / sizes
    lag = _lag(rest, equation.moving)
    scores = np.einsum("njc,nj->nc", columns / sizes[:, None], rest)
    meat = _long_run(scores / (scale := np.sqrt(np.mean(scores**2, axis=0)) + 1e-300), lag)
    meat *= np.outer(scale, scale)
    free = max(float(of.rows.sum()) - len(places), 1.0)
    cover = (float(of.rows.sum()) / free) * inverse @ meat @ inverse
    # a sum of few products may come out too small by chance, never below that of white residuals
    more = np.sqrt(np.maximum(np.diag(inverse) / np.maximum(np.diag(cover), 1e-300), 1.0))
    return TorqueFit(places, values, cover * np.outer(more, more), sizes, condition, lag)


def _lag(rest: Array, moving: NDArray[np.bool_]) -> int:
    """Rows over which residuals are one another's: until the slowest has forgotten itself."""
    n = len(rest)
    most = max(1, int(_MOST * n))
    longest = 4
    for j in range(rest.shape[1]):
        if moving[:, j].any():
            gone = np.flatnonzero(np.abs(autocorrelation(rest[:, j], most)) < 2.0 / np.sqrt(n))
            longest = max(longest, int(gone[0]) if len(gone) else most)
    return min(longest, most)


def _long_run(scores: Array, lag: int) -> Array:
    """Sum of products of scores at all distances up to a lag, with Bartlett's weights."""
    found = scores.T @ scores
    for k in range(1, lag + 1):
        one = scores[k:].T @ scores[:-k]
        found = found + (1.0 - k / (lag + 1)) * (one + one.T)
    return np.asarray(found)


def enough(equation: JointEquation) -> bool:
    """Whether there are more rows than what is looked for."""
    return int(equation.moving.sum()) > _ROWS * equation.matrix.shape[2]
