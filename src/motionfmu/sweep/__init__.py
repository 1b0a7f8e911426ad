"""Studies: one scenario run at many points, on all cores or a cluster."""

# ruff: noqa: E402
from motionfmu.base.extras import needed

needed("study")

from motionfmu.study.study_definition import Study, study
from motionfmu.study.study_outcome import Outcome, Ways
from motionfmu.sweep.conduct import conduct

__all__ = ["Outcome", "Study", "Ways", "conduct", "study"]
