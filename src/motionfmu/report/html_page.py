"""An HTML page of sections and interactive plots that needs no network."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from hashlib import sha256
from html import escape
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path
from string import Template
from typing import Any

from motionfmu.report.diagram import Diagram
from motionfmu.report.plotly_figure import plotly_figure
from motionfmu.report.samples import Samples, bits, clock
from motionfmu.run.checks import Verdict, tally

# The name of the cursors that all plots over the time of one run share.
RUN = "run"
SCRIPTS = ("samples.js", "cursors.js", "page.js")


@dataclass(frozen=True)
class PageFrame:
    """The parts of a page around its sections: head, verdict and footer."""

    name: str  # of the scenario
    about: str  # what it shows
    kind: str  # of report
    checks: Sequence[Verdict]  # for the verdict beside the title
    footer: str  # HTML


class Page:
    """The sections and plots of a page, in the order in which they are added."""

    def __init__(self) -> None:
        self.sections: list[str] = []
        self.plots: list[dict[str, Any]] = []
        self.times: list[dict[str, Any]] = []
        self._known: dict[bytes, int] = {}

    def place(self, name: str, diagram: Diagram, over_time: bool = False, cursors: str = "") -> str:
        """Add the plot of a diagram and give its HTML element, which goes into a section."""
        # Plots over time are zoomed together and share the cursors of the run. Any other plot with
        # curves of samples may have cursors, too: plots with one name for them share them.
        drawn = plotly_figure(diagram)
        data = [self._trace(trace) for trace in drawn["data"]]
        more = {"over_time": over_time, "cursors": cursors or (RUN if over_time else "")}
        self.plots.append({"id": name, "data": data, "layout": drawn["layout"]} | more)
        height = drawn["layout"]["height"]
        return f'<div class="plot"><div id="{name}" style="min-height:{height}px"></div></div>'

    def _trace(self, trace: dict[str, Any]) -> dict[str, Any]:
        """A trace as the page's script takes it: samples packed, times named."""
        whole: Samples | None = trace.get("samples")
        if whole is None:
            return trace
        few = whole.few()
        key = sha256(few.time.tobytes()).digest()
        if key not in self._known:
            self._known[key] = len(self.times)
            self.times.append(clock(few.time))
        samples = {"time": self._known[key], "values": bits(few.values)}
        samples |= {"steps": few.steps, "dots": few.dots, "all": few.all}
        if few.lines is not None:
            samples["lines"] = bits(few.lines)
        return trace | {"samples": samples}

    def section(self, title: str, note: str, content: str) -> None:
        """Add a section of HTML; the note may be empty."""
        note = f'<p class="note">{note}</p>' if note else ""
        self.sections.append(f"<section><h2>{title}</h2>{note}{content}</section>")

    def text(self, frame: PageFrame, scripts: Sequence[str] = (), **data: Any) -> str:
        """The whole page as HTML, with scripts that follow page.js and the data they read."""
        here = files("motionfmu.report")
        everything = {"figures": self.plots, "times": self.times} | data
        run = [(here / s).read_text(encoding="utf-8") for s in (*SCRIPTS, *scripts)]
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
            plotly=_plotly(),
            # "</" would end the script element
            data=json.dumps(everything, separators=(",", ":")).replace("</", "<\\/"),
        )


def _plotly() -> str:
    """The script that draws plots: the wheel's, else that of plotly's package."""
    own = Path(__file__).parent / "plotly"
    if not own.is_dir():
        found = find_spec("plotly")
        assert found is not None and found.submodule_search_locations
        own = Path(found.submodule_search_locations[0]) / "package_data"
    return (own / "plotly.min.js").read_text(encoding="utf-8")


def _verdict(checks: Sequence[Verdict]) -> str:
    if not checks:
        return ""
    judged = tally(c.ok for c in checks)
    kind, mark = ("fail", "✗ ") if judged.failed else ("pass", "✓ ") if judged.judged else ("", "")
    return f'<span class="pill {kind}">{mark}{judged.words}</span>'
