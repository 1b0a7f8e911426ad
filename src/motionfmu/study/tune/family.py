"""The linear models of a tuning: a family of plants, and the gains that vary in them."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from motionfmu.analysis import linear
from motionfmu.analysis.linear.axis import AxisModel
from motionfmu.base.errors import InputError
from motionfmu.run import Result, Scenario
from motionfmu.study.tune import choice
from motionfmu.study.tune.axis_study import AxisStudy
from motionfmu.study.tune.problem import CONTOUR, ON_PATH, Problem
from motionfmu.study.tune.steps import Array


class Family:
    """Models of all plants and axes, and the gains of each at a point.

    `more` are plants beside those of the problem.
    """

    def __init__(
        self,
        scenario: Scenario,
        problem: Problem,
        base: Result,
        set: Mapping[str, Any],
        more: Sequence[Mapping[str, float]] = (),
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
        elif problem.cost in ON_PATH:
            self.at = self.at or choice.mean_speed(one, base, problem.position)
        self.axes = {k: linear.model(scenario, k, at=self.at, set=self.set) for k in used}
        self.names = choice.gains(one, problem)
        self.variables = choice.variables(self.axes, self.names, problem)
        self.signals, self.peaks = choice.signals(one, problem)
        self._check_family()
        self.plants = [*problem.plants(), *map(dict, more)]
        bent = on_contour or problem.cost in ON_PATH
        self.parts = [self._studies(plant, bent) for plant in self.plants]

    def _studies(self, plant: Mapping[str, float], bent: bool) -> dict[int, AxisStudy]:
        """The studies of all axes with one plant; equal axes share one study."""
        found: dict[int, AxisStudy] = {}
        axes = {k: axis.changed(dict(plant)) if plant else axis for k, axis in self.axes.items()}
        for k, axis in axes.items():
            like = [j for j in found if axes[j].alike(axis)]
            found[k] = found[like[0]] if like else AxisStudy(axis, self.names, self.signals, bent)
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

    def still(self, z: Array, plant: Mapping[str, float]) -> list[AxisStudy]:
        """Studies without variables, of margins and steps, of the axes that are not alike."""
        # numbers instead of expressions: a twentieth of the time
        found: list[AxisModel] = []
        for k, gains in self.gains(z).items():
            ports = (self.scenario.resolver.end(n, "set", n).port for n in self.names)
            exact = [
                round(g) if p.type == "Int32" else g for g, p in zip(gains, ports, strict=True)
            ]
            axis = self.axes[k].changed({**plant, **dict(zip(self.names, exact, strict=True))})
            if not any(axis.alike(other) for other in found):
                found.append(axis)
        return [AxisStudy(axis, (), self.signals, False) for axis in found]

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
