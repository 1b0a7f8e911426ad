"""The report of a run: an HTML page, a picture, and every number."""

from motionfmu.report.run_page import write_report

__all__ = ["write_report"]
