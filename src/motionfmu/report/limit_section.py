"""Each axis against its limits, and which of them bounds the cycle, as a section of the page."""

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

import numpy as np
from numpy.typing import NDArray

from motionfmu.report.diagram import Diagram, LevelMark, Mark, SamplesMark, Scale, Subplot
from motionfmu.report.html_page import Page
from motionfmu.report.html_tables import table
from motionfmu.report.samples import Samples
from motionfmu.report.style import AXES, INK
from motionfmu.run.axis_figures import AxisFigure
from motionfmu.run.decimate import at, few
from motionfmu.run.limit_shares import FEED, PATH, STANDS, CycleBounds, LimitShares

HEIGHT, STRIP = 96, 20  # [pixel] of a figure, of each row of the strip
POINTS = 4000  # of a figure, for all its axes
ROOM = 1.08  # height of a figure that nothing exceeds
TICKS = {FEED: "speed", PATH: "path", STANDS: "rest"}
MOST = 2.0  # height of a figure at most, in shares of the limit


@dataclass(frozen=True)
class LimitUse:
    """How a run uses the limits of its axes."""

    shares: Sequence[LimitShares]
    bounds: CycleBounds | None
    figures: Sequence[AxisFigure]


def add_limit_use(page: Page, time: NDArray[np.float64], use: LimitUse) -> None:
    """Add the section; nothing without limits."""
    if not use.shares:
        return
    note = (
        "Shares of the limits over time: 1 is the limit; of a place in a travel 0 is its middle, 1"
        " an end."
    )
    content = _share_table(use)
    if use.bounds is not None:
        note += (
            " The last row is what has least room left: an axis, the programmed speed, or the path"
            " with its ramps and corners."
        )
        content += "<h3>What bounds the cycle</h3>" + _bounds_table(use.bounds)
    content += page.place("limits", _chart(time, use), True)
    page.section("Each axis against its limits", note, content)


def share_words(figure: AxisFigure) -> str:
    """The largest share of an axis and when, and how long it was at its limit, as HTML."""
    share, at = _largest(figure)
    if share is None:
        return ""
    told = f"{100.0 * share:.0f} % at {at:.3f} s"
    long = figure.time_at_limit
    return f"{told}<br>{long:.3f} s at it" if long > 0.0 else told


def _largest(figure: AxisFigure) -> tuple[float | None, float]:
    """The largest share and when [s]."""
    limit = figure.limit
    if limit.limit:
        return figure.share, figure.at
    if limit.low is None or limit.high is None or limit.high <= limit.low:
        return None, 0.0
    middle, half = 0.5 * (limit.low + limit.high), 0.5 * (limit.high - limit.low)
    ends = (middle - figure.low, figure.low_at), (figure.high - middle, figure.high_at)
    way, when = max(ends)
    return way / half, when


def _share_table(use: LimitUse) -> str:
    """A row for each axis, a column for each figure."""
    names = [s.figure for s in use.shares]
    axes = dict.fromkeys(name for s in use.shares for name in s.axes)
    found = {(f.limit.axis.name, f.limit.figure): share_words(f) for f in use.figures}
    rows = [(escape(a), *(found.get((a, n), "") for n in names)) for a in axes]
    heads = ("largest share", *(n.replace("_", " ") for n in names))
    return table(heads, rows)


def _bounds_table(bounds: CycleBounds) -> str:
    rows = [
        (
            escape(x.name),
            ", ".join(f"{escape(n)} {t:.3f} s" for n, t in x.by),
            f"{x.time:.3f}",
            f"{100.0 * x.time / bounds.time:.1f}",
        )
        for x in bounds.nearest
    ]
    return table(("nearest", "by its", "s", "% of the cycle"), rows, numeric=2)


def _chart(time: NDArray[np.float64], use: LimitUse) -> Diagram:
    rows: list[Subplot] = []
    colors: dict[str, str] = {}
    for s in use.shares:
        for name in s.axes:
            colors.setdefault(name, AXES[len(colors) % len(AXES)])
    for s in use.shares:
        kept = few(len(time), s.read, False, POINTS)
        values = s.read(0, len(time)) if kept is None else at(s.read, kept)
        when = time if kept is None else time[kept]
        curves: list[Mark] = [
            SamplesMark(
                Samples(when, np.ascontiguousarray(values[:, k]), all=kept is None),
                name,
                colors[name],
            )
            for k, name in enumerate(s.axes)
        ]
        top = min(MOST, max(ROOM, ROOM * float(values.max(initial=0.0))))
        scale = Scale(s.figure.replace("_", " "), "", (0.0, top))
        rows.append(Subplot(scale, [*curves, LevelMark(1.0, "")], HEIGHT, not rows))
    if use.bounds is not None:
        rows.append(_strip(time, use.bounds))
    span = (float(time[0]), float(time[-1]))
    return Diagram((Scale("Time", "s", span),), rows)


def _strip(time: NDArray[np.float64], bounds: CycleBounds) -> Subplot:
    """What is nearest, as a staircase over its names."""
    known = [bounds.names.index(x.name) for x in bounds.nearest]
    places = sorted(known, reverse=True)
    kept = few(len(time), bounds.read, True, POINTS)
    values = bounds.read(0, len(time)) if kept is None else at(bounds.read, kept)
    row = np.full(len(bounds.names), np.nan)
    row[places] = np.arange(len(places))
    there = ~np.isnan(values)
    values = values.copy()
    values[there] = row[values[there].astype(int)]
    ticks = tuple((float(k), TICKS.get(x := bounds.names[p], x)) for k, p in enumerate(places))
    scale = Scale("", "", (-0.6, len(places) - 0.4), ticks=ticks)
    when = time if kept is None else time[kept]
    mark = SamplesMark(Samples(when, values, steps=True, all=kept is None), "nearest", INK)
    return Subplot(scale, [mark], max(HEIGHT, STRIP * len(places)), False)
