"""Processor time of the commands that one gives all day."""

import os
import resource
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from medians import Medians

ROOT = Path(__file__).resolve().parents[2]
DEMO = ROOT / "scenarios/circle"
# Line and what is asked of it [s of processor time].
COMMANDS = (
    ("--help", 0.06),
    ("list", 0.1),
    ("info mcc", 0.12),
    ("info scenarios/circle", 0.12),
    ("run scenarios/circle", 0.5),
    ("margins scenarios/circle", 1.5),
    ("tune scenarios/circle", 1.2),
    ("tune scenarios/circle --velocity", 8.0),
)
ENOUGH = 20.0  # [s] of one command, after two runs of it
WRITES = ("run", "margins", "tune")

_FOLDER = tempfile.TemporaryDirectory(prefix="motionfmu-")


def environment() -> dict[str, str]:
    """Modules are compiled once, as where it is installed, whatever this environment says."""
    kept = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    return kept | {"PYTHONPYCACHEPREFIX": f"{_FOLDER.name}/bytes", "PYTHONHASHSEED": "0"}


def taken(line: Sequence[str | Path], **more: str) -> float:
    """Processor time of a process and of those it has started [s]."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    env = environment() | more
    subprocess.run(line, check=True, stdout=subprocess.DEVNULL, env=env, cwd=ROOT)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


class Command:
    """One command: processor time of its process [s]."""

    def __init__(self, line: str, asked: float) -> None:
        self.line, self.asked, self.taken, self._rounds = line, asked, 0.0, Medians()
        out = ["--out", f"{_FOLDER.name}/out"] if line.startswith(WRITES) else []
        self.whole = [sys.executable, "-m", "motionfmu", *line.split(), *out]

    def __call__(self) -> None:
        if self.taken == 0.0:  # what is made once is there
            taken(self.whole)
        if self.taken < ENOUGH:
            seconds = taken(self.whole)
            self.taken += seconds
            self._rounds.add("command", seconds)

    @property
    def seconds(self) -> float:
        return self._rounds["command"]


class NewStructure:
    """A hundred steps of the demo with an empty cache, and with its program in it, in turns."""

    LINE = (sys.executable, Path(__file__).with_name("one_run.py"), DEMO, "fused", "3", "100")

    def __init__(self) -> None:
        self._rounds = Medians()

    def __call__(self) -> None:
        with tempfile.TemporaryDirectory(prefix="motionfmu-") as cache:
            for which in ("empty", "warm"):
                self._rounds.add(which, taken(self.LINE, MOTIONFMU_CACHE=cache))

    @property
    def seconds(self) -> float:
        """What an empty cache costs [s]."""
        return self._rounds["empty"] - self._rounds["warm"]


def all_commands() -> list[Command]:
    """Each of `COMMANDS`."""
    return [Command(line, asked) for line, asked in COMMANDS]
