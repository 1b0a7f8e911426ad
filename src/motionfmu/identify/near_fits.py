"""Fits that begin beside another one: the best of them, and how far they lie apart.

Where contact opens and closes, the sum of squares has many small hollows, and its curvature in one
of them says nothing of where the next one lies. What fits that begin around it find does.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from motionfmu.identify.contact_shooting import ContactShooting
from motionfmu.identify.free_parameters import FreeParameters
from motionfmu.identify.ground import Ground
from motionfmu.identify.shooting import Fitted, Guess
from motionfmu.identify.spread import Spread, spread

Array = NDArray[np.float64]
# How many fits, and how far beside the first one they begin, as a share of the drive.
_FITS, _BESIDE = 4, 3e-3
# What rounding in the drive does to passages through a gap, as a share of the drive; no residual
# shows it.
_ROUNDED = 1e-4


def near_fits(
    own: Ground, free: FreeParameters, fit: Fitted, span: tuple[int, int]
) -> tuple[Fitted, Spread]:
    """The best fit around one, and what is known of it."""
    problem, _ = own.shooting(free, span, fit.guess.free)
    assert isinstance(problem, ContactShooting)
    every = [fit]
    for k in range(_FITS):
        # all quantities at once, with other signs each time
        signs = np.array([(-1) ** ((q & (k + 1)).bit_count() + k) for q in range(len(free.names))])
        begun = np.clip(fit.guess.free + signs * _BESIDE * problem.reach, free.low, free.high)
        there = problem.fit(Guess(begun, fit.guess.start))
        if there.linear.sound:
            every.append(there)
    losses = [problem.loss(f, fit.sizes) for f in every]
    best = every.pop(int(np.argmin(losses)))
    known = spread(best)
    away = np.array([f.guess.free - best.guess.free for f in every])
    scatter = np.sqrt(np.mean(away**2, axis=0)) if every else np.zeros(len(free.names))
    least = _ROUNDED * own.reach(free, best.guess.free)
    deviations = np.hypot(np.fmax(known.deviations, scatter), least)
    return best, replace(known, deviations=deviations)
