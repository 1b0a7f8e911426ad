"""A comparison in a few lines, and what a notebook shows of it."""

from html import escape

from motionfmu.base.units import spelled
from motionfmu.compare import plots
from motionfmu.compare.number_pairs import Number
from motionfmu.compare.pairing import Pairing
from motionfmu.compare.words import GONE, change_text, row_of
from motionfmu.report.numbers import text_of

LARGEST = (("error.max", "largest contour error"), ("error.rms", "RMS contour error"))
_LINES, _ROWS = 4, 12  # signals that differ: in the text, in the table of a notebook
_INCHES = 7.5  # width of a picture as it is drawn


def apart_lines(found: Pairing, most: int) -> list[str]:
    """A line for each of the signals that differ most."""
    return [
        f"{s.element}: {text_of(s.largest, spelled(s.unit), sign=True)} at {s.at:.6g} s"
        for s in found.apart[:most]
    ]


def count_line(found: Pairing) -> str:
    """How many signals differ, are the same, are not compared."""
    n = len(found.apart)
    same = len(found.signals) - n
    return f"{n} signals differ ({GONE}), {same} are the same, {len(found.left)} not compared"


def verdict_line(found: Pairing) -> str:
    """Whether B is worse, and in what."""
    return "no verdict is worse" if found.ok else f"FAILED in B: {', '.join(found.worse)}"


def comparison_text(found: Pairing) -> str:
    """A comparison as it is told at the prompt."""
    lines = [f"A: {found.a.name}", f"B: {found.b.name}"]
    lines += [f"{d.what}: {d.a} → {d.b}" for d in found.different]
    for what, n in _errors(found):
        told = f"{text_of(n.a, 'mm')} → {text_of(n.b, 'mm')} {change_text(n)}"
        lines.append(f"{what}: {told.strip()}")
    lines += [*apart_lines(found, _LINES), count_line(found), verdict_line(found)]
    return "Comparison\n" + "\n".join(f"  {t}" for t in lines)


def _errors(found: Pairing) -> list[tuple[str, Number]]:
    known = {n.name: n for n in found.table("contour")}
    return [(words, known[name]) for name, words in LARGEST if name in known]


def comparison_html(found: Pairing) -> str:
    """What was run differently, errors, signals, and both paths or the signal most apart."""
    # They draw, which needs an extra.
    from motionfmu.report.matplotlib_figure import picture
    from motionfmu.report.notebook_view import (
        PATH_INCHES,
        PATH_WIDTH,
        beside,
        cells,
        images,
        view,
    )

    mark = "ok" if found.ok else "failed"
    head = (
        f"<b>{escape(found.a.name)}</b> and <b>{escape(found.b.name)}</b>"
        f' <span class="{mark}">{escape(verdict_line(found))}</span>'
    )
    left = ""
    if found.different:
        rows = [tuple(map(escape, (d.what, d.a, d.b))) for d in found.different]
        left += cells(("Run differently", "A", "B"), rows)
    if errors := [row_of(escape(words), n, "mm") for words, n in _errors(found)]:
        left += cells(("", "A", "B", GONE, "Change"), errors, (1, 2, 3, 4))
    signals = [
        (escape(s.element), text_of(s.largest, spelled(s.unit), sign=True), f"{s.at:.6g} s")
        for s in found.apart[:_ROWS]
    ]
    if signals:
        left += cells(("Signal", f"Largest {GONE}", "At"), signals, (1, 2))
    left += f'<p class="sub">{escape(count_line(found))}</p>'
    shown = ""
    if found.a.track and found.b.track:
        diagram, factor = plots.path_figure(found.a, found.b)
        title = f"Contour errors {factor:,.0f} times as large"
        shown = images(picture(title, "", diagram, width=PATH_INCHES), title, PATH_WIDTH)
    elif found.apart:
        name = found.apart[0].name
        shown = images(picture(name, "", plots.signal_figure(found, name), width=_INCHES), name)
    return view(head, beside(left, shown))
