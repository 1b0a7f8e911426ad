"""Looks up every name of a study in its scenario and checks every value."""

from pathlib import Path
from typing import Any

from pydantic import ValidationError

from motionfmu.base.errors import Faults, InputError, suggestion
from motionfmu.base.toml_lines import shown, tables_of, text_of
from motionfmu.run import Options, Scenario
from motionfmu.scenarios import values
from motionfmu.scenarios.system import End
from motionfmu.study import study_axes as ax
from motionfmu.study.study_columns import Column, column, usual
from motionfmu.study.study_file import StudyFile

USUAL_COST = "contour.error.max"  # the cost of a study that names none
_KINDS: dict[str, Any] = {"String": str, "Boolean": bool}


class StudyResolver:
    """Resolves a study's file against its scenario; errors are added to the faults."""

    def __init__(self, file: StudyFile, scenario: Scenario, faults: Faults) -> None:
        self.file, self.scenario, self.faults = file, scenario, faults
        self.body, self.origin = file.body, file.origin
        self._wired = {w.target.name for w in scenario.resolved(Options()).wires}

    def _sound(self, *keys: str) -> bool:
        """Whether these keys have no fault yet."""
        return not self.file.damaged & set(keys)

    def axes(self) -> tuple[ax.Axis, ...]:
        """The axes of the study; one with a fault is left out."""
        if not self.body.axis and self._sound("axis"):
            with self.faults.each():
                text = "nothing is varied: [axis] or --vary wanted"
                raise self.origin.error(text, "", "axis")
        sampling = self.body.sampling if self._sound("sampling") else ""
        found = []
        for name, spec in self.body.axis.items():
            told: list[str] = []
            try:
                axis = ax.Axis(name, self._end(name), _source(name, spec))
                axis.check(sampling)
                found.append(axis)
            except InputError as error:
                told = values.texts(self.scenario.document, error)
            except ValidationError as error:
                told = _told(name, error)
            except ValueError as error:
                told = [str(error)]
            for text in told:
                self.faults.lines += self.origin.error(text, "axis", name).args
        return tuple(found)

    def _end(self, name: str) -> End:
        whole, element = self.scenario.resolver.split(name)
        end = self.scenario.resolver.end(whole, "", "")
        if end.port.causality not in ("parameter", "input"):
            raise ValueError(f"{name} is an {end.port.causality} and cannot be set")
        if whole in self._wired:
            raise ValueError(f"{name} is connected and cannot be set")
        if element is not None and not 0 <= element < end.port.count * bool(end.port.shape):
            raise ValueError(f"{name}: {whole} has no element {element + 1}")
        return end

    def columns(self) -> tuple[Column, ...]:
        """The columns of the study's results; a name with a fault is left out."""
        if not self._sound("results"):
            return ()
        if not self.body.results:
            checked = tuple(usual(self.scenario))
            if self.scenario.document.body.contour and USUAL_COST not in {c.name for c in checked}:
                checked += (column(self.scenario, USUAL_COST),)
            with self.faults.each():
                if not checked:
                    text = "no results: name some, the scenario checks nothing"
                    raise self.origin.error(text, "", "results")
            return checked
        found = []
        for name in dict.fromkeys(self.body.results):
            try:
                found.append(column(self.scenario, name))
            except InputError as error:
                for text in values.texts(self.scenario.document, error):
                    self.faults.lines += self.origin.error(text, "", "results").args
            except ValueError as error:
                self.faults.lines += self.origin.error(str(error), "", "results").args
        return tuple(found)

    def options(self) -> None:
        """Check the values for all runs, and the times."""
        resolver, document = self.scenario.resolver, self.scenario.document
        for name, value in self.body.set.items():
            with self.faults.each():
                try:
                    values.setting(resolver, name, value, {})
                except InputError as error:
                    (text,) = values.unplaced(document, error).args
                    raise self.origin.error(text, "set", name) from None
        times = {k: getattr(self.body, k) for k in ("stop", "step")}
        try:
            self.scenario.resolved(Options(**times))
        except InputError as error:
            for text in values.texts(document, error):
                key = "step" if text.startswith("step") or times["stop"] is None else "stop"
                self.faults.lines += self.origin.error(text, "", key).args

    def runs(self, chosen: tuple[ax.Axis, ...]) -> int:
        """Number of runs that are drawn; 0 if it has a fault."""
        body = self.body
        with self.faults.each():
            if not self._sound("sampling", "runs"):
                return 0
            if body.sampling != "grid":
                if body.runs is None:
                    text = f"sampling {body.sampling!r} wants runs, their number"
                    raise self.origin.error(text, "", "runs")
                return self._bounded(body.runs, "runs")
            if body.runs is not None:
                text = "runs: the number of runs of a grid follows from its axes"
                raise self.origin.error(text, "", "runs")
            if len(chosen) == len(body.axis):
                return self._bounded(ax.count(chosen), "axis")
        return 0

    def _bounded(self, runs: int, key: str) -> int:
        """Refuse more points than memory holds."""
        axes = len(self.body.axis)
        most = min(ax.RUNS_MAX, ax.VALUES_MAX // max(axes, 1))
        if runs > most:
            raise self.origin.error(f"{runs} runs of {axes} axes; {most} are the most", "", key)
        return runs

    def cost(self, columns: tuple[Column, ...]) -> str:
        """The column that is to be small; empty if there is none."""
        names, wanted = [c.name for c in columns], self.body.cost
        if wanted is None:
            return USUAL_COST if USUAL_COST in names else ""
        with self.faults.each():
            # If a result has a fault already, the cost may name just that one.
            told = len(columns) < len(set(self.body.results)) or not self._sound("results")
            if wanted not in names and not told:
                text = f"cost = {wanted!r} is none of the results ({', '.join(names)})"
                raise self.origin.error(f"{text}{suggestion(wanted, names)}", "", "cost")
        return wanted

    def tuned(self, chosen: tuple[ax.Axis, ...]) -> dict[str, ax.Value]:
        """Values of the axes in a gains file; an element takes the value of its whole array."""
        named, origin = self.body.tuned, self.origin
        if named is None:
            return {}
        file = Path(named) if "tuned" in origin.given else self.file.folder / named
        try:
            given = tables_of(text_of(file), file)
        except InputError as error:
            told = str(error).removeprefix(f"{file}: ")
            text = f"tuned = {shown(named)}: {told}"
            self.faults.lines += origin.error(text, "", "tuned").args
            return {}
        found: dict[str, ax.Value] = {}
        for axis in chosen:
            whole, element = self.scenario.resolver.split(axis.name)
            value = given.get(axis.name, given.get(whole))
            if isinstance(value, list):
                index = element if element is not None else 0
                value = value[index] if index < len(value) else None
            if isinstance(value, _KINDS.get(axis.end.port.type, float | int)):
                found[axis.name] = value
                continue
            close = "" if whole in given else suggestion(axis.name, given)
            text = f'{file}: no value "{axis.name}" = ... for the tuned point{close}'
            self.faults.lines.append(text)
        return found


def _source(name: str, spec: Any) -> ax.Source:
    """An axis from a list, from {from, to, n, log} or from {mean, deviation}."""
    if isinstance(spec, list):
        return ax.ListedValues(values=spec)
    if isinstance(spec, dict):
        normal = set(ax.Normal.model_fields) & set(spec)
        return (ax.Normal if normal else ax.Span).model_validate(spec)
    text = f"{name} = {shown(spec)}: a list, {{from, to, n}} or {{mean, deviation}} wanted"
    raise ValueError(text)


def _told(name: str, error: ValidationError) -> list[str]:
    """The faults of an axis; a missing key is left out if an unknown one is meant for it."""
    found: dict[str, str] = {}
    known = [f.alias or key for key, f in _fields(error).items()]
    meant = ""
    for one in sorted(error.errors(), key=lambda e: e["type"] != "extra_forbidden"):
        key = next((str(x) for x in one["loc"]), "")
        if one["type"] == "extra_forbidden":
            close = suggestion(key, known)
            meant += close
            found[key] = f"{name}: unknown key {key!r}{close}"
        elif one["type"] != "missing":
            found.setdefault(key, f"{name}: {key} = {shown(one['input'])}: {_words(one)}")
        elif repr(key) not in meant:
            found[key] = f"{name}: {key} is missing"
    return list(found.values())


def _fields(error: ValidationError) -> dict[str, Any]:
    kinds = {kind.__name__: kind.model_fields for kind in (ax.Span, ax.Normal, ax.ListedValues)}
    return dict(kinds[error.title])


def _words(found: Any) -> str:
    """Pydantic's message, with other words for items of a list."""
    if found["loc"][0] == "values":
        return "it is empty" if not found["input"] else "a number, a text, true or false wanted"
    return str(found["msg"]).lower()
