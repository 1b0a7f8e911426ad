"""The figures a scenario asks for: signals over time, a panel for each quantity."""

from collections.abc import Sequence
from dataclasses import replace
from html import escape
from pathlib import Path

import numpy as np

from motionfmu.report.diagram import (
    DASH,
    DOT,
    SOLID,
    Diagram,
    LevelMark,
    Mark,
    SamplesMark,
    Scale,
    Subplot,
    ends_of,
)
from motionfmu.report.html_page import RUN, Page
from motionfmu.report.html_tables import picture_buttons
from motionfmu.report.samples import Samples
from motionfmu.report.signal_words import titled
from motionfmu.report.style import AXES
from motionfmu.run.figures import Chart, Curve, Panel

DASHES = (SOLID, DASH, DOT)
HEIGHTS = (250, 180, 150)  # [pixel] of a panel of one, of two and of more
LOGIC = 0.6  # height of a panel of Booleans, of the others


def signal_chart(chart: Chart) -> Diagram:
    """The diagram of a scenario's figure."""
    full = HEIGHTS[min(len(chart.panels), len(HEIGHTS)) - 1]
    panels = [_subplot(p, LOGIC * full if p.logic else full) for p in chart.panels]
    return Diagram((Scale("Time", "s", chart.span),), panels)


def _subplot(panel: Panel, height: float) -> Subplot:
    ends = (-0.15, 1.15)
    if not panel.logic:
        lines = np.array(list(panel.levels.values()))
        ends = ends_of([*(c.values for c in panel.curves), lines])
    # Few whole numbers have a tick each.
    whole = all(np.array_equal(c.values, np.round(c.values)) for c in panel.curves)
    spacing = 1.0 if whole and ends[1] - ends[0] < 10.0 else None
    curves = [_curve(c, i) for i, c in enumerate(panel.curves)]
    levels = [LevelMark(value, name) for name, value in panel.levels.items()]
    scale = Scale(panel.label, "", ends, spacing=spacing)
    return Subplot(scale, [*curves, *levels], height, panel.legend)


def _curve(curve: Curve, number: int) -> SamplesMark:
    samples = Samples(curve.time, curve.values, curve.steps, all=curve.all)
    dash = DASHES[number // len(AXES) % len(DASHES)]
    return SamplesMark(samples, curve.name, AXES[number % len(AXES)], dash=dash)


def recolored(diagram: Diagram, looks: Sequence[tuple[str, str]]) -> Diagram:
    """The diagram with colours and dashes of its curves, in their order."""
    left = iter(looks)

    def changed(mark: Mark) -> Mark:
        if not isinstance(mark, SamplesMark):
            return mark
        color, dash = next(left)
        return replace(mark, color=color, dash=dash)

    rows = [replace(s, marks=[changed(m) for m in s.marks]) for s in diagram.subplots]
    return replace(diagram, subplots=rows)


def add_charts(page: Page, charts: Sequence[Chart], pictures: bool = True) -> None:
    """Add a section for each figure, which may be saved as a picture."""
    for number, chart in enumerate(charts, 1):
        content = page.place(f"figure{number}", signal_chart(chart), chart.whole, RUN)
        if pictures:
            content += picture_buttons(f"figure{number}")
            page.section(escape(chart.title), escape(chart.note), content)
        else:
            page.section(escape(titled(chart.title, chart.note)), "", content)


def write_charts(charts: Sequence[Chart], folder: Path) -> None:
    """Draw each figure into figure1.png, figure1.svg and so on."""
    from motionfmu.report.matplotlib_figure import write_picture

    for number, chart in enumerate(charts, 1):
        write_picture(folder / f"figure{number}", chart.title, chart.note, signal_chart(chart))
