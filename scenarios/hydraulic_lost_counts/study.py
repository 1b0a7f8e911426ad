"""Counts lost per second over speed: as written and repaired, for three lengths of timer routine.

    .venv/bin/python scenarios/hydraulic_lost_counts/study.py [picture.png]

The valve is held open, the axis runs at a constant speed, and a finer scale makes edges come as
fast as wanted. The closed form: one edge per timer period keeps the processor's flag until the
timer's routine and its own service are over; those that come meanwhile are lost.
"""

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
CLOCK, PERIOD = 8e6, 1e-3  # [Hz] processor, [s] timer
LATENCY = 6  # [clocks] from an interrupt's acceptance to its first instruction
# Clocks from acceptance to what decides, upwards, A rising, A falling, B rising, B falling: as
# written the flags are cleared, repaired the level is read.
WRITTEN, REPAIRED = (31, 39, 45, 50), (21, 27, 34, 41)
CYCLES = (400, 200, 100)  # of the timer's routine
SETTLED, STOP = 0.2, 0.4  # [s]
SHARES = np.array([0.9, 0.97, 1.03, 1.06, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.8])  # of the border
VOLTS, SPEED = 8.0, 0.1944  # [V] of the held valve, [m/s] that it gives
BLUE, ORANGE = "#0072b2", "#d55e00"


@dataclass(frozen=True)
class Rate:
    """Edges per second at one speed, and what became of them."""

    speed: float  # [counts/s]
    lost: tuple[float, float]  # [1/s] as written, repaired
    turned: tuple[float, float]  # [1/s]

    @property
    def wrong(self) -> tuple[float, float]:
        """Counts by which the counter falls behind, a turned edge twice [1/s]."""
        a, b = (x + 2 * y for x, y in zip(self.lost, self.turned, strict=True))
        return a, b


def border(cycles: int, way: tuple[int, ...]) -> float:
    """Speed beyond which the first count goes wrong [counts/s]."""
    return CLOCK / (LATENCY + cycles + max(way) + 1)


def theory(cycles: int, way: tuple[int, ...], speed: np.ndarray) -> np.ndarray:
    """Mean of floor((W - x) v) per timer period, x the place of its first edge: W v - 1 [1/s]."""
    mean = LATENCY + cycles + sum(way) / len(way)
    return np.maximum(mean * speed / CLOCK - 1.0, 0.0) / PERIOD


def held(cycles: int, speed: float) -> motionfmu.Result:
    """Run the axis with the valve held open and a scale that gives about this speed."""
    valve = {"input": "axis.voltage", "at": [0.0], "value": [VOLTS]}
    values = {"axis.scale_pitch": pitch(speed)}
    values |= {f"{n}.timer_cycles": cycles for n in ("written", "repaired")}
    return motionfmu.load(HERE).changed(drive=[valve]).run(stop=STOP, set=values)


def pitch(speed: float) -> float:
    """Line period of the scale that gives about this speed [m]."""
    return 4 * SPEED / speed


def measure(r: motionfmu.Result) -> Rate:
    """Rates of a run, once it has settled."""
    first = int(np.searchsorted(r.time, SETTLED))
    time = r.time[-1] - r.time[first]

    def rate(name: str) -> tuple[float, float]:
        a, b = ((r[f"{c}.{name}"][-1] - r[f"{c}.{name}"][first]) / time for c in NAMES)
        return float(a), float(b)

    return Rate(rate("edges")[0], rate("lost"), rate("turned"))


NAMES = ("written", "repaired")


def draw(found: dict[int, list[Rate]], picture: Path) -> None:
    """A column per timer routine: lost edges above, what the counter falls behind below."""
    figure, axes = plt.subplots(
        2, len(found), figsize=(13.0, 7.0), sharex="col", layout="constrained"
    )
    for column, (cycles, rates) in enumerate(found.items()):
        speed = np.array([r.speed for r in rates])
        for k, (way, colour, name) in enumerate(
            ((WRITTEN, BLUE, "as written"), (REPAIRED, ORANGE, "repaired"))
        ):
            edge = border(cycles, way)
            top, low = axes[0, column], axes[1, column]
            lost = np.array([r.lost[k] for r in rates])
            wrong = np.array([r.wrong[k] for r in rates])
            top.plot(speed / 1e3, lost, "o", color=colour, markersize=4, label=name)
            low.plot(speed / 1e3, wrong, "o-", color=colour, markersize=4, linewidth=0.8)
            for panel in (top, low):
                panel.axvline(edge / 1e3, color=colour, linestyle=":", linewidth=1.2)
            if k == 0:
                line = theory(cycles, way, speed)
                top.plot(speed / 1e3, line, color="#444444", linewidth=1.0, label="(W v - 1)/T")
        axes[0, column].set_title(f"timer routine of {cycles} cycles", loc="left", fontsize=11)
        axes[1, column].set_xlabel("speed [1000 counts/s]")
    axes[0, 0].set_ylabel("edges lost [1/s]")
    axes[1, 0].set_ylabel("counter falls behind [counts/s]")
    axes[0, 0].legend(frameon=False)
    for panel in axes.flat:
        panel.grid(alpha=0.25)
        panel.spines[["top", "right"]].set_visible(False)
    figure.suptitle(
        "Lost counts over speed; dotted: the border speeds", x=0.01, ha="left", fontweight="bold"
    )
    figure.savefig(picture, dpi=100)


def main(picture: Path) -> None:
    """Run all speeds; print the table, draw the picture."""
    found: dict[int, list[Rate]] = {}
    for cycles in CYCLES:
        edge = border(cycles, WRITTEN)
        # Off whole numbers of edges per timer period, which would all fall alike.
        speeds = (np.floor(edge * SHARES * PERIOD) + 0.382) / PERIOD
        what = f"{cycles} cycles"
        found[cycles] = [measure(held(cycles, v)) for v in track(speeds, what, transient=True)]
        print(f"{what}: border {edge:.0f} as written, {border(cycles, REPAIRED):.0f} repaired")
        print(f"{'counts/s':>10}{'lost':>8}{'theory':>8}{'behind':>8}   repaired: lost, behind")
        for r in found[cycles]:
            expected = theory(cycles, WRITTEN, np.array([r.speed]))[0]
            row = f"{r.speed:10.0f}{r.lost[0]:8.0f}{expected:8.0f}{r.wrong[0]:8.0f}"
            print(row + f"{r.lost[1]:8.0f}{r.wrong[1]:8.0f}")
    draw(found, picture)
    print(f"picture: {picture}")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "lost_counts.png")
