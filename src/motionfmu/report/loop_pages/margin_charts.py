"""Charts of a loop: Bode, Nyquist, root locus, sensitivity and step."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.freq.response import Response
from motionfmu.analysis.linear.closed_step import chart_length, closed_step
from motionfmu.analysis.linear.stability import Margins, closed_poles, grid, response
from motionfmu.report.diagram import (
    DASH,
    DOT,
    EQUAL,
    CircleMark,
    Diagram,
    LevelMark,
    LineMark,
    Mark,
    PointMark,
    SamplesMark,
    Scale,
    Subplot,
    one,
)
from motionfmu.report.samples import Samples
from motionfmu.report.style import AXES, INK, MUTED

Array = NDArray[np.float64]

BLUE, RED, GREEN = AXES[0], AXES[1], AXES[2]
WIDTH = 2.0  # [pixel] of a line
_POINTS = 600
_RANGE_DB = (-80.0, 80.0)
# The Nyquist plot shows so far around -1, and the root locus so many gains.
_NEAR = 2.5
_GAINS = 241
_STEP_POINTS = 1500
# Heights [pixel]: of a plot of the Bode diagram, of one in a plane, of the others.
_BODE, _PLANE, _LOW = 190, 360, 270


def _decibel(values: NDArray[Any]) -> Array:
    found: Array = 20.0 * np.log10(np.maximum(np.abs(values), 1e-12))
    return found


def bode(found: Margins, measured: Response | None = None) -> Diagram:
    """Magnitude and phase of the open loop, with what was measured."""
    omega = grid(found.loop, _POINTS)
    values = response(found.loop, omega)
    hertz, size = omega / (2.0 * math.pi), _decibel(values)
    angle = np.degrees(np.unwrap(np.angle(values)))
    angle -= 360.0 * round((angle[np.argmin(np.abs(size))] + 180.0) / 360.0)
    sizes: list[Mark] = [LineMark(hertz, size, "linear model", BLUE, WIDTH)]
    angles: list[Mark] = [LineMark(hertz, angle, "linear model", BLUE, WIDTH)]
    if measured is not None:
        w, y = measured.omega, measured.values[:, 0]
        near = np.interp(w, omega, angle)
        lag = np.degrees(np.angle(y))
        lag += 360.0 * np.round((near - lag) / 360.0)
        for marks, dots in ((sizes, _decibel(y)), (angles, lag)):
            marks.append(PointMark(w / (2.0 * math.pi), dots, "running FMUs", RED, size=5.0))
    low, high = max(size.min(), _RANGE_DB[0]), min(size.max(), _RANGE_DB[1])
    shown = angle[(size > low) & (size < high)]
    ends = float(shown.min()) - 15.0, float(shown.max()) + 15.0
    first = hertz[np.flatnonzero(size < _RANGE_DB[1])]
    reach = float(max(hertz[0], first[0]) if first.size else hertz[0]), float(hertz[-1])
    sizes.append(LevelMark(0.0, dash=DASH))
    angles.append(LevelMark(-180.0, dash=DASH))
    for crossing, color in ((found.omega_phase, GREEN), (found.omega_gain, RED)):
        if math.isfinite(crossing):
            mark = LevelMark(crossing / (2.0 * math.pi), color=color, upright=True)
            sizes.append(mark)
            angles.append(mark)
    rows = (
        Subplot(Scale("|L|", "dB", (low - 5.0, high + 5.0)), sizes, _BODE),
        Subplot(Scale("Phase", "°", ends, spacing=90.0), angles, _BODE, legend=False),
    )
    return Diagram((Scale("Frequency", "Hz", reach, log=True),), rows)


def nyquist(found: Margins) -> Diagram:
    """The open loop about -1, with the disk that it keeps out of."""
    values = response(found.loop, grid(found.loop, 3 * _POINTS))
    half = found.disk / 2.0
    marks: list[Mark] = [CircleMark(0.0, 0.0, 1.0, dash=DOT)]
    if found.stable and half < 1.0:
        a, b = -(1.0 + half) / (1.0 - half), -(1.0 - half) / (1.0 + half)
        marks.append(CircleMark((a + b) / 2.0, 0.0, (b - a) / 2.0, RED, filled=True))
    half_rate = "0 to half the sampling rate"
    minus_one = np.array([-1.0]), np.array([0.0]), "\N{MINUS SIGN}1", INK, "cross", 9.0
    marks += [
        LineMark(values.real, values.imag, half_rate, BLUE, WIDTH),
        LineMark(values.real, -values.imag, "its mirror image", BLUE, 1.0, DOT),
        PointMark(*minus_one),
    ]
    real = Scale("Real part", ends=(-1.0 - _NEAR, -1.0 + _NEAR))
    imaginary = Scale("Imaginary part", ends=(-_NEAR, _NEAR))
    return one(real, imaginary, marks, _PLANE, EQUAL)


def locus(found: Margins) -> Diagram:
    """Poles of the closed loop over a factor on the wire."""
    top = found.gain if math.isfinite(found.gain) else 10.0
    factors = np.concatenate([[0.0], np.geomspace(1e-3, 2.0, _GAINS) * top])
    poles = [closed_poles(found.loop, g) for g in factors]
    flat = np.concatenate(poles)
    told = [
        f"factor {g:.4g}\n{z.real:.4f}, {z.imag:.4f}"
        for g, p in zip(factors, poles, strict=True)
        for z in p
    ]
    name = f"factor 0 to {2.0 * top:.3g}"
    marks: list[Mark] = [
        CircleMark(0.0, 0.0, 1.0, INK),
        PointMark(flat.real, flat.imag, name, MUTED, size=3.0, hover=told),
        _poles(poles[0], "factor 0", INK, "x"),
        _poles(closed_poles(found.loop), "as it is", BLUE, "circle"),
    ]
    if math.isfinite(found.gain):
        rings = closed_poles(found.loop, top)
        marks.append(_poles(rings, f"limit, factor {top:.4g}", RED, "diamond"))
    slow = flat[(np.abs(flat) > 0.5) & (np.abs(flat) < 1.3)]
    left = min(float(slow.real.min(initial=0.8)), 0.8) - 0.05
    high = max(float(np.abs(slow.imag).max(initial=0.1)), 0.1) * 1.1
    real = Scale("Real part of z", ends=(left, 1.1))
    return one(real, Scale("Imaginary part of z", ends=(-high, high)), marks, _PLANE, EQUAL)


def _poles(poles: NDArray[Any], name: str, color: str, symbol: str) -> PointMark:
    return PointMark(poles.real, poles.imag, name, color, symbol, 8.0)


def sensitivity(found: Margins) -> Diagram:
    """Magnitude of 1/(1 + L) and L/(1 + L)."""
    omega = grid(found.loop, _POINTS)
    values = response(found.loop, omega)
    hertz = omega / (2.0 * math.pi)
    marks: list[Mark] = [
        LineMark(hertz, _decibel(1.0 / (1.0 + values)), "S = 1/(1 + L)", BLUE, WIDTH),
        LineMark(hertz, _decibel(values / (1.0 + values)), "T = L/(1 + L)", GREEN, WIDTH),
        LevelMark(0.0, dash=DASH),
    ]
    top = 20.0 * math.log10(max(found.sensitivity, found.complementary))
    low = found.bandwidth or omega[-1]
    reach = float(max(hertz[0], low / (2e2 * math.pi))), float(hertz[-1])
    size = Scale("Magnitude", "dB", (-50.0, max(6.0, top + 4.0)))
    return one(Scale("Frequency", "Hz", reach, log=True), size, marks, _LOW)


def step(found: Margins) -> Diagram:
    """Response of L/(1 + L) to a step."""
    time, values = closed_step(found.loop, chart_length(found.loop, found))
    keep = max(1, len(time) // _STEP_POINTS)
    time, values = time[::keep] * 1e3, np.clip(np.nan_to_num(values[::keep], nan=0.0), -3.0, 5.0)
    curve = SamplesMark(Samples(time, values, steps=keep == 1), "L/(1 + L)", BLUE, WIDTH)
    marks: list[Mark] = [curve, LevelMark(1.0, dash=DASH)]
    return one(Scale("Time", "ms"), Scale("Response to a step of 1"), marks, _LOW)
