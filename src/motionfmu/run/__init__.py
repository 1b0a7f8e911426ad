"""How a scenario runs, and what a run gave."""

from motionfmu.run.machine_program import Machine, machine
from motionfmu.run.result import Result
from motionfmu.run.run_plan import Options
from motionfmu.run.runner import Scenario, load, scenario
from motionfmu.run.session import Session

__all__ = [
    "Machine",
    "Options",
    "Result",
    "Scenario",
    "Session",
    "load",
    "machine",
    "scenario",
]
