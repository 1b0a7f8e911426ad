"""Charts of a run over time: errors, FIFO stock, signals and the speed of its tool."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from motionfmu.analysis.contour import ContourResult
from motionfmu.analysis.contour.arcs import Array
from motionfmu.base.columns import forget, in_blocks
from motionfmu.report.diagram import (
    Diagram,
    LevelMark,
    Mark,
    PointMark,
    SamplesMark,
    Scale,
    Subplot,
    ends_of,
)
from motionfmu.report.numbers import length, unit
from motionfmu.report.samples import Samples
from motionfmu.report.style import AXES, HEAT, INK, RAPID
from motionfmu.run.decimate import Read, ends, reader
from motionfmu.run.tool_gap import ToolGap

ROOM, PEAK_ROOM = 0.08, 0.16  # free part of the height above curves, and above a peak with a label
LATE = 0.05  # part of a run at its end in which a text has no room
HEIGHT, LOW = 188, 150  # [pixel] of a plot, and of one of several


@dataclass(frozen=True)
class Speeds:
    """Speeds of a tool over time, in one unit."""

    time: Array  # (n,) [s]
    tool: Array  # (n,)
    planned: Array | None  # (n,) by the controller
    programmed: Array | None  # (n,) NaN where the program asks for no speed
    unit: tuple[str, str]  # unit, and the signals from which the speed of the tool is computed
    done: float | None  # when the program was done [s]


def error_chart(contour: ContourResult) -> Diagram:
    """Contour error against time."""
    track, time = contour.track, contour.run.time
    factor, name = unit(contour.error.max)

    def error(first: int, last: int) -> Array:
        own = slice(first, last)
        forget(track.distance)
        value = np.where(contour.cutting[own], track.distance[own], np.nan) * factor
        return value if track.right is None else np.where(track.right[own], -value, value)

    def lines(first: int, last: int) -> Array:
        forget(track.segment)
        return contour.run.path.lines[track.segment[first:last]]

    samples = Samples.made(time, error, lines=lines)
    at, worst = contour.error.time, int(np.searchsorted(time, contour.error.time))
    highest = float(error(worst, worst + 1)[0])
    early = at < 0.5 * (time[0] + time[-1])
    peak = PointMark(
        np.array([at]),
        np.array([highest]),
        color=INK,
        symbol="ring",
        size=9.0,
        texts=[f"{length(contour.error.max)}, line {contour.error.line}"],
        side=("top " if highest >= 0.0 else "bottom ") + ("right" if early else "left"),
        hover=(),
    )
    bounds = ends_of([samples.values], zero=True, share=PEAK_ROOM)
    curve = SamplesMark(samples, "contour error", HEAT[2])
    return _chart(time, [(Scale("Contour error", name, bounds), [curve, peak])])


def following_chart(contour: ContourResult, names: Sequence[str]) -> Diagram:
    """Following error of each axis against time."""
    run = contour.run
    commanded, actual = reader(run.commanded), reader(run.actual)

    def following(first: int, last: int) -> Array:
        return commanded(first, last) - actual(first, last)

    def of_axis(i: int) -> Read:
        return lambda first, last: following(first, last)[:, i] * factor

    top = max(float(np.abs(end).max()) for end in ends(len(run.time), following))
    factor, name = unit(top)
    curves = [_curve(run.time, of_axis(i), names[i], AXES[i]) for i in run.axes]
    return _chart(run.time, [(_scale("Following error", name, curves), curves)])


def gap_chart(time: Array, tool: ToolGap) -> Diagram:
    """Distance and angle between a tool and its command against time."""
    factor, name = unit(tool.sizes[0].largest)
    distance = _curve(
        time, lambda first, last: factor * tool.distance(first, last), "Distance", AXES[0]
    )
    rows = [(_scale("Distance", name, [distance], True), [distance])]
    if tool.angle is not None:
        angle = _curve(time, tool.angle, "Orientation", AXES[1])
        rows.append((_scale("Orientation", "°", [angle], True), [angle]))
    return _chart(time, rows)


def fifo_chart(contour: ContourResult) -> Diagram | None:
    """FIFO stock and interrupts against time; None without either."""
    run = contour.run
    rows: list[tuple[Scale, list[SamplesMark]]] = []
    if run.stock is not None:
        stock = reader(run.stock)

        def least(first: int, last: int) -> Array:
            several = stock(first, last)
            return several[:, list(run.axes)].min(axis=1) if several.ndim > 1 else several

        curve = SamplesMark(Samples.made(run.time, least, True), "FIFO stock", AXES[0])
        rows.append((_scale("FIFO stock\n[commands]", "", [curve], True), [curve]))
    if run.interrupts is not None:
        parts = in_blocks(run.interrupts, run.time, back=1)
        at = np.concatenate([time[1:][np.diff(number) > 0] for number, time in parts])
        between = Samples(at[1:], np.diff(at) * 1e3, dots=True)
        dots = SamplesMark(between, "since last interrupt", AXES[1])
        rows.append((_scale("Since last\ninterrupt [ms]", "", [dots], not rows), [dots]))
    return _chart(run.time, rows) if rows else None


def trace_charts(contour: ContourResult, names: Sequence[str]) -> list[tuple[str, Diagram]]:
    """Names and charts of the further signals against time."""
    out = []
    for trace in contour.run.traces:
        columns = trace.values.reshape(len(contour.run.time), -1)
        several = columns.shape[1] > 1
        curves = [
            _curve(
                contour.run.time,
                reader(columns[:, i]),
                names[i] if several else trace.name,
                AXES[i],
            )
            for i in (contour.run.axes if several else (0,))
        ]
        scale = _scale(trace.name.rpartition(".")[2], trace.unit or "", curves)
        out.append((trace.name, _chart(contour.run.time, [(scale, curves)], LOW)))
    return out


def speed_chart(speeds: Speeds) -> Diagram:
    """Speed of the tool against time, planned and programmed beside it."""
    known = [
        (name, values, color, width)
        for name, values, color, width in (
            ("programmed", speeds.programmed, RAPID, 3.0),
            ("planned", speeds.planned, INK, 1.4),
            ("tool", speeds.tool, AXES[0], 1.4),
        )
        if values is not None
    ]
    marks: list[Mark] = [
        SamplesMark(Samples(speeds.time, v, steps=name == "programmed"), name, color, width)
        for name, v, color, width in known
    ]
    top = ends_of([v for _, v, _, _ in known], zero=True, share=ROOM)[1]
    if speeds.done is not None:
        late = speeds.done > speeds.time[-1] - LATE * (speeds.time[-1] - speeds.time[0])
        side = "left" if late else "right"
        marks.append(LevelMark(speeds.done, "done", upright=True, side=side))
    title = "Feed" if speeds.unit[0] == "mm/min" else "Speed"
    return _chart(speeds.time, [(Scale(title, speeds.unit[0], (0.0, top)), marks)])


def _curve(time: Array, read: Read, name: str, color: str) -> SamplesMark:
    return SamplesMark(Samples.made(time, read), name, color)


def _scale(title: str, unit: str, curves: Sequence[SamplesMark], zero: bool = False) -> Scale:
    """A vertical axis with room about its curves."""
    return Scale(title, unit, ends_of([c.samples.values for c in curves], zero, ROOM))


def _chart(time: Array, rows: Sequence[tuple[Scale, Any]], height: float = HEIGHT) -> Diagram:
    """Axes and their marks over the time of a run."""
    low = height if len(rows) == 1 else 0.6 * height
    span = Scale("Time", "s", (float(time[0]), float(time[-1])))
    return Diagram((span,), [Subplot(scale, marks, low) for scale, marks in rows])
