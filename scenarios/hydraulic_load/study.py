"""What the laws hold under load and without, over the overlap of the valve.

    .venv/bin/python scenarios/hydraulic_load/study.py [picture.png]

1 kN comes at 0.25 s and goes at 2.25 s. Held is the largest error in the last second with the load,
and in the last two without it.
"""

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray
from rich.progress import track

import motionfmu

HERE = Path(__file__).parent
ON, OFF, STOP = 0.25, 2.25, 6.25  # [s]
FORCE = 1000.0  # [N]
OVERLAPS = (0.0, 0.0025, 0.005, 0.01, 0.015, 0.02, 0.03)
LAWS: dict[str, dict[str, Any]] = {
    "P": {"controller.law": 0},
    "literal, band 50": {
        "controller.law": 1,
        "controller.i_gain": 1500,
        "controller.band": 50,
        "controller.band_outside": 0,
    },
    "true, band 100": {},
}
COLOURS = ("#555555", "#0072b2", "#d55e00")


@dataclass(frozen=True)
class Held:
    """Error over time, and what is held."""

    time: NDArray[np.float64]  # [s]
    error: NDArray[np.int32]  # [counts]

    def within(self, low: float, high: float) -> int:
        """Largest error in a window [counts]."""
        return int(np.abs(self.error[(self.time >= low) & (self.time <= high)]).max())

    @property
    def loaded(self) -> int:
        """In the last second with the load [counts]."""
        return self.within(OFF - 1.0, OFF)

    @property
    def free(self) -> int:
        """In the last two seconds [counts]."""
        return self.within(STOP - 2.0, STOP)


def run(overlap: float, law: dict[str, Any]) -> Held:
    """One load on and off."""
    load = {"input": "axis.force", "at": [ON, OFF], "value": [FORCE, 0.0]}
    scenario = motionfmu.load(HERE).changed(stop=STOP, drive=[load])
    r = scenario.run(set={"axis.valve_overlap": overlap} | law)
    return Held(r.time, r["controller.error"])


def draw(found: dict[str, list[Held]], picture: Path) -> None:
    """Errors over time for the two ends of the range, what is held over the overlap."""
    figure, axes = plt.subplots(2, 2, figsize=(13.0, 7.5), layout="constrained")
    for column, (index, title) in enumerate(
        ((0, "No overlap"), (len(OVERLAPS) - 1, "Overlap of 3 %"))
    ):
        panel = axes[0, column]
        for (name, held), colour in zip(found.items(), COLOURS, strict=True):
            panel.plot(held[index].time, held[index].error, color=colour, linewidth=1, label=name)
        panel.set_title(f"{title}: 1 kN on at 0.25 s, off at 2.25 s", loc="left", fontsize=11)
        panel.set_xlabel("time [s]")
        panel.set_ylabel("error [counts]")
        panel.set_yscale("symlog", linthresh=2.0)
        ticks = (-100, -10, -1, 0, 1, 10, 100)
        panel.set_yticks(ticks, [str(x) for x in ticks])
        low = axes[1, column]
        for (name, held), colour in zip(found.items(), COLOURS, strict=True):
            values = [h.free if column else h.loaded for h in held]
            low.plot(np.array(OVERLAPS) * 100, values, "o-", color=colour, label=name)
        low.axhline(1.0, color="#444444", linestyle=":", linewidth=1.0)
        low.set_title("Held without load" if column else "Held under 1 kN", loc="left", fontsize=11)
        low.set_xlabel("overlap of the valve [% of the stroke]")
        low.set_ylabel("largest error [counts]")
        low.set_yscale("symlog", linthresh=2.0)
        low.set_yticks([0, 1, 2, 5, 20, 100], ["0", "1", "2", "5", "20", "100"])
        low.set_ylim(-0.2, 400.0)
    axes[0, 0].legend(frameon=False)
    for panel in axes.flat:
        panel.grid(alpha=0.25)
        panel.spines[["top", "right"]].set_visible(False)
    figure.savefig(picture, dpi=100)


def main(picture: Path) -> None:
    """Run all cases; print the table, draw the picture."""
    found = {
        name: [run(x, law) for x in track(OVERLAPS, name, transient=True)]
        for name, law in LAWS.items()
    }
    print("| overlap | " + " | ".join(f"{x * 100:g} %" for x in OVERLAPS) + " |")
    print("|---" * (len(OVERLAPS) + 1) + "|")
    for name, held in found.items():
        print(f"| {name} | " + " | ".join(f"{h.loaded} / {h.free}" for h in held) + " |")
    draw(found, picture)
    print(f"picture: {picture}")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "held.png")
