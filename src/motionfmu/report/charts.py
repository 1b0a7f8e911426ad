"""The figures a scenario asks for, as interactive plots."""

import math
from collections.abc import Sequence
from dataclasses import replace
from html import escape
from typing import Any

import numpy as np

from motionfmu.report.samples import Samples, sampled
from motionfmu.report.sheet import RUN, Sheet
from motionfmu.report.signal_words import titled
from motionfmu.report.style import AXES, INK, MUTED, axis, layout
from motionfmu.report.tables import picture_buttons
from motionfmu.run.decimate import keep_peaks, keep_steps
from motionfmu.run.figures import Chart, Curve, Panel

Figure = dict[str, Any]

# A curve has at most twice as many points: more than a screen has columns.
BUCKETS = 1200
DASHES = ("solid", "dash", "dot")
# Heights [pixel] of a panel, by how many there are; of a row of a legend; of space between two.
HEIGHTS = (250, 180, 150)
LOGIC = 0.6  # height of a panel of Booleans, of the others
LEGEND, GAP = 19, 12
TOP, BOTTOM, LEFT, RIGHT = 22, 48, 84, 20
CHARACTER = 7.0  # mean width of a letter of 12 pixel
# Room [pixel] for a legend on a page of usual width; for the line beside a name.
WIDTH, SAMPLE = 980, 45
ROOM = 0.06  # free above and below the curves, of their height


def shown(curve: Curve) -> Curve:
    """A curve with no more points than can be seen."""
    # All changes of a staircase, or all peaks.
    if not len(curve.values):
        return curve
    kept = (keep_steps if curve.steps else keep_peaks)(curve.values, BUCKETS)
    return replace(curve, time=curve.time[kept], values=curve.values[kept])


def extent(panel: Panel) -> tuple[float, float]:
    """Ends of the vertical axis, with room about curves and levels."""
    if panel.logic:
        return -0.15, 1.15
    values = [*(c.values for c in panel.curves), np.array(list(panel.levels.values()))]
    every = np.concatenate(values)
    every = every[np.isfinite(every)]
    low, high = (float(every.min()), float(every.max())) if len(every) else (0.0, 1.0)
    room = ROOM * (high - low) or 0.1 * abs(low) or 0.5
    return low - room, high + room


def spacing(panel: Panel) -> float | None:
    """Distance of the ticks where it must be 1: few whole numbers."""
    # None leaves the choice to the plot.
    low, high = extent(panel)
    whole = all(np.array_equal(c.values, np.round(c.values)) for c in panel.curves)
    return 1.0 if whole and high - low < 10.0 else None


def heights(chart: Chart, sizes: Sequence[float]) -> list[float]:
    """Height of each panel, in the unit of the sizes."""
    # Sizes for one panel, two panels and so on; the last for all larger numbers.
    full = sizes[min(len(chart.panels), len(sizes)) - 1]
    return [LOGIC * full if panel.logic else full for panel in chart.panels]


def add_charts(page: Sheet, charts: Sequence[Chart], pictures: bool = True) -> None:
    """A section for each figure, which may be saved as a picture."""
    names = [name for c in charts for p in c.panels for name in p.levels]
    right = RIGHT + math.ceil(CHARACTER * max((len(n) for n in names), default=0))
    for number, chart in enumerate(charts, 1):
        content = page.place(f"figure{number}", chart_figure(chart, right), chart.whole, RUN)
        if pictures:
            content += picture_buttons(f"figure{number}")
            page.section(escape(chart.title), escape(chart.note), content)
        else:
            page.section(escape(titled(chart.title, chart.note)), "", content)


def chart_figure(chart: Chart, right: int = RIGHT) -> Figure:
    """The interactive plot of a figure."""
    # The margin on the right [pixel] is for the names of levels.
    heads = [GAP + LEGEND * _rows(p) for p in chart.panels]
    sizes = heights(chart, HEIGHTS)
    inner = sum(heads) + sum(sizes)
    more: Figure = {"shapes": [], "annotations": []}
    data = []
    top = inner
    for i, panel in enumerate(chart.panels):
        key = str(i + 1) if i else ""
        top -= heads[i]
        domain = [max(0.0, top - sizes[i]) / inner, top / inner]
        top -= sizes[i]
        more["yaxis" + key] = _vertical(panel, domain)
        more["legend" + key] = layout(0)["legend"] | {"y": domain[1]}
        for j, curve in enumerate(panel.curves):
            data.append(_series(curve, j, key) | {"showlegend": panel.legend})
        for name, value in panel.levels.items():
            more["shapes"].append(_level_line(value, key))
            more["annotations"].append(_level_name(name, value, key))
    last = "y" + (str(len(chart.panels)) if len(chart.panels) > 1 else "")
    more["xaxis"] = axis("Time [s]", range=list(chart.span), anchor=last)
    more["margin"] = {"l": LEFT, "r": right, "t": TOP, "b": BOTTOM}
    more |= {"hovermode": "x", "hoversubplots": "axis"}
    return {"data": data, "layout": layout(round(inner) + TOP + BOTTOM, **more)}


def _rows(panel: Panel) -> int:
    """Rows of the legend."""
    if not panel.legend:
        return 0
    each = SAMPLE + CHARACTER * max(len(c.name) for c in panel.curves)
    return math.ceil(len(panel.curves) / max(1, WIDTH // each))


def _vertical(panel: Panel, domain: list[float]) -> Figure:
    label = escape(panel.label, quote=False).replace("\n", "<br>")
    more: Figure = {"domain": domain, "range": list(extent(panel)), "automargin": False}
    more |= {"nticks": 6, "exponentformat": "none", "zeroline": False}
    if step := spacing(panel):
        more["dtick"] = step
    return axis(label, **more)


def _series(curve: Curve, number: int, key: str) -> Figure:
    name, color = escape(curve.name, quote=False), AXES[number % len(AXES)]
    samples = Samples(curve.time, curve.values, curve.steps, all=curve.all)
    drawn = sampled(samples, name, color, dash=DASHES[number // len(AXES) % len(DASHES)])
    return drawn | {"yaxis": "y" + key, "legend": "legend" + key}


def _level_line(value: float, key: str) -> Figure:
    ends = {"x0": 0, "x1": 1, "y0": value, "y1": value}
    line = {"color": MUTED, "width": 1.3, "dash": "dot"}
    return ends | {"type": "line", "xref": "paper", "yref": "y" + key, "line": line}


def _level_name(name: str, value: float, key: str) -> Figure:
    text = escape(name, quote=False)
    where = {"x": 1, "xref": "paper", "xanchor": "left", "xshift": 4}
    where |= {"y": value, "yref": "y" + key, "yanchor": "middle"}
    return where | {"text": text, "showarrow": False, "font": {"size": 12, "color": INK}}
