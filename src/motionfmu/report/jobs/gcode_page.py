"""The page and the picture of a part program: what it does, its path, its tools."""

from collections.abc import Sequence
from html import escape
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.analysis.cycle_time import CommandedMotion, Lifted
from motionfmu.analysis.gcode import Fault, Program, Stroke, Summary
from motionfmu.base.axis_names import AXIS_NAMES, ControllerAxis
from motionfmu.report.cycle_time_section import add_cycle_time
from motionfmu.report.diagram import DOT, Diagram, path_diagram, path_lines
from motionfmu.report.html_page import Page, PageFrame
from motionfmu.report.html_tables import cards, table
from motionfmu.report.jobs.drawn_strokes import DrawnStrokes
from motionfmu.report.style import AXES, RAPID, heat

SHORT = 24  # [characters] a text that is told again behind what is wrong with it
# Spans of the feed that are told apart by their colours.
LEVELS = 8
HEIGHT = 500  # [pixel] of the path
FOOTER = (
    "Times are those of the trajectory planner with the limits given; stops, tool changes and waits"
    " for inputs take none. Coordinates are the machine's. Every number is in"
    ' <a href="result.json">result.json</a>.'
)


def clock(seconds: float) -> str:
    """A time as h:mm:ss, or with tenths below a minute."""
    if seconds < 60.0:
        return f"{seconds:.1f} s"
    hours, rest = divmod(round(seconds), 3600)
    text = f"{rest // 60:02d}:{rest % 60:02d}" if hours else f"{rest // 60}:{rest % 60:02d}"
    return f"{hours}:{text} h" if hours else f"{text} min"


def metres(way: float) -> str:
    """A way [mm] in mm or m."""
    return f"{way / 1e3:.3g} m" if way >= 1e4 else f"{way:.4g} mm"


def page_text(
    name: str,
    program: Program,
    summary: Summary,
    path: DrawnStrokes,
    planned: tuple[CommandedMotion, Sequence[Lifted]] | None = None,
) -> str:
    """The whole HTML page; with the plan of a machine's controller, where the time goes."""
    page = Page()
    low, high = summary.feeds
    feeds = f"{low:.4g}" if low == high else f"{low:.4g} to {high:.4g}"
    size = " \N{MULTIPLICATION SIGN} ".join(
        f"{b - a:.4g}" for a, b in zip(summary.low[:3], summary.high[:3], strict=True)
    )
    total = summary.feed_way + summary.rapid_way
    rapid = 100.0 * summary.rapid_way / total if total else 0.0
    rows = [
        (
            "Cycle time",
            clock(summary.time if planned is None else planned[0].time),
            f"{summary.stops} stops not counted",
        ),
        ("Way with feed", metres(summary.feed_way), "measured in X Y Z"),
        ("Way in rapid", metres(summary.rapid_way), f"{rapid:.0f} % of the whole"),
        ("Feeds", feeds, "mm/min"),
        ("Size of the path", size, "mm in X, Y, Z, rapids too"),
        ("Commands", f"{summary.commands}", f"of {program.text.count(chr(10)) + 1} lines"),
    ]
    page.sections.append(cards(rows))
    if drawn := path.strokes:
        note = "Rapids are dotted." if any(s.rapid for s in drawn) else ""
        note += "" if len(summary.tools) < 2 else " A colour each tool."
        note += f" Drawn to within {path.within:.3g} mm." if path.within else ""
        note += f" One of {path.every} pairs of strokes is drawn." if path.every > 1 else ""
        page.section(
            "Path", note.strip(), page.place("path", path_of_program(drawn, by_feed=False))
        )
        if low < high:
            place = page.place("feeds", path_of_program(drawn, by_feed=True))
            page.section("Feed along the path", "As programmed.", place)
    if planned is not None:
        add_cycle_time(page, *planned)
    page.section("Extents", "", _extents(summary, program.axes))
    page.section("Tools", "", _tools(summary))
    if program.notes:
        rows = [(f"{n.file} {n.line}".strip(), escape(n.text), n.why) for n in program.notes]
        told = table(("line", "text", "note"), rows, numeric=3)
        page.section("Notes", "Accepted, and without effect here; each once.", told)
    return page.text(PageFrame(name, "A part program", "program", [], FOOTER))


def _extents(summary: Summary, axes: Sequence[ControllerAxis]) -> str:
    rows = [
        (n.name, f"{a:.4f}", f"{b:.4f}", f"{b - a:.4f}", n.unit)
        for n, a, b in zip(axes, summary.low, summary.high, strict=True)
        if a != b or a != 0.0
    ]
    return table(("axis", "from", "to", "over", ""), rows)


def _tools(summary: Summary) -> str:
    rows = [
        (f"T{u.tool}" if u.tool else "none", clock(u.time), metres(u.feed_way), f"{u.low[2]:.4g}")
        for u in summary.tools
    ]
    return table(("tool", "time", "way with feed", "deepest Z [mm]"), rows)


def is_space(drawn: Sequence[Stroke]) -> bool:
    """Whether the path leaves a plane along X and Y."""
    feeds = [s.points[:, 2] for s in drawn if not s.rapid] or [s.points[:, 2] for s in drawn]
    every = np.concatenate(feeds)
    return bool(np.ptp(every) > 1e-9)


def colors(drawn: Sequence[Stroke]) -> dict[int, str]:
    """A colour for each tool."""
    used = dict.fromkeys(s.tool for s in drawn)
    return {tool: AXES[i % len(AXES)] for i, tool in enumerate(used)}


def _joined(parts: Sequence[Stroke]) -> tuple[Any, Any, Any]:
    """Points, feeds and line numbers of several strokes, with a gap between two strokes."""
    gap = np.full((1, 3), np.nan)
    points = np.concatenate([np.concatenate([s.points, gap]) for s in parts])
    feed = np.concatenate([np.append(s.feed, s.feed[-1]) for s in parts])
    line = np.concatenate([np.append(s.line, s.line[-1]) for s in parts])
    return points, feed, line


Group = tuple[str, list[Stroke], str]


def _by_tool(feeds: Sequence[Stroke]) -> list[Group]:
    shades = colors(feeds)
    return [
        (f"T{t}" if t else "feed", [s for s in feeds if s.tool == t], shade)
        for t, shade in shades.items()
    ]


def _by_feed(feeds: Sequence[Stroke]) -> list[Group]:
    """Groups of moves with the same feed, or with one of `LEVELS` spans of feeds, light to dark."""
    pieces = []
    for s in feeds:
        cuts = np.flatnonzero(np.diff(s.feed)) + 1
        for a, b in zip([0, *cuts], [*cuts, len(s.feed)], strict=True):
            pieces.append(Stroke(False, s.tool, s.points[a:b], s.feed[a:b], s.line[a:b]))
    values = np.array([p.feed[0] for p in pieces])
    single = np.unique(values)
    edges = np.linspace(values.min(), values.max(), LEVELS + 1)
    names = [f"F{a:.4g} .. {b:.4g}" for a, b in pairwise(edges)]
    level = np.clip(np.searchsorted(edges, values, "right") - 1, 0, LEVELS - 1)
    if len(single) <= LEVELS:
        names, level = [f"F{v:.4g}" for v in single], np.searchsorted(single, values)
    shades = [heat(k / max(1, len(names) - 1)) for k in range(len(names))]
    return [
        (name, [p for p, at in zip(pieces, level, strict=True) if at == k], shades[k])
        for k, name in enumerate(names)
        if (level == k).any()
    ]


def path_of_program(drawn: Sequence[Stroke], by_feed: bool) -> Diagram:
    """The path, coloured by tool or by feed."""
    width = 3 if is_space(drawn) else 2
    rapids = [s for s in drawn if s.rapid]
    feeds = [s for s in drawn if not s.rapid]
    lines = []
    if rapids:
        look: Any = {"name": "rapid", "color": RAPID, "width": 1.2, "dash": DOT, "hover": ()}
        lines.append(path_lines(_joined(rapids)[0][:, :width], **look))
    for name, parts, color in _by_feed(feeds) if by_feed else _by_tool(feeds):
        points, feed, number = _joined(parts)
        told = [f"line {n:.0f}, F{f:.4g}" for n, f in zip(number, feed, strict=True)]
        look = {"name": name, "color": color, "width": 1.8, "hover": told}
        lines.append(path_lines(points[:, :width], **look))
    return path_diagram(AXIS_NAMES[:width], lines, HEIGHT)


def write_path(name: str, drawn: Sequence[Stroke], folder: Path) -> None:
    """Draw the path by tool, as path.png and path.svg."""
    from motionfmu.report.matplotlib_figure import write_picture

    write_picture(folder / "path", name, "", path_of_program(drawn, by_feed=False))


def place(name: str, f: Fault) -> str:
    """Where a fault or a note stands; a file that the program calls is beside it."""
    file = str(Path(name).with_name(f"{f.file}.ngc")) if f.file else name
    return f"{file}:{f.line}:{f.column}"


def _line(text: str, number: int) -> str | None:
    """A line of a text, from 1 on; the others are not made."""
    begin = 0
    for _ in range(number - 1):
        begin = text.find("\n", begin) + 1
        if not begin:
            return None
    end = text.find("\n", begin)
    return None if number < 1 else text[begin : end if end >= 0 else len(text)]


def fault_lines(name: str, program: Program) -> list[str]:
    """Each fault with its place, its line and a mark below the text."""
    texts = {"": program.text, **program.files}
    told = []
    for f in program.faults:
        about = f' "{f.text}"' if 0 < len(f.text) <= SHORT else ""
        about += f" ({f.limits})" if f.limits else ""
        told.append(f"{place(name, f)}: {f.why}{about}")
        if (line := _line(texts[f.file], f.line)) is not None:
            text = line.removeprefix("\ufeff").rstrip("\r").replace("\t", " ")
            told += [f"    {text}", " " * (f.column + 3) + "^" + "~" * max(0, f.length - 1)]
    if program.more:
        told.append(f"{name}: {len(program.faults)} faults are told, there are more")
    return told
