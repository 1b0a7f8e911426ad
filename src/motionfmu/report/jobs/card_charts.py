"""Charts of a network card's drawing, plan or job: its path, and how fast it is drawn."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError
from motionfmu.cards.card_job import Job
from motionfmu.cards.plan import DRAWS, Plan
from motionfmu.cards.plan_figures import speeds
from motionfmu.drawings import Drawing
from motionfmu.report.diagram import (
    DOT,
    Diagram,
    LineMark,
    Mark,
    PointMark,
    SamplesMark,
    Scale,
    one,
    path_diagram,
    path_lines,
)
from motionfmu.report.samples import Samples
from motionfmu.report.style import AXES, RAPID, heat

Array = NDArray[np.float64]

LEVELS = 8  # colours of the speed
MOST = 20_000  # points of a path that a picture can show
HEIGHT, LOW = 540, 180  # [pixel] of a path, of what is over time
NAMES = "XYZU"
UP: dict[str, Any] = {"name": "pen up", "color": RAPID, "width": 1.0, "dash": DOT}


def plan_chart(plan: Plan) -> Diagram:
    """The path of a plan; its colour is the speed with the pen down."""
    places = np.vstack([np.zeros((1, 2)), plan.places[:, :2]])
    drawn, quick = plan.steps == DRAWS, speeds(plan)
    lines = [path_lines(_chords(places, ~drawn), **UP)]
    top = float(quick[drawn].max(initial=0.0)) or 1.0
    level = np.minimum((quick / top * LEVELS).astype(int), LEVELS - 1)
    for k in range(LEVELS):
        if (mask := drawn & (level == k)).any():
            name = f"{top * k / LEVELS:.0f} .. {top * (k + 1) / LEVELS:.0f} mm/s"
            look: Any = {"name": name, "color": heat(k / (LEVELS - 1)), "width": 2.2}
            lines.append(path_lines(_chords(places, mask), **look))
    return path_diagram("XY", lines, HEIGHT)


def rate_chart(plan: Plan, order: int) -> Diagram:
    """The speed (order 1) or the acceleration (order 2) of each axis that moves."""
    every = np.vstack([np.zeros((order, 4)), plan.places])
    rates = np.diff(every, order, axis=0) / plan.period**order
    title, unit = (("Speed", "mm/s"), ("Acceleration", "mm/s²"))[order - 1]
    return _over_time(plan.period, rates, Scale(title, unit))


def _over_time(period: float, rows: Array, scale: Scale) -> Diagram:
    """A curve for each axis that moves; `rows` (n, 4) has one row for each period [s]."""
    time = np.arange(1, len(rows) + 1) * period
    curves = [
        SamplesMark(Samples(time, rows[:, k]), name, AXES[k], 1.2)
        for k, name in enumerate(NAMES)
        if rows[:, k].any()
    ]
    span = Scale("Time", "s", (0.0, float(time[-1]) if len(time) else 1.0))
    return one(span, scale, curves, LOW)


def _chords(places: Array, mask: NDArray[np.bool_]) -> Array:
    """The chords of the chosen frames, with gaps where frames do not follow each other."""
    step = -(-len(mask) // MOST)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]])))
    parts = []
    for a, b in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        part = places[a : b + 1]
        parts += [part[: -1 if len(part) > 1 else None : step], part[-1:], np.full((1, 2), np.nan)]
    return np.concatenate(parts) if parts else np.zeros((0, 2))


def _joined(parts: list[Array]) -> Array:
    """Lines one after the other, with gaps between them."""
    gap = np.full((1, 2), np.nan)
    return np.concatenate([np.zeros((0, 2)), *(p for part in parts for p in (part[:, :2], gap))])


def draw_plan(plan: Plan, title: str, file: Path) -> None:
    """Draw the path by its speed, above speed and acceleration of the axes."""
    _write(file, title, [plan_chart(plan), rate_chart(plan, 1), rate_chart(plan, 2)])


def draw_drawing(drawing: Drawing, title: str, file: Path) -> None:
    """Draw the layers of a drawing; moves with the pen up are dotted."""
    up = [p.points for p in drawing.lines if not p.down and len(p.points) > 1]
    lines = [path_lines(_joined(up), **UP)]
    for k, (pen, layer) in enumerate(drawing.layers.items()):
        look: Any = {"name": f"pen {pen}", "color": AXES[k % len(AXES)]}
        lines.append(path_lines(_joined([p.points for p in layer]), **look))
    _write(file, title, [path_diagram("XY", lines, HEIGHT)])


def draw_job(job: Job, title: str, file: Path) -> None:
    """Draw the path of a job in mm, above the pulses of its frames."""
    scale = np.array([1e3 / p if p else 0.0 for p in job.pulses_per_m])
    places = np.vstack([np.zeros(4), job.positions]) * scale
    shown = places[:: -(-len(places) // MOST)]
    marks: list[Mark] = [LineMark(shown[:, 0], shown[:, 1], "path", AXES[0], 1.2)]
    for number, color in zip(range(1, len(job.events) + 1), AXES[1:], strict=False):
        there = places[:-1][job.frame_events == number]
        marks.append(PointMark(there[:, 0], there[:, 1], f"event {number}", color))
    pulses = _over_time(1e-9 * job.period_ns, job.commands, Scale("Pulses\na frame"))
    _write(file, title, [path_diagram("XY", marks, HEIGHT), pulses])


def _write(file: Path, title: str, column: list[Diagram]) -> None:
    from motionfmu.report.matplotlib_figure import write_file

    try:
        write_file(file, title, "", column)
    except OSError as error:
        raise InputError(f"cannot write {file}: {error.strerror}") from None
