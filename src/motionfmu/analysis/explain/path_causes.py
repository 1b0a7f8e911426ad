"""A tool path's deviation taken apart: one cause switched off at a time, for any machine."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from motionfmu.analysis.explain import cause_switches
from motionfmu.analysis.explain.cause_switches import Cause, CauseOff
from motionfmu.analysis.explain.decompose import NOTHING, SAME, short, watch
from motionfmu.analysis.explain.effects import Effects
from motionfmu.analysis.explain.servo_formulas import Array
from motionfmu.analysis.iso9283 import Performance
from motionfmu.base.errors import InputError
from motionfmu.run import Scenario, load
from motionfmu.run.iso9283_of import evaluation_of

if TYPE_CHECKING:
    from motionfmu.run import Result

REST = "rest"
REST_TITLE = "What is left: commands, servo"
REST_HOW = "all causes above switched off together"
FIGURES = ("accuracy", "straightness", "straightness_in_plane", "in_plane", "height")


@dataclass(frozen=True)
class PathEffect:
    """What one cause does to the mean line of the cycles."""

    name: str
    title: str
    how: str  # how it was switched off, or why not
    judged: bool  # the cause could be switched off, or was absent; else `how` says why not
    change: Array  # (m, 3) mean line with the cause minus without, at the planes [mm]
    figures: Mapping[str, float]  # of the change as if it were the error, by `FIGURES` [mm]
    without: Mapping[str, float]  # of the run without the cause [mm]; empty if there is none

    @property
    def size(self) -> float:
        """Largest change at any plane [mm]."""
        return self.figures["accuracy"]


@dataclass(frozen=True)
class PathExplanation(Effects[PathEffect]):
    """The deviation of a tool path, explained.

    Attributes
    ----------
    result : Result
        The whole run.
    effects : tuple of PathEffect
        The largest first; what is left without all causes is one of them.
    along : ndarray, shape (m,)
        Places of the planes on the command path [mm].
    whole, together : ndarray, shape (m, 3)
        Deviation of the mean line there, and the sum of all effects [mm].
    figures : mapping
        Of the whole run: accuracy (AT_P), straightness, in_plane, height [mm].
    """

    result: "Result"
    effects: tuple[PathEffect, ...]
    along: Array
    whole: Array
    together: Array
    figures: Mapping[str, float]

    def numbers(self) -> dict[str, Any]:
        """Every number, ready for JSON; mm."""
        rest = np.linalg.norm(self.residual, axis=1)
        rows = [
            {"name": e.name, "title": e.title, "how": e.how, "judged": e.judged}
            | {"figures": dict(e.figures), "without": dict(e.without)}
            for e in self.effects
        ]
        return {"figures": dict(self.figures), "residual": float(rest.max()), "effects": rows}


def explain_path(
    path: "str | Path | Scenario",
    set: Mapping[str, Any] | None = None,
    stop: float | None = None,
    progress: Callable[[str, float], None] = lambda what, share: None,
) -> PathExplanation:
    """Explain the deviation of a tool path.

    The scenario runs as it is, once without each cause that acts in it, and once without all of
    them. Compared are the mean lines of the cycles in the same planes across the same command
    path, so no model of axes or pulses is needed.

    Parameters
    ----------
    path : str, Path or Scenario
        A scenario with an [iso9283] table.
    set : mapping, optional
        Value by ``component.variable``, stronger than the scenario's.
    stop : float, optional
        Instead of the scenario's [s].
    progress : callable
        Called with what is under way and the share of all work that is done.

    Raises
    ------
    InputError
        The scenario or a setting is wrong, or has no figures; one message.
    """
    # The scenario is loaded anew, because more signals are recorded.
    scenario = path.changed() if isinstance(path, Scenario) else load(path)
    if scenario.document.body.iso9283 is None:
        raise InputError(f"{scenario.document.file}: the scenario has no [iso9283] table")
    given = dict(set or {})
    known = cause_switches.causes(scenario)
    errors = _errors(scenario)
    watch(scenario, [*errors, *cause_switches.watched(known)])
    progress(scenario.name, 0.0)
    result = scenario.run(set=given, stop=stop)
    base = result.iso9283().path
    states = {c.name: cause_switches.off(c, result, {}) for c in known}
    acting = [c for c in known if states[c.name].set]
    runs: dict[str, Performance] = {}

    def without(changed: Mapping[str, Any]) -> Performance:
        run = scenario.run(set={**given, **changed}, stop=stop)
        for name in errors:
            if np.max(run[name]) > np.max(result[name]):
                raise InputError(f"{name} = {int(np.max(run[name]))}")
        return _same_motion(evaluation_of(run, base.given.path).path, base)

    for i, cause in enumerate(acting, 1):
        progress(f"without {cause.title.lower()}", i / (len(acting) + 2))
        before = states[cause.after].set if cause.after in states else {}
        try:
            runs[cause.name] = without({**before, **cause_switches.off(cause, result, before).set})
        except InputError as error:
            states[cause.name] = CauseOff({}, f"not comparable without it: {error}")
    progress("without all of them", (len(acting) + 1) / (len(acting) + 2))
    everything: dict[str, Any] = {}
    for cause in acting:
        if cause.name in runs:
            everything |= cause_switches.off(cause, result, everything).set
    ideal = without(everything) if everything else base
    progress("done", 1.0)
    return _put_together(result, (known, states), (runs, ideal))


def _errors(scenario: "Scenario") -> list[str]:
    """Outputs by which a controller tells that a run went wrong."""
    return [
        f"{component}.error"
        for component, ports in scenario.resolver.ports.items()
        if "error" in ports
        and ports["error"].causality == "output"
        and (ports["error"].type, ports["error"].shape) == ("Int32", ())
    ]


def _same_motion(run: Performance, base: Performance) -> Performance:
    """Refuse a run whose cycles take another time for the same path."""
    spans = [float((p.time[:, -1] - p.time[:, 0]).mean() / np.ptp(p.along)) for p in (run, base)]
    if run.point.shape[0] != base.point.shape[0]:
        count = (run.point.shape[0], base.point.shape[0])
        raise InputError(f"{count[0]} cycles instead of {count[1]}")
    if abs(spans[0] - spans[1]) > SAME * spans[1]:
        times = [s * float(np.ptp(base.along)) for s in spans]
        raise InputError(f"a cycle takes {times[0]:.3g} s instead of {times[1]:.3g} s")
    return run


def _error(run: Performance, along: Array) -> Array:
    """Deviation of the mean line (m, 3) at places of the path [mm]."""
    error = run.mean - run.command
    return np.stack([np.interp(along, run.along, c) for c in error.T], axis=1)


def _figures(base: Performance, error: Array) -> dict[str, float]:
    """Figures of a mean line with this deviation."""
    line = base.moved(error)
    found = {"accuracy": float(line.accuracy.max())}
    found |= {k: float(v[0]) for k, v in line.shapes().items()}
    return {k: v if v >= NOTHING else 0.0 for k, v in found.items()}


def _put_together(
    result: "Result",
    known: tuple[list[Cause], dict[str, CauseOff]],
    runs: tuple[dict[str, Performance], Performance],
) -> PathExplanation:
    base = result.iso9283().path
    along = base.along
    whole = _error(base, along)
    effects = []
    for cause in known[0]:
        state, run = known[1][cause.name], runs[0].get(cause.name)
        change, without = np.zeros_like(whole), {}
        if run is not None:
            other = runs[0].get(cause.after)
            change = (whole if other is None else _error(other, along)) - _error(run, along)
            without = _figures(base, _error(run, along))
        how = ", ".join(f"{k} = {short(v)}" for k, v in state.set.items()) or state.why_not
        judged = run is not None or state.absent
        names = (cause.name, cause.title, how)
        effects.append(PathEffect(*names, judged, change, _figures(base, change), without))
    left = _error(runs[1], along)
    rest = _figures(base, left)
    effects.append(PathEffect(REST, REST_TITLE, REST_HOW, True, left, rest, rest))
    together = np.sum([e.change for e in effects], axis=0)
    ordered = tuple(sorted(effects, key=lambda e: -e.size))
    return PathExplanation(result, ordered, along, whole, together, _figures(base, whole))
