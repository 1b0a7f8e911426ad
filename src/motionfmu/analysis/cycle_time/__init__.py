"""Where the time of a part program goes on a machine, and what it would take to make it shorter."""

from motionfmu.analysis.cycle_time.driven_motion import driven
from motionfmu.analysis.cycle_time.lifted import Lifted, what_if
from motionfmu.analysis.cycle_time.program_plan import (
    CAUSES,
    Block,
    CommandedMotion,
    Share,
    planned,
)

__all__ = ["CAUSES", "Block", "CommandedMotion", "Lifted", "Share", "driven", "planned", "what_if"]
