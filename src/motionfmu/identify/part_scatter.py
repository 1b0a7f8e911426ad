"""How far fits of parts of a record lie apart.

Where contact opens and closes, the sum of squares has many small hollows, and its curvature in one
of them says nothing of where the next one lies. What parts of the record find for themselves does.
"""

import itertools

import numpy as np
from numpy.typing import NDArray

from motionfmu.identify.free_parameters import FreeParameters
from motionfmu.identify.ground import Ground
from motionfmu.identify.shooting import Fitted, Guess
from motionfmu.identify.spread import spread

Array = NDArray[np.float64]
# Parts of a record, and the fewest samples of one.
_PARTS, _FEWEST = 6, 400
# Share of a quantity to which contact is integrated: on machines with backlash fits without noise
# are 0.01 to 0.1 % off, and no residual shows it.
_CONTACT = 1e-3


def part_scatter(own: Ground, free: FreeParameters, fit: Fitted, span: tuple[int, int]) -> Array:
    """Standard deviations of what a fit found, by what parts of its record find; (free,).

    At least what the integration of contact leaves; that alone where the record is too short.
    """
    begin, end = span
    found = fit.guess.free
    parts = min(_PARTS, (end - begin) // _FEWEST)
    least = _CONTACT * np.abs(found)
    if parts < 2 or not len(found):
        return least
    cuts = np.linspace(begin, end, parts + 1).astype(int).tolist()
    n = len(found)
    whole, products = np.zeros((n, n)), np.zeros((n, n))
    for one in itertools.pairwise(cuts):
        problem, starts = own.shooting(free, one, found)
        if len(problem.stretch.rows) < _FEWEST // 2:
            continue
        there = problem.fit(Guess(found, starts), fit.sizes)
        if there.linear.sound:
            # a part counts as much as it tells
            known = spread(there).information
            moved = known @ (there.guess.free - found)
            if np.isfinite(known).all() and np.isfinite(moved).all():
                whole, products = whole + known, products + np.outer(moved, moved)
    size = np.sqrt(np.maximum(np.diag(whole), 1e-300))
    inverse = np.linalg.pinv(whole / np.outer(size, size), hermitian=True) / np.outer(size, size)
    scatter = np.sqrt(np.maximum(np.diag(inverse @ products @ inverse), 0.0))
    return np.asarray(np.fmax(scatter, least))
