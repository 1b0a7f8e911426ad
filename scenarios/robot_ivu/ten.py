"""IVU ten times, letters of 60 mm, and what ISO 9283 and the eye say of the ten pen lines.

    .venv/bin/python scenarios/robot_ivu/ten.py [picture.png]

The first five runs begin each stroke from the one side, the others from the other side. The run of
500 s takes about a minute; picture and report with the moving picture are in results/robot_ivu.ten.
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray
from rich.progress import Progress
from write import CAP, ORIGIN, looked_at, strokes

import motionfmu
from motionfmu.analysis.iso9283 import CommandPath, Cycle, Cycles, Evaluation, analyse
from motionfmu.report import write_report

HERE = Path(__file__).parent
OUT = Path("results/robot_ivu.ten")
STOP = 500.0  # [s]
WIDTH = 1.0  # [mm] of the pen
SPEED = 8.0  # [mm/s]
MAGNIFIED = 10
COLOURS = ("#0072b2", "#d55e00")  # of the sides
Array = NDArray[np.float64]


def scenario() -> motionfmu.Scenario:
    """The folder's scenario with large letters, ten times."""
    folder = OUT / "scenario"
    folder.mkdir(parents=True, exist_ok=True)
    text = (HERE / "scenario.toml").read_text()
    for old, new in (
        ("small.txt", "large.txt"),
        ('"TWO"', '"TEN"'),
        ("stop = 36.0", f"stop = {STOP}"),
        ("twice", "ten times"),
    ):
        text = text.replace(old, new)
    text = text[: text.index("[expect]")]
    (folder / "scenario.toml").write_text(text)
    for name in ("ivu.job", "large.txt"):
        (folder / name).write_text((HERE / name).read_text())
    np.savetxt(folder / "path.txt", looked_at(strokes(), 3, 1.0), fmt="%.4f")
    return motionfmu.load(folder)


def cycles(result: motionfmu.Result, stroke: int) -> list[Cycle]:
    """The ten pen lines of a stroke."""
    lines = (HERE / "ivu.job").read_text().split("\n")
    first = lines.index(f"JOB STROKE{stroke + 1}") + 8
    last = lines.index("END", first)
    on = (result["soft.line"] >= first) & (result["soft.line"] <= last)
    edges = np.flatnonzero(np.diff(np.r_[False, on, False])).reshape(-1, 2)
    place = result["arm.tool_position"] * 1e3
    return [Cycle(result.time[a:b], place[a:b]) for a, b in edges]


def evaluate(lines: list[Cycle], path: Array) -> Evaluation:
    """Figures of some pen lines; their ends are cut off already."""
    given = Cycles(lines, CommandPath(path), SPEED, None, WIDTH, ramp=0.0)
    return Evaluation(analyse(given))


def letters(points: Array) -> Array:
    """Of the base frame, as one reads them [mm]."""
    return np.column_stack([ORIGIN[1] - points[..., 1], points[..., 0] - ORIGIN[0]])


def draw(panels: list[Axes], lines: list[Cycle], found: Evaluation) -> None:
    """Strokes as the pen paints them; centre lines, their deviation magnified."""
    point = found.path.point
    mean = point.mean(axis=0)
    scale = 72.0 * panels[0].get_window_extent().height / panels[0].figure.dpi / (CAP * 1.25)
    for n, line in enumerate(lines):
        colour = COLOURS[2 * n // len(lines)]
        inside = line.position[:: max(1, len(line.time) // 2000)]
        panels[0].plot(
            *letters(inside).T,
            color=colour,
            linewidth=WIDTH * scale,
            alpha=0.25,
            solid_capstyle="round",
        )
        panels[1].plot(
            *letters(mean + MAGNIFIED * (point[n] - mean)).T, color=colour, linewidth=0.8
        )


def main(picture: Path) -> None:
    """Run it, print the table, draw the picture."""
    with Progress(transient=True, disable=not sys.stdout.isatty()) as bar:
        task = bar.add_task("500 s", total=1.0)
        result = scenario().run(progress=lambda part: bar.update(task, completed=part))
    write_report(result, None, OUT)
    figure, panels = plt.subplots(2, 1, figsize=(10, 9.6), layout="constrained")
    for panel, title in zip(
        panels, (f"a pen of {WIDTH:g} mm", f"centre lines, deviation x {MAGNIFIED}"), strict=True
    ):
        panel.set(xlim=(-75, 75), ylim=(-0.625 * CAP, 0.625 * CAP), aspect="equal", title=title)
        panel.set(ylabel="up [mm]")
        panel.grid(alpha=0.25)
        panel.spines[["top", "right"]].set_visible(False)
    figure.draw_without_rendering()
    print("stroke  side  AT_P   RT_P   lines  band   common  speed   FV  [mm, mm/s]")
    for n in range(4):
        lines = cycles(result, n)
        path = looked_at(strokes(), n, 1.0)
        for name, some in (("one", lines[:5]), ("other", lines[5:]), ("both", lines)):
            found = evaluate(some, path)
            x = found.numbers()
            c = x["coincidence"]
            print(
                f"{'IVVU'[n]}{n + 1:<6} {name:6}{x['AT_P']:6.3f} {x['RT_P']:6.4f} "
                f"{c['lines']:6.4f} {c['band']:6.3f} {c['common']:6.3f}  "
                f"{x['speed']:6.3f} {x['FV']:6.3f}"
            )
        draw(list(panels), lines, found)
    panels[-1].set_xlabel("along the text [mm]")
    figure.suptitle("IVU ten times; blue: begun from the one side, orange: from the other")
    figure.savefig(picture, dpi=110)
    print(f"picture: {picture}, report: {OUT / 'report.html'}")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else OUT / "ivu.png")
