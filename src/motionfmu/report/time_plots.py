"""The interactive plots over time."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from motionfmu.analysis.contour import ContourResult
from motionfmu.analysis.contour.arcs import Array
from motionfmu.base.columns import in_blocks
from motionfmu.report.numbers import label, length, unit
from motionfmu.report.samples import Samples, sampled
from motionfmu.report.style import AXES, HEAT, INK, MUTED, RAPID, axis, layout
from motionfmu.run.decimate import Read, ends, reader
from motionfmu.run.tool_gap import ToolGap

Figure = dict[str, Any]

TIME = "Time [s]"
ROOM = 0.16  # above and below the error, for the label of its peak
NAMES = "XYZUVW"


@dataclass(frozen=True)
class Speeds:
    """Speeds of a tool over time, in one unit."""

    time: Array  # (n,) [s]
    tool: Array  # (n,)
    planned: Array | None  # (n,) by the controller
    programmed: Array | None  # (n,) NaN where nothing is
    unit: tuple[str, str]  # and what the tool's is from
    done: float | None  # when the program was done [s]


def error_figure(contour: ContourResult) -> Figure:
    """Contour error against time."""
    track, time = contour.track, contour.run.time
    factor, name = unit(contour.error.max)

    def error(first: int, last: int) -> Array:
        own = slice(first, last)
        value = np.where(contour.cutting[own], track.distance[own], np.nan) * factor
        return value if track.right is None else np.where(track.right[own], -value, value)

    def lines(first: int, last: int) -> Array:
        return contour.run.path.lines[track.segment[first:last]]

    samples = Samples.made(time, error, lines=lines)
    trace = sampled(samples, "contour error", HEAT[2])
    trace["hovertemplate"] = "%{y:.4g} " + name + ", line %{customdata}<extra></extra>"
    worst = int(np.searchsorted(time, contour.error.time))
    highest = float(error(worst, worst + 1)[0])
    peak = {
        "type": "scatter",
        "mode": "markers+text",
        "x": [contour.error.time],
        "y": [highest],
        "text": [f"{length(contour.error.max)}, line {contour.error.line}"],
        "textposition": _text_side(contour.error.time, time, highest),
        "textfont": {"size": 12, "color": INK},
        "marker": {"size": 9, "color": "rgba(0,0,0,0)", "line": {"color": INK, "width": 1.5}},
        "hoverinfo": "skip",
        "showlegend": False,
        "cliponaxis": False,
    }
    trace["showlegend"] = False
    low, high = float(np.nanmin(samples.values)), float(np.nanmax(samples.values))
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
    run = contour.run
    commanded, actual = reader(run.commanded), reader(run.actual)

    def following(first: int, last: int) -> Array:
        return commanded(first, last) - actual(first, last)

    def of_axis(i: int) -> Read:
        return lambda first, last: following(first, last)[:, i] * factor

    top = max(float(np.abs(end).max()) for end in ends(len(run.time), following))
    factor, name = unit(top)
    shown = [(NAMES[i], of_axis(i), AXES[i]) for i in run.axes]
    return _curves(run.time, shown, f"Following error [{name}]", 270)


def gap_figure(time: Array, tool: ToolGap) -> Figure:
    """How far a tool is from its command against time, and how it is turned from it."""
    factor, name = unit(tool.sizes[0].largest)
    curves = [(lambda first, last: factor * tool.distance(first, last), f"Distance [{name}]")]
    if tool.angle is not None:
        curves.append((tool.angle, "Attitude [°]"))
    return _panels(
        time,
        [
            (sampled(Samples.made(time, read), title.partition(" [")[0], AXES[i]), title, True)
            for i, (read, title) in enumerate(curves)
        ],
    )


def fifo_figure(contour: ContourResult) -> Figure | None:
    """FIFO stock and interrupts against time; None without either."""
    run = contour.run
    rows: list[tuple[Figure, str, bool]] = []
    if run.stock is not None:
        stock = reader(run.stock)

        def least(first: int, last: int) -> Array:
            several = stock(first, last)
            return several[:, list(run.axes)].min(axis=1) if several.ndim > 1 else several

        stocked = sampled(Samples.made(run.time, least, True), "FIFO stock", AXES[0])
        rows.append((stocked, "FIFO stock<br>[commands]", True))
    if run.interrupts is not None:
        parts = in_blocks(run.interrupts, run.time, back=1)
        at = np.concatenate([time[1:][np.diff(number) > 0] for number, time in parts])
        between = Samples(at[1:], np.diff(at) * 1e3, dots=True)
        trace = sampled(between, "since last interrupt", AXES[1])
        marked = trace | {"marker": {"size": 3, "color": AXES[1]}}
        rows.append((marked, "Since last<br>interrupt [ms]", not rows))
    return _panels(run.time, rows) if rows else None


def _panels(time: Array, rows: Sequence[tuple[Figure, str, bool]]) -> Figure:
    """One or two curves over each other: trace, title of its axis, whether that shows zero."""
    more: Figure = {}
    for i, (trace, title, zero) in enumerate(rows):
        low = 0.0 if i == len(rows) - 1 else 0.54
        high = 1.0 if i == 0 else 0.46
        key = "" if i == 0 else "2"
        trace |= {"yaxis": "y" + key, "showlegend": False}
        shown = _range(trace["samples"].values, zero=zero)
        more["yaxis" + key] = _axis(title, domain=[low, high], range=shown, nticks=5)
    figure = _over_time(300 if len(rows) == 2 else 230, time, **more)
    figure["xaxis"]["anchor"] = "y2" if len(rows) == 2 else "y"
    return {"data": [trace for trace, _, _ in rows], "layout": figure}


def trace_figures(contour: ContourResult) -> list[tuple[str, Figure]]:
    """Names and figures of the further signals against time."""
    out = []
    for trace in contour.run.traces:
        columns = trace.values.reshape(len(contour.run.time), -1)
        several = columns.shape[1] > 1
        shown = [
            (NAMES[i] if several else trace.name, reader(columns[:, i]), AXES[i])
            for i in (contour.run.axes if several else (0,))
        ]
        title = label(trace.name.rpartition(".")[2], trace.unit)
        out.append((trace.name, _curves(contour.run.time, shown, title, 230)))
    return out


def speed_figure(speeds: Speeds) -> Figure:
    """Speed of the tool against time, planned and programmed beside it."""
    shown = [
        ("programmed", speeds.programmed, RAPID, True),
        ("planned", speeds.planned, INK, False),
    ]
    data = []
    for name, values, color, steps in [*shown, ("tool", speeds.tool, AXES[0], False)]:
        if values is not None:
            data.append(sampled(Samples(speeds.time, values, steps=steps), name, color))
    data[0]["line"] |= {"width": 3.0} if speeds.programmed is not None else {}
    known = [v for v in (speeds.tool, speeds.planned, speeds.programmed) if v is not None]
    ends = _range(np.concatenate(known), zero=True)
    title = "Feed" if speeds.unit[0] == "mm/min" else "Speed"
    more: Figure = {"yaxis": _axis(f"{title} [{speeds.unit[0]}]", range=[0.0, ends[1]])}
    if speeds.done is not None:
        at = {"x0": speeds.done, "x1": speeds.done, "y0": 0, "y1": 1, "yref": "paper"}
        line = {"color": MUTED, "width": 1, "dash": "dot"}
        more["shapes"] = [{"type": "line", **at, "line": line}]
        more["annotations"] = [
            {
                "x": speeds.done,
                "y": 1,
                "yref": "paper",
                "text": "done",
                "showarrow": False,
                "xanchor": "right",
                "yanchor": "top",
                "font": {"size": 12, "color": MUTED},
            }
        ]
    return {"data": data, "layout": _over_time(270, speeds.time, **more)}


def _curves(time: Array, shown: list[tuple[str, Read, str]], title: str, height: int) -> Figure:
    """Curves of a name and a colour on one pair of axes."""
    few = [(Samples.made(time, read), name, color) for name, read, color in shown]
    data = [sampled(*curve) for curve in few]
    for trace in data:
        trace["showlegend"] = len(data) > 1
    bounds = _range(np.concatenate([samples.values for samples, _, _ in few]))
    return {"data": data, "layout": _over_time(height, time, yaxis=_axis(title, range=bounds))}


def _range(values: Array, zero: bool = False) -> list[float]:
    """Ends of a vertical axis, with room about the curve; zero is in it if wanted."""
    known = values[np.isfinite(values)]
    low, high = (float(known.min()), float(known.max())) if len(known) else (0.0, 1.0)
    low, high = (min(low, 0.0), max(high, 0.0)) if zero else (low, high)
    room = 0.08 * (high - low) or 0.1 * abs(high) or 0.5
    return [low - room, high + room]


def _axis(title: str, **more: Any) -> Figure:
    """A vertical axis; its margin is fixed, so that all plots over time line up."""
    return axis(title, automargin=False, **more)


def _over_time(height: int, time: Array, **more: Any) -> Figure:
    ends = [float(time[0]), float(time[-1])]
    axes = {"xaxis": axis(TIME, range=ends), "hovermode": "x"}
    return layout(height, **(axes | {"margin": {"l": 84, "r": 20, "t": 34, "b": 48}} | more))
