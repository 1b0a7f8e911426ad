"""Tune a scenario: solve, round to the registers, run the FMUs."""

import itertools
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.base.errors import InputError
from motionfmu.identify import Identified
from motionfmu.identify.confidence_region import ConfidenceRegion, read_region, region_of
from motionfmu.run import Result, Scenario, load
from motionfmu.scenarios.values import later
from motionfmu.study.tune.choice import DecisionVariable
from motionfmu.study.tune.move import MoveCost
from motionfmu.study.tune.path_error import EVERY
from motionfmu.study.tune.problem import Problem, check_names, problem
from motionfmu.study.tune.solve import TOLERANCE, merit, solve
from motionfmu.study.tune.steps import Array
from motionfmu.study.tune.trial import tried
from motionfmu.study.tune.tuning_functions import CostAndLimits, TuningFunctions
from motionfmu.study.tune.tuning_result import RegionCheck, Tuned, TuningRun, settings

# Directions drawn on each region, and how often the worst plant is added.
_DRAWN, _EXCHANGES = 40, 6
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
    identified: Sequence[Identified | ConfidenceRegion | str | Path] = (),
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
    identified : sequence, optional
        What `motionfmu.identify` found, or its folders, beside those of the options: values are set
        as found, and limits of loops and steps hold for all plants that the records leave possible.

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
    regions = _regions(asked, identified)
    given = _identified(regions, dict(set or {}))
    base = loaded.run(set=given, every=EVERY, progress=lambda share: progress("path", share))
    tuned = _solved(loaded, (asked, regions), (base, given), progress)
    study, z, values = tuned.study, tuned.z, tuned.values
    if isinstance(study.path, MoveCost):
        for name, ends in asked.trial.items():
            set_ = later(given, tuned.settings)
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
        before = later(later(given, present), plant)
        ran = base if p == 0 else loaded.run(set=before, every=EVERY)
        tuned.before.append(_run(study, study.present, p, ran))
        ran = loaded.run(set=later(later(given, tuned.settings), plant), every=EVERY)
        tuned.after.append(_run(study, z, p, ran))
    tuned.seconds = time.perf_counter() - begun
    return tuned


def _regions(
    problem: Problem, identified: Sequence[Identified | ConfidenceRegion | str | Path]
) -> list[ConfidenceRegion]:
    """All regions; an InputError if two of them, or one and the family, say the same value."""
    found: list[ConfidenceRegion] = []
    known = {name: f"family.{name}" for name in problem.family}
    for one in (*problem.identified, *identified):
        if isinstance(one, str | Path):
            region = read_region(one)
        elif isinstance(one, ConfidenceRegion):
            region = one
        elif (told := region_of(one)) is not None:
            region = told
        else:
            raise InputError(f"{one.record.name} told nothing, so it leaves every plant possible")
        for name in region.settings:
            if other := known.get(name) or known.get(name.partition("[")[0]):
                raise InputError(f"{name} is in {region.name} and in {other}: choose one")
        known |= dict.fromkeys(region.settings, region.name)
        found.append(region)
    return found


def _identified(regions: Sequence[ConfidenceRegion], set: dict[str, Any]) -> dict[str, Any]:
    """What was identified, below what is set; an InputError if that is a plant's value."""
    found: dict[str, Any] = {}
    for region in regions:
        for name in region.moved:
            if twice := {name, name.partition("[")[0]} & set.keys():
                raise InputError(
                    f"{min(twice)} is set, and identified in {region.name}: choose one"
                )
        found |= region.settings
    return later(found, set)


def _solved(
    scenario: Scenario,
    asked: tuple[Problem, Sequence[ConfidenceRegion]],
    of: tuple[Result, dict[str, Any]],
    progress: Callable[[str, float], None],
) -> Tuned:
    """Find the gains; the possible plant that misses a limit most is added, and again.

    So an exchange method solves a problem with limits for infinitely many plants (Blankenship and
    Falk 1976).
    """
    (problem, regions), (base, given) = asked, of
    possible = _possible(problem, regions)
    more: list[dict[str, float]] = []
    first: tuple[float, ...] = ()
    near: Array | None = None
    while True:
        study = TuningFunctions(scenario, problem, base, given, more)
        found = solve(study, lambda share: progress("gains", share), near)
        z, values = rounded(study, found.z)
        tuned = Tuned(study, found, z, values)
        if not possible:
            return tuned
        room = []
        for k, plant in enumerate(possible):
            progress("possible plants", k / len(possible))
            room.append(study.room(z, plant))
        first = first or tuple(room)
        names = tuple(r.name for r in regions)
        tuned.region = RegionCheck(names, problem.level, tuple(more), tuple(room), first)
        worst = possible[int(np.argmin(room))]
        if min(room) > -TOLERANCE or worst in more or len(more) == _EXCHANGES:
            return tuned
        more.append(worst)
        near = found.z


def _possible(problem: Problem, regions: Sequence[ConfidenceRegion]) -> list[dict[str, float]]:
    """Plants on the surface of all regions, at each corner of the family.

    Those of several regions, of an axis each, go together, for axes have limits of their own.
    """
    every = [[*r.principal(problem.level), *r.surface(problem.level, _DRAWN)] for r in regions]
    rows = itertools.zip_longest(*every, fillvalue={})
    around = [{n: v for plant in row for n, v in plant.items()} for row in rows]
    nominal, *corners = problem.plants()
    return [{**corner, **plant} for corner in corners or [nominal] for plant in around]


def _run(study: TuningFunctions, z: Array, plant: int, result: Result) -> TuningRun:
    model = study.path.error(study.motions(z, plant))
    return TuningRun(study.plants[plant], result, model, study.path.measured(result))
