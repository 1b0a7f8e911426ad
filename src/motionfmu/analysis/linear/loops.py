"""The loops that a scenario closes, and the largest gain with which one is stable."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from motionfmu.analysis.linear.axis import AxisModel
from motionfmu.analysis.linear.block import Plant
from motionfmu.analysis.linear.stability import closed_poles, moving
from motionfmu.analysis.linear.tuning_parts import matrices
from motionfmu.analysis.linear.wiring import Port
from motionfmu.base.errors import InputError

# A gain is searched within this factor of its start.
FACTOR_MAX = 1e4
_WIDEN = 1.5


@dataclass(frozen=True)
class Limit:
    """The largest gain with which a loop is stable.

    Attributes
    ----------
    gain : float
        Value of the parameter, or factor on the wire; infinite if none was found.
    omega : float
        Frequency at which it rings there [rad/s]; NaN if none was found.
    evaluations : int
        Gains tried.
    """

    gain: float
    omega: float
    evaluations: int


def feedbacks(axis: AxisModel) -> dict[str, tuple[str, ...]]:
    """Inputs that feed a plant back, and what is cut for each.

    An outer loop has the inner ones closed; an inner loop has the outer ones cut, which are
    those of blocks that do not lie on its way to the plant.

    Parameters
    ----------
    axis : AxisModel

    Returns
    -------
    dict
        Names of inputs to be cut, by the name of the input at which a loop is opened; outer
        loops first.
    """
    sensors = [
        t
        for t, s in axis.wires.items()
        if isinstance(axis.blocks[s[0]], Plant)
        and not isinstance(axis.blocks[t[0]], Plant)
        and "[" not in t[1]  # loops of axes that are coupled stay closed
    ]
    found = {}
    for target in sensors:
        on = _way(axis, target)
        cut = tuple(sorted(".".join(t) for t in sensors if t != target and t[0] not in on))
        name = ".".join(target)
        try:
            around = matrices(axis, [name], [".".join(axis.wires[target])], (name, *cut))
        except InputError:
            continue
        if around.states or around.d.any():  # else the input is read, but has no effect
            found[name] = cut
    return dict(sorted(found.items(), key=lambda pair: len(pair[1])))


def _way(axis: AxisModel, start: Port) -> set[str]:
    """Components between an input and the plants on which it acts."""
    found, left = {start[0]}, [start[0]]
    while left:
        component = left.pop()
        for target, source in axis.wires.items():
            further = target[0]
            if source[0] == component and further not in found:
                if not isinstance(axis.blocks[further], Plant):
                    found.add(further)
                    left.append(further)
    return found


def largest_gain(
    axis: AxisModel, at: str, cut: tuple[str, ...] = (), gain: str | None = None
) -> Limit:
    """The largest gain of a loop, from the poles of the linear model.

    Parameters
    ----------
    axis : AxisModel
    at : str
        The input at which the loop is closed, ``component.variable``.
    cut : tuple of str
        Inputs of other loops that are cut.
    gain : str, optional
        A parameter, ``component.variable``; else a factor on the wire to `at`.

    Returns
    -------
    Limit
        For a whole-number parameter between the last stable value and the next one.

    Raises
    ------
    InputError
        A name is unknown, or the parameter is 0 or no number.
    """
    if gain is None:
        loop = axis.loop(at, cut)

        def poles(value: float) -> np.ndarray:
            return closed_poles(loop, value)
    else:

        def poles(value: float) -> np.ndarray:
            return closed_poles(axis.changed({gain: _of_axis(axis, gain, value)}).loop(at, cut))

    period = axis.loop(at, cut).dt

    def growth(value: float) -> float:
        size = np.abs(moving(poles(value))).max(initial=0.0)
        return math.log(max(float(size), 1e-300)) / period

    found, tried = boundary(growth, begin(axis, gain), 1e-9, is_whole(axis, gain))
    if not math.isfinite(found):
        return Limit(found, math.nan, tried)
    ringing = moving(poles(round(found) if is_whole(axis, gain) else found))
    worst = ringing[np.argmax(np.abs(ringing))]
    return Limit(found, float(abs(np.angle(worst)) / period), tried)


def is_whole(axis: AxisModel, gain: str | None) -> bool:
    """Whether a gain takes whole numbers only."""
    return gain is not None and isinstance(axis.value(gain), int)


def begin(axis: AxisModel, gain: str | None) -> float:
    """The start of a search for a gain: its value, which must be above 0."""
    if gain is None:
        return 1.0
    value = axis.value(gain)
    if isinstance(value, bool | str) or not value > 0:
        raise InputError(f"gain {gain} = {value!r}: a number above 0 wanted")
    return float(value)


def _of_axis(axis: AxisModel, gain: str, value: float) -> list[float] | float:
    """The parameter with another value for this axis alone."""
    component, _, name = gain.partition(".")
    port = axis.scenario.resolver.ports[component][name]
    number = round(value) if port.type == "Int32" else float(value)
    if not port.shape:
        return number
    own = axis.value(gain)
    listed = [type(own)(own)] * port.count
    listed[axis.axis - 1] = number
    return listed


def with_gain(axis: AxisModel, gain: str, value: float) -> AxisModel:
    """The model with a value for this axis alone, rounded if whole."""
    return axis.changed({gain: _of_axis(axis, gain, value)})


def boundary(
    growth: Callable[[float], float], start: float, tolerance: float, whole: bool
) -> tuple[float, int]:
    """The value at which a growth [1/s] turns positive, and the calls.

    The value is infinite if all is stable to `FACTOR_MAX` times the start, and 0 if nothing is.
    The search ends at a relative width; the rest is interpolated.
    """
    tried: dict[float, float] = {}

    def rate(value: float) -> float:
        asked = float(max(round(value), 1)) if whole else value
        if asked not in tried:
            tried[asked] = growth(asked)
        return tried[asked]

    low, high = start, start
    try:
        while rate(high) < 0.0:
            low, high = high, high * _WIDEN + (1.0 if whole else 0.0)
            if high > start * FACTOR_MAX:
                return math.inf, len(tried)
        while rate(low) >= 0.0:
            high, low = low, low / _WIDEN
            if low < start / FACTOR_MAX or (whole and round(low) < 1):
                return 0.0, len(tried)
    except InputError:
        return math.inf, len(tried)  # the parameter takes no larger value
    if whole:
        low, high = float(round(low)), float(round(high))
    while high - low > tolerance * high and not (whole and high - low <= 1.0):
        middle = 0.5 * (low + high)
        middle = float(round(middle)) if whole else middle
        if rate(middle) < 0.0:
            low = middle
        else:
            high = middle
    below, above = rate(low), rate(high)
    return low - below * (high - low) / (above - below), len(tried)
