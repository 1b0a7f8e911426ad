"""Margins and step answers of the loops of an axis."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.freq.loop_study import LoopStudyOptions, study
from motionfmu.analysis.freq.step_run import LONGEST, step_of
from motionfmu.analysis.linear import AxisModel, Margins, gain_of, model
from motionfmu.analysis.linear.closed_step import settling_length
from motionfmu.analysis.positioning import StepFigures, step_figures
from motionfmu.base.errors import InputError
from motionfmu.run.run_plan import Options
from motionfmu.run.runner import Scenario
from motionfmu.scenarios.values import values_in

Array = NDArray[np.float64]
POSITION, VELOCITY = "position", "velocity"


@dataclass(frozen=True)
class LoopSheet:
    """A loop of an axis: its margins, and its answer to a step."""

    at: str  # input at which it is opened, component.variable
    kind: str  # position, or velocity for an inner loop, which gets a step of speed
    margins: Margins
    kp: float | None  # position gain [1/s]; None for a loop without one
    model: StepFigures  # of the linear model
    measured: StepFigures | None  # of the running FMUs; None if they did not run
    time: Array  # (n,) [s] of the step that is drawn
    answer: Array  # (n,) as a share of the step; of the FMUs if they ran

    @property
    def step(self) -> StepFigures:
        """Figures of the FMUs where they ran, else of the model."""
        return self.measured or self.model

    def numbers(self) -> dict[str, Any]:
        """The same for JSON; what is infinite is None."""
        m = self.margins
        sizes = {"gain_margin": m.gain, "phase_margin": m.phase, "delay_margin": m.delay}
        sizes |= {"sensitivity": m.sensitivity, "bandwidth": m.bandwidth}
        found: dict[str, Any] = {"at": self.at, "kind": self.kind, "stable": m.stable}
        found |= {k: v if math.isfinite(v) else None for k, v in sizes.items()}
        measured = None if self.measured is None else self.measured.numbers()
        return found | {"kp": self.kp, "step_model": self.model.numbers(), "step": measured}


def axis_model(
    scenario: Scenario, row: int, at: Mapping[str, float], set_: Mapping[str, Any]
) -> AxisModel:
    """The linear model of an axis, also of one that its controller moves by the row of another."""
    try:
        return model(scenario, row, at, set_)
    except InputError as error:
        switched = _switched_on(scenario, row, set_)
        if "is not active in" not in str(error) or not switched:
            raise
    return model(scenario, row, at, {**set_, **switched})


def _switched_on(scenario: Scenario, row: int, set_: Mapping[str, Any]) -> dict[str, list[bool]]:
    """Values of `active` in which the row is on where another component has it on already."""
    made = scenario.resolved(Options(set=set_))
    given = {s.end.name: s.values for s in made.settings}
    found, on = {}, False
    for component, ports in scenario.resolver.ports.items():
        if "active" in ports and ports["active"].shape and row <= ports["active"].count:
            listed = [bool(v) for v in values_in(given, component, ports["active"])]
            on = on or listed[row - 1]
            listed[row - 1] = True
            found[f"{component}.active"] = listed
    return found if on else {}


def loops(linear: AxisModel, simulate: bool = True) -> list[LoopSheet]:
    """The loops of an axis at its operating point, outer ones first."""
    gains = {g.loop: g.kp for g in gain_of(linear.scenario, linear.set, linear.axis, linear.at)}
    studied = study(linear, LoopStudyOptions(simulate=False))
    every = {each.at for each in studied}
    found = []
    for each in studied:
        kind = VELOCITY if every.intersection(each.cut) else POSITION
        asked = step_of(linear, each.at, each.cut, kind == VELOCITY)
        length = settling_length(each.loop, each.margins)
        time, answer = asked.by_model(length)
        own = step_figures(time, answer)
        measured = None
        samples = length * 1e9 / linear.step_ns
        if simulate and each.margins.stable and not linear.others and samples <= LONGEST:
            time, answer = asked.by_fmus(length, each.margins.bandwidth)
            measured = step_figures(time, answer)
        shown = LoopSheet(
            each.at, kind, each.margins, gains.get(each.at), own, measured, time, answer
        )
        found.append(_shortened(shown))
    return found


def _shortened(sheet: LoopSheet) -> LoopSheet:
    """The answer as far as it is worth a picture: twice its settling time."""
    settling = sheet.step.settling
    if not math.isfinite(settling) or settling <= 0.0:
        return sheet
    count = max(2, int(np.searchsorted(sheet.time, 2.0 * settling)))
    return replace(sheet, time=sheet.time[:count], answer=sheet.answer[:count])
