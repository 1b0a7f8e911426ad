"""The page of a study: its cost over what was varied, its best runs, its errors."""

import os
from collections import Counter
from collections.abc import Iterable
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from motionfmu.base.errors import InputError
from motionfmu.base.units import spelled
from motionfmu.report.numbers import label
from motionfmu.report.packed import packed
from motionfmu.report.sheet import Frame, Sheet
from motionfmu.report.studies.sweep_field import (
    CURVE,
    FIELD,
    MATRIX,
    Dimension,
    cost_label,
    cost_of,
    dimensions,
    field,
    kind,
    levels,
    logarithmic,
    rangemode,
)
from motionfmu.report.style import AXES, COLORSCALE, INK, MUTED, axis, layout
from motionfmu.report.tables import cards, picture_links, table

if TYPE_CHECKING:
    from motionfmu.study.study_outcome import Outcome

Figure = dict[str, Any]

PAGE = "report.html"
BEST_SHOWN, ERRORS_SHOWN = 10, 20
LINES = 18  # of equal cost, where they are even in the logarithm
CELL = 210  # [pixel] of a scatter matrix
BEST = {"symbol": "star", "size": 17, "color": "#ffffff", "line": {"color": INK, "width": 1.6}}
TUNED = {"symbol": "diamond", "size": 12, "color": AXES[0], "line": {"color": "#fff", "width": 1}}
WORDS = {
    CURVE: "One point is one run.",
    FIELD: "Lines of equal cost; a dot is a run, a cross one without a cost.",
    MATRIX: "One point is one run, its colour is the cost; the smallest lie on top.",
}


def write_sweep(outcome: "Outcome", folder: Path) -> Path:
    """Write report.html and, with a cost, sweep.png and sweep.svg."""
    part = folder / f".{PAGE}.part{os.getpid()}"
    try:
        if np.isfinite(outcome.cost).any():
            from motionfmu.report.studies.sweep_picture import write_picture

            write_picture(outcome, folder)
        part.write_text(page(outcome), encoding="utf-8")
        part.replace(folder / PAGE)
    except OSError as error:
        raise InputError(f"cannot write {folder}: {error.strerror or error}") from None
    finally:
        part.unlink(missing_ok=True)
    return folder / PAGE


def page(outcome: "Outcome") -> str:
    """The page of a study: HTML that needs no network."""
    sheet, study = Sheet(), outcome.study
    sheet.sections.append(_cards(outcome))
    if np.isfinite(outcome.cost).any():
        way = kind(outcome)
        draw = {CURVE: _curve, FIELD: _field}.get(way, _matrix)
        content = sheet.place("cost", draw(outcome)) + picture_links("sweep")
        sheet.section(escape(cost_label(outcome)), f"{WORDS[way]} {_told_best(outcome)}", content)
        if outcome.best is not None:
            note = "Smallest cost first; checks: those of the scenario."
            sheet.section("Best runs", note, _best(outcome))
    if outcome.errors:
        sheet.section("Errors", "Runs that gave no row, by message.", _told(outcome, False))
    if any(row.status == "ok" and row.message for row in outcome.rows):
        note = "Runs with an empty cell, by the reason."
        sheet.section("Missing numbers", note, _told(outcome, True))
    sheet.section("What was varied", "", _varied(outcome))
    footer = f"{escape(study.sampling)} of {len(study.points)} runs"
    footer += "" if study.sampling == "grid" else f", seed {study.seed}"
    footer += "; every row is in sweep.parquet."
    return sheet.text(Frame(study.name, study.about, "sweep", (), footer))


def _told_best(outcome: "Outcome") -> str:
    """Where the best run lies at an end of the study; that there is none without a cost."""
    if not outcome.study.cost:
        return "No cost was named, so no run is the best: <code>--cost</code>."
    if not outcome.at_the_edge:
        return ""
    places = escape("; ".join(outcome.at_the_edge))
    return f"<b>The best run is at the edge of the study</b>: {places}. Less may lie beyond."


def _number(value: Any) -> str:
    if value is None:
        return ""
    return f"{value:.6g}" if isinstance(value, float) else escape(str(value))


def _cards(outcome: "Outcome") -> str:
    rows, study, best = outcome.rows, outcome.study, outcome.best
    held = sum(row.checks is True for row in rows)
    shown = [("Runs", str(len(rows)), f"{outcome.errors} with an error")]
    if any(row.checks is not None for row in rows):
        shown.append(("Checks hold", str(held), f"of {len(rows)} runs"))
    if best is not None:
        point = zip(study.axes, study.points[best], strict=True)
        where = ", ".join(f"{a.name} = {_number(v)} {spelled(a.unit)}".strip() for a, v in point)
        shown.append((f"Smallest {cost_label(outcome)}", f"{cost_of(outcome)[best]:.4g}", where))
    return cards(shown)


def _best(outcome: "Outcome") -> str:
    study = outcome.study
    known = np.flatnonzero(np.isfinite(cost_of(outcome)))
    order = known[np.argsort(cost_of(outcome)[known], kind="stable")][:BEST_SHOWN]
    words = {True: "✓", False: "✗", None: ""}
    names = [c.name for c in study.columns]
    first = sorted(
        range(len(names)), key=lambda k: names[k] != study.cost
    )  # the cost, then as asked
    body = []
    for i in order:
        row = outcome.rows[i]
        numbers = [*study.points[row.run], *(row.values[k] for k in first)]
        mark = escape(row.status if row.status != "ok" else words[row.checks])
        body.append([str(row.run), mark, *map(_number, numbers)])
    units = [label(a.name, a.unit) for a in study.axes]
    units += [label(study.columns[k].name, study.columns[k].unit) for k in first]
    return table(["Run", "Checks", *map(escape, units)], body, numeric=2)


def _told(outcome: "Outcome", ok: bool) -> str:
    """Messages of the rows that are ok, or of the others."""
    rows = [row for row in outcome.rows if row.message and (row.status == "ok") is ok]
    told = Counter(row.message for row in rows)
    first = {row.message: row.run for row in reversed(rows)}
    body: list[tuple[str, str, str]] = [
        (escape(text), str(n), str(first[text])) for text, n in told.most_common(ERRORS_SHOWN)
    ]
    if more := len(told) - len(body):
        body.append((f"{more} more messages", "", ""))
    return table(("Message", "Runs", "First run"), body)


def _varied(outcome: "Outcome") -> str:
    body = []
    for shown in dimensions(outcome):
        different = list(dict.fromkeys(shown.values))
        if shown.numeric:
            ends = f"{shown.numbers.min():g} … {shown.numbers.max():g}"
        else:
            ends = escape(", ".join(map(str, different)))
        body.append((escape(shown.label), str(len(different)), ends))
    return table(("Variable", "Different values", "Range"), body)


def _scale(shown: Dimension, **more: Any) -> Figure:
    kinds = {"type": "log" if shown.log else "linear"} if shown.numeric else {"type": "category"}
    return axis(escape(shown.label), **kinds, zeroline=False, **more)


def _series(name: str, x: Iterable[Any], y: Iterable[Any], marker: Figure) -> Figure:
    point: Figure = {"type": "scatter", "mode": "markers", "name": name, "marker": marker}
    point["cliponaxis"] = False
    return point | {"x": list(x), "y": list(y)}


def _marks(outcome: "Outcome", shown: list[Dimension]) -> list[Figure]:
    """The best run, the tuned point, and runs with an error."""
    found, values = [], [d.values for d in shown]
    bad = np.flatnonzero(~np.isfinite(cost_of(outcome)))
    if len(bad):
        cross = {"symbol": "x-thin-open", "size": 6, "color": MUTED}
        x, y = ([v[i] for i in bad] for v in values)
        found.append(_series("no cost", x, y, cross))
    if (best := outcome.best) is not None:
        point = dict(zip(outcome.study.job.axes, outcome.study.points[best], strict=True))
        x, y = ([point[d.name]] for d in shown)
        found.append(_series(f"best: run {best}", x, y, BEST))
    if tuned := outcome.study.tuned:
        x, y = ([tuned[d.name]] for d in shown)
        found.append(_series("tuned", x, y, TUNED))
    return found


def _field(outcome: "Outcome") -> Figure:
    found, shown = field(outcome), dimensions(outcome)
    assert found is not None, "kind() has seen it"
    log, steps = logarithmic(found.z), levels(found.z)
    z = np.log10(found.z) if log else found.z
    at = np.log10(steps) if log else steps
    title = {"text": escape(cost_label(outcome)), "side": "right", "font": {"size": 12}}
    bar: Figure = {"outlinewidth": 0, "title": title}
    bar |= {"tickvals": at.tolist(), "ticktext": [f"{s:g}" for s in steps]}
    # The lowest and the highest colour reach a step beyond: to the ends of the levels.
    steps_shown = LINES if log else max(len(at) - 1, 2)
    size = float(at[-1] - at[0]) / steps_shown
    even = {"start": float(at[0]) + size, "end": float(at[-1]) - size, "size": size}
    drawn = {
        "type": "contour",
        "x": packed(found.x, exact=True),
        "y": packed(found.y, exact=True),
        "z": [[None if np.isnan(v) else float(v) for v in row] for row in z],
        "customdata": [[None if np.isnan(v) else float(v) for v in row] for row in found.z],
        "colorscale": COLORSCALE,
        "contours": even | {"coloring": "fill", "showlabels": not log},
        "line": {"width": 0.8, "color": "#ffffff"},
        "colorbar": bar,
        "hovertemplate": f"{escape(shown[0].label)} %{{x:.6g}}"
        f"<br>{escape(shown[1].label)} %{{y:.6g}}"
        f"<br>{escape(cost_label(outcome))} %{{customdata:.6g}}<extra></extra>",
    }
    data = [drawn]
    known = np.isfinite(outcome.cost)
    dot = {"size": 4, "color": INK, "opacity": 0.5}
    x, y = ([v for v, k in zip(d.values, known, strict=True) if k] for d in shown)
    runs = _series("runs", x, y, dot) | {"hoverinfo": "skip"}
    data.append(runs)
    ends = ([float(d.even.min()), float(d.even.max())] for d in shown)
    across, up = (_scale(d, range=e) for d, e in zip(shown, ends, strict=True))
    more: Figure = {"xaxis": across, "yaxis": up, "showlegend": True}
    return {"data": data + _marks(outcome, shown), "layout": layout(560, **more)}


def _curve(outcome: "Outcome") -> Figure:
    (shown,), cost = dimensions(outcome), cost_of(outcome)
    order = np.argsort(shown.numbers, kind="stable")
    x = [shown.values[i] for i in order]
    y = [None if np.isnan(c) else float(c) for c in cost[order]]
    style = {"color": AXES[1], "size": 6}
    data = [_series("runs", x, y, style) | {"line": {"color": AXES[1], "width": 1.5}}]
    data[0]["mode"] = "lines+markers" if shown.numeric else "markers"
    if (best := outcome.best) is not None:
        data.append(_series(f"best: run {best}", [shown.values[best]], [float(cost[best])], BEST))
    kinds = {"type": "log" if logarithmic(cost) else "linear", "exponentformat": "power"}
    kinds |= {"rangemode": rangemode(cost)}
    more: Figure = {"xaxis": _scale(shown), "showlegend": True}
    more["yaxis"] = axis(escape(cost_label(outcome)), **kinds)
    if shown.name in outcome.study.tuned:
        tuned = outcome.study.tuned[shown.name]
        line = {"color": AXES[0], "width": 1.5, "dash": "dash"}
        ends = {"x0": tuned, "x1": tuned, "y0": 0, "y1": 1, "yref": "paper"}
        more["shapes"] = [ends | {"type": "line", "line": line}]
        text = {"text": "tuned", "showarrow": False, "xanchor": "left", "font": {"color": AXES[0]}}
        more["annotations"] = [text | {"x": tuned, "y": 1, "yref": "paper"}]
    return {"data": data, "layout": layout(420, **more)}


def _matrix(outcome: "Outcome") -> Figure:
    shown, cost, study = dimensions(outcome), cost_of(outcome), outcome.study
    order = np.argsort(-np.where(np.isfinite(cost), cost, np.inf), kind="stable")
    order = order[np.isfinite(cost[order])]
    log = logarithmic(cost)
    color = np.log10(cost[order]) if log else cost[order]
    steps = levels(cost)
    title = {"text": escape(cost_label(outcome)), "side": "right", "font": {"size": 12}}
    bar: Figure = {"outlinewidth": 0, "title": title}
    bar |= {"tickvals": (np.log10(steps) if log else steps).tolist()}
    bar |= {"ticktext": [f"{s:g}" for s in steps]}

    def cloud(name: str, columns: list[list[Any]], costs: list[Any], marker: Figure) -> Figure:
        named = zip([d.label for d in shown], columns, strict=True)
        listed = [{"label": escape(n), "values": c} for n, c in named]
        listed.append({"label": escape(cost_label(outcome)), "values": costs})
        half = {"diagonal": {"visible": False}, "showupperhalf": False}
        return {"type": "splom", "name": name, "dimensions": listed, "marker": marker} | half

    columns = [[d.values[i] for i in order] for d in shown]
    many = {"color": packed(color), "colorscale": COLORSCALE, "colorbar": bar, "size": 5}
    data = [cloud("runs", columns, [float(cost[i]) for i in order], many)]
    if (best := outcome.best) is not None:
        point = [[v] for v in study.points[best]]
        data.append(cloud(f"best: run {best}", point, [float(cost[best])], BEST | {"size": 13}))
    if study.tuned:
        point = [[study.tuned[d.name]] for d in shown]
        data.append(cloud("tuned", point, [None], TUNED | {"size": 9}))
    more: Figure = {}
    for i, d in enumerate(shown):
        key = str(i + 1) if i else ""
        for way in ("xaxis", "yaxis"):
            more[way + key] = _scale(d)
    last = str(len(shown) + 1)
    for way in ("xaxis", "yaxis"):
        kinds = {"type": "log" if log else "linear", "rangemode": rangemode(cost)}
        more[way + last] = axis(escape(cost_label(outcome)), zeroline=False, **kinds)
    return {"data": data, "layout": layout(CELL * len(shown) + 90, **more)}
