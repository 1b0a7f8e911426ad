"""The interactive ballbar plot of a circular test."""

import math
from typing import Any

import numpy as np

from motionfmu.analysis.contour.arcs import Array
from motionfmu.analysis.contour.circles import CirclePass, CircularTest
from motionfmu.report.numbers import MINUS, round_up
from motionfmu.report.packed import packed
from motionfmu.report.style import CCW, CW, GRID, INK, MUTED, layout
from motionfmu.run.decimate import keep_peaks

Figure = dict[str, Any]

BUCKETS = 500
LABELS_AT = 67.5  # [deg]
RING_MIN = 0.1  # [um] finer than any pulse
NAMES = "XYZ"


def polar_figure(test: CircularTest) -> Figure:
    """Radial deviation of a circle, as a ballbar shows it."""
    traces, top = [], 0.0
    for way, name, color, dash in (
        (test.ccw, "counter-clockwise", CCW, "solid"),
        (test.cw, "clockwise", CW, "solid"),
    ):
        if way is None:
            continue
        angle, deviation = polar_trace(way, test.radius)
        top = max(top, float(np.abs(deviation).max()))
        traces.append(
            {
                "type": "scatterpolar",
                "mode": "lines",
                "name": name,
                "theta": packed(angle),
                "r": packed(deviation),
                "line": {"color": color, "width": 2, "dash": dash},
                "hovertemplate": "%{theta:.1f}°: %{r:.2f} µm<extra>" + name + "</extra>",
            }
        )
    return polar_rings(traces, top, polar_names(test.axes))


def polar_rings(traces: list[Figure], top: float, names: list[str]) -> Figure:
    """Curves of deviations to `top` [µm] over an angle [°], about the nominal circle."""
    ring = round_up(max(top, RING_MIN))
    nominal = {
        "type": "scatterpolar",
        "mode": "lines",
        "name": "nominal circle",
        "theta": list(range(0, 361, 2)),
        "r": [0.0] * 181,
        "line": {"color": INK, "width": 1.3, "dash": "dash"},
        "hoverinfo": "skip",
    }
    labels = {
        "type": "scatterpolar",
        "mode": "text",
        "theta": [LABELS_AT] * 3,
        "r": [-ring, 0.0, ring],
        "text": [f"{MINUS}{ring:g} µm", "0", f"+{ring:g} µm"],
        "textfont": {"size": 12, "color": MUTED},
        "hoverinfo": "skip",
        "showlegend": False,
    }
    more = {
        "margin": {"l": 40, "r": 40, "t": 56, "b": 30},
        "legend": layout(0)["legend"] | {"y": 1.07},
        "polar": {
            "bgcolor": "#ffffff",
            "radialaxis": {
                "range": [-2.2 * ring, 1.05 * ring],
                "tickvals": [-ring, -0.5 * ring, 0.0, 0.5 * ring, ring],
                "showticklabels": False,
                "gridcolor": GRID,
                "linecolor": "rgba(0,0,0,0)",
                "ticks": "",
            },
            "angularaxis": {
                "tickvals": list(range(0, 360, 45)),
                "ticktext": names,
                "tickfont": {"size": 12, "color": INK},
                "gridcolor": GRID,
                "linecolor": GRID,
            },
        },
    }
    return {"data": [nominal, *traces, labels], "layout": layout(520, **more)}


def polar_names(axes: Array) -> list[str]:
    """Labels at 0, 45, ... degrees: the axes' names at the quarters."""
    first, second = (NAMES[int(np.argmax(np.abs(a)))] for a in axes)
    return [
        f"+{first}",
        "45°",
        f"+{second}",
        "135°",
        f"{MINUS}{first}",
        "225°",
        f"{MINUS}{second}",
        "315°",
    ]


def polar_trace(way: CirclePass, radius: float) -> tuple[Array, Array]:
    """Angle [°] and radial deviation [µm] of one way, decimated."""
    deviation = np.hypot(way.points[:, 0], way.points[:, 1]) - radius
    kept = keep_peaks(deviation, BUCKETS)
    angle = np.arctan2(way.points[kept, 1], way.points[kept, 0])
    return angle * 180.0 / math.pi, deviation[kept] * 1e3
