"""Study planners: every shape by every planner, at 1000 mm/s² of each axis.

    .venv/bin/python scenarios/short_lines/study.py [picture.png]

The points of the library at every period, without a card; the contour error of the machine comes
from runs of the scenario. Junction deviation is computed here, as is the bound: the least time
along our own curve, by toppra. tests/helpers/shape_paths.py asks the library for the curve.
"""

import re
import sys
import tempfile
import tomllib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import shapes
import toppra
from toppra import algorithm, constraint, interpolator

import motionfmu
from motionfmu.analysis import gcode

HERE = Path(__file__).parent
sys.path.append(str(HERE.parents[1] / "tests/helpers"))
from shape_paths import Chords, Segment, shaped  # noqa: E402

toppra.setup_logging("ERROR")
TOLERANCE, ACC, JERK, PERIOD = 0.02, 1000.0, 50000.0, 1e-3  # [mm], [mm/s²], [mm/s³], [s]
CHORD = 5e-4  # [mm] of arcs as chords
SLIVER, STRAIGHT = 1e-6, 1e-6  # [mm], [1/mm] less than toppra can resolve
RUNS = [(name, 100.0) for name in shapes.SHAPES]
RUNS[6:8] = [("plate", 50.0), ("plate", 100.0), ("gear", 50.0), ("gear", 100.0)]
WORDS = {
    "exact stop": ("G61", 0.0),
    "`G64`": ("G64", 0.0),
    "`G64 P0.02 Q0`": ("G64 P0.02 Q0", 0.0),
    "`G64 P0.02` T": ("G64 P0.02", 0.0),
    "`G64 P0.02` S": ("G64 P0.02", JERK),
}
T, S, JUNCTION, BOUND = "`G64 P0.02` T", "`G64 P0.02` S", "junction deviation", "bound"
LINUXCNC = "LinuxCNC"
SHADES = "#7f7f7f #e69f00 #56b4e9 #0072b2 #009e73 #cc79a7 #d55e00"
COLOURS = dict(zip([*WORDS, JUNCTION, LINUXCNC], SHADES.split(), strict=True))


@dataclass
class Row:
    """A shape by a planner."""

    time: float  # [s] without rapids
    off: tuple[float, float] = (0.0, 0.0)  # [mm] path to programmed, programmed to path
    peaks: list[np.ndarray] = field(default_factory=list)  # v, a, j of each axis
    machine: float = np.nan  # [mm]
    places: np.ndarray | None = None


def program(name: str, feed: float, words: str, jerk: float = 0.0) -> gcode.Program:
    """Read a shape as a program, from its first place on."""
    text = shapes.SHAPES[name]()
    start = np.zeros(6)
    if text[0].startswith("G0"):
        numbers = re.findall(r"[XYZ](-?[\d.]+)", text[0])
        start[: len(numbers)] = [float(x) for x in numbers]
    acc, jerks = np.full(6, ACC), np.full(6, jerk)
    if not words.startswith("G64 P"):
        acc[:] = jerks[:] = 0.0
    head = f"G21 G17 G90 {words} F{feed * 60:g}"
    read = gcode.read(
        "\n".join([head, *text]), point=start, axis_acc=acc, axis_jerk=jerks, period=PERIOD
    )
    assert not read.faults, read.faults
    return read


def driven(name: str, feed: float, planner: str = T) -> float:
    """Time that a planner of ours takes for a shape, without rapids. [s]"""
    return fed(program(name, feed, *WORDS[planner]))


def fed(read: gcode.Program) -> float:
    """Time of all commands but rapids. [s]"""
    return float(read.seconds()[read.commands["type"] != 0].sum())


def recorded() -> dict[tuple[str, float], float]:
    """What in_linuxcnc.py measured: time of shapes and feeds. [s]"""
    read = tomllib.loads((HERE / "linuxcnc_times.toml").read_text(encoding="utf-8"))
    return {(row["name"], row["feed"]): row["time"] for row in read["shape"]}


def chains(read: gcode.Program) -> list[np.ndarray]:
    """Commands between rapids."""
    c = read.commands
    moves = c[np.isin(c["type"], [0, *range(1, 4)])]
    cuts = np.flatnonzero(moves["type"] == 0)
    parts = [part[part["type"] != 0] for part in np.split(moves, cuts)]
    return [part for part in parts if len(part)]


def programmed(chain: np.ndarray) -> np.ndarray:
    """Points of the commands, arcs as chords."""
    points = [chain["start"][:1, :3]]
    for c in chain:
        if not c["arc"]:
            points.append(c["end"][None, :3])
            continue
        count = int(np.ceil(abs(c["sweep"]) / np.sqrt(8.0 * CHORD / c["radius"])))
        turn = c["angle"] + c["sweep"] * np.arange(1, count + 1) / count
        arc = np.tile(c["end"][:3], (count, 1))
        arc[:, 0] = c["centre"][0] + c["radius"] * np.cos(turn)
        arc[:, 1] = c["centre"][1] + c["radius"] * np.sin(turn)
        points.append(arc)
    return np.vstack(points)


def curve(chain: np.ndarray, feed: float) -> list[Segment]:
    """Segments of our own path."""
    rows = ["merge 0.02", "start " + " ".join(map(repr, chain["start"][0].tolist()))]
    for c in chain:
        end = " ".join(map(repr, c["end"].tolist()))
        row = f"{TOLERANCE} {feed} "
        if c["arc"]:
            x, y = c["centre"][:2].tolist()
            rows.append(f"arc {row} 2 {int(c['sweep'] > 0.0)} 1 {x!r} {y!r} {end}")
        else:
            rows.append(f"line {row} {end}")
    return shaped(rows)[0]


class Grid(interpolator.AbstractGeometricPath):
    """The path of segments at the points of a grid."""

    dof = 3
    waypoints = None

    def __init__(self, segments: list[Segment]) -> None:
        ways, states, at = [], [], 0.0
        segments = [p for p in segments if p.length > SLIVER]
        for n, p in enumerate(segments):
            count = max(48, int(np.ceil(p.length / 0.05)))
            u = np.linspace(0.0, p.length, count + 1)[: count + (n == len(segments) - 1)]
            states.append(np.stack(p.at(u), axis=1)[:, :, :3])
            ways.append(at + u)
            at += p.length
        self.ways, self.states = np.concatenate(ways), np.concatenate(states)
        self.states[np.abs(self.states) < STRAIGHT] = 0.0

    @property
    def path_interval(self) -> np.ndarray:
        """From the start to the end."""
        return self.ways[[0, -1]]

    def __call__(self, ways: Any, order: int = 0) -> np.ndarray:
        """Points, r' or r'' of the grid."""
        found = self.states[np.searchsorted(self.ways, np.atleast_1d(ways)), order]
        return found if np.ndim(ways) else found[0]


class FeedConstraint(constraint.LinearConstraint):
    """Speed |r'| du/dt at most the feed."""

    def __init__(self, feed: float) -> None:
        super().__init__()
        self.feed, self._dof = feed, 3
        self.discretization_type = constraint.DiscretizationType.Collocation

    def compute_constraint_params(self, path: Grid, grid: np.ndarray, *_: Any) -> tuple:
        """Bounds of (du/dt)^2 at the grid alone."""
        most = (self.feed / np.linalg.norm(path(grid, 1), axis=1)) ** 2
        return None, None, None, None, None, None, np.stack([np.zeros_like(most), most], 1)


def bound(segments: list[Segment], feed: float) -> float:
    """Least time from rest to rest with each axis within ACC. [s]"""
    total, begin = 0.0, 0
    for n, segment in enumerate(segments, 1):
        if not (segment.rest or n == len(segments)):
            continue
        path = Grid(segments[begin:n])
        begin = n
        axes = constraint.JointAccelerationConstraint(
            np.array([[-ACC, ACC]] * 3), constraint.DiscretizationType.Interpolation
        )
        solver = algorithm.TOPPRA(
            [axes, FeedConstraint(feed)], path, path.ways, solver_wrapper="seidel"
        )
        speed = solver.compute_parameterization(0, 0)[1]
        if speed is None:
            return float("nan")
        total += float((2.0 * np.diff(path.ways) / (speed[1:] + speed[:-1])).sum())
    return total


def junctions(points: np.ndarray, feed: float) -> tuple[float, float]:
    """Time [s] by trapezoids, and the largest jump of the speed of an axis [mm/s]."""
    ways = np.linalg.norm(np.diff(points, axis=0), axis=1)
    keep = ways > 1e-9
    slope, ways = np.diff(points, axis=0)[keep] / ways[keep, None], ways[keep]
    acc = ACC / np.abs(slope).max(axis=1)
    change = np.diff(slope, axis=0)
    sine = np.clip(np.sqrt(0.5 * (1.0 + (slope[1:] * slope[:-1]).sum(1))), 0.0, 1.0)
    # sin(t / 2) of the angle t between the lines is the cosine of half the turn.
    at_most = ACC / np.maximum(np.abs(change).max(axis=1), 1e-12)
    at_most *= np.linalg.norm(change, axis=1)
    square = np.minimum(feed**2, at_most * TOLERANCE * sine / np.maximum(1.0 - sine, 1e-12))
    v = np.concatenate([[0.0], square, [0.0]])
    for i in range(len(ways) - 1, -1, -1):
        v[i] = min(v[i], v[i + 1] + 2.0 * acc[i] * ways[i])
    for i in range(len(ways)):
        v[i + 1] = min(v[i + 1], v[i] + 2.0 * acc[i] * ways[i])
    top = np.minimum(feed, np.sqrt(0.5 * (v[1:] + v[:-1]) + acc * ways))
    low, high = np.sqrt(v[:-1]), np.sqrt(v[1:])
    flat = ways - (2.0 * top**2 - v[1:] - v[:-1]) / (2.0 * acc)
    time = (2.0 * top - low - high) / acc + np.maximum(flat, 0.0) / top
    jump = np.abs(change).max(axis=1) * np.sqrt(v[1:-1])
    return float(time.sum()), float(jump.max())


def peaks(read: gcode.Program, places: np.ndarray) -> list[np.ndarray]:
    """Largest v, a, j of each axis without rapids, as differences at the periods."""
    ends = np.cumsum(read.seconds())
    owner = np.searchsorted(ends, (np.arange(len(places)) + 0.5) * PERIOD)
    rapid = read.commands["type"][np.minimum(owner, len(ends) - 1)] == 0
    cuts = np.flatnonzero(np.diff(rapid)) + 1
    begins = [0, *cuts]
    parts = [
        p[1:]
        for p, b in zip(np.split(places, cuts), begins, strict=True)
        if not rapid[b] and len(p) > 4
    ]
    return [
        np.max([np.abs(np.diff(p, n, axis=0)).max(axis=0) for p in parts], axis=0) / PERIOD**n
        for n in (1, 2, 3)
    ]


def distances(places: np.ndarray, path: np.ndarray) -> tuple[float, float]:
    """Largest distance of chords between places to the programmed path, and back."""
    there, back = Chords(path, TOLERANCE), Chords(places, TOLERANCE)
    return float(there.distance(back.points).max()), float(back.distance(there.points).max())


def machine(name: str, feed: float, words: str, jerk: float, time: float) -> float:
    """Contour error of the ball-screw axes. [mm]"""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "shape.ngc"
        head = f"G21 G17 G90 {words} F{feed * 60:g}"
        file.write_text("\n".join(["%", head, *shapes.SHAPES[name](), "M30", "%", ""]))
        settings: dict[str, Any] = {"mcc.program": str(file)}
        settings["mcc.axis_jerk"] = [jerk, jerk, 0, 0, 0, 0]
        result = motionfmu.load(HERE).run(set=settings, stop=round(1.1 * time + 2.5, 1))
    assert result["mcc.done"][-1], name
    return result.contour().error.max


def study(name: str, feed: float) -> dict[str, Row]:
    """All planners on one shape."""
    rows = {}
    for planner, (words, jerk) in WORDS.items():
        read = program(name, feed, words, jerk)
        time = fed(read)
        places = read.places()[:, :3]
        path = np.vstack([programmed(chain) for chain in chains(read)])
        rows[planner] = Row(time, distances(places, path), peaks(read, places), places=places)
        if planner in (T, S) and name != "chip":
            rows[planner].machine = machine(name, feed, words, jerk, time)
    parts = chains(program(name, feed, "G61"))
    junction = [junctions(programmed(chain), feed) for chain in parts]
    rows[JUNCTION] = Row(
        sum(t for t, _ in junction), peaks=[np.array([max(j for _, j in junction)])]
    )
    rows[LINUXCNC] = Row(recorded()[name, feed])
    rows[BOUND] = Row(sum(bound(curve(chain, feed), feed) for chain in parts))
    return rows


def _told(x: float) -> str:
    return "-" if np.isnan(x) else f"{x:.2f}"


def line(name: str, feed: float, planner: str, row: Row, unit: float) -> str:
    """A row of the table."""
    cells = [name, f"{feed:g}", planner, *(_told(x) for x in (row.time, row.time / unit))]
    if row.places is None:
        cells += ["-"] * 5
        if planner == JUNCTION:
            cells[6] = f"jumps of {row.peaks[0][0]:.1f}"
    else:
        cells.append(" / ".join(f"{1e3 * x:.1f}" for x in row.off))
        cells += [
            " / ".join(f"{x * k:.0f}" for x in p[row.peaks[0] > 0.0])
            for p, k in zip(row.peaks, (1, 1, 1e-3), strict=True)
        ]
        cells.append("-" if np.isnan(row.machine) else f"{row.machine * 1e3:.0f}")
    return "| " + " | ".join(cells) + " |"


def draw(found: dict[tuple[str, float], dict[str, Row]], picture: Path) -> None:
    """Times as bars over that of T, the bound as a line; the outline by its speed."""
    figure, (left, right) = plt.subplots(
        1, 2, figsize=(13, 6.5), layout="constrained", width_ratios=(2.2, 1)
    )
    names = [f"{n}\n{f:g} mm/s" for n, f in found]
    for k, planner in enumerate(COLOURS):
        times = [rows[planner].time / rows[T].time for rows in found.values()]
        label = planner.replace("`", "")
        left.bar(
            np.arange(len(times)) + (k - 3) * 0.13,
            times,
            0.13,
            color=COLOURS[planner],
            label=label,
        )
    for n, rows in enumerate(found.values()):
        ratio = rows[BOUND].time / rows[T].time
        left.plot([n - 0.45, n + 0.45], [ratio] * 2, color="black", linewidth=1.2)
    left.set(
        yscale="log",
        ylabel="time over that of G64 P0.02 T",
        title="Time; black line: the bound of the curve",
    )
    left.set_xticks(range(len(names)), names, fontsize=8)
    left.legend(frameon=False, fontsize=8, ncols=2)
    places = next(iter(found.values()))[T].places
    assert places is not None
    speed = np.linalg.norm(np.diff(places, axis=0), axis=1) / PERIOD
    dots = right.scatter(*places[1:, :2].T, c=speed, s=3, cmap="viridis", vmin=0.0, vmax=100.0)
    figure.colorbar(dots, ax=right, location="bottom", shrink=0.8, label="speed [mm/s]")
    right.set(aspect="equal", xlabel="X [mm]", ylabel="Y [mm]", title="Outline, G64 P0.02 T")
    for axes in (left, right):
        axes.grid(alpha=0.25)
        axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(picture, dpi=100)


def main(picture: Path) -> None:
    """Print the table, draw the picture."""
    print(
        "| shape | F [mm/s] | planner | time [s] | over bound | off / back [µm] | v [mm/s] "
        "| a [mm/s²] | j [m/s³] | machine off [µm] |\n" + "|---" * 10 + "|"
    )
    found = {}
    for name, feed in RUNS:
        rows = found[name, feed] = study(name, feed)
        for planner, row in rows.items():
            print(line(name, feed, planner, row, rows[BOUND].time), flush=True)
    draw(found, picture)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "planners.png")
