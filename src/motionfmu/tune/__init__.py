"""Servo gains for a scenario's own path: NLP, global check, FMU verification."""

from motionfmu.tune.problem import Problem, problem, read
from motionfmu.tune.result import Tuned, tune
from motionfmu.tune.solve import RanAway

__all__ = ["Problem", "RanAway", "Tuned", "problem", "read", "tune"]
