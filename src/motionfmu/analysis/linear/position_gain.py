"""The position gain Kp of a loop in 1/s, in whatever unit its parameter is."""

import cmath
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np

from motionfmu.analysis.linear import coupled_plant, law
from motionfmu.analysis.linear.axis import AxisModel, model, wired_with
from motionfmu.analysis.linear.loops import feedbacks
from motionfmu.analysis.linear.tuning_parts import listed, matrices
from motionfmu.base.errors import InputError
from motionfmu.fmu.modelica.ode import Ode
from motionfmu.run import Scenario
from motionfmu.scenarios import system
from motionfmu.scenarios.fmus import Port

# Frequency [rad/s] that counts as 0, for time constants up to a minute.
_SLOW = 1e-4
# A loop has a position gain if (z - 1)/T times it changes less than this over an octave there.
_STEADY = 1e-3
# A difference of two loops that is below this share of them is rounding.
_SAME = 1e-9
# Speeds, by unit, at which a gain is told if nobody states one: slow, but no creeping.
_MOTION = {"rad/s": 10.0, "m/s": 0.01}


def kp_of(axis: AxisModel, name: str) -> float | None:
    """Position gain Kp [1/s] that a parameter gives a loop.

    The return ratio of the parameter, ``(L(p) - L(0))/(1 + L(0))`` with L the open loop that it is
    in, approaches ``Kp T/(z - 1)`` for slow motions; integral parts of the position loop are off.

    Parameters
    ----------
    axis : AxisModel
    name : str
        ``component.variable``.

    Returns
    -------
    float or None
        None if it sets no position gain: it acts on no loop, is not above 0, or what it acts on
        does not add speed up to a position.
    """
    found = _acting(axis, name)
    return None if found is None else found[0]


def _acting(axis: AxisModel, name: str) -> tuple[float, str] | None:
    """Position gain [1/s] of a parameter, and where its loop can be opened."""
    value = axis.value(name)
    if isinstance(value, bool | str) or not value > 0:
        return None
    other = (value - 1 if value > 1 else value + 1) if isinstance(value, int) else 0.5 * value
    still = {n: type(axis.value(n))(0) for n in listed(axis, "integral") if n != name}
    own = wired_with(axis, name.partition(".")[0])
    models = [_with(own, {**still, name: v}) for v in (value, other)]
    for at, cut in feedbacks(own).items():
        rates = [_rate(models, (value, other), (at, cut), w) for w in (_SLOW, 2.0 * _SLOW)]
        if rates[0] is None or rates[1] is None:
            continue
        if abs(rates[0] - rates[1]) < _STEADY * abs(rates[0]) and rates[0].real > 0.0:
            return float(rates[0].real), at
    return None


def _with(axis: AxisModel, values: Mapping[str, Any]) -> AxisModel:
    """The model with values for its own axis; a shared parameter for all."""
    ports = axis.scenario.resolver.ports
    every: dict[str, Any] = {}
    for name, value in values.items():
        component, _, variable = name.partition(".")
        port = ports[component][variable]
        every[name] = [value] * port.count if port.shape else value
    return axis.changed(every)


def _rate(
    models: list[AxisModel],
    values: tuple[float, float],
    loop: tuple[str, tuple[str, ...]],
    w: float,
) -> complex | None:
    """(z - 1)/T times the return ratio of a parameter with two values; None if it has none."""
    (at, cut), found = loop, []
    component, _, port = at.partition(".")
    for axis in models:
        source = ".".join(axis.wires[component, port])
        parts = matrices(axis, [at], [source], [at, *cut])
        a, b, c, d = (np.asarray(m, dtype=float) for m in (parts.a, parts.b, parts.c, parts.d))
        period = parts.period_ns * 1e-9
        z = cmath.exp(1j * w * period)
        found.append(-complex((c @ np.linalg.solve(z * np.eye(len(a)) - a, b) + d)[0, 0]))
    own, other = found
    part = values[0] * (own - other) / (values[0] - values[1])
    if abs(part) <= _SAME * abs(own):
        return None
    return (z - 1.0) / period * part / (1.0 + own - part)


def found(
    scenario: Scenario,
    set_: Mapping[str, Any],
    axis: int | None,
    at: Mapping[str, float] | None,
) -> Iterator[tuple[str, int, float, float, str]]:
    """Parameter, axis, value, Kp [1/s] and loop, as `LoopGain` has them, of each position gain."""
    points = [dict(at)] if at else _motions(scenario)
    models: dict[int, AxisModel | None] = {}
    for whole, port in _gains(scenario):
        count = port.count if port.shape else 0
        every = range(1, count + 1) if count else (axis or 1,)
        for k in [k for k in every if axis in (None, k)]:
            if k not in models:
                models[k] = _first(scenario, k, points, set_)
            made = models[k]
            if made is not None and (kp := _acting(made, whole)) is not None:
                yield (whole, k if count else 0, made.value(whole), *kp)


def _gains(scenario: Scenario) -> Iterator[tuple[str, Port]]:
    """Parameters that a law calls position gains and that are not in 1/s already."""
    for component, fmu in scenario.document.body.component.items():
        own, ports = law.carried(fmu), scenario.resolver.ports[component]
        for name, kind in own.gain.items() if isinstance(own, law.Law) else ():
            if kind == "position" and ports[name].unit != "1/s":
                yield f"{component}.{name}", ports[name]


def _first(
    scenario: Scenario, axis: int, points: Iterable[dict[str, float]], set_: Mapping[str, Any]
) -> AxisModel | None:
    """The model at the first point that the plants have; None if the axis has none."""
    for at in points:
        try:
            return model(scenario, axis, at, set_)
        except InputError:  # the axis is not active, or an end stop or a load is in the way
            continue
    return None


# CCN 17: half of it are conditions within comprehensions: which plants, wires and outputs.
def _motions(scenario: Scenario) -> list[dict[str, float]]:
    """Slow motions, in both directions, of plants that a law moves: speed by output."""
    found = {}
    said = {c: law.carried(fmu) for c, fmu in scenario.document.body.component.items()}
    wires = [(w.source.component, w.target.component) for w in system.wires(scenario.resolver)]
    for component, own in said.items():
        moved = any(t == component and isinstance(said[s], law.Law) for s, t in wires)
        if not isinstance(own, Ode) or coupled_plant.couples(own) or not moved:
            continue
        ports, shown = scenario.resolver.ports[component], [d.name for d in own.outputs]
        for unit, value in _MOTION.items():
            if speeds := [n for n in shown if n in ports and ports[n].unit == unit]:
                found[f"{component}.{speeds[0]}"] = value
                break
    return [{n: sign * v for n, v in found.items()} for sign in (1.0, -1.0)]
