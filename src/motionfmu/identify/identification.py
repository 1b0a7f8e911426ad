"""From a record of one axis to the parameters of its plant."""

import math
import time as clock
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.identify import identify_file, rigid_motion
from motionfmu.identify.axis_record import AxisRecord, of_record
from motionfmu.identify.controller_check import ControllerCheck
from motionfmu.identify.doubted_gap import doubted_gap
from motionfmu.identify.fit_notes import contact_notes, notes
from motionfmu.identify.free_parameters import FreeParameters
from motionfmu.identify.friction_curve import FrictionCurve, friction_curve
from motionfmu.identify.ground import Ground, IdentifyOptions, ground
from motionfmu.identify.law_choice import (
    WORTH,
    Progress,
    Validation,
    chosen_law,
    extended,
    free_names,
    idle_laws,
    others,
    validated,
)
from motionfmu.identify.near_fits import near_fits
from motionfmu.identify.recorded_loop import RecordedLoop
from motionfmu.identify.shooting import Fitted
from motionfmu.identify.span_fit import fitted_span, following, misfit, stretch_signals
from motionfmu.identify.spread import Spread, autocorrelation
from motionfmu.identify.tellable import scattered, tellable
from motionfmu.records import Record
from motionfmu.run import Scenario, load

Array = NDArray[np.float64]
# Distances of samples at which residuals are looked at for what is left in them.
_DISTANCES = 100


@dataclass(frozen=True)
class Parameter:
    """One quantity as the record tells it."""

    name: str  # component.variable
    title: str
    unit: str
    before: float  # as the scenario has it
    value: float  # the same if the record cannot tell it
    deviation: float  # standard deviation; infinite if the record says nothing
    told: bool  # whether the record tells it
    why: str = ""  # if not


@dataclass(frozen=True)
class Identified:
    """What a record tells of an axis.

    Attributes
    ----------
    scenario, axis, record :
        Of what.
    parameters : tuple of Parameter
        In the plant's order, those that cannot be told too.
    settings : dict
        Value by ``component.variable[axis]`` for ``--set``, of all that was found.
    laws : tuple of str
        Extensions of the friction law that were taken.
    tried : tuple of Validation
        All that were tried, in order.
    chosen : Validation
        That of the law taken.
    spread : Spread
        Standard deviations and correlations, in the order of `free`.
    free : tuple of str
        Names of the quantities fitted.
    curve : FrictionCurve
        Force over speed, from inverse dynamics.
    check : ControllerCheck or None
        The scenario's controller beside the record.
    time, measured, simulated :
        Samples [s]; signals of the record and of the fit, (samples, n), in the signals' units.
    signals : tuple of str
        Their names.
    following : tuple of arrays or None
        Following error measured and simulated, in the unit of the first output fed back.
    notes : tuple of str
        What is to be known, in words.
    seconds : dict
        Time that each part took [s].
    """

    scenario: Scenario
    axis: int
    record: AxisRecord
    parameters: tuple[Parameter, ...]
    settings: Mapping[str, Any]
    laws: tuple[str, ...]
    tried: tuple[Validation, ...]
    chosen: Validation | None
    spread: Spread | None
    free: tuple[str, ...]
    curve: FrictionCurve
    check: ControllerCheck | None
    time: Array
    measured: Array
    simulated: Array
    signals: tuple[str, ...]
    following: tuple[Array, Array] | None
    recorded: RecordedLoop
    notes: tuple[str, ...]
    ground: Ground
    given: Mapping[str, Any]
    kept_share: float
    seconds: Mapping[str, float] = field(default_factory=dict)

    @property
    def residuals(self) -> dict[str, float]:
        """How far residuals are from white noise, by signal.

        The share of the first autocorrelations beyond what 95 % of those of white noise are: 0.05
        for white noise, 1 where a law is missing.

        Returns
        -------
        dict
        """
        found = {}
        for k, name in enumerate(self.signals):
            rest = self.measured[:, k] - self.simulated[:, k]
            most = min(_DISTANCES, len(rest) // 4)
            c = autocorrelation(rest, most)[1:]
            found[name] = float(np.mean(np.abs(c) > 1.96 / math.sqrt(len(rest))))
        return found

    def value(self, name: str) -> Parameter:
        """One quantity.

        Parameters
        ----------
        name : str
            ``component.variable``, or the variable alone.

        Returns
        -------
        Parameter

        Raises
        ------
        KeyError
            There is none of this name.
        """
        for p in self.parameters:
            if name in (p.name, p.name.partition(".")[2]):
                return p
        raise KeyError(name)


def identify(
    scenario: Scenario | str | Path,
    record: AxisRecord | Record,
    options: IdentifyOptions | Mapping[str, Any] | None = None,
    set: Mapping[str, Any] | None = None,
    progress: Progress = lambda what, share: None,
) -> Identified:
    """Find the parameters of an axis' plant that explain a record.

    Start values come by inverse dynamics and least squares (Gautier 1997). Then closed-loop output
    error follows by multiple shooting and Gauss-Newton on the plant's own equation and the sampled
    laws of the scenario. The friction law is the one that explains best what was kept back.

    Parameters
    ----------
    scenario : Scenario, str or Path
        With the controller that the record was made with, and the plant.
    record : AxisRecord or Record
    options : IdentifyOptions or mapping, optional
        As in an identify.toml; that beside the scenario if not given.
    set : mapping, optional
        Values by ``component.variable``, stronger than the scenario's.
    progress : callable, optional
        Called with what is done and the share done.

    Returns
    -------
    Identified

    Raises
    ------
    InputError
        A name, column or unit is wrong, or the axis has no plant that can be identified.
    """
    scenario = scenario if isinstance(scenario, Scenario) else load(scenario)
    record = record if isinstance(record, AxisRecord) else of_record(record)
    options = _options(scenario, options)
    marks = [clock.perf_counter()]
    given = dict(set or {})
    progress("controller and start values", 0.0)
    own = ground(scenario, record, options, (given, {}))
    laws = tuple(options.laws or ())
    wanted = free_names(own, options)
    told, why = tellable(own, extended(own, wanted, laws, options))
    names = [n for n in wanted if n in told]
    asked = replace(options, fix=(*options.fix, *why))
    marks.append(clock.perf_counter())
    tried: list[Validation] = []
    chosen = None
    if names:
        chosen = validated(own, (names, laws), asked, None)
        tried.append(chosen)
        if options.laws is None and not why:  # else an extension would stand for what is untold
            chosen = chosen_law(own, (names, asked), (tried, chosen), progress)
            laws = chosen.laws
        for other in others(scenario, own, given):
            progress("drive", 0.6)
            there = ground(scenario, record, options, (given, other))
            look = validated(there, (names, laws), asked, (tried[0], chosen))
            tried.append(look)
            if look.score < WORTH * chosen.score:
                own, chosen = there, look
    marks.append(clock.perf_counter())
    progress("all of the record", 0.7)
    span = own.first, own.data.samples - 1
    near = chosen.values if chosen else {}
    judge = laws if options.laws is None else ()
    (free, fitted, known, more), laws, idle, late = _all_of_the_record(
        own, (names, laws, judge, asked), span, near, progress
    )
    why |= late
    progress("the gap", 0.9)
    known, doubts = doubted_gap(
        own,
        (free, fitted, known),
        span,
        lambda gap: ground(scenario, record, options, ({**given, **gap}, own.other)),
    )
    marks.append(clock.perf_counter())
    parts = np.diff(marks).tolist()
    measured, simulated = stretch_signals(own, fitted, span)
    rows = own.stretch(*span)[0].rows
    return Identified(
        scenario=scenario,
        axis=options.axis,
        record=record,
        parameters=_parameters(own, options, (free, fitted, known), {**why, **more}),
        settings=_settings(own, free, fitted),
        laws=laws,
        tried=tuple(tried),
        chosen=chosen,
        spread=known,
        free=free.names,
        curve=_curve(own, free, fitted),
        check=own.check,
        recorded=own.data,
        time=own.data.time[rows],
        measured=measured,
        simulated=simulated,
        signals=own.data.compared,
        following=following(own, (measured, simulated), rows),
        notes=(
            *notes(own, free, options, chosen),
            *contact_notes(own, fitted, span),
            *doubts,
            *(
                f"The law {n} was left out again: in all of the record it may be nothing."
                for n in idle
            ),
        ),
        seconds=dict(zip(("start", "law", "fit"), parts, strict=True)),
        ground=own,
        given=given,
        kept_share=options.keep,
    )


def _all_of_the_record(
    own: Ground,
    asked: tuple[Sequence[str], Sequence[str], Sequence[str], IdentifyOptions],
    span: tuple[int, int],
    near: Mapping[str, float],
    progress: Progress,
) -> tuple[
    tuple[FreeParameters, Fitted, Spread | None, dict[str, str]],
    tuple[str, ...],
    list[str],
    dict[str, str],
]:
    """The last fit; the laws that stay, those that left again, what its parts tell too differently.

    Laws are in `asked` twice: all of them, and those that may leave.
    """
    names, laws, judge, options = asked
    left, idle, late = list(names), list[str](), dict[str, str]()
    while True:
        fit = fitted_span(own, extended(own, left, laws, options), span, near)
        free, fitted, known, more = fit
        if known is not None and own.gap:
            progress("fits beside it", 0.8)
            fitted, known = near_fits(own, free, fitted, span)
            known = known.widened(misfit(own, fitted, span))
        nothing = idle_laws(own, [n for n in laws if n in judge], (free, fitted, known))
        worst = {} if nothing else scattered(own, free, fitted, known)
        if not nothing and not worst:
            return (free, fitted, known, more), tuple(laws), idle, late
        idle += nothing
        laws = [n for n in laws if n not in nothing]
        left = [n for n in left if n not in worst]
        options = replace(options, fix=(*options.fix, *worst))  # of a law that was asked for, too
        late |= worst


def _options(
    scenario: Scenario, given: IdentifyOptions | Mapping[str, Any] | None
) -> IdentifyOptions:
    """Options of tables, or of the identify.toml beside the scenario."""
    if isinstance(given, IdentifyOptions):
        return given
    if given is not None:
        return identify_file.options(given, "identify")
    file = scenario.document.file.parent / identify_file.FILE
    return identify_file.options(identify_file.read(file), str(file))


def _parameters(
    own: Ground,
    options: IdentifyOptions,
    of: tuple[FreeParameters, Fitted, Spread | None],
    why: Mapping[str, str],
) -> tuple[Parameter, ...]:
    """All quantities that were asked for, those that cannot be told too."""
    free, fit, known = of
    rows = []
    every = list(dict.fromkeys([*free_names(own, options), *free.names, *why]))
    titles = {d.name: d for d in (*own.loop.ode.parameters, *own.loop.ode.inputs)}
    now = free.settings(fit.guess.free)
    for name in every:
        d = titles[name]
        before = own.value(name)
        told = name in free.names and known is not None
        deviation = np.inf
        if told and known is not None:
            deviation = _deviation(free, known, name)
        rows.append(
            Parameter(
                f"{own.loop.component}.{name}",
                d.description,
                d.unit,
                before,
                now.get(name, before),
                deviation,
                told,
                "" if told else why.get(name, "the record says nothing of it"),
            )
        )
    return tuple(rows)


def _deviation(free: FreeParameters, known: Spread, name: str) -> float:
    """Standard deviation of a quantity; one that counts from another has the sum's."""
    k = free.names.index(name)
    row = np.zeros(len(free.names))
    row[k] = 1.0
    if name in free.above and free.above[name] in free.names:
        row[free.names.index(free.above[name])] = 1.0
    cover = known.correlation * np.outer(known.deviations, known.deviations)
    return math.sqrt(max(float(row @ cover @ row), 0.0))


def _settings(own: Ground, free: FreeParameters, fit: Fitted) -> dict[str, Any]:
    """Values by the name that --set takes."""
    component = own.loop.component
    found = {own.set_name(f"{component}.{n}"): v for n, v in free.settings(fit.guess.free).items()}
    found |= {own.set_name(n): v for n, v in own.other.items()}
    if own.check is not None and own.check.taken and own.gains_taken:
        found |= {own.set_name(n): v for n, (_, v) in own.check.gains.items()}
    return found


def _curve(own: Ground, free: FreeParameters, fit: Fitted) -> FrictionCurve:
    """Friction over speed: the drive less what accelerates the axis."""
    at = own.points
    if own.still or not len(at):
        nothing = np.zeros(0)
        return FrictionCurve(nothing, nothing, nothing, nothing, ("", ""))
    values = fit.guess.free
    s, v, a = (m[at] for m in own.moving)
    plan = own.way, own.drive, own.position
    moves = own.follow(free, values, at).drive
    steady = rigid_motion.follow(own.rates, (s, v, 0.0 * a), plan, free.values(values)).drive
    drive = own.force[at] - moves + steady
    name = f"{own.loop.component}.{own.rates.outputs[own.position]}"
    unit = own.loop.ode.inputs[own.drive].unit
    return friction_curve(v / own.ratios[name], drive, steady, (own.length + "/s", unit))
