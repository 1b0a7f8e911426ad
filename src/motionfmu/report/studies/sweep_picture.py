"""The picture of a study, as PNG and SVG."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np
from matplotlib.colors import BoundaryNorm, LinearSegmentedColormap, LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from motionfmu.report.pictures import PLAIN, STABLE
from motionfmu.report.studies.sweep_field import (
    CURVE,
    FIELD,
    Dimension,
    cost_label,
    cost_of,
    dimensions,
    field,
    kind,
    levels,
    logarithmic,
    rangemode,
)
from motionfmu.report.style import AXES, GRID, HEAT, INK, MUTED

if TYPE_CHECKING:
    from motionfmu.study.study_outcome import Outcome

DPI = 110
SIDE = 2.1  # [inch] of a cell of a scatter matrix
HEATMAP = LinearSegmentedColormap.from_list("cost", HEAT)
BEST: dict[str, Any] = {
    "marker": "*",
    "s": 210,
    "color": "white",
    "edgecolor": INK,
    "zorder": 5,
    "clip_on": False,
}
TUNED: dict[str, Any] = {
    "marker": "D",
    "s": 70,
    "color": AXES[0],
    "edgecolor": "white",
    "zorder": 6,
}


def write_picture(outcome: "Outcome", folder: Path) -> None:
    """Draw the costs, one at least, as sweep.png and sweep.svg."""
    way = kind(outcome)
    with matplotlib.rc_context(PLAIN | STABLE):
        if way == FIELD:
            picture = _field(outcome)
        elif way == CURVE:
            picture = _curve(outcome)
        else:
            picture = _matrix(outcome)
        picture.savefig(folder / "sweep.png", dpi=DPI)
        picture.savefig(folder / "sweep.svg", metadata={"Date": None})


def _dress(axes: Any) -> None:
    axes.tick_params(length=0)
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(MUTED)


def _log(axes: Any, way: str) -> None:
    """A logarithmic scale with numbers in full."""
    getattr(axes, f"set_{way}scale")("log")
    _ticks(getattr(axes, f"{way}axis"))


def _ticks(scale: Any) -> None:
    low, high = scale.get_view_interval()
    scale.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if high < 200 * low else (1.0,)))
    scale.set_major_formatter("{x:g}")
    scale.set_minor_formatter(NullFormatter())


def _not_below(axes: Any, cost: Any) -> None:
    """No room below 0 for a cost that is never negative."""
    if rangemode(cost) == "nonnegative" and not logarithmic(cost):
        axes.set_ylim(bottom=max(0.0, axes.get_ylim()[0]))


def _legend(axes: Any) -> None:
    """The marks, beside the title."""
    place: Any = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0), "borderaxespad": 0.2}
    if axes.get_legend_handles_labels()[0]:
        axes.legend(**place, ncols=4, frameon=False, fontsize=9)


def _title(outcome: "Outcome", axes: Any) -> None:
    axes.set_title(
        f"{outcome.study.name}: {cost_label(outcome)}", loc="left", fontweight="bold", pad=10
    )


def _scales(axes: Any, first: Dimension, second: Dimension) -> None:
    for dimension, way in ((first, "x"), (second, "y")):
        getattr(axes, f"set_{way}label")(dimension.label)
        if dimension.log:
            _log(axes, way)


def _marks(outcome: "Outcome", axes: Any, shown: list[Dimension]) -> None:
    """The best run, the tuned point, and runs with an error."""
    x, y = (d.numbers for d in shown)
    bad = ~np.isfinite(cost_of(outcome))
    if bad.any():
        axes.scatter(x[bad], y[bad], marker="x", s=18, color=MUTED, lw=1, label="no cost")
    if (best := outcome.best) is not None:
        axes.scatter(x[best], y[best], **BEST, label=f"best: {cost_of(outcome)[best]:.4g}")
    if tuned := outcome.study.tuned:
        axes.scatter(*(float(tuned[d.name]) for d in shown), **TUNED, label="tuned")


def _field(outcome: "Outcome") -> Any:
    found, shown = field(outcome), dimensions(outcome)
    assert found is not None, "kind() has seen it"
    picture = Figure(figsize=(8.2, 5.6), layout="constrained")
    axes: Any = picture.add_subplot()
    steps = levels(found.z)
    drawn, at = (np.log10(found.z), np.log10(steps)) if logarithmic(found.z) else (found.z, steps)
    whole, names = (
        np.ma.masked_invalid(drawn),
        {k: f"{v:g}" for k, v in zip(at, steps, strict=True)},
    )
    norm = BoundaryNorm(at, HEATMAP.N)
    filled = axes.contourf(found.x, found.y, whole, at, cmap=HEATMAP, norm=norm)
    lines = axes.contour(
        found.x, found.y, whole, at, colors="white", linewidths=0.8, linestyles="solid"
    )
    axes.clabel(lines, fmt=names, fontsize=8)
    bar = picture.colorbar(filled, ax=axes, ticks=at, aspect=28, pad=0.02)
    bar.set_ticklabels(list(names.values()))
    bar.outline.set_visible(False)
    bar.set_label(cost_label(outcome))
    known = np.isfinite(outcome.cost)
    x, y = (d.numbers[known] for d in shown)
    dot: Any = {"s": 6, "color": INK, "alpha": 0.5, "linewidths": 0, "clip_on": False}
    axes.scatter(x, y, zorder=3, **dot)
    _scales(axes, *shown)
    _marks(outcome, axes, shown)
    _dress(axes)
    _title(outcome, axes)
    _legend(axes)
    return picture


def _curve(outcome: "Outcome") -> Any:
    (shown,), cost = dimensions(outcome), cost_of(outcome)
    picture = Figure(figsize=(8.2, 4.2), layout="constrained")
    axes: Any = picture.add_subplot()
    x = shown.numbers
    order = np.argsort(x, kind="stable")
    line = "-" if shown.numeric else ""
    axes.plot(x[order], cost[order], line, color=AXES[1], marker="o", ms=3.5, lw=1.4)
    if not shown.numeric:
        names = list(dict.fromkeys(map(str, shown.values)))
        axes.set_xticks(range(len(names)), names)
    if logarithmic(cost):
        _log(axes, "y")
    if (best := outcome.best) is not None:
        axes.scatter(x[best], cost[best], **BEST, label=f"best: {cost[best]:.4g}")
    if shown.name in outcome.study.tuned and shown.numeric:
        tuned = float(outcome.study.tuned[shown.name])
        axes.axvline(tuned, color=AXES[0], lw=1.4, ls="--", label="tuned")
    if shown.log:
        _log(axes, "x")
    _not_below(axes, cost)
    axes.set_xlabel(shown.label)
    axes.set_ylabel(cost_label(outcome))
    axes.grid(color=GRID, lw=0.8)
    axes.set_axisbelow(True)
    _dress(axes)
    _title(outcome, axes)
    _legend(axes)
    return picture


def _matrix(outcome: "Outcome") -> Any:
    """Every pair of axes, the cost as colour; the cost itself in the last row."""
    shown, cost = dimensions(outcome), cost_of(outcome)
    n = len(shown)
    order = np.argsort(-np.where(np.isfinite(cost), cost, np.inf))  # the smallest on top
    limits = np.nanmin(cost), np.nanmax(cost)
    norm = (LogNorm if logarithmic(cost) else Normalize)(*limits)
    size = (SIDE * n + 1.6, SIDE * n + 0.6)
    picture = Figure(figsize=size, layout="constrained")
    grid: Any = picture.subplots(n, n, sharex="col", squeeze=False)
    points: Any = None
    for i in range(n):
        for j in range(n):
            axes = grid[i, j]
            if j > i:
                axes.axis("off")
                continue
            x = shown[j].numbers[order]
            y = cost[order] if i == j else shown[i].numbers[order]
            points = axes.scatter(x, y, c=cost[order], cmap=HEATMAP, norm=norm, s=12, linewidths=0)
            _cell(outcome, axes, (i, j), shown)
    bar = picture.colorbar(points, ax=grid, aspect=32, pad=0.02, shrink=0.8, format="%g")
    if logarithmic(cost):
        _ticks(bar.ax.yaxis)
    bar.outline.set_visible(False)
    bar.set_label(cost_label(outcome))
    handles, names = grid[-1, 0].get_legend_handles_labels()
    picture.suptitle(
        f"{outcome.study.name}: {cost_label(outcome)}", x=0.01, ha="left", fontweight="bold"
    )
    if handles:
        picture.legend(handles, names, loc="upper right", frameon=False, fontsize=9)
    return picture


def _cell(outcome: "Outcome", axes: Any, at: tuple[int, int], shown: list[Dimension]) -> None:
    (i, j), cost, study = at, cost_of(outcome), outcome.study
    if (best := outcome.best) is not None:
        y = cost[best] if i == j else shown[i].numbers[best]
        told = f"best: {cost[best]:.4g}"
        axes.scatter(shown[j].numbers[best], y, **BEST | {"s": 120}, label=told)
    if study.tuned and i != j and shown[i].numeric and shown[j].numeric:
        x, y = float(study.tuned[shown[j].name]), float(study.tuned[shown[i].name])
        axes.scatter(x, y, **TUNED | {"s": 40}, label="tuned")
    if shown[j].log:
        _log(axes, "x")
    if i == j:
        _not_below(axes, cost)
    if logarithmic(cost) if i == j else shown[i].log:
        _log(axes, "y")
    if i == len(shown) - 1:
        axes.set_xlabel(shown[j].label)
    if i == j:
        axes.set_ylabel(cost_label(outcome), color=MUTED)
    elif j == 0:
        axes.set_ylabel(shown[i].label)
    for way, d in (("x", shown[j]), ("y", shown[i])):
        if not d.numeric and not (way == "y" and i == j):
            names = list(dict.fromkeys(map(str, d.values)))
            getattr(axes, f"set_{way}ticks")(range(len(names)), names)
    axes.grid(color=GRID, lw=0.6)
    axes.set_axisbelow(True)
    _dress(axes)
