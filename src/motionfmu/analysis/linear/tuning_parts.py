"""Parts of a linear model that a tuning needs: matrices with open gains, plants, limits."""

import math
from collections.abc import Iterable

from motionfmu.analysis.linear import law
from motionfmu.analysis.linear.axis import AxisModel
from motionfmu.analysis.linear.block import Matrix
from motionfmu.analysis.linear.parts import equation
from motionfmu.analysis.linear.plant import Linearised
from motionfmu.analysis.linear.wiring import PeriodMap, period_of


def matrices(
    axis: AxisModel, inputs: Iterable[str], outputs: Iterable[str], cut: Iterable[str] = ()
) -> PeriodMap:
    """The matrices of `AxisModel.system`, also with open gains."""
    # If a value is a `Gain`, they are arrays of objects: floats and CasADi expressions.
    entries = [axis.port(n, axis.inputs, "input") for n in inputs]
    exits = [axis.port(n, axis.outputs, "output") for n in outputs]
    return period_of(axis.net(cut, {}), entries, exits, axis.scenario.document.file)


def linearised(axis: AxisModel, component: str) -> tuple[Linearised, Matrix]:
    """The functions of a plant, and its parameters in this model."""
    parts = equation(axis.scenario.document.body.component[component])
    own = axis.values(component)
    return parts, parts.parameters({d.name: own[d.name] for d in parts.ode.parameters})


def limit(axis: AxisModel, name: str) -> float:
    """Largest magnitude of an output; infinite if its law says none."""
    component, _, variable = name.partition(".")
    said = law.carried(axis.scenario.document.body.component[component])
    if not isinstance(said, law.Law) or variable not in said.limit:
        return math.inf
    return law.number(said, axis.values(component), said.limit[variable])


def listed(axis: AxisModel, kind: str) -> list[str]:
    """Parameters that the laws let a tuning change, by their kind."""
    # The kinds are position, velocity and feed_forward.
    found = []
    for component, fmu in axis.scenario.document.body.component.items():
        own = law.carried(fmu)
        if isinstance(own, law.Law):
            found += [f"{component}.{n}" for n, k in own.gain.items() if k == kind]
    return found


def worst(axis: AxisModel) -> list[str]:
    """``component: what`` for all that the model assumes to be the worst case."""
    # There is none if the running FMUs do what the model does.
    found = []
    for component in axis.blocks:
        own = law.carried(axis.scenario.document.body.component[component])
        if isinstance(own, law.Law):
            values = axis.values(component)
            told = [t for formula, t in own.worst.items() if law.number(own, values, formula)]
            found += [f"{component}: {t}" for t in told]
    return found


def held(axis: AxisModel) -> str:
    """In words, the inputs at the operating point that nobody stated."""
    kept = [f"{c}.{n} = {v:g}" for c, p in axis.points.items() for n, v in p.held.items()]
    return f"Not stated, kept as the scenario has them: {', '.join(kept)}" if kept else ""
