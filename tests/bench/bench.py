"""Speed of the engines, as ratios measured in one run: `make bench`.

Every quantity is the best of several rounds, and the rounds take turns, so that a busy machine
slows all of them alike. README.md beside this file says what each line means and
where the time goes.
"""

import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import commands
import kinematics
import network
import numpy as np
import plans
import scurve_moves
import segments
import studies
from rich.console import Console
from rich.progress import Progress

import motionfmu

ROOT = Path(__file__).resolve().parents[2]
DEMO = ROOT / "scenarios/circle"
SIX_AXES = Path(__file__).parent / "six_axes"
ROBOT = ROOT / "scenarios/robot_line"
PULSE_AXES = Path(__file__).parent / "pulse_axes"
FUSED = ROOT / "build/tests/bench/fused"
CARD_COST = ROOT / "build/tests/bench/card_cost"
INTERPRETER_COST = ROOT / "build/tests/bench/interpreter_cost"
ROUNDS = 5
SLOW_STOP = 0.2  # [s] simulated by the engines that go through Python at every step


class Clock:
    """Takes the time between the first and the last report of progress before the end."""

    def __init__(self) -> None:
        self.marks: list[tuple[float, float]] = []

    def __call__(self, share: float) -> None:
        if share < 1.0:
            self.marks.append((share, time.perf_counter()))

    def seconds(self) -> float:
        """Time of the whole loop, from the part that was seen."""
        (first, start), (last, end) = self.marks[0], self.marks[-1]
        return (end - start) / (last - first)


class Timed:
    """A scenario under one engine: seconds of its loop and of the whole run, best of all rounds."""

    def __init__(self, scenario: Path, **options: Any) -> None:
        self.scenario, self.options = motionfmu.load(scenario), options
        self.loop = self.whole = float("inf")
        self.result: motionfmu.Result | None = None

    def __call__(self) -> None:
        clock = Clock()
        start = time.perf_counter()
        self.result = self.scenario.run(progress=clock, **self.options)
        self.whole = min(self.whole, time.perf_counter() - start)
        self.loop = min(self.loop, clock.seconds())

    @property
    def steps(self) -> int:
        assert self.result is not None
        return len(self.result.time)

    @property
    def simulated(self) -> float:
        """Simulated time [s]."""
        return float(self.options.get("stop") or self.scenario.document.body.stop_limit)

    @property
    def fmus(self) -> int:
        """FMUs stepped, the recorder among them."""
        return len(self.scenario.document.body.component) + 1


class Fused:
    """The demo's loop without FMI, tests/bench/fused.c."""

    def __init__(self, steps: int) -> None:
        self.steps, self.loop = steps, float("inf")
        layout = subprocess.check_output([FUSED, "--layout"], text=True).split("\n")
        *rows, size = [line.split() for line in layout if line]
        kinds = {"double": "f8", "int32_t": "i4", "bool": "?"}
        self.type = np.dtype(
            {
                "names": [row[0] for row in rows],
                "formats": [(kinds[row[1]], int(row[2])) for row in rows],
                "offsets": [int(row[3]) for row in rows],
                "itemsize": int(size[1]),
            }
        )
        self.data = np.zeros(0, self.type)

    def __call__(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "rows"
            program = str(DEMO / "circle.ngc")
            told = subprocess.check_output([FUSED, program, str(self.steps), file], text=True)
            self.loop = min(self.loop, float(told))
            self.data = np.fromfile(file, self.type)

    def check(self, result: motionfmu.Result) -> None:
        """The same bits as the engine gave, or it is another loop."""
        for name, signal in result.signals.items():
            if not np.array_equal(self.data[name].reshape(signal.shape), signal):
                sys.exit(f"bench: {name} differs between the fused loop and the native engine")


@dataclass
class Card:
    """The card alone: processor time per simulated second."""

    axes: int
    hertz: int
    edges: bool
    cost: float = np.inf

    def __call__(self) -> None:
        line = [CARD_COST, str(self.axes), str(self.hertz), str(int(self.edges))]
        self.cost = min(self.cost, float(subprocess.check_output(line, text=True).split()[0]))


class Interpreter:
    """The interpreter alone: processor time per line [s], and of strtod for its numbers."""

    def __init__(self) -> None:
        self.line = self.strtod = float("inf")

    def __call__(self) -> None:
        line, strtod, _ = subprocess.check_output([INTERPRETER_COST], text=True).split()
        self.line, self.strtod = min(self.line, float(line)), min(self.strtod, float(strtod))


def card_table(cards: list[Card]) -> None:
    """Cost of the card against pulse rate and axes."""
    print(f"\n{'card alone, ms per simulated s':32}{'counts':>10}{'all edges':>12}")
    for card in cards:
        if not card.edges:
            other = next(
                c for c in cards if c.edges and (c.axes, c.hertz) == (card.axes, card.hertz)
            )
            what = f"{card.axes} axes at {card.hertz / 1000:g} kHz"
            print(f"  {what:30}{card.cost * 1e3:10.2f}{other.cost * 1e3:12.2f}")


def rounds(runs: list[Callable[[], None]]) -> None:
    """Let all take turns."""
    with Progress(transient=True, console=Console(stderr=True)) as progress:
        task = progress.add_task("measuring", total=ROUNDS * len(runs))
        for _ in range(ROUNDS):
            for run in runs:
                run()
                progress.advance(task)


def verdict(what: str, figure: float, most: float = np.inf, least: float = 0.0) -> None:
    """Print a ratio beside what is asked of it."""
    asked = f"at most {most:g}" if least == 0.0 else f"at least {least:g}"
    print(f"{what:44}{figure:8.2f}   {'' if least <= figure <= most else 'MISSED, '}asked: {asked}")


def main() -> None:
    native, six = Timed(DEMO), Timed(SIX_AXES)
    engines = {
        "native, FMI 3": native,
        "native, FMI 2": Timed(DEMO, fmi=2),
        "python, FMI 3": Timed(DEMO, engine="python", stop=SLOW_STOP),
        "python, FMI 2": Timed(DEMO, engine="python", fmi=2, stop=SLOW_STOP),
        "fmpy (container), FMI 2": Timed(DEMO, engine="fmpy", fmi=2, stop=SLOW_STOP),
    }
    native()
    assert native.result is not None
    fused = Fused(native.steps)
    pulses = Timed(PULSE_AXES)
    cards = [Card(a, h, e) for a in (1, 3, 6) for h in (0, 10_000, 500_000) for e in (False, True)]
    interpreter = Interpreter()
    curves = [
        plans.Plans("rest to rest", scurve_moves.rest_to_rest),
        plans.Plans("in motion to rest", scurve_moves.to_rest),
    ]
    arm = kinematics.Kinematics()
    net = network.Network()
    robot = Timed(ROBOT, stop=20.0)
    asked = commands.all_commands()
    rounds(
        [
            fused,
            *engines.values(),
            six,
            pulses,
            *cards,
            interpreter,
            arm,
            net,
            robot,
            *asked,
            *curves,
            *segments.ALL,
            segments.LONG,
        ]
    )
    fused.check(native.result)

    base = fused.loop / fused.steps
    print(f"{'demo, one step of all FMUs':28}{'ns':>10}{'ns/FMU':>10}{'x fused':>10}")
    print(f"{'fused in C, no FMI':28}{base * 1e9:10.0f}{'':>10}{1.0:10.2f}")
    for name, run in engines.items():
        step = run.loop / run.steps
        print(f"{name:28}{step * 1e9:10.0f}{step / run.fmus * 1e9:10.0f}{step / base:10.2f}")
    print(f"\n{'simulated s per wall s':28}{'loop':>10}{'whole run':>10}")
    for name, run in (
        ("demo", native),
        ("six ball-screw axes", six),
        ("six pulse axes at 500 kHz", pulses),
        ("robot draws a line", robot),
    ):
        print(f"{name:28}{run.simulated / run.loop:10.1f}{run.simulated / run.whole:10.1f}")
    card_table(cards)
    print(f"\n{'one line of a part program':28}{'ns':>10}{'x strtod':>20}")
    ratio = interpreter.line / interpreter.strtod
    print(f"{'read, checked, planned':28}{interpreter.line * 1e9:10.0f}{ratio:20.2f}")
    plans.table(curves)
    segments.table(curves[0].ruckig)
    net.table(curves[0].ruckig)
    arm.table()
    study = studies.Study()
    study()
    study.table()
    print()
    verdict("native engine / fused loop", native.loop / native.steps / base, most=2.0)
    verdict("six axes, simulated s per wall s of the loop", six.simulated / six.loop, least=10.0)
    verdict("robot draws a line, times real time", robot.simulated / robot.loop, least=8.0)
    fastest = 1.0 / next(c.cost for c in cards if c.axes == 6 and c.hertz > 1e5 and not c.edges)
    edges = 1.0 / next(c.cost for c in cards if c.axes == 6 and c.hertz > 1e5 and c.edges)
    verdict("card with six axes at 500 kHz, times real time", fastest, least=20.0)
    verdict("the same, every edge asked for", edges, least=20.0)
    verdict(
        "the same as FMUs with the library, whole loop", pulses.simulated / pulses.loop, least=20.0
    )
    verdict("interpreter, million lines/s", 1e-6 / interpreter.line, least=0.5)
    for curve in curves:
        verdict(f"ruckig / scurve, {curve.name}", curve.ruckig / curve.scurve, least=1.0)
    for s in segments.ALL:
        least = 1.0 if s is segments.LONG.walk else 0.1 if s.jerk else 0.2
        verdict(f"{s.name}, million segments/s", 1e-6 / max(s.cost.values()), least=least)
        verdict(f"{s.name}, 256 over 16 commands", s.growth, most=1.5)
    verdict("the same, 100,000 over 1,000 segments", segments.LONG.growth, most=1.2)
    verdict(
        f"{network.SEGMENTS:,} lines of a drawing, s to plan", network.SEGMENTS * net.plan, most=2.0
    )
    verdict(
        f"{network.CARDS} network cards, times real time", 1 / net.card / network.CARDS, least=1.0
    )
    verdict("arm, all eight branches, us", 1e6 * arm.inverse, most=1.0)
    verdict("py-opw-kinematics / ours", arm.other / arm.inverse, least=1.0)
    for command in asked:
        verdict(f"motionfmu {command.line}, processor s", command.seconds, most=0.3)
    verdict("sweep, efficiency of all cores", study.efficiency, least=0.9)


if __name__ == "__main__":
    main()
