"""What a study on a cluster costs beside its runs: `make bench BENCH=--cluster`.

100,000 short runs go to 16 workers of a LocalCluster, on however few cores. So no wall time can
tell what is lost, and processor time does. Efficiency is the processor time of the same runs by one
worker without a cluster, over all that the study took: client, scheduler and workers.
"""

import os
import resource
import subprocess
import sys
import tempfile
import time
from contextlib import closing
from pathlib import Path
from typing import Any

from figures import Figure
from medians import Medians
from rich.console import Console
from rich.progress import Progress

from motionfmu.study.study_definition import Study
from motionfmu.study.worker import Worker
from motionfmu.sweep import Ways, conduct, study

SCENARIO = Path(__file__).resolve().parents[2] / "scenarios/circle_theory"
RUNS, WORKERS = 100_000, 16
STOP = 0.2  # [s] simulated: about 4 ms of a processor
ALONE = 1000  # of the runs, evenly drawn, which one worker does by itself, a round before and after
AXIS, GAINS = "machine.tau", [100, 200, 300, 400]
RESULTS = ["card.err_count.absmax", "machine.table_position[1].final"]
# What dask does all the time, whether there is work or not. Eight workers of a core do it eight
# times as often as one, so here it is done seldom.
SELDOM = {
    "distributed.worker.profile.enabled": False,
    "distributed.admin.tick.interval": "1s",
    "distributed.admin.system-monitor.interval": "10s",
}
TICK = os.sysconf("SC_CLK_TCK")


def _cpu(process: int) -> float:
    """Processor time of a process [s]."""
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / TICK


def _chosen(runs: int) -> Study:
    lags = {"from": 1e-3, "to": 0.05, "n": runs // len(GAINS)}
    axis = {AXIS: lags, "mcc.p_gain": GAINS}
    return study(SCENARIO, {"axis": axis, "results": RESULTS, "cost": RESULTS[0], "stop": STOP})


def _alone(worker: Worker, chosen: Study, rounds: Medians) -> None:
    """Processor time of a run by one worker [s]."""
    runs = range(0, len(chosen.points), max(len(chosen.points) // ALONE, 1))
    tasks = [(run, chosen.points[run]) for run in runs]
    start = time.process_time()
    worker.rows(tasks)
    rounds.add("run", (time.process_time() - start) / len(tasks))


def _conducted(chosen: Study, address: str) -> None:
    """The study on the cluster; its table must be whole, in order and without an error."""
    bar = Progress(transient=True, console=Console(stderr=True))
    with tempfile.TemporaryDirectory() as folder, bar:
        task = bar.add_task("runs on the cluster", total=len(chosen.points))
        ways = Ways(scheduler=address, progress=lambda n, _: bar.update(task, completed=n))
        found = conduct(chosen, Path(folder) / "out", ways)
        if [row.run for row in found.rows] != list(range(len(chosen.points))) or found.errors:
            sys.exit("cluster: the table is not whole")


def figures_of_a_cluster(runs: int = RUNS, workers: int = WORKERS) -> list[Figure]:
    """Run the study, and tell where the processor time went."""
    chosen, rounds = _chosen(runs), Medians()
    with closing(Worker(chosen.job)) as alone:
        for _ in range(3):
            _alone(alone, chosen, rounds)
        line = [sys.executable, __file__, str(workers)]
        here = subprocess.Popen(line, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        assert here.stdin and here.stdout
        address, *numbers = here.stdout.readline().split()
        processes = [here.pid, *map(int, numbers)]
        begun = [_cpu(process) for process in processes]
        client, wall = time.process_time(), time.perf_counter()
        _conducted(chosen, address)
        client, wall = time.process_time() - client, time.perf_counter() - wall
        ended = [_cpu(process) for process in processes]
        here.communicate("end\n")
        for _ in range(3):
            _alone(alone, chosen, rounds)
    scheduler, *own = [end - begin for begin, end in zip(begun, ended, strict=True)]
    useful = rounds["run"] * runs
    spent = {"client": client, "scheduler and nannies": scheduler, "workers": sum(own)}
    print(f"\n{f'{runs:,} runs, {workers} workers':34}{'processor s':>14}{'ms/run':>10}")
    rows: dict[str, float] = {"the runs by themselves": useful, **spent}
    rows["start of the cluster"] = sum(begun)
    for name, seconds in rows.items():
        print(f"{name:34}{seconds:14.1f}{seconds / runs * 1e3:10.3f}")
    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"wall {wall:.0f} s; peak of the client {most:.0f} MB")
    total = sum(spent.values())
    return [
        Figure(f"cluster, {runs:,} runs, efficiency", useful / total, least=0.9),
        Figure("the same with the cluster's own start", useful / (total + sum(begun))),
        Figure("the same, client and scheduler, ms a run", 1e3 * (client + scheduler) / runs),
        Figure("the same, peak of the client, MB", most, most=400.0),
    ]


def serve(workers: int) -> None:
    """A LocalCluster until a line comes; it prints its address and its workers' processes."""
    import dask
    import distributed

    given: Any = {"n_workers": workers, "threads_per_worker": 1, "dashboard_address": None}
    with (
        dask.config.set(SELDOM),
        distributed.LocalCluster(host="127.0.0.1", memory_limit=0, **given) as made,
    ):
        print(made.scheduler_address, *(one.pid for one in made.workers.values()), flush=True)
        sys.stdin.readline()


if __name__ == "__main__":
    serve(int(sys.argv[1]))
