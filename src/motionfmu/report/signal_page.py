"""The report of a run without a contour: its verdict and its signals over time."""

from collections.abc import Sequence
from functools import partial
from html import escape

from motionfmu.report.cycle_time_section import add_axes, add_cycle_time
from motionfmu.report.html_page import Page, PageFrame
from motionfmu.report.html_tables import check_table, expected_table, warning_list
from motionfmu.report.iso9283_section import add_iso9283
from motionfmu.report.limit_section import add_limit_use
from motionfmu.report.record_section import add_record
from motionfmu.report.report_input import ReportInput
from motionfmu.report.run_summary import RunSummary, add_speed, add_summary
from motionfmu.report.sample_files import SampleFiles
from motionfmu.report.signal_chart import add_charts
from motionfmu.report.signal_words import of_check
from motionfmu.report.tool_section import add_tools
from motionfmu.report.view.deviations import from_cycles
from motionfmu.report.view.scene import DeviationLine, no_arm, scene_of
from motionfmu.report.view_section import SCRIPTS, add_view
from motionfmu.run.checks import NOTHING, tally
from motionfmu.run.figures import Chart

FOOTER = "A point holds the outputs at its communication step, before that step was taken."


def deviations(result: ReportInput) -> list[DeviationLine]:
    """Lines of the run's cycles, if it has an [iso9283] table."""
    asked = result.resolver.document.body.iso9283 is not None and not result.no_iso9283
    return from_cycles(result.iso9283().path) if asked else []


def add_performance(page: Page, result: ReportInput) -> None:
    """Add the figures after ISO 9283, or why there are none, if the scenario asks for them."""
    if result.resolver.document.body.iso9283 is None:
        return
    if result.no_iso9283:
        page.section("Path performance", escape(result.no_iso9283), "")
    else:
        add_iso9283(page, result.iso9283())


def add_record_over_run(page: Page, result: ReportInput) -> None:
    """Add the record over the run, or why it is not over it, if the scenario has one to lay."""
    table = result.resolver.document.body.record_file
    if table is None or not table.over:
        return
    if result.no_record:
        page.section("Record over run", escape(result.no_record), "")
    else:
        add_record(page, result.record_matches())


def add_verdict(page: Page, result: ReportInput) -> None:
    """Add the verdict, and what is expected of the scenario as written where that is not judged."""
    words = partial(of_check, result.resolver)
    count = tally(v.ok for v in result.checks)
    if count.judged:
        page.section("Verdict", "", check_table(result.checks, words))
    else:
        page.section("Verdict", f"{NOTHING.capitalize()}.", "")
    if count.open:
        note = (
            "Numbers of the scenario as it is written; this run is another one, so none is judged."
        )
        page.section("Expected as written", note, expected_table(result.checks, words))


def plain_text(
    result: ReportInput,
    charts: Sequence[Chart],
    ran: RunSummary,
    beside: SampleFiles | None = None,
) -> str:
    """The whole HTML page of a run without a contour."""
    # If there are no figures, the recorded signals are shown.
    page = Page(beside)
    add_verdict(page, result)
    add_summary(page, result, ran)
    if result.warnings:
        page.section("Warnings", "", warning_list(result.warnings))
    if result.no_contour:
        page.section("Contour error", escape(result.no_contour), "")
    views = add_view(page, scene_of(result, deviations(result)), missing=no_arm(result))
    add_performance(page, result)
    add_tools(page, result, ran.tools)
    if ran.use is not None:
        add_limit_use(page, result.time, ran.use)
    add_axes(page, ran.axes)
    if ran.plan is not None:
        add_cycle_time(page, ran.plan)
    add_record_over_run(page, result)
    shown = charts or result.overview()
    add_charts(page, shown, pictures=bool(charts))
    add_speed(page, ran)
    footer = FOOTER
    if not charts and len(shown) < len(result.signals):
        footer += f" {len(shown)} of {len(result.signals)} recorded signals are shown."
    frame = PageFrame(result.name, result.about, "report", result.checks, footer)
    return page.text(frame, SCRIPTS if views else (), **views)
