"""The page of a calibration: what was found, how sure it is, and what it leaves."""

import math
from collections.abc import Sequence
from html import escape

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.units import spelled
from motionfmu.calibrate import (
    ArmCalibration,
    AxisCalibration,
    CircleCalibration,
    CircleErrors,
    LeadError,
    MachineCalibration,
    PoseFit,
)
from motionfmu.calibrate.estimate import Estimate
from motionfmu.report.diagram import (
    DASH,
    DOT,
    Diagram,
    LevelMark,
    LineMark,
    Mark,
    PointMark,
    Scale,
    Subplot,
)
from motionfmu.report.html_page import Page, PageFrame
from motionfmu.report.html_tables import cards, table
from motionfmu.report.numbers import figure, length
from motionfmu.report.polar_chart import deviation_line, polar_rings
from motionfmu.report.style import AXES, CCW, CW, INK, MUTED, RAPID

Array = NDArray[np.float64]
UP, DOWN = AXES[0], AXES[1]
POINTS, HIGH, LOW = 600, 240, 150  # of a curve; [pixel] of a plot
BEFORE, AFTER, CONTROLLER = RAPID, AXES[0], AXES[1]
FIGURES = ("A", "E", "R", "B", "M")
FOOTER = (
    "Found by <code>motionfmu calibrate</code>. Every number is in"
    ' <a href="result.json">result.json</a>; use the values with'
    " <code>motionfmu run SCENARIO --set found.toml</code>, with the compensation"
    " <code>--set compensated.toml</code>."
)


def machine_page(found: MachineCalibration) -> str:
    """The whole HTML page of a machine tool."""
    page = Page()
    page.sections.append(cards(_machine_cards(found)))
    if found.parameters:
        note = "Standard deviations are those of the records; of one that was left the value stays."
        page.section("What was found", note, _parameters(found))
    for axis in found.axes:
        _add_axis(page, axis)
    for circle in found.circles:
        _add_circle(page, circle)
    _add_notes(page, found.notes)
    return page.text(PageFrame(found.machine, found.about, "calibration", [], FOOTER))


def _add_notes(page: Page, notes: Sequence[str]) -> None:
    if notes:
        page.section("To be known", "", "".join(f"<p>{escape(n)}</p>" for n in notes))


def _machine_cards(found: MachineCalibration) -> list[tuple[str, str, str]]:
    rows = []
    for a in found.axes:
        now = a.error.test.figures()["A"]
        words = "ISO 230-2, as measured"
        if a.after is not None:
            then = a.after.test.figures()["A"]
            words = f"compensated {length(then)}, by the FMUs: {now / then:.3g} times less"
        rows.append((f"A of {a.name}", length(now), words))
    for c in found.circles:
        square = c.errors.squareness
        shown = f"{square.text(1e6)} µrad"
        rows.append((f"Squareness {c.record.plane}", shown, "90° and so much between the axes"))
    return rows


# Units of parameters as they read well.
_READ = {"m": (1e6, "µm"), "1": (1e6, "µm/m"), "rad": (1e6, "µrad"), "mm": (1e3, "µm")}


def _shown(e: Estimate, part: str) -> tuple[float, str]:
    """Factor and unit in which a value reads well."""
    if e.unit == "m" and "period" in part:
        return 1e3, "mm"
    if e.unit == "rad" and "phase" in part:
        return 180.0 / math.pi, "°"
    return _READ.get(e.unit, (1.0, spelled(e.unit)))


def _parameters(found: MachineCalibration) -> str:
    rows = []
    for p in found.parameters:
        factor, unit = _shown(p.found, p.part)
        title = f'{escape(p.part)}<div class="sub">{escape(p.name)}</div>'
        value = p.found.text(factor) if p.found.told else f"left: {escape(p.found.why)}"
        rows.append([title, unit, figure(p.before * factor), value, escape(p.record)])
    return table(["quantity", "unit", "before", "found", "record"], rows, 2)


def _add_axis(page: Page, axis: AxisCalibration) -> None:
    test, error = axis.error.test, axis.error
    note = (
        f"{escape(axis.record.name)}: {len(test.targets)} targets, {len(test.up)} approaches from"
        " either side. Points are approaches, the line is what was found: slope"
        + (", wave" if error.amplitude.told else "")
        + f" and backlash; it leaves {length(error.rest)} rms at the targets."
    )
    if axis.table is not None:
        note += " Crosses are the points of the table, with their sign turned."
    content = page.place(f"axis{axis.name}", _deviations(axis))
    page.section(f"Axis {axis.name}", note, content + _figures(axis))


def _figures(axis: AxisCalibration) -> str:
    """ISO 230-2 of the record, of the FMUs, and compensated."""
    rows = []
    sides = ("record", axis.error), ("FMUs with what was found", axis.run)
    for words, side in (*sides, ("FMUs, compensated", axis.after)):
        if side is not None:
            found = side.test.figures()
            rows.append([words, *(length(found[k]) for k in FIGURES)])
    return table(["ISO 230-2", *FIGURES], rows, 1)


def _deviations(axis: AxisCalibration) -> Diagram:
    """Deviations over the position, with the fit and the table; below it what is left."""
    error = axis.error
    test = error.test
    x = np.linspace(test.targets[0], test.targets[-1], POINTS)
    marks: list[Mark] = []
    sides = ("upwards", test.up, UP, -0.5), ("downwards", test.down, DOWN, 0.5)
    for name, runs, color, side in sides:
        at = np.tile(test.targets, len(runs))
        marks.append(PointMark(at, runs.ravel() * 1e3, name, color, size=5.0))
        fit = error.mean(x) + side * error.backlash.value
        marks.append(LineMark(x, fit * 1e3, f"{name}, found", color, 1.6))
    if axis.table is not None:
        marks += _crosses(axis)
    low = _left(error)
    title = "left by the fit [µm]"
    if axis.after is not None:
        low, title = _of_test(axis.after), "compensated [µm]"
    low.append(LevelMark(0.0, color=MUTED))
    return Diagram(
        (Scale(f"{axis.name}", "mm"),),
        (Subplot(Scale("deviation [µm]"), marks, HIGH), Subplot(Scale(title), low, LOW)),
    )


def _crosses(axis: AxisCalibration) -> list[Mark]:
    """The table as it takes deviations away; the laser is zero where it corrects nothing."""
    assert axis.table is not None
    places = axis.table.places(axis.pulse)
    test = axis.error.test
    inside = (places >= test.targets[0]) & (places <= test.targets[-1])
    zero = float(np.interp(0.0, test.targets, test.means[0]))
    listed: list[Mark] = []
    for rows in (axis.table.forward, axis.table.backward):
        values = (zero - rows[inside] * axis.pulse) * 1e3
        name = "" if listed else "compensation"
        listed.append(PointMark(places[inside], values, name, INK, "x", 5.0))
    return listed


def _left(error: LeadError) -> list[Mark]:
    test = error.test
    marks: list[Mark] = []
    for k, (name, color) in enumerate((("upwards", UP), ("downwards", DOWN))):
        side = -0.5 if k == 0 else 0.5
        rest = test.means[k] - error.mean(test.targets) - side * error.backlash.value
        marks.append(LineMark(test.targets, rest * 1e3, name, color, 1.4))
    return marks


def _of_test(error: LeadError) -> list[Mark]:
    rows = zip(("upwards", "downwards"), error.test.means, (UP, DOWN), strict=True)
    return [LineMark(error.test.targets, m * 1e3, n, c, 1.4) for n, m, c in rows]


def _add_circle(page: Page, circle: CircleCalibration) -> None:
    errors, name = circle.errors, circle.record.plane
    note = (
        f"{escape(circle.record.name)}: radius {errors.test.radius:g} mm, both ways round. Dashed"
        f" is what was found; it leaves {length(errors.left)} rms, without what stands just behind"
        " the quadrants."
    )
    plots = (
        page.place(f"circle{name}", _circle(errors)),
        page.place(f"rest{name}", _circle_rest(circle)),
    )
    content = f'<div class="two">{plots[0]}{plots[1]}</div>{_circle_table(circle)}'
    page.section(f"Circle in {name}", note, content)


def _ways(errors: CircleErrors) -> list[tuple[NDArray[np.bool_], str, str]]:
    way = errors.fit.way
    return [(way > 0.0, "counter-clockwise", CCW), (way < 0.0, "clockwise", CW)]


def _circle(errors: CircleErrors) -> Diagram:
    """The record with what was found."""
    fit = errors.fit
    lines = []
    for rows, name, color in _ways(errors):
        angle = fit.angle[rows]
        lines.append(deviation_line(angle, fit.deviation[rows] * 1e3, name, color))
        found = (fit.columns @ fit.parts)[rows] * 1e3
        words = "" if len(lines) > 1 else "found"
        lines.append(deviation_line(angle, found, words, INK, DASH))
    return polar_rings(lines, errors.test.axes)


def _circle_rest(circle: CircleCalibration) -> Diagram:
    """What is left of the record: by the fit, and of the machine's own run by its fit."""
    lines = []
    errors = circle.errors
    for rows, name, color in _ways(errors):
        rest = errors.fit.rest[rows] * 1e3
        lines.append(deviation_line(errors.fit.angle[rows], rest, f"{name}, left", color))
    if circle.run is not None:
        fit = circle.run.fit
        for rows, name, _ in _ways(circle.run):
            rest = fit.rest[rows] * 1e3
            words = "" if name != "clockwise" else "left of the FMUs"
            lines.append(deviation_line(fit.angle[rows], rest, words, MUTED, DOT))
    return polar_rings(lines, errors.test.axes)


def _circle_table(circle: CircleCalibration) -> str:
    sides = [circle.errors, *([circle.run] if circle.run else [])]
    first, second = circle.record.plane[0], circle.record.plane[1]

    def row(words: str, unit: str, factor: float, pick: str, k: int = -1) -> list[str]:
        cells = []
        for side in sides:
            e = getattr(side, pick)
            cells.append((e if k < 0 else e[k]).text(factor))
        return [words, unit, *cells]

    rows = [
        row(f"squareness, angle from +{first} to +{second} less 90°", "µrad", 1e6, "squareness"),
        row(f"scale, {first} more than {second}", "µm/m", 1e6, "scale"),
        row(f"reversal of {first}", "µm", 1e3, "backlash", 0),
        row(f"reversal of {second}", "µm", 1e3, "backlash", 1),
        row("mismatch of gains, turns with the direction", "µm", 1e3, "mismatch"),
        row("mean radius", "µm", 1e3, "radius"),
        row(f"centre, {first}", "µm", 1e3, "centre", 0),
        row(f"centre, {second}", "µm", 1e3, "centre", 1),
    ]
    return table(["ISO 230-4", "unit", "record", "FMUs"][: 2 + len(sides)], rows, 2)


def arm_page(found: ArmCalibration) -> str:
    """The whole HTML page of an arm."""
    page = Page()
    numbers = found.numbers()["rms"]
    rows = [
        ("Before", length(numbers["before"]), "rms, with base and tool alone"),
        ("Controller", length(numbers["known"]), "with what a controller can know"),
        ("Found", length(numbers["after"]), "with all that was found"),
    ]
    if numbers["kept_back"] is not None:
        rows.append(("Kept back", length(numbers["kept_back"]), "poses that took no part"))
    page.sections.append(cards(rows))
    note = f"{escape(found.record.name)}: {len(found.record.joints)} poses."
    page.section("Distance from the measured place", note, page.place("poses", _poses(found)))
    told = {n: e for n, e in found.parameters.items() if e.told}
    note = (
        f"Observability index O1 {found.after.index:.3g}, condition number"
        f" {found.after.condition:.3g} of the scaled columns. What was found holds with what was"
        " left as it was."
    )
    listed = [[escape(n), *_value(e, n, found)] for n, e in told.items()]
    page.section(
        "What was found", note, table(["quantity", "unit", "change", "plant then"], listed, 2)
    )
    left = [[escape(n), escape(e.why)] for n, e in found.parameters.items() if not e.told]
    if left:
        words = "Of two that move the tool alike one is found, the other stays as it was."
        page.section("What was left", words, table(["quantity", "why"], left, 2))
    heads = [f"J{k + 1} [°]" for k in range(found.next_poses.shape[1])]
    moved = [[f"{v:.1f}" for v in row] for row in found.next_poses.tolist()]
    words = "Poses within the range of these that lessen the deviations most, one after another."
    page.section("Poses that would help", words, table(heads, moved, 0))
    _add_notes(page, found.notes)
    frame = PageFrame(found.machine, found.about, "calibration", [], FOOTER)
    return page.text(frame)


def _value(e: Estimate, name: str, found: ArmCalibration) -> list[str]:
    """Unit, value, and what the plant has then."""
    factor, unit = (1.0, "mm") if e.unit == "mm" else (180.0 / math.pi, "°")
    array, _, element = name.partition("[")
    values = found.settings.get(f"{found.component}.{array}")
    if values is None:
        return [unit, e.text(factor), ""]
    places = [int(n) for n in element.rstrip("]").split(",")]
    index = places[0] - 1 if len(places) == 1 else 3 * (places[0] - 1) + places[1] - 1
    scale = 1e3 if e.unit == "mm" else factor
    return [unit, e.text(factor), f"{values[index] * scale:.4g}"]


def _poses(found: ArmCalibration) -> Diagram:
    """Distances by pose."""
    number = np.arange(1.0, len(found.record.joints) + 1.0)
    sides: list[tuple[str, PoseFit, str]] = [
        ("base and tool alone", found.before, BEFORE),
        ("what a controller can know", found.known, CONTROLLER),
        ("all that was found", found.after, AFTER),
    ]
    marks: list[Mark] = [PointMark(number, f.sizes, name, c, size=7.0) for name, f, c in sides]
    if np.isfinite(found.kept_back).all():
        marks.append(PointMark(number, found.kept_back, "kept back", INK, "ring", 8.0))
    largest = float(found.before.sizes.max())
    factor = (1.0, "mm") if largest >= 0.1 else (1e3, "µm")
    if factor[0] != 1.0:
        marks = [
            PointMark(m.x, m.y * factor[0], m.name, m.color, m.symbol, m.size)
            for m in marks
            if isinstance(m, PointMark)
        ]
    return Diagram(
        (Scale("pose"),), (Subplot(Scale("distance", factor[1], floor=True), marks, HIGH),)
    )
