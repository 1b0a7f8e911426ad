"""Start values of an identification, and which quantities a record can tell at all."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from motionfmu.identify.free_parameters import FreeParameters
from motionfmu.identify.ground import Ground
from motionfmu.identify.shooting import Fitted, Guess
from motionfmu.identify.spread import Spread, spread

Array = NDArray[np.float64]
# A quantity whose standard deviation is above this share of itself cannot be told by the record;
# one that makes less than the second share of the drive counts as that.
UNTOLD, _LITTLE = 0.3, 0.05
# From here on it says nothing of it.
_BLANK = 0.9
_NEVER = 1e-100
# Steps of least squares for start values.
_NEWTON = 6
# Directions of start values that inverse dynamics tell with less than this share of the clearest
# one stay as they are: the rest of a law at low speeds.
_CLEAR = 1e-3
# A quantity whose whole size makes less than this share of the drive leaves rounding alone there.
_ROUNDING = 1e-9


def start_values(own: Ground, free: FreeParameters) -> tuple[Array, Array]:
    """Values by inverse dynamics and least squares, and their deviations as for white noise."""
    values = np.clip(free.start, free.low, free.high)
    if not len(values) or own.still or len(own.points) < 10 * len(values):
        return values, np.full(len(values), np.inf)
    deviations = np.full(len(values), np.inf)
    sizes = np.where(free.start == 0.0, 1.0, np.abs(free.start))
    drive = float(np.linalg.norm(own.force[own.points]))
    for _ in range(_NEWTON):
        found = own.follow(free, values, own.points)
        rest = own.force[own.points] - found.drive
        with np.errstate(over="ignore"):  # values that run away are seen below
            lengths = np.linalg.norm(found.slopes, axis=0)
        heard = lengths * sizes > _ROUNDING * drive
        scale = np.where(heard, np.maximum(lengths, 1e-300), 1.0)
        u, s, v = np.linalg.svd(np.where(heard, found.slopes / scale, 0.0), full_matrices=False)
        inverse = np.where(s > _CLEAR * s[0], 1.0 / np.maximum(s, 1e-300), 0.0)
        step = v.T @ (inverse * (u.T @ rest)) / scale
        new = np.clip(values + step, free.low, free.high)
        deviations = np.sqrt(np.sum((v.T * inverse) ** 2, axis=1) * np.mean(rest**2)) / scale
        deviations[~heard] = np.inf
        moved, values = np.abs(new - values), new
        if (moved <= 1e-6 * deviations).all():
            break
    good = np.isfinite(values) & (np.abs(values) > 0.05 * np.abs(free.start))
    return np.where(good | (free.start == 0.0), values, free.start), deviations


def quantity_sizes(own: Ground, free: FreeParameters, values: Array) -> Array:
    """What counts as the size of each quantity: itself, or what the scenario believes of it.

    Where that is 0, what makes a little of the drive, but no more than its limit.
    """
    sizes = np.maximum(np.abs(values), np.abs(free.start))
    if not len(values) or not len(own.points):
        return np.maximum(sizes, _NEVER)
    slopes = own.follow(free, values, own.points).slopes
    drive = float(np.sqrt(np.mean(own.force[own.points] ** 2)))
    share = np.maximum(np.sqrt(np.mean(slopes**2, axis=0)), _NEVER)
    most = np.where(np.isfinite(free.high), np.abs(free.high), np.inf)
    little = np.minimum(_LITTLE * drive / share, most)
    return np.asarray(np.where(free.start == 0.0, np.maximum(sizes, little), sizes))


def tellable(own: Ground, names: Sequence[str]) -> tuple[list[str], dict[str, str]]:
    """Names that the record can tell at all, and why not of the others.

    By the information matrix of the closed loop about the start values: its slopes are those of a
    simulated motion, so noise of the record is no news. Each is believed beforehand to within its
    size, so one that acts as another one does is not told because that one is left alone.
    """
    if own.still:
        return [], dict.fromkeys(names, "the axis does not move")
    if not names:
        return [], {}
    free = own.free(names)
    for values in (start_values(own, free)[0], free.start):
        problem, starts = own.shooting(free, (own.first, own.data.samples - 1), values)
        now = problem.linear(Guess(values, starts))
        if now.sound:
            break
    else:
        return [], dict.fromkeys(names, "no motion of the plant is near the record")
    sizes = np.sqrt(np.mean(now.rest**2, axis=0) + problem.stretch.floor**2)
    prior = problem.prior(now, len(values))
    fit = Fitted(Guess(values, starts), now, sizes, 0, False, prior, np.ones(len(now.rest)))
    size = quantity_sizes(own, free, values)
    known = spread(fit).information * np.outer(size, size) + np.eye(len(size))
    share = np.sqrt(np.diag(np.linalg.inv(known)))
    rows = list(zip(names, share.tolist(), strict=True))
    return [n for n, s in rows if s <= UNTOLD], {n: reason(s) for n, s in rows if s > UNTOLD}


def scattered(
    own: Ground, free: FreeParameters, fit: Fitted, known: Spread | None
) -> dict[str, str]:
    """The quantity that is told worst, with why, if parts of the record tell it too differently."""
    if known is None:
        return {}
    share = known.deviations / np.maximum(quantity_sizes(own, free, fit.guess.free), 1e-100)
    worst = int(np.argmax(share))
    return {free.names[worst]: reason(float(share[worst]))} if share[worst] > UNTOLD else {}


def reason(share: float) -> str:
    """Why a quantity of this deviation, as a share of its size, is not told."""
    if share > _BLANK:
        return "the record says nothing of it, or nothing that another quantity would not"
    return f"its standard deviation is {100.0 * share:.0f} % of its size"
