"""A gap that the plant's file has wrong: with which one the record would be explained better."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from motionfmu.identify.fit_notes import WIDER
from motionfmu.identify.free_parameters import FreeParameters
from motionfmu.identify.ground import Ground
from motionfmu.identify.shooting import Fitted, Guess
from motionfmu.identify.span_fit import misfit
from motionfmu.identify.spread import Spread

Array = NDArray[np.float64]
# Twice and half of the gap are looked at, at most so often; then between the best one's neighbours.
_DOUBLED, _BETWEEN = 3, 9
# Of what a fit leaves beyond noise, another gap leaves no more than this share.
_CLEARLY = 0.5


def doubted_gap(
    own: Ground,
    of: tuple[FreeParameters, Fitted, Spread | None],
    span: tuple[int, int],
    made: Callable[[dict[str, float]], Ground],
) -> tuple[Spread | None, tuple[str, ...]]:
    """Look for a gap that explains a span better; what is known of the others then, and why.

    `made` gives the ground with other values. Nothing changes where the plant names no gap.
    """
    free, fit, known = of
    name = own.known.gap
    left = misfit(own, fit, span) if known is not None and name and own.value(name) else 1.0
    if known is None or left <= WIDER:
        return known, ()
    given, full = own.value(name), own.set_name(f"{own.loop.component}.{name}")
    looked: dict[float, tuple[float, Array]] = {0.0: (left, fit.guess.free)}

    def leaves(octaves: float) -> float:
        """Misfit of the span, in times of noise, with a gap so many octaves wider."""
        if octaves not in looked:
            near = min(looked, key=lambda k: abs(k - octaves))
            there = made({full: given * 2.0**octaves})
            values = looked[near][1]
            problem, starts = there.shooting(there.free(free.names), span, values)
            found = problem.fit(Guess(values, starts))
            worse = misfit(there, found, span) if found.linear.sound else np.inf
            looked[octaves] = worse, found.guess.free
        return looked[octaves][0]

    best = min((-1.0, 0.0, 1.0), key=leaves)
    while best and abs(best) < _DOUBLED and leaves(best + np.sign(best)) < leaves(best):
        best += np.sign(best)
    ends = best - 1.0, best + 1.0
    minimize_scalar(leaves, bounds=ends, method="bounded", options={"maxiter": _BETWEEN})
    best = min(looked, key=leaves)
    if leaves(best) - 1.0 > _CLEARLY * (left - 1.0):
        return known, ()
    unit = next(d.unit for d in own.loop.ode.parameters if d.name == name)
    note = (
        f"The record contradicts {full} = {given:.3g} {unit}: the fit leaves {left:.3g} times the"
        f" noise, with {given * 2.0**best:.3g} {unit} only {leaves(best):.3g} times. Measure it"
        " anew, or give it with --set; deviations hold how far it moves the other values."
    )
    away = looked[best][1] - fit.guess.free
    return replace(known, deviations=np.hypot(known.deviations, away)), (note,)
