"""The cycle time if one limit were lifted.

The limits.toml in an FMU lists its limits and how each is lifted.
"""

import functools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from motionfmu.analysis.cycle_time.program_plan import (
    CommandedMotion,
    planned,
)
from motionfmu.base.errors import InputError
from motionfmu.base.toml_lines import tables_of
from motionfmu.run import Scenario
from motionfmu.run.controller_plan import Controller, controller_of
from motionfmu.scenarios import fmus

FILE = "limits.toml"
SHARE = 0.25


class LimitLift(BaseModel):
    """How a limit is lifted: a variable of power p becomes (1 + share)**p times as large."""

    model_config = ConfigDict(extra="forbid", strict=True)
    title: str
    power: dict[str, int] = Field(default_factory=dict)  # together
    each: dict[str, int] = Field(default_factory=dict)  # axis by axis


@dataclass(frozen=True)
class Lifted:
    """A limit that is lifted.

    Attributes
    ----------
    title : str
        Of the limit.
    axis : str
        Of which it is; empty for one of all.
    set : dict
        The values that lift it, by ``component.variable``.
    time : float
        Cycle time with them [s].
    saved : float
        By how much that is shorter [s].
    """

    title: str
    axis: str
    set: dict[str, Any]
    time: float
    saved: float


@functools.cache
def of_fmu(name: str) -> dict[str, LimitLift]:
    """A built FMU's limits.toml, if any."""
    text = fmus.extra(name, FILE)
    if text is None:
        return {}
    where = f"fmus/{name}/{FILE}"
    try:
        found = {k: LimitLift.model_validate(v) for k, v in tables_of(text, where).items()}
    except ValidationError as error:
        raise InputError(f"{where}: {' '.join(str(error).split())}") from None
    ports = fmus.ports(name)
    for key, limit in found.items():
        if unknown := [n for n in (*limit.power, *limit.each) if n not in ports]:
            raise InputError(f"{where}: [{key}]: {name} has no variable {unknown[0]!r}")
    return found


def what_if(
    scenario: Scenario,
    plan: CommandedMotion | None = None,
    *,
    set: Mapping[str, Any] | None = None,
    share: float = SHARE,
) -> list[Lifted]:
    """Plan a program again and again, each time with one limit lifted.

    Parameters
    ----------
    scenario : Scenario
    plan : CommandedMotion, optional
        With no limit lifted; planned if it is not given.
    set : mapping, optional
        Values by ``component.variable``, stronger than the scenario's.
    share : float
        By how much a limit is lifted, above 0.

    Returns
    -------
    list of Lifted
        What saves most first; limits that are switched off are left out.

    Raises
    ------
    InputError
        As of `planned`; or `share` is not above 0.
    """
    if not share > 0.0:
        raise InputError(f"share = {share:g}: above 0 wanted")
    base = planned(scenario, set) if plan is None else plan
    found = []
    controller = controller_of(scenario, set or {})
    for title, axis, values in _lifts(controller, 1.0 + share, base.axes):
        time = planned(scenario, {**(set or {}), **values}).time
        found.append(Lifted(title, axis, values, time, base.time - time))
    return sorted(found, key=lambda one: -one.saved)


def _lifts(
    found: Controller, factor: float, axes: tuple[str, ...]
) -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Title, axis and values of each limit that acts."""
    name, ports = found.name, fmus.ports(found.fmu)
    used = found.values("active") if "active" in ports else (True,) * len(axes)
    for limit in of_fmu(found.fmu).values():
        together = {
            v: [float(x) * factor**p for x in found.values(v)] for v, p in limit.power.items()
        }
        if any(any(listed) for listed in together.values()):
            pairs = together.items()
            values = {f"{name}.{v}": x if ports[v].shape else x[0] for v, x in pairs}
            yield limit.title, "", values
        for variable, power in limit.each.items():
            for k, x in enumerate(found.values(variable)):
                if x and used[k]:
                    yield (
                        limit.title,
                        axes[k],
                        {f"{name}.{variable}[{k + 1}]": float(x) * factor**power},
                    )
