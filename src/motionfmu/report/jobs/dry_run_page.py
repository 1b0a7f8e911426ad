"""The page of a robot's program that was run dry: verdict, times, joints and their reserves."""

import math
from html import escape

import numpy as np

from motionfmu.analysis.dry_run import DryRun, LineReserve
from motionfmu.report.cycle_time_section import add_cycle_time
from motionfmu.report.diagram import Diagram, LevelMark, SamplesMark, Scale, Subplot
from motionfmu.report.html_page import RUN, Page, PageFrame
from motionfmu.report.html_tables import cards, table
from motionfmu.report.jobs.dry_scene import dry_scene
from motionfmu.report.jobs.gcode_page import clock, metres
from motionfmu.report.jobs.reach_section import add_reach
from motionfmu.report.samples import Samples
from motionfmu.report.style import AXES
from motionfmu.report.view_section import SCRIPTS, add_view
from motionfmu.run.checks import Verdict

HEIGHT = 190  # [pixel] of a plot
FOOTER = (
    "Moves are planned and refused by the code that drives the arm; drives, arm and the processor"
    ' times of the PC are left out. Every number is in <a href="result.json">result.json</a>.'
)
HEADS = (
    "line", "passes", "s", "way [mm]", "to an end [°]", "speed [%]", "shoulder [mm]", "elbow [°]",
    "wrist [°]", "apart [mm]",
)  # fmt: skip


def line_cells(x: LineReserve, run: DryRun) -> tuple[str, ...]:
    """Texts of a line by `HEADS`."""
    axes = run.axes
    near = run.nearest.get(x.line)
    return (
        str(x.line),
        str(x.passes),
        f"{x.time:.3f}",
        f"{x.way:.1f}",
        f"{axes[x.nearest.joint - 1]} {x.nearest.left:z.1f}",
        f"{axes[x.fastest.fastest - 1]} {100.0 * x.fastest.share:.1f}",
        f"{x.singular[0]:.0f}",
        f"{x.singular[1]:.1f}",
        f"{x.singular[2]:.1f}",
        f"{near.distance:.0f}" if near else "",
    )


def reserves_chart(run: DryRun) -> Diagram:
    """Joints over time, in their range and as a share of their speeds."""
    s = run.samples
    middle, half = 0.5 * (run.low + run.high), 0.5 * (run.high - run.low)
    place, rate = (s["joint"] - middle) / half, s["rate"] / run.top
    time = s["time"]
    rows: list[Subplot] = []
    for what, values in (("Place in the range", place), ("Share of the speed", rate)):
        curves = [
            SamplesMark(Samples(time, np.ascontiguousarray(values[:, k])), name, AXES[k])
            for k, name in enumerate(run.axes)
        ]
        levels = [LevelMark(-1.0, ""), LevelMark(1.0, "")]
        rows.append(Subplot(Scale(what, "", (-1.15, 1.15)), [*curves, *levels], HEIGHT, not rows))
    span = (float(time[0]), float(time[-1]))
    return Diagram((Scale("Time", "s", span),), rows)


def page_text(run: DryRun) -> str:
    """The whole HTML page."""
    page = Page()
    lines = run.lines
    verdict = [Verdict("it runs through", "", math.nan, not run.faults, " ".join(run.faults))]
    rows = [
        ("Cycle time", clock(run.time), f"{clock(run.waits)} of it waits for inputs"),
        ("Moves", f"{len(run.moves)}", f"of {len(lines)} lines"),
        ("Way of the tool", metres(sum(x.way for x in lines)), ""),
    ]
    if lines:
        joint = min(lines, key=lambda x: x.nearest.left)
        rows.append(
            (
                "Least room of a joint",
                f"{joint.nearest.left:z.1f}°",
                f"{run.axes[joint.nearest.joint - 1]}, line {joint.line}",
            )
        )
        bent = min(lines, key=lambda x: x.singular[2])
        rows.append(("Joint 5 from singular", f"{bent.singular[2]:.1f}°", f"line {bent.line}"))
    if run.approaches:
        near = min(run.nearest.values(), key=lambda a: a.distance)
        which = f"{near.first} and {near.second}, line {near.line}"
        rows.append(("Least distance of parts", f"{near.distance:.0f} mm", which))
    if run.faults:
        told = "".join(f"<p><b>{escape(text)}</b></p>" for text in run.faults)
        page.section("It cannot run as it is", "", told)
    page.sections.append(cards(rows))
    told = "The arm as its controller commands it, and what stands around it."
    if run.collisions:
        told += " It stands where it first comes too near."
    views = add_view(
        page, dry_scene(run), told, min((a.time for a in run.collisions), default=None)
    )
    if len(run.samples):
        add_cycle_time(page, run.motion)
        add_reach(page, run)
        note = "1 and \N{MINUS SIGN}1 are the ends of the range, and the highest speeds."
        place = page.place("joints", reserves_chart(run), True, RUN)
        page.section("Joints and their limits", note, place)
        note = (
            "Each figure is the least of all passes of a line. The joints are the one that comes"
            " nearest to an end of its range and the one with the largest share of its speed."
            " How far the arm stays from singular has three figures: wrist centre from axis 1,"
            " elbow from stretched, joint 5 from straight. The last column says how near parts of"
            " arm and cell come to each other."
        )
        cells = [tuple(map(escape, line_cells(x, run))) for x in lines]
        page.section("Lines", note, table(HEADS, cells, numeric=0))
    about = "A robot's program, run dry"
    return page.text(
        PageFrame(run.file.name, about, "dry run", verdict, FOOTER),
        SCRIPTS if views else (),
        **views,
    )
