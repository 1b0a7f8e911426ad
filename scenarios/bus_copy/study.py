"""The driver's run against the bytes it copies out, programmed and in bursts; where it breaks.

    .venv/bin/python scenarios/bus_copy/study.py [picture.png]

A run takes the wait, the copy in and the copy out; it is in time while that is less than the
100 µs that a memory plays.
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import motionfmu
from motionfmu.report.studies.study_picture import save

HERE = Path(__file__).parent
CLOCK = 25e-9  # [s]
CYCLE, SLOT, WAIT = 4000, 200, 20  # [clocks]
KINDS = {  # bytes in, rates of reads and writes [bytes/s]
    "programmed, all inputs": (1024, 6.6e6, 16.5e6),
    "programmed, inputs in use": (32, 6.6e6, 16.5e6),
    "bursts": (1024, 133e6, 133e6),
}
COLOURS = ("#d55e00", "#0072b2", "#009e73")


def theory(out: int, copy_in: int, read: float, write: float) -> int:
    """Clocks of a run."""
    return WAIT + round(copy_in / read / CLOCK) + round(out / write / CLOCK)


def measure(scenario: motionfmu.Scenario, out: int, kind: str) -> tuple[float, float]:
    """Time of a run, and from one memory to the next [s]."""
    copy_in, read, write = KINDS[kind]
    result = scenario.run(
        set={
            "part.bus_bytes_in": copy_in,
            "part.bus_bytes_out": out,
            "part.bus_read_rate": read,
            "part.bus_write_rate": write,
        }
    )
    runs = result["part.runs"][-1] - result["part.runs"][1000]
    took = result.time[-1] - result.time[1000]
    return float(result["part.cycle_time_most"][-1]), took / runs


def last(kind: str) -> int | None:
    """Most bytes out that are in time; None if all 3 KB are, or nothing is."""
    fits = [n for n in range(3073) if theory(n, *KINDS[kind]) < CYCLE]
    return fits[-1] if fits and fits[-1] < 3072 else None


def main(picture: Path) -> None:
    """Run the sweep, print the table, draw the picture."""
    scenario = motionfmu.load(HERE)
    figure, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(9, 6.5))
    print(f"{'kind':28} {'bytes out':>9} {'run':>9} {'formula':>9} {'memory each':>12}  [µs]")
    for colour, kind in zip(COLOURS, KINDS, strict=True):
        edge = last(kind)
        sizes = sorted({*range(0, 3073, 512), 192, *([edge, edge + 1] if edge else [])})
        found = np.array([measure(scenario, n, kind) for n in sizes]) * 1e6
        lines = np.array([theory(n, *KINDS[kind]) for n in sizes]) * CLOCK * 1e6
        for n, (run, each), line in zip(sizes, found, lines, strict=True):
            print(f"{kind:28} {n:9d} {run:9.3f} {line:9.3f} {each:12.2f}")
        above.plot(sizes, lines, color=colour, linewidth=1)
        style = {"color": colour, "linestyle": "", "marker": "o", "markersize": 4}
        above.plot(sizes, found[:, 0], **style, label=kind)
        below.plot(sizes, found[:, 1], color=colour, marker="o", markersize=4, linewidth=1)
    above.axhline(100.0, color="black", linewidth=1, linestyle=":")
    above.set_title("A run of the driver; dotted: its cycle. Lines: formula", loc="left")
    above.set_ylabel("run [µs]")
    below.set_ylabel("from memory to memory [µs]")
    below.set_ylim(0, None)
    below.set_xlabel("bytes copied to the card")
    above.legend(frameon=False)
    save(figure, picture)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "copy.png")
