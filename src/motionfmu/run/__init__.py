"""How a scenario runs, and what a run gave."""

from typing import TYPE_CHECKING, Any

from motionfmu.run.machine_program import Machine, machine
from motionfmu.run.record_matches import RecordMatches
from motionfmu.run.result import Result
from motionfmu.run.run_plan import Options
from motionfmu.run.runner import Scenario, load, scenario
from motionfmu.run.session import Session

if TYPE_CHECKING:
    from motionfmu.run.record_analyses import record_contour, record_iso9283

__all__ = [
    "Machine",
    "Options",
    "RecordMatches",
    "Result",
    "Scenario",
    "Session",
    "load",
    "machine",
    "record_contour",
    "record_iso9283",
    "scenario",
]


def __getattr__(name: str) -> Any:
    """Import the analyses of records when they are first used."""
    if name not in ("record_contour", "record_iso9283"):
        raise AttributeError(f"module 'motionfmu.run' has no attribute {name!r}")
    from motionfmu.run import record_analyses

    return getattr(record_analyses, name)


def __dir__() -> list[str]:
    """Names of `__all__`, though some are not imported yet, and what is there."""
    return [*{*__all__, *globals()}]
