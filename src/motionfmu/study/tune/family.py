"""The linear models of a tuning: a family of plants, and the gains that vary in them."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from motionfmu.analysis import linear
from motionfmu.analysis.linear.axis import AxisModel
from motionfmu.base.errors import InputError
from motionfmu.run import Result, Scenario
from motionfmu.study.tune import choice
from motionfmu.study.tune.axis_study import AxisStudy
from motionfmu.study.tune.problem import CONTOUR, Problem
from motionfmu.study.tune.steps import Array


class Family:
    """Models of all plants and axes, and the gains of each at a point."""

    def __init__(
        self, scenario: Scenario, problem: Problem, base: Result, set: Mapping[str, Any]
    ) -> None:
        self.scenario, self.problem, self.base, self.set = scenario, problem, base, dict(set)
        on_contour = problem.command is None
        used = [i + 1 for i in base.contour().run.axes if i < 3] if on_contour else [1]
        one = linear.model(scenario, used[0], set=self.set)
        self.at = dict(problem.at)  # operating point of the plants
        if on_contour:
            self.at = self.at or choice.operating_point(one, base)
        elif (problem.cost in CONTOUR) or problem.position is None:
            raise InputError(
                f"cost = {problem.cost!r}: of [contour] tables; one of the others with command"
            )
        self.axes = {k: linear.model(scenario, k, at=self.at, set=self.set) for k in used}
        self.names = choice.gains(one, problem)
        self.variables = choice.variables(self.axes, self.names, problem)
        self.signals, self.peaks = choice.signals(one, problem)
        self.plants = problem.plants()
        self._check_family()
        self.parts = [self._studies(plant, on_contour) for plant in self.plants]

    def _studies(self, plant: Mapping[str, float], bent: bool) -> dict[int, AxisStudy]:
        """The studies of all axes with one plant; equal axes share one study."""
        found: dict[int, AxisStudy] = {}
        for k, axis in self.axes.items():
            like = [j for j in found if self.axes[j].alike(axis)]
            found[k] = (
                found[like[0]]
                if like
                else AxisStudy(_changed(axis, plant), self.names, self.signals, bent)
            )
        return found

    def _check_family(self) -> None:
        one = next(iter(self.axes.values()))
        for name, ends in self.problem.family.items():
            component, _, variable = name.partition(".")
            if component not in one.points or variable not in self.scenario.resolver.ports.get(
                component, {}
            ):
                plants = ", ".join(one.points)
                raise InputError(
                    f"family.{name} = {list(ends)}: no parameter of a plant ({plants})"
                )

    def gains(self, z: Array) -> dict[int, Array]:
        """Gains (g,) of each axis at shares of the variables' ranges."""
        found = {k: np.empty(len(self.names)) for k in self.axes}
        for variable, share in zip(self.variables, z, strict=True):
            for k in variable.axes:
                found[k][self.names.index(variable.name)] = variable.value(float(share))
        return found

    @property
    def present(self) -> Array:
        """The point of the scenario's present gains."""
        return np.array([v.share(v.start) for v in self.variables])

    def rates(self, z: Array) -> dict[int, Array]:
        """Derivatives of each axis' gains to the shares: (g, n)."""
        found = {k: np.zeros((len(self.names), len(z))) for k in self.axes}
        for column, (variable, share) in enumerate(zip(self.variables, z, strict=True)):
            for k in variable.axes:
                value = variable.value(float(share))
                found[k][self.names.index(variable.name), column] = variable.slope(value)
        return found


def _changed(axis: AxisModel, plant: Mapping[str, float]) -> AxisModel:
    return axis.changed(dict(plant)) if plant else axis
