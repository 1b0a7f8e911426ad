"""Parts of a linear model that a tuning needs: matrices with open gains, plants, limits."""

import math
from collections.abc import Iterable

from motionfmu.linear import law
from motionfmu.linear.axis import AxisModel
from motionfmu.linear.block import Matrix
from motionfmu.linear.parts import equation
from motionfmu.linear.plant import Linearised
from motionfmu.linear.wiring import PeriodMap, period_of


def matrices(
    axis: AxisModel, inputs: Iterable[str], outputs: Iterable[str], cut: Iterable[str] = ()
) -> PeriodMap:
    """The matrices of `AxisModel.system`, also with open gains.

    Parameters
    ----------
    axis : AxisModel
        Changed to values that may be `motionfmu.linear.form.Gain`.
    inputs, outputs, cut : iterable of str
        As in `AxisModel.system`.

    Returns
    -------
    PeriodMap
        Of objects, floats and CasADi expressions, where a gain is a `Gain`.

    Raises
    ------
    InputError
        As in `AxisModel.system`.
    """
    entries = [axis.port(n, axis.inputs, "input") for n in inputs]
    exits = [axis.port(n, axis.outputs, "output") for n in outputs]
    return period_of(axis.net(cut, {}), entries, exits, axis.scenario.document.file)


def linearised(axis: AxisModel, component: str) -> tuple[Linearised, Matrix]:
    """The functions of a plant, and its parameters in this model.

    Parameters
    ----------
    axis : AxisModel
    component : str
        A plant.

    Returns
    -------
    Linearised
    ndarray, shape (n_p,)
    """
    parts = equation(axis.scenario.document.body.component[component])
    own = axis.values(component)
    return parts, parts.parameters({d.name: own[d.name] for d in parts.ode.parameters})


def limit(axis: AxisModel, name: str) -> float:
    """Largest magnitude of an output, as its law says.

    Parameters
    ----------
    axis : AxisModel
    name : str
        ``component.variable``.

    Returns
    -------
    float
        Infinite if the law says none.
    """
    component, _, variable = name.partition(".")
    said = law.carried(axis.scenario.document.body.component[component])
    if not isinstance(said, law.Law) or variable not in said.limit:
        return math.inf
    return law.number(said, axis.values(component), said.limit[variable])


def listed(axis: AxisModel, kind: str) -> list[str]:
    """Parameters that a tuning may change, as the laws say.

    Parameters
    ----------
    axis : AxisModel
    kind : str
        ``position``, ``velocity`` or ``feed_forward``.

    Returns
    -------
    list of str
        ``component.variable``.
    """
    found = []
    for component, fmu in axis.scenario.document.body.component.items():
        own = law.carried(fmu)
        if isinstance(own, law.Law):
            found += [f"{component}.{n}" for n, k in own.gain.items() if k == kind]
    return found


def worst(axis: AxisModel) -> list[str]:
    """Where the model is a worst case.

    The worst that an FMU can become, not what it does.

    Parameters
    ----------
    axis : AxisModel

    Returns
    -------
    list of str
        ``component: what``; empty if the running FMUs do what the model does.
    """
    found = []
    for component in axis.blocks:
        own = law.carried(axis.scenario.document.body.component[component])
        if isinstance(own, law.Law):
            values = axis.values(component)
            told = [t for formula, t in own.worst.items() if law.number(own, values, formula)]
            found += [f"{component}: {t}" for t in told]
    return found


def held(axis: AxisModel) -> str:
    """Inputs beside the operating point that nobody stated.

    Parameters
    ----------
    axis : AxisModel

    Returns
    -------
    str
        In words; empty if there are none.
    """
    kept = [f"{c}.{n} = {v:g}" for c, p in axis.points.items() for n, v in p.held.items()]
    return f"Not stated, kept as the scenario has them: {', '.join(kept)}" if kept else ""
