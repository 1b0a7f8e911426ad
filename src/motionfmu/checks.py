"""Verdicts: bounds of signals and contour figures."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.scenario import Check


@dataclass(frozen=True)
class Verdict:
    """One bound of a ``[check]`` line and what was found.

    Attributes
    ----------
    name : str
        Signal or figure.
    bounds : str
        What was asked, in words.
    value : float
        What was found, the worst over time and axes.
    ok : bool
    """

    name: str
    bounds: str
    value: float
    ok: bool


def _within(value: float, low: float, high: float) -> bool:
    return bool(low <= value <= high)


def _range(name: str, words: str, value: float, bounds: tuple[float, float]) -> Verdict:
    low, high = bounds
    text = f"{words} = {low:g}" if low == high else f"{words} in {low:g} .. {high:g}"
    return Verdict(name, text, value, _within(value, low, high))


def _final(name: str, last: NDArray[Any], wanted: bool | float | tuple[float, float]) -> Verdict:
    low, high = wanted if isinstance(wanted, tuple) else (float(wanted), float(wanted))
    outside = np.maximum(low - last, last - high)
    value = float(last.ravel()[int(np.argmax(outside))])
    return _range(name, "final", value, (low, high))


def _inside(time: NDArray[Any], windows: tuple[tuple[float, float], ...]) -> NDArray[Any]:
    """Samples from the start of a window to its end, both included."""
    return np.any([(time >= a - 1e-12) & (time <= b + 1e-12) for a, b in windows], axis=0)


def _where(windows: tuple[tuple[float, float], ...]) -> str:
    low, high = windows[0]
    return f", {low:g} to {high:g} s" if len(windows) == 1 else f", in {len(windows)} windows"


def judge(name: str, check: Check, time: NDArray[Any], data: NDArray[Any]) -> list[Verdict]:
    """Judge one signal by every bound of its check.

    Parameters
    ----------
    name : str
        Signal name.
    check : Check
        Bounds, in the signal's unit.
    time : ndarray
        Times of the samples [s].
    data : ndarray
        One row per sample.

    Returns
    -------
    list of Verdict
        A NaN in the signal fails every bound.
    """
    x = np.asarray(data, dtype=float)
    if check.at is not None:
        x = x[[int(np.searchsorted(time, check.at - 1e-12).clip(0, len(time) - 1))]]
    elif check.windows is not None:
        x = x[_inside(time, check.windows)]
        if len(x) == 0:  # a run that ends before
            x = np.full((1, *x.shape[1:]), np.nan)
    found = []
    if check.min is not None:
        low = float(x.min())
        found.append(Verdict(name, f">= {check.min:g}", low, low >= check.min))
    if check.max is not None:
        high = float(x.max())
        found.append(Verdict(name, f"<= {check.max:g}", high, high <= check.max))
    if check.absmax is not None:
        peak = float(np.abs(x).max())
        found.append(Verdict(name, f"|.| <= {check.absmax:g}", peak, peak <= check.absmax))
    if check.peak is not None:
        found.append(_range(name, "peak", float(np.abs(x).max()), check.peak))
    if check.rms is not None:
        found.append(_range(name, "rms", float(np.sqrt((x**2).mean())), check.rms))
    if check.final is not None:
        found.append(_final(name, x[-1], check.final))
    where = _where(check.windows) if check.windows is not None else ""
    return [replace(v, bounds=v.bounds + where) for v in found]
