"""The figures after ISO 9283 as a section of the page and as a picture."""

from html import escape
from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.analysis.contour.circles import plane_axes
from motionfmu.analysis.iso9283 import Evaluation, Performance
from motionfmu.analysis.iso9283.evaluation import ANGLES
from motionfmu.report.diagram import (
    BandMark,
    Diagram,
    LineMark,
    Mark,
    Scale,
    Subplot,
    path_diagram,
    path_lines,
)
from motionfmu.report.error_scale import magnification, scale_end, within
from motionfmu.report.formula import readable
from motionfmu.report.html_page import Page
from motionfmu.report.html_tables import picture_buttons, table
from motionfmu.report.numbers import figure, length, unit
from motionfmu.report.style import AXES, INK, MUTED

PICTURE = "iso9283"
BAND = "#0b5cad"
HEIGHT = 190  # [pixel] of a plot along the path
MEANS = {
    "AT_P": ("Path accuracy AT_P", "largest distance of the mean line from the command"),
    "RT_P": ("Path repeatability RT_P", "mean distance from the mean line and 3 S, largest"),
    "straightness": ("Straightness", "largest distance of a line from its best line"),
    "straightness_in_plane": ("Straightness on the surface", "the same, seen along the normal"),
    "in_plane": ("In-plane deviation", "range across the path, on the surface"),
    "height": ("Height deviation", "range along the normal of the surface"),
}


def add_iso9283(page: Page, found: Evaluation) -> None:
    """Add tables and pictures of an evaluation."""
    path = found.path
    start, end = path.excluded
    count = len(path.given.cycles)
    note = (
        f"ISO 9283: {count} cycle{'s' if count != 1 else ''}, {len(path.along)} planes"
        f" perpendicular to the command path of {figure(path.given.path.length)} mm. Left out:"
        f" {_left_out(path, start, end)}."
    )
    content = _figures(found) + _cycles(found)
    content += page.place("iso9283", deviation_chart(path)) + picture_buttons(PICTURE)
    if found.poses:
        content += f"<h3>Poses</h3>{_poses(found)}"
    page.section("Path performance", note, content)


def _left_out(path: Performance, start: float, end: float) -> str:
    ramp, corner = path.given.ramp, path.given.corner
    why = f" (below {ramp:.0%} of the speed, or not reached)" if ramp else " (not reached)"
    told = f"{length(start)} at the start and {length(end)} at the end{why}"
    bent = corner > 0.0 and not path.given.path.straight
    return told + (f", {figure(corner)} mm to either side of corners" if bent else "")


def _figures(found: Evaluation) -> str:
    numbers = found.numbers()
    rows = []
    for name, (title, what) in MEANS.items():
        if numbers[name] is not None:
            rows.append((_named(title, what), length(numbers[name])))
    for a in ANGLES:
        for kind, what in (("AT", "largest mean deviation"), ("RT", "3 S, largest")):
            if numbers[f"{kind}_{a}"] is not None:
                rows.append((_named(f"{kind}_{a}", what), f"{figure(numbers[f'{kind}_{a}'])}°"))
    for name, what in (
        ("AV", "mean speed against its command, on the middle half"),
        ("RV", "3 S of the mean speeds"),
    ):
        if numbers[name] is not None:
            rows.append((_named(name, what), f"{figure(numbers[name])} %"))
    rows.append((_named("FV", "largest range of the speed in a cycle"), _speed(numbers["FV"])))
    strokes, width = numbers["coincidence"], found.path.given.pen_width
    if len(found.path.given.cycles) > 1 and strokes["lines"] is not None:
        what = "largest distance between two lines"
        rows.append((_named("Coincidence of the lines", what), length(strokes["lines"])))
        if width > 0.0:
            name = f"Coincidence of strokes {figure(width)} mm wide"
            gap = "" if strokes["gap"] == 0.0 else f", white between them {length(strokes['gap'])}"
            told = f"all paint {strokes['common']:.0%} of the width{gap}"
            rows.append((_named(name, f"painted band; {told}"), length(strokes["band"])))
    half = (len(rows) + 1) // 2
    parts = (table(("Figure", "Value"), part) for part in (rows[:half], rows[half:]))
    return f'<div class="two">{"".join(parts)}</div>'


def _named(title: str, what: str) -> str:
    return f'{readable(title)}<br><span class="sub">{escape(what)}</span>'


def _speed(value: float) -> str:
    return f"{figure(value)} mm/s"


def _cycles(found: Evaluation) -> str:
    heads = ("Cycle", "Time", "Largest", "Straightness", "In plane", "Height", "Speed")
    rows = []
    for k, c in enumerate(found.path.cycle_numbers(), 1):
        shapes = [length(c[n]) if n in c else "" for n in ("straightness", "in_plane", "height")]
        span = f"{figure(c['start'])} to {figure(c['end'])} s"
        rows.append((str(k), span, length(c["largest"]), *shapes, _speed(c["speed"])))
    return table(heads, rows)


def _poses(found: Evaluation) -> str:
    rows = [
        (
            str(k),
            length(p.AP_P),
            *(length(v, sign=True) for v in p.AP),
            "" if p.RP_l is None else length(p.RP_l),
        )
        for k, p in enumerate(found.poses, 1)
    ]
    return table(("Pose", *map(readable, ("AP_P", "AP_x", "AP_y", "AP_z", "RP_l"))), rows)


def parts(path: Performance) -> list[tuple[str, Any, Any]]:
    """The deviations over the path: title, values by cycle (n, m) and their mean (m,) [mm]."""
    if path.normal is None:
        size = np.linalg.norm(path.point - path.command, axis=2)
        return [("Distance", size, path.accuracy)]
    return [
        ("Across, on the surface", path.across, path.across.mean(axis=0)),
        ("Height", path.height, path.height.mean(axis=0)),
    ]


def deviation_chart(path: Performance) -> Diagram:
    """Deviation of every cycle along the path, and the band of the repeatability."""
    drawn = parts(path)
    factor, name = unit(max(float(np.abs(v).max()) for _, v, _ in drawn))
    rows = []
    for i, (title, values, mean) in enumerate(drawn):
        marks: list[Mark] = []
        if path.repeatability is not None:
            low, high = (factor * (mean + s * path.repeatability) for s in (-1.0, 1.0))
            marks.append(BandMark(path.along, low, high, "mean ± repeatability", BAND))
        for j, own in enumerate(values):
            color = AXES[j % len(AXES)]
            marks.append(LineMark(path.along, factor * own, f"cycle {j + 1}", color, 1.1))
        if len(values) > 1:
            marks.append(LineMark(path.along, factor * mean, "mean", INK, 2.2))
        rows.append(Subplot(Scale(title, name), marks, HEIGHT, None if i == 0 else False))
    return Diagram((Scale("Place on the path", "mm"),), rows)


def magnified_chart(path: Performance) -> tuple[Diagram, float]:
    """The command path and the lines seen along its normal, and how much they are magnified."""
    normal = np.array([0.0, 0.0, 1.0]) if path.normal is None else path.normal
    basis = plane_axes(normal)
    gap = path.point - path.command
    sizes = np.linalg.norm(gap, axis=2)
    extent = float(np.linalg.norm(np.ptp(path.command, axis=0)))
    errors = float(np.percentile(sizes, 95)), float(sizes.max())
    factor = magnification(errors, extent, extent)
    lines = [path_lines(path.given.path.points @ basis.T, name="command", color=MUTED)]
    for j, own in enumerate(path.command + factor * within(gap, scale_end(errors))):
        look: Any = {"name": f"cycle {j + 1}", "color": AXES[j % len(AXES)], "width": 1.2}
        lines.append(path_lines(own @ basis.T, **look))
    names = ["XYZ"[int(np.argmax(np.abs(b)))] for b in basis]
    return path_diagram(names, lines, 2.0 * HEIGHT), factor


def write_iso9283(name: str, found: Evaluation, folder: Path) -> None:
    """Draw the lines over the command path and along it, as iso9283.png and iso9283.svg."""
    from motionfmu.report.matplotlib_figure import write_picture

    path = found.path
    lines, factor = magnified_chart(path)
    title = f"{name}: {len(path.given.cycles)} cycles, deviation {factor:,.0f} times as large"
    note = f"AT_P {length(float(path.accuracy.max()))}"
    if path.repeatability is not None:
        note += f", RT_P {length(float(path.repeatability.max()))}"
    write_picture(folder / PICTURE, title, note, lines, deviation_chart(path))
