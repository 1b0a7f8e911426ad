"""Tune a scenario: solve, round to the registers, run the FMUs."""

import itertools
import time
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.errors import InputError
from motionfmu.linear.block import Plant, Sampled
from motionfmu.linear.opened import worst
from motionfmu.run import Result, Scenario, load
from motionfmu.tune.curve import margin
from motionfmu.tune.move import MoveCost
from motionfmu.tune.path import Measured, PathError
from motionfmu.tune.problem import ON_PATH, Problem, problem
from motionfmu.tune.solve import TOLERANCE, Found, merit, solve
from motionfmu.tune.steps import Array
from motionfmu.tune.study import Study, Values
from motionfmu.tune.trial import Trial, tried

# More registers than this are rounded together, not one by one.
_ONE_BY_ONE = 4


@dataclass(frozen=True)
class Run:
    """The FMUs with some gains and a plant.

    Attributes
    ----------
    plant : dict
        Changed values; empty for the nominal one.
    result : Result
    model : PathError
        What the tuner's model says of the same.
    fmus : Measured
        What the run shows.
    """

    plant: dict[str, float]
    result: Result
    model: PathError
    fmus: Measured


@dataclass(frozen=True)
class LoopMargins:
    """Margins of a loop of an axis, the least of a family.

    Attributes
    ----------
    axis : int
    loop : str
    sensitivity : float
        Largest |1/(1 + L)|.
    gain : float
        Factor up or down, the smaller one; infinite beyond 1000.
    phase : float
        [deg]
    """

    axis: int
    loop: str
    sensitivity: float
    gain: float
    phase: float


@dataclass
class Tuned:
    """What a tuning found.

    Attributes
    ----------
    study : Study
    found : Found
        With the gains as the solver has them.
    z : ndarray
        The same, rounded to the registers.
    values : Values
        With the rounded gains.
    before, after : list of Run
        FMUs with the present and the found gains: nominal plant, then, with a family, its worst.
    seconds : float
        Of everything.
    trial : Trial or None
        The parameter that was looked for by running the FMUs.
    """

    study: Study
    found: Found
    z: Array
    values: Values
    before: list[Run] = field(default_factory=list)
    after: list[Run] = field(default_factory=list)
    seconds: float = 0.0
    trial: Trial | None = None

    @property
    def settings(self) -> dict[str, Any]:
        """Gains as the scenario takes them, and what was tried.

        A value, or one for each axis.
        """
        found = settings(self.study, self.z)
        return found | ({self.trial.name: self.trial.value} if self.trial else {})

    @property
    def stopped_by(self) -> list[str]:
        """What the gains are stopped by, in words."""
        found = []
        for what in dict.fromkeys(x.what for x in self.found.stopped_by):
            same = [x for x in self.found.stopped_by if x.what == what]
            axes = sorted({x.axis for x in same})
            text = f"{what}, {'axes' if len(axes) > 1 else 'axis'} {', '.join(map(str, axes))}"
            plants = sorted({x.plant for x in same})
            if self.study.problem.family:
                text += f", {plant_text(self.study.plants[plants[0]])}"
                text += f" and {len(plants) - 1} more" if len(plants) > 1 else ""
            found.append(text)
        found += self.found.ends
        found = found or [f"no limit: {self.study.problem.cost} has its minimum here"]
        return found + ([self.trial.stopped_by] if self.trial else [])

    def cost(self, z: Array) -> Array:
        """Cost of every plant with some gains, from the model.

        Parameters
        ----------
        z : ndarray

        Returns
        -------
        ndarray, shape (plants,)
            [mm], or [s] and [s^2] after a step.
        """
        return self.study.values(z, False).costs

    def margins(self, z: Array) -> list[LoopMargins]:
        """Least margins of the family with some gains.

        Parameters
        ----------
        z : ndarray

        Returns
        -------
        list of LoopMargins
            One for each axis and loop.
        """
        return margins(self.study, z)

    def lags(self, z: Array) -> dict[int, float]:
        """Following error over speed of each axis, nominal plant.

        Parameters
        ----------
        z : ndarray

        Returns
        -------
        dict
            [s] by axis.
        """
        gains = self.study.gains(z)
        return {k: part.lag(gains[k]) for k, part in self.study.parts[0].items()}

    def toml(self) -> str:
        """The gains file, for ``motionfmu run SCENARIO --set FILE``.

        Returns
        -------
        str
        """
        lines = [
            f"# Gains of {self.study.scenario.name}, found by motionfmu tune.",
            *(f"# {text}" for text in assumptions(self.study)),
            *(f"# Stopped by: {text}" for text in self.stopped_by),
            *(f"# Lag of axis {k}: {v * 1e3:.4g} ms" for k, v in self.lags(self.z).items()),
        ]
        for name, value in self.settings.items():
            shown = f"[{', '.join(map(repr, value))}]" if isinstance(value, list) else repr(value)
            lines.append(f'"{name}" = {shown}')
        return "\n".join(lines) + "\n"

    def numbers(self) -> dict[str, Any]:
        """Everything as numbers, ready for JSON.

        Returns
        -------
        dict
        """
        study, found = self.study, self.found
        return {
            "scenario": study.scenario.name,
            "problem": study.problem.model_dump(),
            "assumed": assumptions(study),
            "gains": self.settings,
            "lag": {"before": self.lags(study.present), "after": self.lags(self.z)},
            "stopped_by": self.stopped_by,
            "cost": {
                "name": study.problem.cost,
                "plants": study.plants,
                "before": _finite(self.cost(study.present)),
                "after": _finite(self.values.costs),
                "unrounded": _finite(found.values.costs),
                "from_each_start": _finite(np.array(found.starts)),
                "global_search": _finite(np.array([found.check]))[0],
            },
            "tried": {str(v): asdict(x) for v, x in self.trial.tried.items()}
            if self.trial
            else None,
            "seconds": {
                "nlp": found.seconds[0],
                "global_search": found.seconds[1],
                "all": self.seconds,
            },
            "evaluations": dict(zip(("nlp", "global_search"), found.evaluations, strict=True)),
            "margins": {
                "before": [_row(m) for m in self.margins(study.present)],
                "after": [_row(m) for m in self.margins(self.z)],
            },
            "fmus": {
                side: [
                    {
                        "plant": r.plant,
                        "rms": r.fmus.rms,
                        "max": r.fmus.max,
                        "model_rms": r.model.rms,
                        "model_max": r.model.max,
                    }
                    for r in runs
                ]
                for side, runs in (("before", self.before), ("after", self.after))
            },
        }


def _finite(values: Array) -> list[float | None]:
    return [float(v) if np.isfinite(v) else None for v in values]


def _row(m: LoopMargins) -> dict[str, Any]:
    gain = m.gain if np.isfinite(m.gain) else None
    return {
        "axis": m.axis,
        "loop": m.loop,
        "sensitivity": m.sensitivity,
        "gain": gain,
        "phase": m.phase,
    }


def margins(study: Study, z: Array) -> list[LoopMargins]:
    """Least margins of the family with some gains.

    Parameters
    ----------
    study : Study
    z : ndarray

    Returns
    -------
    list of LoopMargins
        One for each axis and loop.
    """
    gains, rows = study.gains(z), []
    for k, nominal in study.parts[0].items():
        for loop in nominal.loops:
            every = [margin(parts[k].loop(loop, gains[k])).values for parts in study.parts]
            least = np.min(every, axis=0)
            wide = float(np.exp(min(least[1], least[2])))
            rows.append(
                LoopMargins(
                    k,
                    loop,
                    float(1.0 / max(least[0], 1e-12)),
                    wide if wide < 999.0 else np.inf,
                    float(np.degrees(least[3])),
                )
            )
    return rows


def settings(study: Study, z: Array) -> dict[str, Any]:
    """Gains as a scenario takes them.

    Parameters
    ----------
    study : Study
    z : ndarray

    Returns
    -------
    dict
        One value, or one for each axis, by ``component.variable``; axes that are not tuned keep
        theirs.
    """
    found: dict[str, Any] = {}
    for variable, share in zip(study.variables, z, strict=True):
        value: float | int = variable.value(float(share))
        value = round(value) if variable.whole else float(f"{value:.6g}")
        port = study.scenario.resolver.end(variable.name, "set", variable.name).port
        if not port.shape:
            found[variable.name] = value
            continue
        listed = found.setdefault(variable.name, list(study.base.parameter(variable.name)))
        for k in variable.axes:
            listed[k - 1] = value
    return found


def assumptions(study: Study) -> list[str]:
    """Feedback side, delays and operating point of the model.

    Parameters
    ----------
    study : Study

    Returns
    -------
    list of str
    """
    axis = study.axes[next(iter(study.axes))]
    found = []
    ports = study.scenario.resolver.ports
    for target, source in axis.wires.items():
        if isinstance(axis.blocks[source[0]], Plant):
            doc = ports[source[0]][source[1]].doc
            found.append(f"Feedback: {'.'.join(target)} reads {'.'.join(source)} ({doc})")
    found.append(f"Judged: {study.signals.position}")
    for name, block in axis.blocks.items():
        grid = f"{block.grid_ns * 1e-3:g} us"
        if isinstance(block, Sampled) and _acts(block):
            found.append(f"Delay: {name} samples every {grid} and shows it one period later")
            if len(block.laws) > 1:
                cycle = f"{block.cycle_ns * 1e-3:g} us"
                found.append(f"Delay: {name} computes its law every {cycle}")
        elif isinstance(block, Plant):
            found.append(f"Delay: {name} holds its input over {grid}")
    found.append(f"Delay: the wires none, communication step {axis.step_ns * 1e-3:g} us")
    found += [f"Worst case: {text}" for text in worst(axis)]
    point = ", ".join(f"{n} = {v:.4g}" for n, v in study.at.items()) or "at rest"
    found.append(f"Operating point: {point}")
    if study.problem.family:
        ranges = ", ".join(f"{n} {lo:g} to {hi:g}" for n, (lo, hi) in study.problem.family.items())
        found.append(f"Plants: nominal and all corners of {ranges}")
    return found


def _acts(block: Sampled) -> bool:
    """Whether an output moves at all."""
    first = len(block.states)
    return bool(block.pattern[first : first + len(block.outputs)].any())


def plant_text(plant: Mapping[str, float]) -> str:
    """A plant in words.

    Parameters
    ----------
    plant : mapping

    Returns
    -------
    str
    """
    return ", ".join(f"{n} = {v:g}" for n, v in plant.items()) or "nominal plant"


def rounded(study: Study, z: Array) -> tuple[Array, Values]:
    """The best whole-number registers about a solution.

    Parameters
    ----------
    study : Study
    z : ndarray

    Returns
    -------
    ndarray
        With the shares of whole numbers; limits are kept, if they can be, rather than the cost.
    Values
    """
    options = []
    whole = [k for k, v in enumerate(study.variables) if v.whole]
    for variable, share in zip(study.variables, z, strict=True):
        value = variable.value(float(share))
        if variable.whole:
            both = {float(np.floor(value)), float(np.ceil(value))}
            kept = sorted(b for b in both if variable.low <= b <= variable.high)
            options.append([variable.share(b) for b in kept or [round(value)]])
        else:
            options.append([variable.share(float(f"{value:.6g}"))])
    if len(whole) > _ONE_BY_ONE:
        corners = [np.array([o[side] for o in options]) for side in (0, -1)]
    else:
        corners = [np.array(c) for c in itertools.product(*options)]
    tried = [(c, study.values(c, False)) for c in corners]
    good = [t for t in tried if t[1].feasible(TOLERANCE)]
    return min(good or tried, key=lambda t: t[1].worst if good else merit(t[1]))


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
    for name in asked.trial:
        loaded.resolver.end(name, "trial", name)
    given = dict(set or {})
    base = loaded.run(set=given, progress=lambda share: progress("path", share))
    study = Study(loaded, asked, base, given)
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
        ran = base if p == 0 else loaded.run(set={**given, **present, **study.plants[p]})
        tuned.before.append(_run(study, study.present, p, ran))
        ran = loaded.run(set={**given, **tuned.settings, **study.plants[p]})
        tuned.after.append(_run(study, z, p, ran))
    tuned.seconds = time.perf_counter() - begun
    return tuned


def _run(study: Study, z: Array, plant: int, result: Result) -> Run:
    model = study.path.error(study.motions(z, plant))
    return Run(study.plants[plant], result, model, study.path.measured(result))


def units_of(cost: str) -> tuple[float, str]:
    """Factor and unit in which a cost is shown.

    Parameters
    ----------
    cost : str

    Returns
    -------
    float
    str
    """
    if cost in ON_PATH:
        return 1e3, "µm"
    return {"ise": (1e3, "ms"), "iae": (1e3, "ms"), "itae": (1e6, "ms^2")}[cost]
