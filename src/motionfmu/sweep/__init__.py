"""Studies: one scenario run at many points, on all cores or a cluster."""

from motionfmu.sweep.conduct import Outcome, Ways, conduct
from motionfmu.sweep.study import Study, study

__all__ = ["Outcome", "Study", "Ways", "conduct", "study"]
