"""What a notebook shows of a loop's margins, and of a tuning."""

import math
from html import escape

from motionfmu.analysis.linear.stability import Margins
from motionfmu.base.units import spelled
from motionfmu.report.loop_pages.margin_charts import bode
from motionfmu.report.loop_pages.margin_page import margin_rows
from motionfmu.report.loop_pages.tune_page import errors
from motionfmu.report.matplotlib_figure import picture
from motionfmu.report.notebook_view import beside, cells, images, view
from motionfmu.report.numbers import MINUS, figure, length
from motionfmu.study.tune.tuning_result import LoopMargins, Tuned

_INCHES = 7.5  # width of a picture as it is drawn


def margins_html(found: Margins) -> str:
    """Margins in a table, and the Bode diagram of their loop."""
    mark, word = ("ok", "stable") if found.stable else ("failed", "UNSTABLE")
    head = f'<b>Margins</b> <span class="{mark}">{word}</span>'
    drawn = picture("Open loop", f"Green: |L| is 1; red: {MINUS}180°", bode(found), width=_INCHES)
    return view(
        head, beside(cells(("", "", ""), margin_rows(found), (1,)), images(drawn, "Bode diagram"))
    )


def tuned_html(tuned: Tuned) -> str:
    """Gains and errors before and after in tables, and both errors over time."""
    name, what = tuned.study.scenario.name, tuned.study.path.what
    head = f'<b>{escape(name)}</b> <span class="sub">tuned in {tuned.seconds:.3g} s</span>'
    gains = [
        (escape(n), _values(tuned.present[n]), _values(v), escape(_unit(tuned, n)))
        for n, v in tuned.settings.items()
    ]
    errors_found = []
    for before, after in zip(tuned.before, tuned.after, strict=True):
        plant = escape(tuned.plant_name(before.plant))
        for word, had, has in (
            ("RMS", before.fmus.rms, after.fmus.rms),
            ("largest", before.fmus.max, after.fmus.max),
        ):
            errors_found.append((plant, word, length(had), length(has)))
    loops = [
        (f"axis {m.axis}, {escape(m.loop)}", figure(m.sensitivity), _factor(m.gain), _degrees(m))
        for m in tuned.margins(tuned.z)
    ]
    stopped = "; ".join(map(escape, tuned.stopped_by))
    left = (
        cells(("Gain", "Before", "Found", "Unit"), gains, (1, 2))
        + cells((escape(what.capitalize()), "", "Before", "After"), errors_found, (2, 3))
        + cells(("Loop", "|1/(1 + L)|", "Gain", "Phase"), loops, (1, 2, 3))
        + f'<p><span class="sub">stopped by</span> {stopped}</p>'
    )
    drawn = picture(what.capitalize(), "", errors(tuned), width=_INCHES)
    return view(head, beside(left, images(drawn, f"{what} before and after")))


def _values(value: object) -> str:
    """A value, or those of the axes."""
    listed = value if isinstance(value, list | tuple) else [value]
    return ", ".join(f"{x:.6g}" for x in listed)


def _unit(tuned: Tuned, name: str) -> str:
    return spelled(tuned.study.scenario.resolver.end(name, "set", name).port.unit)


def _factor(value: float) -> str:
    return f"x {figure(value)}" if math.isfinite(value) else "unlimited"


def _degrees(margins: LoopMargins) -> str:
    return f"{figure(margins.phase)}°"
