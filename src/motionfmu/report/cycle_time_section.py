"""Where the time of a program goes, what limits the axes, and what would make it shorter."""

from collections.abc import Sequence
from html import escape
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.cycle_time import CAUSES, CommandedMotion, Lifted, Share
from motionfmu.base import units
from motionfmu.base.columns import forget
from motionfmu.report.diagram import Diagram, path_diagram, path_lines
from motionfmu.report.html_page import Page
from motionfmu.report.html_tables import table
from motionfmu.report.numbers import figure
from motionfmu.report.style import AXES, HEAT, INK, MUTED, RAPID
from motionfmu.run.axis_figures import AxisFigure

HEIGHT = 500  # [pixel] of the path
POINTS, TOLD = 12_000, 5_000  # of the path: at most; and with words at most
# A step across a plane is below this share of its length; so much of the way lies in the plane.
ACROSS, MOSTLY = 0.02, 0.6
COLORS = {
    "feed": AXES[0],
    "speed": AXES[2],
    "acceleration": AXES[1],
    "jerk": AXES[3],
    "corner": HEAT[3],
    "exact stop": INK,
    "dwell": RAPID,
    "waiting": MUTED,
}
WORDS = {
    "feed": "programmed feed, or the highest of the machine",
    "speed": "highest speed of an axis",
    "acceleration": "gains speed, or holds it on a bend, with all the acceleration there is",
    "jerk": "acceleration changes as fast as it may",
    "corner": "slows down for the tolerance of a corner, or is in it",
    "exact stop": "slows down to rest",
    "dwell": "",
    "waiting": "hold, operator",
}


def name_of(share: Share) -> str:
    """What limits, in words."""
    return f"{share.cause} of {share.axis}" if share.axis else share.cause


def add_cycle_time(page: Page, plan: CommandedMotion, lifted: Sequence[Lifted] = ()) -> None:
    """Add sections on where the time goes; with limits lifted, on what they would save."""
    if not plan.time:
        return
    rows = [
        (escape(name_of(s)), WORDS[s.cause], f"{s.time:.3f}", f"{100.0 * s.time / plan.time:.1f}")
        for s in plan.shares()
    ]
    rows.append(("all", "", f"{plan.time:.3f}", "100.0"))
    waits = "Waits for an operator, an input, a probe or the position of an axis are "
    waits += "in it." if plan.driven else "not in it."
    note = f"What keeps the program from being faster, at each instant of its motion. {waits}"
    lines = bool(plan.rows["line"].any())
    if lines and not plan.driven and not lifted:
        note += " <code>motionfmu gcode</code> says what a higher limit would save."
    content = table(("limited by", "", "s", "%"), rows, numeric=2)
    content += page.place("limited", path_by_cause(plan))
    page.section("Where the time goes", note, content)
    blocks = [
        (
            str(b.line),
            ", ".join(f"{escape(name_of(s))} {s.time:.3f} s" for s in b.shares[:3]),
            f"{b.time:.3f}",
            f"{b.lost:.3f}",
        )
        for b in plan.slowest
    ]
    note = "Lines that take longest beyond the time at their programmed feed; dwells lose none."
    if lines:
        content = table(("line", "limited by", "s", "lost [s]"), blocks, numeric=2)
        page.section("Slowest lines", note, content)
    if lifted:
        note = "The cycle time if this limit alone were a quarter higher."
        rows = [
            (escape(f"{x.title}, {x.axis}" if x.axis else x.title), f"{x.time:.3f}",
             f"{x.saved:.3f}", f"{100.0 * x.saved / plan.time:.1f}")
            for x in lifted
        ]  # fmt: skip
        page.section("What if", note, table(("limit", "s", "saved [s]", "%"), rows))


def path_by_cause(plan: CommandedMotion) -> Diagram:
    """The path, coloured by what limits the motion on it."""
    rows = _working(plan.rows)
    rows = rows[:: max(1, len(rows) // POINTS)]
    place, cause = rows["place"][:, :3], rows["cause"]
    shown = _seen(place)
    place, width = place[:, shown], len(shown)
    lines = []
    shares: dict[str, float] = {}
    for share in plan.shares():
        shares[share.cause] = shares.get(share.cause, 0.0) + share.time
    for number, name in CAUSES.items():
        own = cause == number
        if name not in shares or not own.any():
            continue
        before = np.append(own[1:] & ~own[:-1], False)  # from where the limit before it ended
        kept = np.flatnonzero(own | before)
        gaps = np.flatnonzero(before[kept])
        points = np.insert(place[kept, :width], gaps, np.nan, axis=0)
        told: list[str] = []
        if len(rows) <= TOLD:
            words = [f"line {r['line']}, {r['speed'] * 60.0:.4g} mm/min" for r in rows[kept]]
            if not rows["line"].any():
                words = [f"{r['speed']:.4g} mm/s" for r in rows[kept]]
            told = list(np.insert(np.array(words, object), gaps, ""))
        lines.append(path_lines(points, name=name, color=COLORS[name], width=2.2, hover=told))
    forget(plan.rows)
    return path_diagram("".join("XYZ"[k] for k in shown), lines, HEIGHT)


def _working(rows: NDArray[Any]) -> NDArray[Any]:
    """Rows from the first to the last move with a feed, where there are some; else all."""
    there = np.flatnonzero(rows["feed"] > 0.0)
    return rows[there[0] : there[-1] + 1] if len(there) else rows


def _seen(place: NDArray[np.float64]) -> list[int]:
    """Two axes, if the path hardly goes but along their plane, else all three."""
    steps = np.abs(np.diff(place, axis=0))
    way = np.linalg.norm(steps, axis=1)
    if not way.any():
        return [0, 1]
    flat = [float(way[s <= ACROSS * way].sum()) for s in steps.T]
    across = int(np.argmax([share + 1e-9 * k for k, share in enumerate(flat)]))
    if flat[across] < MOSTLY * way.sum():
        return [0, 1, 2]
    return [k for k in range(3) if k != across]


def add_axes(page: Page, found: Sequence[AxisFigure]) -> None:
    """Add a table of the axes' figures, each beside what limits it."""
    if not found:
        return
    names = "figure axis least greatest RMS limit share at_it_[s] continuous above_[s] longest_[s]"
    heads = [name.replace("_", " ") for name in names.split()]
    rows = []
    for f in found:
        unit = units.spelled(f.limit.unit)
        title = f.limit.figure.replace("_", " ") + (f" [{unit}]" if unit else "")
        rows.append(
            (
                escape(title),
                escape(f.limit.axis.name),
                figure(f.low),
                figure(f.high),
                figure(f.rms),
                bounds(f),
                "" if f.share is None else f"{100.0 * f.share:.0f} %",
                f"{f.time_at_limit:.3f}" if bounds(f) else "",
                "" if f.continuous_share is None else f"{100.0 * f.continuous_share:.0f} %",
                "" if f.limit.continuous is None else f"{f.time_above:.3f}",
                _longest(f),
            )
        )
    note = (
        "Each figure over the whole run beside what limits it. <b>Continuous</b> is the RMS over"
        " what the axis bears for ever; <b>above</b> is the time beyond that, <b>longest</b> the"
        " longest without a break, and the share of what is allowed where the machine states it."
    )
    page.section("Axes and their limits", note, table(heads, rows, numeric=2))


def _longest(f: AxisFigure) -> str:
    """The longest time above what may last, and its share of what is allowed."""
    if f.limit.continuous is None:
        return ""
    share = f.overload_share
    return f"{f.longest_above:.3f}" + ("" if share is None else f", {100.0 * share:.0f} %")


def bounds(f: AxisFigure) -> str:
    """The limits of a figure in words; empty without."""
    limit = f.limit
    parts = []
    if limit.limit is not None:
        parts.append(figure(limit.limit))
    if limit.low is not None or limit.high is not None:
        ends = ("" if x is None else figure(x) for x in (limit.low, limit.high))
        parts.append(" to ".join(ends))
    return ", ".join(parts)
