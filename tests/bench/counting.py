"""Instructions of a process: they stand on a busy machine, too, where times do not."""

import functools
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import commands

RUN, PLANS = (Path(__file__).parent / name for name in ("one_run.py", "plans.py"))
_MARKED = {RUN, PLANS}  # programs that say what of them is to be counted
MARKS = Path(__file__).resolve().parents[2] / "build/tests/bench/count_here.so"
_PERF = ("perf", "stat", "-x,", "-e", "instructions:u", "-o")
_VALGRIND = ("valgrind", "--trace-children=yes", "--tool=cachegrind", "--cache-sim=no")
_HERE = ("valgrind", "--tool=callgrind", "--instr-atstart=no", "--callgrind-out-file=/dev/null")
# A short and a long run of a loop; their difference is the loop's alone. Both report progress
# equally often, which a run of fewer steps does not: a report costs as much as two steps.
STEPS = (5000, 9000)
SLOW = 4.0  # [s]


@functools.cache
def method() -> str | None:
    """What counts here: the processor itself, else valgrind, else nothing."""
    for name, count in (("perf", _perf), ("valgrind", _valgrind)):
        try:
            count(["true"])
        except (OSError, ValueError, subprocess.CalledProcessError):
            continue
        return name
    return None


def _run(line: Sequence[str | Path], **more: str) -> str:
    done = subprocess.run(
        line,
        check=True,
        env=commands.environment() | more,
        stdout=subprocess.DEVNULL,
        stderr=-1,
        text=True,
    )
    return str(done.stderr)


def _perf(line: Sequence[str | Path]) -> int:
    with tempfile.NamedTemporaryFile("r") as told:
        _run([*_PERF, told.name, *line])
        return int(told.read().splitlines()[-1].partition(",")[0])


def _valgrind(line: Sequence[str | Path]) -> int:
    told = _run([*_VALGRIND, "--cachegrind-out-file=/dev/null", *line])
    if not (found := re.findall(r"I +refs: +([\d,]+)", told)):
        raise ValueError("valgrind tells no count")
    return sum(int(n.replace(",", "")) for n in found)


def instructions(line: Sequence[str | Path]) -> float:
    """Instructions in user mode of a command; NaN if the machine counts none."""
    which = method()
    return float("nan") if which is None else (_perf if which == "perf" else _valgrind)(line)


def share(told: str) -> float:
    """The share of its work that a program has counted."""
    found = re.search(r"^counted share ([\d.]+)$", told, re.MULTILINE)
    if not found:
        raise ValueError("the program tells no share")
    return float(found[1])


def _inside(line: Sequence[str | Path], shares: set[float]) -> float:
    """Instructions of a program's loop alone: what is around it differs by millions.

    The share of the loop that was seen is added to `shares`.
    """
    if method() != "valgrind":
        return instructions(line)
    told = _run([*_HERE, *line], COUNT_HERE=str(MARKS))
    count = re.search(r"Collected : (\d+)", told)
    if not count:
        raise ValueError("valgrind tells no count")
    shares.add(share(told))
    return int(count[1]) / share(told)


class Loop:
    """Instructions of one step of a loop: a longer run less a shorter one.

    `line` makes the command of a run from its number of steps.
    """

    def __init__(self, name: str, line: Sequence[str | Path], steps: Sequence[int] = STEPS) -> None:
        self.name, self.line, self.steps = name, line, steps
        self.count = float("nan")

    def __call__(self) -> None:
        if method() is None:
            return
        lines = [[str(a).format(n) for a in self.line] for n in self.steps]
        _run(lines[0])  # what is made once is there
        shares: set[float] = set()
        short, long = (
            _inside(line, shares) if _MARKED & set(self.line) else instructions(line)
            for line in lines
        )
        if len(shares) > 1:
            raise ValueError(f"{self.name}: {self.steps} steps report progress unequally often")
        self.count = (long - short) / (self.steps[1] - self.steps[0])


def of_run(scenario: Path, engine: str, fmi: int = 3) -> list[str | Path]:
    """A command that runs a scenario of so many steps; nothing is written."""
    return [sys.executable, RUN, scenario, engine, str(fmi), "{}"]


def count(loops: Sequence[Loop], slow: Sequence[Loop]) -> dict[str, Loop]:
    """Count all, as many at once as there are cores; valgrind none that are slow."""
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(lambda loop: loop(), [*loops, *(slow if method() == "perf" else [])]))
    return {loop.name: loop for loop in [*loops, *slow]}


def of_commands(asked: Sequence[commands.Command]) -> list[tuple[commands.Command, float]]:
    """Instructions of each command; valgrind is too slow for those that take long."""
    few = [c for c in asked if method() == "perf" or c.seconds < SLOW]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(zip(few, pool.map(lambda c: instructions(c.whole), few), strict=True))
