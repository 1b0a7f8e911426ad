"""A parameter that no linear model knows, looked for by running the FMUs."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from motionfmu.run import Scenario
from motionfmu.tune.move import MoveCost
from motionfmu.tune.solve import RanAway

# Values of the first look, and of each finer one; costs within this share are the same.
_COARSE, _FINE, _ROUNDS, _SAME = 13, 5, 2, 0.05


@dataclass(frozen=True)
class Trial:
    """What was tried.

    Attributes
    ----------
    name : str
        Parameter, ``component.variable``.
    value : float or int
        The smallest value with which the cost is as small as with any.
    tried : dict
        RMS error of the standing axis [mm] by value, in order.
    """

    name: str
    value: float
    tried: Mapping[float, float]

    @property
    def stopped_by(self) -> str:
        """What it is stopped by, in words."""
        values = list(self.tried)
        k = values.index(self.value)
        best = self.tried[self.value]
        text = f"{self.name} = {self.value:g}, tried: {best * 1e3:.3g} um of error at rest"
        text += f"; {values[k - 1]:g} leaves {self.tried[values[k - 1]] * 1e3:.3g} um"
        worst = max(values[k:], key=lambda v: self.tried[v])
        if self.tried[worst] > (1.0 + _SAME) * best:
            text += f", {worst:g} {self.tried[worst] * 1e3:.3g} um"
        return text


def tried(
    scenario: Scenario,
    move: MoveCost,
    asked: tuple[str, tuple[float, float]],
    set: Mapping[str, Any],
    progress: Callable[[float], None] = lambda share: None,
) -> Trial:
    """Run the FMUs with values of a parameter between two bounds.

    Parameters
    ----------
    scenario : Scenario
    move : MoveCost
        Judges a run.
    asked : tuple
        The parameter and its bounds.
    set : mapping
        Values by ``component.variable``, the gains found among them.
    progress : callable
        Called with the share done.

    Returns
    -------
    Trial

    Raises
    ------
    RanAway
        The best value is a bound of the search.
    InputError
        The name or a bound is wrong.
    """
    name, (low, high) = asked
    port = scenario.resolver.end(name, "trial", name).port
    whole = port.type == "Int32"
    found: dict[float, float] = {}

    def look(values: Any) -> None:
        for value in values:
            number = round(float(value)) if whole else float(f"{value:.4g}")
            if number not in found:
                found[number] = move.standing(scenario.run(set={**set, name: number}))
                progress(len(found) / (_COARSE + _FINE * _ROUNDS))

    look(np.geomspace(low, high, _COARSE))
    for _ in range(_ROUNDS):
        values = sorted(found)
        k = values.index(_least(found))
        around = values[max(k - 1, 0)], values[min(k + 1, len(values) - 1)]
        look(np.geomspace(*around, _FINE + 2)[1:-1])
    values = sorted(found)
    value = _least(found)
    if value in (values[0], values[-1]):
        side = "lower" if value == values[0] else "upper"
        raise RanAway(
            f"{scenario.document.file}: {name} ran to its own {side} bound {value:g}: nothing"
            " stops it there, so this is no result; give other bounds"
        )
    return Trial(name, value, {v: found[v] for v in values})


def _least(found: Mapping[float, float]) -> float:
    """The smallest value whose cost is as small as any."""
    best = min(found.values())
    return min(v for v, cost in found.items() if cost <= (1.0 + _SAME) * best)
