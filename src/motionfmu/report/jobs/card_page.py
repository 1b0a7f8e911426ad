"""The page of a plan: its numbers, the path by speed, speeds over time, what was passed over."""

from html import escape
from typing import Any

import numpy as np
from matplotlib.colors import to_hex

from motionfmu.cards.plan import DRAWS, Plan
from motionfmu.cards.plan_figures import speeds
from motionfmu.cards.plt import PltDrawing
from motionfmu.report.jobs.card_pictures import MOST, SPEEDS
from motionfmu.report.packed import packed
from motionfmu.report.samples import Samples, sampled
from motionfmu.report.sheet import Frame, Sheet
from motionfmu.report.style import AXES, RAPID, axis, layout
from motionfmu.report.tables import cards, table

LEVELS = 8  # colours of the speed
FOOTER = (
    "Speeds and accelerations are those planned, before they are rounded to pulses. Every number is"
    ' in <a href="result.json">result.json</a>.'
)


def plan_page(name: str, plan: Plan, drawing: PltDrawing, numbers: dict[str, Any]) -> str:
    """The whole HTML page."""
    page = Sheet()
    n = numbers
    up = n["time"] - n["time_down"]
    page.sections.append(
        cards(
            [
                ("Time", f"{n['time']:.3f} s", f"{n['frames']} frames"),
                ("Pen down", f"{n['way_down']:.1f} mm", f"in {n['time_down']:.3f} s"),
                ("Pen up", f"{n['way_up']:.1f} mm", f"in {up:.3f} s with the pen's own time"),
                ("Off the drawing", f"{1e3 * n['off']:.1f} µm", f"back {1e3 * n['back']:.1f} µm"),
                ("At feed", f"{100 * n['at_feed']:.0f} %", f"{n['stops']} stops in contours"),
                ("Job", f"{n['size']} bytes", f"{100 * n['flash']:.1f} % of a slot of the flash"),
            ]
        )
    )
    note = "The colour is the speed with the pen down; dotted: pen up."
    page.section("Path", note, page.place("path", _path(plan)))
    page.section("Speed of the axes", "", page.place("speed", _over_time(plan, 1), True))
    page.section("Acceleration of the axes", "", page.place("pull", _over_time(plan, 2), True))
    rows = [
        (a, f"{v:.1f}", f"{p:.0f}", f"{j:.0f}")
        for a, v, p, j in zip("XYZU", n["speed"], n["acceleration"], n["jerk"], strict=False)
    ]
    page.section(
        "Peaks", "", table(("axis", "speed [mm/s]", "acceleration [mm/s²]", "jerk [mm/s³]"), rows)
    )
    if drawing.notes:
        told = [(f"{x.line}", f"{x.byte}", f"{x.count}", escape(x.text)) for x in drawing.notes]
        heads = ("line", "byte", "times", "passed over")
        page.section("Notes", "What the file says that draws nothing.", table(heads, told, 4))
    which = f", page {drawing.page} of {drawing.pages}" if drawing.pages > 1 else ""
    about = f"A drawing as a job of a network card{which}"
    return page.text(Frame(name, about, "plan", [], FOOTER))


def _runs(mask: np.ndarray) -> list[tuple[int, int]]:
    """Begin and end of what is true in a row."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]])))
    return list(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))


def _trace(places: np.ndarray, mask: np.ndarray) -> dict[str, Any]:
    """Chords of the frames of a mask, gaps between those that do not follow each other."""
    step = -(-len(mask) // MOST)
    parts = []
    for a, b in _runs(mask):
        part = places[a : b + 1]
        parts += [part[: -1 if len(part) > 1 else None : step], part[-1:], np.full((1, 2), np.nan)]
    line = np.concatenate(parts) if parts else np.zeros((0, 2))
    return {"x": packed(line[:, 0]), "y": packed(line[:, 1]), "type": "scatter", "mode": "lines"}


def _path(plan: Plan) -> dict[str, Any]:
    places = np.vstack([np.zeros((1, 2)), plan.places[:, :2]])
    drawn, quick = plan.steps == DRAWS, speeds(plan)
    traces = [
        _trace(places, ~drawn)
        | {"name": "pen up", "line": {"color": RAPID, "width": 1.0, "dash": "dot"}}
    ]
    top = float(quick[drawn].max(initial=0.0)) or 1.0
    level = np.minimum((quick / top * LEVELS).astype(int), LEVELS - 1)
    for k in range(LEVELS):
        if (mask := drawn & (level == k)).any():
            name = f"{top * k / LEVELS:.0f} .. {top * (k + 1) / LEVELS:.0f} mm/s"
            color = to_hex(SPEEDS(k / (LEVELS - 1)))
            line = {"name": name, "line": {"color": color, "width": 2.2}}
            traces.append(_trace(places, mask) | line)
    low, high = places.min(axis=0), places.max(axis=0)
    edge = 0.03 * float((high - low).max()) or 1.0
    x, y = ([a - edge, b + edge] for a, b in zip(low, high, strict=True))
    return {
        "data": traces,
        "layout": layout(
            600,
            xaxis=axis("X [mm]", range=x, constrain="domain"),
            yaxis=axis("Y [mm]", range=y, scaleanchor="x", scaleratio=1, constrain="domain"),
        ),
    }


def _over_time(plan: Plan, order: int) -> dict[str, Any]:
    """Speeds (1) or accelerations (2) of the axes that move."""
    every = np.vstack([np.zeros((order, 4)), plan.places])
    rates = np.diff(every, order, axis=0) / plan.period**order
    time = np.arange(1, len(rates) + 1) * plan.period
    traces = [
        sampled(Samples(time, rates[:, k]), name, AXES[k], width=1.2)
        for k, name in enumerate("XYZU")
        if rates[:, k].any()
    ]
    title = ("Speed [mm/s]", "Acceleration [mm/s²]")[order - 1]
    titles = {"xaxis": axis("Time [s]"), "yaxis": axis(title)}
    return {"data": traces, "layout": layout(260, hovermode="x", **titles)}
