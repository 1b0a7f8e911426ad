"""Long work from the console to the report: `make bench BENCH=--long`.

A tenth of it and all of it, each as a command in a process of its own: what a row costs must not
grow, and memory is bounded. Processor time is what other work on the machine changes least.
"""

import math
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from figures import Figure
from rich.console import Console
from rich.progress import Progress

ROOT = Path(__file__).resolve().parents[2]
SIX_AXES = Path(__file__).parent / "six_axes"
DEMO = ROOT / "scenarios/circle"
PROGRAM = "six_axes.ngc"
STEP = 1e-4  # [s]
SIMULATED = (60, 600)  # [s] of six axes
LINES = (100_000, 1_000_000)
LENGTH, FEED = 0.1, 100.0  # [mm] of a line, [mm/s]
FROM, TO = 20.0, 90.0  # [mm] radii of the spiral they are on


@dataclass
class Spent:
    """What a command took."""

    rows: int
    seconds: float
    megabytes: float

    @property
    def each(self) -> float:
        """Processor time of a row [s]."""
        return self.seconds / self.rows


@dataclass(frozen=True)
class Work:
    """What is done in two sizes, and the most that the larger one may take."""

    unit: str  # of a size
    run: Callable[[int, Path], Spent]
    sizes: tuple[int, int]
    megabytes: float
    seconds: float = math.inf


def _command(rows: int, out: Path, *words: str) -> Spent:
    """A command to its report and verdicts, all of which must hold."""
    line = [sys.executable, "-m", "motionfmu", *words]
    process = subprocess.Popen([*line, "--out", str(out)], stdout=subprocess.DEVNULL, cwd=ROOT)
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        sys.exit(f"long_run: {' '.join(line)} ended with {process.returncode}")
    return Spent(rows, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024)


def _run(scenario: Path, stop: float, out: Path) -> Spent:
    """`motionfmu run`."""
    return _command(round(stop / STEP), out, "run", str(scenario), "--stop", str(stop))


def spiral(lines: int) -> str:
    """A part program of so many lines of equal length."""
    words, angle = [f"G21 G90 G64 P0.01 G1 F{60 * FEED:g}"], 0.0
    for k in range(lines):
        radius = FROM + (TO - FROM) * k / lines
        angle += LENGTH / radius
        words.append(f"X{radius * math.cos(angle) - FROM:.4f} Y{radius * math.sin(angle):.4f}")
    return "\n".join([*words, "M2"]) + "\n"


def _lines(lines: int, folder: Path) -> Spent:
    """The demo's machine on a spiral."""
    return _run(on_a_spiral(lines, folder), lines * LENGTH / FEED + 2.0, folder / "out")


def on_a_spiral(lines: int, folder: Path) -> Path:
    """A scenario of the demo's machine on a spiral of so many lines."""
    scenario = folder / "spiral"
    scenario.mkdir()
    demo = (DEMO / "scenario.toml").read_text().partition("[expect]")[0]
    check = '[check]\n"mcc.done" = { final = true }\n"mcc.error" = { absmax = 0 }\n'
    (scenario / "scenario.toml").write_text(demo + check)
    (scenario / "circle.ngc").write_text(spiral(lines))
    return scenario


def _checked(lines: int, folder: Path) -> Spent:
    """`motionfmu gcode` of the spiral; a row is a line."""
    (folder / "spiral.ngc").write_text(spiral(lines))
    return _command(lines, folder / "out", "gcode", str(folder / "spiral.ngc"))


def _six_axes(seconds: int, folder: Path) -> Spent:
    """The bench's six axes, their program over and over."""
    scenario = folder / "six_axes"
    shutil.copytree(SIX_AXES, scenario)
    first, *moves, end = (scenario / PROGRAM).read_text().replace("%", "").strip().splitlines()
    assert end.endswith("M30")
    again = [first, f"O1 REPEAT [{seconds}]", *moves, "O1 ENDREPEAT", end]  # more than enough
    (scenario / PROGRAM).write_text("\n".join(again) + "\n")
    return _run(scenario, float(seconds), folder / "out")


def figures_of_long_work() -> list[Figure]:
    """Take each piece of work in both lengths."""
    work = {
        "six axes": Work("s", _six_axes, SIMULATED, 500.0),
        "demo's machine": Work("lines", _lines, LINES, 500.0),
        "gcode": Work("lines", _checked, LINES, 300.0, 20.0),
    }
    found = []
    print(f"\n{'long work':34}{'rows':>12}{'processor s':>14}{'ns a row':>10}{'peak MB':>10}")
    with Progress(transient=True, console=Console(stderr=True)) as progress:
        task = progress.add_task("long work", total=2 * len(work))
        for name, w in work.items():
            spent = []
            with tempfile.TemporaryDirectory(dir=ROOT / "build") as folder:
                w.run(w.sizes[0] // 10, Path(folder))  # what is made once is there
            for size in w.sizes:
                with tempfile.TemporaryDirectory(dir=ROOT / "build") as folder:
                    spent.append(w.run(size, Path(folder)))
                progress.advance(task)
                s = spent[-1]
                told = f"{s.rows:12,}{s.seconds:14.1f}{s.each * 1e9:10.0f}{s.megabytes:10.0f}"
                print(f"{f'{name}, {size:,} {w.unit}':34}{told}")
            short, long = spent
            growth, all_of_it = long.each / short.each, f"{name}, {w.sizes[1]:,} {w.unit}"
            found += [
                Figure(f"{all_of_it}, a row over that of a tenth", growth, most=1.2),
                Figure(f"{all_of_it}, peak MB", long.megabytes, most=w.megabytes),
                Figure(f"{all_of_it}, s", long.seconds, most=w.seconds),
            ]
    return found
