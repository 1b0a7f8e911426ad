"""Gains of an arm's drives that keep limits in all its poses."""

# ruff: noqa: E402
from motionfmu.base.extras import needed

needed("tune")

from motionfmu.study.arm_gains.arm_tuning import (
    ArmTuned,
    ArmVerdict,
    JointGains,
    is_arm,
    tune_arm,
    verdict,
)

__all__ = ["ArmTuned", "ArmVerdict", "JointGains", "is_arm", "tune_arm", "verdict"]
