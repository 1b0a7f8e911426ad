"""The report of a run without a contour: its verdict and its signals over time."""

from collections.abc import Sequence
from html import escape
from typing import Protocol

from motionfmu.iso9283 import Evaluation
from motionfmu.report.charts import add_charts
from motionfmu.report.iso9283_section import add_iso9283
from motionfmu.report.sheet import Frame, Sheet
from motionfmu.report.tables import Check, check_table, warning_list
from motionfmu.report.view_section import SCRIPTS, add_view
from motionfmu.run.figures import Chart
from motionfmu.run.recorded import Recorded
from motionfmu.view.deviations import from_cycles
from motionfmu.view.scene import Line, scene_of

FOOTER = "A point holds the outputs at its communication step, before that step was taken."


class Result(Recorded, Protocol):
    """What the report needs to know of a run beside its contour."""

    @property
    def name(self) -> str:
        """Name of the scenario."""

    @property
    def about(self) -> str:
        """What the scenario shows."""

    @property
    def checks(self) -> Sequence[Check]:
        """Its verdicts."""

    @property
    def no_contour(self) -> str:
        """Why the run has no contour; empty if it has one or wants none."""

    @property
    def warnings(self) -> Sequence[str]:
        """What FMUs and runner warned of."""

    def figures(self) -> Sequence[Chart]:
        """The figures that the scenario asks for."""

    @property
    def no_iso9283(self) -> str:
        """Why the run has no figures after ISO 9283; empty if it has them or wants none."""

    def iso9283(self) -> Evaluation:
        """Its figures after ISO 9283."""

    def overview(self) -> Sequence[Chart]:
        """A figure of each recorded signal."""


def deviations(result: Result) -> list[Line]:
    """Lines of the run's cycles, if it has an [iso9283] table."""
    asked = result.resolver.document.body.iso9283 is not None and not result.no_iso9283
    return from_cycles(result.iso9283().path) if asked else []


def add_performance(page: Sheet, result: Result) -> None:
    """Add the figures after ISO 9283, or why there are none, if the scenario asks for them."""
    if result.resolver.document.body.iso9283 is None:
        return
    if result.no_iso9283:
        page.section("Path performance", escape(result.no_iso9283), "")
    else:
        add_iso9283(page, result.iso9283())


def plain_text(result: Result, charts: Sequence[Chart]) -> str:
    """The whole HTML page of a run without a contour."""
    # If there are no figures, the recorded signals are shown.
    page = Sheet()
    if result.checks:
        page.section("Verdict", "", check_table(result.checks))
    if result.warnings:
        page.section("Warnings", "", warning_list(result.warnings))
    if result.no_contour:
        page.section("Contour error", escape(result.no_contour), "")
    views = add_view(page, scene_of(result, deviations(result)))
    add_performance(page, result)
    shown = charts or result.overview()
    add_charts(page, shown, pictures=bool(charts))
    footer = FOOTER
    if not charts and len(shown) < len(result.signals):
        footer += f" {len(shown)} of {len(result.signals)} recorded signals are shown."
    frame = Frame(result.name, result.about, "report", result.checks, footer)
    return page.text(frame, SCRIPTS if views else (), **views)
