"""Poses of an arm over the ranges of its joints, and the worst of them."""

from collections.abc import Callable, Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
# A joint that turns for ever has no pose that it has not within this [deg].
TURN = 180.0
# The first axis of an arm is vertical: gravity and inertia are the same at all its angles.
UPRIGHT = 0
# Joints that change what the others move most: from straight to folded, and the hand's way.
FOLDING = (1, 2, 4)
# A search goes to either side by these shares of the ranges.
STEPS = (0.12, 0.06, 0.03, 0.015, 0.008)
MOVES = 5  # of one length, of a joint each


def ranges(low: Array, high: Array) -> Array:
    """Ends (2, 6) [deg] of the poses."""
    ends = np.array([np.maximum(low, -TURN), np.minimum(high, TURN)])
    ends[:, UPRIGHT] = np.clip(0.0, *ends[:, UPRIGHT])
    return ends


def spread(ends: Array, count: int) -> Array:
    """Poses (n, 6) [deg]: a Halton sequence, and the ends and middles of the joints that fold."""
    from scipy.stats import qmc  # a second to import, and `tune` of axes wants none

    drawn = qmc.Halton(d=len(ends[0]), scramble=False).random(count + 1)[1:]
    middle = ends.mean(axis=0)
    rows = []
    for shares in product((0.0, 0.5, 1.0), repeat=len(FOLDING)):
        pose = middle.copy()
        for k, share in zip(FOLDING, shares, strict=True):
            pose[k] = ends[0, k] + share * (ends[1, k] - ends[0, k])
        rows.append(pose)
    return np.vstack([ends[0] + drawn * (ends[1] - ends[0]), rows])


def climbed(
    start: Array, height: Callable[[Array], Array], ends: Array, steps: Sequence[float] = STEPS
) -> tuple[Array, float]:
    """A pose about a start where a height (n,) of poses (n, 6) is greatest, and that height."""
    pose, best = start.copy(), float(height(start[None])[0])
    movable = np.flatnonzero(ends[1] > ends[0])
    for share in steps:
        for _ in range(MOVES):
            around = np.repeat(pose[None], 2 * len(movable), axis=0)
            for row, k in enumerate(movable):
                step = share * (ends[1, k] - ends[0, k])
                around[2 * row : 2 * row + 2, k] += (step, -step)
            around = np.clip(around, *ends)
            found = height(around)
            if found.max() <= best:
                break
            pose, best = around[int(found.argmax())], float(found.max())
    return pose, best
