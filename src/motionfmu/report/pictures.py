"""The main picture, as SVG and PNG."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Line3DCollection

from motionfmu.analysis.contour import ContourResult
from motionfmu.report.drawing import Drawing
from motionfmu.report.numbers import length
from motionfmu.report.style import GRID, HEAT, INK, MUTED, PATH, RAPID

PICTURES = ("path.svg", "path.png")
# Same picture, same bytes: no date, and fixed names inside the SVG.
STABLE = {"svg.hashsalt": "motionfmu", "svg.fonttype": "path"}
PLAIN: dict[Any, Any] = {
    "font.family": "sans-serif",
    "font.sans-serif": ["Inter", "Segoe UI", "Helvetica Neue", "Arial", "DejaVu Sans"],
    "text.color": INK,
    "axes.labelcolor": INK,
    "xtick.color": MUTED,
    "ytick.color": MUTED,
}


def write_pictures(name: str, contour: ContourResult, drawing: Drawing, folder: Path) -> None:
    """Draw the path with its magnified error, as `PICTURES`."""
    with matplotlib.rc_context(PLAIN | STABLE):
        figure = path_picture(name, contour, drawing)
        for file in PICTURES:
            plain = {"Date": None} if file.endswith("svg") else None
            figure.savefig(folder / file, dpi=160, metadata=plain)


def path_picture(
    name: str, contour: ContourResult, drawing: Drawing, make: Callable[..., Figure] = Figure
) -> Figure:
    """The path with its magnified error, in a figure of pyplot's or one by itself."""
    figure = make(figsize=(10.0, 8.0), layout="constrained")
    space = len(drawing.names) == 3
    axes: Any = figure.add_subplot(projection="3d" if space else None)
    lines = _draw(axes, drawing)
    bar = figure.colorbar(lines, ax=axes, shrink=0.7, aspect=28, pad=0.02)
    bar.set_label("Contour error [µm]")
    bar.outline.set_visible(False)
    _dress(axes, drawing)
    axes.set_title(
        f"{name}: contour error drawn {drawing.magnify:,.0f} times as large",
        loc="left",
        fontsize=14,
        fontweight="bold",
        pad=26 if not space else 10,
    )
    numbers = f"largest {length(contour.error.max)} in line {contour.error.line}"
    place = axes.text2D if space else axes.text
    place(
        0.0,
        1.02,
        f"{numbers}, RMS {length(contour.error.rms)}",
        transform=axes.transAxes,
        color=MUTED,
        fontsize=11,
    )
    return figure


def _draw(axes: Any, drawing: Drawing) -> Any:
    shown = drawing.magnified(drawing.magnify)
    collection: Any = Line3DCollection if len(drawing.names) == 3 else LineCollection
    hairs = np.stack([drawing.foot[drawing.hairs], shown[drawing.hairs]], axis=1)
    axes.add_collection(collection(hairs, colors="#f0c9a8", linewidths=0.7))
    axes.plot(*drawing.rapids.T, color=RAPID, lw=1.0, ls=":", label="rapid")
    axes.plot(*drawing.path.T, color=PATH, lw=1.3, label="programmed path")
    size = np.abs(drawing.error) * 1e3
    pieces = np.stack([shown[:-1], shown[1:]], axis=1)
    whole = ~np.isnan(pieces).any(axis=(1, 2))
    lines = collection(
        pieces[whole],
        cmap=LinearSegmentedColormap.from_list("error", HEAT),
        norm=Normalize(0.0, float(np.max(size)) or 1.0),
        linewidths=2.2,
        capstyle="round",
    )
    lines.set_array(np.maximum(size[:-1], size[1:])[whole])
    axes.add_collection(lines)
    every = np.concatenate([shown, drawing.path])
    low, high = np.nanmin(every, axis=0), np.nanmax(every, axis=0)
    margin = 0.04 * float(np.max(high - low))
    for letter, a, b in zip("xyz", low - margin, high + margin, strict=False):
        getattr(axes, f"set_{letter}lim")(a, b)
    return lines


def _dress(axes: Any, drawing: Drawing) -> None:
    for letter, title in zip("xyz", drawing.names, strict=False):
        getattr(axes, f"set_{letter}label")(f"{title} [mm]")
    if len(drawing.names) == 3:
        axes.set_box_aspect(
            [np.ptp(axes.get_xlim()), np.ptp(axes.get_ylim()), np.ptp(axes.get_zlim())]
        )
        return
    axes.set_aspect("equal")
    axes.grid(color=GRID, lw=0.8)
    axes.set_axisbelow(True)
    for side in axes.spines.values():
        side.set_visible(False)
    axes.tick_params(length=0)
