"""A tool path explained: one HTML page, its picture and numbers beside it."""

import json
from html import escape
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from motionfmu.analysis.explain.path_causes import FIGURES, PathEffect, PathExplanation
from motionfmu.report.numbers import figure, length, unit
from motionfmu.report.pictures import PLAIN, STABLE
from motionfmu.report.sheet import Frame, Sheet
from motionfmu.report.style import AXES, GRID, INK, MUTED, axis, layout, plotted
from motionfmu.report.tables import cards, overrides, picture_links, table

PAGE, NUMBERS = "report.html", "result.json"
PICTURES = ("causes.svg", "causes.png")
HEADS = {
    "accuracy": "AT_P",
    "straightness": "Best line",
    "straightness_in_plane": "Best line, on the surface",
    "in_plane": "In plane",
    "height": "Height",
}
BAR_HEIGHT = 58  # [pixel]
SHOWN = 6  # curves over the path
FOOTER = (
    "A cause is the change of the mean line of all cycles between the run and the same run without"
    " it, in the same planes across the command path; its figures are those that a path with this"
    " error alone would have. A constant offset is part of AT_P and of no other. The causes"
    " interact, so their sum is not the whole: the residual says by how much. All numbers are in"
    ' <a href="result.json">result.json</a>.'
)


def write_path_explanation(found: PathExplanation, folder: Path) -> Path:
    """Write report.html, result.json, causes.png and causes.svg."""
    text = json.dumps({"scenario": found.result.name} | found.numbers(), indent=1)
    (folder / NUMBERS).write_text(text + "\n", encoding="utf-8")
    _write_picture(found, folder)
    page = Sheet()
    page.sections.append(_cards(found))
    if found.result.overrides:
        page.section("What was run", "", overrides(found.result.overrides))
    note = "What each cause alone does to the mean line: as an error of its own."
    content = page.place("causes", _bars(found)) + picture_links("causes") + _effects(found)
    page.section("Causes", note, content)
    note = "Change of the mean line by the largest causes: its size in the planes across the path."
    page.section("Along the path", note, page.place("along", _curves(found)))
    result = found.result
    frame = Frame(result.name, result.about, "tool path explained", (), FOOTER)
    (folder / PAGE).write_text(page.text(frame), encoding="utf-8")
    return folder / PAGE


def acting(found: PathExplanation) -> list[PathEffect]:
    """Effects that are to be seen, the largest first; all if none is."""
    return [e for e in found.effects if e.judged and e.size > 0.0] or list(found.effects)


def _cards(found: PathExplanation) -> str:
    first = found.effects[0]
    rest = float(np.linalg.norm(found.residual, axis=1).max())
    whole = [(HEADS[n], length(found.figures[n]), "") for n in FIGURES if n in found.figures]
    more = [
        (f"First cause: {first.title}", length(first.size), "largest change"),
        ("Residual: interaction", length(rest), "whole minus sum of the effects"),
    ]
    return cards([*whole, *more])


def _kinds(found: PathExplanation) -> list[str]:
    return [n for n in FIGURES if n in found.figures and n != "straightness_in_plane"]


def _bars(found: PathExplanation) -> dict[str, Any]:
    effects = acting(found)[::-1]
    factor, name = unit(max(e.size for e in effects))
    data = []
    for i, kind in reversed(list(enumerate(_kinds(found)))):
        values = [factor * e.figures[kind] for e in effects]
        data.append(
            {
                "type": "bar",
                "orientation": "h",
                "name": HEADS[kind],
                "y": [e.title for e in effects],
                "x": values,
                "text": [f"{figure(v)} {name}" for v in values],
                "textposition": "outside",
                "cliponaxis": False,
                "marker": {"color": AXES[i]},
            }
        )
    more = {
        "barmode": "group",
        "margin": {"l": 210, "r": 90, "t": 34, "b": 48},
        "xaxis": axis(f"Of the change by the cause [{name}]", rangemode="tozero"),
        "yaxis": axis("", automargin=True),
        "legend": layout(0)["legend"] | {"traceorder": "reversed"},
    }
    return {"data": data, "layout": layout(110 + BAR_HEIGHT * len(effects), **more)}


def _effects(found: PathExplanation) -> str:
    kinds = [n for n in FIGURES if n in found.figures]
    rows = []
    idle = [e for e in found.effects if e.judged and e.size == 0.0]
    for e in (e for e in found.effects if not (e.judged and e.size == 0.0)):
        title = f'{escape(e.title)}<br><span class="sub">{escape(e.how)}</span>'
        sizes = [length(e.figures[n]) for n in kinds] if e.judged else ["not judged"]
        sizes += [""] * (len(kinds) - len(sizes))
        without = length(e.without["accuracy"]) if e.without else ""
        rows.append((title, *sizes, without))
    whole = [length(found.figures[n]) for n in kinds]
    rows.append(("<b>The whole run</b>", *whole, ""))
    heads = ("Cause, and how it is off", *(HEADS[n] for n in kinds), "AT_P without it")
    told = escape(", ".join(e.title for e in idle))
    note = f'<p class="note">Switched off without any change: {told}.</p>' if idle else ""
    return table(heads, rows) + note


def _curves(found: PathExplanation) -> dict[str, Any]:
    shown = [("deviation", found.whole, INK, 2.4)]
    shown += [
        (e.title, e.change, AXES[i], 1.3) for i, e in enumerate(acting(found)[:SHOWN]) if e.size
    ]
    shown.append(("residual", found.residual, MUTED, 1.0))
    factor, name = unit(float(np.linalg.norm(found.whole, axis=1).max()))
    data = []
    for what, values, color, width in shown:
        size = factor * np.linalg.norm(values, axis=1)
        data.append(plotted(found.along, size, what, color, width=width))
    more = {
        "xaxis": axis("Place on the path [mm]"),
        "yaxis": axis(f"Size [{name}]", rangemode="tozero"),
        "hovermode": "x",
    }
    return {"data": data, "layout": layout(360, **more)}


def _write_picture(found: PathExplanation, folder: Path) -> None:
    effects, kinds = acting(found)[::-1], _kinds(found)[::-1]
    factor, name = unit(max(e.size for e in effects))
    height = 0.8 / len(kinds)
    with matplotlib.rc_context(PLAIN | STABLE):
        drawn = Figure(figsize=(9.0, 1.4 + 0.62 * len(effects)), layout="constrained")
        axes: Any = drawn.add_subplot()
        place = np.arange(len(effects))
        for i, kind in enumerate(kinds):
            sizes = [factor * e.figures[kind] for e in effects]
            shift = (i - 0.5 * (len(kinds) - 1)) * height
            color = AXES[len(kinds) - 1 - i]
            axes.barh(place + shift, sizes, 0.92 * height, color=color, label=HEADS[kind])
        axes.set_yticks(place, [e.title for e in effects], color=INK)
        axes.set_xlabel(f"Of the change by the cause [{name}]")
        told = f"AT_P {length(found.figures['accuracy'])}"
        axes.set_title(f"{found.result.name}: causes of the deviation, {told}", loc="left")
        axes.grid(axis="x", color=GRID)
        axes.set_axisbelow(True)
        axes.tick_params(length=0)
        axes.spines[:].set_visible(False)
        axes.legend(frameon=False, loc="lower right", reverse=True)
        for file in PICTURES:
            plain = {"Date": None} if file.endswith("svg") else None
            drawn.savefig(folder / file, dpi=100, metadata=plain)
