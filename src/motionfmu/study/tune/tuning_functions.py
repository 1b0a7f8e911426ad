"""Cost and limits of a tuning as functions of the gains."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from threadpoolctl import ThreadpoolController

from motionfmu.base.errors import InputError
from motionfmu.base.memo import Memo
from motionfmu.run import Result, Scenario
from motionfmu.study.tune import choice
from motionfmu.study.tune.axis_study import AxisStudy, Motion
from motionfmu.study.tune.curve import margin
from motionfmu.study.tune.family import Family
from motionfmu.study.tune.move import MoveCost
from motionfmu.study.tune.path_error import EVERY, ROUGH, PathCost
from motionfmu.study.tune.problem import ON_PATH, MarginLimits, Problem
from motionfmu.study.tune.steps import Array

# A step response is computed over this many servo lags, at this many samples at least.
_LAGS, _SAMPLES = 20.0, 800
# BLAS gets one thread: products of matrices as small as these take five times as long on two.
_BLAS = ThreadpoolController()
# Number of points whose results are kept.
_KNOWN_MAX = 1000
# An overshoot limit of 0 means no more than rounding.
_LEAST_OVERSHOOT = 1e-3


@dataclass(frozen=True)
class TuningLimit:
    """One of the limits."""

    what: str  # in words
    plant: int  # index, 0 is the nominal one
    axis: int  # from 1


@dataclass(frozen=True)
class CostAndLimits:
    """Cost and limits at a point."""

    costs: Array  # (plants,) cost of each plant, NaN if a loop is unstable
    slack: Array  # (limits,) relative distance to each; negative beyond it
    dcosts: Array  # (plants, n) derivatives to the shares of the variables
    dslack: Array  # (limits, n)

    @property
    def worst(self) -> float:
        """Largest cost of the family."""
        return float(self.costs.max())

    def feasible(self, tolerance: float = 1e-4) -> bool:
        """Whether all loops are stable and all limits kept within a share."""
        return bool(np.isfinite(self.costs).all() and (self.slack > -tolerance).all())


class TuningFunctions(Family):
    """A tuning problem, ready to be evaluated.

    `base` is a run of the scenario with its present gains and `set`, each step a row; InputError if
    there are fewer. `more` are plants beside those of the problem.
    """

    def __init__(
        self,
        scenario: Scenario,
        problem: Problem,
        base: Result,
        set: Mapping[str, Any] | None = None,
        more: Sequence[Mapping[str, float]] = (),
    ) -> None:
        every = base.options["every"] or base.scenario.document.body.record.every
        if every != EVERY:
            raise InputError(f"a tuning needs each step of its run, not one of {every}: every = 1")
        super().__init__(scenario, problem, base, set or {}, more)
        first = next(iter(self.axes))
        self.path, self.lag = self._path(first, self.parts[0][first])
        self._rough = self.path  # judges motions for the global search, from fewer samples
        if isinstance(self.path, PathCost):
            self._rough = PathCost(base, self.parts[0][first].period, ROUGH, problem.judged)
        period = self.parts[0][first].period
        seconds = _LAGS * max(self.lag, 50.0 * period)
        self._step = max(1, round(seconds / _SAMPLES / period)), _SAMPLES
        self._check_loops()
        self.limits = self._limits()  # in the order of `CostAndLimits.slack`
        self.evaluations = 0
        self._known: Memo[CostAndLimits] = Memo(_KNOWN_MAX)

    def _path(self, axis: int, part: AxisStudy) -> tuple[PathCost | MoveCost, float]:
        """The judge of motions, and the servo lag [s] with the present gains."""
        problem, base = self.problem, self.base
        if problem.command is None or problem.position is None:
            path = PathCost(base, part.period, most=problem.judged)
            return path, base.contour().lag
        ends = problem.command, problem.position
        gains = self.gains(self.present)[axis]
        late = choice.shown(self.axes[axis], problem, self.signals.command)
        move = MoveCost(base, ends, part.period, (part.end(gains), late))
        return move, part.lag(gains)

    def _check_loops(self) -> None:
        known = self.parts[0][next(iter(self.axes))].loops
        for name in self.problem.limits.loop:
            if name not in known:
                raise InputError(f"limits.loop.{name}: no loop there ({', '.join(known)})")

    def asked(self, loop: str) -> MarginLimits:
        """Margins asked of the loop that is opened at an input."""
        return self.problem.limits.loop.get(loop, self.problem.limits.margins)

    def _limits(self) -> list[TuningLimit]:
        found = []
        for p, parts in enumerate(self.parts):
            for k, part in parts.items():
                texts = []
                for loop in part.loops:
                    asked = self.asked(loop)
                    if asked.sensitivity is not None:
                        texts.append(f"sensitivity {asked.sensitivity:g} of the loop at {loop}")
                    if asked.gain is not None:
                        texts.append(f"gain margin {asked.gain:g} of the loop at {loop}")
                        texts.append(f"gain reduction 1/{asked.gain:g} of the loop at {loop}")
                    if asked.phase is not None:
                        texts.append(f"phase margin {asked.phase:g}° of the loop at {loop}")
                if self.problem.limits.overshoot is not None:
                    texts.append(f"overshoot {100.0 * self.problem.limits.overshoot:g} %")
                if self.problem.limits.recovery is not None:
                    texts.append(f"recovery within {self.problem.limits.recovery:g} s")
                texts += [f"{n} {v:g}" for n, v in self.peaks.items()]
                found += [TuningLimit(text, p, k) for text in texts]
        return found

    def values(self, z: Array, slopes: bool = True) -> CostAndLimits:
        """Cost and limits at shares (n,) of the variables' ranges, with slopes or zeros."""
        place = z.tobytes()
        slopes = slopes or (place, True) in self._known
        return self._known((place, slopes), lambda: self._counted(z, slopes, self.path))

    def rough(self, z: Array) -> CostAndLimits:
        """Cost and limits without slopes, the cost from fewer samples of the path."""
        return self._counted(z, False, self._rough)

    def _counted(self, z: Array, slopes: bool, path: PathCost | MoveCost) -> CostAndLimits:
        self.evaluations += 1
        with _BLAS.limit(limits=1, user_api="blas"):
            return self._values(z, slopes, path)

    def _values(self, z: Array, slopes: bool, path: PathCost | MoveCost) -> CostAndLimits:
        gains, rates = self.gains(z), self.rates(z)
        costs, dcosts, slack, dslack = [], [], [], []
        for parts in self.parts:
            if not all(np.isfinite(part.slowest(gains[k])[0]) for k, part in parts.items()):
                costs.append(np.nan)
                dcosts.append(np.zeros(len(z)))
                count = len(self.limits) // len(self.plants)
                slack += [-1.0] * count
                dslack += [np.zeros(len(z))] * count
                continue
            cost, dcost, motions = self._cost(parts, (gains, rates), (path, slopes))
            costs.append(cost)
            dcosts.append(dcost)
            known: dict[Any, tuple[list[float], list[Array]]] = {}  # shared by equal axes
            for k, part in parts.items():
                same = part, gains[k].tobytes()
                if same not in known:
                    known[same] = self._slack(part, gains[k], slopes)
                peaks = self._peaks(motions.get(k), len(gains[k]))
                slack += known[same][0] + peaks[0]
                dslack += [c @ rates[k] for c in known[same][1] + peaks[1]]
        return CostAndLimits(
            np.array(costs),
            np.array(slack),
            np.array(dcosts),
            np.array(dslack).reshape(len(slack), len(z)),
        )

    def room(self, z: Array, plant: Mapping[str, float]) -> float:
        """Least relative distance to the limits of loops and steps with another plant.

        It is minus infinity if a loop is unstable with it.
        """
        least, none = np.inf, np.zeros(0)
        with _BLAS.limit(limits=1, user_api="blas"):
            for part in self.still(z, plant):
                if not np.isfinite(part.slowest(none)[0]):
                    return -np.inf
                least = min(least, *self._slack(part, none, False)[0], np.inf)
        return float(least)

    def motions(self, z: Array, plant: int = 0) -> dict[int, Array]:
        """Positions of all axes on the path."""
        # By axis, shape (count,), in the unit of the scenario's position output; from 0.
        gains = self.gains(z)
        found = {}
        for k, part in self.parts[plant].items():
            pulses = self.path.pulses[k]
            found[k] = part.motion(gains[k], pulses, self.path.periods, False).position.value
        return found

    def _cost(
        self,
        parts: Mapping[int, AxisStudy],
        where: tuple[dict[int, Array], dict[int, Array]],
        how: tuple[PathCost | MoveCost, bool],
    ) -> tuple[float, Array, dict[int, Motion]]:
        (gains, rates), (path, slopes) = where, how
        on_path = self.problem.cost in ON_PATH
        motions = {}
        if on_path or self.peaks:
            for k, part in parts.items():
                pulses = path.pulses[k]
                motions[k] = part.motion(gains[k], pulses, path.periods, slopes)
        total = np.zeros(next(iter(rates.values())).shape[1])
        if on_path:
            error = path.error({k: m.position.value for k, m in motions.items()})
            cost, slope = error.cost(self.problem.cost)
            for k, m in motions.items():
                if slopes:
                    total += path.chain(slope, k, m.position.slopes) @ rates[k]
            return cost, total, motions
        cost = 0.0
        for k, part in parts.items():
            value, change = self._after_step(part, gains[k])
            cost += value
            total += change @ rates[k]
        return cost, total, motions

    def _after_step(self, part: AxisStudy, gains: Array) -> tuple[float, Array]:
        answer = part.step(gains, *self._step)
        e, de = 1.0 - answer.value[0], -answer.slopes[:, 0]
        weight = np.full(len(e), part.period * self._step[0])  # trapezoids, to rest
        weight[0] *= 0.5
        if self.problem.cost == "ise":
            return float(weight @ (e * e)), 2.0 * de @ (weight * e)
        if self.problem.cost == "itae":
            weight *= part.period * self._step[0] * np.arange(len(e))
        return float(weight @ np.abs(e)), de @ (weight * np.sign(e))

    def _slack(
        self, part: AxisStudy, gains: Array, slopes: bool
    ) -> tuple[list[float], list[Array]]:
        """Distances to the limits of loops and steps, with slopes."""
        found: list[float] = []
        changes: list[Array] = []

        def add(value: float, slope: Array) -> None:
            found.append(value)
            changes.append(slope)

        for name in part.loops:
            asked, has = self.asked(name), margin(part.loop(name, gains))
            if asked.sensitivity is not None:
                add(has.values[0] * asked.sensitivity - 1.0, has.slopes[0] * asked.sensitivity)
            if asked.gain is not None:
                wide = np.log(asked.gain)
                add(has.values[1] / wide - 1.0, has.slopes[1] / wide)
                add(has.values[2] / wide - 1.0, has.slopes[2] / wide)
            if asked.phase is not None:
                wide = np.radians(asked.phase)
                add(has.values[3] / wide - 1.0, has.slopes[3] / wide)
        if self.problem.limits.overshoot is not None:
            most = max(self.problem.limits.overshoot, _LEAST_OVERSHOOT)
            answer = part.step(gains, *self._step, slopes)
            top = int(np.argmax(answer.value[0]))
            rate = answer.slopes[:, 0, top] if slopes else np.zeros(len(gains))
            add(1.0 - (answer.value[0, top] - 1.0) / most, -rate / most)
        if self.problem.limits.recovery is not None:
            slow, change = part.slowest(gains)
            most = self.problem.limits.recovery
            add(1.0 - slow / most, -change / most)
        return found, changes

    def _peaks(self, motion: Motion | None, count: int) -> tuple[list[float], list[Array]]:
        """Distances to the limits of outputs on the path, with slopes to so many gains."""
        found, changes = [], []
        for row, most in enumerate(self.peaks.values()):
            assert motion is not None
            peak = motion.peaks[row]
            slopes = peak.slopes * np.sign(peak.value)
            found.append(1.0 - abs(float(peak.value)) / most)
            changes.append(-slopes / most if len(slopes) else np.zeros(count))
        return found, changes
