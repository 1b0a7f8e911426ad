"""Where an arm reaches with its tool turned one way, by which branches, how far from singular."""

from motionfmu.analysis.reach.reach_slice import ReachSlice, least_singular, reach_slice

__all__ = ["ReachSlice", "least_singular", "reach_slice"]
