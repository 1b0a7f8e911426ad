"""Whether the laws of a scenario are those that a record was made with.

Fed with what they saw by the record, the laws must show what the record has of them. Where gains of
another size do that far better, the record was made with those; the lag says how many
communication steps later than in the record a signal of the scenario shows the same.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.linear import law
from motionfmu.analysis.linear.law import Law
from motionfmu.identify.axis_loop import AxisLoop

Array = NDArray[np.float64]
# Other gains are taken if they leave less than this share of the difference, and are known to this
# share of themselves.
_BETTER, _KNOWN = 0.8, 0.02
_STEPS, _NUDGE = 3, 1e-3
# Times the longest period of a law by which a signal may show what the record has.
_LATEST = 2


@dataclass(frozen=True)
class ControllerCheck:
    """The laws beside the record."""

    signal: str  # that of a law which the record has
    lag: int  # communication steps by which the scenario's signal shows it later
    difference: float  # of record and law, norm over norm
    gains: Mapping[str, tuple[float, float]]  # as the scenario has them, and as the record says
    fitted: float  # difference with those gains
    taken: bool  # whether the gains of the record are taken


Shown = Callable[[AxisLoop], Array]


def gains_of(loop: AxisLoop, values: Mapping[str, Mapping[str, object]]) -> dict[str, float]:
    """Gains of the laws that show something compared, which are not 0; by component.variable."""
    found = {}
    for signal in loop.shown:
        component = signal.partition(".")[0]
        said = law.carried(loop.scenario.document.body.component[component])
        if isinstance(said, Law):
            for name in said.gain:
                value = float(values[component][name])  # type: ignore[arg-type]
                if value != 0.0:
                    found[f"{component}.{name}"] = value
    return found


def controller_check(
    of: tuple[AxisLoop, str, Array, int],
    shown: Shown,
    changed: Callable[[Mapping[str, float]], AxisLoop],
    gains: Mapping[str, float],
) -> ControllerCheck:
    """Hold a law against the record: loop, signal, what was measured and points between samples.

    `shown` gives the signal at all points, `changed` the loop with other gains.
    """
    loop, signal, measured, every = of
    lag, difference = _lag(shown(loop), measured, every, loop.laws.cycle)
    names = list(gains)
    factors = np.ones(len(names))
    deviations = np.full(len(names), np.inf)
    whole = float(np.linalg.norm(measured)) or 1.0
    fitted = difference

    def at(f: Array) -> Array:
        here = changed({n: gains[n] * x for n, x in zip(names, f, strict=True)})
        return _sampled(shown(here), measured, every, lag)[0]

    rows = _sampled(shown(loop), measured, every, lag)[1]
    for _ in range(_STEPS if names else 0):
        base = at(factors)
        slopes = np.column_stack(
            [(at(factors + _NUDGE * e) - base) / _NUDGE for e in np.eye(len(names))]
        )
        rest = rows - base
        step, _, rank, _ = np.linalg.lstsq(slopes, rest, rcond=1e-9)
        if rank < len(names):
            break
        left = rest - slopes @ step
        spread = np.linalg.inv(slopes.T @ slopes) * np.mean(left**2)
        if (factors + step <= 0.0).any():  # a record that tells nothing of the gains
            break
        factors, deviations = factors + step, np.sqrt(np.diag(spread))
        fitted = float(np.linalg.norm(rows - at(factors))) / whole
        if np.abs(step).max() < _NUDGE:
            break
    good = bool((factors > 0.0).all() and (deviations < _KNOWN).all())
    taken = good and fitted < _BETTER * difference
    told = {n: (gains[n], gains[n] * f) for n, f in zip(names, factors.tolist(), strict=True)}
    return ControllerCheck(signal, lag, difference, told, fitted, taken)


def _sampled(values: Array, measured: Array, every: int, lag: int) -> tuple[Array, Array]:
    """Values `lag` points behind each sample, and the samples that have them."""
    here = values[lag::every]
    n = min(len(here), len(measured))
    return here[:n], measured[:n]


def _lag(values: Array, measured: Array, every: int, cycle: int) -> tuple[int, float]:
    """The lag with the least difference, the shortest of equal ones, and that difference."""
    whole = float(np.linalg.norm(measured)) or 1.0
    best, least = 0, np.inf
    for lag in range(_LATEST * max(cycle, every) + 1):
        here, rows = _sampled(values, measured, every, lag)
        left = float(np.linalg.norm(here - rows)) / whole
        if left < least * (1.0 - 1e-6):
            best, least = lag, left
    return best, least
