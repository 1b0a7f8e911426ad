"""Grids on which the FMUs of a system read, and whether they fit each other."""

import functools
import json
from collections.abc import Mapping

from motionfmu.fmu.archive_names import GRID
from motionfmu.scenarios import fmus
from motionfmu.scenarios.system import System, nanoseconds
from motionfmu.scenarios.values import start_values


@functools.cache
def grid(fmu: str) -> str:
    """The parameter that is an FMU's grid; empty if the FMU states none."""
    text = fmus.extra(fmu, GRID) if fmus.is_ours(fmu) else None
    return "" if text is None else str(json.loads(text)["grid"])


def warnings(system: System) -> list[str]:
    """Warnings about grids that do not fit each other, at most one sentence for each reason.

    A wire hands on without a delay if the step divides the grid of its source, which then changes
    at communication points only, or that of its target, which reads at such points only. A grid and
    a step of which neither divides the other are told of by the FMU itself.
    """
    given = {s.end.name: s.values[0] for s in system.settings}
    periods = {}
    for component, fmu in system.components.items():
        if own := grid(fmu):
            name = f"{component}.{own}"
            value = given.get(name, start_values(fmus.ports(fmu)[own])[0])
            periods[component] = name, nanoseconds(name, float(value))
    apart: set[str] = set()
    held: set[str] = set()
    for wire in system.wires:
        ends = {wire.source.component, wire.target.component}
        if not ends <= set(periods):
            continue
        a, b = (periods[w.component][1] for w in (wire.source, wire.target))
        if a % b and b % a:
            apart |= ends
        if all(system.step_ns % g == 0 and g < system.step_ns for g in (a, b)):
            held |= ends
    found = []
    if apart:
        told = "what is read over a wire between them is older at some samples than at others"
        found.append(f"grids do not divide each other: {_listed(periods, apart)}; {told}")
    if held:
        step = f"{system.step_ns * 1e-9:.9g} s"
        told = f"wires between them hold what they bring for {step}"
        found.append(f"the step, {step}, is longer than {_listed(periods, held)}; {told}")
    return found


def _listed(periods: Mapping[str, tuple[str, int]], which: set[str]) -> str:
    return ", ".join(f"{periods[c][0]} = {periods[c][1] * 1e-9:.9g} s" for c in sorted(which))
