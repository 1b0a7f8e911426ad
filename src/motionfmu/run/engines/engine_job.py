"""The job that an engine gets, and the result that it gives."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError
from motionfmu.scenarios.system import End, System

Progress = Callable[[float], None]


@dataclass(frozen=True)
class EngineJob:
    """What an engine makes ready for one run or many, which differ in values only."""

    system: System
    recorded: tuple[End, ...]
    folder: Path  # holds the files of the signals; no other run uses it
    fmi: int  # 2 or 3
    name: str = "system"  # names the whole system in messages
    memory: int = 0  # [byte] signals of a run that take no more need no files


@dataclass(frozen=True)
class EngineResult:
    """What an engine gives of a run: signals, warnings, and why it ended."""

    engine: str  # name of the engine
    signals: Mapping[str, NDArray[Any]]  # one row for each sample
    warnings: list[str]  # of the FMUs
    steps: int  # number of steps that were made
    signal: int | None = None  # communication point at which a signal that ends it came
    which: int = 0  # of the system's two: its number in `Until.signals`
    time: NDArray[np.float64] | None = None  # of the rows [s], if the engine recorded it


class Engine(Protocol):
    """A system that is ready to run, once or many times."""

    def run(self, system: System, progress: Progress) -> EngineResult:
        """Run a system, which differs from the job's in values only, from its start."""

    def close(self) -> None:
        """Free instances, libraries and files."""


@runtime_checkable
class SideBySide(Protocol):
    """An engine that runs several systems side by side, each with the bits it has alone."""

    def lanes(self, system: System) -> int:
        """How many at once."""

    def run_together(self, systems: Sequence[System]) -> list[EngineResult | InputError]:
        """Run systems that differ in values only; an error of one leaves the others whole."""
