"""The report of a run without a contour: its verdict and its signals over time."""

from collections.abc import Mapping, Sequence
from html import escape
from typing import Any, Protocol

from motionfmu.report.charts import add_charts
from motionfmu.report.sheet import Frame, Sheet
from motionfmu.report.tables import Check, check_table, warning_list
from motionfmu.run.figures import Chart

FOOTER = "A point holds the outputs at its communication step, before that step was taken."


class Result(Protocol):
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
    def signals(self) -> Mapping[str, Any]:
        """What was recorded, by name."""

    @property
    def no_contour(self) -> str:
        """Why the run has no contour; empty if it has one or wants none."""

    @property
    def warnings(self) -> Sequence[str]:
        """What FMUs and runner warned of."""

    def figures(self) -> Sequence[Chart]:
        """The figures that the scenario asks for."""

    def overview(self) -> Sequence[Chart]:
        """A figure of each recorded signal."""


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
    shown = charts or result.overview()
    add_charts(page, shown, pictures=bool(charts))
    footer = FOOTER
    if not charts and len(shown) < len(result.signals):
        footer += f" {len(shown)} of {len(result.signals)} recorded signals are shown."
    return page.text(Frame(result.name, result.about, "report", result.checks, footer))
