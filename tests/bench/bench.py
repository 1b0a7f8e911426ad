"""Speed of the engines, as ratios measured in one run: `make bench`.

Every time is processor time, the median of several rounds, and the runs take turns, so that a busy
machine slows all of them alike; instructions are counted beside. README.md beside this file says
what each line means and where the time goes. `--renew` keeps the figures as those to compare with,
`--quick` takes one round, a rough look that is never kept; `--long` does long work alone,
`--cluster` does a study on a cluster, `--profile` tells where the instructions of a step go,
`--growth` how cost grows with size, and `--peers` has other people's tools beside ours.
"""

import math
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import cluster
import commands
import counting
import figures
import growth
import identifying
import kinematics
import long_page
import long_run
import network
import numpy as np
import peers
import plans
import profiles
import scope_cost
import segments
import sessions
import states
import studies
from figures import Figure
from medians import Medians
from rich.console import Console
from rich.progress import Progress
from timed_runs import Timed

import motionfmu
from motionfmu.run.engines import ENGINES

ROOT = Path(__file__).resolve().parents[2]
DEMO = ROOT / "scenarios/circle"
SIX_AXES = Path(__file__).parent / "six_axes"
ROBOT = ROOT / "scenarios/robot_line"
PULSE_AXES = Path(__file__).parent / "pulse_axes"
FOURTEEN = ROOT / "scenarios/fourteen_axes"
PLATE = ROOT / "scenarios/plt_plate"
BUILT = ROOT / "build/tests/bench"
CARD_COST = BUILT / "card_cost"
INTERPRETER_COST = BUILT / "interpreter_cost"
QUICK, RENEW = "--quick" in sys.argv, "--renew" in sys.argv
ROUNDS = 1 if QUICK else 5
SLOW_STOP = 0.2  # [s] simulated by the engines that go through Python at every step


class Fused:
    """The loop of a scenario fused by hand, without FMI: tests/bench/fused.c."""

    def __init__(self, scenario: Path, part_program: str, steps: int) -> None:
        self.steps, self._rounds = steps, Medians()
        self.line = [BUILT / f"fused_{scenario.name}", scenario / part_program]
        layout = subprocess.check_output([self.line[0], "--layout"], text=True).split("\n")
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
            told = subprocess.check_output([*self.line, str(self.steps), file], text=True)
            self._rounds.add("loop", float(told))
            self.data = np.fromfile(file, self.type)

    @property
    def loop(self) -> float:
        return self._rounds["loop"]

    def check(self, result: motionfmu.Result) -> None:
        """The same bits as the engine gave, or it is another loop."""
        for name, signal in result.signals.items():
            if not np.array_equal(self.data[name].reshape(signal.shape), signal):
                sys.exit(f"bench: {name} differs between the hand-fused loop and the engine")


@dataclass
class Card:
    """The card alone: processor time per simulated second."""

    axes: int
    hertz: int
    edges: bool
    rounds: Medians = field(default_factory=Medians)

    def __call__(self) -> None:
        line = [CARD_COST, str(self.axes), str(self.hertz), str(int(self.edges))]
        self.rounds.add("cost", float(subprocess.check_output(line, text=True).split()[0]))

    @property
    def cost(self) -> float:
        return self.rounds["cost"]


class Interpreter:
    """The interpreter alone: processor time per line [s], and of strtod for its numbers."""

    def __init__(self) -> None:
        self._rounds = Medians()

    def __call__(self) -> None:
        line, strtod, _ = subprocess.check_output([INTERPRETER_COST], text=True).split()
        self._rounds.add("line", float(line))
        self._rounds.add("strtod", float(strtod))

    @property
    def line(self) -> float:
        return self._rounds["line"]

    @property
    def strtod(self) -> float:
        return self._rounds["strtod"]


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


@dataclass(frozen=True)
class Aims:
    """What is asked of the fused engine: over the loop by hand, and instructions of a step."""

    hand: float
    instructions: float


def profiled(loops: dict[str, Fused]) -> list[counting.Loop]:
    """The hand-fused loops optimised by profiles of their own runs, where they were built so."""
    found = []
    for name, hand in loops.items():
        file, program = hand.line
        built = BUILT.parents[1] / "profiled/tests/bench" / file.name
        if built.exists():
            line = [built, program, "{}", "/dev/null"]
            found.append(counting.Loop(f"{name}, hand-fused, profiled", line))
    return found


def system_figures(
    name: str, hand: Fused, runs: dict[str, Timed], loops: dict[str, counting.Loop], aims: Aims
) -> list[Figure]:
    """Engines over the loop fused by hand: by time and by instructions."""
    found = []
    base, counted = hand.loop / hand.steps, loops[f"{name}, hand-fused"].count
    print(f"\n{f'{name}, one step':34}{'ns':>10}{'x hand':>10}{'instructions':>14}{'x hand':>10}")
    print(f"{'fused by hand, no FMI':34}{base * 1e9:10.0f}{1.0:10.2f}{counted:14.0f}{1.0:10.2f}")
    found.append(Figure(f"{name}, hand-fused, instructions a step", counted, counted=True))
    if told := loops.get(f"{name}, hand-fused, profiled"):  # for information
        print(f"{'the same, by a profile':34}{'':20}{told.count:14.0f}{told.count / counted:10.2f}")
    for engine, run in runs.items():
        step, count = run.loop / run.steps, loops[f"{name}, {engine}"].count
        ratio = f"{step / base:10.2f}{count:14.0f}{count / counted:10.2f}"
        print(f"{engine:34}{step * 1e9:10.0f}{ratio}")
        most = math.inf
        if engine.startswith("fused"):
            of, most = f"{name}, {engine} / hand-fused", aims.instructions
            found.append(Figure(f"{of}, time", step / base, aims.hand))
            found.append(Figure(f"{of}, instructions", count / counted, aims.hand, counted=True))
        found.append(Figure(f"{name}, {engine}, instructions a step", count, most, counted=True))
    return found


def main(kept: figures.Kept) -> None:
    best = next(e for e in ("fused", "native") if e in ENGINES)
    quick = [e for e in ("fused", "native") if e in ENGINES]
    demos = {f"{e}, FMI {f}": Timed(DEMO, engine=e, fmi=f) for e in quick for f in (3, 2)}
    demos |= {
        f"{e}, FMI {f}": Timed(DEMO, engine=e, fmi=f, stop=SLOW_STOP)
        for e, f in (("python", 3), ("python", 2), ("fmpy", 3), ("fmpy", 2))
    }
    sixes = {f"{e}, FMI 3": Timed(SIX_AXES, engine=e) for e in quick}
    native, six = demos[f"{best}, FMI 3"], sixes[f"{best}, FMI 3"]
    native()
    six()
    assert native.result is not None and six.result is not None
    by_hand = Fused(DEMO, "circle.ngc", native.steps)
    by_hand_six = Fused(SIX_AXES, "six_axes.ngc", six.steps)
    pulses = Timed(PULSE_AXES)
    cards = [Card(a, h, e) for a in (1, 3, 6) for h in (0, 10_000, 500_000) for e in (False, True)]
    interpreter = Interpreter()
    curves = [plans.Plans(kind) for kind in plans.KINDS]
    arm = kinematics.Kinematics()
    net = network.Network()
    robot, fourteen = Timed(ROBOT, stop=20.0), Timed(FOURTEEN)
    asked, structure = commands.all_commands(), commands.NewStructure()
    tuning, short = sessions.Tuning(), sessions.ShortRun()
    library = states.States("mcc")
    scope = scope_cost.ScopeCost()
    records = identifying.all_records()
    rounds(
        [
            by_hand,
            *demos.values(),
            by_hand_six,
            *sixes.values(),
            pulses,
            *cards,
            interpreter,
            arm,
            net,
            robot,
            fourteen,
            *asked,
            structure,
            tuning,
            short,
            *records,
            library,
            scope,
            *curves,
            *segments.ALL,
            segments.LONG,
        ]
    )
    by_hand.check(native.result)
    by_hand_six.check(six.result)
    study = studies.Study()
    study()
    loops = [
        counting.Loop("demo, hand-fused", [*by_hand.line, "{}", "/dev/null"]),
        counting.Loop("six axes, hand-fused", [*by_hand_six.line, "{}", "/dev/null"]),
        *(
            counting.Loop(
                f"demo, {name}",
                counting.of_run(DEMO, run.options["engine"], run.options["fmi"]),
                (100, 300) if "stop" in run.options else counting.STEPS,
            )
            for name, run in demos.items()
        ),
        *(
            counting.Loop(f"six axes, {name}", counting.of_run(SIX_AXES, run.options["engine"]))
            for name, run in sixes.items()
        ),
        *profiled({"demo": by_hand, "six axes": by_hand_six}),
        counting.Loop("robot", counting.of_run(ROBOT, best), (20_000, 30_000)),
        counting.Loop("network card", counting.of_run(PLATE, best)),
        *(loop for c in curves for loop in c.loops()),
    ]
    counts = counting.count(loops, studies.loops(study.cores))

    found = system_figures("demo", by_hand, demos, counts, Aims(1.1, 7_000))
    found += system_figures("six axes", by_hand_six, sixes, counts, Aims(1.1, 10_000))
    print(f"\n{'simulated s per processor s':34}{'loop':>10}{'whole run':>10}")
    for name, run in (
        ("demo", native),
        ("six ball-screw axes", six),
        ("six pulse axes at 500 kHz", pulses),
        ("robot draws a line", robot),
        ("fourteen axes", fourteen),
    ):
        print(f"{name:34}{run.simulated / run.loop:10.1f}{run.simulated / run.whole:10.1f}")
    card_table(cards)
    print(f"\n{'one line of a part program':34}{'ns':>10}{'x strtod':>20}")
    ratio = interpreter.line / interpreter.strtod
    print(f"{'read, checked, planned':34}{interpreter.line * 1e9:10.0f}{ratio:20.2f}")
    plans.table(curves, counts)
    segments.table()
    net.table()
    arm.table()
    study.table()
    fast = [c.cost for c in cards if c.axes == 6 and c.hertz > 1e5]
    found += [
        Figure("six axes, loop, times real time", six.simulated / six.loop, least=50.0),
        Figure("six axes, whole run, times real time", six.simulated / six.whole, least=25.0),
        Figure("robot draws a line, loop, times real time", robot.simulated / robot.loop, least=25),
        Figure("robot, instructions a step", counts["robot"].count, 22_000, counted=True),
        Figure(
            "network card, instructions a step", counts["network card"].count, 4_400, counted=True
        ),
        Figure(
            "fourteen axes, loop, times real time", fourteen.simulated / fourteen.loop, least=20
        ),
        Figure("card with six axes at 500 kHz, times real time", 1 / fast[0], least=20.0),
        Figure("the same, every edge asked for", 1 / fast[1], least=20.0),
        Figure("the same as FMUs, whole loop", pulses.simulated / pulses.loop, least=20.0),
        Figure("interpreter, million lines/s", 1e-6 / interpreter.line, least=0.5),
        *(
            Figure(
                f"ruckig / scurve, {c.name}, instructions", c.ratio(counts), least=1, counted=True
            )
            for c in curves
        ),
    ]
    for s in segments.ALL:
        least = 1.0 if s is segments.LONG.walk else 0.1 if s.jerk else 0.2
        found.append(Figure(f"{s.name}, million segments/s", s.rate, least=least))
        found.append(Figure(f"{s.name}, 256 over 16 commands", s.growth, most=1.5))
    planned = network.SEGMENTS * net.rounds["plan"]
    in_motion = 1 / net.rounds["card"] / network.CARDS
    found += [
        Figure("the same, 100,000 over 1,000 segments", segments.LONG.growth, most=1.2),
        Figure(f"{network.SEGMENTS:,} lines of a drawing, s to plan", planned, most=2.0),
        Figure(f"{network.CARDS} network cards, times real time", in_motion, least=1.0),
        Figure("arm, all eight branches, us", 1e6 * arm.rounds["inverse"], most=1.0),
        Figure("py-opw-kinematics / ours", arm.rounds["other"] / arm.rounds["inverse"], least=1.0),
        *(Figure(f"motionfmu {c.line}, s", c.seconds, most=c.asked) for c in asked),
        *(
            Figure(f"motionfmu {c.line}, G instructions", count / 1e9, counted=True)
            for c, count in counting.of_commands(asked)
        ),
        Figure("tune scenarios/circle in a session, s", tuning.seconds, most=1.0),
        Figure(f"a run of {sessions.STEPS} steps in a session, ms", 1e3 * short.seconds, most=0.5),
        Figure("compile of a new structure, s", structure.seconds, most=0.15),
        *(Figure(r.name, r.seconds, most=r.most) for r in records),
        Figure("state of mcc at rest, kB", library.size / 1e3, most=40.0, counted=True),
        Figure("state of mcc at rest, us to save", 1e6 * library.rounds["save"], most=5.0),
        Figure("state of mcc at rest, us to restore", 1e6 * library.rounds["restore"], most=5.0),
        Figure(
            "live machine, step with 16 channels / plain",
            scope.step["traced"] / scope.step["plain"],
            most=12,
        ),
        Figure("the same, times real time", 1e-4 / scope.step["traced"], least=4.0),
        *study.figures(counts),
    ]
    figures.show(found, counting.method(), kept)


if __name__ == "__main__":
    if QUICK and RENEW:
        sys.exit("bench: --quick takes one round, which --renew does not keep")
    if "--profile" in sys.argv:
        profiles.main()
    elif "--growth" in sys.argv:
        words = [a.removeprefix("--only=") for a in sys.argv if a.startswith("--only=")]
        growth.main(RENEW, *words)
    elif "--peers" in sys.argv:
        peers.main(RENEW)
    elif "--long" in sys.argv:
        long = [*long_page.figures_of_long_page(), *long_run.figures_of_long_work()]
        figures.show(long, None, figures.Kept.SHOWN)
    elif "--cluster" in sys.argv:
        figures.show(cluster.figures_of_a_cluster(), None, figures.Kept.SHOWN)
    else:
        one, more = figures.Kept.ONE_ROUND, figures.Kept.SHOWN
        main(one if QUICK else figures.Kept.NEW if RENEW else more)
