"""The tables, cards and lists of the page."""

import math
import re
from collections.abc import Callable, Iterable, Sequence
from html import escape
from typing import Any

import numpy as np

from motionfmu.analysis.contour import ContourResult
from motionfmu.analysis.contour.circles import CirclePass, CircularTest
from motionfmu.analysis.contour.kinds import Corner
from motionfmu.base.axis_names import AXIS_NAMES, ControllerAxis
from motionfmu.report.numbers import MINUS, figure, length
from motionfmu.report.numbers import unit as length_unit
from motionfmu.run.checks import Verdict, beyond, of_one_number, parts, together

# The words on every page for the time over which the RMS of a contour error is taken.
RMS = "over time where the tool cuts"
# Rows of a table with the rest folded, and rows of that.
SHOWN, FOLDED = 10, 1000
LINES_SHOWN = 10
# A value of a card with more letters than LONG is written small.
LONG, SMALL = 13, ' style="font-size:17px"'
# A column with more letters than this may break its text into lines.
WIDE = 26
_NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")  # of a bound
_DASH = re.compile(r"(?<![\w.>-])-(?=\d)|^-(?=\d)")  # before a number a minus


def table(heads: Sequence[str], rows: Iterable[Sequence[str]], numeric: int = 1) -> str:
    """A table of ready HTML cells; numbers stand to the right."""
    # Columns from `numeric` on are numbers.

    listed = [tuple(row) for row in rows]
    wide = [_width(column) > WIDE for column in zip(*listed, strict=True)]
    texts = ["key wide" if w else "key" for w in wide] or ["key"] * len(heads)

    def cells(tag: str, row: Sequence[str]) -> str:
        kinds = [texts[i] if i < numeric else "n" for i in range(len(row))]
        shown = [c if i < numeric else _DASH.sub(MINUS, c) for i, c in enumerate(row)]
        return "".join(f'<{tag} class="{k}">{c}</{tag}>' for k, c in zip(kinds, shown, strict=True))

    body = "".join(f"<tr>{cells('td', row)}</tr>" for row in listed)
    return (
        f'<div class="scroll"><table><thead><tr>{cells("th", heads)}</tr></thead>'
        f"<tbody>{body}</tbody></table></div>"
    )


def facts(rows: Iterable[tuple[str, str]]) -> str:
    """A table without a head: names, and ready HTML beside them."""
    body = "".join(f"<tr><th>{escape(name)}</th><td>{text}</td></tr>" for name, text in rows)
    return f'<table class="facts"><tbody>{body}</tbody></table>'


def overrides(told: Iterable[str]) -> str:
    """A line for each value that was run otherwise than the scenario is written."""
    return facts([("Overrides", "<br>".join(map(escape, told)))])


def _width(column: Sequence[str]) -> int:
    """Letters of the longest line in a column of cells."""
    lines = (re.sub("<[^>]*>", "", part) for cell in column for part in re.split("<br>|<div", cell))
    return max(map(len, lines), default=0)


def cards(rows: Iterable[tuple[str, str, str]], columns: str = "") -> str:
    """Cards with large numbers: title as plain text, value and place as HTML."""
    # Columns are those of the grid in CSS, else the page's own; a long value is written small.
    shown = (
        f'<div class="card"><div class="what">{escape(what)}</div>'
        f'<div class="value"{SMALL if len(value) > LONG else ""}>{value}</div>'
        f'<div class="where">{where}</div></div>'
        for what, value, where in rows
    )
    style = f' style="grid-template-columns:{columns}"' if columns else ""
    return f'<div class="cards"{style}>{"".join(shown)}</div>'


def picture_links(name: str) -> str:
    """Links to a picture beside the page, as PNG and SVG."""
    links = (f'<a href="{name}.{e}">{name}.{e}</a>' for e in ("png", "svg"))
    return f'<p class="files">{" ".join(links)}</p>'


def picture_buttons(name: str) -> str:
    """Buttons that save a plot of the page as a picture."""
    made = (
        f'<button type="button" data-save="{name}.{e}">{e.upper()}</button>' for e in ("png", "svg")
    )
    return f'<p class="files save">Save as {" ".join(made)}</p>'


def warning_list(warnings: Sequence[str]) -> str:
    """The warnings of FMUs and of the runner, as a list."""
    return f"<ul>{''.join(f'<li>{escape(told)}</li>' for told in warnings)}</ul>"


def check_table(checks: Sequence[Verdict], words: Callable[[Verdict], tuple[str, str]]) -> str:
    """Verdicts of the scenario, failures first; `words` say what is checked, and its unit.

    The least and the largest that one number may be are one row. What is not judged has none.
    """
    rows = []
    given = [c for c in checks if c.ok is not None]
    for same in of_one_number(sorted(given, key=lambda c: bool(c.ok))):
        check = same[0]
        mark, kind = ("✓ pass", "pass") if check.ok else ("✗ fail", "fail")
        said, unit = words(check)
        told = [judged(c.value, c.bounds, unit) for c in same]
        text, bounds = told[0][0], together([b for _, b in told])
        text = "none" if check.reason else text
        below = (t for t in (said, check.reason) if t)
        sub = "".join(f'<div class="sub">{escape(t)}</div>' for t in below)
        rows.append(
            (
                f'<span class="mark {kind}">{mark}</span>',
                f"{escape(check.name)}{sub}",
                escape(text),
                escape(bounds),
            )
        )
    return table(("Verdict", "Check", "Value", "Bounds"), rows, numeric=4)


def expected_table(checks: Sequence[Verdict], words: Callable[[Verdict], tuple[str, str]]) -> str:
    """What the scenario as written is expected to give and this run gave, with the difference."""
    rows = []
    for same in of_one_number([c for c in checks if c.ok is None]):
        check, apart = same[0], beyond(same)
        said, unit = words(check)
        told = [judged(c.value, c.bounds, unit) for c in same]
        below = (t for t in (said, check.reason) if t)
        sub = "".join(f'<div class="sub">{escape(t)}</div>' for t in below)
        gap = "as expected" if apart == 0.0 else "not as expected"
        if apart and math.isfinite(apart):
            size = judged(abs(apart), check.bounds, unit)[0]
            gap = f"{'+' if apart > 0.0 else MINUS}{size}"
        cells = together([b for _, b in told]), "none" if check.reason else told[0][0], gap
        rows.append((f"{escape(check.name)}{sub}", *map(escape, cells)))
    return table(("Figure", "Expected", "Got", "Difference"), rows)


def judged(value: Any, bounds: str, unit: str) -> tuple[str, str]:
    """Value and bounds of a verdict with their unit; lengths below a mm in µm, as on the cards."""
    words, asked, where = parts(bounds)
    plain = words.startswith(("changes", "order", "rate"))
    limits = [float(n) for n in _NUMBER.findall(asked)]
    factor = 1.0
    if unit == "mm" and not plain:
        sizes = [abs(x) for x in (*limits, value) if isinstance(x, float) and math.isfinite(x)]
        factor, unit = length_unit(max(sizes, default=0.0))
        asked = _NUMBER.sub(lambda m: f"{float(m[0]) * factor:.6g}", asked)
    if unit and not plain and limits:
        asked = f"{asked} {unit}"
    bounds = f"{words}{_DASH.sub(MINUS, asked)}{where}"
    if not isinstance(value, float):
        return str(value), bounds
    text = f"{value * factor:.6g}".replace("-", MINUS)
    return f"{text} {unit}" if unit and not words.startswith(("changes", "rate")) else text, bounds


def error_table(contour: ContourResult, axes: Sequence[ControllerAxis]) -> str:
    """Maximum, RMS and percentiles of the errors."""
    rows = []
    for name, size in (("Contour error", contour.error), ("Command error", contour.command_error)):
        shown = (size.max, size.rms, size.p50, size.p95)
        rows.append((name, *(length(v) for v in shown)))
    per_axis = contour.numbers()["following"]
    for letter, both in per_axis.items():
        axis = axes[AXIS_NAMES.index(letter.upper())]
        sizes = both["max"], both["rms"]
        cells = [length(v) if axis.unit == "mm" else f"{figure(v)}{axis.unit}" for v in sizes]
        rows.append((f"Following error {axis.name}", *cells, "", ""))
    note = (
        f'<p class="note">RMS, median and 95 % are {RMS}; of following errors where it moves.</p>'
    )
    return table(("", "Max", "RMS", "Median", "95 %"), rows) + note


def circle_table(test: CircularTest) -> str:
    """Quantities of a circular test."""
    ways = [(name, w) for name, w in (("ccw", test.ccw), ("cw", test.cw)) if w is not None]

    def row(title: str, what: str, get: Any, both: str = "") -> tuple[str, ...]:
        cells = [get(way) for _, way in ways]
        name = f'{title}<br><span class="sub">{what}</span>'
        return (name, *cells, *([both] if test.both else []))

    def um(key: str) -> Any:
        return lambda way: length(getattr(way.reading, key), sign=not key.startswith("g"))

    both_g = length(test.both.g) if test.both else ""
    both_d = length(test.both.d, sign=True) if test.both else ""
    rows = [
        row("G, G(b)", "minimum zone of the path, of both paths", um("g"), both_g),
        row("F max", "about the nominal centre", um("f_max")),
        row("F min", "about the nominal centre", um("f_min")),
        row("Radius change, D", "mean, least-squares centre", um("radius_change"), both_d),
        row("Major semi-axis", "fitted ellipse minus radius", um("major_change")),
        row("Minor semi-axis", "fitted ellipse minus radius", um("minor_change")),
        row("Ellipse direction", "of the major axis", _direction),
        row("Centre offset", "least squares minus nominal", _offset),
        row("Evaluated", "angle, speed", _evaluated),
    ]
    heads = ["", *(name for name, _ in ways), *(["both"] if test.both else [])]
    return table(heads, rows)


def _direction(way: CirclePass) -> str:
    return f"{figure(math.degrees(way.reading.orientation), sign=True)}°"


def _offset(way: CirclePass) -> str:
    return "<br>".join(length(v, sign=True) for v in way.reading.offset)


def _evaluated(way: CirclePass) -> str:
    steady = "" if way.steady else "<br>with run-in"
    return f"{math.degrees(way.coverage):.0f}°<br>{figure(way.speed)} mm/s{steady}"


def folded(make: Callable[[Sequence[Any]], str], rows: Sequence[Any]) -> str:
    """A table of the first rows; a line opens one of the others, of very many as `FOLDED`."""
    first, rest = rows[:SHOWN], rows[SHOWN : SHOWN + FOLDED]
    if not rest:
        return make(first)
    left = len(rows) - len(first) - len(rest)
    more = f", the first of {len(rest) + left}" if left else ""
    head = f"<summary>{len(rest)} more{more}</summary>"
    return f"{make(first)}<details>{head}{make(rest)}</details>"


def corner_table(contour: ContourResult) -> str:
    """Corners, the largest errors first."""
    return folded(_corner_rows, sorted(contour.corners, key=lambda c: -c.error))


def _corner_rows(corners: Sequence[Corner]) -> str:
    rows = [
        (
            f"{c.line_before} → {c.line_after}",
            ", ".join(figure(v) for v in c.point),
            f"{math.degrees(c.angle):.1f}°",
            f"{figure(c.speed)} mm/s",
            length(c.error),
            f"{c.time:.3f} s",
        )
        for c in corners
    ]
    return table(("Lines", "At X, Y, Z [mm]", "Turn", "Least feed", "Error", "Time"), rows, 2)


def line_table(contour: ContourResult) -> str:
    """Program lines with the largest errors."""
    commands = contour.commands
    worst = commands[np.argsort(-commands["max"], kind="stable")[:LINES_SHOWN]]
    rows = [
        (
            str(row["line"]),
            row["kind"],
            f"{figure(row['length'])} mm",
            length(row["max"]),
            length(row["rms"]),
            f"{row['time']:.3f} s",
        )
        for row in worst
    ]
    return table(("Line", "Move", "Length", "Max", "RMS", "Time of max"), rows, 2)
