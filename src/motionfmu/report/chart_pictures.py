"""The figures a scenario asks for, as PNG and SVG."""

import math
import textwrap
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import matplotlib
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, MultipleLocator, ScalarFormatter

from motionfmu.report.charts import extent, heights, shown, spacing
from motionfmu.report.pictures import PLAIN, STABLE
from motionfmu.report.style import AXES, GRID, INK, MUTED
from motionfmu.run.figures import Chart, Panel

WIDTH = 9.0  # [inch]
DPI = 130
# Heights [inch] of a panel, by how many there are; of the time axis' label; of rows of text.
HEIGHTS = (3.1, 2.1, 1.7)
BELOW = 0.55
TITLE_ROW, NOTE_ROW, LEGEND_ROW = 0.25, 0.2, 0.18
MARGIN = 0.09
# Letters in a row of the title, of the note; in the legend over a panel.
TITLE, NOTE, LEGEND = 76, 113, 104
DASHES = ("-", "--", ":")
MARKS = {"text.parse_math": False}  # a dollar sign is one


def write_charts(charts: Sequence[Chart], folder: Path) -> None:
    """Draw each figure into figure1.png, figure1.svg and so on."""
    with matplotlib.rc_context(PLAIN | STABLE | MARKS):
        for number, chart in enumerate(charts, 1):
            picture = chart_picture(chart)
            picture.savefig(folder / f"figure{number}.png", dpi=DPI)
            picture.savefig(folder / f"figure{number}.svg", metadata={"Date": None})


def chart_picture(chart: Chart, make: Callable[..., Figure] = Figure) -> Figure:
    """The picture of a figure, a pair of axes per panel; `make` as of `path_picture`."""
    title, note = textwrap.wrap(chart.title, TITLE), textwrap.wrap(chart.note, NOTE)
    head = MARGIN + TITLE_ROW * len(title) + NOTE_ROW * len(note)
    rows = sum(_rows(p) for p in chart.panels if p.legend)
    sizes = heights(chart, HEIGHTS)
    height = head + sum(sizes) + LEGEND_ROW * rows + BELOW
    picture = make(figsize=(WIDTH, height))
    left, top = MARGIN / WIDTH, 1.0 - MARGIN / height
    place: Any = {"ha": "left", "va": "top", "linespacing": 1.2}
    picture.text(left, top, "\n".join(title), fontsize=14, fontweight="bold", **place)
    top -= TITLE_ROW * len(title) / height
    picture.text(left, top, "\n".join(note), fontsize=10.5, color=MUTED, **place)
    below = (0.0, 0.0, 1.0, 1.0 - head / height)
    picture.set_layout_engine("constrained", w_pad=MARGIN, h_pad=MARGIN, rect=below)
    shared: Any = {"sharex": True, "squeeze": False, "height_ratios": sizes}
    grid: Any = picture.subplots(len(chart.panels), 1, **shared)
    for axes, panel in zip(grid[:, 0], chart.panels, strict=True):
        _draw(axes, panel)
    bottom = grid[-1, 0]
    bottom.set_xlim(*chart.span)
    bottom.set_xlabel("Time [s]")
    bottom.xaxis.set_major_formatter(_plain())
    picture.align_ylabels(grid[:, 0])
    return picture


def _plain() -> ScalarFormatter:
    """Numbers in full: no offset, powers of ten for very large and small ones only."""
    plain = ScalarFormatter(useOffset=False)
    plain.set_powerlimits((-6, 9))
    return plain


def _draw(axes: Any, panel: Panel) -> None:
    for i, curve in enumerate(shown(c) for c in panel.curves):
        axes.plot(
            curve.time,
            curve.values,
            color=AXES[i % len(AXES)],
            ls=DASHES[i // len(AXES) % len(DASHES)],
            lw=1.3,
            drawstyle="steps-post" if curve.steps else "default",
            snap=False,  # else equal pulses differ in width by a pixel
            label=curve.name,
        )
    for name, value in panel.levels.items():
        axes.axhline(value, color=MUTED, ls=":", lw=1.2, zorder=1.5)
        where = {"xycoords": axes.get_yaxis_transform(), "textcoords": "offset points"}
        axes.annotate(name, (1.0, value), (5, 0), **where, va="center", color=INK, fontsize=9)
    axes.set_ylim(*extent(panel))
    axes.set_ylabel(panel.label)
    step = spacing(panel)
    axes.yaxis.set_major_locator(
        MultipleLocator(step) if step else MaxNLocator(6, steps=[1, 2, 2.5, 5, 10])
    )
    axes.yaxis.set_major_formatter(_plain())
    axes.grid(color=GRID, lw=0.8)
    axes.set_axisbelow(True)
    axes.tick_params(length=0)
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(MUTED)
    if panel.legend:
        axes.legend(
            loc="lower left",
            bbox_to_anchor=(0.0, 1.0),
            ncols=math.ceil(len(panel.curves) / _rows(panel)),
            frameon=False,
            borderaxespad=0.0,
            borderpad=0.2,
            handlelength=1.4,
            columnspacing=1.1,
            fontsize=9,
        )


def _rows(panel: Panel) -> int:
    """Rows of the legend; beside a name are its line and a space."""
    longest = max(len(c.name) for c in panel.curves)
    return math.ceil(len(panel.curves) / max(1, LEGEND // (longest + 6)))
