"""The page of a study: its cost over what was varied, its best runs, its errors."""

import os
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from motionfmu.base.errors import InputError
from motionfmu.base.units import spelled
from motionfmu.report.html_page import Page, PageFrame
from motionfmu.report.html_tables import cards, picture_links, table
from motionfmu.report.numbers import label
from motionfmu.report.studies.cost_chart import cost_chart
from motionfmu.report.studies.cost_field import (
    CURVE,
    FIELD,
    MATRIX,
    cost_label,
    cost_of,
    kind,
    least_cost,
)
from motionfmu.report.studies.drawn_rows import drawn_rows

if TYPE_CHECKING:
    from motionfmu.study.study_outcome import Outcome, Told

PAGE = "report.html"
BEST_SHOWN, ERRORS_SHOWN = 10, 20
WORDS = {
    CURVE: "One point is one run.",
    FIELD: "Lines of equal cost; a dot is a run, a cross one without a cost.",
    MATRIX: "One point is one run, its colour is the cost; the smallest lie on top.",
}


def write_sweep(outcome: "Outcome", folder: Path) -> Path:
    """Write report.html and, with a cost, sweep.png and sweep.svg."""
    part, drawn = folder / f".{PAGE}.part{os.getpid()}", drawn_rows(outcome)
    try:
        if np.isfinite(outcome.cost).any():
            from motionfmu.report.matplotlib_figure import write_picture

            title = f"{outcome.study.name}: {cost_label(outcome)}"
            best, note = outcome.best, ""
            if best is not None:
                note = f"smallest {least_cost(outcome):.4g} in run {best}"
            write_picture(folder / "sweep", title, note, cost_chart(drawn))
        part.write_text(page_text(outcome, drawn), encoding="utf-8")
        part.replace(folder / PAGE)
    except OSError as error:
        raise InputError(f"cannot write {folder}: {error.strerror or error}") from None
    finally:
        part.unlink(missing_ok=True)
    return folder / PAGE


def page_text(outcome: "Outcome", drawn: "Outcome | None" = None) -> str:
    """The page of a study, and of its rows that are drawn: HTML that needs no network."""
    page, study = Page(), outcome.study
    page.sections.append(_cards(outcome))
    if np.isfinite(outcome.cost).any():
        drawn = drawn or drawn_rows(outcome)
        words = [WORDS[kind(drawn)]]
        if (shown := len(drawn.rows)) < (runs := len(outcome.rows)):
            words.append(f"{shown} of {runs} runs are drawn, the best one among them.")
        content = page.place("cost", cost_chart(drawn)) + picture_links("sweep")
        words.append(_told_best(outcome))
        page.section(escape(cost_label(outcome)), " ".join(words), content)
        if outcome.best is not None:
            note = "Smallest cost first; checks: those of the scenario."
            page.section("Best runs", note, table(*best_rows(outcome), numeric=2))
    if outcome.errors:
        page.section("Errors", "Runs that gave no row, by message.", _told(outcome.counts.wrong))
    if outcome.counts.missing.first:
        note = "Runs with an empty cell, by the reason."
        page.section("Missing numbers", note, _told(outcome.counts.missing))
    page.section("What was varied", "", _varied(outcome))
    footer = f"{escape(study.sampling)} of {len(study.points)} runs"
    footer += "" if study.sampling == "grid" else f", seed {study.seed}"
    footer += "; every row is in sweep.parquet."
    return page.text(PageFrame(study.name, study.about, "sweep", (), footer))


def _told_best(outcome: "Outcome") -> str:
    """Say at which ends of the study the best run lies, or that no cost was named."""
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
    shown = [("Runs", str(len(rows)), f"{outcome.errors} with an error")]
    if outcome.counts.judged:
        shown.append(("Checks hold", str(outcome.counts.held), f"of {len(rows)} runs"))
    if best is not None:
        point = zip(study.axes, study.points[best], strict=True)
        where = ", ".join(f"{a.name} = {_number(v)} {spelled(a.unit)}".strip() for a, v in point)
        shown.append((f"Smallest {cost_label(outcome)}", f"{least_cost(outcome):.4g}", where))
    return cards(shown)


def best_rows(outcome: "Outcome") -> tuple[list[str], list[list[str]]]:
    """Heads and rows of the table of the best runs, as HTML."""
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
    return ["Run", "Checks", *map(escape, units)], body


def _told(messages: "Told") -> str:
    """A table of messages, the most frequent first."""
    body: list[tuple[str, str, str]] = [
        (escape(text), str(n), str(messages.first[text]))
        for text, n in messages.times.most_common(ERRORS_SHOWN)
    ]
    if more := len(messages.times) - len(body):
        body.append((f"{more} more messages", "", ""))
    if messages.others:
        body.append(("Other messages", str(messages.others), ""))
    return table(("Message", "Runs", "First run"), body)


def _varied(outcome: "Outcome") -> str:
    body = []
    for i, axis in enumerate(outcome.study.axes):
        different = outcome.study.points.different(i)
        if axis.end.port.type in ("Float64", "Int32"):
            ends = f"{different[0]:g} … {different[-1]:g}"
        else:
            ends = escape(", ".join(map(str, different)))
        body.append((escape(label(axis.name, axis.unit)), str(len(different)), ends))
    return table(("Variable", "Different values", "Range"), body)
