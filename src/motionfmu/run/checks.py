"""Verdicts: bounds of signals and figures, what must hold and what is expected."""

import math
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.columns import ROWS
from motionfmu.run import record_matches
from motionfmu.run.decimate import Read, reader
from motionfmu.scenarios import rates, record_signals
from motionfmu.scenarios.body import CHECK, Bounds, Pair
from motionfmu.scenarios.system import Resolver

TABLES = ("contour", "iso9283", "record")  # what has figures that can be checked
NOTHING = "no checks: nothing was judged"
# A bound in words: its name, its numbers, the times at which it holds.
_BOUNDS = re.compile(r"((?:.*? )??(?:>=|<=|in|=|order) )(.*?)((?:, (?:at|in) .*|, \S+ to \S+ s)?)$")

Judged = TypeVar("Judged", bound=Any)  # a Verdict, or a verdict of a saved result


@dataclass(frozen=True)
class Verdict:
    """One bound of a line of ``[check]`` or ``[expect]``, and what was found."""

    name: str  # signal or figure
    bounds: str  # the bound in words
    value: float  # the worst over time and axes; NaN if there is no number
    within: bool  # whether the bound holds
    reason: str = ""  # why there is no number; else empty
    beyond: float = math.nan  # value less the bound it lies beyond, 0 within; NaN: no number
    table: str = CHECK
    judged: bool = True  # whether it counts: what is expected does in a run as written only

    @property
    def ok(self) -> bool | None:
        """The verdict; None if it is not judged."""
        return self.within if self.judged else None

    def numbers(self) -> dict[str, Any]:
        """The verdict for JSON, which has no NaN."""
        value, beyond = (x if math.isfinite(x) else None for x in (self.value, self.beyond))
        return {
            "name": self.name,
            "table": self.table,
            "bounds": self.bounds,
            "value": value,
            "ok": self.ok,
            "beyond": beyond,
            "reason": self.reason,
        }


@dataclass(frozen=True)
class Tally:
    """How many verdicts hold, fail and are not given."""

    held: int
    failed: int
    open: int

    @property
    def judged(self) -> int:
        """The number of verdicts that are given."""
        return self.held + self.failed

    @property
    def words(self) -> str:
        """The verdict of a whole run; a run of which nothing is asked says so."""
        if not self.judged:
            kept = f"; {self.open} expected of the scenario as written" if self.open else ""
            return f"{NOTHING}{kept}"
        if self.failed:
            told = f"{self.failed} of {self.judged} checks FAILED"
        else:
            told = f"all {self.judged} checks hold" if self.judged > 1 else "the check holds"
        return f"{told}, {self.open} expected not judged" if self.open else told


def tally(found: Iterable[bool | None]) -> Tally:
    """Count verdicts."""
    listed = list(found)
    return Tally(*(sum(x is kind for x in listed) for kind in (True, False, None)))


def parts(bounds: str) -> tuple[str, str, str]:
    """Name of a bound, its numbers, and the times at which it holds."""
    found = _BOUNDS.match(bounds)
    return (found[1], found[2], found[3]) if found else (bounds, "", "")


def of_one_number(checks: Iterable[Judged]) -> list[list[Judged]]:
    """Groups of successive verdicts: two that bound one number from both sides are one group."""
    groups = groupby(
        checks, lambda c: (c.name, c.table, c.ok, str(c.value), c.reason, parts(c.bounds)[2])
    )
    return [list(group) for _, group in groups]


def together(bounds: Sequence[str]) -> str:
    """Bounds of one number in words; times that are common to all are told once."""
    where = parts(bounds[0])[2]
    return " and ".join(dict.fromkeys(b.removesuffix(where) for b in bounds)) + where


def beyond(same: Iterable[Judged]) -> float:
    """How far a number lies beyond the bounds of its group [its unit]; NaN if that is no number."""
    return float(max((v.beyond for v in same), key=lambda x: math.inf if math.isnan(x) else abs(x)))


def misplaced(name: str, checks: Sequence[Bounds], resolver: Resolver) -> str:
    """Why a line of bounds cannot be, apart from the name of its signal; empty if it can."""
    body = resolver.document.body
    if any(all(getattr(c, bound) is None for bound in BOUNDS) for c in checks):
        return f"{name}: no bound ({', '.join(BOUNDS)})"
    if is_figure(name):
        if any((c.windows, c.at, c.rate) != (None, None, None) for c in checks):
            return f"{name}: a figure has no time, no windows and no rate"
        return wrong_figure(name, resolver)
    told = next((text for c in checks if (text := _no_time(c, body.stop_limit))), "")
    return f"{name}: {told}" if told else ""


def is_figure(name: str) -> bool:
    """Whether a name is that of a figure of an analysis, not of a signal."""
    return name.partition(".")[0] in TABLES


def table_of(figure: str) -> str:
    """The table of a scenario that asks for a figure."""
    table = figure.partition(".")[0]
    return record_signals.TABLE if table == record_matches.TABLE else table


def wrong_figure(name: str, resolver: Resolver) -> str:
    """Why no run of a scenario can have this figure; empty if a run can."""
    table, _, figure = name.partition(".")
    if table == record_matches.TABLE:
        return record_matches.wrong(figure, resolver)
    body = resolver.document.body
    if getattr(body, table) is None:
        return f"{name}: there is no [{table}] table"
    if table == "contour":
        from motionfmu.analysis.contour.names import wrong  # with the analysis; the other one, too
    else:
        from motionfmu.analysis.iso9283.evaluation import wrong
    return wrong(figure)


def _no_time(check: Bounds, stop: float) -> str:
    """Why the times of a check cannot be; empty if they can."""
    if check.at is not None and check.windows is not None:
        return "at and windows exclude each other"
    if check.at is not None and not 0.0 <= check.at <= stop:
        return f"at = {check.at!r} s is not within 0 .. {stop!r} s"
    for low, high in check.windows or ():
        if not 0.0 <= low <= high <= stop:
            return f"windows: [{low!r}, {high!r}] s is not within 0 .. {stop!r} s"
    return ""


def _range(name: str, words: str, value: float, bounds: tuple[float, float]) -> Verdict:
    low, high = bounds
    text = f"{words} = {low:g}" if low == high else f"{words} in {low:g} .. {high:g}"
    beyond = value - min(max(value, low), high)
    return Verdict(name, text, value, bool(low <= value <= high), beyond=beyond)


def _side(name: str, sign: str, value: float, bound: float | Pair) -> Verdict:
    """Judge the smallest sample (sign ``>=``) or the largest (``<=``) by a limit or a range."""
    if isinstance(bound, tuple):
        words = {">=": "min", "<=": "max", "|.| <=": "absmax"}
        return _range(name, words[sign], value, bound)
    ok = value >= bound if sign == ">=" else value <= bound
    return Verdict(name, f"{sign} {bound:g}", value, ok, beyond=0.0 if ok else value - bound)


def _each(name: str, words: str, found: NDArray[Any], wanted: bool | float | Pair) -> Verdict:
    """Judge one value of every axis; the verdict has the value that is farthest out."""
    low, high = wanted if isinstance(wanted, tuple) else (float(wanted), float(wanted))
    outside = np.maximum(low - found, found - high)
    value = float(found.ravel()[int(np.argmax(outside))])
    return _range(name, words, value, (low, high))


def _order(name: str, orders: list[list[float]], wanted: tuple[float, ...]) -> Verdict:
    """Judge the order of every axis' values; the verdict has the first that is out of order."""
    text = "order " + ", ".join(f"{w:g}" for w in wanted)
    for found in orders:
        for i in range(max(len(found), len(wanted))):
            if i >= len(found):
                reason = f"nothing follows {found[-1]:g}"
                return Verdict(name, text, float("nan"), False, reason)
            if i >= len(wanted) or found[i] != wanted[i]:
                return Verdict(name, text, found[i], False)
    return Verdict(name, text, wanted[-1], True, beyond=0.0)


def _inside(time: NDArray[Any], windows: tuple[tuple[float, float], ...]) -> NDArray[Any]:
    """Which samples lie within a window, both of its ends included."""
    return np.any([(time >= a - 1e-12) & (time <= b + 1e-12) for a, b in windows], axis=0)


def _when(check: Bounds) -> str:
    """At which times a bound holds, in words; empty if it always does."""
    if check.at is not None:
        return f", at {check.at:g} s"
    if check.windows is None:
        return ""
    low, high = check.windows[0]
    many = len(check.windows)
    return f", {low:g} to {high:g} s" if many == 1 else f", in {many} windows"


def judge(name: str, check: Bounds, time: NDArray[Any], data: NDArray[Any]) -> list[Verdict]:
    """Judge one signal, a row per sample, by every bound of its check; a NaN fails them all."""
    seen, reason = _statistics(check, time, data)
    given = ((kind, getattr(check, kind)) for kind in BOUNDS)
    found = [_JUDGES[kind](name, seen, bound) for kind, bound in given if bound is not None]
    when = _when(check)
    what = f"rate over {check.rate:g} s " if check.rate is not None else ""
    return [replace(v, bounds=f"{what}{v.bounds}{when}", reason=reason or v.reason) for v in found]


def _statistics(
    check: Bounds, time: NDArray[Any], data: NDArray[Any]
) -> tuple["SampleStatistics", str]:
    """Of the samples that a check looks at; NaN, and the reason, if a check finds none."""
    end = float(time[-1]) + (float(time[-1] - time[-2]) if len(time) > 1 else 0.0)
    last = check.at if check.at is not None else max((b for _, b in check.windows or ()), default=0)
    reason = f"the run ends at {end:g} s, before {last:g} s" if last > end + 1e-12 else ""
    read = reader(data)
    if check.rate is not None:
        back = rates.steps(time, check.rate)
        time, read = time[back:], rates.reader(data, back, check.rate)
        reason = reason or ("" if len(time) else f"the run is shorter than {check.rate:g} s")
    seen = SampleStatistics(check)
    if not reason:
        for block in _chosen(check, time, read):
            seen.add(block)
        reason = "" if seen.count else "no sample is in a window"  # they are between two
    if reason:
        seen.add(np.full((1, *data.shape[1:]), np.nan))
    return seen, reason


def _chosen(check: Bounds, time: NDArray[Any], read: Read) -> Iterator[NDArray[np.float64]]:
    """The samples that a check looks at, in blocks."""
    if check.at is not None:
        k = int(np.searchsorted(time, check.at - 1e-12).clip(0, len(time) - 1))
        yield read(k, k + 1).astype(np.float64)
        return
    for first in range(0, len(time), ROWS):
        block = read(first, min(first + ROWS, len(time)))
        if check.windows is not None:
            block = block[_inside(time[first : first + ROWS], check.windows)]
        if len(block):
            yield block.astype(np.float64)


class SampleStatistics:
    """Statistics of a signal by which bounds judge it; its samples come in blocks."""

    def __init__(self, check: Bounds) -> None:
        self.count = 0  # number of values
        self.low, self.high = math.inf, -math.inf
        self.squares = 0.0  # sum of the squares of all values
        self.last: NDArray[Any] = np.empty(0)  # last value of each axis
        self.changes: NDArray[Any] = np.zeros(1)  # changes of each axis; NaN if it has a NaN
        self.orders: list[list[float]] = []  # of each axis its values, one after the other
        self._check = check

    @property
    def size(self) -> float:
        """The largest magnitude of all values."""
        return float(np.maximum(abs(self.low), abs(self.high)))

    @property
    def rms(self) -> float:
        """Root of the mean square of all values."""
        return float(np.sqrt(self.squares / self.count))

    def add(self, x: NDArray[np.float64]) -> None:
        """Take the next block of samples into account."""
        if self._check.changes is not None or self._check.order is not None:
            self._follow(x if not self.count else np.concatenate([self.last[None], x]))
        self.count += x.size
        self.low = float(np.minimum(self.low, x.min()))
        self.high = float(np.maximum(self.high, x.max()))
        if self._check.rms is not None:
            self.squares += float((x**2).sum())
        self.last = x[-1]

    def _follow(self, x: NDArray[np.float64]) -> None:
        """Note which values follow one another; `x` begins with the last sample before it."""
        other = np.diff(x, axis=0) != 0
        self.changes = self.changes + np.where(np.isnan(x).any(axis=0), np.nan, other.sum(axis=0))
        if self._check.order is None:
            return
        columns = x.reshape(len(x), -1).T
        others = other.reshape(len(other), len(columns)).T
        self.orders = self.orders or [[float(c[0])] for c in columns]
        most = len(self._check.order) + 1
        for found, column, changed in zip(self.orders, columns, others, strict=True):
            found += map(float, column[1:][changed][: most - len(found)])


# How each bound of a [check] line judges the statistics of a signal; verdicts stand in this order.
_JUDGES: dict[str, Callable[[str, SampleStatistics, Any], Verdict]] = {
    "min": lambda name, seen, bound: _side(name, ">=", seen.low, bound),
    "max": lambda name, seen, bound: _side(name, "<=", seen.high, bound),
    "absmax": lambda name, seen, bound: _side(name, "|.| <=", seen.size, bound),
    "peak": lambda name, seen, bound: _range(name, "peak", seen.size, bound),
    "rms": lambda name, seen, bound: _range(name, "rms", seen.rms, bound),
    "final": lambda name, seen, bound: _each(name, "final", seen.last, bound),
    "changes": lambda name, seen, bound: _each(name, "changes", seen.changes, bound),
    "order": lambda name, seen, bound: _order(name, seen.orders, bound),
}
BOUNDS = tuple(_JUDGES)
