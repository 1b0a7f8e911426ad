"""What a report needs to know of a run."""

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

from motionfmu.analysis.iso9283 import Evaluation
from motionfmu.run.checks import Verdict
from motionfmu.run.figures import Chart
from motionfmu.run.record_matches import RecordMatches
from motionfmu.run.run_plan import RunPlan
from motionfmu.run.run_record import RunRecord


class ReportInput(RunRecord, Protocol):
    """A run beside its contour; `motionfmu.Result` is one."""

    @property
    def name(self) -> str:
        """Name of the scenario."""

    @property
    def about(self) -> str:
        """What the scenario shows."""

    @property
    def checks(self) -> Sequence[Verdict]:
        """The verdicts of its checks."""

    @property
    def scenario(self) -> RunPlan:
        """The scenario that was run."""

    @property
    def options(self) -> Mapping[str, Any]:
        """The options with which it was run."""

    @property
    def overrides(self) -> Sequence[str]:
        """The values with which the run departs from the scenario as written."""

    @property
    def stopped(self) -> str:
        """The reason for which the run ended."""

    @property
    def done_at(self) -> float | None:
        """When the program was done [s]."""

    @property
    def no_contour(self) -> str:
        """Why the run has no contour; empty if it has one or wants none."""

    @property
    def warnings(self) -> Sequence[str]:
        """The warnings of FMUs and of the runner, as a list."""

    def figures(self) -> Sequence[Chart]:
        """The figures that the scenario asks for."""

    @property
    def no_iso9283(self) -> str:
        """Why the run has no figures after ISO 9283; empty if it has them or wants none."""

    def iso9283(self) -> Evaluation:
        """Its figures after ISO 9283."""

    @property
    def no_record(self) -> str:
        """Why the record is not over the run; empty if it is or there is none."""

    def record_matches(self) -> RecordMatches:
        """The scenario's record over the run."""

    def overview(self) -> Sequence[Chart]:
        """A figure of each recorded signal."""
