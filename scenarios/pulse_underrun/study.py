"""Underruns an hour against the slots of a pulse memory, for the waits of three PCs.

    .venv/bin/python scenarios/pulse_underrun/study.py [picture.png]

A run of the driver is late if its wait w is S slots less the copies, or more. With w = L0 + x, x
exponential of mean m, and with the probability e uniform up to U instead:

    P = (1 - e) exp(-B / m) + e (1 - B / U)          B = S * 5 µs - 30.8 µs - L0, rounded to clocks
"""

import math
import sys
from dataclasses import dataclass
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import motionfmu
from motionfmu.report.studies.study_picture import save

HERE = Path(__file__).parent
HERTZ = 40e6
SLOT, LEAST, COPIES = 200, 20, 308 + 924  # [clocks]
OFTEN = 0.02  # probability of a long wait in the quick runs
RARE = 1e-5  # and of the presets
SLOTS = (20, 24, 28, 32, 36, 40, 64, 96, 128)
COLOURS = ("#0072b2", "#d55e00")


@dataclass(frozen=True)
class Waits:
    """A PC: preset, mean [s] and longest [s] of its waits."""

    name: str
    mean: float
    longest: float

    def late(self, slots: int, rare: float) -> float:
        """Probability that an interrupt waits too long."""
        budget = slots * SLOT - COPIES - LEAST - 0.5
        span = self.longest * HERTZ - LEAST
        return (1.0 - rare) * math.exp(-budget / (self.mean * HERTZ)) + rare * max(
            0.0, 1.0 - budget / span
        )

    def hourly(self, slots: int) -> float:
        """Underruns an hour with the preset."""
        return self.late(slots, RARE) * 3600.0 * HERTZ / (slots * SLOT)


PCS = (Waits("good", 1.2e-6, 160e-6), Waits("graphics", 2.7e-6, 667e-6))


def quick(scenario: motionfmu.Scenario, pc: Waits, slots: int) -> tuple[int, int]:
    """Underruns and runs with many long waits."""
    setting = {
        "short.irq_mean": pc.mean,
        "short.irq_longest": pc.longest,
        "short.irq_rare": OFTEN,
        "short.slots": slots,
        "short.seed": slots,
    }
    result = scenario.run(set=setting, stop=20.0)
    return int(result["short_card.underruns"][-1]), int(result["short.runs"][-1])


def presets(scenario: motionfmu.Scenario, slots: int) -> list[tuple[int, float]]:
    """Underruns and seconds of the presets themselves, good and graphics."""
    names, seconds = ("good", "short"), 300.0
    setting: dict[str, object] = {"good.pc": "good", "short.pc": "graphics", "long.pc": "document"}
    setting |= {f"{n}.slots": slots for n in names} | {f"{n}.seed": 11 for n in names}
    result = scenario.run(set=setting, stop=seconds)
    return [(int(result[f"{n}_card.underruns"][-1]), seconds) for n in names]


def main(picture: Path) -> None:
    """Run all, print the tables, draw the picture."""
    scenario = motionfmu.load(HERE)
    figure, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(9, 7))
    every = range(20, 142)
    print(f"{'PC':9} {'slots':>6} {'runs':>7} {'underruns':>10} {'expected':>9} {'sigmas':>7}")
    for colour, pc in zip(COLOURS, PCS, strict=True):
        found = []
        for slots in SLOTS:
            underruns, runs = quick(scenario, pc, slots)
            p = pc.late(slots, OFTEN)
            sigma = math.sqrt(runs * p * (1.0 - p))
            off = (underruns - runs * p) / sigma if sigma else float(underruns > 0)
            found.append((underruns / runs, math.sqrt(underruns) / runs))
            print(f"{pc.name:9} {slots:6d} {runs:7d} {underruns:10d} {runs * p:9.1f} {off:7.2f}")
        share, error = np.array(found).T
        style = {"color": colour, "linestyle": "", "marker": "o", "markersize": 4}
        above.errorbar(SLOTS, share * 100.0, 2.0 * error * 100.0, **style, label=f"{pc.name}: runs")
        above.plot(every, [pc.late(n, OFTEN) * 100.0 for n in every], color=colour, linewidth=1)
        hours = np.array([pc.hourly(n) for n in every])
        below.plot(every, np.where(hours > 0.0, hours, np.nan), color=colour, label=pc.name)
    for k, slots in enumerate((20, 128)):
        for colour, pc, (n, seconds) in zip(COLOURS, PCS, presets(scenario, slots), strict=True):
            expected = pc.hourly(slots) * seconds / 3600.0
            print(
                f"preset {pc.name:9} {slots:4d} slots, {seconds:.0f} s: {n:3d} underruns, "
                f"{expected:.1f} expected"
            )
            if n:
                below.plot(
                    [slots],
                    [n / seconds * 3600.0],
                    "o",
                    color=colour,
                    markersize=6,
                    label=None if k else "preset itself, 300 s",
                )
    print(f"{'slots':>6} {'latency':>8} [µs] {'good':>8} {'graphics':>9} [1/h]")
    for slots in (20, 30, 38, 39, 64, 128, 139, 140):
        good, graphics = (pc.hourly(slots) for pc in PCS)
        print(f"{slots:6d} {slots * 5:8d}      {good:8.2f} {graphics:9.2f}")
    above.set_title(
        "Share of late cycles with 2 % of long waits; lines: formula, bars: 2 sigma", loc="left"
    )
    above.set_ylabel("late [%]")
    below.set_title("Underruns an hour with the presets", loc="left")
    below.set_ylabel("underruns [1/h]")
    below.set_yscale("log")
    below.set_ylim(0.1, 1000.0)
    below.axvline(128, color="black", linewidth=1, linestyle=":")
    below.set_xlabel("slots of a pulse memory, 5 µs each; dotted: 4 KB have no more")
    for axes in (above, below):
        axes.legend(frameon=False)
    save(figure, picture)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "underruns.png")
