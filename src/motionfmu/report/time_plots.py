"""The interactive plots over time."""

from typing import Any

import numpy as np

from motionfmu.contour import ContourResult
from motionfmu.contour.geometry import Array
from motionfmu.report.decimate import keep_peaks
from motionfmu.report.numbers import length, unit
from motionfmu.report.packed import packed
from motionfmu.report.style import AXES, HEAT, INK, axis, layout, plotted

Figure = dict[str, Any]

BUCKETS = 1200
TIME = "Time [s]"
ROOM = 0.16  # above and below the error, for the label of its peak
NAMES = "XYZUVW"


def error_figure(contour: ContourResult) -> Figure:
    """Contour error against time."""
    track, time = contour.track, contour.run.time
    value = track.distance if track.signed is None else track.signed
    factor, name = unit(contour.error.max)
    value = np.where(contour.cutting, value, np.nan) * factor
    kept = keep_peaks(np.where(contour.cutting, value, 0.0), 2 * BUCKETS)
    lines = np.array([s.label.line for s in contour.run.path.segments])[track.segment]
    trace = _series(time[kept], value[kept], "contour error", HEAT[2])
    trace["customdata"] = packed(lines[kept])
    trace["hovertemplate"] = "%{y:.4g} " + name + ", line %{customdata}<extra></extra>"
    worst = int(np.searchsorted(time, contour.error.time))
    peak = {
        "type": "scatter",
        "mode": "markers+text",
        "x": [contour.error.time],
        "y": [float(value[worst])],
        "text": [f"{length(contour.error.max)}, line {contour.error.line}"],
        "textposition": _text_side(contour.error.time, time, float(value[worst])),
        "textfont": {"size": 12, "color": INK},
        "marker": {"size": 9, "color": "rgba(0,0,0,0)", "line": {"color": INK, "width": 1.5}},
        "hoverinfo": "skip",
        "showlegend": False,
        "cliponaxis": False,
    }
    trace["showlegend"] = False
    low, high = float(np.nanmin(value)), float(np.nanmax(value))
    room = ROOM * max(high - low, 1e-6)
    low, high = min(low, 0.0), max(high, 0.0)
    more = _axis(f"Contour error [{name}]", range=[low - room, high + room])
    return {"data": [trace, peak], "layout": _over_time(270, time, yaxis=more)}


def _text_side(at: float, time: Array, value: float) -> str:
    """Where the label of the peak has room."""
    middle = 0.5 * (time[0] + time[-1])
    return ("top " if value >= 0.0 else "bottom ") + ("right" if at < middle else "left")


def following_figure(contour: ContourResult) -> Figure:
    """Following error of each axis against time."""
    time, value = contour.run.time, contour.following
    factor, name = unit(float(np.abs(value).max()))
    traces = []
    for i in contour.run.axes:
        kept = keep_peaks(value[:, i], BUCKETS)
        traces.append(_series(time[kept], value[kept, i] * factor, NAMES[i], AXES[i]))
    more = _axis(f"Following error [{name}]")
    return {"data": traces, "layout": _over_time(270, time, yaxis=more)}


def fifo_figure(contour: ContourResult) -> Figure | None:
    """FIFO stock and interrupts against time; None without either."""
    run = contour.run
    traces: list[Figure] = []
    rows = []
    if run.stock is not None:
        stock = run.stock if run.stock.ndim == 1 else run.stock[:, list(run.axes)].min(axis=1)
        kept = keep_peaks(stock.astype(float), BUCKETS)
        trace = _series(run.time[kept], stock[kept], "FIFO stock", AXES[0], shape="hv")
        traces.append(trace | {"fill": "tozeroy", "fillcolor": "rgba(0,114,178,0.12)"})
        rows.append("FIFO stock<br>[commands]")
    if run.interrupts is not None:
        at = run.time[1:][np.diff(run.interrupts) > 0]
        between = np.diff(at) * 1e3
        kept = keep_peaks(between, BUCKETS) if len(between) else np.empty(0, dtype=np.int64)
        trace = _series(at[1:][kept], between[kept], "interrupts", AXES[1])
        trace |= {"mode": "markers", "marker": {"size": 4, "color": AXES[1]}}
        traces.append(trace)
        rows.append("Since last<br>interrupt [ms]")
    if not traces:
        return None
    more: Figure = {}
    for i, (trace, title) in enumerate(zip(traces, rows, strict=True)):
        low = 0.0 if i == len(rows) - 1 else 0.54
        high = 1.0 if i == 0 else 0.46
        key = "" if i == 0 else "2"
        trace |= {"yaxis": "y" + key, "showlegend": False}
        more["yaxis" + key] = _axis(title, domain=[low, high], rangemode="tozero", nticks=5)
    figure = _over_time(300 if len(rows) == 2 else 230, run.time, **more)
    figure["xaxis"]["anchor"] = "y2" if len(rows) == 2 else "y"
    return {"data": traces, "layout": figure}


def trace_figures(contour: ContourResult) -> list[tuple[str, Figure]]:
    """Titles and figures of the further signals against time."""
    out = []
    for trace in contour.run.traces:
        columns = trace.values.reshape(len(contour.run.time), -1)
        series = []
        for i in contour.run.axes if columns.shape[1] > 1 else (0,):
            kept = keep_peaks(columns[:, i], BUCKETS)
            name = NAMES[i] if columns.shape[1] > 1 else trace.name
            series.append(_series(contour.run.time[kept], columns[kept, i], name, AXES[i]))
            series[-1]["showlegend"] = columns.shape[1] > 1
        title = f"{trace.name} [{trace.unit}]" if trace.unit else trace.name
        figure = _over_time(230, contour.run.time, yaxis=_axis(title))
        out.append((trace.name, {"data": series, "layout": figure}))
    return out


def _series(time: Array, values: Array, name: str, color: str, shape: str = "linear") -> Figure:
    return plotted(time, values, name, color, width=1.4, shape=shape)


def _axis(title: str, **more: Any) -> Figure:
    """A vertical axis; its margin is fixed, so that all plots over time line up."""
    return axis(title, automargin=False, **more)


def _over_time(height: int, time: Array, **more: Any) -> Figure:
    ends = [float(time[0]), float(time[-1])]
    axes = {"xaxis": axis(TIME, range=ends), "hovermode": "x"}
    return layout(height, **(axes | {"margin": {"l": 84, "r": 20, "t": 34, "b": 48}} | more))
