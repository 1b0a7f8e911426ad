"""The explanation as one HTML page, with its picture and numbers beside it."""

import json
import math
from collections.abc import Sequence
from html import escape
from pathlib import Path

import numpy as np

from motionfmu.analysis.contour.circles import CircularTest
from motionfmu.analysis.explain import ballbar
from motionfmu.analysis.explain.ballbar import Signature
from motionfmu.analysis.explain.decompose import Effect, Explanation
from motionfmu.analysis.explain.theory import CornerRow
from motionfmu.report.diagram import BarMark, Diagram, LineMark, Scale, one
from motionfmu.report.formula import readable
from motionfmu.report.html_page import Page, PageFrame
from motionfmu.report.html_tables import RMS, cards, circle_table, folded, overrides, table
from motionfmu.report.numbers import figure, length, unit
from motionfmu.report.polar_chart import polar_chart
from motionfmu.report.style import AXES, INK, MUTED
from motionfmu.run.decimate import keep_peaks

PAGE, NUMBERS = "report.html", "result.json"
# Points of a curve over the path: twice as many as a screen has columns.
BUCKETS = 1200
OVER_WAY = "over the way"
BAR_HEIGHT, HEIGHT = 44, 238  # [pixel] of a cause, of the curves over the path
CAUSE, FORMULA = AXES[0], "#9ec8e3"
FOOTER = (
    "A cause is the change of the contour error between the run and the same run without it, at the"
    " same places of the path. Its size is the largest such change. Servo lag and path are what is"
    " left with all causes switched off together. The first places after a rest are not counted:"
    " how a tool starts depends on where friction has left it. The causes interact, so their sum is"
    ' not the whole: the residual says by how much. All numbers are in <a href="result.json">'
    "result.json</a>."
)


def write_explanation(found: Explanation, folder: Path) -> Path:
    """Write report.html, result.json, causes.png and causes.svg."""
    text = json.dumps({"scenario": found.result.name} | found.numbers(), indent=1)
    (folder / NUMBERS).write_text(text + "\n", encoding="utf-8")
    _write_picture(found, folder)
    (folder / PAGE).write_text(page_text(found), encoding="utf-8")
    return folder / PAGE


def page_text(found: Explanation) -> str:
    """The whole HTML page."""
    page = Page()
    page.sections.append(_cards(found))
    if found.result.overrides:
        page.section("What was run", "", overrides(found.result.overrides))
    note = "Largest change of the contour error by each cause: simulated beside theory."
    content = page.place("causes", _bars(found)) + _effects(found)
    page.section("Causes", note, content)
    note = (
        "The contour error of the run, the sum of all single effects, and what the sum leaves:"
        " interaction of the causes."
    )
    page.section("Along the path", note, page.place("along", _curves(found)))
    for i, mark in enumerate(found.signatures):
        add_circle(page, f"circle{i}", mark)
    if found.corners:
        note = (
            "Theory: first-order axes with the mean gain, the corner run into at the speed of the"
            " command. A corner at which the command rests until the tool has come has no error;"
            " moves too short for their ramps have no formula."
        )
        page.section("Corners", note, _corners(found))
    result = found.result
    frame = PageFrame(result.name, result.about, "contour error explained", (), FOOTER)
    return page.text(frame)


def _cards(found: Explanation) -> str:
    first = found.effects[0]
    numbers = found.numbers()
    whole, total, rest = (numbers[n] for n in ("contour_error", "sum_of_effects", "residual"))
    theory = "" if first.theory.value is None else f"theory {length(first.theory.value)}"
    rows = [
        ("Largest contour error", length(whole["max"]), f"RMS {length(whole['rms'])}, {RMS}"),
        (f"First cause: {first.title}", length(first.size), theory),
        ("Sum of all effects", length(total["max"]), f"RMS {length(total['rms'])}, {OVER_WAY}"),
        ("Residual: interaction", length(rest["max"]), f"RMS {length(rest['rms'])}, {OVER_WAY}"),
    ]
    return cards(rows)


def shown(found: Explanation) -> list[Effect]:
    """Effects that a chart shows: those that act, and those that act in theory."""
    # The largest effect comes first; if none acts, all are shown.
    acting = [e for e in found.effects if e.judged and (e.size > 0.0 or e.theory.value)]
    return acting or list(found.effects)


def _bars(found: Explanation) -> Diagram:
    effects = shown(found)
    theory = [e.theory.value for e in effects]
    factor, name = unit(max(max(e.size, e.theory.value or 0.0) for e in effects))
    marks = []
    simulated: list[float | None] = [e.size for e in effects]
    for what, sizes, color in (("simulated", simulated, CAUSE), ("theory", theory, FORMULA)):
        values = [None if v is None else v * factor for v in sizes]
        texts = ["" if v is None else f"{figure(v)} {name}" for v in values]
        marks.append(BarMark(values, texts, what, color))
    titles = tuple((float(i), e.title) for i, e in enumerate(effects))
    across = Scale("Largest change of the contour error", name, floor=True)
    return one(across, Scale(ticks=titles), marks, BAR_HEIGHT * len(effects))


def _write_picture(found: Explanation, folder: Path) -> None:
    """Draw the causes, and the first circle that was run, as causes.png and causes.svg."""
    from motionfmu.report.matplotlib_figure import write_picture

    columns, note = [_bars(found)], ""
    for mark in found.signatures[:1]:
        columns.append(polar_chart(mark.test))
        named = [f"{f.name} {length(f.size)}" for f in mark.findings if f.named]
        words = ", ".join([f"mean radius {length(mark.mean, sign=True)}", *named])
        note = f"{_circle_title(mark.test)}: {words}"
    title = f"{found.result.name}: causes of the contour error"
    write_picture(folder / "causes", title, note, *columns)


def _effects(found: Explanation) -> str:
    rows = []
    still = {e.name for e in idle(found)}
    for e in (e for e in found.effects if e.name not in still):
        said = "" if e.theory.value is None else length(e.theory.value)
        title = f'{escape(e.title)}<br><span class="sub">{escape(_wrap(e.how))}</span>'
        formula = f'<span class="formula">{readable(e.theory.formula)}</span>'
        line = str(e.where) if e.where else ""
        without = "" if e.without is None else length(e.without)
        sizes = (length(e.size), line, length(e.usual), length(e.rms), without, said)
        if not e.judged:
            sizes = ("not judged", "", "", "", "", said)
        rows.append((title, formula, *sizes))
    heads = ("Cause, and how it is off", "Formula", "Largest", "Line", "99 %", f"RMS {OVER_WAY}")
    return table((*heads, "Error without", "Theory"), rows, numeric=2) + _without(idle(found))


def idle(found: Explanation) -> list[Effect]:
    """Causes that change nothing, in the runs and in theory."""
    return [e for e in found.effects if e.judged and e.size == 0.0 and not e.theory.value]


def _without(effects: list[Effect]) -> str:
    if not effects:
        return ""
    told = escape(", ".join(e.title for e in effects))
    return f'<p class="note">Switched off without any change: {told}.</p>'


def _wrap(text: str, most: int = 5) -> str:
    parts = text.split(", ")
    whole = text.count("[") or len(parts) <= most
    return text if whole else ", ".join(parts[:most]) + f" and {len(parts) - most} more"


def _curves(found: Explanation) -> Diagram:
    factor, name = unit(float(np.abs(found.whole).max()))
    lines = []
    for what, values, color, width in (
        ("contour error", found.whole, INK, 2.4),
        ("sum of the effects", found.together, AXES[1], 1.2),
        ("residual", found.residual, MUTED, 1.0),
    ):
        kept = keep_peaks(values, BUCKETS)
        lines.append(LineMark(found.along[kept], values[kept] * factor, what, color, width))
    scales = Scale("Place on the path", "mm"), Scale("Contour error", name)
    return one(*scales, lines, HEIGHT)


def add_circle(page: Page, name: str, mark: Signature) -> None:
    """Add a ballbar's picture of a circle, its diagnosis and the quantities of ISO 230-4."""
    plot = page.place(name, polar_chart(mark.test))
    words = "".join(f"<li>{escape(w)}</li>" for w in mark.words())
    rows = [
        (f"<b>{f.name}</b>" if f.named else f.name, length(f.size), "named" if f.named else "")
        for f in mark.findings
    ]
    mean = f"Mean radius {length(mark.mean, sign=True)}: servo lag, or both axes' scale alike."
    right = (
        f"<h3>Diagnosis</h3><ul><li>{mean}</li>{words}</ul>"
        f"{table(('Part of the signature', 'Size', ''), rows)}"
        f'<p class="note">Largest radial deviation of each part. Named from'
        f" {ballbar.NAMED_MIN * 1e3:g} µm and {ballbar.NAMED_SHARE:.0%} of the largest on; spikes"
        f" also from {ballbar.SPIKE_SCATTER:g} times the {length(mark.rest)} RMS that the fit"
        " leaves.</p>"
    )
    note = (
        "Radial deviation about the nominal centre, both ways round. The fit: least squares of"
        " harmonics and backlash steps, without the"
        f" {math.degrees(ballbar.SPIKE_BEHIND):.0f}° behind each quadrant. ISO 230-4: G and G(b)"
        " about the centre of minimum zone, F about the nominal centre, D about the least-squares"
        " centre."
    )
    content = f'<div class="two">{plot}<div>{right}</div></div>{circle_table(mark.test)}'
    page.section(_circle_title(mark.test), note, content)


def _circle_title(test: CircularTest) -> str:
    return f"Ballbar, radius {test.radius:g} mm"


def _corners(found: Explanation) -> str:
    """The corners, the largest errors first."""
    return folded(_corner_rows, sorted(found.corners, key=lambda c: -c.error))


def _corner_rows(corners: Sequence[CornerRow]) -> str:
    rows = [
        (
            f"{c.lines[0]} to {c.lines[1]}",
            c.kind,
            f"{math.degrees(c.angle):.0f}°",
            f"{figure(c.speed)} mm/s",
            length(c.error),
            length(c.ideal),
            "" if c.theory is None else length(c.theory),
        )
        for c in corners
    ]
    heads = ("Lines", "Kind", "Angle", "Speed", "Error", "Servo and path only", "Theory")
    return table(heads, rows, numeric=2)
