"""Find the gains: a CasADi NLP from several points, checked by a global search."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from motionfmu.base.errors import InputError
from motionfmu.study.tune.choice import DecisionVariable
from motionfmu.study.tune.steps import Array
from motionfmu.study.tune.tuning_functions import CostAndLimits, TuningFunctions, TuningLimit

# A limit, or a bound of a variable, is reached within this share.
_REACHED = 2e-3
# Relative amount by which a result may miss a limit.
TOLERANCE = 1e-4
_PENALTY = 10.0
# Half the width of the box in which the NLP is solved once, as a share of the range: slopes are
# trusted so far.
_BOX, _BOXES, _EDGE = 0.15, 8, 1e-4
# The NLP is solved again in a smaller box as long as that lowers the cost by this share.
_SMALLER, _SMALLEST, _GAIN, _AGAIN = 0.4, 0.01, 5e-4, 6
# If gains for each axis alone lower the cost by a smaller share, they are not searched.
_SETTLED = 1e-7
_OPTIONS: Any = {
    "ipopt.hessian_approximation": "limited-memory",
    "ipopt.limited_memory_max_history": 12,
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "ipopt.tol": 1e-5,
    "ipopt.acceptable_tol": 1e-2,
    "ipopt.acceptable_obj_change_tol": 1e-5,
    "ipopt.acceptable_constr_viol_tol": 1e-6,
    "ipopt.constr_viol_tol": 1e-6,
    "ipopt.acceptable_iter": 3,
    "ipopt.mu_init": 1e-2,
    "ipopt.max_iter": 25,
    "ipopt.bound_relax_factor": 0.0,
    "print_time": False,
    "show_eval_warnings": False,
}


class RanAway(InputError):
    """A gain ran to its own bound, because no limit stopped it before."""


@dataclass(frozen=True)
class Found:
    """A solution of the problem."""

    z: Array  # (n,) each variable as a share of its range
    values: CostAndLimits
    stopped_by: tuple[TuningLimit, ...]  # limits that are reached there
    ends: tuple[str, ...]  # variables at an end of their parameter's own range
    starts: tuple[float, ...]  # cost found from each start; NaN where the search failed
    # Cost of the global search alone; NaN if it found nothing within the limits, or was not made.
    check: float
    seconds: tuple[float, float]  # of the NLP and of the global search
    evaluations: tuple[int, int]  # of both


class _Function(ca.Callback):
    """Logarithms of the costs and the slacks, for CasADi."""

    def __init__(self, study: TuningFunctions) -> None:
        super().__init__()
        self.study = study
        self.n = len(study.variables)
        self.m = len(study.plants) + len(study.limits)
        self._slopes: Any = None
        self.construct("values", {})

    def get_n_in(self) -> int:
        """One: the shares."""
        return 1

    def get_n_out(self) -> int:
        """One: costs and slacks."""
        return 1

    def get_sparsity_in(self, i: int) -> ca.Sparsity:
        """Dense column."""
        return ca.Sparsity.dense(self.n)

    def get_sparsity_out(self, i: int) -> ca.Sparsity:
        """Dense column."""
        return ca.Sparsity.dense(self.m)

    def eval(self, arg: Sequence[ca.DM]) -> list[ca.DM]:
        """Values."""
        found = self.study.values(np.asarray(arg[0].full()).ravel())
        return [ca.DM(np.concatenate([np.log(found.costs), found.slack]))]

    def has_jacobian(self) -> bool:
        """Always."""
        return True

    def get_jacobian(self, name: str, inames: Any, onames: Any, opts: Any) -> ca.Function:
        """Slopes."""
        self._slopes = _Slopes(name, self)
        return self._slopes


class _Slopes(ca.Callback):
    """Jacobian of `_Function`."""

    def __init__(self, name: str, of: _Function) -> None:
        super().__init__()
        self.of = of
        self.construct(name, {})

    def get_n_in(self) -> int:
        """The shares, and the values there."""
        return 2

    def get_n_out(self) -> int:
        """One matrix."""
        return 1

    def get_sparsity_in(self, i: int) -> ca.Sparsity:
        """Dense column."""
        return ca.Sparsity.dense(self.of.n if i == 0 else self.of.m)

    def get_sparsity_out(self, i: int) -> ca.Sparsity:
        """Dense."""
        return ca.Sparsity.dense(self.of.m, self.of.n)

    def eval(self, arg: Sequence[ca.DM]) -> list[ca.DM]:
        """Slopes."""
        found = self.of.study.values(np.asarray(arg[0].full()).ravel())
        return [ca.DM(np.vstack([found.dcosts / found.costs[:, None], found.dslack]))]


_Run = Callable[[Array, CostAndLimits, float], tuple[Array, CostAndLimits, bool]]


def _shared(study: TuningFunctions) -> Array:
    """Shares of all variables from those of the gains: axes move together."""
    found = np.zeros((len(study.variables), len(study.names)))
    for row, variable in enumerate(study.variables):
        found[row, study.names.index(variable.name)] = 1.0
    return found


def _solver(study: TuningFunctions, spread: Array) -> tuple[_Run, Any]:
    """min t over y and t, z = spread y, with log cost <= t for every plant and no slack < 0."""
    function = _Function(study)
    n, plants = spread.shape[1], len(study.plants)
    inverse = np.linalg.pinv(spread)
    y, t = ca.MX.sym("y", n), ca.MX.sym("t")
    found = function(ca.mtimes(ca.DM(spread), y))
    nlp: Any = {"x": ca.vertcat(y, t), "f": t, "g": ca.vertcat(t - found[:plants], found[plants:])}
    solver = ca.nlpsol("tune", "ipopt", nlp, _OPTIONS)

    def solve(start: Array, values: CostAndLimits, box: float) -> tuple[Array, CostAndLimits, bool]:
        """Solve in one box after another until a solution is inside its box; returns if it is."""
        best = start, values
        for _ in range(_BOXES):
            centre = np.clip(inverse @ best[0], 0.01, 0.99)
            low, high = np.maximum(centre - box, 0.0), np.minimum(centre + box, 1.0)
            answer = solver(
                x0=np.append(centre, np.log(best[1].worst) + 0.01),
                lbx=np.append(low, -np.inf),
                ubx=np.append(high, np.inf),
                lbg=0.0,
                ubg=np.inf,
            )
            y = np.clip(np.asarray(answer["x"].full()).ravel()[:n], low, high)
            z = spread @ y
            found = study.values(z)
            if not merit(found) < merit(best[1]):
                box *= _SMALLER  # the slopes did not hold over the whole box
                if box < _SMALLEST:
                    break
                continue
            best = z, found
            free = (y > low + _EDGE) | (low == 0.0)
            if (free & ((y < high - _EDGE) | (high == 1.0))).all():
                return *best, solver.stats()["return_status"] == "Solve_Succeeded"
        return *best, False

    return solve, function


def merit(values: CostAndLimits) -> float:
    """Cost and limits as one number, for the global search, which knows no limits."""
    # It is the logarithm of the worst cost plus a penalty for limits that are not kept.
    if not np.isfinite(values.costs).all():
        return 1e3
    return float(np.log(values.worst)) + _PENALTY * float(-np.minimum(values.slack, 0.0).sum())


# CCN 21: stages of one search after each other, of each of which time and evaluations are told.
def solve(
    study: TuningFunctions,
    progress: Callable[[float], None] = lambda share: None,
    near: Array | None = None,
) -> Found:
    """Find the gains within the limits; `RanAway` if only a gain's own bound stops it.

    With a point that is `near` the search begins there, and nowhere else.
    """
    together = _solver(study, _shared(study))
    begun, first = time.perf_counter(), study.evaluations
    check, points = np.nan, [study.present if near is None else near]
    if study.problem.check and near is None:
        point, values = _global(study, lambda share: progress(0.4 * share))
        check = values.worst if values.feasible(TOLERANCE) else np.nan
        points.append(point)
    spent = time.perf_counter() - begun, study.evaluations - first
    begun, first = time.perf_counter(), study.evaluations
    points = points[: study.problem.starts]
    if len(points) < study.problem.starts and near is None:
        points = [*points, *_spread(study)][: study.problem.starts]
    candidates: list[tuple[Array, CostAndLimits]] = []
    costs = []
    for i, start in enumerate(points):
        progress(0.4 + 0.6 * i / len(points))
        found = _attempt(study, together[0], start)
        costs.append(found[1].worst if found and found[1].feasible(TOLERANCE) else np.nan)
        candidates += [found] if found else []
    if len(study.variables) > len(study.names) and candidates:
        best = min(candidates, key=lambda c: merit(c[1]))
        if not _settled(study.values(best[0])):
            alone = _solver(study, np.eye(len(study.variables)))
            candidates += [c for c in [_attempt(study, alone[0], best[0])] if c]
    seconds, count = time.perf_counter() - begun, study.evaluations - first
    progress(1.0)
    kept = [c for c in candidates if c[1].feasible(TOLERANCE)]
    if not kept:
        raise InputError(_hopeless(study, candidates))
    z, values = min(kept, key=lambda c: c[1].worst)
    ends = _ends(study, z, values)
    return Found(
        z,
        values,
        tuple(x for x, s in zip(study.limits, values.slack, strict=True) if s < _REACHED),
        ends,
        tuple(costs),
        float(check),
        (seconds, spent[0]),
        (count, spent[1]),
    )


def _attempt(study: TuningFunctions, run: _Run, start: Array) -> tuple[Array, CostAndLimits] | None:
    """Solve the NLP from one point; the point itself if no better one is found."""
    best = start, study.values(start)
    if not np.isfinite(best[1].costs).all():
        return None
    box = _BOX
    for _ in range(_AGAIN):
        try:
            z, values, done = run(*best, box)
        except RuntimeError:  # CasADi met a value that is not a number
            break
        lower = merit(best[1]) - merit(values)
        best = z, values
        if done or lower < _GAIN:
            break
        box = max(box * _SMALLER, _SMALLEST)
    return best


def _settled(values: CostAndLimits) -> bool:
    """Whether no direction in the box lowers the cost to first order: each axis for itself, too.

    For multipliers m >= 0 of the limits with slack s and slopes G the linear problem gains at most
    m s + box |g - G' m| (its dual), g being the slope of the logarithm of the cost.
    """
    if len(values.costs) > 1 or not values.feasible(TOLERANCE):
        return False
    near = values.slack < _REACHED
    slope, limits = values.dcosts[0] / values.costs[0], values.dslack[near]
    weights = np.linalg.lstsq(limits.T, slope, rcond=None)[0].clip(min=0.0)
    left = float(np.abs(slope - limits.T @ weights).sum())
    return abs(float(weights @ values.slack[near])) + _BOX * left < _SETTLED


def _spread(study: TuningFunctions) -> list[Array]:
    """Points spread over the range, moved to the present gains until all loops are stable."""
    from scipy.stats import qmc  # a third of a second, and seldom needed

    present, found = study.present, []
    drawn = qmc.Sobol(len(present), seed=1).random_base2(6)
    for point in drawn[: max(0, study.problem.starts - 1)]:
        for share in (1.0, 0.5, 0.25, 0.1):
            between = present + share * (point - present)
            if np.isfinite(study.values(between, False).costs).all():
                found.append(between)
                break
    return found


def _global(
    study: TuningFunctions, progress: Callable[[float], None]
) -> tuple[Array, CostAndLimits]:
    """Global search by DIRECT, which divides the box and needs neither slopes nor a start."""
    spread = _shared(study)
    box = [(0.0, 1.0)] * spread.shape[1]
    best: tuple[float, Array] = (np.inf, study.present)
    done = 0

    def at(y: Array) -> float:
        nonlocal best, done
        z = spread @ y
        done += 1
        progress(min(1.0, done / study.problem.check))
        value = merit(study.rough(z))
        best = min(best, (value, z), key=lambda pair: pair[0])
        return value

    from scipy.optimize import direct  # whose import takes a third of a second

    direct(at, box, maxfun=study.problem.check, maxiter=10_000, locally_biased=True)
    return best[1], study.values(best[1], False)


def _ends(study: TuningFunctions, z: Array, values: CostAndLimits) -> tuple[str, ...]:
    """Variables at their bounds; an error if that is the search's own bound and holds the cost."""
    ends = []
    for k, (variable, share) in enumerate(zip(study.variables, z, strict=True)):
        high = share > 1.0 - _REACHED
        if _REACHED <= share <= 1.0 - _REACHED:
            continue
        worst = int(np.argmax(values.costs))
        falls = values.dcosts[worst, k] < 0.0 if high else values.dcosts[worst, k] > 0.0
        if not falls:
            continue
        if variable.own[1 if high else 0] and not variable.whole:
            ends.append(f"{variable.title} = {variable.value(float(share)):g}, an end of its range")
            continue
        raise RanAway(_away(study, variable, high))
    return tuple(ends)


def _away(study: TuningFunctions, variable: DecisionVariable, high: bool) -> str:
    bound = variable.high if high else variable.low
    side = "upper" if high else "lower"
    return (
        f"{study.scenario.document.file}: {variable.title} ran to its own {side} bound {bound:g}:"
        f" {study.problem.cost} still falls there and no limit stops it, so this is no result;"
        " ask for margins or an overshoot limit, or give other bounds"
    )


def _hopeless(study: TuningFunctions, candidates: list[tuple[Array, CostAndLimits]]) -> str:
    text = f"{study.scenario.document.file}: no gains within the bounds keep all limits"
    if not candidates:
        return f"{text}: the loop is unstable wherever the search began"
    _, values = min(candidates, key=lambda c: merit(c[1]))
    worst = int(np.argmin(values.slack))
    limit = study.limits[worst]
    return (
        f"{text}; nearest: {limit.what}, axis {limit.axis},"
        f" plant {limit.plant} is missed by {-100.0 * values.slack[worst]:.3g} %"
    )
