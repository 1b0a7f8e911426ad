"""The demo exported, in other people's importers, beside the fused engine of the same system."""

import resource
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from medians import Medians
from peers import ROUNDS, Row, agree
from timed_runs import Timed

import motionfmu
from motionfmu.export import as_fmu, as_ssp

ROOT = Path(__file__).resolve().parents[2]
DEMO = ROOT / "scenarios/circle"
sys.path.insert(0, str(ROOT / "tests/importers"))
import importers  # noqa: E402
import matrix  # noqa: E402

TOOLS = ("libcosim", "ecos", "fmpy")
CHECKED = 1000  # steps whose outputs are compared bit for bit
ONE = "mcc.done"  # the output that is read of an FMU that is only stepped
SELDOM = 500  # steps from one look at it to the next
SHORT = 1000  # steps; a longer run less one of these has no start in it


@dataclass(frozen=True)
class _Way:
    """How an exported system is stepped and read."""

    what: str
    case: importers.Case
    every: int
    steps: int  # more than SHORT, so many that it takes about a second


def _used() -> float:
    """Processor time of processes that have ended [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Rows:
    """Processor time of a communication step [us]: a longer run less a shorter one."""

    def __init__(self) -> None:
        self._rounds = Medians()
        self._folder = tempfile.TemporaryDirectory(prefix="motionfmu-")
        self._place = Path(self._folder.name)
        if "--install" in sys.argv:
            matrix.set_up([importers.tool(name) for name in TOOLS])
        found = [importers.tool(name) for name in TOOLS]
        self._tools = [t for t in found if not t.install or t.installed()]
        self.missing = [
            f"{t.name} is not installed (make bench BENCH='--peers --install')"
            for t in found
            if t not in self._tools
        ]
        self._ours = {fmi: Timed(DEMO, engine="fused", fmi=fmi) for fmi in (2, 3)}
        self._ways = self._exported()

    def _exported(self) -> list[tuple[importers.Tool, _Way]]:
        """Export the demo, compare what each tool reads of it, and tell the ways to run it."""
        scenario = motionfmu.load(DEMO)
        step = scenario.document.body.step
        ran = scenario.run(stop=(CHECKED + 1) * step, engine="fused")
        expected, ways = {}, []
        for fmi in (2, 3):
            whole = importers.Case("circle", fmi, self._place / f"circle.fmi{fmi}.fmu")
            as_fmu(scenario, whole.file, fmi, {})
            names = importers.job(whole, self._place).names
            expected[whole] = np.column_stack([importers.column(ran, name) for name in names])
            only = importers.Case("circle one", fmi, whole.file, names=(ONE,))
            told = f"exported demo, one FMU {fmi}.0: a communication step"
            ways += [
                _Way(told, only, SELDOM, 40_000),
                _Way(f"{told}, {len(names)} outputs read", whole, 1, 10_000),
            ]
            if fmi == 2:
                file = self._place / "circle.ssp"
                as_ssp(scenario, file, 2, {})
                ssp = importers.Case("circle.ssp", 2, file, step, tuple(names))
                expected[ssp] = expected[whole]
                one = importers.Case("circle.ssp one", 2, file, step, (ONE,))
                told = "exported demo, SSP 1.0: a communication step"
                ways += [_Way(told, one, SELDOM, 10_000)]
        for tool in self._tools:
            for verdict in importers.verdicts(tool, expected):
                same = verdict.good or bool(tool.why(verdict.verdict))
                agree(f"{tool.name}, {verdict.fmu}, FMI {verdict.fmi}", same, verdict.verdict)
        found = []
        for way in ways:
            for tool in self._tools:
                arrays = tool.folder == "ecos" and way.case.fmi == 3  # it reads none
                if tool.can(way.case) and not (arrays and way.every == 1):
                    found.append((tool, way))
        return found

    def _taken(self, tool: importers.Tool, way: _Way, steps: int) -> float:
        job = importers.job(way.case, self._place, steps, way.every)
        before = _used()
        (told,) = tool.told([job]).values()
        agree(f"{tool.name}, {way.what}", told.startswith("ok"), told)
        return _used() - before

    def __call__(self) -> None:
        for ours in self._ours.values():
            ours()
        for tool, way in self._ways:
            steps = way.steps
            if tool.folder == "fmpy" and way.case.file.suffix == ".ssp":
                steps = 1_000  # of a millisecond each
            short = self._taken(tool, way, SHORT)
            long = self._taken(tool, way, SHORT + steps)
            self._rounds.add((tool.name, way.what), (long - short) / steps)

    def rows(self) -> list[Row]:
        """A row for each tool and each way."""
        step = {fmi: ours.loop / ours.steps for fmi, ours in self._ours.items()}
        return [
            Row(
                way.what,
                "µs",
                tool.version if tool.name in tool.version else f"{tool.name} {tool.version}",
                1e6 * step[way.case.fmi],
                1e6 * self._rounds[tool.name, way.what],
                ROUNDS,
            )
            for tool, way in self._ways
        ]
