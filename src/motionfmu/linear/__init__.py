"""Linear models of scenarios: the same equations, laws and delays as the running FMUs."""

from motionfmu.linear.axis import AxisModel, model
from motionfmu.linear.loops import Limit, feedbacks, largest_gain
from motionfmu.linear.margins import Margins, margins

__all__ = ["AxisModel", "Limit", "Margins", "feedbacks", "largest_gain", "margins", "model"]
