"""A tool path explained: one HTML page, its picture and numbers beside it."""

import json
from html import escape
from pathlib import Path

import numpy as np

from motionfmu.analysis.explain.path_causes import FIGURES, PathEffect, PathExplanation
from motionfmu.report.diagram import BarMark, Diagram, LineMark, Scale, one
from motionfmu.report.html_page import Page, PageFrame
from motionfmu.report.html_tables import cards, overrides, picture_links, table
from motionfmu.report.numbers import figure, length, unit
from motionfmu.report.style import AXES, INK, MUTED

PAGE, NUMBERS = "report.html", "result.json"
HEADS = {
    "accuracy": "AT_P",
    "straightness": "Best line",
    "straightness_in_plane": "Best line, on the surface",
    "in_plane": "In plane",
    "height": "Height",
}
BAR_HEIGHT, HEIGHT = 58, 278  # [pixel] of a cause, of the curves over the path
SHOWN = 6  # curves over the path
FOOTER = (
    "A cause is the change of the mean line of all cycles between the run and the same run without"
    " it, in the same planes across the command path. Its figures are those that a path with this"
    " error alone would have. A constant offset is part of AT_P and of no other. The causes"
    " interact, so their sum is not the whole: the residual says by how much. All numbers are in"
    ' <a href="result.json">result.json</a>.'
)


def write_path_explanation(found: PathExplanation, folder: Path) -> Path:
    """Write report.html, result.json, causes.png and causes.svg."""
    text = json.dumps({"scenario": found.result.name} | found.numbers(), indent=1)
    (folder / NUMBERS).write_text(text + "\n", encoding="utf-8")
    _write_picture(found, folder)
    page = Page()
    page.sections.append(_cards(found))
    if found.result.overrides:
        page.section("What was run", "", overrides(found.result.overrides))
    note = "What each cause alone does to the mean line: as an error of its own."
    content = page.place("causes", _bars(found)) + picture_links("causes") + _effects(found)
    page.section("Causes", note, content)
    note = "Change of the mean line by the largest causes: its size in the planes across the path."
    page.section("Along the path", note, page.place("along", _curves(found)))
    result = found.result
    frame = PageFrame(result.name, result.about, "tool path explained", (), FOOTER)
    (folder / PAGE).write_text(page.text(frame), encoding="utf-8")
    return folder / PAGE


def acting(found: PathExplanation) -> list[PathEffect]:
    """Effects that are larger than 0, the largest first; all effects if there is none."""
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


def _bars(found: PathExplanation) -> Diagram:
    effects = acting(found)
    factor, name = unit(max(e.size for e in effects))
    marks = []
    for kind, color in zip(_kinds(found), AXES, strict=False):
        values = [factor * e.figures[kind] for e in effects]
        marks.append(BarMark(values, [f"{figure(v)} {name}" for v in values], HEADS[kind], color))
    titles = tuple((float(i), e.title) for i, e in enumerate(effects))
    across = Scale("Of the change by the cause", name, floor=True)
    return one(across, Scale(ticks=titles), marks, BAR_HEIGHT * len(effects))


# CCN 17: a table in HTML, most of whose cells may be empty.
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


def _curves(found: PathExplanation) -> Diagram:
    shown = [("deviation", found.whole, INK, 2.4)]
    shown += [
        (e.title, e.change, AXES[i], 1.3) for i, e in enumerate(acting(found)[:SHOWN]) if e.size
    ]
    shown.append(("residual", found.residual, MUTED, 1.0))
    factor, name = unit(float(np.linalg.norm(found.whole, axis=1).max()))
    lines = [
        LineMark(found.along, factor * np.linalg.norm(values, axis=1), what, color, width)
        for what, values, color, width in shown
    ]
    return one(Scale("Place on the path", "mm"), Scale("Size", name, floor=True), lines, HEIGHT)


def _write_picture(found: PathExplanation, folder: Path) -> None:
    from motionfmu.report.matplotlib_figure import write_picture

    title = f"{found.result.name}: causes of the deviation"
    write_picture(
        folder / "causes", title, f"AT_P {length(found.figures['accuracy'])}", _bars(found)
    )
