"""How fast a recorded signal changes: for figures and checks."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.columns import forget
from motionfmu.scenarios.system import NS_TOLERANCE


def change(
    time: NDArray[Any], x: NDArray[Any], rate: float
) -> tuple[NDArray[Any], NDArray[np.float64]]:
    """Times [s] and (x(t) - x(t - rate)) / rate [1/s], from t = rate on.

    A row per sample, none if the run is shorter; the rate is a whole number of steps [s].
    """
    back = steps(time, rate)
    values = np.asarray(x, dtype=np.float64)
    return time[back:], (values[back:] - values[: len(values) - back]) / rate


def steps(time: NDArray[Any], rate: float) -> int:
    """Number of samples in the time `rate` [s]; all samples if the run is shorter."""
    return min(len(time), round(rate / (time[1] - time[0]))) if len(time) > 1 else len(time)


def reader(x: NDArray[Any], back: int, rate: float) -> Callable[[int, int], NDArray[np.float64]]:
    """A function that gives `change` of a range of samples, which count from t = rate on."""

    def read(first: int, last: int) -> NDArray[np.float64]:
        forget(x)
        old, new = x[first:last], x[first + back : last + back]
        return (new.astype(np.float64) - old[: len(new)].astype(np.float64)) / rate

    return read


def wrong(rate: float, step_ns: int, stop: float) -> str:
    """Why a rate [s] does not fit a run of such steps up to `stop` [s]; empty if it fits."""
    count = round(rate * 1e9 / step_ns)
    if count < 1 or abs(rate * 1e9 - count * step_ns) > NS_TOLERANCE:
        return f"rate = {rate!r} s is no whole number of steps of {step_ns * 1e-9:g} s"
    return f"rate = {rate!r} s is longer than the run" if rate >= stop else ""
