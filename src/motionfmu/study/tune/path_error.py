"""Contour error or position error of a simulated motion, with its derivatives."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.contour.assign import assign
from motionfmu.analysis.contour.error import AHEAD
from motionfmu.base import units
from motionfmu.run import Result
from motionfmu.study.tune.steps import Array

# A run records every step, whatever the scenario has, so that it has the model's instants.
EVERY = 1
# Time between two samples of the path [s]: about one command of the card.
SAMPLE = 1e-3
# The same for the global search; costs are within 5 % wherever the limits are kept.
ROUGH = 2e-3
# A path that is longer than what is judged of it is judged in pieces of so many seconds: half of
# them where the error is largest, half spread evenly. The motion begins so long before each [s].
PIECE, RUN_UP = 1.0, 0.4
# Order of the norm that approximates the largest error, so that it has a derivative.
_ORDER = 24


@dataclass(frozen=True)
class PathError:
    """Contour error of a motion, where the tool cuts."""

    distance: Array  # (count,) from the nearest point of the exact path [mm]
    gap: Array  # (count, 3) from there to the tool [mm]

    @property
    def rms(self) -> float:
        """Root of the mean square [mm]."""
        return float(np.sqrt(np.mean(self.distance**2)))

    @property
    def max(self) -> float:
        """Largest distance [mm]."""
        return float(self.distance.max())

    def cost(self, name: str) -> tuple[float, Array]:
        """A cost [mm], and its derivative (count, 3) to the positions."""
        # The name ends with ``_rms``, or with ``_max`` for the norm of order 24.
        if name.endswith("rms"):
            value = max(self.rms, 1e-12)
            return value, self.gap / (value * len(self.gap))
        top = max(self.max, 1e-12)
        share = self.distance / top
        total = float(np.sum(share**_ORDER))
        value = top * total ** (1.0 / _ORDER)
        weight = (share ** (_ORDER - 2)) * total ** (1.0 / _ORDER - 1.0) / top
        return value, self.gap * weight[:, None]


@dataclass(frozen=True)
class RunPath:
    """The error in a run of the FMUs."""

    rms: float  # [mm]
    max: float  # [mm]
    time: Array  # [s]
    values: Array  # [mm]; NaN where it does not count


class PathCost:
    """The path of a scenario, from a run of its FMUs.

    Nearest points are those of `motionfmu.analysis.contour`: on the exact geometry, each sample
    within the part of the path that the pulses passed shortly before. To first order a motion of
    the nearest point along the path does not change the distance: the derivative is the normal.
    """

    what = "contour error"

    def __init__(
        self, base: Result, period: float, sample: float = SAMPLE, most: float = np.inf
    ) -> None:
        contour = base.contour()
        run, document = contour.run, base.scenario.document
        assert document.body.contour is not None
        rows = round(period / (run.time[1] - run.time[0]))
        # periods of the model from one sample to the next
        self.periods = max(1, round(sample / period))
        window = contour.window
        owners = contour.command_track.segment
        time = run.time
        error = np.where(contour.cutting, contour.track.distance, 0.0)
        stride, judged = pieces(error, rows * self.periods, float(time[1] - time[0]), most)
        self.time = time[stride]
        self.judged = float(judged.sum()) * rows * self.periods * float(time[1] - time[0])
        first = owners[_held(time, -window)[stride]]
        last = owners[_held(time, AHEAD * window)[stride]]
        self._cutting = contour.cutting[stride] & judged
        self._path = run.path
        self._lowest, self._owners = first, first.copy()
        # Other samples have one candidate only, so runs of samples between them are independent.
        self._open = np.flatnonzero(first < last)
        self._candidates = first[self._open], last[self._open]
        self._pairs = np.split(self._open, np.flatnonzero(np.diff(self._candidates[0])) + 1)
        self.axes = tuple(i + 1 for i in run.axes if i < 3)
        counts = base[document.body.contour.pulses]
        # what lies between two pieces is left out of the motion, and added to the positions
        self.pulses = {
            i: _joined(counts[stride, i - 1].astype(float), stride)[0] for i in self.axes
        }
        self._left_out = {i: _joined(run.commanded[stride, i - 1], stride)[1] for i in self.axes}
        self._rest = run.actual[stride, :3].copy()
        self._start = {i: float(run.actual[0, i - 1]) for i in self.axes}
        port = base.scenario.resolver.end(
            document.body.contour.position, "contour", "position"
        ).port
        self.factor = units.parse(port.unit or "1").factor / units.parse("mm").factor

    def error(self, positions: Mapping[int, Array]) -> PathError:
        """Contour error of positions (count,) by axis, which begin at 0."""
        # The positions are in the unit of the scenario's position output.
        points = self._rest.copy()
        for axis, values in positions.items():
            points[:, axis - 1] = self._start[axis] + values * self.factor + self._left_out[axis]
        self._assign(points)
        points = points[self._cutting]
        near = self._path.segments.foot(points, self._owners[self._cutting])
        return PathError(near.distance, points - near.point)

    def _assign(self, points: Array) -> None:
        """Give samples with several candidates the one that `assign` gives them."""
        first, last = self._candidates
        if (last > first + 1).any():
            self._owners[self._open] = assign(points[self._open], self._path, first, last)
            return
        for own in self._pairs:  # of two segments: change where the sum of squares is least
            if not len(own):
                continue
            k = int(self._lowest[own[0]])
            one, two = (self._path.segments[j].foot(points[own]).distance ** 2 for j in (k, k + 1))
            sums = np.concatenate([[0.0], np.cumsum(one - two)])
            self._owners[own] = np.where(np.arange(len(own)) < np.argmin(sums), k, k + 1)

    def chain(self, slope: Array, axis: int, changes: Array) -> Array:
        """Derivatives of a cost to an axis' gains, from its position's."""
        found: Array = changes[:, self._cutting] @ slope[:, axis - 1] * self.factor
        return found

    def measured(self, result: Result) -> RunPath:
        """Contour error of a run."""
        contour = result.contour()
        track = contour.track
        values = track.distance if track.signed is None else track.signed
        shown = np.where(contour.cutting, values, np.nan)
        return RunPath(contour.error.rms, contour.error.max, contour.run.time, shown)


def pieces(
    error: Array, stride: int, step: float, most: float
) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    """The samples of a path with an error (n,) every so many seconds that are looked at.

    They are every `stride`-th one, of a path that is longer than `most` [s] those of some pieces
    only. The second array has those that are judged, not only run up to.
    """
    every = np.arange(0, len(error), stride)
    if len(error) * step <= most:
        return every, np.ones(len(every), dtype=bool)
    length = max(1, round(PIECE / (stride * step)))
    count = -(-len(every) // length)
    wanted = max(2, int(most / PIECE))
    rows = np.arange(count) * length * stride
    highest = np.maximum.reduceat(error, rows)
    worst = np.argsort(-highest, kind="stable")[: wanted // 2]
    others = np.setdiff1d(np.arange(count), worst)
    spread = others[np.linspace(0, len(others) - 1, wanted - len(worst)).round().astype(np.int64)]
    judged = np.zeros(count * length, dtype=bool)
    for k in (*worst, *spread):
        judged[k * length : (k + 1) * length] = True
    judged = judged[: len(every)]
    before = round(RUN_UP / (stride * step))
    # a sample is looked at if one is judged within the run-up after it
    ahead = np.cumsum(np.append(judged, np.zeros(before, dtype=bool)))
    here = np.arange(len(every))
    seen = ahead[here + before] - np.where(here > 0, ahead[here - 1], 0) > 0
    return every[seen], judged[seen]


def _joined(values: Array, rows: NDArray[np.int64]) -> tuple[Array, Array]:
    """Values at some rows, less the way between two that do not follow each other; that way."""
    steps = np.diff(rows)
    gaps = np.flatnonzero(steps > steps.min()) + 1 if len(steps) else steps
    away = np.zeros(len(values))
    away[gaps] = values[gaps] - values[gaps - 1]
    left_out = np.cumsum(away)
    return values - left_out, left_out


def _held(time: Array, shift: float) -> NDArray[np.int64]:
    found = np.searchsorted(time, time + shift, side="right") - 1
    return np.clip(found, 0, len(time) - 1)
