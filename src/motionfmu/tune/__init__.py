"""Servo gains for a scenario's own path: NLP, global check, FMU verification."""

# ruff: noqa: E402
from motionfmu.extras import needed

needed("tune")

from motionfmu.tune.problem import Problem, problem, read
from motionfmu.tune.result import Tuned
from motionfmu.tune.solve import RanAway
from motionfmu.tune.tuning import tune

__all__ = ["Problem", "RanAway", "Tuned", "problem", "read", "tune"]
