"""The last times that the 100 µs cycle holds and the next that break it; what a short queue costs.

    .venv/bin/python scenarios/line_latency/study.py [picture.png]

wait + copy in + lines + points + copy out < 4000 clocks, with what runs together: up to four lines,
or a point. A user program that reads n lines of length a poll moves no faster than n length / poll.
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
CYCLE, SLOT = 4000, 200  # [clocks]
WAIT, COPY_IN, COPY_OUT, POINT = 20, 308, 924, 1440  # [clocks] the document's
BYTES_OUT, LINES = 3072, 4
MOVES, LENGTH, ACC, POLL = 40, 0.5, 2000.0, 36e-3  # [mm], [mm/s²], [s]


def setting(quantity: str, clocks: int) -> dict[str, float]:
    """What gives a quantity so many clocks."""
    if quantity == "copy out":
        return {"document.bus_write_rate": BYTES_OUT / (clocks * CLOCK)}
    names = {"wait": "irq_latency", "four lines": "line_time", "a point": "ik_time"}
    share = LINES if quantity == "four lines" else 1
    return {f"document.{names[quantity]}": clocks // share * CLOCK}


def most(quantity: str) -> int:
    """Clocks of a quantity that just hold."""
    rest = {
        "wait": COPY_IN + POINT + COPY_OUT,
        "copy out": WAIT + COPY_IN + POINT,
        "a point": WAIT + COPY_IN + COPY_OUT,
        "four lines": WAIT + COPY_IN + COPY_OUT,
    }
    left = CYCLE - 1 - rest[quantity]
    return left // LINES * LINES if quantity == "four lines" else left


def leaves(line: int) -> int:
    """Clocks from an interrupt to the first slot of its lines, of so many clocks each."""
    run = WAIT + COPY_IN + COPY_OUT + LINES * line
    return max(CYCLE, (run // SLOT + 1) * SLOT)


def queue_time(depth: int) -> float:
    """Time of all moves if a user program reads so many at a poll, from rest to rest [s]."""
    group = 2.0 * np.sqrt(depth * LENGTH / ACC)
    return float(MOVES / depth * POLL + group)


def rests(depth: int) -> bool:
    """Whether the arm has come to rest before the next poll."""
    return bool(2.0 * np.sqrt(depth * LENGTH / ACC) < POLL)


def main(picture: Path) -> None:
    """Run all, print the tables, draw the picture."""
    scenario = motionfmu.load(HERE)
    print(f"{'quantity':12} {'clocks':>7} {'time':>9} {'run':>9} [µs] {'underruns':>10}")
    for quantity in ("wait", "copy out", "a point", "four lines"):
        for clocks in (most(quantity), most(quantity) + (LINES if "lines" in quantity else 1)):
            result = scenario.run(set=setting(quantity, clocks))
            run = result["document.cycle_time_most"][-1] * 1e6
            print(
                f"{quantity:12} {clocks:7d} {clocks * CLOCK * 1e6:9.3f} {run:9.3f}      "
                f"{result['document_card.underruns'][-1]:10d}"
            )
    times = np.unique([*range(0, 2401, 160), 686, 687])
    found = [
        scenario.run(set={"document.line_time": n * CLOCK}, stop=0.2)["document.line_latency_most"][
            -1
        ]
        for n in times
    ]
    fine = range(2401)
    figure, (above, below) = plt.subplots(2, 1, figsize=(9, 7))
    style = {"color": "#d55e00", "linestyle": "", "marker": "o", "markersize": 4}
    above.plot(
        [n * CLOCK * 1e6 for n in fine],
        [leaves(n) * CLOCK * 1e6 for n in fine],
        color="#0072b2",
        label="formula",
    )
    above.plot(times * CLOCK * 1e6, np.array(found) * 1e6, **style, label="run")
    above.set_title("From the interrupt that executes four lines to their first slot", loc="left")
    above.set_xlabel("time of a line [µs]")
    above.set_ylabel("latency [µs]")
    above.set_ylim(0, None)
    depths = (1, 2, 4, 5, 8, 10, 20, 40)
    print(f"{'queue':>6} {'moves take':>11} {'formula':>8} [s] {'starved':>8}")
    took = []
    for depth in depths:
        result = scenario.run(set={"queue.queue_depth": depth})
        moves = result.time[result["queue.path_feed"] > 0.0]
        took.append(float(moves[-1]))
        starved = result["queue.starved"][-1]
        formula = f"{queue_time(depth):8.4f}" if rests(depth) else "       -"
        print(f"{depth:6d} {took[-1]:11.4f} {formula}     {starved:8d}")
    result = scenario.run()
    driver = result.time[result["document.path_feed"] > 0.0][-1]
    print(f"driver {driver:11.4f}")
    below.plot(depths, took, **style, label="user program, polls every 36 ms")
    below.axhline(driver, color="black", linewidth=1, linestyle=":", label="driver")
    short = [d for d in depths if rests(d)]
    below.plot(
        short,
        [queue_time(d) for d in short],
        "x",
        color="#0072b2",
        label="formula, at rest between",
    )
    below.set_title("40 lines of 0.5 mm at 50 mm/s", loc="left")
    below.set_xlabel("lines that the queue holds")
    below.set_ylabel("time [s]")
    below.set_xscale("log")
    below.set_xticks(depths, [str(d) for d in depths])
    below.set_ylim(0, None)
    for axes in (above, below):
        axes.legend(frameon=False)
    save(figure, picture)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "latency.png")
