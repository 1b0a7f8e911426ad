"""The fit of a plant whose parts move across a gap.

Contact opens and closes between samples, so the sum of squares has many small hollows, and its
slope at a point is that of a hollow, not of the way down. So slopes are taken across many hollows:
by motions beside a guess, far apart at first and nearer each time that less is gained, on both
sides in the end (implicit filtering; Kelley 2011). Motions are joined end to end.

On which side of its gap a table lies after a slow reversal may be decided by less than a count of
the encoder. Such a passage is no news of a parameter: a time in which the motion is another than
the recorded one counts by the logarithm of its squares (Huber and Ronchetti 2009).
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from motionfmu.identify.shooting import Fitted, Guess, Linear, Shooting

Array = NDArray[np.float64]
# How far apart the motions are from which slopes are taken, as a share of the drive: at first, and
# in the end.
_FIRST, _LAST = 0.03, 3e-4
# They come so many times nearer when a step gains less than this share, at most so many times
# nearer, and are no farther apart than `_NEARER` times the step.
_NEARER, _GAINED, _MOST = 3.0, 0.01, 10.0
# It has ended when the loss falls by less than this share, or no quantity would move by more than
# this share of its standard deviation.
_FALLEN, _SETTLED = 5e-4, 0.1
# Most steps, and shares of one that are tried.
_STEPS, _SHARES = 40, (1.0, 0.5, 0.25, 0.125)
# So many times the usual squares are those of another motion than the recorded one.
_STRANGE = 4.0


@dataclass(frozen=True)
class ContactShooting(Shooting):
    """A problem of shooting whose slopes are taken across many hollows."""

    reach: Array  # (n_free,) change that is as much as all of the drive, or as much as may be
    window: int  # samples of the time in which a motion is held to be another one

    def fit(self, guess: Guess, sizes: Array | None = None) -> Fitted:
        """Fit; each measured signal is weighed by what is usually left of it."""
        exact = self.linear(guess)
        guess, rest = self._joined(guess)
        if not (exact.sound and np.isfinite(rest).all()):
            unsound = replace(exact, rest=np.full_like(exact.rest, np.nan))
            return self._found(guess, unsound, 0, False)
        apart, last = _FIRST * self.reach, False
        now = self._across(guess, replace(exact, rest=rest), (apart, last))
        for step in range(_STEPS):
            usual = self._usual(now.rest) if sizes is None else sizes
            strange = self._strange(now.rest, usual)
            change, deviations, _ = self.direction(guess, _weighed(now, _weights(strange)), usual)
            least = np.maximum(deviations, _LAST * self.reach)
            asked = np.abs(change[len(change) - len(guess.free) :])
            if last and (asked <= _SETTLED * deviations).all():
                return self._found(guess, now, step, True)
            merit = float(_loss(strange).sum())
            tried, rest, better = self._stepped(guess, now, change, (usual, merit))
            gained, moved = merit - better, np.abs(tried.free - guess.free)
            if gained > 0.0:
                guess = tried
                now = replace(now, rest=rest, shifted=rest, ahead=np.zeros_like(now.ahead))
            if last and gained < _FALLEN * merit:
                return self._found(guess, now, step + 1, True)
            if last and gained > 0.0 and (moved <= apart).all():
                continue  # its slopes are those of here, too
            factor = 1.0 if gained > _GAINED * merit else 1.0 / _NEARER
            if gained > 0.0:
                factor = min(factor, _NEARER * float((moved / apart).max(initial=0.0)))
            apart = np.clip(max(factor, 1.0 / _MOST) * apart, least, _FIRST * self.reach)
            last = bool((apart <= 1.01 * least).all())
            now = self._across(guess, now, (apart, last))
        return self._found(guess, now, _STEPS, False)

    def loss(self, fit: Fitted, usual: Array) -> float:
        """What a fit leaves, for residuals of usual sizes."""
        return float(_loss(self._strange(fit.linear.rest, usual)).sum())

    def _stepped(
        self, guess: Guess, now: Linear, change: Array, of: tuple[Array, float]
    ) -> tuple[Guess, Array, float]:
        """The largest share of a change with a smaller loss, what it leaves, and its loss."""
        usual, merit = of
        for share in _SHARES:
            tried, rest = self._joined(self.moved(guess, now, change, share))
            better = float(np.nan_to_num(_loss(self._strange(rest, usual)).sum(), nan=np.inf))
            if better < merit:
                break
        return tried, rest, better

    def _found(self, guess: Guess, now: Linear, steps: int, settled: bool) -> Fitted:
        weights = np.ones(len(now.rest))
        if now.sound:
            weights = _weights(self._strange(now.rest, self._usual(now.rest)))
        found = self.sizes(replace(now, rest=now.rest * np.sqrt(weights)[:, None]))
        return Fitted(guess, now, found, steps, settled, self.prior(now, len(guess.free)), weights)

    def _joined(self, guess: Guess) -> tuple[Guess, Array]:
        """The guess with pieces that begin where the one before ends, and what is left."""
        p, u, _, _ = self.values(guess.free)
        stretch = self.stretch
        start, y = self.motion.chained(
            guess.start, stretch.pieces, stretch.driven, (p, u), stretch.joined
        )
        rest = (stretch.measured - y[:, stretch.columns])[stretch.counted]
        return replace(guess, start=start), rest

    def _across(self, guess: Guess, now: Linear, of: tuple[Array, bool]) -> Linear:
        """The problem with new slopes to what is free, by a motion on one side or on both.

        Those to starts stay what they are.
        """
        apart, both = of
        slopes = now.slopes.copy()
        first = slopes.shape[2] - len(apart)
        for k, far in enumerate(apart):
            low, high = (b[k] for b in self.bounds)
            end = min(guess.free[k] + far, high)
            begin = max(guess.free[k] - far, low)
            if both or end == guess.free[k]:
                rest = self._beside(guess, k, begin)
            else:
                begin, rest = guess.free[k], now.rest
            slopes[:, :, first + k] = (rest - self._beside(guess, k, end)) / (end - begin)
        return replace(now, shifted=now.rest, slopes=slopes)

    def _beside(self, guess: Guess, k: int, value: float) -> Array:
        """What is left with another value of one quantity."""
        free = guess.free.copy()
        free[k] = value
        return self._joined(replace(guess, free=free))[1]

    def _usual(self, rest: Array) -> Array:
        """Root mean square of residuals in half of the record, by signal."""
        return np.asarray(np.sqrt(np.median(self._squares(rest), axis=0) + self.stretch.floor**2))

    def _strange(self, rest: Array, usual: Array) -> Array:
        """Squares about each sample over the usual ones, mean of all signals."""
        return np.asarray(np.mean(self._squares(rest / usual), axis=1))

    def _squares(self, rest: Array) -> Array:
        """Mean squares in the window about each sample."""
        one = np.ones(min(self.window, len(rest)))
        count = np.convolve(np.ones(len(rest)), one, "same")
        return np.column_stack([np.convolve(c**2, one, "same") / count for c in rest.T])


def _loss(strange: Array) -> Array:
    """What squares count: in full up to the strange ones, from there on their logarithm."""
    above = np.maximum(strange / _STRANGE, 1.0)
    return np.where(strange > _STRANGE, _STRANGE * (1.0 + np.log(above)), strange)


def _weights(strange: Array) -> Array:
    """Slope of the loss."""
    return np.minimum(1.0, _STRANGE / np.maximum(strange, _STRANGE))


def _weighed(now: Linear, weights: Array) -> Linear:
    root = np.sqrt(weights)[:, None]
    return replace(
        now, rest=now.rest * root, shifted=now.shifted * root, slopes=now.slopes * root[:, :, None]
    )
