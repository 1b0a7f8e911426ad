"""Processor time of the commands that one gives all day."""

import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import motionfmu.study.tune

ROOT = Path(__file__).resolve().parents[2]
DEMO = ROOT / "scenarios/circle"
# Line and what is asked of it [s of processor time].
COMMANDS = (
    ("--help", 0.3),
    ("list", 0.3),
    ("info mcc", 0.3),
    ("info scenarios/circle", 0.3),
    ("run scenarios/circle", 1.2),
    ("tune scenarios/circle", 2.5),
    ("tune scenarios/circle --velocity", 8.0),
)
ENOUGH = 20.0  # [s] of one command, after two runs of it

_FOLDER = tempfile.TemporaryDirectory(prefix="motionfmu-")


def environment() -> dict[str, str]:
    """Modules are compiled once, as where it is installed, whatever this environment says."""
    kept = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    return kept | {"PYTHONPYCACHEPREFIX": f"{_FOLDER.name}/bytes", "PYTHONHASHSEED": "0"}


class Command:
    """One command: processor time of its process [s], the best of all rounds."""

    def __init__(self, line: str, asked: float) -> None:
        self.line, self.asked, self.seconds, self.taken = line, asked, float("inf"), 0.0
        out = ["--out", f"{_FOLDER.name}/out"] if line.startswith(("run", "tune")) else []
        self.whole = [sys.executable, "-m", "motionfmu", *line.split(), *out]

    def _run(self) -> float:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        env = environment()
        subprocess.run(self.whole, check=True, stdout=subprocess.DEVNULL, env=env, cwd=ROOT)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime

    def __call__(self) -> None:
        if self.taken == 0.0:  # what is made once is there
            self._run()
        if self.taken < ENOUGH:
            seconds = self._run()
            self.taken += seconds
            self.seconds = min(self.seconds, seconds)


class Session:
    """The demo tuned in a process that has its modules: processor time [s]."""

    def __init__(self) -> None:
        self.seconds = float("inf")

    def __call__(self) -> None:
        start = time.process_time()
        motionfmu.study.tune.tune(DEMO)
        self.seconds = min(self.seconds, time.process_time() - start)


def all_commands() -> list[Command]:
    """Each of `COMMANDS`."""
    return [Command(line, asked) for line, asked in COMMANDS]
