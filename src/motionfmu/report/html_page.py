"""An HTML page of sections and interactive plots that needs no network."""

import json
import re
from collections.abc import Sequence
from dataclasses import dataclass
from hashlib import sha256
from html import escape
from importlib.resources import files
from string import Template
from typing import Any

from motionfmu.report.diagram import Diagram
from motionfmu.report.plotly_figure import plotly_figure
from motionfmu.report.plotly_script import packed_script, packed_text
from motionfmu.report.sample_files import SampleFiles
from motionfmu.report.samples import Samples, bits, clock
from motionfmu.report.style import dark_colors
from motionfmu.run.checks import Verdict, tally
from motionfmu.run.decimate import MOST

# The name of the cursors that all plots over the time of one run share.
QUICK = 1  # level of gzip: most of a page is packed samples already
RUN = "run"
# [bytes] of a page; samples of a curve that it has at least: of 150 curves fewer than 2000 fit.
LARGEST, FEWEST = 2_000_000, 200
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

    def __init__(self, beside: SampleFiles | None = None) -> None:
        self.beside = beside
        self.sections: list[str] = []
        self.contents: list[str] = []  # titles of the sections, as HTML
        self.plots: list[dict[str, Any]] = []

    def place(self, name: str, diagram: Diagram, over_time: bool = False, cursors: str = "") -> str:
        """Add the plot of a diagram and give its HTML element, which goes into a section."""
        # Plots over time are zoomed together and share the cursors of the run. Any other plot with
        # curves of samples may have cursors, too: plots with one name for them share them.
        drawn = plotly_figure(diagram)
        more = {"over_time": over_time, "cursors": cursors or (RUN if over_time else "")}
        self.plots.append({"id": name} | drawn | more)
        height = drawn["layout"]["height"]
        return f'<div class="plot"><div id="{name}" style="min-height:{height}px"></div></div>'

    def section(self, title: str, note: str, content: str) -> None:
        """Add a section of HTML; the note may be empty."""
        self.contents.append(title)
        note = f'<p class="note">{note}</p>' if note else ""
        head = f'<section id="{_anchor(len(self.contents))}"><h2>{title}</h2>'
        self.sections.append(f"{head}{note}{content}</section>")

    def text(self, frame: PageFrame, scripts: Sequence[str] = (), **data: Any) -> str:
        """The whole page as HTML, with scripts that follow page.js and the data they read."""
        here = files("motionfmu.report")
        run = [_script(s) for s in (*SCRIPTS, *scripts)]
        ways = enumerate(map(_plain, self.contents), 1)
        template = (here / "page.html").read_text(encoding="utf-8")
        parts = {
            "title": escape(f"{frame.name}: {frame.kind}"),
            "kicker": escape(f"motionfmu {frame.kind}"),
            "name": escape(frame.name),
            "about": escape(frame.about),
            "verdict": _verdict(frame.checks),
            "footer": frame.footer,
            "contents": "".join(f'<li><a href="#{_anchor(k)}">{t}</a></li>' for k, t in ways),
            "body": "\n".join(self.sections),
            "style": (here / "page.css").read_text(encoding="utf-8"),
            "theme": (here / "theme.js").read_text(encoding="utf-8"),
            "script": "\n".join(run),
            "plotly": packed_script(any("scene" in plot["layout"] for plot in self.plots)),
        }
        room = LARGEST - len(template) - sum(len(text.encode()) for text in parts.values())
        parts["data"] = self._packed(room, {"dark": dark_colors()} | data)
        return Template(template).substitute(parts)

    def _packed(self, room: int, data: dict[str, Any]) -> str:
        """The plots' data; if they do not fit into the room, long curves have their peaks alone."""
        most = MOST
        while True:
            text = packed_text(json.dumps(self._drawn(most) | data, separators=(",", ":")), QUICK)
            if len(text) <= room or most <= FEWEST:
                if self.beside is not None:
                    self.beside.write()
                return text
            most //= 2

    def _drawn(self, most: int) -> dict[str, Any]:
        """The plots, with so many samples of a curve at most, and the times of their samples."""
        times: list[dict[str, Any]] = []
        known: dict[bytes, int] = {}
        figures = []
        for plot in self.plots:
            traces = [_trace(t, (most, self.beside), times, known) for t in plot["data"]]
            figures.append(plot | {"data": traces})
        return {"figures": figures, "times": times}


def _script(name: str) -> str:
    """The text of a script, of the report's own or of those that draw a machine."""
    own = files("motionfmu.report") / name
    shared = files("motionfmu.base") / "machine_picture" / name
    return (own if own.is_file() else shared).read_text(encoding="utf-8")


def _trace(
    drawn: dict[str, Any],
    kept: tuple[int, SampleFiles | None],
    times: list[dict[str, Any]],
    known: dict[bytes, int],
) -> dict[str, Any]:
    """A trace as the page's script takes it: samples packed, times named."""
    whole: Samples | None = drawn.get("samples")
    if whole is None:
        return drawn
    most, beside = kept
    few = whole.few(most)
    key = sha256(few.time.tobytes()).digest()
    if key not in known:
        known[key] = len(times)
        times.append(clock(few.time))
    samples = {"time": known[key], "values": bits(few.values)}
    samples |= {"steps": few.steps, "dots": few.dots, "all": few.all}
    if beside is not None and (more := beside.more(few)) is not None:
        samples["more"] = more
    if few.lines is not None:
        samples["lines"] = bits(few.lines)
    return drawn | {"samples": samples}


def _anchor(number: int) -> str:
    return f"section{number}"


def _plain(html: str) -> str:
    """A title without its marks."""
    return re.sub("<[^>]*>", "", html)


def _verdict(checks: Sequence[Verdict]) -> str:
    if not checks:
        return ""
    judged = tally(c.ok for c in checks)
    kind, mark = ("fail", "✗ ") if judged.failed else ("pass", "✓ ") if judged.judged else ("", "")
    return f'<span class="pill {kind}">{mark}{judged.words}</span>'
