"""What a study costs beside its runs: a thousand short ones, by one worker and by one per core."""

import tempfile
import time
from pathlib import Path

from rich.console import Console
from rich.progress import Progress

from motionfmu.study import processes
from motionfmu.sweep import Ways, conduct, study

SCENARIO = Path(__file__).resolve().parents[2] / "scenarios/circle_theory"
RUNS = 1000
STOP = 1.0  # [s] simulated: about 0.05 s of work


class Study:
    """Seconds of the same study in both ways, from its file to the report.

    Efficiency is the time of one worker over the time of all, divided by their number: what
    starting processes, handing out, keeping rows and drawing leave of the cores.
    """

    def __init__(self) -> None:
        self.cores = processes.cores()
        self.seconds = {1: 0.0, self.cores: 0.0}

    def __call__(self) -> None:
        axis = {"mcc.p_gain": {"from": 50, "to": 50 + RUNS - 1, "n": RUNS}}
        results = ["card.err_count.absmax", "machine.table_position[1].final"]
        chosen = study(SCENARIO, {"axis": axis, "results": results, "stop": STOP})
        console = Console(stderr=True)
        with (
            tempfile.TemporaryDirectory() as name,
            Progress(transient=True, console=console) as bar,
        ):
            for workers in self.seconds:
                task = bar.add_task(f"sweep, {workers} at a time", total=RUNS)

                def show(done: int, _: int, task: object = task) -> None:
                    bar.update(task, completed=done)

                start = time.perf_counter()
                conduct(chosen, Path(name) / str(workers), Ways(workers=workers, progress=show))
                self.seconds[workers] = time.perf_counter() - start

    @property
    def efficiency(self) -> float:
        """1 if all cores do nothing but run."""
        return self.seconds[1] / self.seconds[self.cores] / self.cores

    def table(self) -> None:
        """Seconds of both."""
        print(f"\n{f'sweep of {RUNS} runs':28}{'s':>10}{'ms/run':>10}")
        for workers, seconds in self.seconds.items():
            print(f"{f'{workers} at a time':28}{seconds:10.1f}{seconds / RUNS * 1e3:10.1f}")
