"""Reactions of all layers as histograms and one table, 10,000 edges each at least.

    .venv/bin/python scenarios/layers/study.py [picture.png]

An edge is uniform over the period of the layer that sees it, so a reaction is uniform from
`least` to `least` + period, both whole clocks.
"""

import sys
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import motionfmu
from motionfmu.report.studies.study_picture import save

HERE = Path(__file__).parent
CLOCK = 25e-9  # [s]
SLOT, CYCLE, BUS = 200, 4000, 100  # [clocks]
WAIT, ACCESS, RUN = 20, 40, 20 + 308 + 924  # [clocks]
TICK, POLL = 400_000, 1_440_000  # [clocks]
EDGES, STOP = 10_000, 30.0  # [s]


def exchange(clock: int) -> int:
    """The card's exchange at or behind a clock."""
    return -(-clock // SLOT) * SLOT


def shortest_by_user() -> int:
    """From the interrupt of the copy that a poll sees to the answer [clocks]."""
    first = CYCLE + (RUN // SLOT + 1) * SLOT  # interrupt at which the card's first memory begins
    copies = np.arange(first, POLL, CYCLE)
    seen = copies[copies + WAIT + 308 <= POLL][-1]
    run = first + -(-(POLL - WAIT - first) // CYCLE) * CYCLE
    return int(exchange(run + RUN) - seen)


@dataclass(frozen=True)
class Layer:
    """Channels of a layer; its shortest reaction, the period of its looks [clocks]."""

    name: str
    channels: range
    least: int
    period: int

    @property
    def mean(self) -> float:
        """Of the reactions [clocks]."""
        return self.least + (self.period - 1) / 2.0


LAYERS = (
    Layer("FPGA logic", range(0, 1), 0, SLOT),
    Layer("interrupt", range(1, 2), exchange(WAIT + ACCESS), SLOT),
    Layer("driver", range(2, 3), exchange(RUN), CYCLE),
    # A tick sees the image of the instant before it.
    Layer("driver's timer", range(3, 10), exchange(BUS) + exchange(ACCESS), TICK),
    Layer("user program", range(10, 32), shortest_by_user(), POLL),
)
COLOURS = ("#009e73", "#56b4e9", "#0072b2", "#e69f00", "#d55e00")


def reactions() -> list[np.ndarray]:
    """Of each layer [clocks]."""
    scenario = motionfmu.load(HERE)
    with TemporaryDirectory() as folder:
        file = Path(folder) / "edges.csv"
        scenario.run(set={"analyser.record_file": str(file)}, stop=STOP)
        rows = np.loadtxt(file, delimiter=",", skiprows=1, dtype=np.int64)
    return [(rows[:, 2] - rows[:, 1])[np.isin(rows[:, 0], layer.channels)] for layer in LAYERS]


def text(clocks: float) -> str:
    """A time in µs or ms."""
    micro = clocks * CLOCK * 1e6
    return f"{micro:.3f} µs" if micro < 1000.0 else f"{micro / 1000.0:.3f} ms"


def main(picture: Path) -> None:
    """Run, print the table, draw the picture; an error if a layer is not as its formula has it."""
    figure, axes = plt.subplots(figsize=(9, 4.5))
    print("| layer | edges | least | median | mean | formula | off | most | formula |")
    print("|---|---|---|---|---|---|---|---|---|")
    medians, longest = [], []
    for layer, colour, found in zip(LAYERS, COLOURS, reactions(), strict=True):
        off = found.mean() / layer.mean - 1.0
        end = layer.least + layer.period - 1
        cells = [
            layer.name,
            str(len(found)),
            text(found.min()),
            text(float(np.median(found))),
            text(found.mean()),
            text(layer.mean),
            f"{off * 100.0:+.2f} %",
            text(found.max()),
            text(end),
        ]
        print("| " + " | ".join(cells) + " |")
        if len(found) < EDGES or abs(off) > 0.02 or found.min() < layer.least or found.max() > end:
            raise SystemExit(f"{layer.name}: not as the formula has it")
        medians.append(float(np.median(found)))
        longest.append(int(found.max()))
        bins = np.geomspace(2e-7, 0.1, 115).tolist()
        axes.hist(
            np.maximum(found * CLOCK, 2.1e-7),
            bins,
            weights=np.full(len(found), 100.0 / len(found)),
            color=colour,
            alpha=0.75,
            label=layer.name,
        )
        axes.axvline(layer.mean * CLOCK, color=colour, linewidth=1, linestyle=":")
    if sorted(medians) != medians or sorted(longest) != longest:
        raise SystemExit("medians or maxima are in another order")
    axes.set_xscale("log")
    axes.set_xlabel("from edge to answer [s]; dotted: mean by the formula")
    axes.set_ylabel("edges [%]")
    axes.set_title("Reactions of the layers, 10,000 edges or more each", loc="left")
    axes.legend(frameon=False)
    save(figure, picture)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "reactions.png")
