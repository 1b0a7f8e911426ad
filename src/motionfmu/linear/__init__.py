"""Linear models of scenarios: the same equations, laws and delays as the running FMUs."""

from motionfmu.linear.axis import AxisModel, model
from motionfmu.linear.loops import Limit, feedbacks, largest_gain
from motionfmu.linear.margins import Margins, margins
from motionfmu.linear.position_gain import LoopGain, gain_of, kp_of

__all__ = [
    "AxisModel",
    "Limit",
    "LoopGain",
    "Margins",
    "feedbacks",
    "gain_of",
    "kp_of",
    "largest_gain",
    "margins",
    "model",
]
