"""A measured tool against its program, or a ballbar's record, as one HTML page."""

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any

from motionfmu.analysis.contour import ContourResult
from motionfmu.analysis.contour.circles import CircularTest
from motionfmu.analysis.explain.ballbar import Signature, signature
from motionfmu.records import Record
from motionfmu.report.cause_pages.explain_page import add_circle
from motionfmu.report.error_path import draw
from motionfmu.report.html_page import Page, PageFrame
from motionfmu.report.html_tables import RMS, circle_table, folded, line_table, table
from motionfmu.report.numbers import NOTHING, figure, length
from motionfmu.report.path_chart import outlier_words, path_chart
from motionfmu.report.polar_chart import polar_chart
from motionfmu.report.record_section import about
from motionfmu.report.time_charts import error_chart

PAGE, NUMBERS = "report.html", "result.json"
FOOTER = (
    "The contour error is the distance of the measured position from the nearest point of the exact"
    " programmed geometry, on the part of the path that is being cut. A record does not tell which"
    " command it is at: samples are assigned by how far the tool has travelled, always forward."
    ' Every number is in <a href="result.json">result.json</a>.'
)
# Numbers of a contour that a record does not have.
_OF_A_RUN = ("command_error", "following", "lag", "window")


@dataclass(frozen=True)
class ContourRecord:
    """A measured contour beside that of a run of the same program."""

    name: str  # of the scenario
    record: Record
    run: ContourResult
    measured: ContourResult

    @property
    def signatures(self) -> list[Signature]:
        """What a ballbar would say of each circle that the record has both ways round."""
        both = (c for c in self.measured.circles if c.ccw and c.cw)
        return [signature(c) for c in both]

    def numbers(self) -> dict[str, Any]:
        """The numbers, ready for JSON."""
        own = {k: v for k, v in self.measured.numbers().items() if k not in _OF_A_RUN}
        marks = [s.numbers() for s in self.signatures]
        run = self.run.numbers()
        return {
            "scenario": self.name,
            "record": self.record.name,
            "notes": list(self.record.notes),
            "contour": own,
            "ballbar": marks,
            "run": {k: run[k] for k in ("error", "circles", "corners")},
        }


def write_record_contour(found: ContourRecord, folder: Path) -> Path:
    """Write report.html and result.json."""
    text = json.dumps(found.numbers(), indent=1, default=str)
    (folder / NUMBERS).write_text(text + "\n", encoding="utf-8")
    (folder / PAGE).write_text(_page(found), encoding="utf-8")
    return folder / PAGE


def _page(found: ContourRecord) -> str:
    page = Page()
    drawing = draw(found.measured)
    note = (
        f"{escape(about(found.record))} The error is drawn {drawing.magnify:,.0f} times as large as"
        f" it is. {outlier_words(drawing)}"
    )
    left = page.place("path", path_chart(drawing))
    right = f"<h3>Errors</h3>{_errors(found)}<h3>Worst lines</h3>{line_table(found.measured)}"
    told = "".join(f'<p class="note">{escape(n)}.</p>' for n in found.record.notes)
    content = f'<div class="wide"><div>{left}</div><div>{right}{told}</div></div>'
    page.section("Path and contour error of the record", note, content)
    marks = {mark.test.place: mark for mark in found.signatures}
    for i, test in enumerate(found.measured.circles):
        if test.place in marks:
            add_circle(page, f"circle{i}", marks[test.place])
        else:
            plot = page.place(f"circle{i}", polar_chart(test))
            content = f'<div class="two">{plot}<div>{circle_table(test)}</div></div>'
            page.section(f"Circular test, radius {test.radius:g} mm", "ISO 230-4.", content)
    drawn = page.place("error", error_chart(found.measured), True)
    page.section("Contour error over time", "Where the tool is cutting.", drawn)
    pairs = corner_pairs(found.run, found.measured)
    if pairs:
        ranked = sorted(pairs, key=lambda p: -p[1].error)
        page.section("Corners", "", folded(_corner_rows, ranked))
    frame = PageFrame(found.name, found.record.name, "contour of a record", (), FOOTER)
    return page.text(frame)


def _errors(found: ContourRecord) -> str:
    heads = ("", "Record", "Run")
    rows = []
    for words, key in (("Largest", "max"), ("RMS", "rms"), ("Median", "p50"), ("95 %", "p95")):
        sizes = (getattr(x.error, key) for x in (found.measured, found.run))
        rows.append((words, *map(length, sizes)))
    for own in found.measured.circles:
        other = next((c for c in found.run.circles if c.place == own.place), None)
        for words, get in CIRCLE_ROWS:
            shown = [
                NOTHING if c is None or (v := get(c)) is None else length(v, sign=True)
                for c in (own, other)
            ]
            if shown[0] != NOTHING:
                rows.append((f"R {own.radius:g} mm, {words}", *shown))
    return table(heads, rows) + f'<p class="note">RMS, median and 95 % are {RMS}.</p>'


def _shown(value: float | None) -> str:
    return NOTHING if value is None else length(value, sign=True)


def _way(name: str, key: str) -> Any:
    def get(test: CircularTest) -> float | None:
        way = getattr(test, name)
        return None if way is None else float(getattr(way.reading, key))

    return get


CIRCLE_ROWS = tuple(
    (f"{words} {name}", _way(name, key))
    for name in ("ccw", "cw")
    for words, key in (("G", "g"), ("F max", "f_max"), ("F min", "f_min"))
)


def corner_pairs(run: ContourResult, measured: ContourResult) -> list[tuple[Any, Any]]:
    """Each corner of a record with the run's, which may be None."""
    key = {(c.line_before, c.line_after, c.point): c for c in run.corners}
    return [(key.get((c.line_before, c.line_after, c.point)), c) for c in measured.corners]


def _corner_rows(pairs: Sequence[tuple[Any, Any]]) -> str:
    rows = [
        (
            f"{own.line_before} → {own.line_after}",
            ", ".join(figure(v) for v in own.point),
            f"{math.degrees(own.angle):.1f}°",
            f"{figure(own.speed)} mm/s",
            length(own.error),
            NOTHING if run is None else length(run.error),
        )
        for run, own in pairs
    ]
    heads = ("Lines", "At X, Y, Z [mm]", "Turn", "Least feed", "Error of the record", "of the run")
    return table(heads, rows, 2)


def write_ballbar(
    test: CircularTest, mark: Signature | None, records: Sequence[Record], folder: Path
) -> Path:
    """Write the page and the numbers of a ballbar's record; without both ways no diagnosis."""
    page = Page()
    notes = "<br>".join(escape(about(r)) for r in records)
    if mark is not None:
        add_circle(page, "circle", mark)
    else:
        plot = page.place("circle", polar_chart(test))
        note = "One way round: the diagnosis needs both."
        content = f'<div class="two">{plot}<div>{circle_table(test)}</div></div>'
        page.section(f"Circular test, radius {test.radius:g} mm", note, content)
    page.section("Records", "", f"<p>{notes}</p>")
    found: dict[str, Any] = {"records": [r.name for r in records], "circle": test.numbers()}
    found["ballbar"] = None if mark is None else mark.numbers()
    text = json.dumps(found, indent=1, default=str)
    (folder / NUMBERS).write_text(text + "\n", encoding="utf-8")
    name = Path(records[0].name).stem
    footer = 'Every number is in <a href="result.json">result.json</a>.'
    frame = PageFrame(name, records[0].name, "ballbar", (), footer)
    (folder / PAGE).write_text(page.text(frame), encoding="utf-8")
    return folder / PAGE
