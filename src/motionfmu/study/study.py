"""A study: which scenario, what is varied, what becomes a column."""

import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from motionfmu.errors import InputError
from motionfmu.run import Options, Scenario, load
from motionfmu.scenarios import fmus
from motionfmu.scenarios.system import End, split
from motionfmu.study import axes as ax
from motionfmu.study.columns import Column, column, usual
from motionfmu.study.study_file import Body, Origin, read
from motionfmu.toml_lines import shown, tables_of, text_of

USUAL_COST = "contour.error.max"  # where none is named


@dataclass(frozen=True)
class Job:
    """All a worker needs to know, without the points."""

    scenario: str  # path of the scenario.toml
    digest: str  # of its files and FMUs; a worker with others refuses
    named: tuple[str, ...]  # texts among the study's values, which may name files
    axes: tuple[str, ...]
    columns: tuple[str, ...]
    set: dict[str, Any]  # values for all runs
    stop: float | None  # instead of the scenario's [s]
    step: float | None  # [s]


@dataclass(frozen=True, repr=False)
class Study:
    """A study whose every name and value was checked.

    Attributes
    ----------
    name, about : str
        Name of the scenario's folder; what the first line of the study's file says.
    axes : tuple of Axis
    columns : tuple of Column
    points : list of tuple
        One value per axis; the order of the rows.
    job : Job
        For the workers.
    sampling, seed : str, int
        How the points were made.
    cost : str
        The column that is to be small; empty if none is.
    tuned : dict
        Values of the tuned point by axis; empty if there is none.
    """

    name: str
    about: str
    axes: tuple[ax.Axis, ...]
    columns: tuple[Column, ...]
    points: list[ax.Point] = field(repr=False)
    job: Job
    sampling: str
    seed: int
    cost: str
    tuned: dict[str, ax.Value]

    def __repr__(self) -> str:
        axes = ", ".join(axis.name for axis in self.axes)
        return f"<Study {self.name}: {len(self.points)} runs over {axes}; cost {self.cost}>"

    @property
    def shown(self) -> str:
        """The column that is drawn: the cost, without one the first."""
        return self.cost or self.columns[0].name

    @property
    def digest(self) -> str:
        """What must be the same for rows to belong together."""
        text = json.dumps([self.job.__dict__, self.points], default=str, sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()


def study(path: str | Path, given: Mapping[str, Any] | None = None) -> Study:
    """Read a study and check it against its scenario.

    Parameters
    ----------
    path : str or Path
        A study's file; or a scenario, whose sweep.toml is taken if there is one.
    given : mapping, optional
        Keys of the file that count instead of what is written there.

    Returns
    -------
    Study

    Raises
    ------
    InputError
        Anything wrong; one message with file, line and value.
    """
    given = {k: v for k, v in (given or {}).items() if v is not None}
    origin, body, about, folder = read(Path(path), given)
    relative = Path(body.scenario)
    try:
        scenario = load(relative if "scenario" in origin.given else folder / relative)
    except InputError as error:
        if str(error).endswith("no such scenario"):
            raise origin.error(str(error), "", "scenario") from None
        raise
    chosen = tuple(_axis(origin, scenario, n, spec) for n, spec in body.axis.items())
    if not chosen:
        raise origin.error("nothing is varied: [axis] or --vary wanted", "", "axis")
    for axis in chosen:
        try:
            axis.check(body.sampling)
        except ValueError as error:
            raise origin.error(str(error), "axis", axis.name) from None
    runs = _runs(origin, body, chosen)
    columns = _columns(origin, scenario, body.results)
    scenario.resolved(Options(set=body.set, stop=body.stop, step=body.step))
    return Study(
        name=scenario.name,
        about=about or scenario.document.about,
        axes=chosen,
        columns=columns,
        points=ax.points(chosen, body.sampling, runs, body.seed),
        job=Job(
            scenario=str(scenario.document.file),
            digest=digest(scenario, _texts(chosen, body.set)),
            named=_texts(chosen, body.set),
            axes=tuple(a.name for a in chosen),
            columns=tuple(c.name for c in columns),
            set=dict(body.set),
            stop=body.stop,
            step=body.step,
        ),
        sampling=body.sampling,
        seed=body.seed,
        cost=_cost(origin, body, columns),
        tuned=_tuned(origin, body, chosen, folder),
    )


def digest(scenario: Scenario, given: Iterable[Any] = ()) -> str:
    """Fingerprint of a scenario, the files it names and its FMUs."""
    # Given values may name files beside the scenario, too.
    names = sorted({*scenario.document.body.component.values(), "scope"})
    found = hashlib.sha256()
    files = [*scenario.document.files, *(fmus.fmu_path(name) for name in names)]
    for value in (*scenario.document.body.set.values(), *given):
        listed = value if isinstance(value, list) else [value]
        texts = (x for x in listed if isinstance(x, str) and x)
        files += [file for x in texts if (file := scenario.document.beside(x))]
    for file in files:
        found.update(hashlib.sha256(file.read_bytes()).digest())
    return found.hexdigest()


def _named(scenario: Scenario, error: InputError) -> str:
    """The message about a name, without the scenario's file."""
    text = str(error)
    return text.partition(": ")[2] if text.startswith(str(scenario.document.file)) else text


def _end(scenario: Scenario, name: str) -> End:
    whole, element = split(name)
    try:
        end = scenario.resolver.end(whole, "", "")
    except InputError as error:
        raise ValueError(_named(scenario, error)) from None
    if end.port.causality not in ("parameter", "input"):
        raise ValueError(f"{name} is an {end.port.causality} and cannot be set")
    if whole in {w.target.name for w in scenario.resolved(Options()).wires}:
        raise ValueError(f"{name} is connected and cannot be set")
    if element is not None and not 0 <= element < end.port.count * bool(end.port.shape):
        raise ValueError(f"{name}: {whole} has no element {element + 1}")
    return end


def _axis(origin: Origin, scenario: Scenario, name: str, spec: Any) -> ax.Axis:
    """An axis from a list, from {from, to, n, log} or from {mean, deviation}."""
    try:
        end = _end(scenario, name)
        if isinstance(spec, list):
            source: ax.Source = ax.Listed(values=spec)
        elif isinstance(spec, dict):
            source = (ax.Normal if "mean" in spec else ax.Span).model_validate(spec)
        else:
            text = f"{name} = {shown(spec)}: a list, {{from, to, n}} or {{mean, deviation}} wanted"
            raise origin.error(text, "axis", name)
    except ValidationError as error:
        found = error.errors()[0]
        key = next((str(x) for x in found["loc"]), "")
        if found["type"] == "extra_forbidden":
            text = f"{name}: unknown key {key!r}"
        elif found["type"] == "missing":
            text = f"{name}: {key} is missing"
        else:
            text = f"{name}: {key} = {shown(found['input'])}: {found['msg'].lower()}"
        raise origin.error(text, "axis", name) from None
    except ValueError as error:
        if isinstance(error, InputError):
            raise
        raise origin.error(str(error), "axis", name) from None
    return ax.Axis(name, end, source)


def _texts(chosen: tuple[ax.Axis, ...], given: Mapping[str, Any]) -> tuple[str, ...]:
    lists = [a.source.values for a in chosen if isinstance(a.source, ax.Listed)]
    lists += [v if isinstance(v, list) else [v] for v in given.values()]
    return tuple(x for values in lists for x in values if isinstance(x, str))


def _runs(origin: Origin, body: Body, chosen: tuple[ax.Axis, ...]) -> int:
    if body.sampling != "grid":
        if body.runs is None:
            raise origin.error(f"sampling {body.sampling!r} wants runs, their number", "", "runs")
        return _bounded(origin, body.runs, len(chosen), "runs")
    if body.runs is not None:
        raise origin.error("runs: the number of runs of a grid follows from its axes", "", "runs")
    return _bounded(origin, ax.count(chosen), len(chosen), "axis")


def _bounded(origin: Origin, runs: int, axes: int, key: str) -> int:
    """Refuse more points than memory holds."""
    most = min(ax.RUNS_MAX, ax.VALUES_MAX // axes)
    if runs > most:
        raise origin.error(f"{runs} runs of {axes} axes; {most} are the most", "", key)
    return runs


def _columns(origin: Origin, scenario: Scenario, names: list[str]) -> tuple[Column, ...]:
    if not names:
        if checked := tuple(usual(scenario)):
            return checked
        text = "no results: name some, the scenario checks nothing"
        raise origin.error(text, "", "results")
    found = []
    for name in dict.fromkeys(names):
        try:
            found.append(column(scenario, name))
        except InputError as error:
            raise origin.error(_named(scenario, error), "", "results") from None
        except ValueError as error:
            raise origin.error(str(error), "", "results") from None
    return tuple(found)


def _cost(origin: Origin, body: Body, columns: tuple[Column, ...]) -> str:
    names = [c.name for c in columns]
    if body.cost is None:
        return USUAL_COST if USUAL_COST in names else ""
    if body.cost not in names:
        text = f"cost = {body.cost!r} is none of the results ({', '.join(names)})"
        raise origin.error(text, "", "cost")
    return body.cost


def _tuned(
    origin: Origin, body: Body, chosen: tuple[ax.Axis, ...], folder: Path
) -> dict[str, ax.Value]:
    """Values of a gains file at the axes; an element takes that of its whole array."""
    if body.tuned is None:
        return {}
    file = Path(body.tuned) if "tuned" in origin.given else folder / body.tuned
    try:
        text = text_of(file)
    except InputError as error:
        told = str(error).removeprefix(f"{file}: ")
        raise origin.error(f"tuned = {shown(body.tuned)}: {told}", "", "tuned") from None
    values = tables_of(text, file)
    found: dict[str, ax.Value] = {}
    for axis in chosen:
        whole, element = split(axis.name)
        value = values.get(axis.name, values.get(whole))
        if isinstance(value, list):
            index = element if element is not None else 0
            value = value[index] if index < len(value) else None
        kinds: dict[str, Any] = {"String": str, "Boolean": bool}
        if not isinstance(value, kinds.get(axis.end.port.type, float | int)):
            raise InputError(f'{file}: no value "{axis.name}" = ... for the tuned point')
        found[axis.name] = value
    return found
