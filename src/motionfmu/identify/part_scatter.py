"""How far fits of parts of a record lie apart.

What a model leaves out acts differently in each part, and where contact opens and closes, the sum
of squares has many small hollows, of which each part finds its own. The curvature of the sum and
the residuals at its end say nothing of that; what parts of the record find for themselves does.
"""

import itertools

import numpy as np
from numpy.typing import NDArray

from motionfmu.identify.free_parameters import FreeParameters
from motionfmu.identify.ground import Ground
from motionfmu.identify.shooting import Fitted, Guess

Array = NDArray[np.float64]
# Parts of a record, and the fewest samples of one.
_PARTS, _FEWEST = 6, 400


def part_scatter(own: Ground, free: FreeParameters, fit: Fitted, span: tuple[int, int]) -> Array:
    """Standard deviations of what a fit found, by what parts of its record find; (free,).

    0 where the record is too short for parts.
    """
    begin, end = span
    found = fit.guess.free
    parts = min(_PARTS, (end - begin) // _FEWEST)
    if parts < 2 or not len(found):
        return np.zeros(len(found))
    cuts = np.linspace(begin, end, parts + 1).astype(int).tolist()
    away = []
    for one in itertools.pairwise(cuts):
        problem, starts = own.shooting(free, one, found)
        if len(problem.stretch.rows) < _FEWEST // 2:
            continue
        there = problem.fit(Guess(found, starts), fit.sizes)
        if there.linear.sound:
            away.append(there.guess.free - found)
    if len(away) < 2:
        return np.full(len(found), np.inf)
    return np.asarray(np.sqrt(np.mean(np.square(away), axis=0) / len(away)))
