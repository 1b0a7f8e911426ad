"""Draw what the machine makes of the curve, its copy and its lines: spline.png.

.venv/bin/python scenarios/spline/picture.py [picture.png]
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import motionfmu

HERE = Path(__file__).parent
GAIN = 47.7  # [1/s] of the position loop, gain 200
SPEED = 50.0  # [mm/s]
RADIUS = 11.34  # [mm] of the wave at its top: 33^2/96
# Commands of the curve, its copy, its lines; colour; shift to the curve's place, size, turn.
PARTS = (
    ("curve (G5, G5.1)", (1, 3), "#0072b2", (0.0, 0.0), 1.0, 0.0),
    ("copy (G51 P0.5, G68 R90)", (5, 7), "#e69f00", (95.0, -35.0), 0.5, np.pi / 2.0),
    ("lines of 0.25 mm (G64 P0.02)", (9, 451), "#009e73", (0.0, -35.0), 1.0, 0.0),
)


def main(picture: Path) -> None:
    """Run, print the largest deviations, draw."""
    result = motionfmu.load(HERE).run()
    contour = result.contour()
    command, place = result["mcc.command"], result["machine.table_position"][:, :2] * 1e3
    figure, (left, right) = plt.subplots(1, 2, figsize=(12, 4.6), layout="constrained")
    for name, (first, last), colour, zero, size, turn in PARTS:
        here = (command >= first) & (command <= last) & contour.cutting
        left.plot(*place[here].T, color=colour, linewidth=1.5, label=name)
        own = place[here] - zero
        along = (own @ [np.cos(turn), np.sin(turn)]) / size
        off = np.abs(contour.track.signed[here]) * 1e3
        line = {"linestyle": "--", "linewidth": 2.2} if first == 9 else {"linewidth": 1.2}
        right.plot(along, off, color=colour, label=name, **line)
        middle = (along > 10.0) & (along < 50.0)
        print(f"{name}: {off[middle].max():.1f} µm on the wave")
    left.set(xlabel="X [mm]", ylabel="Y [mm]", aspect="equal")
    left.set_title("Table of the machine", loc="left", fontsize=10)
    left.legend(frameon=False, loc="upper center", fontsize=8, bbox_to_anchor=(0.5, -0.2), ncols=3)
    for size in (1.0, 0.5):
        lag = SPEED**2 / (2.0 * GAIN**2 * RADIUS * size) * 1e3
        text = "V²/(2 Kp² R) at the top of the wave, curve and copy" if size == 1.0 else None
        right.axhline(lag, color="#777777", linestyle=":", linewidth=1.2, label=text)
    right.legend(handles=right.lines[-2:-1], frameon=False, fontsize=8, loc="upper center")
    right.set(xlabel="along the curve, in its own size [mm]", ylabel="contour error [µm]")
    right.set(xlim=(0, 80), ylim=(0, None))
    right.set_title("Distance from the exact curve", loc="left", fontsize=10)
    for axes in (left, right):
        axes.grid(alpha=0.25)
        axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "spline.png")
