"""The law of friction that explains best what was kept back of a record."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError, suggestion
from motionfmu.identify.free_parameters import FreeParameters, carried, checked
from motionfmu.identify.ground import Ground, IdentifyOptions
from motionfmu.identify.shooting import Fitted, Guess
from motionfmu.identify.span_fit import errors_of, fitted_span
from motionfmu.identify.spread import Spread
from motionfmu.run import Scenario

Array = NDArray[np.float64]
# A law must explain what was kept back so much better to be taken.
WORTH = 0.98
# What says how much of a law there is must be so many deviations from nothing.
CERTAIN = 3.0
Progress = Callable[[str, float], None]


@dataclass(frozen=True)
class Validation:
    """How well values found on one part explain the part kept back."""

    laws: tuple[str, ...]
    other: Mapping[str, Any]
    fitted: Mapping[str, float]  # norm of the difference over norm, by signal, on the part fitted
    kept: Mapping[str, float]  # on the part kept back
    score: float  # what the choice goes by: kept-back residuals over those of the first law
    values: Mapping[str, float]  # of the free quantities, from the part fitted
    sizes: Mapping[str, float]  # root mean square of each signal about its mean, kept back
    idle: tuple[str, ...] = ()  # laws whose quantities may as well be nothing


def free_names(own: Ground, options: IdentifyOptions) -> list[str]:
    """Quantities that are free in every law."""
    loop = own.loop
    names = list(own.known.free) if options.free is None else list(options.free)
    fixed = checked(loop.ode, options.fix, loop.wired, "fix")
    return [n for n in dict.fromkeys(names) if n not in fixed]


def extended(
    own: Ground, names: Sequence[str], laws: Sequence[str], options: IdentifyOptions
) -> list[str]:
    """Quantities that are free with extensions of the law."""
    for law in laws:
        if law not in own.known.law:
            known = ", ".join(own.known.law) or "none"
            told = suggestion(law, own.known.law) or f"; there are: {known}"
            raise InputError(f"--law {law}: {own.loop.fmu} has no such law of friction{told}")
    if not names:
        return []
    more = [n for law in laws for n in own.known.law[law].free]
    wired = {d.name for k, d in enumerate(own.loop.ode.inputs) if k in own.loop.wired}
    return [n for n in dict.fromkeys([*names, *more]) if n not in wired and n not in options.fix]


def others(scenario: Scenario, own: Ground, given: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """Values of other parameters that are tried, one after the other: what nobody has said."""
    for component, fmu in scenario.document.body.component.items():
        values = own.loop.values.get(component)
        for name, choices in carried(fmu).other.items():
            if values is None or name in values.given or f"{component}.{name}" in given:
                continue
            for value in choices:
                if value != values[name]:
                    yield {f"{component}.{name}": value}


def validated(
    own: Ground,
    asked: tuple[Sequence[str], Sequence[str]],
    options: IdentifyOptions,
    before: "tuple[Validation, Validation] | None",
) -> Validation:
    """Fit the first part of the record and try what was found on the part kept back.

    `before` are the first look, by which it is scored, and the one from whose values it begins.
    """
    names, laws = asked
    first, near = (before[0], before[1].values) if before else (None, {})
    low, high = own.first, own.data.samples - 1
    rows = own.stretch(low, high)[0].rows
    cut = int(rows[int((1.0 - options.keep) * len(rows))])
    free, fit, known, _ = fitted_span(own, extended(own, names, laws, options), (low, cut), near)
    p, u, _, _ = free.values(fit.guess.free)
    fixed = own.fixed(p, u)
    problem, starts = own.shooting(fixed, (cut, high), fixed.start)
    kept = problem.fit(Guess(fixed.start, starts), fit.sizes)
    here, _ = errors_of(own, fit, (low, cut))
    there, sizes = errors_of(own, kept, (cut, high))
    score = 1.0
    if first is not None:
        ratios = [there[n] / max(first.kept[n], 1e-12) for n in own.data.compared]
        score = first.score * float(np.mean(ratios))
    found = dict(zip(free.names, fit.guess.free.tolist(), strict=True))
    nothing = idle_laws(own, laws, (free, fit, known))
    return Validation(tuple(laws), dict(own.other), here, there, score, found, sizes, nothing)


def idle_laws(
    own: Ground, laws: Sequence[str], of: tuple[FreeParameters, Fitted, Spread | None]
) -> tuple[str, ...]:
    """Extensions that are not there: a quantity is not told, or the first one may be nothing.

    Each law's first quantity says how much of it there is, and is nothing at 0.
    """
    free, fit, known = of
    found = []
    for law in laws:
        names = own.known.law[law].free
        if known is None or not set(names) <= set(free.names):
            found.append(law)
            continue
        k = free.names.index(names[0])
        if abs(float(fit.guess.free[k])) < CERTAIN * known.deviations[k]:
            found.append(law)
    return tuple(found)


def chosen_law(
    own: Ground,
    asked: tuple[Sequence[str], IdentifyOptions],
    so_far: tuple[list[Validation], Validation],
    progress: Progress,
) -> Validation:
    """Add the extension that explains most of what was kept back, while one does."""
    (names, options), (tried, chosen) = asked, so_far
    first = tried[0]
    left = [n for n in own.known.law if n not in chosen.laws]
    rounds = 0
    while left:
        progress("friction law", 0.3 + 0.1 * min(rounds, 3))
        before = first, chosen
        looks = [validated(own, (names, (*chosen.laws, n)), options, before) for n in left]
        tried += looks
        best = min((v for v in looks if not v.idle), key=lambda v: v.score, default=chosen)
        if best.score >= WORTH * chosen.score:
            break
        chosen = best
        left = [n for n in left if n not in chosen.laws]
        rounds += 1
    return chosen
