"""The fit of a span of samples, and how far it is from what was measured there."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from motionfmu.identify.free_parameters import FreeParameters
from motionfmu.identify.ground import Ground
from motionfmu.identify.shooting import Fitted, Guess
from motionfmu.identify.spread import Spread, spread
from motionfmu.identify.tellable import UNTOLD, quantity_sizes, reason, start_values

Array = NDArray[np.float64]
# Name under which the difference of command and position is told.
FOLLOWING = "following error"
# Share of a signal below which nobody asks for more, noise or not.
_ENOUGH = 0.01
# Median of the size of a normal deviate, and that of fourth differences of white noise.
_MEDIAN, _FOURTH = 0.6745, np.sqrt(70.0)


def fitted_span(
    own: Ground,
    names: Sequence[str],
    span: tuple[int, int],
    near: Mapping[str, float],
) -> tuple[FreeParameters, Fitted, Spread | None, dict[str, str]]:
    """Fit a span of samples; quantities that it cannot tell are fixed one after the other.

    `near` are values found before, from which those quantities begin.
    """
    left = list(names)
    why: dict[str, str] = {}
    while True:
        free = own.free(left)
        values = start_values(own, free)[0]
        values = np.array([near.get(n, v) for n, v in zip(left, values.tolist(), strict=True)])
        problem, starts = own.shooting(free, span, values)
        fit = problem.fit(Guess(values, starts))
        if not left:
            return free, fit, None, why
        if not fit.linear.sound:  # extensions of the law stand last
            why[left.pop()] = "no motion of the plant is near the record with it"
            continue
        known = spread(fit)
        share = known.deviations / np.maximum(quantity_sizes(own, free, fit.guess.free), 1e-100)
        worst = int(np.argmax(np.where(np.isfinite(share), share, np.inf)))
        if share[worst] <= UNTOLD:
            return free, fit, known, why
        why[left[worst]] = reason(float(share[worst]))
        left.pop(worst)


def stretch_signals(own: Ground, fit: Fitted, span: tuple[int, int]) -> tuple[Array, Array]:
    """Signals of the record and of a fit."""
    stretch = own.stretch(*span)[0]
    measured = stretch.measured[stretch.counted]
    return measured, measured - fit.linear.rest


def errors_of(
    own: Ground, fit: Fitted, span: tuple[int, int]
) -> tuple[dict[str, float], dict[str, float]]:
    """Norm of the difference over that of the signal about its mean, and root mean square of that.

    By signal, and of the following error [m or rad; signal's unit in the second]. Samples count as
    they did in the fit.
    """
    weights = fit.weights
    measured, simulated = stretch_signals(own, fit, span)
    rows = {n: (measured[:, k], simulated[:, k], 1.0) for k, n in enumerate(own.data.compared)}
    error = following(own, (measured, simulated), own.stretch(*span)[0].rows)
    if error is not None:
        per = own.ratios[f"{own.loop.component}.{own.rates.outputs[own.position]}"]
        rows[FOLLOWING] = *error, abs(per)
    shares, sizes = {}, {}
    for name, (a, b, per) in rows.items():
        size = float(np.std(a))
        shares[name] = float(np.sqrt(np.mean(weights * (a - b) ** 2))) / max(size, 1e-300)
        sizes[name] = per * size
    return shares, sizes


def misfit(own: Ground, fit: Fitted, span: tuple[int, int]) -> float:
    """How many times what noise leaves a fit leaves, of the signal that it explains worst; >= 1.

    A position is judged by the following error: of itself it always leaves little.
    """
    shares, sizes = errors_of(own, fit, span)
    position = f"{own.loop.component}.{own.rates.outputs[own.position]}"
    most = 1.0
    for name, left in shares.items():
        if name != position or FOLLOWING not in shares:
            column = position if name == FOLLOWING else name
            noise = _noise(own.data.measured[:, own.data.compared.index(column)])
            most = max(most, left / max(noise / max(sizes[name], 1e-300), _ENOUGH))
    return most


def _noise(signal: Array) -> float:
    """Standard deviation of the white noise in a signal, which impacts do not count for."""
    return float(np.median(np.abs(np.diff(signal, 4)))) / _MEDIAN / float(_FOURTH)


def following(
    own: Ground, signals: tuple[Array, Array], rows: NDArray[np.int64]
) -> tuple[Array, Array] | None:
    """Following errors [m or rad] at samples, where a command of the position is recorded."""
    name = f"{own.loop.component}.{own.rates.outputs[own.position]}"
    command = next((n for n in own.loop.driven if n in own.ratios), None)
    if command is None or name not in own.data.compared:
        return None
    wanted = own.data.driven[:: own.data.every, own.loop.driven.index(command)]
    wanted = wanted[rows] / own.ratios[command]
    k = own.data.compared.index(name)
    return tuple(wanted - s[:, k] / own.ratios[name] for s in signals)  # type: ignore[return-value]
