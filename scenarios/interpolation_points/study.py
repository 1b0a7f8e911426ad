"""Contour error of the pulses against the number of interpolation points of a circle.

    .venv/bin/python scenarios/interpolation_points/study.py [picture.png]

The pulses of one DDA time T run along a chord: error R (1 - cos(V T/(2 R))). With the FIFO twice
the points cost no more interrupts: N commands per interrupt are doubled while T is halved.
"""

import math
import sys
from dataclasses import dataclass
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from rich.progress import track

import motionfmu

HERE = Path(__file__).parent
RADIUS, FEED, PULSES = 10.0, 100.0, 8000.0  # [mm], [mm/s], per mm
TICKS = 2**15 * 25e-9  # [s] DDA time at divider 1
BATCH = {48: 1, 24: 2, 12: 4, 6: 8, 3: 16}  # commands per interrupt by divider
SHOWN = {48: "#d55e00", 24: "#e69f00", 6: "#0072b2"}


@dataclass
class Row:
    """A setting and what came of it."""

    divider: int
    error: float  # [mm] largest distance of the pulses from the circle
    interrupts: float  # per second of cutting
    path: np.ndarray  # [mm] (n, 2) of the circle

    @property
    def time(self) -> float:
        """DDA time [s]."""
        return self.divider * TICKS

    @property
    def points(self) -> float:
        """Points of a turn."""
        return 2.0 * math.pi * RADIUS / (FEED * self.time)

    @property
    def theory(self) -> float:
        """Sagitta of a chord [mm]."""
        return RADIUS * (1.0 - math.cos(FEED * self.time / (2.0 * RADIUS)))


def measure(divider: int) -> Row:
    """Run the circle with this DDA time."""
    result = motionfmu.load(HERE).run(
        set={
            "mcc.dda_time": divider * TICKS,
            "mcc.batch": BATCH[divider],
            "mcc.min_stock": max(3, BATCH[divider] - 1),
            "mcc.irq_latency": 2e-4,
        }
    )
    cut = np.flatnonzero(result["mcc.path_feed"] > 0.999 * FEED)
    span = slice(cut[0], cut[-1])
    served = np.ptp(result["mcc.services"][span]) / np.ptp(result.time[span])
    path = result["card.pulse_count"][:, :2] / PULSES
    return Row(divider, result.contour().command_error.max, float(served), path)


def draw(rows: list[Row], picture: Path) -> None:
    """Paths of three settings beside error against points."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 5), layout="constrained")
    angle = np.linspace(0.0, 0.5 * math.pi, 400)
    left.plot(RADIUS * np.cos(angle), RADIUS * np.sin(angle), color="black", linewidth=0.8)
    for row in rows:
        if row.divider in SHOWN:
            label = f"{row.points:.0f} points a turn"
            left.plot(*row.path.T, color=SHOWN[row.divider], linewidth=1.6, label=label)
    left.set(xlim=(4.5, 10.2), ylim=(4.5, 10.2), aspect="equal", xlabel="X [mm]", ylabel="Y [mm]")
    left.set_title("Pulses put out, and the circle (black)", loc="left", fontsize=10)
    left.legend(frameon=False, loc="lower left")
    points = np.array([r.points for r in rows])
    many = np.geomspace(points.min() * 0.8, points.max() * 1.25, 100)
    right.loglog(many, RADIUS * (1.0 - np.cos(math.pi / many)) * 1e3, color="black", linewidth=0.8)
    right.loglog(points, [r.error * 1e3 for r in rows], "o", color="#0072b2", label="measured")
    right.plot([], [], color="black", linewidth=0.8, label="R (1 - cos(pi/N))")
    for row in rows:
        text = f"{row.interrupts:.1f} interrupts/s"
        right.annotate(
            text, (row.points, row.error * 1e3), (6, 4), textcoords="offset points", fontsize=8
        )
    right.set(xlabel="interpolation points a turn", ylabel="largest error of the pulses [µm]")
    right.set_xlim(right=points.max() * 2.2)
    right.set_xticks(points, [f"{n:.0f}" for n in points])
    right.minorticks_off()
    right.set_title("Four times less error for twice the points", loc="left", fontsize=10)
    right.legend(frameon=False, loc="lower left")
    for axes in (left, right):
        axes.grid(alpha=0.25, which="both" if axes is left else "major")
        axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(picture, dpi=120)


def main(picture: Path) -> None:
    """Run the sweep, print the table, draw the picture."""
    quiet = not sys.stdout.isatty()
    rows = [measure(d) for d in track(BATCH, "runs", transient=True, disable=quiet)]
    print(
        f"{'T [ms]':>9}{'points':>8}{'error [µm]':>12}{'theory [µm]':>13}"
        f"{'N':>4}{'interrupts/s':>14}"
    )
    for r in rows:
        print(
            f"{r.time * 1e3:9.3f}{r.points:8.1f}{r.error * 1e3:12.3f}{r.theory * 1e3:13.3f}"
            f"{BATCH[r.divider]:4d}{r.interrupts:14.1f}"
        )
    draw(rows, picture)
    print(f"picture: {picture}")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "points.png")
