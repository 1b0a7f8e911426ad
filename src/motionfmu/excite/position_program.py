"""An excitation as a part program that a mill can run.

The axis that is measured moves by a multisine about a steady speed while another one carries the
time. The path is driven at one feed, so a controller has no feed to change, only a smooth curve to
follow. Look-ahead (G64 P) is wanted. Its planner says how large the multisine may be.
"""

import math
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.cycle_time import planned
from motionfmu.base.errors import InputError
from motionfmu.excite.axis_excitation import (
    AxisExcitation,
    ExcitedAxis,
    ExciteOptions,
    multisine_of,
)
from motionfmu.excite.crest_factor import waves
from motionfmu.run import Scenario
from motionfmu.scenarios.machine_limits import AxisLimit

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
# Highest frequency of a program [Hz], and lines of text per shortest period.
_HIGH, _POINTS = 10.0, 20
_FINE = 20  # integration steps per line of text
# Feed over the largest speed of the axis.
_FEED = 1.2
# Share by which the planner may need longer than at steady speed, and the smallest signal tried.
_LATE, _SMALLEST = 0.005, 0.05
_TOLERANCE = 0.02  # [mm] of G64 P


@dataclass(frozen=True)
class PositionProgram:
    """A part program with a multisine of one axis.

    Attributes
    ----------
    text : str
        Of the program.
    time, feed : ndarray, shape (n,)
        [s] at the beginning of each line, and its speed of the axis [mm/min].
    hertz, amplitudes : ndarray
        Lines, and their amplitudes of position [mm].
    high : float
        [Hz].
    share : float
        Of what speed, torque and travel allow, that the planner follows.
    words : tuple of str
        What it is, in sentences.
    """

    text: str
    time: Array
    feed: Array
    hertz: Array
    amplitudes: Array
    high: float
    share: float
    words: tuple[str, ...]


@dataclass(frozen=True)
class _Plane:
    """The two axes, with their names and travels [mm]."""

    name: str
    other: str
    centre: tuple[float, float]
    room: tuple[float, float]


def part_program(made: AxisExcitation) -> PositionProgram | None:
    """Make a part program at frequencies that a path can have.

    Parameters
    ----------
    made : AxisExcitation

    Returns
    -------
    PositionProgram or None
        None where no controller takes programs, another axis is missing, or there is no room.
    """
    scenario = made.axis.scenario
    signals = scenario.document.body.signals
    plane = _plane(made)
    moved = _commanded(made)
    if signals is None or signals.program is None or plane is None or moved is None:
        return None
    o = moved.options
    lines = np.arange(math.ceil(o.low * o.period - 1e-9), int(_HIGH * o.period + 1e-9) + 1)
    if len(lines) < 2:
        return None
    n = round(o.period * _HIGH * _POINTS) * _FINE
    try:
        sized = multisine_of(moved, lines, n)
    except InputError:
        return None
    per = 1e3 * moved.per * moved.masses.ratio  # [mm] of the load per unit of the command
    sines, speed = per * sized.sines, 1e3 * sized.speed * moved.masses.ratio
    share = 1.0
    while share >= _SMALLEST:
        found = _program(plane, (share * sines, speed), (lines, n), o)
        steady = _program(plane, (0.0 * sines, speed), (lines, n), o)
        try:
            seconds = [_seconds(scenario, signals.program, p.text) for p in (found, steady)]
        except InputError:
            return None
        if seconds[0] <= (1.0 + _LATE) * seconds[1]:
            return replace(found, share=share, words=_words(plane, found, share))
        share *= 0.7
    return None


def _commanded(made: AxisExcitation) -> ExcitedAxis | None:
    """The axis moved by a command of its position, from as far outside as there is one."""
    low = made.options.low
    options = replace(made.options, high=_HIGH, low=low, seed=None, speed=None)
    for name in made.axis.inputs:
        port = made.axis.port(name, made.axis.inputs, "input")
        wire = made.axis.wires.get(port)
        if wire is not None and wire[0] == made.masses.component:
            continue  # a feedback
        try:
            moved = ExcitedAxis(
                made.axis.scenario, made.given, replace(options, input=name), inside=True
            )
        except InputError:
            continue
        if not moved.is_rate:
            return moved
    return None


# CCN 16: what is no straight axis with a travel is passed over, condition by condition.
def _plane(made: AxisExcitation) -> _Plane | None:
    """The axis and the first other one; None if there is none."""
    scenario = made.axis.scenario
    if not scenario.document.body.limits:
        return None
    own: AxisLimit | None = None
    others: list[AxisLimit] = []
    for limit in scenario.axis_limits(made.given):
        if limit.low is None or limit.high is None or limit.axis.kind != "linear":
            continue
        if len(limit.axis.name) != 1 or limit.unit not in ("m", "mm"):
            continue
        if limit.element == made.axis.axis - 1:
            own = limit
        else:
            others.append(limit)
    if own is None or not others:
        return None
    other = others[0]
    scale = [1e3 if r.unit == "m" else 1.0 for r in (own, other)]
    ends = [
        (s * float(r.low or 0), s * float(r.high or 0))
        for r, s in zip((own, other), scale, strict=True)
    ]
    return _Plane(
        own.axis.name,
        other.axis.name,
        (0.5 * sum(ends[0]), 0.5 * sum(ends[1])),
        (ends[0][1] - ends[0][0], ends[1][1] - ends[1][0]),
    )


def _program(
    plane: _Plane, moved: tuple[Complex, float], of: tuple[NDArray[np.int64], int], o: ExciteOptions
) -> PositionProgram:
    """The program, for position amplitudes [mm] and a speed [mm/s]; smaller if room is scarce."""
    sines, speed = moved
    lines, n = of
    period, periods, margin = o.period, o.periods + 1, o.margin
    omega = 2.0 * math.pi * lines / period
    rate = speed + np.tile(waves(1j * omega * sines, lines, n), periods)
    step = period / n
    feed = _FEED * float(np.abs(rate).max())
    beside = np.sqrt(feed * feed - rate * rate)
    x, y = (np.concatenate([[0.0], np.cumsum(v)]) * step for v in (rate, beside))
    # all of it is proportional, so it is made to fit
    fits = min(1.0, margin * plane.room[0] / np.ptp(x), margin * plane.room[1] / y[-1])
    x, y, feed, sines = fits * x, fits * y, fits * feed, fits * sines
    x += plane.centre[0] - 0.5 * (x.max() + x.min())
    y += plane.centre[1] - 0.5 * y[-1]
    at = np.arange(0, len(x), _FINE)
    px, py = x[at], y[at]
    a, b = plane.name, plane.other
    text = [
        f"({a} by a multisine of {lines[0] / period:g} to {lines[-1] / period:g} Hz)",
        f"({periods} periods of {period:g} s; {b} carries the time at one feed.)",
        f"G21 G90 G94 G64 P{_TOLERANCE:g}",
        f"G0 {a}{px[0]:.4f} {b}{py[0]:.4f}",
        f"G1 F{60.0 * feed:.3f}",
        *(f"G1 {a}{u:.4f} {b}{v:.4f}" for u, v in zip(px[1:], py[1:], strict=True)),
        "M2",
    ]
    times: Array = np.asarray(at[:-1] * step, dtype=np.float64)
    return PositionProgram(
        "\n".join(text) + "\n",
        times,
        60.0 * np.diff(px) / (step * _FINE),
        lines / period,
        np.abs(sines),
        float(lines[-1] / period),
        1.0,
        (),
    )


def _seconds(scenario: Scenario, parameter: str, text: str) -> float:
    """How long the controller will take for a program, by its own planner [s]."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "program.ngc"
        file.write_text(text, encoding="utf-8")
        return float(planned(scenario, {parameter: str(file)}).time)


def _words(plane: _Plane, program: PositionProgram, share: float) -> tuple[str, ...]:
    found = [
        f"program.ngc moves {plane.name} by {len(program.hertz)} lines up to {program.high:g} Hz"
        f" while {plane.other} carries the time at one feed: {len(program.feed)} lines of text."
    ]
    if share < 1.0:
        found.append(
            f"The controller's planner follows {100 * share:.0f} % of what speed, torque and travel"
            " would allow without slowing down."
        )
    return tuple(found)
