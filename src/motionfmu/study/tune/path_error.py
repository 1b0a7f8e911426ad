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

    def __init__(self, base: Result, period: float, sample: float = SAMPLE) -> None:
        contour = base.contour()
        run, document = contour.run, base.scenario.document
        assert document.body.contour is not None
        rows = round(period / (run.time[1] - run.time[0]))
        # periods of the model from one sample to the next
        self.periods = max(1, round(sample / period))
        stride = slice(None, None, rows * self.periods)
        window = contour.window
        owners = contour.command_track.segment
        time = run.time
        self.time = time[stride]
        first = owners[_held(time, -window)][stride]
        last = owners[_held(time, AHEAD * window)][stride]
        self._cutting = contour.cutting[stride]
        self._path = run.path
        self._lowest, self._owners = first, first.copy()
        # Other samples have one candidate only, so runs of samples between them are independent.
        self._open = np.flatnonzero(first < last)
        self._candidates = first[self._open], last[self._open]
        self._pairs = np.split(self._open, np.flatnonzero(np.diff(self._candidates[0])) + 1)
        self.axes = tuple(i + 1 for i in run.axes if i < 3)
        counts = base[document.body.contour.pulses]
        self.pulses = {i: counts[stride, i - 1].astype(float) for i in self.axes}
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
            points[:, axis - 1] = self._start[axis] + values * self.factor
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


def _held(time: Array, shift: float) -> NDArray[np.int64]:
    found = np.searchsorted(time, time + shift, side="right") - 1
    return np.clip(found, 0, len(time) - 1)
