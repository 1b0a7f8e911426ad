"""Search of a parameter that no linear model has, by running the FMUs."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from motionfmu.base.errors import InputError
from motionfmu.run import Scenario, Session
from motionfmu.study.tune.move import MoveCost
from motionfmu.study.tune.path_error import EVERY
from motionfmu.study.tune.solve import RanAway

# Numbers of values that are tried at first and in each finer round; costs within this share are
# equal.
_COARSE, _FINE, _ROUNDS, _SAME = 13, 5, 2, 0.05


@dataclass(frozen=True)
class Look:
    """The result of a run with one value."""

    cost: float  # RMS error while the axis should stand still [mm]
    beyond: float  # overshoot past the ends of the move [mm]


@dataclass(frozen=True)
class Trial:
    """The values that were tried, and the best of them."""

    name: str  # component.variable
    value: float  # the smallest whose cost is as small as any within the limit
    tried: Mapping[float, Look]  # in order
    limit: float  # largest way beyond that is allowed [mm]

    @property
    def stopped_by(self) -> str:
        """In words, what keeps the value from being smaller."""
        values = list(self.tried)
        k = values.index(self.value)
        text = (
            f"{self.name} = {self.value:g}, tried: {_um(self.tried[self.value].cost)} left at rest"
        )
        text += f"; {values[k - 1]:g} leaves {_um(self.tried[values[k - 1]].cost)}"
        for value in values[k:]:
            if self.tried[value].beyond > self.limit:
                return f"{text}, {value:g} goes {_um(self.tried[value].beyond)} beyond"
        worst = max(values[k:], key=lambda v: self.tried[v].cost)
        return f"{text}, {worst:g} {_um(self.tried[worst].cost)}"


def _um(length: float) -> str:
    return f"{length * 1e3:.3g} µm"


def tried(
    scenario: Scenario,
    move: MoveCost,
    asked: tuple[str, tuple[float, float], float],
    set: Mapping[str, Any],
    progress: Callable[[float], None] = lambda share: None,
) -> Trial:
    """Run the FMUs with values of a parameter between two bounds.

    `asked` has the parameter, its bounds, and the largest overshoot [mm]; `set` has the gains that
    were found. `RanAway` if the best value is a bound.
    """
    name, (low, high), limit = asked
    port = scenario.resolver.end(name, "trial", name).port
    whole = port.type == "Int32"
    found: dict[float, Look] = {}

    fixed = {n: v for n, v in set.items() if n != name}
    with Session(scenario, [name], set=fixed, every=EVERY) as session:

        def look(values: Any) -> None:
            for value in values:
                number = round(float(value)) if whole else float(f"{value:.4g}")
                if number not in found:
                    ran = session.run({name: number})
                    found[number] = Look(move.standing(ran), move.beyond(ran))
                    progress(len(found) / (_COARSE + _FINE * _ROUNDS))

        look(np.geomspace(low, high, _COARSE))
        for _ in range(_ROUNDS):
            values = sorted(found)
            k = values.index(_least(found, limit))
            around = values[max(k - 1, 0)], values[min(k + 1, len(values) - 1)]
            look(np.geomspace(*around, _FINE + 2)[1:-1])
    values = sorted(found)
    value = _least(found, limit)
    if value in (values[0], values[-1]):
        side = "lower" if value == values[0] else "upper"
        raise RanAway(
            f"{scenario.document.file}: {name} ran to its own {side} bound {value:g}: nothing"
            " stops it there, so this is no result; give other bounds"
        )
    return Trial(name, value, {v: found[v] for v in values}, limit)


def _least(found: Mapping[float, Look], limit: float) -> float:
    """The smallest value whose cost is as small as any within the limit."""
    kept = {v: look.cost for v, look in found.items() if look.beyond <= limit}
    if not kept:
        v, look = min(found.items(), key=lambda pair: pair[1].beyond)
        raise InputError(f"limits.beyond = {limit:g}: missed by all; {v:g} goes {_um(look.beyond)}")
    best = min(kept.values())
    return min(v for v, cost in kept.items() if cost <= (1.0 + _SAME) * best)
