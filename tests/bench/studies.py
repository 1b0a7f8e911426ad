"""What a study costs beside its runs: many short ones; and a run of the demo with its contour."""

import resource
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from counting import Loop
from figures import Figure
from rich.console import Console
from rich.progress import Progress

from motionfmu.study import processes
from motionfmu.study.study_definition import Study as Chosen
from motionfmu.sweep import Ways, conduct, study

SCENARIOS = Path(__file__).resolve().parents[2] / "scenarios"
RUNS = 1000
STOP = 1.0  # [s] simulated: some hundredths of a second of work
DEMO_RUNS = 24, 104  # start, table and report are the same in both


def _cpu() -> float:
    """Processor time of this process and those it has waited for [s]."""
    used = [resource.getrusage(w) for w in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(u.ru_utime + u.ru_stime for u in used)


class Study:
    """Seconds of the same study by one worker and by one per core, from its file to the report.

    Efficiency is the time of one worker over the time of all, divided by their number: what
    starting processes, handing out, keeping rows and drawing leave of the cores. By processor
    time it is what the same runs cost more when they run beside each other.
    """

    def __init__(self) -> None:
        self.cores = processes.cores()
        self.seconds = {1: 0.0, self.cores: 0.0}
        self.cpu = dict(self.seconds)
        self.demo = 0.0  # [s] of processor, a run

    def __call__(self) -> None:
        for workers in self.seconds:
            short = _conduct(_chosen("circle_theory", RUNS), workers)
            self.seconds[workers], self.cpu[workers] = short
        few, many = (_conduct(_chosen("circle", n), 1)[1] for n in DEMO_RUNS)
        self.demo = (many - few) / (DEMO_RUNS[1] - DEMO_RUNS[0])

    def table(self) -> None:
        """Seconds of both."""
        print(f"\n{f'sweep of {RUNS} runs':34}{'s':>10}{'ms/run':>10}{'processor s':>14}")
        for workers, seconds in self.seconds.items():
            row = f"{seconds:10.1f}{seconds / RUNS * 1e3:10.1f}{self.cpu[workers]:14.1f}"
            print(f"{f'{workers} at a time':34}{row}")

    def figures(self, counts: dict[str, Loop]) -> list[Figure]:
        """What is asked of them."""
        alone, beside = counts["sweep, 1"].count, counts[f"sweep, {self.cores}"].count
        one, all_ = self.seconds[1], self.seconds[self.cores]
        return [
            Figure("sweep, efficiency of all cores, wall time", one / all_ / self.cores, least=0.9),
            Figure(
                "sweep, processor time of one over all",
                self.cpu[1] / self.cpu[self.cores],
                least=0.9,
            ),
            Figure("sweep, instructions of one over all", alone / beside, least=0.9),
            Figure(
                "sweep of the demo, G instructions a run",
                counts["sweep of the demo"].count / 1e9,
                counted=True,
            ),
            Figure("sweep of the demo, runs/s of a core", 1.0 / self.demo, least=15.0),
        ]


def _chosen(scenario: str, runs: int) -> Chosen:
    """So many gains; of the demo what its own study asks for."""
    keys: dict[str, Any] = {
        "axis": {"mcc.p_gain": {"from": 50, "to": 50 + max(runs - 1, 1), "n": runs}}
    }
    if scenario != "circle":
        keys |= {
            "results": ["card.err_count.absmax", "machine.table_position[1].final"],
            "stop": STOP,
        }
    return study(SCENARIOS / scenario, keys)


def loops(cores: int) -> list[Loop]:
    """Instructions of a run of each study: the demo's, the short one's in both ways."""
    line = [sys.executable, __file__]
    return [
        Loop("sweep of the demo", [*line, "circle", "1", "{}"], (2, 4)),
        *(
            Loop(f"sweep, {n}", [*line, "circle_theory", str(n), "{}"], (20, 60))
            for n in (1, cores)
        ),
    ]


def _conduct(chosen: Chosen, workers: int) -> tuple[float, float]:
    """A study from its start to its report: wall and processor time [s]."""
    bar = Progress(transient=True, console=Console(stderr=True))
    with tempfile.TemporaryDirectory() as name, bar:
        task = bar.add_task(f"sweep, {workers} at a time", total=None)
        start, cpu = time.perf_counter(), _cpu()
        ways = Ways(
            workers=workers, progress=lambda n, all_: bar.update(task, completed=n, total=all_)
        )
        conduct(chosen, Path(name) / "out", ways)
        return time.perf_counter() - start, _cpu() - cpu


if __name__ == "__main__":
    _conduct(_chosen(sys.argv[1], int(sys.argv[3])), int(sys.argv[2]))
