"""The true speed of the tool against its feed, with the document's copies and with short ones.

    .venv/bin/python scenarios/robot_speed/study.py [picture.png]

n points fit while wait + copies + n ik_time < 4000 clocks, so the cap is floor(n) pitch / cycle.
Above it a cycle of m points takes until the slot behind its mark.
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
CYCLE, SLOT, POINT = 4000, 200, 1440  # [clocks]
REST = {"below": 20 + 308 + 924, "part": 20 + 194 + 465}  # [clocks] wait and copies
NAMES = {"below": "copies of 4 KB", "part": "copies of 224 bytes"}
COLOURS = {"below": "#d55e00", "part": "#0072b2"}
PITCH, PRINTED = 0.1, 2777.0  # [mm], [mm/s]
FEEDS = (500, 800, 990, 1010, 1200, 1500, 1800, 1990, 2010, 2300, 2600, 2777)  # [mm/s]


def cap(rest: int) -> float:
    """Highest feed without a late cycle [mm/s]."""
    return (CYCLE - 1 - rest) // POINT * PITCH / (CYCLE * CLOCK)


def truly(feed: float, rest: int) -> float:
    """Speed that cycles of so many points give [mm/s]."""
    points = feed * CYCLE * CLOCK / PITCH
    few, more = int(points), points - int(points)
    takes = [max(CYCLE, ((rest + n * POINT) // SLOT + 1) * SLOT) for n in (few, few + 1)]
    return feed * CYCLE / ((1.0 - more) * takes[0] + more * takes[1])


def measure(result: motionfmu.Result, name: str) -> tuple[float, int]:
    """Speed at the full feed [mm/s], underruns."""
    feed, way = result[f"{name}.path_feed"], result[f"{name}.path_length"]
    full = np.flatnonzero(feed > 0.999 * feed.max())[50:-50]
    speed = (way[full[-1]] - way[full[0]]) / (result.time[full[-1]] - result.time[full[0]])
    return float(speed), int(result[f"{name}_card.underruns"][-1])


def main(picture: Path) -> None:
    """Run all, print the table, draw the picture."""
    scenario = motionfmu.load(HERE)
    found: dict[str, list[tuple[float, int]]] = {name: [] for name in REST}
    for feed in FEEDS:
        given = {f"{name}.program": "printed.ngc" for name in REST}
        shares = {f"{name}.override": feed / PRINTED for name in REST}
        result = scenario.run(set={**given, **shares}, stop=2.2)
        for name in REST:
            found[name].append(measure(result, name))
    figure, axes = plt.subplots(figsize=(9, 5))
    fine = np.arange(500.0, 2800.0, 2.0)
    for name, rest in REST.items():
        print(f"{NAMES[name]}: cap {cap(rest):.0f} mm/s")
        print(f"{'feed':>6} {'true':>8} {'formula':>8} [mm/s] {'underruns':>10}")
        for feed, (speed, underruns) in zip(FEEDS, found[name], strict=True):
            print(f"{feed:6d} {speed:8.1f} {truly(feed, rest):8.1f}        {underruns:10d}")
        points = [x for x, _ in found[name]]
        axes.plot(FEEDS, points, "o", color=COLOURS[name], markersize=5, label=NAMES[name])
        axes.plot(fine, [truly(f, rest) for f in fine], color=COLOURS[name], linewidth=1)
        axes.axvline(cap(rest), color=COLOURS[name], linewidth=1, linestyle=":")
    axes.plot(fine, fine, color="black", linewidth=0.7, label="feed")
    axes.set_title("Points: run; lines: formula; dotted: cap of the 100 µs cycle", loc="left")
    axes.set_xlabel("feed [mm/s]")
    axes.set_ylabel("true speed of the tool [mm/s]")
    axes.legend(frameon=False)
    save(figure, picture)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "speed.png")
