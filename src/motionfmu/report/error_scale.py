"""How an error is drawn beside a path: how large, in which colours, and what goes beyond them."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.report.numbers import round_down

# Where the largest error is more than so many times the one below which 95 % are, there are
# outliers; colours end at so many times that one.
FAR, BEYOND = 2.0, 1.5
# At the chosen magnification the usual error, and the one where colours end, are these parts of
# the path's size.
SHARE_USUAL = 0.05
SHARE_LARGEST = 0.2
# That one stays below this part of the way between two corners: details stay apart.
SHARE_REACH = 0.5


def scale_end(errors: tuple[float, float]) -> float:
    """Where the colours end, from the error's 95th percentile and its maximum [mm]."""
    usual, largest = errors
    return BEYOND * usual if 0.0 < FAR * usual < largest else largest


def within(gap: NDArray[Any], end: float) -> NDArray[Any]:
    """Errors (n, k) as vectors, those of outliers no longer than the colours reach [mm]."""
    size = np.linalg.norm(gap, axis=-1, keepdims=True)
    shorter = np.divide(end, size, out=np.ones_like(size), where=size > end)
    return np.asarray(gap * shorter)


def magnification(errors: tuple[float, float], size: float, reach: float) -> float:
    """Round magnification that makes an error easy to see.

    From the error's 95th percentile and maximum, the size of the path, and the mean way between two
    corners [mm]; 1 where nothing has to be magnified.
    """
    usual, end = errors[0], scale_end(errors)
    if end <= 0.0 or size <= 0.0:
        return 1.0
    wanted = min(SHARE_LARGEST * size, SHARE_REACH * reach) / end
    if usual > 0.0:
        wanted = min(wanted, SHARE_USUAL * size / usual)
    return max(1.0, round_down(wanted))
