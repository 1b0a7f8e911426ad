"""The record of a scenario over its run, as a section of the page."""

from collections.abc import Mapping
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionfmu.base.units import spelled
from motionfmu.report.diagram import SOLID, Diagram
from motionfmu.report.html_page import RUN, Page
from motionfmu.report.html_tables import table
from motionfmu.report.numbers import MINUS, NOTHING, figure, label, text_of
from motionfmu.report.signal_chart import recolored, signal_chart
from motionfmu.report.style import AXES
from motionfmu.run.figures import Chart, Curve, Panel
from motionfmu.run.record_matches import RecordMatches

if TYPE_CHECKING:
    from motionfmu.records import Match, Record

DRAWN = 12  # signals; all are in the table
NOTE = (
    "NRMSE: norm of the difference over the norm of the record; of its motion: over that of the"
    " record less its mean. Lag: how much later the signal comes than the record, by the largest"
    " correlation; it is in all other numbers."
)
RED = "#5a0f45"


def heads(first: str, second: str) -> tuple[str, ...]:
    """Heads of a table of matches."""
    gone = f"largest {first} {MINUS} {second}"
    return (*_FIRST, gone, "at", "RMS", "mean", "NRMSE", "of its motion", "lag")


_FIRST = ("Signal", "Column")


def add_record(page: Page, found: RecordMatches) -> None:
    """Add the numbers of every signal under the record, and curves of the first ones."""
    rows = [row(name, over.column, over.unit, one) for name, (over, one) in found.found.items()]
    whys = dict.fromkeys(
        f"{name}: no lag, {one.lag.reason}"
        for name, (_, one) in found.found.items()
        if one.lag.reason
    )
    told = "".join(f'<p class="note">{escape(w)}.</p>' for w in (*whys, *found.record.notes))
    note = f"{escape(about(found.record))} {NOTE}"
    page.section("Record over run", note, table(heads("run", "record"), rows, 2) + told)
    for i, (name, (over, one)) in enumerate(list(found.found.items())[:DRAWN]):
        drawn = chart(name, over.unit, one, ("run", "record"))
        page.section(
            f"<code>{escape(name)}</code>, {escape(over.column)}",
            "",
            page.place(f"record{i}", drawn, True, RUN),
        )


def about(record: "Record") -> str:
    """A record in a sentence."""
    rate = record.rate
    even = f"{figure(rate)} Hz" if rate else "uneven samples"
    span = f"{record.time[0]:.9g} to {record.time[-1]:.9g} s"
    return f"{Path(record.name).name}: {len(record.ns)} samples, {even}, {span}."


def row(name: str, column: str, unit: str, one: "Match") -> tuple[str, ...]:
    """The numbers of a match as a row of a table."""
    found: Mapping[str, Any] = one.numbers()
    own = spelled(unit)
    percent = [NOTHING if (x := found[k]) is None else f"{100 * x:.3g} %" for k in _SHARES]
    return (
        escape(name),
        escape(column),
        text_of(found["max"], own, sign=True),
        f"{found['at']:.6g} s",
        text_of(found["rms"], own),
        text_of(found["mean"], own, sign=True),
        *percent,
        lag_text(found["lag"]),
    )


_SHARES = ("nrmse", "nrmse_centred")


def lag_text(lag: float | None) -> str:
    """A lag with its unit [s]; a dash if there is none."""
    if lag is None:
        return NOTHING
    return f"{1e3 * lag:+.4g} ms".replace("-", MINUS)


def chart(name: str, unit: str, one: "Match", names: tuple[str, str]) -> Diagram:
    """A signal and its record, and below them their difference."""
    both = (one.signal, one.record)
    curves = [Curve(n, one.time, x, False) for n, x in zip(names, both, strict=True)]
    gone = Curve("", one.time, one.difference, False)
    short = name.rpartition(".")[2]
    panels = (
        Panel(label(short, unit), tuple(curves), {}, True),
        Panel(label(f"{names[0]} {MINUS} {names[1]}", unit), (gone,), {}, False),
    )
    span = (float(one.time[0]), float(one.time[-1]))
    looks = [(AXES[0], SOLID), (AXES[1], SOLID), (RED, SOLID)]
    return recolored(signal_chart(Chart(name, "", span, True, panels)), looks)
