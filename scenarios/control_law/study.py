"""What each part of the control law buys, on the same paths.

    .venv/bin/python scenarios/control_law/study.py [picture.png]

Runs the scenario with the P law alone and with feed-forward, matched-lag pre-filter and
cross-coupled control added to it, and shows the contour error on a line, a square corner and a
circle.
"""

import sys
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import motionfmu
from motionfmu.analysis.contour import ContourResult

HERE = Path(__file__).parent
GAINS = (40.0, 30.0)  # [1/s] Kx, Ky
SLOWEST = 1.0 / min(GAINS)  # [s]
CROSS, INTEGRAL = 100.0, 2000.0  # [1/s], [1/s²]
# Lines of the part program.
PATHS = {"line at 30°": (4,), "square corner": (9, 10), "circle R20": (13, 15)}
# Time from the start of a path that counts [s]: without the stops at its ends.
AROUND = {"square corner": (0.4, 1.1)}
OFF: dict[str, Any] = {
    "mcc.velocity_ff": 0.0,
    "mcc.command_lag": 0.0,
    "mcc.cross_gain": 0.0,
    "mcc.cross_integral": 0.0,
}


def six(values: Iterable[float]) -> list[float]:
    """Values of X and Y as the FMU wants them."""
    return [*values, 0.0, 0.0, 0.0, 0.0]


FORWARD = {"mcc.velocity_ff": six((1.0, 1.0))}
LAG = {"mcc.command_lag": six(SLOWEST - 1.0 / k for k in GAINS)}
COUPLED = {"mcc.cross_gain": CROSS, "mcc.cross_integral": INTEGRAL}
CASES: dict[str, dict[str, Any]] = {
    "P": {},
    "P + feed-forward": FORWARD,
    "P + pre-filter": LAG,
    "P + CCC": COUPLED,
    "P + feed-forward + CCC": FORWARD | COUPLED,
}
COLOURS = ("#555555", "#0072b2", "#009e73", "#d55e00", "#cc79a7")


@dataclass(frozen=True)
class Case:
    """A law and its contour error."""

    name: str
    contour: ContourResult
    following: float  # [mm] largest

    def on(self, path: str) -> tuple[np.ndarray, np.ndarray]:
        """Time from the start of a path [s], and the error with its sign [mm]."""
        c = self.contour
        lines = np.array([s.label.line for s in c.run.path.segments])[c.track.segment]
        own = np.isin(lines, PATHS[path]) & c.cutting
        signed = c.track.signed
        assert signed is not None
        time = c.run.time[own] - c.run.time[own][0]
        low, high = AROUND.get(path, (0.0, np.inf))
        chosen = (time >= low) & (time <= high)
        return time[chosen], signed[own][chosen]

    def size(self, path: str) -> tuple[float, float]:
        """Largest and RMS error on a path [mm]."""
        error = self.on(path)[1]
        return float(np.abs(error).max()), float(np.sqrt(np.mean(error**2)))

    def steady(self, path: str) -> float:
        """Mean error in the middle third of a path [mm]."""
        error = self.on(path)[1]
        return float(np.mean(error[len(error) // 3 : 2 * len(error) // 3]))


def run(name: str, more: dict[str, Any]) -> Case:
    """Run the scenario with one law."""
    result = motionfmu.load(HERE).run(set=OFF | more)
    assert result["mcc.done"][-1] and not result["mcc.error"].any()
    contour = result.contour()
    return Case(name, contour, float(np.abs(contour.following[contour.cutting]).max()))


def draw(cases: list[Case], picture: Path) -> None:
    """Error over time, and its size, on each path."""
    figure, axes = plt.subplots(
        2, len(PATHS), figsize=(13.5, 8.0), height_ratios=[3, 2], layout="constrained"
    )
    for column, path in enumerate(PATHS):
        top, low = axes[0, column], axes[1, column]
        for case, colour in zip(cases, COLOURS, strict=True):
            time, error = case.on(path)
            gaps = np.flatnonzero(np.diff(time) > 0.01) + 1
            top.plot(
                np.insert(time, gaps, np.nan),
                np.insert(error * 1e3, gaps, np.nan),
                color=colour,
                linewidth=1.2,
                label=case.name,
            )
        top.set_title(path, loc="left", fontsize=12)
        top.set_xlabel("time from the start of the path [s]")
        sizes = np.array([case.size(path) for case in cases]) * 1e3
        place = np.arange(len(cases))
        for shift, kind, alpha in ((-0.2, 0, 1.0), (0.2, 1, 0.45)):
            bars = low.bar(place + shift, sizes[:, kind], width=0.38, color=COLOURS, alpha=alpha)
            low.bar_label(bars, fmt="%.3g", fontsize=8, padding=1)
        low.set_yscale("log")
        low.set_ylim(0.1, 1500.0)
        low.set_xticks(place, [c.name.replace("P + ", "+ ", 1) for c in cases], fontsize=8)
        for label in low.get_xticklabels():
            label.set(rotation=20, horizontalalignment="right", rotation_mode="anchor")
        for a in (top, low):
            a.grid(alpha=0.25)
            a.spines[["top", "right"]].set_visible(False)
    axes[0, 0].set_ylabel("contour error, positive to the left [µm]")
    axes[1, 0].set_ylabel("largest (full), RMS (pale) [µm]")
    axes[0, 0].legend(frameon=False, fontsize=9)
    figure.suptitle(
        "The same paths with Kx = 40/s, Ky = 30/s: what each part of the control law buys",
        x=0.01,
        ha="left",
        fontweight="bold",
    )
    figure.savefig(picture, dpi=100)


def main(picture: Path) -> None:
    """Run all cases; print the table, draw the picture."""
    cases = [run(name, more) for name, more in CASES.items()]
    print("| [µm] max / RMS | " + " | ".join(PATHS) + " | line, steady | lag of an axis |")
    print("|---" * (len(PATHS) + 3) + "|")
    for case in cases:
        sizes = [" / ".join(f"{x * 1e3:.1f}" for x in case.size(path)) for path in PATHS]
        steady = case.steady("line at 30°") * 1e3
        last = f"{steady:.1f} | {case.following * 1e3:.0f}"
        print(f"| {case.name} | " + " | ".join(sizes) + f" | {last} |")
    draw(cases, picture)
    print(f"picture: {picture}")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "control_law.png")
