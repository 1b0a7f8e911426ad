"""The cycle time if one limit were lifted.

The limits.toml in an FMU lists its limits and how each is lifted.
"""

import functools
import zipfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from motionfmu.analysis.cycle_time.program_plan import (
    AXES,
    CommandedMotion,
    controller,
    planned,
    settings,
)
from motionfmu.base.errors import InputError
from motionfmu.base.toml_lines import tables_of
from motionfmu.fmu.archive_names import EXTRA
from motionfmu.scenarios import fmus
from motionfmu.scenarios.values import start_values

if TYPE_CHECKING:
    from motionfmu.run import Scenario
    from motionfmu.scenarios.fmus import Port

RESOURCE = f"{EXTRA}/limits.toml"
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
    with zipfile.ZipFile(fmus.fmu_path(name)) as archive:
        if RESOURCE not in archive.namelist():
            return {}
        text = archive.read(RESOURCE).decode()
    where = f"fmus/{name}/limits.toml"
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
    scenario: "Scenario",
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
    fmu = scenario.document.body.component[name]
    values = _Values(name, fmus.ports(fmu), scenario, set)
    for limit in of_fmu(fmu).values():
        together = {v: [x * factor**p for x in values.of(v)] for v, p in limit.power.items()}
        if any(any(listed) for listed in together.values()):
            yield limit.title, "", dict(values.given(v, listed) for v, listed in together.items())
        for variable, power in limit.each.items():
            for k, x in enumerate(values.of(variable)):
                if x and values.used[k]:
                    key = f"{name}.{variable}[{k + 1}]"
                    yield limit.title, axes[k], {key: x * factor**power}


class _Values:
    """Parameters of a controller in a run, as lists."""

    def __init__(
        self, name: str, ports: "Mapping[str, Port]", scenario: "Scenario", set: Mapping[str, Any]
    ) -> None:
        self._name, self._ports = name, ports
        self._set = {s.end.name: s.values for s in settings(scenario, set)}
        self.used = self.of("active") if "active" in ports else [1.0] * len(AXES)

    def of(self, variable: str) -> list[float]:
        port = self._ports[variable]
        values = self._set.get(f"{self._name}.{variable}") or start_values(port)
        return [float(v) for v in (values if len(values) == port.count else values * port.count)]

    def given(self, variable: str, listed: list[float]) -> tuple[str, Any]:
        """Name and value as a run takes them."""
        shape = self._ports[variable].shape
        return f"{self._name}.{variable}", listed if shape else listed[0]
