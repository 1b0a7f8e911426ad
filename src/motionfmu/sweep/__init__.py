"""Studies: one scenario run at many points, on all cores or a cluster."""

# ruff: noqa: E402
from motionfmu.base.extras import needed

needed("study")

from motionfmu.study.outcome import Outcome, Ways
from motionfmu.study.study import Study, study
from motionfmu.sweep.conduct import conduct

__all__ = ["Outcome", "Study", "Ways", "conduct", "study"]
