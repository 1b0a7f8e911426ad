"""Linear models of scenarios: the same equations, laws and delays as the running FMUs."""

from motionfmu.linear.axis import AxisModel, model

__all__ = ["AxisModel", "model"]
