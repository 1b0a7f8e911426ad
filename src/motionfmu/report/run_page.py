"""The report as one HTML page that needs no network."""

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path

from motionfmu.analysis.contour import ContourResult
from motionfmu.analysis.contour.circles import CircularTest
from motionfmu.base.axis_names import ControllerAxis
from motionfmu.report.cycle_time_section import add_axes, add_cycle_time
from motionfmu.report.error_path import ErrorPath, draw
from motionfmu.report.html_page import Page, PageFrame
from motionfmu.report.html_tables import (
    RMS,
    SHOWN,
    cards,
    circle_table,
    corner_table,
    error_table,
    line_table,
    picture_buttons,
    warning_list,
)
from motionfmu.report.iso9283_section import write_iso9283
from motionfmu.report.limit_section import add_limit_use
from motionfmu.report.numbers import figure, length
from motionfmu.report.path_chart import outlier_words, path_chart, path_titles
from motionfmu.report.polar_chart import polar_chart
from motionfmu.report.report_input import ReportInput
from motionfmu.report.run_summary import RunSummary, add_speed, add_summary, as_written, summary_of
from motionfmu.report.sample_files import SampleFiles
from motionfmu.report.signal_chart import add_charts, write_charts
from motionfmu.report.signal_page import (
    add_performance,
    add_record_over_run,
    add_verdict,
    deviations,
    plain_text,
)
from motionfmu.report.signal_words import titled
from motionfmu.report.time_charts import (
    error_chart,
    fifo_chart,
    following_chart,
    trace_charts,
)
from motionfmu.report.tool_section import add_tools
from motionfmu.report.typed_arrays import packed
from motionfmu.report.view.deviations import from_contour
from motionfmu.report.view.scene import no_arm, scene_of
from motionfmu.report.view_section import SCRIPTS as VIEW
from motionfmu.report.view_section import add_view
from motionfmu.run.figures import Chart
from motionfmu.run.result_files import json_of

PAGE = "report.html"
NUMBERS = "contour.json"
CIRCLES_SHOWN = 6
MAGNIFICATIONS = [m * 10**p for p in range(6) for m in (1, 2, 5)]
FOOTER = (
    "The contour error is the distance of the actual position from the nearest point of the exact"
    " programmed geometry (lines, arcs, helices), on the part of the path that is being cut."
    " {sign}Rapids and standstill are not counted. The command error is the same for the pulses"
    " the card put out: chords between interpolation points, rounding to pulses, blended corners."
    ' Every number of this analysis is in <a href="contour.json">contour.json</a>.'
)


@dataclass(frozen=True)
class ReportFiles:
    """The files that stand beside the page of a run."""

    pictures: bool = False
    samples: bool = True  # of curves of more than a page can hold


def write_report(
    result: ReportInput,
    contour: ContourResult | None,
    folder: str | Path,
    ran: RunSummary | None = None,
    pictures: bool = False,
) -> Path:
    """Write the page and the contour's numbers of a run.

    Parameters
    ----------
    result : ReportInput
        Name, purpose, verdicts and figures of the scenario.
    contour : ContourResult or None
        The analysed run; None without a contour.
    folder : str or Path
        Made if it is not there; gets report.html, and with a contour contour.json.
    ran : RunSummary, optional
        How the run went, if it was looked at before.
    pictures : bool
        Also as files what the page draws: figure1.png, figure1.svg and so on, with a contour
        path.svg and path.png, with figures after ISO 9283 iso9283.svg and iso9283.png.

    Returns
    -------
    Path
        The page.

    Raises
    ------
    OSError
        The folder cannot be written.
    """
    return write_files(result, contour, Path(folder), ran, ReportFiles(pictures))


def write_files(
    result: ReportInput,
    contour: ContourResult | None,
    folder: Path,
    ran: RunSummary | None,
    wanted: ReportFiles,
) -> Path:
    """Write the page of a run, with the files that are wanted beside it."""
    beside = SampleFiles(folder) if wanted.samples else None
    charts = as_written(result, result.figures())
    ran = ran or summary_of(result, contour)
    if contour is None:
        page = plain_text(result, charts, ran, beside)
        folder.mkdir(parents=True, exist_ok=True)
    else:
        drawing = draw(contour)
        page = page_text((result, ran), contour, drawing, charts, beside)
        numbers = json_of(contour.numbers())
        folder.mkdir(parents=True, exist_ok=True)
        if wanted.pictures:
            from motionfmu.report.matplotlib_figure import write_picture

            titles = path_titles(result.name, contour, drawing)
            write_picture(folder / "path", *titles, path_chart(drawing))
        (folder / NUMBERS).write_text(numbers + "\n", encoding="utf-8")
    if wanted.pictures:
        write_charts(charts, folder)
        if result.resolver.document.body.iso9283 is not None and not result.no_iso9283:
            write_iso9283(result.name, result.iso9283(), folder)
    (folder / PAGE).write_text(page, encoding="utf-8")
    return folder / PAGE


def page_text(
    run: tuple[ReportInput, RunSummary],
    contour: ContourResult,
    drawing: ErrorPath,
    charts: Sequence[Chart],
    beside: SampleFiles | None = None,
) -> str:
    """The whole HTML page of a run with a contour."""
    result, ran = run
    page = Page(beside)
    page.sections.append(_cards(contour))
    _add_path(page, contour, drawing, result.scenario.document.controller_axes)
    add_verdict(page, result)
    add_summary(page, result, ran)
    if result.warnings:
        page.section("Warnings", "", warning_list(result.warnings))
    lines = deviations(result) or [from_contour(contour)]
    views = add_view(page, scene_of(result, lines, contour.cutting), missing=no_arm(result))
    add_performance(page, result)
    add_tools(page, result, ran.tools)
    if ran.use is not None:
        add_limit_use(page, result.time, ran.use)
    add_axes(page, ran.axes)
    if ran.plan is not None:
        add_cycle_time(page, ran.plan)
    for i, test in enumerate(contour.circles[:CIRCLES_SHOWN]):
        _add_circle(page, f"circle{i}", test)
    add_speed(page, ran)
    _add_time(page, result, contour)
    add_record_over_run(page, result)
    add_charts(page, charts)
    _add_corners(page, contour)
    path = {
        "foot": [packed(c) for c in drawing.foot.T],
        "gap": [packed(c) for c in drawing.shown.T],
        "hairs": packed(drawing.hairs),
        "outliers": packed(drawing.outliers),
    }
    sign = "Positive is to the left of the direction of travel, negative to the right. "
    footer = FOOTER.format(sign="" if contour.track.signed is None else sign)
    frame = PageFrame(result.name, result.about, "contour report", result.checks, footer)
    return page.text(frame, ["path.js", *(VIEW if views else ())], path=path, **views)


def _cards(contour: ContourResult) -> str:
    error, command = contour.error, contour.command_error
    lag = f"{figure(contour.lag * 1e3)} ms"
    gain = f"as a position gain of {figure(1.0 / contour.lag)} 1/s" if contour.lag > 0 else ""
    rows = [
        ("Largest contour error", length(error.max), f"line {error.line}, at {error.time:.3f} s"),
        ("RMS contour error", length(error.rms), f"{RMS}; 95 % below {length(error.p95)}"),
        ("Largest command error", length(command.max), f"RMS {length(command.rms)}"),
        ("Servo lag", lag, gain),
    ]
    if contour.circles:
        test = contour.circles[0]
        way = test.ccw or test.cw
        assert way is not None
        g = test.both.g if test.both else way.reading.g
        change = length(way.reading.radius_change, sign=True)
        name = "Circular deviation G(b)" if test.both else "Circular deviation G"
        rows.append((name, length(g), f"radius change {change}"))
    return cards(rows)


def _add_path(
    page: Page, contour: ContourResult, drawing: ErrorPath, axes: Sequence[ControllerAxis]
) -> None:
    factor = drawing.magnify
    choices = "".join(
        f'<option value="{m}"{" selected" if m == factor else ""}>&times; {m:,}</option>'
        for m in MAGNIFICATIONS
    )
    control = (
        '<div class="control"><label for="magnification">Magnification</label>'
        '<button id="less" type="button" aria-label="less">&minus;</button>'
        f'<select id="magnification">{choices}</select>'
        '<button id="more" type="button" aria-label="more">+</button></div>'
    )
    note = (
        f"The contour error is drawn <b><span data-magnification>{factor:,.0f}</span> times</b> as"
        f" large as it is; colour is its true size. {outlier_words(drawing)}"
    )
    plot = page.place("path", path_chart(drawing)) + picture_buttons("path")
    errors = error_table(contour, axes)
    left = f"<div>{control}{plot}</div>"
    right = f"<h3>Errors</h3>{errors}<h3>Worst lines</h3>{line_table(contour)}"
    content = f'<div class="wide">{left}<div>{right}</div></div>'
    page.section("Path and contour error", note, content)


def _add_circle(page: Page, name: str, test: CircularTest) -> None:
    lines = sorted({n for way in (test.ccw, test.cw) if way for n in way.lines})
    where = "line " + str(lines[0]) if len(lines) == 1 else f"lines {lines[0]} to {lines[-1]}"
    title = f"Circular test, radius {test.radius:g} mm"
    note = (
        f"ISO 230-4, {where}. Radial deviation from the nominal circle about its nominal centre;"
        " the rings are labelled with their deviation."
    )
    plot = page.place(name, polar_chart(test))
    page.section(title, note, f'<div class="two">{plot}<div>{circle_table(test)}</div></div>')


def _add_time(page: Page, result: ReportInput, contour: ContourResult) -> None:
    axes = result.scenario.document.controller_axes
    names = [a.name if a.unit == "mm" else f"{a.name} (1 mm for 1{a.unit})" for a in axes]
    sign = "" if contour.track.signed is None else " Positive is left of the direction of travel."
    zoom = " Zooming one plot zooms all plots over time."
    note = "Where the tool is cutting." + sign + zoom
    page.section("Contour error", note, page.place("error", error_chart(contour), True))
    note = "Pulses put out minus actual position."
    content = page.place("following", following_chart(contour, names), True)
    page.section("Following error", note, content)
    fifo = fifo_chart(contour)
    if fifo is not None:
        note = "Least stock of the axes in use; an empty FIFO during motion means the PC was late."
        page.section("FIFO and interrupts", note, page.place("fifo", fifo, True))
    for i, (title, drawn) in enumerate(trace_charts(contour, names)):
        content = page.place(f"trace{i}", drawn, True)
        doc = result.resolver.end(title, "", "").port.doc
        page.section(escape(titled(title, doc)), "", content)


def _add_corners(page: Page, contour: ContourResult) -> None:
    if contour.corners:
        count = len(contour.corners)
        more = f", worst {SHOWN} of {count}" if count > SHOWN else ""
        page.section(f"Corners{more}", "", corner_table(contour))
