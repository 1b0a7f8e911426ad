"""How cost grows with size: `make bench BENCH=--growth`.

Each work is done in several sizes, and its cost counted: instructions, which are the same on a busy
machine, or processor time where a count would take an hour. A size costs what the smallest does and
something more; the exponent of that excess over that in size is 1 if cost is linear, whatever
the start costs. Steps between two sizes are told, too: vectors have lanes for two axes and for six.
"""

import itertools
import json
import math
import shutil
import statistics
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import commands
import counting
import long_run
from rich.console import Console
from rich.progress import Progress

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
KEPT = HERE / "growth.json"
TABLE = ROOT / "src/motionfmu/machines/xy_table/machine.toml"
DEMO = ROOT / "scenarios/circle"
LINEAR = 1.1  # the most that an exponent may be
# Share of the smallest cost that an excess must have: less is lost in what differs from run to run.
SEEN = {"M instructions": 0.03, "s": 0.1}
ROUNDS = 3  # of processor time
LETTERS = "XYZUVW"


@dataclass(frozen=True)
class Work:
    """What is done in several sizes."""

    name: str
    cost: Callable[[int, Path], float]  # of a size, with a folder to work in
    sizes: Sequence[int]
    unit: str = "M instructions"


@dataclass(frozen=True)
class Grown:
    """What a work has cost."""

    name: str
    unit: str
    sizes: Sequence[int]
    costs: Sequence[float]

    @property
    def exponents(self) -> list[float]:
        """From each size to the next; NaN where the excess is too small to be seen."""
        first = self.costs[0]
        beyond = [(n - self.sizes[0], c - first) for n, c in self.pairs[1:]]
        found = []
        for (n, c), (m, d) in itertools.pairwise(beyond):
            seen = min(c, d) > SEEN[self.unit] * first
            found.append(math.log(d / c) / math.log(m / n) if seen else math.nan)
        return found

    @property
    def pairs(self) -> list[tuple[int, float]]:
        """Each size with its cost."""
        return list(zip(self.sizes, self.costs, strict=True))

    @property
    def exponent(self) -> float:
        """The slope of the largest sizes that show one, three of them if so many do."""
        first = self.costs[0]
        rows = [
            (math.log(n - self.sizes[0]), math.log(c - first))
            for n, c in self.pairs[1:]
            if c - first > SEEN[self.unit] * first
        ][-3:]
        return (
            statistics.linear_regression(*zip(*rows, strict=True)).slope if rows[1:] else math.nan
        )

    @property
    def verdict(self) -> str:
        """Whether cost is linear."""
        if math.isnan(self.exponent):
            return "not seen"
        return "" if self.exponent <= LINEAR else "MISSED"


def tables(count: int, folder: Path) -> Path:
    """So many tables of the demo in one scenario: each with library, card, drives and machine."""
    machine = tomllib.loads(TABLE.read_text(encoding="utf-8"))

    def own(name: str, k: int) -> str:
        component, dot, rest = name.partition(".")
        return f"{component}_{k}{dot}{rest}"

    def every(names: Sequence[str]) -> str:
        return json.dumps([own(name, k) for k in range(count) for name in names])

    text = [
        f"# {count} tables of the demo.",
        "stop = 8.0",
        f"step = {machine['step']!r}",
        f"leave = {every(machine['leave'])}",
    ]
    for table in ("component", "connect", "set"):
        text.append(f"[{table}]")
        for k in range(count):
            for name, value in machine[table].items():
                said = own(value, k) if table == "connect" else value
                text.append(f"{json.dumps(own(name, k))} = {json.dumps(said)}")
    text += [f'"mcc_{k}.program" = "circle.ngc"' for k in range(count)]
    text += ["[record]", f"signals = {every(machine['record']['signals'])}", ""]
    made = folder / f"tables_{count}"
    made.mkdir()
    (made / "scenario.toml").write_text("\n".join(text), encoding="utf-8")
    shutil.copy(DEMO / "circle.ngc", made)
    return made


def axes(count: int, folder: Path) -> Path:
    """The benchmark's six axes with so many of them in use."""
    made = folder / f"axes_{count}"
    made.mkdir()
    active = json.dumps([k < count for k in range(6)])
    text = (long_run.SIX_AXES / "scenario.toml").read_text(encoding="utf-8")
    one = '"mcc.active"  = true'
    assert one in text
    rows = [f'"{part}.active" = {active}' for part in ("mcc", "card", "drives", "machine")]
    (made / "scenario.toml").write_text(text.replace(one, "\n".join(rows)), encoding="utf-8")
    way = " ".join(f"{letter}50" for letter in LETTERS[:count])
    program = f"%\nG21 G17 G90 G64\nG1 {way} F6000\nM30\n%\n"
    (made / long_run.PROGRAM).write_text(program, encoding="utf-8")
    return made


def _step(scenario: Path) -> float:
    """Instructions of a step of the fused engine [M]."""
    loop = counting.Loop(scenario.name, counting.of_run(scenario, "fused"))
    loop()
    return loop.count / 1e6


def _command(*words: str | Path) -> list[str | Path]:
    return [sys.executable, "-m", "motionfmu", *words]


def _counted(line: Sequence[str | Path]) -> float:
    """Instructions of a process [M], once what is made once is there."""
    commands.taken(line)
    return counting.instructions(line) / 1e6


def _axes_step(count: int, folder: Path) -> float:
    return _step(axes(count, folder))


def _tables_step(count: int, folder: Path) -> float:
    return _step(tables(count, folder))


def _tables_run(count: int, folder: Path) -> float:
    """Processor time of a run once its program is there [s]."""
    line = _tables_line(count, folder)
    commands.taken(line)
    return statistics.median(commands.taken(line) for _ in range(ROUNDS))


def _tables_first(count: int, folder: Path) -> float:
    """Processor time of a first run: its program is compiled, its gains are found [s]."""
    line = _tables_line(count, folder)
    if count == 1:  # modules are compiled
        commands.taken(line)
    return commands.taken(line, MOTIONFMU_CACHE=str(folder / "cache"))


def _tables_line(count: int, folder: Path) -> list[str | Path]:
    return _command("run", tables(count, folder), "--stop", "0.5", "--out", folder / "out")


def _gcode(lines: int, folder: Path) -> float:
    file = folder / "spiral.ngc"
    file.write_text(long_run.spiral(lines), encoding="utf-8")
    return _counted(_command("gcode", file, "--out", folder / "out"))


def _driven(lines: int, folder: Path) -> float:
    scenario = long_run.on_a_spiral(lines, folder)
    stop = f"{lines * long_run.LENGTH / long_run.FEED + 2.0:g}"
    return _counted(_command("run", scenario, "--stop", stop, "--out", folder / "out"))


def _growing(work: str, size: int, folder: Path) -> float:
    """Processor time of a work of growing.py [s]."""
    line = [sys.executable, HERE / "growing.py", work, str(size), folder]
    environment = commands.environment()
    found = []
    for _ in range(1 + ROUNDS):  # in the first what is made once is made
        told = subprocess.check_output(line, env=environment, text=True)
        found.append(float(told.split()[-1]))
    return statistics.median(found[1:])


def _study(runs: int, folder: Path) -> float:
    return _growing("study", runs, folder)


def _page(thousands: int, folder: Path) -> float:
    made = folder / "long"
    shutil.copytree(DEMO, made)
    program = made / "circle.ngc"
    first, *lines = program.read_text(encoding="utf-8").replace("%", "").strip().splitlines()
    assert lines[-1].endswith("M30")
    again = [first, f"O1 REPEAT [{thousands}]", *lines[:-1], "O1 ENDREPEAT", lines[-1]]
    program.write_text("\n".join(again) + "\n", encoding="utf-8")
    return _growing("page", thousands, folder)


WORKS = (
    Work("axes of one card, a step", _axes_step, (1, 2, 4, 6)),
    Work("cards, each with library, drives, machine: a step", _tables_step, (1, 2, 4, 8, 16)),
    Work("the same, a run of 0.5 s with its page", _tables_run, (1, 2, 4, 8, 16), "s"),
    Work("the same, once, with nothing kept from before", _tables_first, (1, 2, 4, 8, 16), "s"),
    Work("lines of a part program, motionfmu gcode", _gcode, (1, 10, 100, 1000, 10_000)),
    Work("driven blocks with contour and page", _driven, (1, 10, 100, 1000, 10_000)),
    Work("runs of a study", _study, (2, 10, 100, 1000), "s"),
    Work("page of so many thousand samples", _page, (1, 10, 100, 1000), "s"),
)


def measured(works: Sequence[Work] = WORKS) -> list[Grown]:
    """Do each work in all its sizes."""
    found = []
    with Progress(transient=True, console=Console(stderr=True)) as progress:
        task = progress.add_task("growth", total=sum(len(w.sizes) for w in works))
        for work in works:
            costs = []
            for size in work.sizes:
                with tempfile.TemporaryDirectory(dir=ROOT / "build") as folder:
                    costs.append(work.cost(size, Path(folder)))
                progress.advance(task)
            found.append(Grown(work.name, work.unit, work.sizes, costs))
            print("\n".join(lines(found[-1])), flush=True)
    return found


def lines(grown: Grown) -> list[str]:
    """Sizes, costs and exponents below each other."""
    told = [f"{e:.2f}" if not math.isnan(e) else "-" for e in grown.exponents]
    return [
        f"\n{f'{grown.name} [{grown.unit}]':64}{grown.exponent:6.2f}  {grown.verdict}",
        "  size      " + "".join(f"{n:>12,}" for n in grown.sizes),
        "  cost      " + "".join(f"{c:12.4g}" for c in grown.costs),
        "  exponent  " + "".join(f"{e:>12}" for e in ("", "", *told)),
    ]


def kept() -> list[Grown]:
    """What was kept, in the order of `WORKS`."""
    found = {row["name"]: Grown(**row) for row in json.loads(KEPT.read_text(encoding="utf-8"))}
    return [found[work.name] for work in WORKS if work.name in found]


def table(rows: Sequence[Grown]) -> str:
    """The rows in Markdown, with what each size costs."""
    told = [
        "| what | sizes | cost | exponent | |",
        "|---|---|---|---|---|",
    ]
    for g in rows:
        sizes, costs = (
            ", ".join(f"{x:,.0f}" if x >= 1000 else f"{x:.4g}" for x in v)
            for v in (g.sizes, g.costs)
        )
        slope = "-" if math.isnan(g.exponent) else f"{g.exponent:.2f}"
        told.append(f"| {g.name} | {sizes} | {costs} {g.unit} | {slope} | {g.verdict} |")
    return "\n".join(told) + "\n"


def main(renew: bool, only: str = "") -> None:
    """Print the table, of works with some words in their name alone; keep its rows if asked."""
    print(f"what each size costs; the exponent of the largest is to be at most {LINEAR:g}")
    works = [w for w in WORKS if only in w.name]
    if counting.method() is None:
        print("nothing counts instructions here: processor time alone")
        works = [w for w in works if w.unit == "s"]
    found = measured(works)
    if renew:
        rows = {g.name: g for g in (*(kept() if KEPT.exists() else ()), *found)}
        told = [
            {
                "name": g.name,
                "unit": g.unit,
                "sizes": list(g.sizes),
                "costs": [float(f"{c:.4g}") for c in g.costs],
            }
            for work in WORKS
            if (g := rows.get(work.name))
        ]
        KEPT.write_text(json.dumps(told, indent=1) + "\n", encoding="utf-8")
