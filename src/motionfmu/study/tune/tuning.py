"""Tune a scenario: solve, round to the registers, run the FMUs."""

import itertools
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.base.errors import InputError
from motionfmu.run import Result, Scenario, load
from motionfmu.study.tune.choice import DecisionVariable
from motionfmu.study.tune.move import MoveCost
from motionfmu.study.tune.path_error import EVERY
from motionfmu.study.tune.problem import Problem, check_names, problem
from motionfmu.study.tune.solve import TOLERANCE, merit, solve
from motionfmu.study.tune.steps import Array
from motionfmu.study.tune.trial import tried
from motionfmu.study.tune.tuning_functions import CostAndLimits, TuningFunctions
from motionfmu.study.tune.tuning_result import Tuned, TuningRun, settings

# If there are more registers than this, all are rounded together instead of one by one.
_ONE_BY_ONE = 4


def rounded(study: TuningFunctions, z: Array) -> tuple[Array, CostAndLimits]:
    """The best whole-number registers about a solution."""
    # It is more important to keep the limits than to have the smallest cost.
    options = [_near(v, float(share)) for v, share in zip(study.variables, z, strict=True)]
    if sum(v.whole for v in study.variables) > _ONE_BY_ONE:
        corners = [np.array([o[side] for o in options]) for side in (0, -1)]
    else:
        corners = [np.array(c) for c in itertools.product(*options)]
    tried = [(c, study.values(c, False)) for c in corners]
    good = [t for t in tried if t[1].feasible(TOLERANCE)]
    return min(good or tried, key=lambda t: t[1].worst if good else merit(t[1]))


def _near(variable: DecisionVariable, share: float) -> list[float]:
    """Shares of what a register can hold next to a share: below and above, if they are within."""
    value = variable.value(share)
    if not variable.whole:
        return [variable.share(float(f"{value:.6g}"))]
    both = {float(np.floor(value)), float(np.ceil(value))}
    kept = sorted(b for b in both if variable.low <= b <= variable.high)
    return [variable.share(b) for b in kept or [round(value)]]


def tune(
    scenario: Scenario | str | Path,
    options: Problem | Mapping[str, Any] | None = None,
    set: Mapping[str, Any] | None = None,
    progress: Callable[[str, float], None] = lambda what, share: None,
) -> Tuned:
    """Find gains for a scenario's own path and run its FMUs.

    Parameters
    ----------
    scenario : Scenario, str or Path
    options : Problem or mapping, optional
        As in a tune.toml.
    set : mapping, optional
        Values by ``component.variable``, stronger than the scenario's; gains among them are those
        from which the search begins.
    progress : callable
        Called with what is done and the share of it.

    Returns
    -------
    Tuned

    Raises
    ------
    RanAway
        A gain is stopped by nothing but its own bound.
    InputError
        A name or value is wrong, or no gains keep the limits.
    """
    begun = time.perf_counter()
    loaded = scenario if isinstance(scenario, Scenario) else load(scenario)
    asked = options if isinstance(options, Problem) else problem(options or {})
    if loaded.document.body.contour is None and asked.command is None:
        raise InputError(
            f"{loaded.document.file}: a tuning needs the signals of [contour], or command and"
            " position in its tune.toml"
        )
    if asked.trial and asked.command is None:
        raise InputError("trial: only for a scenario that is judged by command and position")
    check_names(asked, loaded)
    given = dict(set or {})
    base = loaded.run(set=given, every=EVERY, progress=lambda share: progress("path", share))
    study = TuningFunctions(loaded, asked, base, given)
    found = solve(study, lambda share: progress("gains", share))
    z, values = rounded(study, found.z)
    tuned = Tuned(study, found, z, values)
    if isinstance(study.path, MoveCost):
        for name, ends in asked.trial.items():
            set_ = {**given, **tuned.settings}
            most = asked.limits.beyond
            item = name, ends, np.inf if most is None else most
            tuned.trial = tried(
                loaded, study.path, item, set_, lambda share: progress("trial", share)
            )
    plants = [0]
    if len(study.plants) > 1:
        plants.append(1 + int(np.argmax(values.costs[1:])))
    present = settings(study, study.present)
    for i, p in enumerate(plants):
        progress("FMUs", i / len(plants))
        plant = study.plants[p]
        ran = base if p == 0 else loaded.run(set={**given, **present, **plant}, every=EVERY)
        tuned.before.append(_run(study, study.present, p, ran))
        ran = loaded.run(set={**given, **tuned.settings, **plant}, every=EVERY)
        tuned.after.append(_run(study, z, p, ran))
    tuned.seconds = time.perf_counter() - begun
    return tuned


def _run(study: TuningFunctions, z: Array, plant: int, result: Result) -> TuningRun:
    model = study.path.error(study.motions(z, plant))
    return TuningRun(study.plants[plant], result, model, study.path.measured(result))
