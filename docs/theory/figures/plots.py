"""What the figures of all pages share: colours, axes, and the list of those that are made."""

from collections.abc import Callable

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes

BLUE, RED, GREEN, GREY, ORANGE = "#1f5fa8", "#c0392b", "#2e8b57", "#777777", "#d98200"
Array = np.ndarray
FIGURES: list[Callable[[], plt.Figure]] = []


def figure(made: Callable[[], plt.Figure]) -> Callable[[], plt.Figure]:
    """Note a function that makes the figure of its name."""
    FIGURES.append(made)
    return made


def panels(rows: int, columns: int, size: tuple[float, float], **more: object) -> tuple:
    """A figure and its axes, all with a thin grid."""
    made, axes = plt.subplots(rows, columns, figsize=size, layout="constrained", **more)
    for ax in np.atleast_1d(axes).ravel():
        ax.grid(color="#e4e4e4", linewidth=0.6)
        ax.set_axisbelow(True)
    return made, axes


def tube(ax: Axes, points: Array, radius: float) -> None:
    """What is within a radius of a polyline, as a band of that width in data units."""
    from shapely.geometry import LineString

    band = LineString(points).buffer(radius, quad_segs=24)
    x, y = band.exterior.xy
    ax.fill(x, y, color="#dfe9f5", zorder=0)
    ax.plot(x, y, color="#9db8d9", linewidth=0.7, zorder=1)
