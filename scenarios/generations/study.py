"""Both generations of the card behind the same late PC: what latency and jitter do to the speed.

    .venv/bin/python scenarios/generations/study.py [picture.png]

One axis at constant feed, one DDA time T for all cards, every interrupt answered after
latency + uniform jitter. The single buffer stands still until the PC has written (direct), or for a
whole T if the PC misses the boundary (latched); the FIFO hides the PC up to (n + 1) T.
"""

import sys
from dataclasses import dataclass, field
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from rich.progress import track

import motionfmu

HERE = Path(__file__).parent
T = 3.072e-3  # [s]
FEED, PULSES = 50.0, 10_000.0  # [mm/s], per mm
WINDOW = (0.3, 1.2)  # [s] of steady motion
LATENCIES = np.concatenate([np.arange(0.2e-3, 3e-3, 0.4e-3), np.arange(3e-3, 16.1e-3, 1e-3)])
JITTERS = (0.0, 2e-3, 6e-3)  # [s]
SHOWN = (2e-3, 6e-3)  # [s] latency and jitter of the traces
INK = "#444444"


@dataclass(frozen=True)
class Card:
    """A card and its setting."""

    name: str
    scenario: str
    colour: str
    deadline: float  # [s] answer after the interrupt that leaves no gap
    settings: dict[str, object] = field(default_factory=dict)


CARDS = (
    Card("single buffer", "single_buffer_long", "#d55e00", 0.0),
    Card("single buffer, latched", "single_buffer_long", "#e69f00", T, {"card.latched": True}),
    Card("FIFO, n = 0, N = 1", "generations", "#56b4e9", T, {"mcc.min_stock": 0, "mcc.batch": 1}),
    Card("FIFO, n = 3, N = 4", "generations", "#0072b2", 4 * T),
)


def run(card: Card, latency: float, jitter: float) -> motionfmu.Result:
    """One second of constant feed."""
    return motionfmu.load(HERE.parent / card.scenario).run(
        set={
            "mcc.program": str(HERE / "line.ngc"),
            "mcc.irq_latency": float(latency),
            "mcc.irq_jitter": jitter,
            "mcc.start_delay": 0.0,
            "mcc.acc_time": 0.05,
            **card.settings,
        },
        stop=WINDOW[1],
    )


def measure(card: Card, latency: float, jitter: float) -> tuple[float, float, float]:
    """Share of commands that came late; mean and lowest speed over 1 ms as shares of the feed."""
    result = run(card, latency, jitter)
    t = result.time
    inside = (t >= WINDOW[0]) & (t <= WINDOW[1])
    t, way = t[inside], result["card.pulse_count"][inside, 0] / PULSES
    late = np.ptp(result["card.underflows"][inside, 0])
    span = round(1e-3 / (t[1] - t[0]))
    speed = (way[span:] - way[:-span]) / (t[span] - t[0])
    commands = (way[-1] - way[0]) / (FEED * T)
    return late / commands, commands * T / (t[-1] - t[0]), float(speed.min() / FEED)


def draw_traces(panels: list, note: str) -> None:
    """Speed against time for the oldest and the newest card."""
    for panel, card in zip(panels, (CARDS[0], CARDS[3]), strict=True):
        result = run(card, *SHOWN)
        t, pulses = result.time, result["card.pulse_count"][:, 0]
        span = round(2e-4 / (t[1] - t[0]))
        speed = (pulses[span:] - pulses[:-span]) / PULSES / (t[span] - t[0])
        panel.plot(t[span:] * 1e3, speed, color=card.colour, linewidth=1)
        panel.set(xlim=(300, 400), ylim=(-2, 58), ylabel="speed [mm/s]")
        panel.set_title(f"{card.name}: {note}", loc="left", fontsize=10, color=INK)
    panels[-1].set_xlabel("time [ms]")


def main(picture: Path) -> None:
    """Run the sweep, print the table, draw the picture."""
    figure = plt.figure(figsize=(10, 9.5), layout="constrained")
    grid = figure.add_gridspec(4, len(JITTERS), height_ratios=(1, 1, 0.6, 0.6))
    jobs = [(i, c, x) for i in range(len(JITTERS)) for c in CARDS for x in LATENCIES]
    found: dict[tuple[int, str], list] = {}
    for i, card, latency in track(jobs, "runs", transient=True, disable=not sys.stdout.isatty()):
        found.setdefault((i, card.name), []).append(measure(card, latency, JITTERS[i]))
    print(f"{'card':24}{'jitter':>8}{'last clean':>12}{'deadline':>10}  [ms]   speed at 8 ms")
    first = None
    for i, jitter in enumerate(JITTERS):
        rate = figure.add_subplot(grid[0, i], sharey=first)
        mean = figure.add_subplot(grid[1, i], sharex=rate)
        first = first or rate
        for card in CARDS:
            late, share, lowest = np.array(found[i, card.name]).T
            style = {"color": card.colour, "marker": "o", "markersize": 3, "label": card.name}
            if card.settings.get("card.latched"):
                style |= {"linewidth": 5, "alpha": 0.5}  # the FIFO with n = 0 lies upon it
            rate.plot(LATENCIES * 1e3, late * 100.0, **style)
            mean.plot(LATENCIES * 1e3, share * 100.0, **style)
            mean.plot(LATENCIES * 1e3, lowest * 100.0, color=card.colour, linestyle=":")
            limit = card.deadline - jitter
            if limit > 0:
                rate.axvline(limit * 1e3, color=card.colour, linewidth=1, linestyle="--")
            clean = LATENCIES[late == 0.0].max(initial=0.0)
            at8 = share[np.argmin(np.abs(LATENCIES - 8e-3))]
            print(
                f"{card.name:24}{jitter * 1e3:8.1f}{clean * 1e3:12.1f}"
                f"{max(limit, 0.0) * 1e3:10.3f}{at8 * 100:14.0f} %"
            )
        rate.set_title(f"jitter {jitter * 1e3:g} ms", loc="left", fontsize=10, color=INK)
        rate.set_ylabel("commands that came late [%]" if i == 0 else "")
        mean.set_ylabel("mean (-) and lowest (:) speed [%]" if i == 0 else "")
        mean.set_xlabel("latency of the PC [ms]")
        mean.set_ylim(-4, 106)
    figure.legend(
        *first.get_legend_handles_labels(), frameon=False, ncols=4, loc="outside lower left"
    )
    late, width = (x * 1e3 for x in SHOWN)
    panels = [figure.add_subplot(grid[k, :]) for k in (2, 3)]
    draw_traces(panels, f"the PC answers after {late:g} to {late + width:g} ms")
    for axes in figure.axes:
        axes.grid(alpha=0.25)
        axes.spines[["top", "right"]].set_visible(False)
    figure.suptitle(
        f"One late PC, two generations of cards (T = {T * 1e3:.3f} ms; dashed: (n + 1) T - jitter)",
        x=0.01,
        ha="left",
        fontweight="bold",
    )
    figure.savefig(picture, dpi=110)
    print(f"picture: {picture}")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "generations.png")
