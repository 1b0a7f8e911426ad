"""The cycle time if one limit were lifted.

The limits.toml in an FMU lists its limits and how each is lifted.
"""

import functools
import zipfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from motionfmu.analysis.cycle_time.program_plan import Plan, controller, planned
from motionfmu.base.errors import InputError
from motionfmu.base.toml_lines import tables_of
from motionfmu.fmu.archive_names import EXTRA
from motionfmu.scenarios import fmus
from motionfmu.scenarios.values import start_values

if TYPE_CHECKING:
    from motionfmu.run import Scenario

RESOURCE = f"{EXTRA}/limits.toml"
SHARE = 0.25


class Limit(BaseModel):
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
def of_fmu(name: str) -> dict[str, Limit]:
    """A built FMU's limits.toml, if any."""
    with zipfile.ZipFile(fmus.fmu_path(name)) as archive:
        if RESOURCE not in archive.namelist():
            return {}
        text = archive.read(RESOURCE).decode()
    where = f"fmus/{name}/limits.toml"
    try:
        found = {k: Limit.model_validate(v) for k, v in tables_of(text, where).items()}
    except ValidationError as error:
        raise InputError(f"{where}: {' '.join(str(error).split())}") from None
    ports = fmus.ports(name)
    for key, limit in found.items():
        if unknown := [n for n in (*limit.power, *limit.each) if n not in ports]:
            raise InputError(f"{where}: [{key}]: {name} has no variable {unknown[0]!r}")
    return found


def what_if(
    scenario: "Scenario",
    plan: Plan | None = None,
    *,
    set: Mapping[str, Any] | None = None,
    share: float = SHARE,
) -> list[Lifted]:
    """Plan a program again and again, each time with one limit lifted.

    Parameters
    ----------
    scenario : Scenario
    plan : Plan, optional
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
    for title, axis, values in _lifts(scenario, set or {}, 1.0 + share, base.axes):
        time = planned(scenario, {**(set or {}), **values}).time
        found.append(Lifted(title, axis, values, time, base.time - time))
    return sorted(found, key=lambda one: -one.saved)


def _lifts(
    scenario: "Scenario", set: Mapping[str, Any], factor: float, axes: tuple[str, ...]
) -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Title, axis and values of each limit that acts."""
    name = controller(scenario, set)
    if name is None:
        return
    ports = fmus.ports(scenario.document.body.component[name])
    from motionfmu.run.run_plan import Options

    given = {s.end.name: s.values for s in scenario.resolved(Options(set=set)).settings}

    def of(variable: str) -> list[float]:
        values = given.get(f"{name}.{variable}") or start_values(ports[variable])
        count = ports[variable].count
        return [float(v) for v in (values if len(values) == count else values * count)]

    used = of("active") if "active" in ports else []
    for limit in of_fmu(scenario.document.body.component[name]).values():
        lifted = {v: [x * factor**p for x in of(v)] for v, p in limit.power.items()}
        if any(any(x) for x in lifted.values()):
            pairs = lifted.items()
            values = {f"{name}.{v}": x if ports[v].shape else x[0] for v, x in pairs}
            yield limit.title, "", values
        for variable, power in limit.each.items():
            for k, x in enumerate(of(variable)):
                if x and (not used or used[k]):
                    key = f"{name}.{variable}[{k + 1}]"
                    yield limit.title, axes[k], {key: x * factor**power}
