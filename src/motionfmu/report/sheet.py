"""An HTML page of sections and interactive plots that needs no network."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from importlib.resources import files
from string import Template
from typing import Any

import plotly.offline

from motionfmu.report.tables import Check


@dataclass(frozen=True)
class Frame:
    """What stands around the sections."""

    name: str  # of the scenario
    about: str  # what it shows
    kind: str  # of report
    checks: Sequence[Check]  # for the verdict beside the title
    footer: str  # HTML


class Sheet:
    """Sections and plots, as they are added."""

    def __init__(self) -> None:
        self.sections: list[str] = []
        self.plots: list[dict[str, Any]] = []

    def place(self, name: str, drawn: dict[str, Any], over_time: bool = False) -> str:
        """Add a plotly plot; give its HTML element, for a section."""
        # Those over time are zoomed together.
        self.plots.append({"id": name, "over_time": over_time} | drawn)
        return f'<div id="{name}" style="min-height:{drawn["layout"]["height"]}px"></div>'

    def section(self, title: str, note: str, content: str) -> None:
        """Add a section of HTML; the note may be empty."""
        note = f'<p class="note">{note}</p>' if note else ""
        self.sections.append(f"<section><h2>{title}</h2>{note}{content}</section>")

    def text(self, frame: Frame, scripts: Sequence[str] = (), **data: Any) -> str:
        """The whole page; scripts that follow page.js, data for them."""
        here = files("motionfmu.report")
        everything = {"figures": self.plots} | data
        run = [(here / s).read_text(encoding="utf-8") for s in ("page.js", *scripts)]
        return Template((here / "page.html").read_text(encoding="utf-8")).substitute(
            title=escape(f"{frame.name}: {frame.kind}"),
            kicker=escape(f"motionfmu {frame.kind}"),
            name=escape(frame.name),
            about=escape(frame.about),
            verdict=_verdict(frame.checks),
            footer=frame.footer,
            body="\n".join(self.sections),
            style=(here / "page.css").read_text(encoding="utf-8"),
            script="\n".join(run),
            plotly=plotly.offline.get_plotlyjs(),
            # "</" would end the script element
            data=json.dumps(everything, separators=(",", ":")).replace("</", "<\\/"),
        )


def _verdict(checks: Sequence[Check]) -> str:
    failed = sum(not c.ok for c in checks)
    if not checks:
        return ""
    if failed:
        return f'<span class="pill fail">✗ {failed} of {len(checks)} checks failed</span>'
    return f'<span class="pill pass">✓ all {len(checks)} checks passed</span>'
