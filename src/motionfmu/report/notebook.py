"""The figures and the notebook view of a result in Python."""

import base64
import io
from collections.abc import Callable, Iterable, Sequence
from html import escape
from typing import Any

import matplotlib
import numpy as np
from matplotlib.backends import BackendFilter, backend_registry
from matplotlib.figure import Figure
from numpy.typing import NDArray

from motionfmu.base.errors import InputError
from motionfmu.base.units import spelled
from motionfmu.report.error_path import draw
from motionfmu.report.matplotlib_figure import picture
from motionfmu.report.numbers import figure, label, length
from motionfmu.report.path_chart import path_chart, path_titles
from motionfmu.report.signal_chart import signal_chart
from motionfmu.run import Result
from motionfmu.run.checks import Verdict, tally
from motionfmu.run.decimate import Read, reader
from motionfmu.run.figures import Chart, Panel, curve
from motionfmu.run.signals import elements

# Checks that the view shows; those that failed come first.
CHECKS_SHOWN = 15
# Width [pixel] of the view's picture, of a path and of a figure; the file has twice as many.
PATH_WIDTH, WIDTH = 400, 680
PATH_INCHES = 5.2
NOTHING = "the run records no signal"
# Text takes the colour of the page that it stands on; a picture has its own white one.
STYLE = """
.motionfmu { font: 13px/1.45 Inter, "Segoe UI", "Helvetica Neue", Arial, sans-serif; }
.motionfmu p { margin: 0 0 8px; }
.motionfmu .head b { font-size: 16px; }
.motionfmu .sub { opacity: .7; }
.motionfmu .row { display: flex; flex-wrap: wrap; gap: 12px 28px; align-items: flex-start; }
.motionfmu .row > div { min-width: 0; max-width: 100%; }
.motionfmu .scroll { overflow-x: auto; }
.motionfmu img { background: #fff; border-radius: 6px; max-width: 100%; margin: 0; }
.motionfmu table { border-collapse: collapse; margin: 0 0 12px; font-size: 13px; }
.motionfmu th, .motionfmu td { text-align: left; padding: 2px 14px 2px 0; border: 0;
  border-bottom: 1px solid rgba(128, 128, 128, .3); background: none; vertical-align: top; }
.motionfmu th { font-weight: 600; opacity: .7; }
.motionfmu .n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.motionfmu .ok { color: #2a9d5c; font-weight: 600; }
.motionfmu .failed { color: #e5533d; font-weight: 600; }
.motionfmu summary { cursor: pointer; opacity: .7; }
"""


class NotebookFigure(Figure):
    """A figure that a notebook shows, also one in which nothing has loaded pyplot."""

    def _repr_png_(self) -> bytes:
        file = io.BytesIO()
        self.savefig(file, format="png", dpi=2 * WIDTH / self.get_figwidth())
        return file.getvalue()


def plot(
    result: Result,
    names: Sequence[str | tuple[str, ...]],
    window: tuple[float, float] | None,
) -> Figure:
    """The figure of `Result.plot`."""
    make: Callable[..., Figure] = NotebookFigure
    windows = backend_registry.list_builtin(BackendFilter.INTERACTIVE)
    if matplotlib.get_backend().lower() in (name.lower() for name in windows):
        from matplotlib import pyplot

        make = pyplot.figure  # else show() does not know it; a notebook would show it twice
    if not names and window is None:
        return _first(result, make)
    panels = names or tuple(result)[:1]
    if not panels:
        raise InputError(NOTHING)
    chart = _chart(result, panels, window)
    return picture(chart.title, chart.note, signal_chart(chart), make=make)


def _first(result: Result, make: Callable[..., Figure] = Figure) -> Figure:
    """The figure with which the report begins."""
    if _has_contour(result):
        contour = result.contour()
        drawn = draw(contour)
        return picture(*path_titles(result.name, contour, drawn), path_chart(drawn), make=make)
    charts = result.figures() or result.overview()[:1]
    if not charts:
        raise InputError(NOTHING)
    return picture(charts[0].title, charts[0].note, signal_chart(charts[0]), make=make)


def _has_contour(result: Result) -> bool:
    return result.scenario.document.body.contour is not None and not result.no_contour


def _chart(
    result: Result, panels: Iterable[str | tuple[str, ...]], window: tuple[float, float] | None
) -> Chart:
    """Signals over time as the figure of a scenario, a panel each."""
    whole = float(result.time[0]), float(result.time[-1])
    span = whole if window is None else window
    try:
        start, end = map(float, span)
    except (TypeError, ValueError):
        raise InputError(f"window = {window!r}: two times [s] wanted, from and to") from None
    if not 0.0 <= start < end <= result.seconds:
        text = f"window = {window!r}: from and to within 0 .. {result.seconds:g} s wanted"
        raise InputError(text)
    found = []
    for names in panels:
        together = (names,) if isinstance(names, str) else tuple(names)
        columns = {n: data for name in together for n, data in elements(result, name).items()}
        whole_names = {name.partition("[")[0] for name in columns}
        named = {result.units[name] for name in whole_names}
        unit = named.pop() if len(named) == 1 else "1"
        words = together[0] if len(together) == 1 else ", ".join(sorted(whole_names))
        curves = tuple(
            curve(n, result.time, _plain(data), (start, end), data.dtype.kind != "f")
            for n, data in columns.items()
        )
        logic = all(data.dtype == bool for data in columns.values())
        text = label(words, unit if unit != "1" else None)
        found.append(Panel(text, curves, {}, len(curves) > 1, logic))
    return Chart(result.name, result.about, (start, end), window is None, tuple(found))


def _plain(data: NDArray[Any]) -> Read:
    """A signal as real numbers."""
    read = reader(data)
    return lambda first, last: read(first, last).astype(np.float64)


def html(result: Result) -> str:
    """The view of a result in a notebook."""
    checks = result.checks
    count = tally(v.ok for v in checks)
    mark = "failed" if count.failed else "ok" if count.judged else "sub"
    verdict = f' <span class="{mark}">{count.words}</span>'
    reasons = dict.fromkeys([*(v.reason for v in checks), result.no_contour])
    told = "".join(f'<p class="sub">{escape(r)}</p>' for r in reasons if r)
    left = _checks(checks) + _contour(result) + told
    return (
        f'<div class="motionfmu"><style>{STYLE}</style>'
        f'<p class="head"><b>{escape(result.name)}</b>{verdict}'
        f' <span class="sub">{escape(result.size)}</span></p><p>{escape(result.about)}</p>'
        f"{_overrides(result)}"
        f'<div class="row"><div>{left}</div>{_picture(result)}</div>'
        f"{_warnings(result)}{_signals(result)}</div>"
    )


def _table(heads: Sequence[str], rows: Iterable[Sequence[str]], numeric: Sequence[int] = ()) -> str:
    """A table of ready HTML; numeric columns stand to the right."""

    def line(tag: str, cells: Sequence[str]) -> str:
        kinds = [' class="n"' if i in numeric else "" for i in range(len(cells))]
        parts = (f"<{tag}{k}>{c}</{tag}>" for k, c in zip(kinds, cells, strict=True))
        return f"<tr>{''.join(parts)}</tr>"

    body = "".join(line("td", row) for row in rows)
    head = line("th", heads)
    table = f"<table><thead>{head}</thead><tbody>{body}</tbody></table>"
    return f'<div class="scroll">{table}</div>'


_MARKS = {
    True: '<span class="ok">ok</span>',
    False: '<span class="failed">FAILED</span>',
    None: '<span class="sub">expected</span>',
}


def _checks(checks: Sequence[Verdict]) -> str:
    if not checks:
        return ""
    listed = sorted(checks, key=lambda v: (v.ok is None, v.ok))
    rows = [
        (
            _MARKS[v.ok],
            escape(v.name),
            "none" if v.reason else f"{v.value:.6g}",
            escape(v.bounds),
            f"{v.beyond:+.4g}" if v.ok is None and abs(v.beyond) > 0.0 else "",  # NaN: no number
        )
        for v in listed[:CHECKS_SHOWN]
    ]
    rest = len(listed) - len(rows)
    more = f'<p class="sub">and {rest} more in <code>result.checks</code></p>' if rest else ""
    return _table(("", "Check", "Found", "Asked", "Difference"), rows, (2, 4)) + more


def _contour(result: Result) -> str:
    if not _has_contour(result):
        return ""
    contour = result.contour()
    error, command = contour.error, contour.command_error
    rows = [
        ("Contour error", length(error.max), length(error.rms), length(error.p95)),
        ("Command error", length(command.max), length(command.rms), length(command.p95)),
    ]
    lag = f'<p class="sub">servo lag {figure(contour.lag * 1e3)} ms</p>'
    return _table(("", "Max", "RMS", "95 %"), rows, (1, 2, 3)) + lag


def _picture(result: Result) -> str:
    if not len(result):
        return ""
    file, width = io.BytesIO(), WIDTH
    if _has_contour(result):
        # The picture fits beside the checks; the numbers of the error stand below them.
        width, drawn = PATH_WIDTH, draw(result.contour())
        title = f"Contour error {drawn.magnify:,.0f} times as large"
        shown = picture(title, "", path_chart(drawn), width=PATH_INCHES)
    else:
        shown = _first(result)
    shown.savefig(file, format="png", dpi=2 * width / shown.get_figwidth())
    data = base64.b64encode(file.getvalue()).decode()
    return f'<img width="{width}" alt="{escape(result.name)}" src="data:image/png;base64,{data}"/>'


def _overrides(result: Result) -> str:
    if not result.overrides:
        return ""
    return f'<p><span class="sub">not as written:</span> {escape("; ".join(result.overrides))}</p>'


def _warnings(result: Result) -> str:
    return "".join(
        f'<p><span class="failed">warning</span> {escape(w)}</p>' for w in result.warnings
    )


def _signals(result: Result) -> str:
    """The list of recorded signals, which a click opens."""
    rows: list[Any] = []
    for name, data in result.items():
        port = result.resolver.end(name, "record", "signals").port
        shape = f"{data.shape[1]}" if data.ndim == 2 else ""
        rows.append((escape(name), shape, escape(spelled(port.unit)), escape(port.doc)))
    heads = ("Signal", "Elements", "Unit", "Is")
    count = f"{len(rows)} signal{'s' * (len(rows) != 1)}"
    return f"<details><summary>{count}</summary>{_table(heads, rows, (1,))}</details>"
