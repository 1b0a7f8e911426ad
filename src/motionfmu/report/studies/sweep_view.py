"""What a notebook shows of a study."""

from html import escape
from typing import TYPE_CHECKING

import numpy as np

from motionfmu.report.matplotlib_figure import picture
from motionfmu.report.notebook_view import beside, cells, images, view
from motionfmu.report.studies.cost_chart import cost_chart
from motionfmu.report.studies.cost_field import cost_label
from motionfmu.report.studies.drawn_rows import drawn_rows
from motionfmu.report.studies.sweep_page import best_rows

if TYPE_CHECKING:
    from motionfmu.study.study_outcome import Outcome

_ROWS = 5  # of the best runs
_INCHES = 7.5  # width of a picture as it is drawn


def sweep_html(outcome: "Outcome") -> str:
    """The study in words, its best runs in a table, its cost as a picture."""
    lines = f"<p>{'<br/>'.join(map(escape, outcome.summary))}</p>"
    head = f"<b>{escape(outcome.study.name)}</b>"
    if not np.isfinite(outcome.cost).any():
        return view(head, lines)
    label = cost_label(outcome)
    left = lines
    if outcome.best is not None:
        heads, rows = best_rows(outcome)
        left += cells(heads, rows[:_ROWS], range(2, len(heads)))
    drawn = picture(label, "", cost_chart(drawn_rows(outcome)), width=_INCHES)
    return view(head, beside(left, images(drawn, label)))
