"""Figures of an answer to a step."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
LOW, HIGH = 0.1, 0.9  # shares of the step between which it rises
BAND = 0.02  # share of the step within which it has settled


@dataclass(frozen=True)
class StepFigures:
    """How an output answers a step.

    Attributes
    ----------
    rise : float
        From 10 % to 90 % of the step [s]; infinite if it does not come that far.
    overshoot : float
        Largest value beyond the step, as a share of it; 0 if there is none.
    settling : float
        From the step until it stays within 2 % of it [s]; infinite if it does not.
    """

    rise: float
    overshoot: float
    settling: float

    def numbers(self) -> dict[str, float | None]:
        """The same for JSON; what is infinite is None."""
        found = {"rise": self.rise, "overshoot": self.overshoot, "settling": self.settling}
        return {k: v if math.isfinite(v) else None for k, v in found.items()}


def step_figures(time: Array, values: Array, size: float = 1.0) -> StepFigures:
    """Rise time, overshoot and settling time of an answer.

    Parameters
    ----------
    time : ndarray, shape (n,)
        Since the step [s], increasing.
    values : ndarray, shape (n,)
        Output less its value before the step, in any unit. Between two samples it is straight.
    size : float
        Value that it is to reach, in the same unit.

    Returns
    -------
    StepFigures

    Raises
    ------
    ValueError
        The size is 0, or there are fewer than two samples.
    """
    if not size or len(time) < 2:
        raise ValueError(f"a step of {size:g} with {len(time)} samples has no figures")
    share = np.asarray(values, float) / size
    ends = [_first(time, share, level) for level in (LOW, HIGH)]
    rise = ends[1] - ends[0] if math.isfinite(ends[1]) else math.inf
    return StepFigures(rise, max(0.0, float(share.max()) - 1.0), _settled(time, share))


def _first(time: Array, share: Array, level: float) -> float:
    """When a level is first reached."""
    above = share >= level
    if not above.any():
        return math.inf
    k = int(np.argmax(above))
    return float(time[0]) if k == 0 else _crossing(time, share, k - 1, level)


def _settled(time: Array, share: Array) -> float:
    """When the band is entered for good."""
    outside = np.flatnonzero(np.abs(share - 1.0) > BAND)
    if not len(outside):
        return float(time[0])
    k = int(outside[-1])
    if k == len(share) - 1:
        return math.inf
    return _crossing(time, share, k, 1.0 + BAND if share[k] > 1.0 else 1.0 - BAND)


def _crossing(time: Array, share: Array, k: int, level: float) -> float:
    """When a level is passed between sample k and the next."""
    part = (level - share[k]) / (share[k + 1] - share[k])
    return float(time[k] + part * (time[k + 1] - time[k]))
