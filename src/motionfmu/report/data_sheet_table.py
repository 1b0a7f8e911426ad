"""The figures of a data sheet as a short table in Markdown, for a machine's README."""

from collections.abc import Sequence

from motionfmu.analysis.data_sheet import AxisSheet, DataSheet
from motionfmu.analysis.data_sheet.sheet_loops import POSITION, VELOCITY, LoopSheet
from motionfmu.report.data_sheet_page import gain_words, milliseconds, percent, phase_words
from motionfmu.report.numbers import figure, length

SHOWN = ("A", "R", "E", "B")


def markdown(sheet: DataSheet) -> str:
    """The table: a column for each axis, and lines for what is not an axis'."""
    names = [a.axis.name for a in sheet.axes]
    rows = [("", *names), ("---",) * (len(names) + 1)]
    if any(a.positioning for a in sheet.axes):
        rows.append((f"ISO 230-2: {', '.join(SHOWN)}; unrest", *(_position(a) for a in sheet.axes)))
    for kind in (POSITION, VELOCITY):
        own = [next((x for x in a.loops if x.kind == kind), None) for a in sheet.axes]
        if any(own):
            rows.append((f"{kind} loop: gain and phase margin", *map(_margins, own)))
            rows.append(("its step: rise, overshoot, settling", *map(_step, own)))
    text = [f"| {' | '.join(row)} |" for row in rows] if len(rows) > 2 else []
    lines = _more(sheet)
    if text and lines:
        text.append("")
    return "\n".join([*text, *lines, ""])


def _position(a: AxisSheet) -> str:
    if a.positioning is None:
        return ""
    factor, unit = a.axis.fine
    found = a.positioning.figures()
    sizes = ", ".join(figure(factor * found[n]) for n in SHOWN)
    return f"{sizes}; {figure(factor * (a.unrest or 0.0))} {unit}"


def _margins(loop: LoopSheet | None) -> str:
    return "" if loop is None else f"{gain_words(loop.margins)}, {phase_words(loop.margins)}"


def _step(loop: LoopSheet | None) -> str:
    if loop is None:
        return ""
    s = loop.step
    return f"{milliseconds(s.rise)}, {percent(s.overshoot)}, {milliseconds(s.settling)}"


def _more(sheet: DataSheet) -> Sequence[str]:
    """A line for each circle, and for a robot."""
    lines = [
        f"- ISO 230-4, circle of R {c.radius:g} mm in {name} at {figure(c.ccw.speed)} mm/s:"
        f" G(b) {length(c.both.g)}, D {length(c.both.d_nominal, sign=True)}"
        for name, c in sheet.circles.items()
        if c.both is not None and c.ccw is not None
    ]
    if sheet.robot is not None:
        found = sheet.robot.found.numbers()
        lines.append(
            f"- ISO 9283, the worst of five poses: AP {length(sheet.robot.ap)},"
            f" RP {length(sheet.robot.rp)}; a line: AT {length(found['AT_P'])},"
            f" RT {length(found['RT_P'])}"
        )
    return lines
