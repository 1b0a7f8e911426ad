"""The figures and the notebook view of a result."""

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
from motionfmu.report.notebook_view import (
    PATH_INCHES,
    PATH_WIDTH,
    NotebookFigure,
    beside,
    cells,
    images,
    view,
)
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
NOTHING = "the run records no signal"


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
    name, size = escape(result.name), escape(result.size)
    return view(
        f'<b>{name}</b>{verdict} <span class="sub">{size}</span>',
        f"<p>{escape(result.about)}</p>{_overrides(result)}",
        beside(left, _picture(result)) + _warnings(result) + _signals(result),
    )


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
    return cells(("", "Check", "Found", "Asked", "Difference"), rows, (2, 4)) + more


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
    return cells(("", "Max", "RMS", "95 %"), rows, (1, 2, 3)) + lag


def _picture(result: Result) -> str:
    if not len(result):
        return ""
    if not _has_contour(result):
        return images(_first(result), result.name)
    # The picture fits beside the checks; the numbers of the error stand below them.
    drawn = draw(result.contour())
    title = f"Contour error {drawn.magnify:,.0f} times as large"
    shown = picture(title, "", path_chart(drawn), width=PATH_INCHES)
    return images(shown, result.name, PATH_WIDTH)


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
    return f"<details><summary>{count}</summary>{cells(heads, rows, (1,))}</details>"
