"""Identify a screw by a bidirectional measurement, compensate it, and measure again.

    .venv/bin/python scenarios/compensation/study.py [picture.png]

A laser (the table's position) is read at targets that are approached from both sides, several
times, as ISO 230-2 has it. Of the first measurement the table of the library is made; the second,
at other targets, shows what is left.
"""

import sys
import tempfile
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import motionfmu
from motionfmu.analysis.positioning import PositioningTest

HERE = Path(__file__).parent
PULSES = 5000  # per mm
INTERVAL = 20.0  # [mm] between two points of the table
TRAVEL = 200.0  # [mm] to either side of the origin
RUNS = 5  # approaches of each target from each side
OVERRUN, FEED = 5.0, 6000.0  # [mm], [mm/min]
DWELL, RAMP = 0.3, 0.11  # [s] at a target; that a ramp takes, and the clock of the card
FIGURES = ("A", "E", "B", "M")  # of ISO 230-2
BLUE, ORANGE = "#0072b2", "#d55e00"


def program(targets: np.ndarray, runs: int) -> tuple[str, list[tuple[int, float]]]:
    """Part program, and line and target [mm] of each reading."""
    low, high = targets[0] - OVERRUN, targets[-1] + OVERRUN
    lines, readings = [f"G21 G90 G1 F{FEED:g}", f"X{low:.3f}"], []
    for _ in range(runs):
        for way, turn in ((targets, high), (targets[::-1], low)):
            for target in way:
                lines += [f"X{target:.3f}", f"G4 P{DWELL:g}"]
                readings.append((len(lines), float(target)))
            lines.append(f"X{turn:.3f}")
    return "\n".join([*lines, "M2", ""]), readings


def measure(targets: np.ndarray, runs: int, table: Path | None) -> PositioningTest:
    """Approach the targets with or without a table and read the laser.

    The laser is read where a dwell ends. It is set to zero at the origin, approached upwards.
    """
    zeroed = np.unique(np.append(targets, 0.0))
    text, readings = program(zeroed, runs)
    way = 2.0 * runs * (zeroed[-1] - zeroed[0] + 2.0 * OVERRUN) + OVERRUN - zeroed[0]
    moves = len(readings) + 2 * runs + 1
    stop = way / (FEED / 60.0) + moves * RAMP + len(readings) * DWELL + 0.5
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "targets.ngc"
        file.write_text(text)
        result = motionfmu.load(HERE).run(
            set={"mcc.program": str(file), "mcc.comp_file": str(table or "")}, stop=round(stop, 1)
        )
    assert result["mcc.done"][-1] and not result["mcc.error"].any()
    line, place = result["mcc.line"], result["machine.table_position"][:, 0] * 1e3
    end = np.searchsorted(line, [n for n, _ in readings], side="right") - 1
    deviation = (place[end] - [x for _, x in readings]).reshape(runs, 2, len(zeroed))
    up, down = deviation[:, 0], deviation[:, 1, ::-1]
    zero = up[:, zeroed == 0.0].mean()
    asked = np.isin(zeroed, targets)
    return PositioningTest(targets, up[:, asked] - zero, down[:, asked] - zero)


def write_table(m: PositioningTest, file: Path) -> None:
    """The measured deviations with their sign turned, as a comp_file for X."""
    home = int(np.argmin(np.abs(m.targets)))
    rows = np.column_stack([np.round(-x * PULSES).astype(int) for x in m.means])
    lines = ["# X, pulses of 0.2 um", "axis,interval,home", f"1,{INTERVAL * PULSES:.0f},{home}"]
    lines += ["axis,index,forward,backward"]
    lines += [f"1,{i},{forward},{backward}" for i, (forward, backward) in enumerate(rows)]
    file.write_text("\n".join(lines) + "\n")


def grid(travel: float = TRAVEL) -> np.ndarray:
    """Targets at the points of the table [mm]."""
    return np.arange(-travel, travel + 0.5 * INTERVAL, INTERVAL)


def between(travel: float = TRAVEL) -> np.ndarray:
    """Other targets: spaced as ISO 230-2 asks, so that no periodic error hides [mm]."""
    inner = grid(travel)[:-1]
    shift = np.random.default_rng(1).uniform(0.0, INTERVAL, len(inner))
    return np.round(inner + shift, 3)


def draw(
    before: PositioningTest, after: PositioningTest, table: PositioningTest, picture: Path
) -> None:
    """Deviations before and after, and the table, over the travel."""
    figure, (top, middle, low) = plt.subplots(
        3, 1, figsize=(9.5, 9.5), sharex=True, layout="constrained"
    )
    for axes, m, title in (
        (top, before, "Before"),
        (middle, after, "After"),
        (low, after, "After, enlarged"),
    ):
        for runs, mean, colour, name in (
            (m.up, m.means[0], BLUE, "approached upwards"),
            (m.down, m.means[1], ORANGE, "approached downwards"),
        ):
            axes.plot(m.targets, runs.T * 1e3, ".", color=colour, markersize=4, alpha=0.5)
            axes.plot(m.targets, mean * 1e3, color=colour, linewidth=1.4, label=name)
        values = ", ".join(f"{k} {m.figures()[k] * 1e3:.1f}" for k in FIGURES)
        axes.set_title(f"{title}: {values} µm", loc="left", fontsize=11)
        axes.set_ylabel("deviation [µm]")
        axes.grid(alpha=0.25)
        axes.spines[["top", "right"]].set_visible(False)
    middle.set_ylim(top.get_ylim())
    for row in table.means:
        top.plot(table.targets, row * 1e3, "x", color="#444444", markersize=5)
    top.plot([], [], "x", color="#444444", label="points the table is made of")
    top.legend(frameon=False, loc="lower right")
    low.set_xlabel("target X [mm]")
    figure.suptitle(
        "Positioning by ISO 230-2: backlash and pitch error compensated in the pulses",
        x=0.01,
        ha="left",
        fontweight="bold",
    )
    figure.savefig(picture, dpi=110)


def main(picture: Path) -> None:
    """Measure, identify, measure again; print the figures, draw the picture."""
    table = measure(grid(), RUNS, None)
    write_table(table, HERE / "screw.csv")
    before = measure(between(), RUNS, None)
    after = measure(between(), RUNS, HERE / "screw.csv")
    print(f"{'[µm]':8}" + "".join(f"{k:>8}" for k in FIGURES))
    for name, m in (("before", before), ("after", after)):
        print(f"{name:8}" + "".join(f"{m.figures()[k] * 1e3:8.2f}" for k in FIGURES))
    draw(before, after, table, picture)
    print(f"picture: {picture}")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "compensation.png")
