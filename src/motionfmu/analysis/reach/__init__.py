"""Where an arm reaches with an attitude of its tool, by which branches, how far from singular."""

from motionfmu.analysis.reach.reach_slice import ReachSlice, least_singular, reach_slice

__all__ = ["ReachSlice", "least_singular", "reach_slice"]
