"""Draw the machined plate, and how far the tool's edge is from its contours: pocket.png.

    .venv/bin/python scenarios/pocket/picture.py [picture.png]

The distances are those of the tool's centre from the contours of the drawing, less its radius: they
know nothing of the commands that the program makes.
"""

import sys
from itertools import pairwise
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import motionfmu

HERE = Path(__file__).parent
ZERO = np.array([30.0, 20.0])  # [mm] work offset
RADIUS = 3.0  # [mm] of the end mill
BEHIND = 600  # [samples] that the table and the pulses are off the line at most


def corner(centre: tuple[float, float], radius: float, start: float) -> np.ndarray:
    """A quarter of a circle from an angle on, clockwise [mm, rad]."""
    angle = start - np.linspace(0.0, np.pi / 2.0, 400)
    return np.array(centre) + radius * np.column_stack([np.cos(angle), np.sin(angle)])


# Contours of the drawing [mm].
OUTLINE = np.vstack([
    [(0, 0)], corner((6, 28), 6.0, np.pi),
    [(52, 34), (60, 26), (60, 0), (38, 0), (38, 4), (24, 4), (24, 0), (0, 0)],
])  # fmt: skip
POCKET = np.vstack([
    corner((14, 20), 4.0, np.pi), corner((26, 20), 4.0, np.pi / 2.0),
    corner((26, 14), 4.0, 0.0), corner((14, 14), 4.0, -np.pi / 2.0), [(10, 20)],
])  # fmt: skip
# Lines of the program that follow each contour, without entry and exit.
CUTS = ((OUTLINE, (88, 97), "outline"), (POCKET, (24, 33), "pocket"))


def distance(place: np.ndarray, contour: np.ndarray) -> np.ndarray:
    """Least distance of points from a polyline [mm]."""
    least = np.full(len(place), np.inf)
    for a, b in pairwise(contour):
        side = b - a
        u = np.clip((place - a) @ side / max(side @ side, 1e-30), 0.0, 1.0)
        least = np.minimum(least, np.hypot(*(place - a - u[:, None] * side).T))
    return least


def main(picture: Path) -> None:
    """Run, print the largest distances, draw."""
    result = motionfmu.load(HERE).run()
    line, tool, time = result["mcc.line"], result["mcc.tool"], result.time
    table = result["machine.table_position"][:, :2] * 1e3 - ZERO
    pulses = result["card.pulse_count"][:, :2] * 1e-3 - ZERO
    figure = plt.figure(figsize=(12, 5.2), layout="constrained")
    grid = figure.add_gridspec(2, 2, width_ratios=(1.5, 1))
    plan = figure.add_subplot(grid[:, 0])
    for contour in (OUTLINE, POCKET):
        plan.plot(*contour.T, color="black", linewidth=1.2)
    drilled = (tool == 1) & (result["machine.table_position"][:, 2] * 1e3 < -25.0)
    plan.scatter(
        *table[drilled][::40].T, s=5, color="#d55e00", label="drill below the face", zorder=3
    )
    for n, (contour, (first, last), name) in enumerate(CUTS):
        on = (line >= first) & (line <= last) & (tool == 2)
        on[BEHIND:] &= on[:-BEHIND]
        on[:-BEHIND] &= on[BEHIND:]
        past = np.all(table < 0.0, axis=1) | np.all(pulses < 0.0, axis=1)  # entry and exit
        cut = np.flatnonzero(on & ~past)
        plan.plot(*table[cut].T, color="#0072b2", linewidth=0.8)
        panel = figure.add_subplot(grid[n, 1])
        for places, what, colour in ((pulses, "pulses", "#999999"), (table, "table", "#0072b2")):
            off = (distance(places[cut], contour) - RADIUS) * 1e3
            print(f"{name}, {what}: {off.min():.1f} to {off.max():.1f} µm")
            panel.plot(time[cut], off, ".", markersize=1.5, color=colour)
            panel.plot([], [], color=colour, label=what)
        panel.set(ylabel="beside it [µm]", ylim=(-280, 280))
        panel.set_title(f"Edge of the mill from the {name}", loc="left", fontsize=10)
        panel.legend(frameon=False, fontsize=8, loc="lower left", ncols=2)
    panel.set(xlabel="time [s]")
    plan.plot([], [], color="black", linewidth=1.2, label="contours of the drawing")
    plan.plot([], [], color="#0072b2", linewidth=0.8, label="centre of the mill")
    plan.set(xlabel="X [mm]", ylabel="Y [mm]", aspect="equal")
    plan.legend(frameon=False, fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.1), ncols=3)
    for axes in figure.axes:
        axes.grid(alpha=0.25)
        axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "pocket.png")
