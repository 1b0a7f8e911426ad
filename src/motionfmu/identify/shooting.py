"""Closed-loop output error by multiple shooting.

The record is cut into pieces, each with a start of its own. What is asked is that outputs are those
of the record and that each piece begins where the one before it ends. Gauss-Newton: both are
linearised, the starts of all pieces but the first of a stretch are eliminated from end to end
(condensing), and what is left is a problem of least squares in the first states and the free
quantities. (Bock 1987; Albersmeyer and Diehl 2010.)
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from motionfmu.identify.loop_motion import LoopMotion, Moved, Pieces, PieceStart

Array = NDArray[np.float64]
# Most steps of Gauss-Newton, and the least share of one.
_STEPS, _SHORTEST = 15, 1.0 / 64.0
# It has ended when no quantity moves by more than this share of its standard deviation.
_SETTLED = 0.02
# Or when the sum of squares, in units of the residuals' variance, falls by less.
_FALLEN = 0.05
# A gap of this share of a state's range counts as much as a residual of one standard deviation.
_GAP = 1e-5
# The start of a stretch is known to this share of the state's range.
_START = 0.1
# The sizes of residuals count as found when they change by less than this share.
_SIZES, _ROUNDS = 0.05, 4
_TINY = 1e-12
# A slope above this is that of a motion that runs away.
_AWAY = 1e100
# Eigenvalues of the scaled information matrix below this share of the largest are none.
_NONE = 1e-13


@dataclass(frozen=True)
class Stretch:
    """What is fitted: pieces of the record, some of them joined, and what was measured there."""

    pieces: Pieces
    joined: NDArray[np.bool_]  # (pieces,) whether a piece goes on where the one before it ends
    driven: Array  # (points, n_driven) of the whole record
    measured: Array  # (samples of the pieces, n_compared)
    columns: NDArray[np.int64]  # of the outputs: which is compared with each measured one
    floor: Array  # (n_compared,) least size of a residual: what rounding leaves
    samples: NDArray[np.int64]  # which of the record the pieces have
    counted: NDArray[np.bool_]  # (samples of the pieces,) those whose residuals count

    @property
    def rows(self) -> NDArray[np.int64]:
        """Samples of the record whose residuals count."""
        return self.samples[self.counted]


@dataclass(frozen=True)
class Guess:
    """Values of the free quantities, and the starts of all pieces."""

    free: Array  # (n_free,)
    start: PieceStart


@dataclass(frozen=True)
class Linear:
    """The problem about a guess, with the gaps eliminated."""

    moved: Moved
    rest: Array  # (samples that count, n_compared) measured less simulated
    gaps: Array  # (pieces, n_z) end of the piece before less the start; 0 where nothing is joined
    ahead: Array  # (pieces, n_z) how far the starts move because of the gaps
    follow: Array  # (pieces, n_z, n_all) how they move with the unknowns
    slopes: Array  # (samples that count, n_compared, n_all) of the outputs to the unknowns
    shifted: Array  # (samples that count, n_compared) rest less what the gaps make of it

    @property
    def sound(self) -> bool:
        """Whether nothing in it runs away."""
        most = np.abs(self.slopes).max(initial=0.0)
        return bool(most < _AWAY and np.isfinite(self.rest).all() and np.isfinite(most))


@dataclass(frozen=True)
class Fitted:
    """What Gauss-Newton ended with."""

    guess: Guess
    linear: Linear
    sizes: Array  # (n_compared,) root mean square of each residual, by which they were weighed
    steps: int
    settled: bool
    prior: Array  # (n_all,) inverse standard deviation of what was known beforehand
    weights: Array  # (samples that count,) at most 1, by which squares of residuals count

    @property
    def first(self) -> int:
        """The first unknown that is a free quantity."""
        return len(self.prior) - len(self.guess.free)


Values = Callable[[Array], tuple[Array, Array, Array, Array]]


@dataclass(frozen=True)
class Shooting:
    """A motion, what it is fitted to, and how free quantities become parameters."""

    motion: LoopMotion
    stretch: Stretch
    values: Values
    bounds: tuple[Array, Array]
    ranges: Array  # (n_z,) how far each state goes in the record

    def linear(self, guess: Guess) -> Linear:
        """Move the pieces of a guess and eliminate the gaps."""
        stretch, width = self.stretch, self.motion.width
        moved = self.motion.run(
            guess.start, stretch.pieces, stretch.driven, self.values(guess.free)
        )
        rest = stretch.measured - moved.y[:, stretch.columns]
        begin = np.hstack([guess.start.x, guess.start.w])
        end = np.hstack([moved.end.x, moved.end.w])
        count, free = len(begin), len(guess.free)
        firsts = np.flatnonzero(~stretch.joined)
        total = width * len(firsts) + free
        gaps, ahead = np.zeros((count, width)), np.zeros((count, width))
        follow = np.zeros((count, width, total))
        for k in range(count):
            if not stretch.joined[k]:
                place = width * int(np.searchsorted(firsts, k))
                follow[k, :, place : place + width] = np.eye(width)
                continue
            into, by = moved.ends[k - 1, :, :width], moved.ends[k - 1, :, width:]
            gaps[k] = end[k - 1] - begin[k]
            ahead[k] = into @ ahead[k - 1] + gaps[k]
            follow[k] = into @ follow[k - 1]
            follow[k, :, total - free :] += by
        local = moved.slopes[:, stretch.columns, :]
        slopes = np.empty((*rest.shape, total))
        shifted = rest.copy()
        places = np.concatenate([[0], np.cumsum(stretch.pieces.samples)])
        for k in range(count):
            rows = slice(places[k], places[k + 1])
            slopes[rows] = local[rows, :, :width] @ follow[k]
            shifted[rows] -= local[rows, :, :width] @ ahead[k]
        slopes[:, :, total - free :] += local[:, :, width:]
        at = stretch.counted
        return Linear(moved, rest[at], gaps, ahead, follow, slopes[at], shifted[at])

    def fit(self, guess: Guess, sizes: Array | None = None) -> Fitted:
        """Fit, and weigh each measured signal by the residual that is left of it."""
        now = self.linear(guess)
        guess, now, found, (steps, settled) = self._settled(guess, now, sizes)
        prior = self.prior(now, len(guess.free))
        return Fitted(guess, now, found, steps, settled, prior, np.ones(len(now.rest)))

    def _settled(
        self, guess: Guess, now: Linear, sizes: Array | None
    ) -> tuple[Guess, Linear, Array, tuple[int, bool]]:
        """Gauss-Newton, again with the weights of what is left, unless they are given."""
        found = sizes if sizes is not None else self.sizes(now)
        steps, settled = 0, False
        for _ in range(1 if sizes is not None else _ROUNDS):
            guess, now, used, settled = self._gauss_newton(guess, now, found)
            steps += used
            before, found = found, found if sizes is not None else self.sizes(now)
            if np.abs(found / before - 1.0).max() < _SIZES:
                break
        return guess, now, found, (steps, settled)

    def sizes(self, now: Linear) -> Array:
        """Root mean square of each residual, by which it is weighed."""
        found: Array = np.sqrt(np.mean(now.rest**2, axis=0) + self.stretch.floor**2)
        return np.maximum(found, _TINY)

    def prior(self, now: Linear, free: int) -> Array:
        """Inverse standard deviation of what is known beforehand: the starts of stretches."""
        known = np.zeros(now.slopes.shape[2])
        starts = len(known) - free
        if starts:
            each = 1.0 / np.maximum(_START * self.ranges, _TINY)
            known[:starts] = np.tile(each, starts // len(each))
        return known

    def merit(self, guess: Guess, sizes: Array) -> float:
        """Sum of squares of residuals and gaps; not a number where a motion runs away."""
        stretch, start = self.stretch, guess.start
        values = self.values(guess.free)
        moved = self.motion.run(start, stretch.pieces, stretch.driven, values, bare=True)
        rest = (stretch.measured - moved.y[:, stretch.columns])[stretch.counted]
        ends = np.hstack([moved.end.x, moved.end.w])[:-1]
        gaps = np.where(stretch.joined[1:, None], ends - np.hstack([start.x, start.w])[1:], 0.0)
        return self._sum(rest, gaps, sizes)

    def _sum(self, rest: Array, gaps: Array, sizes: Array) -> float:
        held = gaps / np.maximum(_GAP * self.ranges, _TINY)
        return float(np.sum((rest / sizes) ** 2) + np.sum(np.square(held)))

    def _gauss_newton(
        self, guess: Guess, now: Linear, sizes: Array
    ) -> tuple[Guess, Linear, int, bool]:
        for step in range(_STEPS):
            change, deviations, _ = self.direction(guess, now, sizes)
            share, merit = 1.0, self._sum(now.rest, now.gaps, sizes)
            while True:
                tried = self.moved(guess, now, change, share)
                better = self.merit(tried, sizes)
                if (np.isfinite(better) and better < merit) or share <= _SHORTEST:
                    break
                share *= 0.5
            if not (np.isfinite(better) and better < merit * (1.0 + 1e-9)):
                return guess, now, step, True  # no way down is left
            moved = np.abs(tried.free - guess.free)
            guess, now = tried, self.linear(tried)
            fallen = merit - better < _FALLEN
            if fallen or (share == 1.0 and (moved <= _SETTLED * deviations).all()):
                return guess, now, step + 1, True
        return guess, now, _STEPS, False

    def direction(self, guess: Guess, now: Linear, sizes: Array) -> tuple[Array, Array, Array]:
        """Change of the unknowns; of the free ones deviations and covariance for white noise."""
        weighed = (now.slopes / sizes[:, None]).reshape(-1, now.slopes.shape[2])
        right = weighed.T @ (now.shifted / sizes).ravel()
        prior = self.prior(now, len(guess.free))
        matrix = weighed.T @ weighed + np.diag(prior**2)
        scale = np.sqrt(np.maximum(np.diag(matrix), _TINY**2))
        free = len(prior) - len(guess.free)
        low, high = self.bounds
        fixed, change = np.zeros(len(prior), dtype=bool), np.zeros(len(prior))
        if not np.isfinite(matrix).all():  # a motion that runs away tells no way
            n = len(guess.free)
            return change, np.full(n, np.inf), np.zeros((n, n))
        for _ in range(len(guess.free) + 1):
            left = np.flatnonzero(~fixed)
            b = (right - matrix[:, fixed] @ change[fixed])[left] / scale[left]
            values, vectors = np.linalg.eigh(
                matrix[np.ix_(left, left)] / np.outer(scale, scale)[np.ix_(left, left)]
            )
            good = values > _NONE * values[-1]
            inverse = vectors * np.where(good, 1.0 / np.where(good, values, 1.0), 0.0) @ vectors.T
            change[left] = inverse @ b / scale[left]
            there = guess.free + change[free:]
            out = ((there < low) | (there > high)) & ~fixed[free:]
            if not out.any():
                break
            change[free:] = np.where(out, np.clip(there, low, high) - guess.free, change[free:])
            fixed[free:] |= out
        deviations = np.zeros(len(prior))
        deviations[left] = np.sqrt(np.maximum(np.diag(inverse), 0.0)) / scale[left]
        cover = np.zeros_like(matrix)
        cover[np.ix_(left, left)] = inverse / np.outer(scale[left], scale[left])
        return change, deviations[free:], cover[free:, free:]

    def moved(self, guess: Guess, now: Linear, change: Array, share: float) -> Guess:
        """The guess moved by a share of a change of the unknowns."""
        starts = now.ahead + now.follow @ change
        n = guess.start.x.shape[1]
        x, w = guess.start.x + share * starts[:, :n], guess.start.w + share * starts[:, n:]
        free = guess.free + share * change[len(change) - len(guess.free) :]
        return replace(guess, free=np.clip(free, *self.bounds), start=PieceStart(x, w))
