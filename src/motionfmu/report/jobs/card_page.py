"""The page of a plan: numbers, path coloured by speed, speeds over time, ignored commands."""

from html import escape
from typing import Any

from motionfmu.cards.plan import Plan
from motionfmu.drawings import Drawing
from motionfmu.report.html_page import Page, PageFrame
from motionfmu.report.html_tables import cards, table
from motionfmu.report.jobs.card_charts import plan_chart, rate_chart

FOOTER = (
    "Speeds and accelerations are those planned, before they are rounded to pulses. Every number is"
    ' in <a href="result.json">result.json</a>.'
)


def plan_page(name: str, plan: Plan, drawing: Drawing, numbers: dict[str, Any]) -> str:
    """The whole HTML page."""
    page = Page()
    n = numbers
    up = n["time"] - n["time_down"]
    page.sections.append(
        cards(
            [
                ("Time", f"{n['time']:.3f} s", f"{n['frames']} frames"),
                ("Pen down", f"{n['way_down']:.1f} mm", f"in {n['time_down']:.3f} s"),
                ("Pen up", f"{n['way_up']:.1f} mm", f"in {up:.3f} s with the pen's own time"),
                ("Off the drawing", f"{1e3 * n['off']:.1f} µm", f"back {1e3 * n['back']:.1f} µm"),
                ("At feed", f"{100 * n['at_feed']:.0f} %", f"{n['stops']} stops in contours"),
                ("Job", f"{n['size']} bytes", f"{100 * n['flash']:.1f} % of a slot of the flash"),
            ]
        )
    )
    note = "The colour is the speed with the pen down; dotted: pen up."
    page.section("Path", note, page.place("path", plan_chart(plan)))
    page.section("Speed of the axes", "", page.place("speed", rate_chart(plan, 1), True))
    page.section("Acceleration of the axes", "", page.place("pull", rate_chart(plan, 2), True))
    rows = [
        (a, f"{v:.1f}", f"{p:.0f}", f"{j:.0f}")
        for a, v, p, j in zip("XYZU", n["speed"], n["acceleration"], n["jerk"], strict=False)
    ]
    page.section(
        "Peaks", "", table(("axis", "speed [mm/s]", "acceleration [mm/s²]", "jerk [mm/s³]"), rows)
    )
    if drawing.notes:
        told = [(f"{x.line}", f"{x.byte}", f"{x.count}", escape(x.text)) for x in drawing.notes]
        heads = ("line", "byte", "times", "passed over")
        page.section("Notes", "What the file says that draws nothing.", table(heads, told, 4))
    which = f", page {drawing.page} of {drawing.pages}" if drawing.pages > 1 else ""
    about = f"A drawing as a job of a network card{which}"
    return page.text(PageFrame(name, about, "plan", [], FOOTER))
