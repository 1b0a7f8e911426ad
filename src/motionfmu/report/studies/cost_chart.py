"""The cost of a study over what was varied: a curve, a field or a matrix of points."""

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from motionfmu.report.diagram import (
    DASH,
    Array,
    Diagram,
    FieldMark,
    Heat,
    LevelMark,
    LineMark,
    Mark,
    PointMark,
    Scale,
    Subplot,
    one,
)
from motionfmu.report.studies.cost_field import (
    CURVE,
    FIELD,
    Dimension,
    cost_label,
    cost_of,
    dimensions,
    field,
    kind,
    least_cost,
    levels,
    logarithmic,
    never_negative,
)
from motionfmu.report.style import AXES, INK, MUTED

if TYPE_CHECKING:
    from motionfmu.study.study_outcome import Outcome

CELL, HIGH, LOW = 190, 470, 330  # [pixel] of a cell of the matrix, of a field, of a curve
BEST: dict[str, Any] = {"symbol": "star", "size": 17.0, "color": "#ffffff", "edge": INK}
TUNED: dict[str, Any] = {"symbol": "diamond", "size": 12.0, "color": AXES[0], "edge": "#ffffff"}
SMALL = 0.75  # factor for the size of both in a matrix


def cost_chart(outcome: "Outcome") -> Diagram:
    """The chart of the cost that suits the number and kind of the variables."""
    return {CURVE: _curve, FIELD: _field}.get(kind(outcome), _matrix)(outcome)


def _scale(shown: Dimension) -> Scale:
    texts = {} if shown.numeric else dict(enumerate(dict.fromkeys(map(str, shown.values))))
    ticks = tuple((float(k), text) for k, text in texts.items())
    return Scale(shown.label, log=shown.log, ticks=ticks)


def _cost_scale(outcome: "Outcome") -> Scale:
    cost = cost_of(outcome)
    return Scale(cost_label(outcome), log=logarithmic(cost), floor=never_negative(cost))


def _heat(outcome: "Outcome", values: Array) -> Heat:
    """The cost as a colour, between two round values."""
    steps = levels(values)
    ends = float(steps[0]), float(steps[-1])
    ticks = tuple(float(s) for s in steps)
    return Heat(values, cost_label(outcome), ends, logarithmic(values), ticks)


def _number(shown: Dimension, value: Any) -> float:
    """The number at which an axis shows a value of its variable."""
    return float(value) if shown.numeric else float(list(dict.fromkeys(shown.values)).index(value))


def _points(outcome: "Outcome", size: float = 1.0) -> list[tuple[dict[str, Any], Any, Any]]:
    """The best run and the tuned point: how each is drawn, its values and its cost."""
    found: list[tuple[dict[str, Any], Any, Any]] = []
    if (best := outcome.best) is not None:
        place = dict(zip(outcome.study.job.axes, outcome.study.points[best], strict=True))
        cost = least_cost(outcome)
        found.append((BEST | {"name": f"best: run {best}"}, place, cost))
    if tuned := outcome.study.tuned:
        found.append((TUNED | {"name": "tuned"}, tuned, None))
    return [(look | {"size": size * look["size"]}, at, cost) for look, at, cost in found]


def _marks(outcome: "Outcome", x: Dimension, y: Dimension, size: float = 1.0) -> list[Mark]:
    """The best run and the tuned point over two variables."""
    return [
        PointMark(np.array([_number(x, at[x.name])]), np.array([_number(y, at[y.name])]), **look)
        for look, at, _ in _points(outcome, size)
    ]


def _field(outcome: "Outcome") -> Diagram:
    found, (x, y) = field(outcome), dimensions(outcome)
    assert found is not None, "kind() has seen it"
    known = np.isfinite(outcome.cost)
    look: Any = {"color": INK, "size": 4.0, "hover": ()}
    marks: list[Mark] = [FieldMark(found.x, found.y, _heat(outcome, found.z))]
    marks.append(PointMark(x.numbers[known], y.numbers[known], "runs", **look))
    bad = PointMark(x.numbers[~known], y.numbers[~known], "no cost", MUTED, "x", 6.0)
    marks += [bad, *_marks(outcome, x, y)]
    ends = [(float(d.numbers.min()), float(d.numbers.max())) for d in (x, y)]
    across, up = (replace(_scale(d), ends=e) for d, e in zip((x, y), ends, strict=True))
    return one(across, up, marks, HIGH)


def _curve(outcome: "Outcome") -> Diagram:
    (shown,), cost = dimensions(outcome), cost_of(outcome)
    order = np.argsort(shown.numbers, kind="stable")
    x, y = shown.numbers[order], cost[order]
    marks: list[Mark] = [LineMark(x, y, color=AXES[1], width=1.5)] if shown.numeric else []
    marks.append(PointMark(x, y, "runs", AXES[1]))
    for look, at, least in _points(outcome):
        place = _number(shown, at[shown.name]) if shown.name in at else None
        if least is not None and place is not None:
            marks.append(PointMark(np.array([place]), np.array([least]), **look))
        elif place is not None:
            marks.append(LevelMark(place, "tuned", AXES[0], DASH, upright=True))
    return one(_scale(shown), _cost_scale(outcome), marks, LOW)


def _matrix(outcome: "Outcome") -> Diagram:
    """Every pair of variables, the cost as colour, and in the last row the cost over each."""
    shown, cost = dimensions(outcome), cost_of(outcome)
    order = np.argsort(-np.where(np.isfinite(cost), cost, np.inf), kind="stable")
    order = order[np.isfinite(cost[order])]  # the smallest lie on top
    heat = _heat(outcome, cost[order])
    look: Any = {"name": "runs", "size": 5.0, "heat": heat}
    rows = []
    for i, up in enumerate(shown[1:], 1):
        cells = [
            [PointMark(x.numbers[order], up.numbers[order], **look), *_marks(outcome, x, up, SMALL)]
            for x in shown[:i]
        ]
        rows.append(Subplot(_scale(up), cells[0], CELL, None if i == 1 else False, cells[1:]))
    cells = []
    for x in shown:
        marks: list[Mark] = [PointMark(x.numbers[order], cost[order], **look)]
        marks += [
            PointMark(np.array([_number(x, at[x.name])]), np.array([least]), **own)
            for own, at, least in _points(outcome, SMALL)
            if least is not None
        ]
        cells.append(marks)
    rows.append(Subplot(_cost_scale(outcome), cells[0], CELL, False, cells[1:]))
    return Diagram([_scale(x) for x in shown], rows)
