"""A diagram as the interactive plot of a page: a figure of plotly as a plain dictionary."""

import math
from collections.abc import Callable, Iterable
from html import escape
from typing import Any

import numpy as np

from motionfmu.report.diagram import (
    EQUAL,
    FREE,
    POLAR,
    SPACE,
    Array,
    BandMark,
    BarMark,
    CircleMark,
    Diagram,
    FieldMark,
    Heat,
    LevelMark,
    LineMark,
    Mark,
    PointMark,
    SamplesMark,
    Scale,
    Subplot,
    bounds,
    named_mark,
)
from motionfmu.report.style import COLORSCALE, FONT, GRID, INK, LIGHT, MUTED
from motionfmu.report.typed_arrays import packed

Figure = dict[str, Any]

# Heights [pixel] of a row of a legend, and of the space above it or above a plot without one.
LEGEND, GAP = 19, 12
TOP, BOTTOM, LEFT, RIGHT = 22, 48, 64, 20
OVER_TIME = 84  # left of plots over time, for any numbers
CHARACTER = 7.0  # mean width [pixel] of a letter
# Room [pixel] for a legend on a page of usual width; for the line beside a name.
WIDTH, SAMPLE = 980, 45
FLAT = 140  # [pixel] a lower plot has fewer ticks
BESIDE = 0.03  # free between two columns, of the width of the plot
BAR_TEXT = 70  # [pixel] right of the longest bar
IN_SPACE = 1.7  # how much wider lines are in space
CAMERA = {"eye": {"x": 1.5, "y": 1.5, "z": 1.0}, "center": {"x": 0, "y": 0, "z": -0.12}}
LABELS_AT = 67.5  # [°] of the labels of a radial axis
SYMBOLS = {"ring": "circle-open"}


def plotly_figure(diagram: Diagram) -> Figure:
    """The data and the layout that plotly's script takes."""
    data: list[Figure] = []
    drawn = _polar(diagram) if diagram.shape == POLAR else _rows(diagram)
    for row, (subplot, rest) in enumerate(zip(diagram.subplots, drawn.pop("rows"), strict=True)):
        names = subplot.names
        for column, marks in enumerate(subplot.cells):
            at = {"xaxis": _key("x", column), "yaxis": _key("y", row)}
            for mark in marks:
                shown = {"showlegend": column == 0 and named_mark(mark) and bool(names)}
                traces, more = _TRACES[type(mark)](mark, diagram, subplot, at)
                for trace in traces:
                    own = {} if diagram.shape in (POLAR, SPACE) else at
                    data.append(own | {"legend": _key("legend", row)} | shown | trace)
                for name, found in more.items():
                    drawn[name] = [*drawn.get(name, []), *found]
        data += rest
    bars = [t.get("marker", t) for t in data if "colorscale" in t.get("marker", t)]
    for bar in bars[1:]:
        bar["showscale"] = False
    drawn["showlegend"] = any(t.get("showlegend") for t in data)
    return {"data": data, "layout": drawn}


def text_of(text: str) -> str:
    """Words as plotly shows them: what looks like HTML is text, lines are broken."""
    return escape(text, quote=False).replace("\n", "<br>")


def _key(name: str, place: int) -> str:
    return f"{name}{place + 1}" if place else name


def _axis_key(name: str, place: int) -> str:
    return _key(f"{name}axis", place)


def _axis(scale: Scale, **more: Any) -> Figure:
    plain = {
        "title": {"text": text_of(scale.text), "standoff": 8, "font": {"size": 13, "color": INK}},
        "gridcolor": GRID,
        "linecolor": MUTED,
        "zerolinecolor": "#b8c4ce",
        "zerolinewidth": 1,
        "ticks": "outside",
        "tickcolor": GRID,
        "tickfont": {"size": 12, "color": MUTED},
        "automargin": True,
        "exponentformat": "none",
    }
    if scale.log:
        plain["type"] = "log"
    if scale.ends:
        plain["range"] = [math.log10(e) if scale.log else e for e in scale.ends]
    if scale.floor:
        plain["rangemode"] = "nonnegative"
    if scale.spacing:
        plain["dtick"] = scale.spacing
    if scale.ticks:
        plain["tickvals"] = [value for value, _ in scale.ticks]
        plain["ticktext"] = [text_of(text) for _, text in scale.ticks]
    return plain | more


def _layout(height: float, **more: Any) -> Figure:
    plain = {
        "height": round(height),
        "margin": {"l": LEFT, "r": RIGHT, "t": TOP, "b": BOTTOM},
        "paper_bgcolor": "#ffffff",
        "plot_bgcolor": "#ffffff",
        "font": {"family": FONT, "size": 13, "color": INK},
        "hoverlabel": {"font": {"family": FONT, "size": 12}},
    }
    return plain | more


def _legend(height: float) -> Figure:
    """A legend that stands on top of a share of the plot's height."""
    return {
        "orientation": "h",
        "x": 0,
        "xanchor": "left",
        "y": height,
        "yanchor": "bottom",
        "font": {"size": 12},
        "traceorder": "normal",
        "bgcolor": "rgba(255, 255, 255, 0)",  # a mark at the upper edge stays whole
    }


def _legend_height(subplot: Subplot) -> float:
    """Height [pixel] of the legend of a subplot, and of the space above it."""
    names = subplot.names
    if not names:
        return GAP
    each = SAMPLE + CHARACTER * max(map(len, names))
    return GAP + LEGEND * math.ceil(len(names) / max(1, WIDTH // each))


def _rows(diagram: Diagram) -> Figure:
    """Layout of subplots below each other."""
    first, *below = (_legend_height(s) for s in diagram.subplots)
    heads = [0.0, *below]
    inner = sum(heads) + sum(s.height for s in diagram.subplots)
    over_time = _any(diagram.marks, SamplesMark)
    drawn = _layout(inner + TOP + first + BOTTOM, rows=[[] for _ in diagram.subplots])
    drawn["margin"] |= {
        "t": TOP + first,
        "r": _right(diagram),
        "l": OVER_TIME if over_time else LEFT,
    }
    drawn["hovermode"] = "x" if diagram.shape == FREE else "closest"
    if over_time and len(diagram.subplots) > 1:
        drawn["hoversubplots"] = "axis"
    across, up = _one_scale(diagram)
    top = inner
    for i, subplot in enumerate(diagram.subplots):
        top -= heads[i]
        domain = [max(0.0, top - subplot.height) / inner, top / inner]
        top -= subplot.height
        drawn[_key("legend", i)] = _legend(domain[1])
        # Plots over time line up: their margin is fixed.
        more: Figure = {"domain": domain, "automargin": not over_time}
        if diagram.shape == FREE:
            more |= {"nticks": 6 if subplot.height >= FLAT else 4}
        if _any(subplot.marks, BarMark):
            more |= {"autorange": "reversed", "tickvals": None, "ticktext": None}
        drawn[_axis_key("y", i)] = _axis(subplot.y, **more | up)
    last, count = _key("y", len(diagram.subplots) - 1), len(diagram.x)
    for j, scale in enumerate(diagram.x):
        width = (1.0 - BESIDE * (count - 1)) / count
        start = j * (width + BESIDE)
        more = {"domain": [start, min(1.0, start + width)]} if count > 1 else {}
        drawn[_axis_key("x", j)] = _axis(scale, **{"anchor": last} | more | across)
    if diagram.shape == SPACE:
        _into_space(diagram, drawn)
    return drawn


def _any(marks: Iterable[Mark], kind: type) -> bool:
    return any(isinstance(m, kind) for m in marks)


def _right(diagram: Diagram) -> int:
    """Margin [pixel] right of the plots: room for the texts of levels and of bars."""
    levels = [len(m.text) for m in diagram.marks if isinstance(m, LevelMark) and not m.upright]
    bars = BAR_TEXT if _any(diagram.marks, BarMark) else 0
    return math.ceil(RIGHT + CHARACTER * max(levels, default=0) + bars)


def _one_scale(diagram: Diagram) -> tuple[Figure, Figure]:
    """What makes a millimetre of x as long as one of y, for either axis; nothing elsewhere."""
    if diagram.shape != EQUAL:
        return {}, {}
    # Axes of one scale are as long as what they show, or show more where their ends are given.
    alike = {"constrain": "range" if diagram.x[0].ends else "domain"}
    across: Figure = dict(alike)
    up: Figure = alike | {"scaleanchor": "x", "scaleratio": 1}
    # The script of a page may magnify an error that is coloured: its axes follow by themselves.
    if not diagram.heat:
        low, high = (ends.tolist() for ends in bounds(diagram))
        across["range"], up["range"] = ([a, b] for a, b in zip(low, high, strict=True))
    return across, up


def _into_space(diagram: Diagram, drawn: Figure) -> None:
    """Replace the axes in a plane by axes in space."""
    scales = (diagram.x[0], diagram.subplots[0].y, diagram.z)
    drawn["scene"] = {"aspectmode": "data", "camera": CAMERA}
    for name, scale in zip("xyz", scales, strict=True):
        axis = _axis(scale)
        for key in ("automargin", "ticks", "tickcolor"):
            axis.pop(key)
        axis["title"].pop("standoff")
        drawn["scene"][f"{name}axis"] = axis
    for key in ("xaxis", "yaxis"):
        drawn.pop(key)
    drawn["margin"] = {"l": 0, "r": 0, "t": 34, "b": 0}


def _polar(diagram: Diagram) -> Figure:
    """Layout of a diagram round a centre; the labels of its radial axis are a trace."""
    (subplot,), (angle,) = diagram.subplots, diagram.x
    labels = [t for t in subplot.y.ticks if t[1]]
    told = {
        "type": "scatterpolar",
        "mode": "text",
        "theta": [LABELS_AT] * len(labels),
        "r": [value for value, _ in labels],
        "text": [text_of(text) for _, text in labels],
        "textfont": {"size": 12, "color": MUTED},
        "hoverinfo": "skip",
        "showlegend": False,
    }
    polar = {
        "bgcolor": "#ffffff",
        "radialaxis": {
            "range": list(subplot.y.ends or ()),
            "tickvals": [value for value, _ in subplot.y.ticks],
            "showticklabels": False,
            "gridcolor": GRID,
            "linecolor": "rgba(0,0,0,0)",
            "ticks": "",
        },
        "angularaxis": {
            "tickvals": [value for value, _ in angle.ticks],
            "ticktext": [text_of(text) for _, text in angle.ticks],
            "tickfont": {"size": 12, "color": INK},
            "gridcolor": GRID,
            "linecolor": GRID,
        },
    }
    margin = {"l": 40, "r": 40, "t": 56, "b": 30}
    more = {"margin": margin, "polar": polar, "rows": [[told]], "legend": _legend(1.07)}
    return _layout(subplot.height + margin["t"] + margin["b"], **more)


def _clear(color: str, part: float) -> str:
    """A colour through which a part of what lies below is seen."""
    parts = ",".join(str(int(color[k : k + 2], 16)) for k in (1, 3, 5))
    return f"rgba({parts},{part})"


def _heat(heat: Heat, few: bool = False) -> Figure:
    """Colours by value, and the scale beside the plot."""
    scaled: Callable[[Any], Any] = np.log10 if heat.log else np.asarray
    low, high = (float(e) for e in scaled(np.array(heat.ends, dtype=np.float64)))
    bar: Figure = {
        "title": {"text": text_of(heat.title), "side": "right", "font": {"size": 12}},
        "thickness": 14,
        "outlinewidth": 0,
        "tickfont": {"size": 12, "color": MUTED},
    }
    if heat.ticks:
        bar["tickvals"] = np.atleast_1d(scaled(np.array(heat.ticks))).tolist()
        bar["ticktext"] = [f"{t:g}" for t in heat.ticks]
    ends = {} if few else {"cmin": low, "cmax": high, "color": packed(scaled(heat.values))}
    return {"colorscale": COLORSCALE, "colorbar": bar} | ends


def _hover(hover: Any) -> Figure:
    if hover is None:
        return {}
    if not len(hover):
        return {"hoverinfo": "skip"}
    # All at once: a call for each of thousands takes a hundredth of a run's time.
    words = text_of("\0".join(hover)).split("\0")
    return {"hovertext": words, "hoverinfo": "text"}


def _points(mark: LineMark | PointMark, space: bool) -> Figure:
    z = getattr(mark, "z", None)
    exact = isinstance(mark, PointMark)
    found = {"x": packed(mark.x, exact), "y": packed(mark.y, exact)}
    return found | ({"z": packed(z, exact)} if space and z is not None else {})


def _line(mark: LineMark, diagram: Diagram, subplot: Subplot, _: Figure) -> Any:
    space, name = diagram.shape == SPACE, text_of(mark.name)
    width = mark.width * (IN_SPACE if space else 1.0)
    line: Figure = {"color": mark.color, "width": round(width, 2), "dash": mark.dash}
    trace: Figure = {"type": "scatter3d" if space else "scatter", "mode": "lines", "name": name}
    if diagram.shape == POLAR:
        told = f"%{{theta:.1f}}°: %{{r:.2f}} {subplot.y.unit}<extra>{name}</extra>"
        ends: Figure = {"theta": packed(mark.x), "r": packed(mark.y), "hovertemplate": told}
        return [trace | {"type": "scatterpolar", "line": line} | ends | _hover(mark.hover)], {}
    trace |= {"line": line} | _points(mark, space) | _hover(mark.hover)
    if mark.heat:
        trace["mode"] = "markers+lines"
        trace["line"] = {"color": _clear(mark.color, 0.35), "width": 1}
        trace["marker"] = {"size": 2.5 if space else 4} | _heat(mark.heat)
    return [trace], {}


def _samples(mark: SamplesMark, _: Diagram, subplot: Subplot, at: Figure) -> Any:
    shape = "hv" if mark.samples.steps else "linear"
    line = {"color": mark.color, "width": mark.width, "dash": mark.dash, "shape": shape}
    trace: Figure = {"type": "scatter", "mode": "lines", "name": text_of(mark.name)}
    trace |= {"line": line, "samples": mark.samples}
    if mark.samples.dots:
        trace["marker"] = {"size": 3, "color": mark.color}
    if mark.samples.lines is not None:
        told = f"%{{y:.4g}} {text_of(subplot.y.unit)}, line %{{customdata}}<extra></extra>"
        trace["hovertemplate"] = told
    return [trace], {}


def _point(mark: PointMark, diagram: Diagram, _: Subplot, at: Figure) -> Any:
    marker: Figure = {"size": mark.size, "symbol": SYMBOLS.get(mark.symbol, mark.symbol)}
    marker |= _heat(mark.heat) if mark.heat else {"color": mark.color}
    if mark.edge:
        marker["line"] = {"color": mark.edge, "width": 1.6}
    space = diagram.shape == SPACE
    trace: Figure = {"type": "scatter3d" if space else "scatter", "mode": "markers"}
    trace |= {"name": text_of(mark.name), "marker": marker}
    trace |= ({} if space else {"cliponaxis": False}) | _points(mark, space) | _hover(mark.hover)
    if len(mark.texts):
        trace |= {"mode": "markers+text", "text": [text_of(t) for t in mark.texts]}
        trace |= {"textposition": mark.side, "textfont": {"size": 12, "color": INK}}
    return [trace], {}


def _band(mark: BandMark, _: Diagram, __: Subplot, at: Figure) -> Any:
    plain: Figure = {"type": "scatter", "mode": "lines", "hoverinfo": "skip", "line": {"width": 0}}
    plain["x"] = packed(mark.x)
    below = plain | {"y": packed(mark.low), "showlegend": False}
    color = _clear(mark.color, LIGHT)
    above = plain | {"y": packed(mark.high), "name": text_of(mark.name)}
    return [below, above | {"fill": "tonexty", "fillcolor": color}], {}


def _bar(mark: BarMark, diagram: Diagram, subplot: Subplot, at: Figure) -> Any:
    trace = {
        "type": "bar",
        "orientation": "h",
        "name": text_of(mark.name),
        "y": [text_of(text) for _, text in subplot.y.ticks],
        "x": [None if v is None else float(v) for v in mark.values],
        "text": [text_of(text) for text in mark.texts],
        "textposition": "outside",
        "cliponaxis": False,
        "marker": {"color": mark.color},
        "hoverinfo": "skip",
    }
    return [trace], {}


def _level(mark: LevelMark, diagram: Diagram, plot: Subplot, at: Figure) -> Any:
    x, y = at["xaxis"], at["yaxis"]
    across = {"x0": 0, "x1": 1, "xref": f"{x} domain"} | {
        "y0": mark.value,
        "y1": mark.value,
        "yref": y,
    }
    up = {"x0": mark.value, "x1": mark.value, "xref": x} | {"y0": 0, "y1": 1, "yref": f"{y} domain"}
    line = {"color": mark.color, "width": 1.3, "dash": mark.dash}
    shape = (up if mark.upright else across) | {"type": "line", "line": line}
    if not mark.text:
        return [], {"shapes": [shape]}
    told: Figure = {"text": text_of(mark.text), "showarrow": False}
    scale = diagram.x[0] if mark.upright else plot.y
    # Unlike a line, a text has the exponent of its place on a logarithmic axis.
    place = math.log10(mark.value) if scale.log else mark.value
    if mark.upright:
        told |= {"x": place, "xref": x, "y": 1, "yref": f"{y} domain", "yanchor": "top"}
        told |= {"xanchor": "left" if mark.side == "right" else "right"}
        told |= {"xshift": 4 if mark.side == "right" else -4}
        told |= {"font": {"size": 12, "color": mark.color}}
    else:
        told |= {"x": 1, "xref": f"{x} domain", "xanchor": "left", "xshift": 4}
        told |= {"y": place, "yref": y, "yanchor": "middle"}
        told |= {"font": {"size": 12, "color": INK}}
    return [], {"shapes": [shape], "annotations": [told]}


def _circle(mark: CircleMark, _: Diagram, __: Subplot, at: Figure) -> Any:
    x, y, r = mark.x, mark.y, mark.radius
    ends = {"x0": x - r, "x1": x + r, "y0": y - r, "y1": y + r}
    line = {"color": mark.color, "width": 1, "dash": mark.dash}
    shape = {"type": "circle", "xref": at["xaxis"], "yref": at["yaxis"], "line": line} | ends
    return [], {"shapes": [shape | ({"fillcolor": _clear(mark.color, 0.1)} if mark.filled else {})]}


def _field(mark: FieldMark, diagram: Diagram, subplot: Subplot, at: Figure) -> Any:
    heat = mark.heat
    values = np.log10(heat.values) if heat.log else heat.values
    ends = np.log10(heat.ends) if heat.log else np.array(heat.ends)
    # The lowest and the highest colour reach a step beyond: to the ends of the scale.
    steps = 18 if heat.log else max(len(heat.ticks) - 1, 2)
    size = float(ends[1] - ends[0]) / steps
    even = {"start": float(ends[0]) + size, "end": float(ends[1]) - size, "size": size}
    scales = diagram.x[0], subplot.y
    told = [f"{text_of(s.text)} %{{{a}:.6g}}" for s, a in zip(scales, "xy", strict=True)]
    trace = {
        "type": "contour",
        "x": packed(mark.x, exact=True),
        "y": packed(mark.y, exact=True),
        "z": _rows_of(values),
        "customdata": _rows_of(heat.values),
        "contours": even | {"coloring": "fill", "showlabels": not heat.log},
        "line": {"width": 0.8, "color": "#ffffff"},
        "hovertemplate": "<br>".join([*told, f"{text_of(heat.title)} %{{customdata:.6g}}"])
        + "<extra></extra>",
    }
    return [trace | _heat(heat, few=True)], {}


def _rows_of(values: Array) -> list[list[float | None]]:
    return [[None if np.isnan(v) else float(v) for v in row] for row in values]


_TRACES: dict[type, Callable[[Any, Diagram, Subplot, Figure], Any]] = {
    LineMark: _line,
    SamplesMark: _samples,
    PointMark: _point,
    BandMark: _band,
    BarMark: _bar,
    LevelMark: _level,
    CircleMark: _circle,
    FieldMark: _field,
}
