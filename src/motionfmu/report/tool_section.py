"""The tool beside its command as a section of the page."""

from collections.abc import Sequence
from html import escape

from motionfmu.report.html_page import Page
from motionfmu.report.html_tables import table
from motionfmu.report.numbers import figure, length
from motionfmu.report.report_input import ReportInput
from motionfmu.report.time_charts import gap_chart
from motionfmu.run.tool_gap import ToolGap


def add_tools(page: Page, result: ReportInput, found: Sequence[ToolGap]) -> None:
    """Add a section if controllers and machines of the run say where the tool is."""
    if not found:
        return
    note = (
        "How far the tool is from where the controller has it at the same instant: what drives lag"
        " along the path counts, and what the arm gives way."
    )
    content = table(("", "Largest", "at", "RMS"), [row for one in found for row in _rows(one)])
    for k, one in enumerate(found):
        content += page.place(f"tool{k}", gap_chart(result.time, one), True)
    page.section("Tool against command", note, content)


def _rows(one: ToolGap) -> list[tuple[str, ...]]:
    command, actual = map(escape, one.tool.position)
    distance, angle = one.sizes
    at = f"{distance.at:.3f} s"
    name = f"{actual} from {command}"
    rows: list[tuple[str, ...]] = [(name, length(distance.largest), at, length(distance.rms))]
    if angle is not None:
        turned = (f"{figure(angle.largest)}°", f"{angle.at:.3f} s", f"{figure(angle.rms)}°")
        rows.append(("orientation", *turned))
    return rows
