"""Pictures of a loop: Bode, Nyquist, root locus, sensitivity and step."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.freq.loop_study import LoopStudy
from motionfmu.analysis.linear.stability import closed_poles, grid, response
from motionfmu.report.packed import packed
from motionfmu.report.samples import Samples, sampled
from motionfmu.report.style import AXES, INK, MUTED, axis, layout, plotted

Figure = dict[str, Any]
Array = NDArray[np.float64]

BLUE, RED, GREEN = AXES[0], AXES[1], AXES[2]
_POINTS = 600
_RANGE_DB = (-80.0, 80.0)
# The Nyquist plot shows so far around -1, and the root locus so many gains.
_NEAR = 2.5
_GAINS = 241
_STEP_POINTS = 1500


def _line(x: Array, y: Array, name: str, color: str, **more: Any) -> Figure:
    return plotted(x, y, name, color, width=2) | more


def _decibel(values: NDArray[Any]) -> Array:
    found: Array = 20.0 * np.log10(np.maximum(np.abs(values), 1e-12))
    return found


def bode(study: LoopStudy) -> Figure:
    """Magnitude and phase of the open loop, with what was measured."""
    omega = grid(study.loop, _POINTS)
    values = response(study.loop, omega)
    hertz, size = omega / (2.0 * math.pi), _decibel(values)
    angle = np.degrees(np.unwrap(np.angle(values)))
    angle -= 360.0 * round((angle[np.argmin(np.abs(size))] + 180.0) / 360.0)
    data = [
        _line(hertz, size, "linear model", BLUE),
        _line(hertz, angle, "", BLUE, yaxis="y2", showlegend=False),
    ]
    if study.measured is not None:
        w, y = study.measured.omega, study.measured.values[:, 0]
        near = np.interp(w, omega, angle)
        lag = np.degrees(np.angle(y))
        lag += 360.0 * np.round((near - lag) / 360.0)
        dots = {"mode": "markers", "marker": {"color": RED, "size": 5, "line": {"width": 0}}}
        data += [
            _line(w / (2.0 * math.pi), _decibel(y), "running FMUs", RED) | dots,
            _line(w / (2.0 * math.pi), lag, "", RED, yaxis="y2", showlegend=False) | dots,
        ]
    low, high = max(size.min(), _RANGE_DB[0]), min(size.max(), _RANGE_DB[1])
    shown = angle[(size > low) & (size < high)]
    ends = [float(shown.min()) - 15.0, float(shown.max()) + 15.0]
    reach = [math.log10(hertz[0]), math.log10(hertz[-1])]
    first = hertz[np.flatnonzero(size < _RANGE_DB[1])]
    if first.size:
        reach[0] = max(reach[0], math.log10(first[0]))
    shapes = [_level(0.0, "y"), _level(-180.0, "y2")]
    for crossing, color in ((study.margins.omega_phase, GREEN), (study.margins.omega_gain, RED)):
        if math.isfinite(crossing):
            shapes.append(_upright(crossing / (2.0 * math.pi), color))
    more = {
        "xaxis": axis("frequency [Hz]", type="log", range=reach, anchor="y2"),
        "yaxis": axis("|L| [dB]", domain=[0.55, 1.0], range=[low - 5.0, high + 5.0]),
        "yaxis2": axis("phase [°]", domain=[0.0, 0.45], range=ends, dtick=90),
        "shapes": shapes,
    }
    return {"data": data, "layout": layout(520, **more)}


def _level(value: float, on: str) -> Figure:
    style = {"color": MUTED, "width": 1, "dash": "dash"}
    ends = {"x0": 0, "x1": 1, "y0": value, "y1": value}
    return {"type": "line", "xref": "paper", "yref": on, "line": style} | ends


def _upright(hertz: float, color: str) -> Figure:
    style = {"color": color, "width": 1, "dash": "dot"}
    ends = {"x0": hertz, "x1": hertz, "y0": 0, "y1": 1}
    return {"type": "line", "xref": "x", "yref": "paper", "line": style} | ends


def _circle(x: float, y: float, radius: float, **line: Any) -> Figure:
    ends = {"x0": x - radius, "x1": x + radius, "y0": y - radius, "y1": y + radius}
    return {"type": "circle", "xref": "x", "yref": "y", "line": line} | ends


def nyquist(study: LoopStudy) -> Figure:
    """The open loop about -1, with the disk that it keeps out of."""
    values = response(study.loop, grid(study.loop, 3 * _POINTS))
    half = study.margins.disk / 2.0
    shapes = [_circle(0.0, 0.0, 1.0, color=MUTED, width=1, dash="dot")]
    if study.margins.stable and half < 1.0:
        ends = -(1.0 + half) / (1.0 - half), -(1.0 - half) / (1.0 + half)
        disk = _circle(sum(ends) / 2.0, 0.0, (ends[1] - ends[0]) / 2.0, color=RED, width=1)
        shapes.append(disk | {"fillcolor": "rgba(213,94,0,0.10)"})
    point = _line(np.array([-1.0]), np.array([0.0]), "\N{MINUS SIGN}1", INK)
    mark = {"mode": "markers", "marker": {"symbol": "cross", "size": 9, "color": INK}}
    data = [
        _line(values.real, values.imag, "0 to half the sampling rate", BLUE),
        _line(values.real, -values.imag, "its mirror image", BLUE)
        | {"line": {"color": BLUE, "width": 1, "dash": "dot"}},
        point | mark,
    ]
    more = {
        "xaxis": axis("real part", range=[-1.0 - _NEAR, -1.0 + _NEAR]),
        "yaxis": axis("imaginary part", range=[-_NEAR, _NEAR], scaleanchor="x"),
        "shapes": shapes,
    }
    return {"data": data, "layout": layout(440, **more)}


def locus(study: LoopStudy) -> Figure:
    """Poles of the closed loop over a factor on the wire."""
    top = study.margins.gain if math.isfinite(study.margins.gain) else 10.0
    factors = np.concatenate([[0.0], np.geomspace(1e-3, 2.0, _GAINS) * top])
    poles = [closed_poles(study.loop, g) for g in factors]
    flat = np.concatenate(poles)
    text = [f"factor {g:.4g}" for g, p in zip(factors, poles, strict=True) for _ in p]
    data = [
        {
            "type": "scatter",
            "mode": "markers",
            "x": packed(flat.real),
            "y": packed(flat.imag),
            "text": text,
            "name": f"factor 0 to {2.0 * top:.3g}",
            "marker": {"size": 3, "color": MUTED},
            "hovertemplate": "%{text}<br>%{x:.4f}, %{y:.4f}<extra></extra>",
        },
        _marks(poles[0], "factor 0", INK, "x"),
        _marks(closed_poles(study.loop), "as it is", BLUE, "circle"),
    ]
    if math.isfinite(study.margins.gain):
        rings = closed_poles(study.loop, top)
        data.append(_marks(rings, f"limit, factor {top:.4g}", RED, "diamond"))
    slow = flat[(np.abs(flat) > 0.5) & (np.abs(flat) < 1.3)]
    left = min(float(slow.real.min(initial=0.8)), 0.8) - 0.05
    high = max(float(np.abs(slow.imag).max(initial=0.1)), 0.1) * 1.1
    more = {
        "xaxis": axis("real part of z", range=[left, 1.1]),
        "yaxis": axis("imaginary part of z", range=[-high, high], scaleanchor="x"),
        "shapes": [_circle(0.0, 0.0, 1.0, color=INK, width=1)],
    }
    return {"data": data, "layout": layout(440, **more)}


def _marks(poles: NDArray[Any], name: str, color: str, symbol: str) -> Figure:
    marker = {"size": 8, "color": color, "symbol": symbol}
    return _line(poles.real, poles.imag, name, color) | {"mode": "markers", "marker": marker}


def sensitivity(study: LoopStudy) -> Figure:
    """Magnitude of 1/(1 + L) and L/(1 + L)."""
    omega = grid(study.loop, _POINTS)
    values = response(study.loop, omega)
    hertz = omega / (2.0 * math.pi)
    data = [
        _line(hertz, _decibel(1.0 / (1.0 + values)), "S = 1/(1 + L)", BLUE),
        _line(hertz, _decibel(values / (1.0 + values)), "T = L/(1 + L)", GREEN),
    ]
    top = 20.0 * math.log10(max(study.margins.sensitivity, study.margins.complementary))
    low = study.margins.bandwidth or omega[-1]
    reach = [math.log10(max(hertz[0], low / (2e2 * math.pi))), math.log10(hertz[-1])]
    more = {
        "xaxis": axis("frequency [Hz]", type="log", range=reach),
        "yaxis": axis("magnitude [dB]", range=[-50.0, max(6.0, top + 4.0)]),
        "shapes": [_level(0.0, "y")],
    }
    return {"data": data, "layout": layout(360, **more)}


def step(study: LoopStudy) -> Figure:
    """Response of L/(1 + L) to a step."""
    loop = study.loop
    k = 1.0 / (1.0 + loop.D[0, 0])
    a = loop.A - loop.B @ loop.C * k
    b, c, d = loop.B * k, loop.C * k, loop.D[0, 0] * k
    omega = study.margins.bandwidth
    length = 30.0 / omega if omega > 0.0 else _STEP_POINTS * loop.dt
    count = max(20, min(math.ceil(length / loop.dt), 200_000))
    keep = max(1, count // _STEP_POINTS)
    x, shown = np.zeros((loop.nstates, 1)), []
    for n in range(count):
        if n % keep == 0:
            shown.append(float((c @ x)[0, 0] + d))
        x = a @ x + b
    time = np.arange(len(shown)) * (keep * loop.dt * 1e3)
    values = np.clip(np.nan_to_num(np.array(shown), nan=0.0), -3.0, 5.0)
    drawn = sampled(Samples(time, values, steps=keep == 1), "L/(1 + L)", BLUE, width=2)
    more = {
        "xaxis": axis("Time [ms]"),
        "yaxis": axis("response to a step of 1"),
        "shapes": [_level(1.0, "y")],
    }
    return {"data": [drawn], "layout": layout(360, **more)}
