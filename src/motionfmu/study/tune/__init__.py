"""Servo gains for a scenario's own path: NLP, global check, FMU verification."""

# ruff: noqa: E402
from motionfmu.base.extras import needed

needed("tune")

from motionfmu.study.tune.problem import Problem, problem, read
from motionfmu.study.tune.solve import RanAway
from motionfmu.study.tune.tuning import tune
from motionfmu.study.tune.tuning_result import Tuned

__all__ = ["Problem", "RanAway", "Tuned", "problem", "read", "tune"]
