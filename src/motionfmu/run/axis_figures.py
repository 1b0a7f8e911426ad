"""Figures of a machine's axes in a run, each beside what limits it."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.run.decimate import Read, blocks, reader
from motionfmu.run.run_record import RunRecord
from motionfmu.scenarios.machine_limits import AxisLimit

# Share of a limit from which on a figure counts as at it.
REACHED = 0.999


@dataclass(frozen=True)
class AxisFigure:
    """A figure of an axis over a run, in the unit of its limit."""

    limit: AxisLimit  # axis, figure, unit and what limits it
    low: float
    high: float
    largest: float  # value of the largest size
    at: float  # [s] when
    rms: float
    time_at_limit: float  # [s] at or beyond its limit, low or high
    time_above: float = 0.0  # [s] above what may last, in all
    longest_above: float = 0.0  # [s] the longest such time without a break
    low_at: float = 0.0  # [s] of the least value
    high_at: float = 0.0  # [s] of the greatest

    @property
    def share(self) -> float | None:
        """The largest size over the limit; None without one."""
        return abs(self.largest) / self.limit.limit if self.limit.limit else None

    @property
    def continuous_share(self) -> float | None:
        """The RMS over what may last; None where that is not known."""
        return self.rms / self.limit.continuous if self.limit.continuous else None

    @property
    def overload_share(self) -> float | None:
        """The longest time above what may last, over what is allowed; None where none is stated."""
        return self.longest_above / self.limit.overload if self.limit.overload else None

    def numbers(self) -> dict[str, Any]:
        """The same for JSON."""
        limit = self.limit
        bounds = {k: getattr(limit, k) for k in ("limit", "low", "high", "continuous", "overload")}
        return {
            "axis": limit.axis.name,
            "figure": limit.figure,
            "unit": limit.unit,
            "min": self.low,
            "max": self.high,
            "largest": self.largest,
            "at": self.at,
            "rms": self.rms,
            "time_at_limit": self.time_at_limit,
            "time_above": self.time_above,
            "longest_above": self.longest_above,
            "limits": {k: v for k, v in bounds.items() if v is not None},
        }


def axis_figures(run: RunRecord, limits: list[AxisLimit]) -> list[AxisFigure]:
    """Figures whose signal was recorded, from the start to the end of the run."""
    found = []
    for limit in limits:
        name = limit.signal.name
        if name in run.signals and len(run.time) > limit.derivative + 1:
            found.append(_figure(run.time, reader(run.signals[name]), limit))
    return found


def _figure(time: NDArray[np.float64], read: Read, limit: AxisLimit) -> AxisFigure:
    """Go through a signal in blocks; a derivative is a difference of neighbouring samples."""
    n, step = limit.derivative, float(time[1] - time[0])
    tail, low, high, squares, count, reached = np.zeros(0), np.inf, -np.inf, 0.0, 0, 0
    largest, at = 0.0, float(time[0])
    low_at = high_at = at
    above, longest, run = 0, 0, 0  # samples
    for block in blocks(len(time), read):
        raw = np.asarray(block, float)
        x = raw if raw.ndim == 1 else raw[:, limit.element or 0]
        x = np.concatenate([tail, x])
        tail = x[len(x) - n :] if n else tail
        x = np.diff(x, n) / step**n if n else x
        x = x if limit.scale == 1.0 else limit.scale * x
        if not len(x):
            continue
        k = int(np.argmax(np.abs(x)))
        if abs(x[k]) > abs(largest):
            largest, at = float(x[k]), float(time[min(count + k + n, len(time) - 1)])
        ends = int(np.argmin(x)), int(np.argmax(x))
        when = [float(time[min(count + k + n, len(time) - 1)]) for k in ends]
        low, low_at = min((low, low_at), (float(x[ends[0]]), when[0]), key=lambda e: e[0])
        high, high_at = max((high, high_at), (float(x[ends[1]]), when[1]), key=lambda e: e[0])
        squares, count = squares + float(x @ x), count + len(x)
        reached += int(np.count_nonzero(_at_limit(x, limit)))
        if limit.continuous is not None:
            over = np.abs(x) > limit.continuous
            above += int(np.count_nonzero(over))
            most, run = _longest(over, run)
            longest = max(longest, most)
    rms = float(np.sqrt(squares / count)) if count else 0.0
    at_limit, over_time, longest_time = (n * step for n in (reached, above, longest))
    return AxisFigure(
        limit, low, high, largest, at, rms, at_limit, over_time, longest_time, low_at, high_at
    )


def _longest(over: NDArray[np.bool_], before: int) -> tuple[int, int]:
    """The longest run of true samples behind so many before, and how many are true at the end."""
    breaks = np.flatnonzero(~over)
    if not len(breaks):
        return before + len(over), before + len(over)
    inside = int(np.diff(breaks).max(initial=1)) - 1
    end = len(over) - 1 - int(breaks[-1])
    return max(before + int(breaks[0]), inside, end), end


def _at_limit(x: NDArray[np.float64], limit: AxisLimit) -> NDArray[np.bool_]:
    at = np.zeros(len(x), bool)
    if limit.limit:
        at |= np.abs(x) >= REACHED * limit.limit
    if limit.low is not None:
        at |= x <= limit.low
    if limit.high is not None:
        at |= x >= limit.high
    return at
