"""How near each axis is to each of its limits over a run, and which of them bounds its cycle."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.motion_rows import CAUSES, NUMBER_OF
from motionfmu.run.decimate import Read, blocks, reader
from motionfmu.run.run_record import RunRecord
from motionfmu.scenarios import limited_signals as told
from motionfmu.scenarios.machine_limits import AxisLimit

Array = NDArray[np.float64]
# Figures that a shorter cycle would raise.
DYNAMIC = ("speed", "acceleration", "jerk", "torque")
# An axis that moves with less than this share of its speed rests.
RESTS = 1e-3
FEED, PATH, STANDS = "programmed speed", "ramps of the path", "at rest"
# Causes by which the path keeps a tool below its programmed speed.
RAMPS = tuple(NUMBER_OF[n] for n in ("acceleration", "jerk", "corner", "exact stop"))
RESTING = ((STANDS, "waiting"), (STANDS, "dwell"), (STANDS, ""))


@dataclass(frozen=True)
class LimitShares:
    """Shares of the limits of one figure over a run.

    The share is the size over its limit; of a place between two ends its distance from the middle
    over half their distance.
    """

    figure: str
    axes: tuple[str, ...]
    read: Read  # (n, axes)


@dataclass(frozen=True)
class Nearest:
    """An axis, the programmed speed or the path, and how long nothing was nearer to its limit."""

    name: str
    time: float  # [s]
    by: tuple[tuple[str, float], ...]  # figures and their times [s], the longest first


@dataclass(frozen=True)
class CycleBounds:
    """What was nearest to its limit while the program ran."""

    time: float  # [s] of the program
    nearest: tuple[Nearest, ...]  # the longest first
    names: tuple[str, ...]  # that `read` counts
    read: Read  # (n,) place in `names` at each sample, NaN while no program runs

    def numbers(self) -> dict[str, Any]:
        """Time of the program, and what was nearest for how long, for JSON."""
        nearest = [{"name": x.name, "time": x.time, "by": dict(x.by)} for x in self.nearest]
        return {"time": self.time, "nearest": nearest}


def limit_shares(run: RunRecord, limits: Sequence[AxisLimit]) -> list[LimitShares]:
    """Shares of each figure that has limits, whose signal was recorded."""
    found = []
    for figure in dict.fromkeys(limit.figure for limit in limits):
        own = [x for x in limits if x.figure == figure and _bounded(x)]
        if own and own[0].signal.name in run.signals and len(run.time) > own[0].derivative + 1:
            names = tuple(x.axis.name for x in own)
            found.append(LimitShares(figure, names, _read(run, own)))
    return found


def _bounded(limit: AxisLimit) -> bool:
    return bool(limit.limit) or (limit.low is not None and limit.high is not None)


def _read(run: RunRecord, limits: Sequence[AxisLimit]) -> Read:
    """Shares of axes, block by block; before a derivative has its samples it is 0."""
    signal, step = reader(run.signals[limits[0].signal.name]), float(run.time[1] - run.time[0])
    n = limits[0].derivative

    def shares(first: int, last: int) -> Array:
        begin = max(0, first - n)
        raw = np.asarray(signal(begin, last), float)
        raw = raw[:, None] if raw.ndim == 1 else raw
        values = np.stack([raw[:, x.element or 0] * x.scale for x in limits], axis=1)
        if n:
            values = np.diff(values, n, axis=0) / step**n
            values = np.concatenate([np.zeros((last - first - len(values), len(limits))), values])
        return np.stack([_share(v, x) for v, x in zip(values.T, limits, strict=True)], axis=1)

    return shares


def _share(values: Array, limit: AxisLimit) -> Array:
    if limit.limit:
        return np.abs(values) / limit.limit
    low, high = limit.low or 0.0, limit.high or 0.0
    return np.abs(values - 0.5 * (low + high)) / max(0.5 * (high - low), 1e-300)


def cycle_bounds(run: RunRecord, shares: Sequence[LimitShares]) -> CycleBounds | None:
    """Which axis, or limit of the path, is nearest to its end, at each instant of a program.

    None if no controller tells when its program runs and what limits it, or no axis has limits.
    """
    dynamic = [s for s in shares if s.figure in DYNAMIC]
    component = told.controller(run.resolver)
    wanted = [f"{component}.{v}" for v in (told.BY, told.FEED, told.SPEED)]
    if not dynamic or any(name not in run.signals for name in wanted):
        return None
    keys = _keys(dynamic)
    nearest = _nearest(run, wanted, dynamic, keys)
    step = float(run.time[1] - run.time[0])
    times = step * _counts(len(run.time), nearest, len(keys))
    names = tuple(dict.fromkeys(name for name, _ in keys))
    ordered = tuple(sorted((_of(name, keys, times) for name in names), key=lambda x: -x.time))
    ordered = tuple(x for x in ordered if x.time > 0.0)
    place = _named(nearest, np.array([names.index(name) for name, _ in keys], float))
    return CycleBounds(float(times.sum()), ordered, names, place) if ordered else None


def _keys(dynamic: Sequence[LimitShares]) -> list[tuple[str, str]]:
    """What can be nearest: names, and figures or causes of each."""
    axes = [(name, s.figure) for s in dynamic for name in s.axes]
    return [*axes, (FEED, ""), *((PATH, CAUSES[c]) for c in RAMPS), *RESTING]


def _named(nearest: Read, row: Array) -> Read:
    """The same with the row of each place instead."""

    def named(first: int, last: int) -> Array:
        key = nearest(first, last)
        there = ~np.isnan(key)
        key[there] = row[key[there].astype(int)]
        return key

    return named


def _counts(count: int, read: Read, places: int) -> Array:
    """How many samples each place has."""
    found = np.zeros(places)
    for block in blocks(count, read):
        found += np.bincount(block[~np.isnan(block)].astype(int), minlength=places)
    return found


def _nearest(
    run: RunRecord,
    signals: Sequence[str],
    dynamic: Sequence[LimitShares],
    keys: Sequence[tuple[str, str]],
) -> Read:
    """The place in `keys` of what is nearest, NaN while no program runs."""
    by, feed, speed = (reader(run.signals[name]) for name in signals)
    moving = [s for s in dynamic if s.figure == "speed"]

    def nearest(first: int, last: int) -> Array:
        cause, asked, now = by(first, last), feed(first, last), speed(first, last)
        follows = np.divide(now, asked, out=np.zeros(len(now)), where=asked > 0.0)
        follows = np.where(cause == NUMBER_OF["feed"], 1.0, np.minimum(follows, 1.0))
        # Of equal shares, to a thousandth, the first one counts: an axis before the path.
        columns = [s.read(first, last) for s in dynamic]
        ramps = np.stack([(cause == c) * 0.9995 for c in RAMPS], axis=1)
        ends = np.concatenate([np.concatenate(columns, axis=1).round(3), follows[:, None]], axis=1)
        found = np.concatenate([ends, ramps], axis=1).argmax(axis=1).astype(float)
        still = np.zeros(len(now), bool)
        if moving:
            fast = np.concatenate([s.read(first, last) for s in moving], axis=1).max(axis=1)
            still = (now <= 0.0) & (fast < RESTS)
        found[still] = keys.index((STANDS, ""))
        for name in ("dwell", "waiting"):
            found[cause == NUMBER_OF[name]] = keys.index((STANDS, name))
        found[cause == 0] = np.nan
        return found

    return nearest


def _of(name: str, keys: Sequence[tuple[str, str]], times: Array) -> Nearest:
    """How long one was the nearest, and by which figures."""
    own = [(key[1], float(t)) for key, t in zip(keys, times, strict=True) if key[0] == name]
    by = sorted((x for x in own if x[0] and x[1] > 0.0), key=lambda x: -x[1])
    return Nearest(name, sum(t for _, t in own), tuple(by))
