"""One outline in four ways, all within the same tolerance: what look-ahead saves.

    .venv/bin/python scenarios/lookahead/study.py [picture.png]

Exact stop, path mixing at the highest feed that keeps within the tolerance (found by bisection),
look-ahead with T and with S ramps. The acceleration is the same in all: the times of the ramps
follow the feed. Deviations of the command are those of every point of a DDA time, before it is
rounded to pulses.
"""

import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import make_program
import matplotlib.pyplot as plt
import numpy as np

import motionfmu
from motionfmu.analysis.contour import ContourInput, analyse, read_path

HERE = Path(__file__).parent
TOLERANCE, FEED = make_program.TOLERANCE, make_program.FEED / 60.0  # [mm], [mm/s]
RAMP = 0.05  # [s] from rest to FEED
ACC = FEED / RAMP  # [mm/s²] of a T ramp
CORNER = (34.0, 9.0)  # [mm] of the detail
BEFORE = len(make_program.BEFORE.splitlines())
EDGE = (BEFORE + 1, BEFORE + 1 + len(make_program.edge()))  # commands of the wavy edge, and behind
INK, GREY = "#444444", "#999999"


@dataclass(frozen=True)
class Way:
    """How the outline is run."""

    name: str
    words: str  # of the part program
    colour: str
    ramps: str = "T"


STOP = Way("exact stop", "G61", "#7f7f7f")
MIX = Way("path mixing", "G64", "#e69f00")
AHEAD = Way("look-ahead, T ramps", f"G64 P{TOLERANCE:g}", "#0072b2")
SMOOTH = Way("look-ahead, S ramps", f"G64 P{TOLERANCE:g}", "#009e73", "S")
WAYS = (STOP, MIX, AHEAD, SMOOTH)


@dataclass(frozen=True)
class Row:
    """A way at a feed and what came of it."""

    way: Way
    feed: float  # [mm/s]
    time: np.ndarray  # [s] of the points, from the first motion on
    place: np.ndarray  # [mm] shape (n, 2)
    speed: np.ndarray  # [mm/s]
    edge: tuple[float, float]  # [s] on the wavy edge
    command: float  # [mm] largest deviation of the points
    machine: float  # [mm] of the machine

    @property
    def duration(self) -> float:
        """Time of the motion [s]."""
        return float(self.time[-1])

    @property
    def acceleration(self) -> float:
        """Largest acceleration of the points [mm/s²]."""
        step = float(np.median(np.diff(self.time)))
        return float(np.hypot(*np.diff(self.place, 2, axis=0).T).max()) / step**2


def run(way: Way, feed: float, machine: bool = True) -> Row:
    """Run the outline; `machine` false leaves its deviation out (0)."""
    text = make_program.program()
    first = f"{AHEAD.words} F{make_program.FEED}"
    assert first in text
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "plate.ngc"
        program.write_text(text.replace(first, f"{way.words} F{feed * 60.0:.4f}"))
        settings: dict[str, Any] = {
            "mcc.program": str(program),
            "mcc.batch": 1,  # so that every point is seen, the first ones too
            "mcc.start_delay": 0.05,
            "mcc.acc_time": feed / ACC,
            "mcc.dec_time": feed / ACC,
            "mcc.acc_type": way.ramps,
            "mcc.dec_type": way.ramps,
        }
        stop = 10.0 + (0.0 if way is AHEAD or way is SMOOTH else 250.0 / feed)
        result = motionfmu.load(HERE).run(set=settings, stop=round(stop, 1))
    assert result["mcc.done"][-1] and not result["mcc.starved"].any(), way.name
    place = result["mcc.position"]
    seen = 1 + np.flatnonzero(np.any(np.diff(place, axis=0) != 0.0, axis=1))
    seen = np.concatenate([[seen[0] - 1], seen])
    deviation = command_deviation(result, seen)
    error = result.contour().error.max if machine else 0.0
    time, speed = result.time[seen] - result.time[seen[0]], result["mcc.path_feed"][seen]
    first, behind = np.searchsorted(result["mcc.command"][seen], EDGE)
    edge = (float(time[first]), float(time[behind]))
    return Row(way, feed, time, place[seen, :2], speed, edge, deviation, error)


def command_deviation(result: motionfmu.Result, seen: np.ndarray) -> float:
    """Largest distance of the library's points from the programmed geometry [mm]."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "path.csv"
        file.write_text(result.geometry or "")
        path = read_path(file)
    place, command = result["mcc.position"][seen], result["mcc.command"][seen].astype(np.int64)
    return analyse(ContourInput(path, result.time[seen], place, place, command)).error.max


def equal_tolerance(way: Way) -> float:
    """Highest feed [mm/s], to 0.1 %, whose points keep within the tolerance."""
    low, high = 0.0, 2.0 * np.sqrt(8.0 * ACC * TOLERANCE)  # F T / 8 = TOLERANCE, T = F / ACC
    while high - low > 1e-3 * high:
        feed = 0.5 * (low + high)
        if run(way, feed, machine=False).command <= TOLERANCE:
            low = feed
        else:
            high = feed
    return low


def draw_corner(axes: plt.Axes, rows: list[Row]) -> None:
    """The paths at a corner, with the tolerance about its point."""
    centre, reach = np.array(CORNER), 5.0 * TOLERANCE
    sides = np.array([(28.0, 0.0), CORNER, (40.0, 0.0)])
    axes.plot(*sides.T, color="black", linewidth=0.8, label="programmed")
    round_it = plt.Circle(CORNER, TOLERANCE, fill=False, color=GREY, linestyle="--", linewidth=0.8)
    axes.add_patch(round_it)
    for row in rows:
        near = np.hypot(*(row.place - centre).T) < 3.0 * reach
        axes.plot(
            *row.place[near].T,
            color=row.way.colour,
            marker=".",
            markersize=4,
            linewidth=5.0 if row.way is AHEAD else 1.2,
            alpha=0.5 if row.way is AHEAD else 1.0,  # the other one lies upon it
            label=row.way.name,
        )
    axes.set(xlim=centre[0] + np.array([-reach, reach]), xlabel="X [mm]", ylabel="Y [mm]")
    axes.set(ylim=centre[1] + np.array([-1.6, 0.4]) * reach, aspect="equal", anchor="N")
    axes.set_xticks(centre[0] + np.array([-0.1, -0.05, 0.0, 0.05, 0.1]))
    axes.set_title("Tip of the notch; dashed: tolerance", loc="left", fontsize=10, color=INK)
    axes.legend(frameon=False, loc="lower center", fontsize=8)


def draw_plate(axes: plt.Axes, row: Row) -> None:
    """The whole outline, coloured by its speed."""
    dots = axes.scatter(*row.place.T, c=row.speed, s=4, cmap="viridis", vmin=0.0, vmax=FEED)
    axes.figure.colorbar(
        dots, ax=axes, location="bottom", shrink=0.8, pad=0.02, label="speed [mm/s]"
    )
    axes.plot(*CORNER, "o", markersize=14, markerfacecolor="none", color="#d55e00")
    axes.set(aspect="equal", anchor="S", xlabel="X [mm]", ylabel="Y [mm]")
    axes.set_title(f"Outline, {row.way.name}", loc="left", fontsize=10, color=INK)


def draw_bars(axes: plt.Axes, rows: list[Row]) -> None:
    """Largest deviations of command and machine."""
    at = np.arange(len(rows))
    colours = [r.way.colour for r in rows]
    axes.barh(at - 0.2, [r.command * 1e3 for r in rows], 0.38, color=colours)
    axes.barh(at + 0.2, [r.machine * 1e3 for r in rows], 0.38, color=colours, alpha=0.35)
    for i, row in enumerate(rows):
        axes.text(row.command * 1e3 + 2, i - 0.2, f"{row.command * 1e3:.1f}", va="center", size=8)
        axes.text(row.machine * 1e3 + 2, i + 0.2, f"{row.machine * 1e3:.0f}", va="center", size=8)
    axes.axvline(TOLERANCE * 1e3, color=GREY, linestyle="--", linewidth=0.8)
    axes.set_yticks(at, [r.way.name.replace(", ", ",\n") for r in rows], fontsize=8)
    axes.invert_yaxis()
    axes.set(xlabel="largest deviation [µm]", xlim=(0, 1.2e3 * max(r.machine for r in rows)))
    axes.set_title("Command (dark), machine (pale)", loc="left", fontsize=10, color=INK)


def draw(rows: list[Row], picture: Path) -> None:
    """Outline, corner and deviations above the speeds."""
    figure = plt.figure(figsize=(12, 10.5), layout="constrained")
    grid = figure.add_gridspec(
        1 + len(rows), 3, height_ratios=(3.2, *(1 for _ in rows)), width_ratios=(1.3, 1, 1)
    )
    draw_plate(figure.add_subplot(grid[0, 0]), rows[2])
    draw_corner(figure.add_subplot(grid[0, 1]), rows)
    draw_bars(figure.add_subplot(grid[0, 2]), rows)
    first = None
    for i, row in enumerate(rows, 1):
        panel = figure.add_subplot(grid[i, :], sharex=first)
        first = first or panel
        panel.axvspan(*row.edge, color="black", alpha=0.06, linewidth=0)
        panel.plot(row.time, row.speed, color=row.way.colour, linewidth=0.8)
        panel.axvline(row.duration, color=INK, linewidth=0.8, linestyle=":")
        panel.set(ylim=(0, 1.12 * FEED), ylabel="speed [mm/s]")
        text = f"{row.way.name} ({row.way.words}, F{row.feed * 60:.0f}): {row.duration:.2f} s"
        panel.set_title(text, loc="left", fontsize=10, color=INK)
        panel.tick_params(labelbottom=row is rows[-1])
    lines = EDGE[1] - EDGE[0]
    first.text(rows[0].edge[0] + 0.1, 0.8 * FEED, f"grey: wavy edge, {lines} lines", size=9)
    panel.set(xlabel="time [s]", xlim=(0, 1.02 * max(r.duration for r in rows)))
    for axes in figure.axes:
        if axes.get_label() != "<colorbar>":
            axes.grid(alpha=0.25)
            axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(picture, dpi=110)


def main(picture: Path) -> None:
    """Run the four ways, print the table, draw the picture."""
    feeds = dict.fromkeys(WAYS, FEED) | {MIX: equal_tolerance(MIX)}
    rows = [run(way, feed) for way, feed in feeds.items()]
    print(
        f"{'way':22}{'F':>6}{'time [s]':>10}{'saved':>8}{'command [µm]':>14}"
        f"{'machine [µm]':>14}{'acceleration [mm/s²]':>23}"
    )
    for row in rows:
        saved = 1.0 - row.duration / rows[0].duration
        print(
            f"{row.way.name:22}{row.feed * 60:6.0f}{row.duration:10.2f}{saved * 100:6.0f} %"
            f"{row.command * 1e3:14.2f}{row.machine * 1e3:14.0f}{row.acceleration:23.0f}"
        )
    draw(rows, picture)
    print(f"picture: {picture}")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "lookahead.png")
