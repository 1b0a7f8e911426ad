"""Diagrams as a picture: a figure of matplotlib, as PNG and SVG."""

import math
import textwrap
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from matplotlib.ticker import (
    FixedLocator,
    LogLocator,
    MaxNLocator,
    MultipleLocator,
    NullFormatter,
    ScalarFormatter,
)
from mpl_toolkits.mplot3d.art3d import Line3DCollection

from motionfmu.report.dark_figure import COLORS
from motionfmu.report.diagram import (
    EQUAL,
    POLAR,
    SPACE,
    BandMark,
    BarMark,
    CircleMark,
    Diagram,
    FieldMark,
    Heat,
    LevelMark,
    LineMark,
    PointMark,
    SamplesMark,
    Scale,
    Subplot,
    bounds,
    named_mark,
)
from motionfmu.report.samples import Samples
from motionfmu.report.style import GRID, INK, LIGHT, MUTED
from motionfmu.run.decimate import keep_peaks, keep_steps

WIDTH, DPI = 9.0, 130  # [inch] of a column of subplots, and points of an inch
PIXEL = 1.0 / 85.0  # [inch] of a diagram's pixel
POINT = 0.8  # of a line's pixel, in points
# Heights [inch]: below an axis, of rows of the title, the note and a legend, and around all.
BELOW, TITLE_ROW, NOTE_ROW, LEGEND_ROW, MARGIN = 0.55, 0.25, 0.2, 0.18, 0.09
# Letters in an inch of the title, of the note and of a legend.
TITLE, NOTE, LEGEND = 8.4, 12.5, 11.5
# Least height [inch] of axes of one scale; what of the width axes do not take.
LOWEST, SIDES = 1.5, 1.3
# Inches that a number below an axis takes; most numbers at a horizontal and a vertical axis.
NUMBER, NUMBERS, NUMBERS_UP = 0.62, 9, 6
LABELS_AT = 67.5  # [°] of the labels of a radial axis
BUCKETS = 1200  # a curve has at most twice as many points: more than a picture has columns
DASHES: dict[str, Any] = {"solid": "-", "dash": "--", "dot": (0, (1.2, 1.8))}
SYMBOLS = {"circle": "o", "ring": "o", "cross": "P", "x": "x", "star": "*", "diamond": "D"}
BAR = 0.8  # part of the room of a group of bars that they take
LOOK: dict[Any, Any] = {
    "font.family": "sans-serif",
    "font.sans-serif": ["Inter", "Segoe UI", "Helvetica Neue", "Arial", "DejaVu Sans"],
    "text.color": INK,
    "axes.labelcolor": INK,
    "xtick.color": MUTED,
    "ytick.color": MUTED,
    "text.parse_math": False,  # a dollar sign is one
    # Same picture, same bytes: fixed names inside the SVG.
    "svg.hashsalt": "motionfmu",
    "svg.fonttype": "path",
}
Column = Diagram | Sequence[Diagram]


def write_picture(stem: Path, title: str, note: str, *columns: Column) -> None:
    """Draw columns of diagrams beside each other into stem.png and stem.svg."""
    for suffix in (".png", ".svg"):
        write_file(stem.with_name(stem.name + suffix), title, note, *columns)


def write_file(file: Path, title: str, note: str, *columns: Column) -> None:
    """Draw columns of diagrams beside each other into one file."""
    with matplotlib.rc_context(LOOK):
        metadata = {"Date": None} if file.suffix == ".svg" else None
        picture(title, note, *columns).savefig(file, dpi=DPI, metadata=metadata)


def picture(
    title: str,
    note: str,
    *columns: Column,
    width: float = WIDTH,
    make: Callable[..., Figure] = Figure,
) -> Figure:
    """Columns of diagrams in one figure, which `make` gives: one of pyplot's, or by itself."""
    with matplotlib.rc_context(LOOK):
        listed = [[c] if isinstance(c, Diagram) else list(c) for c in columns]
        width = width if len(listed) == 1 else 0.72 * width * len(listed)
        return _picture(title, note, listed, make, width)


def _picture(
    title: str,
    note: str,
    columns: list[list[Diagram]],
    make: Callable[..., Figure],
    width: float,
) -> Figure:
    titles = textwrap.wrap(title, int(TITLE * width))
    notes = [t for line in note.split("\n") for t in textwrap.wrap(line, int(NOTE * width))]
    head = MARGIN + TITLE_ROW * len(titles) + NOTE_ROW * len(notes)
    room = width / len(columns)
    height = head + max(sum(_height(d, room) for d in column) for column in columns)
    drawn = make(figsize=(width, height))
    left, top = MARGIN / width, 1.0 - MARGIN / height
    place: Any = {"ha": "left", "va": "top", "linespacing": 1.2}
    drawn.text(left, top, "\n".join(titles), fontsize=14, fontweight="bold", **place)
    top -= TITLE_ROW * len(titles) / height
    drawn.text(left, top, "\n".join(notes), fontsize=10.5, color=MUTED, **place)
    rect = (0.0, 0.0, 1.0, 1.0 - head / height)
    drawn.set_layout_engine("constrained", w_pad=MARGIN, h_pad=MARGIN, rect=rect)
    grid = drawn.add_gridspec(1, len(columns))
    for i, column in enumerate(columns):
        shares = [_height(d, room) for d in column]
        inner = grid[0, i].subgridspec(len(column), 1, height_ratios=shares)
        first = [_diagram(drawn, inner[k, 0], d, room) for k, d in enumerate(column)]
        drawn.align_ylabels([axes for several in first for axes in several])
    return drawn


def _height(diagram: Diagram, width: float) -> float:
    """Height [inch] of a diagram with its horizontal axis and legends."""
    rows = sum(_legend_rows(s, width) for s in diagram.subplots)
    below = 0.0 if diagram.shape in (POLAR, SPACE) else BELOW
    return sum(_subplot_heights(diagram, width)) + LEGEND_ROW * rows + below


def _subplot_heights(diagram: Diagram, width: float) -> list[float]:
    heights = [PIXEL * s.height for s in diagram.subplots]
    if diagram.shape != EQUAL:
        return heights
    # No higher than axes of one scale need over the whole width.
    low, high = bounds(diagram)
    across, up = high - low
    wanted = (width - SIDES - (0.9 if diagram.heat else 0.0)) * up / across
    return [min(heights[0], max(LOWEST, wanted))]


def _legend_rows(subplot: Subplot, width: float) -> int:
    """Rows of the legend; beside a name are its line and a space."""
    names = subplot.names
    if not names:
        return 0
    return math.ceil(len(names) / max(1, int(LEGEND * width) // (max(map(len, names)) + 6)))


def _diagram(drawn: Figure, place: Any, diagram: Diagram, width: float) -> list[Any]:
    """Draw a diagram in its place; give the axes of its first column."""
    ratios = _subplot_heights(diagram, width)
    grid = place.subgridspec(len(diagram.subplots), len(diagram.x), height_ratios=ratios)
    projection = {SPACE: "3d", POLAR: "polar"}.get(diagram.shape)
    table: list[list[Any]] = []
    for i, subplot in enumerate(diagram.subplots):
        table.append([])
        for j, marks in enumerate(subplot.cells):
            above = next((row[j] for row in table[:-1] if len(row) > j), None)
            look: Any = {"projection": projection, "sharex": above}
            axes: Any = drawn.add_subplot(grid[i, j], **look)
            table[-1].append(axes)
            last = i == len(diagram.subplots) - 1
            _axes(axes, diagram, subplot, (j, last))
            if projection is None:
                _ticks(axes, "x", diagram.x[j], _across(diagram, width))
                _ticks(axes, "y", subplot.y, NUMBERS_UP)
            for number, mark in enumerate(marks):
                name = getattr(mark, "name", "") if named_mark(mark) and subplot.names else ""
                _MARKS[type(mark)](axes, diagram, subplot, mark, name, number)
            _ends(axes, diagram, subplot, j)
            if j == 0:
                _legend(axes, subplot, width)
    if diagram.heat:
        _color_bar(drawn, table, diagram.heat)
    return [row[0] for row in table] if projection is None else []


def _axes(axes: Any, diagram: Diagram, subplot: Subplot, at: tuple[int, bool]) -> None:
    """Titles, grid and look of a pair of axes."""
    column, last = at
    axes.grid(color=GRID, lw=0.8)
    axes.set_axisbelow(True)
    if diagram.shape == POLAR:
        return
    if last or diagram.shape == SPACE:
        axes.set_xlabel(diagram.x[column].text)
    if column == 0:
        axes.set_ylabel(subplot.y.text)
    if diagram.shape == SPACE:
        axes.set_zlabel(diagram.z.text)
        axes.computed_zorder = False
        return
    axes.tick_params(length=0, labelbottom=last, labelleft=column == 0)
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(MUTED)
    if diagram.shape == EQUAL:
        axes.set_aspect("equal", adjustable="box", anchor="N")
        axes.spines[:].set_visible(False)
    bars = any(isinstance(m, BarMark) for m in subplot.marks)
    if bars:
        axes.grid(False, axis="y")
        axes.spines[:].set_visible(False)
        axes.tick_params(axis="y", labelcolor=INK)
        axes.invert_yaxis()
        axes.margins(x=0.12)


def _across(diagram: Diagram, width: float) -> int:
    """How many numbers there is room for below an axis."""
    inches = (width - SIDES) / len(diagram.x)
    if diagram.shape == EQUAL:
        low, high = bounds(diagram)
        across, up = high - low
        inches = min(inches, _subplot_heights(diagram, width)[0] * across / up)
    return min(NUMBERS, max(2, int(inches / NUMBER)))


def _ticks(axes: Any, way: str, scale: Scale, most: int) -> None:
    axis = getattr(axes, f"{way}axis")
    if scale.log:
        getattr(axes, f"set_{way}scale")("log")
        axis.set_minor_formatter(NullFormatter())
    elif scale.ticks:
        axis.set_ticks([v for v, _ in scale.ticks], [t for _, t in scale.ticks])
    else:
        free = MaxNLocator(most, steps=[1, 2, 2.5, 5, 10])
        axis.set_major_locator(MultipleLocator(scale.spacing) if scale.spacing else free)
        axis.set_major_formatter(_numbers())


def _numbers() -> ScalarFormatter:
    """Numbers in full: no offset, powers of ten for very large and small ones only."""
    plain = ScalarFormatter(useOffset=False)
    plain.set_powerlimits((-6, 9))
    return plain


def _ends(axes: Any, diagram: Diagram, subplot: Subplot, column: int) -> None:
    """Set the ends of the axes after all marks are drawn."""
    if diagram.shape == POLAR:
        _rings(axes, subplot.y, diagram.x[0])
        return
    if diagram.shape in (EQUAL, SPACE):
        low, high = bounds(diagram)
        for name, a, b in zip("xyz", low, high, strict=False):
            getattr(axes, f"set_{name}lim")(a, b)
        if diagram.shape == SPACE:
            axes.set_box_aspect(high - low, zoom=1.1)
        return
    for way, scale in (("x", diagram.x[column]), ("y", subplot.y)):
        if scale.ends:
            getattr(axes, f"set_{way}lim")(*scale.ends)
        elif scale.floor and not scale.log:
            edges = getattr(axes, f"get_{way}lim")()
            getattr(axes, f"set_{way}lim")(max(0.0, edges[0]), edges[1])
        if scale.log:
            _log_ticks(getattr(axes, f"{way}axis"))


def _log_ticks(axis: Any) -> None:
    """Ticks of a logarithmic axis, with numbers in full and several in each decade."""
    low, high = axis.get_view_interval()
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if high < 200 * low else (1.0,)))
    axis.set_major_formatter("{x:g}")


def _rings(axes: Any, radius: Scale, angle: Scale) -> None:
    axes.set_rlim(*(radius.ends or (None, None)))
    texts = [t for _, t in radius.ticks]
    axes.set_rticks([v for v, _ in radius.ticks], [""] * len(texts))
    free = {"facecolor": "white", "alpha": 0.8, "pad": 0.5, "linewidth": 0}  # of curves below
    look: Any = {"fontsize": 8, "color": MUTED, "ha": "center", "va": "center", "zorder": 4.0}
    for value, text in radius.ticks:
        if text:
            axes.text(np.radians(LABELS_AT), value, text, bbox=free, **look)
    places = np.radians([v for v, _ in angle.ticks])
    axes.set_xticks(places, [t for _, t in angle.ticks], fontsize=9, color=INK)
    axes.spines["polar"].set_color(GRID)


def _legend(axes: Any, subplot: Subplot, width: float) -> None:
    """Names of the marks in rows above the subplot."""
    if rows := _legend_rows(subplot, width):
        axes.legend(
            loc="lower left",
            bbox_to_anchor=(0.0, 1.1 if axes.name == "polar" else 1.0),
            ncols=math.ceil(len(subplot.names) / rows),
            frameon=False,
            borderaxespad=0.0,
            borderpad=0.2,
            handlelength=1.4,
            columnspacing=1.1,
            fontsize=9,
        )


def _norm(heat: Heat) -> Normalize:
    low, high = heat.ends
    if heat.log:
        return LogNorm(low, high)
    return Normalize(low, high if high > low else low + 1.0)


def _color_bar(drawn: Figure, table: list[list[Any]], heat: Heat) -> None:
    every = [axes for row in table for axes in row]
    colors = matplotlib.cm.ScalarMappable(_norm(heat), COLORS)
    bar = drawn.colorbar(colors, ax=every, shrink=0.8, aspect=28, pad=0.02, panchor=False)
    bar.outline.set_visible(False)
    bar.set_label(heat.title)
    if heat.ticks:
        bar.ax.yaxis.set_major_locator(FixedLocator(heat.ticks))
        bar.ax.yaxis.set_major_formatter("{x:g}")
        bar.ax.yaxis.set_minor_locator(FixedLocator([]))
    bar.ax.tick_params(length=0)


def _line(axes: Any, diagram: Diagram, _: Subplot, mark: LineMark, name: str, order: int) -> None:
    x = np.radians(mark.x) if diagram.shape == POLAR else mark.x
    z = () if diagram.shape != SPACE or mark.z is None else (mark.z,)
    look: Any = {"label": name, "zorder": 2.0 + 0.01 * order, "solid_capstyle": "round"}
    if mark.heat is None:
        width = POINT * mark.width
        axes.plot(x, mark.y, *z, color=mark.color, lw=width, ls=DASHES[mark.dash], **look)
        return
    points = np.column_stack([x, mark.y, *z])
    pieces = np.stack([points[:-1], points[1:]], axis=1)
    whole = ~np.isnan(pieces).any(axis=(1, 2))
    lines: Any = (Line3DCollection if z else LineCollection)(
        pieces[whole],
        cmap=COLORS,
        norm=_norm(mark.heat),
        linewidths=2.2,
        capstyle="round",
        zorder=look["zorder"],
    )
    values = mark.heat.values
    lines.set_array(np.maximum(values[:-1], values[1:])[whole])
    axes.add_collection(lines)
    axes.plot([], [], *[[] for _ in z], color=mark.color, lw=2.2, label=name)


def thinned(samples: Samples) -> Samples:
    """A curve with no more points than can be seen: all changes of a staircase, or all peaks."""
    if not len(samples.values):
        return samples
    known = np.nan_to_num(np.asarray(samples.values, dtype=np.float64))
    kept = (keep_steps if samples.steps else keep_peaks)(known, BUCKETS)
    return replace(samples, time=samples.time[kept], values=samples.values[kept])


def _samples(axes: Any, _: Diagram, __: Subplot, mark: SamplesMark, name: str, order: int) -> None:
    few = thinned(mark.samples)
    dots = mark.samples.dots
    axes.plot(
        few.time,
        few.values,
        color=mark.color,
        ls="" if dots else DASHES[mark.dash],
        marker="." if dots else None,
        ms=3.0,
        lw=0.93 * mark.width,
        drawstyle="steps-post" if few.steps else "default",
        snap=False,  # else equal pulses differ in width by a pixel
        label=name,
        zorder=2.0 + 0.01 * order,
    )


def _point(axes: Any, diagram: Diagram, _: Subplot, mark: PointMark, name: str, order: int) -> None:
    look: Any = {"label": name, "marker": SYMBOLS[mark.symbol], "zorder": 3.0 + 0.01 * order}
    edge = mark.edge or ("none" if mark.symbol not in ("ring", "x") else mark.color)
    size = (POINT * mark.size) ** 2
    at = (mark.x, mark.y) if diagram.shape != SPACE or mark.z is None else (mark.x, mark.y, mark.z)
    if mark.heat:
        colors: Any = {"c": mark.heat.values, "cmap": COLORS, "norm": _norm(mark.heat)}
        axes.scatter(*at, s=size, linewidths=0, **colors, **look)
    elif mark.symbol == "x":
        axes.scatter(*at, s=size, color=mark.color, lw=1, **look)
    else:
        face = "none" if mark.symbol == "ring" else mark.color
        axes.scatter(*at, s=size, facecolors=face, edgecolors=edge, clip_on=False, **look)
    for x, y, text in zip(mark.x, mark.y, mark.texts, strict=False):
        up, right = "top" in mark.side, "right" in mark.side
        place: Any = {"va": "bottom" if up else "top", "ha": "left" if right else "right"}
        shift = (5 if right else -5, 3 if up else -3)
        axes.annotate(text, (x, y), shift, textcoords="offset points", fontsize=9, **place)


def _band(axes: Any, _: Diagram, __: Subplot, mark: BandMark, name: str, order: int) -> None:
    look: Any = {"color": mark.color, "alpha": LIGHT, "lw": 0, "label": name}
    axes.fill_between(mark.x, mark.low, mark.high, **look)


def _bar(axes: Any, _: Diagram, subplot: Subplot, mark: BarMark, name: str, order: int) -> None:
    bars = [m for m in subplot.marks if isinstance(m, BarMark)]
    height = BAR / len(bars)
    shift = (bars.index(mark) - 0.5 * (len(bars) - 1)) * height
    places = np.array([v for v, _ in subplot.y.ticks]) + shift
    sizes = [v or 0.0 for v in mark.values]
    axes.barh(places, sizes, 0.92 * height, color=mark.color, label=name)
    for place, size, text in zip(places, sizes, mark.texts, strict=True):
        where: Any = {"textcoords": "offset points", "va": "center", "fontsize": 9}
        axes.annotate(text, (size, place), (3, 0), color=MUTED, **where)


def _level(axes: Any, _: Diagram, __: Subplot, mark: LevelMark, name: str, order: int) -> None:
    look: Any = {"color": mark.color, "ls": DASHES[mark.dash], "lw": 1.2, "zorder": 1.5}
    where: Any = {"textcoords": "offset points", "fontsize": 9}
    if mark.upright:
        axes.axvline(mark.value, **look)
        right = mark.side == "right"
        place: Any = {"va": "top", "ha": "left" if right else "right", "color": mark.color}
        at = {"xycoords": axes.get_xaxis_transform()}
        axes.annotate(
            mark.text, (mark.value, 1.0), (4 if right else -4, -2), **at, **where, **place
        )
        return
    axes.axhline(mark.value, **look)
    at = {"xycoords": axes.get_yaxis_transform()}
    axes.annotate(mark.text, (1.0, mark.value), (5, 0), **at, **where, va="center", color=INK)


def _circle(axes: Any, _: Diagram, __: Subplot, mark: CircleMark, name: str, order: int) -> None:
    fill = {"facecolor": matplotlib.colors.to_rgba(mark.color, 0.1)} if mark.filled else {}
    look: Any = {"edgecolor": mark.color, "ls": DASHES[mark.dash], "fill": mark.filled}
    axes.add_patch(Circle((mark.x, mark.y), mark.radius, **look, **fill))


def _field(axes: Any, _: Diagram, __: Subplot, mark: FieldMark, name: str, order: int) -> None:
    # Between the places of a cost that is shown by its logarithm, that is what is even.
    heat = mark.heat
    scaled, back = (np.log10, np.power) if heat.log else (np.asarray, lambda _, v: v)
    values, lines = np.ma.masked_invalid(scaled(heat.values)), list(scaled(heat.ticks))
    norm = Normalize(*scaled(heat.ends))
    axes.contourf(mark.x, mark.y, values, lines, cmap=COLORS, norm=norm, extend="neither")
    look: Any = {"colors": "white", "linewidths": 0.8, "linestyles": "solid"}
    drawn = axes.contour(mark.x, mark.y, values, lines, **look)
    axes.clabel(drawn, fmt=lambda v: f"{back(10.0, v):.3g}", fontsize=8)


_MARKS: dict[type, Callable[[Any, Diagram, Subplot, Any, str, int], None]] = {
    LineMark: _line,
    SamplesMark: _samples,
    PointMark: _point,
    BandMark: _band,
    BarMark: _bar,
    LevelMark: _level,
    CircleMark: _circle,
    FieldMark: _field,
}
