"""Causes of contour error, and how each is switched off.

The causes.toml in an FMU lists what it can switch off. A cause of a scenario is switched off in all
FMUs that have it.
"""

import functools
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from motionfmu.analysis.explain.parameter_expression import evaluate
from motionfmu.base.errors import InputError
from motionfmu.base.toml_lines import tables_of
from motionfmu.scenarios import fmus

if TYPE_CHECKING:
    from motionfmu.run import Result, Scenario
    from motionfmu.scenarios.fmus import Port

FILE = "causes.toml"
THEORY = "theory"
AXES = 6
INT_MAX = 2**31 - 1
# Titles of the common causes; an FMU may have others, with titles of their own.
TITLES = {
    "chord": "Interpolation (chord)",
    "quantisation": "Quantisation (pulses, encoder)",
    "mismatch": "Mismatch of the axes",
    "friction": "Friction (reversal)",
    "backlash": "Backlash (reversal)",
    "scale": "Lead error of the screw",
    "torque": "Torque limit of the drive",
    "voltage": "Voltage limit of the card",
}


class Switch(BaseModel):
    """How one FMU switches one cause off."""

    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)
    title: str = ""  # what pages call it; common causes have a title
    set: dict[str, float] = Field(default_factory=dict)  # value by parameter
    times: dict[str, float] = Field(default_factory=dict)  # factor by parameter
    plus: dict[str, float] = Field(default_factory=dict)  # what is added, by parameter
    mean: list[str] = Field(default_factory=list)  # parameters that become the mean of all axes
    # parameters that may stop at their limits; others then cannot be switched off
    limit: list[str] = Field(default_factory=list)
    after: str = ""  # cause that is off in both runs whose difference is this one's effect
    # value by output: it must have come so far, or the cause is absent
    reached: dict[str, float] = Field(default_factory=dict)


@dataclass(frozen=True)
class Cause:
    """A cause of contour error in a scenario."""

    name: str
    title: str
    switches: Mapping[str, Switch]  # by component

    @property
    def after(self) -> str:
        """The cause that is off in both runs whose difference is this cause's effect; or empty."""
        return next((s.after for s in self.switches.values() if s.after), "")


@dataclass(frozen=True)
class CauseOff:
    """The settings that switch a cause off, or why there are none."""

    set: Mapping[str, Any]  # value by `component.variable`; empty if nothing changes
    why_not: str = ""  # why nothing changes: the cause is absent, or cannot be switched off
    absent: bool = False  # the cause does nothing in this run


@functools.cache
def of_fmu(name: str) -> dict[str, Switch | dict[str, str]]:
    """A built FMU's causes.toml, if any: switch by cause, and the expressions under ``theory``."""
    text = fmus.extra(name, FILE)
    if text is None:
        return {}
    where = f"fmus/{name}/{FILE}"
    try:
        tables = tables_of(text, where)
        theory = tables.pop(THEORY, {})
        found: dict[str, Any] = {k: Switch.model_validate(_floats(v)) for k, v in tables.items()}
        theory = TypeAdapter(dict[str, str]).validate_python(theory, strict=True)
    except ValidationError as error:
        raise InputError(f"{where}: {' '.join(str(error).split())}") from None
    ports = fmus.ports(name)
    for cause, switch in found.items():
        names = [*switch.set, *switch.times, *switch.plus, *switch.limit, *switch.reached]
        names += [part.strip() for product in switch.mean for part in product.split("*")]
        if unknown := [n for n in names if n not in ports]:
            raise InputError(f"{where}: [{cause}]: {name} has no variable {unknown[0]!r}")
        if not (switch.title or cause in TITLES):
            raise InputError(f"{where}: [{cause}]: a cause of its own needs a title")
    return found | {THEORY: theory}


def _floats(value: Any) -> Any:
    if isinstance(value, dict):
        return {k: _floats(v) for k, v in value.items()}
    return float(value) if isinstance(value, int) and not isinstance(value, bool) else value


def causes(scenario: "Scenario") -> list[Cause]:
    """Causes that the FMUs of a scenario can switch off: `TITLES` in order, then an FMU's own."""
    found: dict[str, dict[str, Switch]] = {}
    for component, fmu in scenario.document.body.component.items():
        for name, switch in of_fmu(fmu).items():
            if isinstance(switch, Switch):
                found.setdefault(name, {})[component] = switch
    names = [n for n in TITLES if n in found] + [n for n in found if n not in TITLES]
    own = {n: next((s.title for s in found[n].values() if s.title), "") for n in names}
    return [Cause(n, own[n] or TITLES[n], found[n]) for n in names]


def watched(found: list[Cause]) -> list[str]:
    """Outputs ``component.variable`` that tell whether a cause acts, to be recorded."""
    return [f"{c}.{n}" for cause in found for c, s in cause.switches.items() for n in s.reached]


def _not_reached(cause: Cause, result: "Result") -> str:
    """Which output stays below the level at which the cause acts; empty if none does."""
    for component, switch in cause.switches.items():
        for name, level in switch.reached.items():
            largest = float(np.abs(result[f"{component}.{name}"]).max())
            if largest < level:
                told = f"{component}.{name} stays below {level:g} (largest {largest:.3g})"
                return told if level != 1 else f"{component}.{name} never"
    return ""


def off(cause: Cause, result: "Result", base: Mapping[str, Any]) -> CauseOff:
    """Settings that switch a cause off after the run `result`, on top of those of other causes."""
    if why := _not_reached(cause, result):
        return CauseOff({}, why, absent=True)
    changed: dict[str, Any] = {}
    for component, switch in cause.switches.items():
        ports = result.scenario.resolver.ports[component]

        def now(name: str, component: str = component) -> np.ndarray:
            full = f"{component}.{name}"
            return np.atleast_1d(np.asarray(base.get(full, result.parameter(full)), dtype=float))

        wanted = {n: np.full_like(now(n), v) for n, v in switch.set.items()}
        wanted |= {n: now(n) * v for n, v in switch.times.items()}
        wanted |= {n: now(n) + v for n, v in switch.plus.items()}
        for product in switch.mean:
            name, *others = (part.strip() for part in product.split("*"))
            wanted[name] = _equal(now(name), [now(n) for n in others], used(result))
        for name, values in wanted.items():
            given, why = _within(values, ports[name], name in switch.limit)
            if why:
                return CauseOff({}, f"{component}.{name}: {why}")
            if given != [_plain(x, ports[name]) for x in now(name)]:
                changed[f"{component}.{name}"] = given if ports[name].shape else given[0]
    return CauseOff(changed, "" if changed else "nothing to switch off", absent=not changed)


def used(result: "Result") -> list[int]:
    """Axes in use, from 0: those of the library that plans the path, else of another FMU."""
    ports = result.resolver.ports
    told = [n for n, own in ports.items() if "active" in own and own["active"].shape == (AXES,)]
    planning = [n for n in told if "path_file" in ports[n]]
    for name in (*planning, *told):
        return [i for i, on in enumerate(result.parameter(f"{name}.active")) if on]
    return list(range(AXES))


def _equal(values: np.ndarray, others: list[np.ndarray], axes: list[int]) -> np.ndarray:
    """Values whose product with `others` is its mean on all axes in use."""
    weight = np.ones_like(values)
    for other in others:
        weight = weight * other
    out = values.copy()
    out[axes] = np.mean((values * weight)[axes]) / weight[axes]
    return out


def _plain(value: float, port: "Port") -> int | float:
    return round(value) if port.type == "Int32" else float(value)


def _within(values: np.ndarray, port: "Port", limit: bool) -> tuple[list[Any], str]:
    low, high = port.low, port.high
    if port.type == "Int32":
        low, high = max(low, -INT_MAX), min(high, INT_MAX)
    worst = next((x for x in values.tolist() if not low <= x <= high), None)
    if worst is not None and not limit:
        return [], f"{worst:g} would be wanted, {low:g} .. {high:g} is allowed"
    return [_plain(x, port) for x in np.clip(values, low, high).tolist()], ""


def quantities(result: "Result") -> dict[str, np.ndarray]:
    """Quantities for theory from the FMUs, six axes each, by name: ``gain`` is a product over
    FMUs, others are sums.
    """
    found: dict[str, np.ndarray] = {}
    for component, fmu in result.scenario.document.body.component.items():
        table = of_fmu(fmu).get(THEORY, {})
        ports = result.scenario.resolver.ports[component]
        values = {
            name: np.asarray(result.parameter(f"{component}.{name}"), dtype=float)
            for name, port in ports.items()
            if port.causality == "parameter" and port.type in ("Float64", "Int32")
        }
        values = {n: v[0] if len(v) == 1 else v[:AXES] for n, v in values.items()}
        for name, text in table.items() if isinstance(table, dict) else ():
            try:
                new = np.broadcast_to(np.asarray(evaluate(text, values), dtype=float), (AXES,))
            except ValueError as error:
                raise InputError(f"fmus/{fmu}/causes.toml: [theory] {name} = {error}") from None
            old = found.get(name)
            found[name] = new if old is None else old * new if name == "gain" else old + new
    return found
