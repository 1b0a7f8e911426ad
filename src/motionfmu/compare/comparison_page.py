"""The page of a comparison."""

from collections.abc import Iterable, Sequence
from html import escape
from itertools import groupby
from pathlib import Path
from typing import Any

from motionfmu.analysis.iso9283.evaluation import unit as unit_of_iso9283
from motionfmu.base.units import spelled
from motionfmu.compare import plots
from motionfmu.compare.differences import Checked, port_of
from motionfmu.compare.number_pairs import Number
from motionfmu.compare.pairing import Apart, Pairing
from motionfmu.compare.words import GONE, change_text, row_of, signed
from motionfmu.report import result_folder
from motionfmu.report.contour_words import CIRCLE, CONTOUR, in_words
from motionfmu.report.html_page import Page, PageFrame
from motionfmu.report.html_tables import cards, judged, table
from motionfmu.report.numbers import NOTHING, figure, length, text_of
from motionfmu.run.checks import parts, tally, together

ELEMENTS = 40  # of signals are drawn; all are in the table
SIDES = ("", "A", "B", GONE, "change of size")
FOOTER = (
    f"Every difference is {GONE}. RMS of a difference: root of the mean square over the common"
    ' samples and all elements. Every number is in <a href="result.json">result.json</a>.'
)


def write_comparison(found: Pairing, folder: Path) -> Path:
    """Write the page and result.json, whole or not at all."""
    with result_folder.whole(folder) as part:
        result_folder.write_result(part, page_text(found), found.numbers(), str)
    return folder.resolve() / result_folder.PAGE


def page_text(found: Pairing) -> str:
    """The whole HTML page of a comparison."""
    page = Page()
    page.sections.append(_cards(found))
    _add_different(page, found)
    if found.checks:
        note = "A check that held in A and fails in B stands first."
        page.section("Verdicts", note, _checks(found))
    if found.a.track and found.b.track:
        _add_contour(page, found)
    elif found.table("contour"):
        page.section("Contour error", "", _numbers(found, "contour", CONTOUR))
    rows = found.table("iso9283")
    if rows:
        page.section("Path performance, ISO 9283", "", table(SIDES, map(_performance, rows)))
    _add_figures(page, found)
    _add_signals(page, found)
    about = f"A: {found.a.name} · B: {found.b.name}"
    names = dict.fromkeys(x.numbers["scenario"] for x in (found.a, found.b))
    frame = PageFrame(" and ".join(names), about, "comparison", (), FOOTER)
    return page.text(frame)


# CCN 16: a row of cards, each of which is left out or worded by what the runs have.
def _cards(found: Pairing) -> str:
    shown = []
    for name, x in (("Run A", found.a), ("Run B", found.b)):
        judged = tally(c["ok"] for c in x.numbers["checks"])
        kind = "fail" if judged.failed else "pass" if judged.judged else ""
        value = f'<span class="{kind}">{judged.words}</span>'
        shown.append((name, value, escape(x.name)))
    verdict = "no check is worse" if found.ok else f"{len(found.worse)} worse"
    kind, where = ("pass", "") if found.ok else ("fail", escape(", ".join(found.worse)))
    where = where.replace(".", ".<wbr>")
    shown.append(("Verdict of B against A", f'<span class="{kind}">{verdict}</span>', where))
    numbers = {n.name: n for n in found.table("contour")}
    for name, words in (("error.max", "Largest contour error"), ("error.rms", "RMS contour error")):
        n = numbers.get(name)
        if n is not None and n.a is not None and n.b is not None:
            where = f"{length(n.a)} → {length(n.b)}"
            shown.append((words, change_text(n) or signed(n), where))
    done = Number("", *(x.numbers.get("done_at") for x in (found.a, found.b)))
    if done.difference is not None:
        where = f"{done.a:.9g} s → {done.b:.9g} s"
        gone = f"{figure(done.difference, sign=True)} s" if done.difference else "no change"
        shown.append(("Program done", gone, where))
    return cards(shown)


def _add_different(page: Page, found: Pairing) -> None:
    rows = [tuple(map(escape, (d.what, d.a, d.b))) for d in found.different]
    content = table(("", "A", "B"), rows, 3) if rows else "<p>Nothing: both were made alike.</p>"
    page.section("What was run differently", "", content)


_MARKS = {True: ("✓", "pass"), False: ("✗", "fail"), None: (NOTHING, "")}


def _unit_of(found: Pairing, name: str) -> str:
    """Unit of what is checked, as on all pages."""
    if name.startswith("contour."):
        return spelled(in_words(name.partition(".")[2])[1])
    port = port_of(found.a, name.partition("[")[0]) or port_of(found.b, name.partition("[")[0])
    return spelled(port.unit) if port else ""


def _checks(found: Pairing) -> str:
    rows = []
    inorder = sorted(found.checks, key=lambda c: (not c.worse, c.ok[1] is not False))
    for _, group in groupby(inorder, _number):
        same = list(group)
        c, unit = same[0], _unit_of(found, same[0].name)
        sides = [_side(same, k, unit) for k in (0, 1)]
        told = "; ".join(dict.fromkeys(r for r in c.reasons if r))
        words = " → ".join(dict.fromkeys(text for _, text in sides if text))
        words += f"; {told}" if told else ""
        change = change_text(Number(c.name, *c.values))
        rows.append((escape(c.name), escape(words), *(cell for cell, _ in sides), change))
    return table(("Check", "Bounds", "A", "B", "change of size"), rows, 2)


def _number(c: Checked) -> tuple[Any, ...]:
    """What rows have in common that bound one number of each run, by both sides."""
    return c.name, c.ok, str(c.values), c.reasons, [parts(b or "")[2] for b in c.bounds]


def _side(same: Sequence[Checked], run: int, unit: str) -> tuple[str, str]:
    """Mark and value of a run, and its bounds in words; those may be empty."""
    mark, kind = _MARKS[same[0].ok[run]]
    value = same[0].values[run]
    told = [judged(value, asked, unit) for c in same if (asked := c.bounds[run]) is not None]
    text = NOTHING if value is None else told[0][0]
    words = together([asked for _, asked in told]) if told else ""
    return f'<span class="mark {kind}">{mark}</span> {text}', words


def _beside(plot: str, numbers: str) -> str:
    """A plot and a table of five columns."""
    return f'<div class="wide" style="--beside: 575px"><div>{plot}</div><div>{numbers}</div></div>'


def _add_contour(page: Page, found: Pairing) -> None:
    drawn, factor = plots.path_figure(found.a, found.b)
    note = f"Both errors are drawn <b>{factor:,.0f} times</b> as large as they are."
    left = page.place("path", drawn)
    right = f"<h3>Errors</h3>{_numbers(found, 'contour', CONTOUR)}"
    page.section("Path and contour error", note, _beside(left, right))
    if plots.same_path(found.a, found.b):
        drawn, largest = plots.error_figure(found.a, found.b)
        note = (
            f"Over the way along the path, where both cut; they differ by up to {length(largest)}."
        )
        page.section(
            "Contour error along the path", note, page.place("along", drawn, False, "along")
        )
    else:
        page.section("Contour error along the path", "The two paths are not the same.", "")
    places = {n.split(".")[1] for n in (*found.a.track, *found.b.track) if n.startswith("circles.")}
    for place in sorted(map(int, places)):
        round_ = plots.circle_figure(found, place)
        if round_ is None:
            continue
        radius = found.a.numbers["contour"]["circles"][place]["radius"]
        rows = _numbers(found, "contour", [(f"circles.{place}.{n}", w, u) for n, w, u in CIRCLE])
        plot = page.place(f"circle{place}", round_)
        note = "ISO 230-4. Radial deviation from the nominal circle about its nominal centre."
        page.section(f"Circular test, radius {radius:g} mm", note, _beside(plot, rows))


def _numbers(found: Pairing, name: str, wanted: Iterable[tuple[str, str, str]]) -> str:
    known = {n.name: n for n in found.table(name)}
    return table(SIDES, [row_of(w, known[n], u) for n, w, u in wanted if n in known])


def _performance(n: Number) -> tuple[str, ...]:
    return row_of(escape(n.name), n, spelled(unit_of_iso9283(n.name.rpartition(".")[2])))


def _add_figures(page: Page, found: Pairing) -> None:
    asked = {f["title"]: f for f in (*found.b.numbers["figures"], *found.a.numbers["figures"])}
    for i, one in enumerate(asked.values()):
        if (drawn := plots.figure_of(found, one)) is not None:
            whole = one["window"] is None
            page.section(escape(one["title"]), "", page.place(f"figure{i}", drawn, whole, "run"))


def _add_signals(page: Page, found: Pairing) -> None:
    apart = [s for s in found.signals if not s.same]
    same = [s.name for s in found.signals if s.same]
    time = found.common.time
    notes = [
        f"{len(time)} common samples from {time[0]:.9g} to {time[-1]:.9g} s",
        *found.common.words,
    ]
    notes = [escape(n[0].upper() + n[1:] + ".") for n in notes]
    content = table(
        ("Signal", f"largest {GONE}", "in", "at", f"RMS of {GONE}", "range of A"),
        map(_apart, apart),
    )
    if not apart:
        content = "<p>Every signal is the same in both, sample by sample.</p>"
    elif same:
        listed = ", ".join(map(escape, same))
        content += f'<p class="note">The same in both, sample by sample: {listed}.</p>'
    if found.left:
        listed = "; ".join(escape(f"{name}: {why}") for name, why in found.left.items())
        content += f'<p class="note">Not compared: {listed}.</p>'
    page.section("Signals", " ".join(notes), content)
    left, hidden = ELEMENTS, []
    for i, s in enumerate(apart):
        left -= len(found[s.name].differing)
        if left < 0:
            hidden.append(s.name)
            continue
        port = port_of(found.a, s.name)
        words = f"{escape(port.doc.partition(';')[0])} " if port and port.doc else ""
        title = f"{words}<code>{escape(s.name)}</code>"
        page.section(title, "", page.place(f"signal{i}", plots.signal_figure(found, s.name), True))
    if hidden:
        listed = ", ".join(map(escape, hidden))
        told = f"{listed}. Choose with <code>--signals</code>."
        page.section("Signals that differ and are not drawn", told, "")


def _apart(s: Apart) -> tuple[str, ...]:
    unit = spelled(s.unit)
    largest = text_of(s.largest, unit, sign=True)
    rms, span = (text_of(x, unit) for x in (s.rms, s.span))
    return (escape(s.name), largest, escape(s.element), f"{s.at:.9g} s", rms, span)
