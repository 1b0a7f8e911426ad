"""From a record of one axis to the parameters of its plant."""

import math
import time as clock
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError, suggestion
from motionfmu.identify import rigid_motion
from motionfmu.identify.axis_record import AxisRecord
from motionfmu.identify.controller_check import ControllerCheck
from motionfmu.identify.free_parameters import FreeParameters, carried, checked
from motionfmu.identify.friction_curve import FrictionCurve, friction_curve
from motionfmu.identify.ground import Ground, IdentifyOptions, ground
from motionfmu.identify.part_scatter import part_scatter
from motionfmu.identify.recorded_loop import RecordedLoop
from motionfmu.identify.shooting import Fitted, Guess
from motionfmu.identify.spread import Spread, autocorrelation, spread
from motionfmu.run import Scenario

Array = NDArray[np.float64]
# A quantity whose standard deviation is above this share of itself cannot be told by the record;
# one that makes less than the second share of the drive counts as that.
_UNTOLD, _LITTLE = 0.3, 0.05
# From here on it says nothing of it.
_BLANK = 0.9
_NEVER = 1e-100
# A law must explain what was kept back so much better to be taken.
_WORTH = 0.98
# Steps of least squares for start values.
_NEWTON = 6
# Distances of samples at which residuals are looked at for what is left in them.
_DISTANCES = 100
# Directions of start values that inverse dynamics tell with less than this share of the clearest
# one stay as they are: the rest of a law at low speeds.
_CLEAR = 1e-3
# Share of a law's signal above which the scenario's controller is not that of the record.
_STRANGE = 0.1


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
class Validation:
    """How well values found on one part explain the part kept back."""

    laws: tuple[str, ...]
    other: Mapping[str, Any]
    fitted: Mapping[str, float]  # norm of the difference over norm, by signal, on the part fitted
    kept: Mapping[str, float]  # on the part kept back
    score: float  # what the choice goes by: kept-back residuals over those of the first law
    values: Mapping[str, float]  # of the free quantities, from the part fitted


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


Progress = Callable[[str, float], None]


def identify(
    scenario: Scenario,
    record: AxisRecord,
    options: IdentifyOptions,
    set: Mapping[str, Any] | None = None,
    progress: Progress = lambda what, share: None,
) -> Identified:
    """Find the parameters of an axis' plant that explain a record.

    Start values by inverse dynamics and least squares (Gautier 1997), then closed-loop output error
    by multiple shooting and Gauss-Newton on the plant's own equation and the sampled laws of the
    scenario; the friction law is the one that explains best what was kept back.

    Parameters
    ----------
    scenario : Scenario
        With the controller that the record was made with, and the plant.
    record : AxisRecord
    options : IdentifyOptions
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
    marks = [clock.perf_counter()]
    given = dict(set or {})
    progress("controller and start values", 0.0)
    own = ground(scenario, record, options, (given, {}))
    laws = tuple(options.laws or ())
    wanted = _names(own, options)
    told, why = _told(own, _extended(own, wanted, laws, options))
    names = [n for n in wanted if n in told]
    asked = replace(options, fix=(*options.fix, *why))
    marks.append(clock.perf_counter())
    tried: list[Validation] = []
    chosen = None
    if names:
        chosen = _validated(own, (names, laws), asked, None)
        tried.append(chosen)
        for other in _others(scenario, own, given):
            progress("drive", 0.2)
            there = ground(scenario, record, options, (given, other))
            look = _validated(there, (names, laws), asked, (tried[0], chosen))
            tried.append(look)
            if look.score < _WORTH * chosen.score:
                own, chosen = there, look
        if options.laws is None and not why:  # else an extension would stand for what is untold
            chosen = _law(own, (names, asked), (tried, chosen), progress)
            laws = chosen.laws
    marks.append(clock.perf_counter())
    progress("all of the record", 0.7)
    span = own.first, own.data.samples - 1
    near = chosen.values if chosen else {}
    own.motion.fine = own.gap
    free, fitted, known, more = _fitted(own, _extended(own, names, laws, asked), span, near)
    if known is not None:
        progress("parts of the record", 0.8)
        known = known.at_least(part_scatter(own, free, fitted, span))
    marks.append(clock.perf_counter())
    parts = np.diff(marks).tolist()
    measured, simulated = _stretch_signals(own, fitted, span)
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
        notes=tuple(_notes(own, free, options)),
        seconds=dict(zip(("start", "law", "fit"), parts, strict=True)),
        ground=own,
        given=given,
        kept_share=options.keep,
    )


def _names(own: Ground, options: IdentifyOptions) -> list[str]:
    """Quantities that are free in every law."""
    loop = own.loop
    names = list(own.known.free) if options.free is None else list(options.free)
    fixed = checked(loop.ode, options.fix, loop.wired, "fix")
    return [n for n in dict.fromkeys(names) if n not in fixed]


def _extended(
    own: Ground, names: Sequence[str], laws: Sequence[str], options: IdentifyOptions
) -> list[str]:
    """Quantities that are free with extensions of the law."""
    for law in laws:
        if law not in own.known.law:
            known = ", ".join(own.known.law) or "none"
            told = suggestion(law, own.known.law) or f"; there are: {known}"
            raise InputError(f"--law {law}: {own.loop.fmu} has no such law of friction{told}")
    if not names:
        return []
    more = [n for law in laws for n in own.known.law[law].free]
    wired = {d.name for k, d in enumerate(own.loop.ode.inputs) if k in own.loop.wired}
    return [n for n in dict.fromkeys([*names, *more]) if n not in wired and n not in options.fix]


def _others(scenario: Scenario, own: Ground, given: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """Values of other parameters that are tried, one after the other: what nobody has said."""
    for component, fmu in scenario.document.body.component.items():
        values = own.loop.values.get(component)
        for name, choices in carried(fmu).other.items():
            if values is None or name in values.given or f"{component}.{name}" in given:
                continue
            for value in choices:
                if value != values[name]:
                    yield {f"{component}.{name}": value}


def _start(own: Ground, free: FreeParameters) -> tuple[Array, Array]:
    """Values by inverse dynamics and least squares, and their deviations as for white noise."""
    values = np.clip(free.start, free.low, free.high)
    if not len(values) or own.still or len(own.points) < 10 * len(values):
        return values, np.full(len(values), np.inf)
    deviations = np.full(len(values), np.inf)
    for _ in range(_NEWTON):
        found = own.follow(free, values, own.points)
        rest = own.force[own.points] - found.drive
        scale = np.maximum(np.linalg.norm(found.slopes, axis=0), 1e-300)
        u, s, v = np.linalg.svd(found.slopes / scale, full_matrices=False)
        inverse = np.where(s > _CLEAR * s[0], 1.0 / np.maximum(s, 1e-300), 0.0)
        step = v.T @ (inverse * (u.T @ rest)) / scale
        new = np.clip(values + step, free.low, free.high)
        deviations = np.sqrt(np.sum((v.T * inverse) ** 2, axis=1) * np.mean(rest**2)) / scale
        moved, values = np.abs(new - values), new
        if (moved <= 1e-6 * deviations).all():
            break
    good = np.isfinite(values) & (np.abs(values) > 0.05 * np.abs(free.start))
    return np.where(good | (free.start == 0.0), values, free.start), deviations


def _sizes(own: Ground, free: FreeParameters, values: Array) -> Array:
    """What counts as the size of each quantity: itself, or what the scenario believes of it.

    Where that is 0, what makes a little of the drive, but no more than its limit.
    """
    sizes = np.maximum(np.abs(values), np.abs(free.start))
    if not len(values) or not len(own.points):
        return np.maximum(sizes, _NEVER)
    slopes = own.follow(free, values, own.points).slopes
    drive = float(np.sqrt(np.mean(own.force[own.points] ** 2)))
    share = np.maximum(np.sqrt(np.mean(slopes**2, axis=0)), _NEVER)
    most = np.where(np.isfinite(free.high), np.abs(free.high), np.inf)
    little = np.minimum(_LITTLE * drive / share, most)
    return np.asarray(np.where(free.start == 0.0, np.maximum(sizes, little), sizes))


def _told(own: Ground, names: Sequence[str]) -> tuple[list[str], dict[str, str]]:
    """Names that the record can tell at all, and why not of the others.

    By the information matrix of the closed loop about the start values: its slopes are those of a
    simulated motion, so noise of the record is no news. Each is believed beforehand to within its
    size, so one that acts as another one does is not told because that one is left alone.
    """
    if own.still:
        return [], dict.fromkeys(names, "the axis does not move")
    if not names:
        return [], {}
    free = own.free(names)
    for values in (_start(own, free)[0], free.start):
        problem, starts = own.shooting(free, (own.first, own.data.samples - 1), values)
        now = problem.linear(Guess(values, starts))
        if now.sound:
            break
    else:
        return [], dict.fromkeys(names, "no motion of the plant is near the record")
    sizes = np.sqrt(np.mean(now.rest**2, axis=0) + problem.stretch.floor**2)
    fit = Fitted(Guess(values, starts), now, sizes, 0, False, problem.prior(now, len(values)))
    size = _sizes(own, free, values)
    known = spread(fit).information * np.outer(size, size) + np.eye(len(size))
    share = np.sqrt(np.diag(np.linalg.inv(known)))
    rows = list(zip(names, share.tolist(), strict=True))
    return [n for n, s in rows if s <= _UNTOLD], {n: _reason(s) for n, s in rows if s > _UNTOLD}


def _reason(share: float) -> str:
    if share > _BLANK:
        return "the record says nothing of it, or nothing that another quantity would not"
    return f"its standard deviation is {100.0 * share:.0f} % of its size"


def _fitted(
    own: Ground, names: Sequence[str], span: tuple[int, int], near: Mapping[str, float]
) -> tuple[FreeParameters, Fitted, Spread | None, dict[str, str]]:
    """Fit a span of samples; quantities that it cannot tell are fixed one after the other.

    `near` are values found before, from which those quantities begin.
    """
    left = list(names)
    why: dict[str, str] = {}
    while True:
        free = own.free(left)
        values = _start(own, free)[0]
        values = np.array([near.get(n, v) for n, v in zip(left, values.tolist(), strict=True)])
        problem, starts = own.shooting(free, span, values)
        fit = problem.fit(Guess(values, starts), hollow=own.motion.fine)
        if not left:
            return free, fit, None, why
        if not fit.linear.sound:  # extensions of the law stand last
            why[left.pop()] = "no motion of the plant is near the record with it"
            continue
        known = spread(fit)
        share = known.deviations / np.maximum(_sizes(own, free, fit.guess.free), 1e-100)
        worst = int(np.argmax(np.where(np.isfinite(share), share, np.inf)))
        if share[worst] <= _UNTOLD:
            return free, fit, known, why
        why[left[worst]] = _reason(float(share[worst]))
        left.pop(worst)


def _validated(
    own: Ground,
    asked: tuple[Sequence[str], Sequence[str]],
    options: IdentifyOptions,
    before: "tuple[Validation, Validation] | None",
) -> Validation:
    """Fit the first part of the record and try what was found on the part kept back.

    `before` are the first look, by which it is scored, and the one from whose values it begins.
    """
    names, laws = asked
    first, near = (before[0], before[1].values) if before else (None, {})
    low, high = own.first, own.data.samples - 1
    rows = own.stretch(low, high)[0].rows
    cut = int(rows[int((1.0 - options.keep) * len(rows))])
    free, fit, _, _ = _fitted(own, _extended(own, names, laws, options), (low, cut), near)
    p, u, _, _ = free.values(fit.guess.free)
    fixed = own.fixed(p, u)
    problem, starts = own.shooting(fixed, (cut, high), fixed.start)
    kept = problem.fit(Guess(fixed.start, starts), fit.sizes)
    errors = [
        _errors(own, _stretch_signals(own, f, s))
        for f, s in ((fit, (low, cut)), (kept, (cut, high)))
    ]
    score = 1.0
    if first is not None:
        ratios = [errors[1][n] / max(first.kept[n], 1e-12) for n in own.data.compared]
        score = first.score * float(np.mean(ratios))
    found = dict(zip(free.names, fit.guess.free.tolist(), strict=True))
    return Validation(tuple(laws), dict(own.other), errors[0], errors[1], score, found)


def _law(
    own: Ground,
    asked: tuple[Sequence[str], IdentifyOptions],
    so_far: tuple[list[Validation], Validation],
    progress: Progress,
) -> Validation:
    """Add the extension that explains most of what was kept back, while one does."""
    (names, options), (tried, chosen) = asked, so_far
    first = tried[0]
    left = [n for n in own.known.law if n not in chosen.laws]
    rounds = 0
    while left:
        progress("friction law", 0.3 + 0.1 * min(rounds, 3))
        before = first, chosen
        looks = [_validated(own, (names, (*chosen.laws, n)), options, before) for n in left]
        tried += looks
        best = min(looks, key=lambda v: v.score)
        if best.score >= _WORTH * chosen.score:
            break
        chosen = best
        left = [n for n in left if n not in chosen.laws]
        rounds += 1
    return chosen


def _stretch_signals(own: Ground, fit: Fitted, span: tuple[int, int]) -> tuple[Array, Array]:
    """Signals of the record and of a fit."""
    stretch = own.stretch(*span)[0]
    measured = stretch.measured[stretch.counted]
    return measured, measured - fit.linear.rest


def _errors(own: Ground, signals: tuple[Array, Array]) -> dict[str, float]:
    """Norm of the difference over that of the signal about its mean, by signal."""
    measured, simulated = signals
    found = {}
    for k, name in enumerate(own.data.compared):
        whole = float(np.linalg.norm(measured[:, k] - measured[:, k].mean()))
        found[name] = float(np.linalg.norm(measured[:, k] - simulated[:, k])) / max(whole, 1e-300)
    return found


def following(
    own: Ground, signals: tuple[Array, Array], rows: NDArray[np.int64]
) -> tuple[Array, Array] | None:
    """Following errors [m or rad] at samples, where a command of the position is recorded."""
    name = f"{own.loop.component}.{own.rates.outputs[own.position]}"
    command = next((n for n in own.loop.driven if n in own.ratios), None)
    if command is None or name not in own.data.compared:
        return None
    wanted = own.data.driven[:: own.data.every, own.loop.driven.index(command)]
    wanted = wanted[rows] / own.ratios[command]
    k = own.data.compared.index(name)
    return tuple(wanted - s[:, k] / own.ratios[name] for s in signals)  # type: ignore[return-value]


def _parameters(
    own: Ground,
    options: IdentifyOptions,
    of: tuple[FreeParameters, Fitted, Spread | None],
    why: Mapping[str, str],
) -> tuple[Parameter, ...]:
    """All quantities that were asked for, those that cannot be told too."""
    free, fit, known = of
    rows = []
    every = list(dict.fromkeys([*_names(own, options), *free.names, *why]))
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
    component, ports = own.loop.component, own.loop.scenario.resolver.ports
    found: dict[str, Any] = {}

    def add(name: str, value: Any) -> None:
        c, _, variable = name.partition(".")
        found[f"{name}[{own.loop.axis}]" if ports[c][variable].shape else name] = value

    for name, value in free.settings(fit.guess.free).items():
        add(f"{component}.{name}", value)
    for name, value in own.other.items():
        add(name, value)
    if own.check is not None and own.check.taken and own.gains_taken:
        for name, (_, value) in own.check.gains.items():
            add(name, value)
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


def _notes(own: Ground, free: FreeParameters, options: IdentifyOptions) -> Iterator[str]:
    """What is to be known, in words."""
    check = own.check
    if own.limited.note:
        yield own.limited.note
    if not free.names:
        yield "This record tells nothing of the axis: it stands, or its speed does not change."
    if check is None:
        return
    if check.lag:
        late = 1e3 * check.lag * own.loop.step
        yield f"{check.signal} shows {late:.4g} ms later what the record has: compared so."
    if check.taken:
        gains = ", ".join(f"{n} {b:.6g} instead of {a:.6g}" for n, (a, b) in check.gains.items())
        word = "taken" if options.controller else "not taken"
        yield (
            f"The record was made with other gains than the scenario's: {gains}"
            f" ({100 * check.fitted:.2g} % of {check.signal} are left unexplained instead of"
            f" {100 * check.difference:.2g} %): {word}."
        )
    elif check.difference > _STRANGE:
        yield (
            f"The scenario's controller does not explain the record: {check.signal} differs by"
            f" {100 * check.difference:.2g} % from what its law makes of the same motion. This may"
            " be the record of another machine."
        )
