"""Pictures of a network card's drawings, plans and jobs."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure

from motionfmu.base.errors import InputError
from motionfmu.cards.job import Job
from motionfmu.cards.plan import DRAWS, Plan
from motionfmu.cards.plan_figures import speeds
from motionfmu.cards.plt import PltDrawing
from motionfmu.report.pictures import PLAIN, STABLE
from motionfmu.report.style import AXES, GRID, HEAT, MUTED, RAPID

SPEEDS = LinearSegmentedColormap.from_list("speed", HEAT)
# Points of a curve that a picture can show.
MOST = 20_000


@contextmanager
def _sheet(file: Path, title: str, rows: int) -> Iterator[list[Any]]:
    """Axes of a picture, the path above profiles; written at the end."""
    with matplotlib.rc_context(PLAIN | STABLE):
        high = (7.5, 9.5, 10.5)[rows - 1]
        ratios = [5.0, *[1.3] * (rows - 1)]
        figure = Figure(figsize=(9.0, high), layout="constrained")
        axes: Any = figure.subplots(rows, height_ratios=ratios, squeeze=False)
        try:
            path = axes[0, 0]
            path.set(xlabel="X [mm]", ylabel="Y [mm]")
            path.set_aspect("equal", adjustable="datalim")
            path.set_title(title, loc="left", fontsize=14, fontweight="bold")
            yield list(axes[:, 0])
            for one in axes[:, 0]:
                one.grid(color=GRID, lw=0.8)
                one.set_axisbelow(True)
                one.spines[:].set_visible(False)
                one.tick_params(length=0)
            plain = {"Date": None} if file.suffix == ".svg" else None
            figure.savefig(file, dpi=140, metadata=plain)
        except OSError as error:
            raise InputError(f"cannot write {file}: {error.strerror}") from None


def _lines(axes: Any, parts: list[np.ndarray], **look: Any) -> None:
    axes.add_collection(LineCollection(parts, **look))
    axes.autoscale_view()


def draw_drawing(drawing: PltDrawing, title: str, file: Path) -> None:
    """Draw the layers of a PLT file; moves with the pen up are dotted."""
    with _sheet(file, title, 1) as (path,):
        up = [p.points for p in drawing.lines if not p.down and len(p.points) > 1]
        _lines(path, up, colors=RAPID, linewidths=0.8, linestyles=[(0, (1, 2))], label="pen up")
        for k, (pen, lines) in enumerate(drawing.layers.items()):
            color = AXES[k % len(AXES)]
            parts = [p.points for p in lines]
            _lines(path, parts, colors=color, linewidths=1.3, label=f"pen {pen}")
        path.legend(loc="upper right", frameon=False, fontsize=10, labelcolor=MUTED)


def _thin(*columns: np.ndarray) -> list[np.ndarray]:
    """Every n-th row, so that no more than `MOST` are left."""
    step = -(-len(columns[0]) // MOST)
    return [c[::step] for c in columns]


def _profile(axes: Any, time: np.ndarray, rows: np.ndarray, label: str) -> None:
    place: dict[str, Any]
    for k, name in enumerate("XYZU"):
        if np.any(rows[:, k]):
            axes.plot(time, rows[:, k], color=AXES[k], lw=0.9, label=name)
    axes.set(ylabel=label, xlim=(0.0, time[-1] if len(time) else 1.0))
    if axes.lines:
        place = {"loc": "lower right", "bbox_to_anchor": (1.0, 0.98), "ncols": 4}
        axes.legend(frameon=False, fontsize=9, labelcolor=MUTED, **place)


def draw_plan(plan: Plan, title: str, file: Path) -> None:
    """Draw the path by its speed, above speed and acceleration of the axes."""
    with _sheet(file, title, 3) as (path, speed, pull):
        places = np.vstack([np.zeros((1, 2)), plan.places[:, :2]])
        chords = np.stack([places[:-1], places[1:]], axis=1)
        drawn, quick = plan.steps == DRAWS, speeds(plan)
        _lines(path, list(chords[~drawn]), colors=RAPID, linewidths=0.7)
        lines = LineCollection(list(chords[drawn]), array=quick[drawn], cmap=SPEEDS, linewidths=1.6)
        path.add_collection(lines)
        path.autoscale_view()
        bar = path.figure.colorbar(lines, ax=path, shrink=0.8, aspect=30, pad=0.02)
        bar.set_label("speed, pen down [mm/s]")
        bar.outline.set_visible(False)
        every = np.vstack([np.zeros((2, 4)), plan.places])
        v = np.diff(every, axis=0) / plan.period
        a = np.diff(v, axis=0) / plan.period
        time, v, a = _thin(np.arange(1, len(a) + 1) * plan.period, v[1:], a)
        _profile(speed, time, v, "speed [mm/s]")
        _profile(pull, time, a, "acceleration\n[mm/s²]")
        pull.set_xlabel("time [s]")
        path.figure.align_ylabels([speed, pull])


def draw_job(job: Job, title: str, file: Path) -> None:
    """Draw the path of a job in mm, above the pulses of its frames."""
    with _sheet(file, title, 2) as (path, pulses):
        scale = np.array([1e3 / p if p else 0.0 for p in job.pulses_per_m])
        places = np.vstack([np.zeros(4), job.positions]) * scale
        (shown,) = _thin(places)
        path.plot(*shown[:, :2].T, color=AXES[0], lw=1.0)
        for number, color in zip(range(1, len(job.events) + 1), AXES[1:], strict=False):
            there = places[:-1][job.frame_events == number]
            if len(there):
                label = f"event {number}"
                path.scatter(*there[:, :2].T, s=14, color=color, label=label, zorder=3)
        if job.events:
            path.legend(loc="upper right", frameon=False, fontsize=10, labelcolor=MUTED)
        time = 1e-9 * job.period_ns * np.arange(1, len(job.commands) + 1)
        time, commands = _thin(time, job.commands)
        _profile(pulses, time, commands, "pulses\na frame")
        pulses.set_xlabel("time [s]")
