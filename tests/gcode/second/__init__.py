"""A second reading of part programs, from the standard's text; it shares no code with the first."""

from second.run import run
from second.state import Options, Refused, Step

__all__ = ["Options", "Refused", "Step", "run"]
