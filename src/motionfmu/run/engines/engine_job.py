"""What an engine is given to run, and what it tells of it."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from motionfmu.base.columns import Columns
from motionfmu.scenarios.system import End, System

Progress = Callable[[float], None]


@dataclass(frozen=True)
class EngineJob:
    """What one run or many are made of; runs differ in values only."""

    system: System
    recorded: tuple[End, ...]
    folder: Path  # for the files of the signals; the run's own
    fmi: int  # 2 or 3
    name: str = "system"  # for messages of what is wrong with the whole


@dataclass(frozen=True)
class EngineResult:
    """What an engine tells of a run."""

    engine: str  # its name
    signals: Columns  # a row a sample
    warnings: list[str]  # of the FMUs
    steps: int  # done
    signal: int | None = None  # communication point at which the signal that ends it came


class Engine(Protocol):
    """A system that is ready to run, once or many times."""

    def run(self, system: System, progress: Progress) -> EngineResult:
        """Run from the start a system that differs from the job's in values only."""

    def close(self) -> None:
        """Free what it holds."""
