"""Underflows and velocity gaps against the latency of the PC, for three settings of the FIFO.

    .venv/bin/python scenarios/fifo_latency/study.py [picture.png]

The deadline of a refill is (n + 1) T: one command is in the DDA and n wait when it is asked for.
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
from motionfmu.report.studies.study_picture import save

HERE = Path(__file__).parent
BASE = 2**12 * 10 * 25e-9  # [s] DDA time of the first two settings
LATENCIES = np.arange(0.25e-3, 7.01e-3, 0.25e-3)  # [s]
FEED = 50.0  # [mm/s]
PULSES = 1000.0  # per mm


@dataclass(frozen=True)
class Setting:
    """A FIFO setting: stock n at the interrupt, N commands per interrupt, DDA time T [s]."""

    minimum: int
    batch: int
    time: float

    @property
    def name(self) -> str:
        """How the picture calls it."""
        return f"n = {self.minimum}, N = {self.batch}, T = {self.time * 1e3:.3f} ms"

    @property
    def deadline(self) -> float:
        """Latest refill after the interrupt [s]."""
        return (self.minimum + 1) * self.time


SETTINGS = (Setting(0, 1, BASE), Setting(3, 4, BASE), Setting(7, 8, BASE / 2))


def measure(scenario: motionfmu.Scenario, setting: Setting, latency: float) -> tuple[float, float]:
    """Underflows per second of cutting, and the lowest speed over the programmed one."""
    result = scenario.run(
        set={
            "mcc.min_stock": setting.minimum,
            "mcc.batch": setting.batch,
            "mcc.dda_time": setting.time,
            "mcc.irq_latency": float(latency),
            "mcc.irq_jitter": 0.0,
        },
        stop=5.0,  # a PC that is late slows the motion down
    )
    steady = np.flatnonzero(np.abs(result["mcc.path_feed"] - FEED) < 1e-4 * FEED)
    window = slice(steady[0] + 500, steady[-1] - 500)
    t, pulses = result.time[window], result["card.pulse_count"][window, :2]
    lost = np.ptp(result["card.underflows"][window].max(axis=1))
    # Speed over one DDA time, the resolution the card has.
    span = round(setting.time / (t[1] - t[0]))
    way = np.hypot(*(pulses[span:] - pulses[:-span]).T) / PULSES
    return lost / (t[-1] - t[0]), float(way.min() / (span * (t[1] - t[0])) / FEED)


def main(picture: Path) -> None:
    """Run the sweep, print the table, draw the picture."""
    scenario = motionfmu.load(HERE)
    figure, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(9, 6.5))
    print(f"{'setting':32} {'deadline':>9} {'last without gap':>17} {'first with gap':>15}  [ms]")
    for colour, setting in zip(("#d55e00", "#0072b2", "#009e73"), SETTINGS, strict=True):
        found = [
            measure(scenario, setting, x)
            for x in track(LATENCIES, setting.name, transient=True, disable=not sys.stdout.isatty())
        ]
        rate, speed = np.array(found).T
        style = {"color": colour, "marker": "o", "markersize": 4, "label": setting.name}
        if setting is SETTINGS[2]:
            style |= {"linestyle": "--", "markerfacecolor": "white"}
        above.plot(LATENCIES * 1e3, rate, **style)
        below.plot(LATENCIES * 1e3, speed * 100.0, **style)
        for axes in (above, below):
            axes.axvline(setting.deadline * 1e3, color=colour, linewidth=1, linestyle=":")
        clean, gap = LATENCIES[rate == 0.0].max(initial=0.0), LATENCIES[rate > 0.0].min(initial=1.0)
        print(
            f"{setting.name:32} {setting.deadline * 1e3:9.3f} {clean * 1e3:17.3f} {gap * 1e3:15.3f}"
        )
    above.set_title("A late PC: gaps begin at the deadline (n + 1) T (dotted)", loc="left")
    above.set_ylabel("underflows [1/s]")
    below.set_ylabel("lowest speed [% of feed]")
    below.set_xlabel("interrupt latency of the PC [ms]")
    below.set_ylim(-5, 110)
    above.legend(frameon=False)
    save(figure, picture)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "latency.png")
