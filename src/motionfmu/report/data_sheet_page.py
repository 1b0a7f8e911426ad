"""The page and the picture of a machine's data sheet."""

import math
from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.analysis.data_sheet import AxisSheet, DataSheet
from motionfmu.analysis.data_sheet.robot_sheet import CYCLES, PATH_SPEED, SIDE, SPEED, RobotSheet
from motionfmu.analysis.data_sheet.sheet_loops import POSITION, LoopSheet
from motionfmu.analysis.data_sheet.sheet_programs import APPROACHES
from motionfmu.analysis.linear import Margins
from motionfmu.base.units import spelled
from motionfmu.report.diagram import (
    DASH,
    DOT,
    SOLID,
    Diagram,
    LevelMark,
    LineMark,
    Mark,
    PointMark,
    Scale,
    Subplot,
)
from motionfmu.report.html_page import Page, PageFrame
from motionfmu.report.html_tables import circle_table, facts, overrides, table
from motionfmu.report.numbers import figure, length
from motionfmu.report.polar_chart import polar_chart
from motionfmu.report.style import AXES

UP, DOWN = AXES[0], AXES[1]
POINTS = 600  # of a curve
HEIGHT, LOW = 200, 150  # [pixel] of a plot, of one in a picture
COLORS = 64  # of a picture
NONE = "\N{EN DASH}"
HEADS_230 = ("A", "A_up", "A_down", "E", "R", "R_up", "R_down", "M", "B", "B_mean")
WORDS_230 = {"A_up": "A↑", "A_down": "A↓", "R_up": "R↑", "R_down": "R↓", "B_mean": "mean B"}
FOOTER = (
    "All figures are of runs of the machine's FMUs, made by <code>motionfmu machines</code>; the"
    " programs stand beside this page and run by themselves. Every number is in"
    ' <a href="result.json">result.json</a>.'
)


def page_text(sheet: DataSheet) -> str:
    """The whole HTML page."""
    page = Page()
    if sheet.set:
        page.sections.append(overrides(f"{n} = {v}" for n, v in sheet.set.items()))
    page.section("Axes", "", limit_table(sheet))
    _add_positions(page, sheet)
    for name, test in sheet.circles.items():
        note = "ISO 230-4. Radial deviation from the nominal circle about its nominal centre."
        plot = page.place(f"circle{name}", polar_chart(test))
        content = f'<div class="two">{plot}<div>{circle_table(test)}</div></div>'
        page.section(f"Circle in {name}, radius {test.radius:g} mm", note, content)
    _add_loops(page, sheet)
    if sheet.robot is not None:
        _add_robot(page, sheet.robot)
    if sheet.left_out:
        rows = [(escape(what), escape(why)) for what, why in sheet.left_out.items()]
        page.section("Left out", "", facts(rows))
    if sheet.programs:
        links = (f'<a href="{escape(n)}">{escape(n)}</a>' for n in sheet.programs)
        page.section("Programs", "", f'<p class="files">{" ".join(links)}</p>')
    return page.text(PageFrame(sheet.name, sheet.about, "data sheet", [], FOOTER))


def limit_table(sheet: DataSheet) -> str:
    """Each axis with what limits its figures."""
    figures = list(dict.fromkeys(x.figure for x in sheet.limits))
    own = {(x.axis.name, x.figure): x for x in sheet.limits}
    rows = []
    for a in sheet.axes:
        cells = [_limits(own.get((a.axis.name, f))) for f in figures]
        rows.append((a.axis.name, a.axis.axis.kind, *cells))
    return table(("axis", "kind", *(escape(f.replace("_", " ")) for f in figures)), rows, 2)


def _limits(limit: Any) -> str:
    """What limits a figure, in words."""
    if limit is None:
        return ""
    unit = spelled(limit.unit)
    parts = []
    if limit.low is not None and limit.high is not None:
        parts.append(f"{limit.low:.6g} .. {limit.high:.6g}")
    elif limit.limit is not None:
        parts.append(f"{limit.limit:.6g}")
    if not parts:
        return NONE
    text = f"{parts[0]} {unit}".strip()
    if limit.continuous is not None:
        more = "" if limit.overload is None else f", above it {limit.overload:g} s"
        text += f'<div class="sub">lasting {limit.continuous:.6g}{more}</div>'
    return text


def _add_positions(page: Page, sheet: DataSheet) -> None:
    """ISO 230-2 of the axes."""
    measured = [a for a in sheet.axes if a.positioning is not None]
    if not measured:
        return
    note = (
        f"ISO 230-2:2014, {APPROACHES} approaches of each target from either side, each read where"
        " the axis has rested. A is accuracy, E its systematic part, R repeatability, B the"
        " reversal value, M the range of the mean of both directions; ↑ and ↓ are one direction."
        " Unrest is how far the axis moves while it is read, which is the mean of a second."
    )
    content = positioning_table(measured)
    for a in measured:
        content += page.place(f"position{a.axis.name}", positioning_chart(a))
    page.section("Positioning", note, content)


def positioning_table(measured: Sequence[AxisSheet]) -> str:
    """Figures of ISO 230-2, a row an axis."""
    heads = ["axis", "targets", *(WORDS_230.get(n, n) for n in HEADS_230), "unrest", "unit"]
    rows = []
    for a in measured:
        assert a.positioning is not None
        factor, unit = a.axis.fine
        found = a.positioning.figures()
        ends = a.positioning.targets[[0, -1]]
        where = f"{len(a.positioning.targets)}: {ends[0]:g} .. {ends[1]:g} {a.axis.unit}"
        cells = [figure(found[n] * factor) for n in HEADS_230]
        rows.append((a.axis.name, where, *cells, figure((a.unrest or 0.0) * factor), unit))
    return table(heads, rows, 2)


def positioning_chart(sheet: AxisSheet, height: float = HEIGHT) -> Diagram:
    """Deviations at the targets of an axis, and their means."""
    test = sheet.positioning
    assert test is not None
    factor, unit = sheet.axis.fine
    marks: list[Mark] = []
    both = (("upwards", UP, test.up, test.means[0]), ("downwards", DOWN, test.down, test.means[1]))
    for name, color, runs, mean in both:
        x = np.tile(test.targets, len(runs))
        marks.append(PointMark(x, factor * runs.ravel(), color=color, size=4.0, hover=()))
        marks.append(LineMark(test.targets, factor * mean, f"approached {name}", color, 1.6))
    x_scale = Scale(f"Target of {sheet.axis.name}", sheet.axis.unit)
    return Diagram((x_scale,), (Subplot(Scale("Deviation", unit), marks, height),))


def _add_loops(page: Page, sheet: DataSheet) -> None:
    """Margins and steps."""
    rows = [(a.axis.name, loop) for a in sheet.axes for loop in a.loops]
    if not rows:
        return
    point = ", ".join(f"{n} = {v:.4g}" for n, v in sheet.point.items())
    note = (f"About {escape(point)}. " if point else "About rest. ") + (
        "A step of the command, of a velocity loop one of speed, so small that nothing limits it:"
        " by the running FMUs, and by the linear model, from which margins are. Rise is from 10 to"
        " 90 %, settling within 2 %."
    )
    heads = ["axis", "loop", "Kp [1/s]", "gain", "phase", "delay", "peak S", "bandwidth"]
    cells = [(name, _loop_name(loop), *_margins(loop)) for name, loop in rows]
    content = table(heads, cells, 2)
    words = ("rise", "overshoot", "settling")
    heads = ["axis", "loop", *words, *(f"{w}, model" for w in words)]
    steps = [(name, loop.kind, *_step(loop.measured), *_step(loop.model)) for name, loop in rows]
    content += table(heads, steps, 2)
    content += page.place("steps", step_chart(sheet))
    page.section("Loops", note, content)


def _loop_name(loop: LoopSheet) -> str:
    return f'{loop.kind}<div class="sub">{escape(loop.at)}</div>'


def _margins(loop: LoopSheet) -> tuple[str, ...]:
    m = loop.margins
    kp = NONE if loop.kp is None else figure(loop.kp)
    delay = f"{figure(m.delay * 1e3)} ms" if math.isfinite(m.delay) else NONE
    band = f"{figure(m.bandwidth / (2.0 * math.pi))} Hz" if m.bandwidth > 0.0 else NONE
    return kp, gain_words(m), phase_words(m), delay, figure(m.sensitivity), band


def gain_words(m: Margins) -> str:
    """A gain margin as a factor."""
    return f"x {figure(m.gain)}" if math.isfinite(m.gain) else NONE


def phase_words(m: Margins) -> str:
    """A phase margin."""
    return f"{figure(m.phase)}°" if math.isfinite(m.phase) else NONE


def _step(found: Any) -> tuple[str, str, str]:
    """Rise, overshoot and settling of a step."""
    if found is None:
        return NONE, NONE, NONE
    times = [milliseconds(t) for t in (found.rise, found.settling)]
    return times[0], percent(found.overshoot), times[1]


def milliseconds(time: float) -> str:
    """A time [s] in ms."""
    return f"{figure(time * 1e3)} ms" if math.isfinite(time) else NONE


def percent(share: float) -> str:
    """A share in percent, to a tenth."""
    return f"{100.0 * share:.1f} %"


def step_chart(sheet: DataSheet, height: float = HEIGHT) -> Diagram:
    """Answers of all loops to a step; those of velocity loops are dotted."""
    marks: list[Mark] = [LevelMark(1.0, dash=DASH)]
    for k, a in enumerate(sheet.axes):
        for loop in a.loops:
            every = max(1, len(loop.time) // POINTS)
            time, answer = 1e3 * loop.time[::every], loop.answer[::every]
            look = AXES[k % len(AXES)], 1.6, SOLID if loop.kind == POSITION else DOT
            marks.append(LineMark(time, answer, f"{a.axis.name}, {loop.kind}", *look))
    y = Scale("Answer to a step of 1")
    return Diagram((Scale("Time", "ms"),), (Subplot(y, marks, height),))


def _add_robot(page: Page, robot: RobotSheet) -> None:
    """ISO 9283."""
    found = robot.found.numbers()
    rows = []
    for k, (place, pose) in enumerate(zip(robot.poses, robot.found.poses, strict=True), 1):
        at = ", ".join(f"{v:.0f}" for v in place)
        sizes = [length(pose.AP_P), *(length(float(v), sign=True) for v in pose.AP)]
        rows.append((f"P{k}", at, *sizes, length(pose.RP_l or 0.0)))
    heads = ("pose", "x, y, z [mm]", "AP", "x", "y", "z", "RP")
    note = (
        f"ISO 9283:1998. Five poses on a diagonal plane of a cube of {SIDE:g} mm about where the"
        f" arm starts, {CYCLES} times at {SPEED:g} mm/s; the line from P2 to P4 {CYCLES} times at"
        f" {PATH_SPEED:g} mm/s."
    )
    path = [
        ("Path accuracy AT", length(found["AT_P"])),
        ("Path repeatability RT", length(found["RT_P"])),
        ("Speed accuracy AV", f"{figure(found['AV'], sign=True)} %"),
    ]
    content = table(heads, rows, 2) + facts(path) + page.place("line", line_chart(robot))
    page.section("Poses and path", note, content)


def line_chart(robot: RobotSheet, height: float = HEIGHT) -> Diagram:
    """Distance of the mean path from the line."""
    path = robot.found.path
    mark = LineMark(path.along, path.accuracy, "mean path from the command", AXES[0], 1.6)
    y = Scale("Distance", "mm", floor=True)
    return Diagram((Scale("Along the line", "mm"),), (Subplot(y, [mark], height),))


def write_sheet_picture(sheet: DataSheet, stem: Path) -> None:
    """Draw positioning, circle and steps as stem.png and stem.svg."""
    from motionfmu.report.matplotlib_figure import write_picture

    left: list[Diagram] = [
        positioning_chart(a, LOW) for a in sheet.axes if a.positioning is not None
    ][:4]
    right: list[Diagram] = []
    if sheet.robot is not None:
        left.append(line_chart(sheet.robot, LOW))
    if any(a.loops for a in sheet.axes):
        right.append(step_chart(sheet, LOW))
    right += [polar_chart(c) for c in list(sheet.circles.values())[:1]]
    columns = [c for c in (left, right) if c]
    if columns:
        write_picture(stem, f"{sheet.name}: figures from runs", sheet.about, *columns)
        _with_few_colors(stem.with_suffix(".png"))


def _with_few_colors(file: Path) -> None:
    """The same picture with a palette, a quarter of the size, as it stands in a README."""
    from PIL import Image  # what matplotlib writes pictures with

    with Image.open(file) as drawn:
        # an octree keeps the colour of a thin line, which the median cut gives away
        octree, none = Image.Quantize.FASTOCTREE, Image.Dither.NONE
        few = drawn.convert("RGB").quantize(COLORS, octree, dither=none)
    few.save(file, optimize=True)
