"""The figures a scenario asks for: which signals, checked, and their curves after the run."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import Faults
from motionfmu.base.units import spelled
from motionfmu.run.decimate import Read, at, few, reader
from motionfmu.run.run_record import RunRecord
from motionfmu.scenarios import rates, recording
from motionfmu.scenarios.body import Plot
from motionfmu.scenarios.document import Document
from motionfmu.scenarios.system import End, Resolver

# A report without figures shows so many signals.
OVERVIEW = 12


@dataclass(frozen=True)
class Curve:
    """One line of a panel."""

    name: str  # for the legend
    time: NDArray[np.float64]  # (n,) [s]
    values: NDArray[np.float64]  # (n,) as shown, in the unit of the panel's label
    steps: bool  # a value holds until the next one
    all: bool = True  # the curve has every sample


@dataclass(frozen=True)
class Panel:
    """Curves on one pair of axes."""

    label: str  # vertical axis: quantity and unit
    curves: tuple[Curve, ...]
    levels: dict[str, float]  # value of a horizontal line by its name
    legend: bool  # the curves' names are shown
    logic: bool = False  # all curves are Booleans


@dataclass(frozen=True)
class Chart:
    """A figure ready to draw."""

    title: str
    note: str
    span: tuple[float, float]  # from and to [s]
    whole: bool  # it shows the whole run
    panels: tuple[Panel, ...]  # from top to bottom, with a common time axis


def wanted(resolver: Resolver) -> list[End]:
    """Outputs to record because figures show them; wrong elements, too few names are refused."""
    found: list[End] = []
    faults = Faults()
    for i, figure in enumerate(resolver.document.body.figure):
        for j in range(len(figure.plot)):
            with faults.each():
                found += _of_plot(resolver, figure.plot[j], f"figure.{i}.plot.{j}")
    faults.tell()
    return found


def _of_plot(resolver: Resolver, plot: Plot, table: str) -> list[End]:
    named = []
    faults = Faults()
    for name in plot.signals:
        with faults.each():
            named.append(recording.elements(resolver, name, table, "signals"))
    faults.tell()
    count = sum(max(1, len(elements)) for _, elements in named)
    if plot.names is not None and len(plot.names) != count and len(named) == len(plot.signals):
        text = f"names = {plot.names!r}: {len(plot.names)} names for {count} curves"
        raise resolver.document.error(text, table, "names")
    return [end for end, _ in named]


def check(document: Document, step_ns: int) -> None:
    """Refuse a window or a rate that does not fit a run of such steps."""
    stop, faults = document.body.stop_limit, Faults()
    for i, figure in enumerate(document.body.figure):
        with faults.each():
            if figure.window is not None:
                start, end = figure.window
                if not 0.0 <= start < end <= stop:
                    text = f"window = {figure.window!r}: from and to within 0 .. {stop:g} s wanted"
                    raise document.error(text, f"figure.{i}", "window")
        for j, plot in enumerate(figure.plot):
            with faults.each():
                if plot.rate is not None and (text := rates.wrong(plot.rate, step_ns, stop)):
                    raise document.error(text, f"figure.{i}.plot.{j}", "rate")
    faults.tell()


def charts(run: RunRecord) -> list[Chart]:
    """The figures of a run with their curves, in the order of the scenario."""
    found = []
    for i, figure in enumerate(run.resolver.document.body.figure):
        whole = (float(run.time[0]), float(run.time[-1]))
        span = whole if figure.window is None else (figure.window[0], figure.window[1])
        tables = [f"figure.{i}.plot.{j}" for j in range(len(figure.plot))]
        panels = [_panel(run, p, t, span) for p, t in zip(figure.plot, tables, strict=True)]
        found.append(Chart(figure.title, figure.note, span, figure.window is None, tuple(panels)))
    return found


def _panel(run: RunRecord, plot: Plot, table: str, span: tuple[float, float]) -> Panel:
    names, columns = [], []
    for signal in plot.signals:
        end, elements = recording.elements(run.resolver, signal, table, "signals")
        data = run.signals[end.name]
        names += [f"{end.name}[{k}]" for k in elements] or [end.name]
        columns += [data[:, k - 1] for k in elements] or [data]
    curves = [
        _curve(run, plot, name, column, span)
        for name, column in zip(plot.names or names, columns, strict=True)
    ]
    legend = plot.names is not None or len(curves) > 1
    logic = plot.rate is None and plot.scale == 1.0 and all(c.dtype == bool for c in columns)
    return Panel(plot.label, tuple(curves), dict(plot.levels), legend, logic)


def _curve(
    run: RunRecord, plot: Plot, name: str, data: NDArray[Any], span: tuple[float, float]
) -> Curve:
    """The curve of a signal: its samples in the span, and one on either side of it."""
    time, read = run.time, reader(data)
    if plot.rate is not None and len(time) > 1:
        back = rates.steps(time, plot.rate)
        time, read = time[back:], rates.reader(data, back, plot.rate)

    def values(first: int, last: int) -> NDArray[np.float64]:
        return np.asarray(plot.scale * read(first, last).astype(np.float64))

    return curve(name, time, values, span, plot.steps or data.dtype == bool)


def curve(
    name: str, time: NDArray[np.float64], read: Read, span: tuple[float, float], steps: bool
) -> Curve:
    """A curve of the samples in a span and one on either side; of a long one the peaks."""
    first = max(0, int(np.searchsorted(time, span[0], side="right")) - 1)
    last = min(len(time), int(np.searchsorted(time, span[1], side="left")) + 1)

    def inside(low: int, high: int) -> NDArray[np.float64]:
        return read(first + low, first + high)

    kept = few(last - first, inside, steps)
    if kept is None:
        return Curve(name, time[first:last], read(first, last), steps)
    return Curve(name, time[first:last][kept], at(inside, kept), steps, all=False)


def overview(run: RunRecord, ends: Sequence[End]) -> list[Chart]:
    """A figure over the whole run of each of the first `OVERVIEW` signals, elements together."""
    span = (float(run.time[0]), float(run.time[-1]))
    found = []
    for end in ends[:OVERVIEW]:
        unit = spelled(end.port.unit)
        label = f"{end.name} [{unit}]" if unit else end.name
        steps = end.port.type != "Float64"
        plot = Plot(signals=[end.name], label=label, steps=steps)
        panel = _panel(run, plot, "record", span)
        found.append(Chart(end.name, end.port.doc, span, True, (panel,)))
    return found
