"""How a scenario runs, and what a run gave."""

from motionfmu.run.machine_program import Machine, machine
from motionfmu.run.record_analyses import record_contour, record_iso9283
from motionfmu.run.record_matches import RecordMatches
from motionfmu.run.result import Result
from motionfmu.run.run_plan import Options
from motionfmu.run.runner import Scenario, load, scenario
from motionfmu.run.session import Session

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
