"""How well one axis positions: bidirectional tests after ISO 230-2, and answers to a step."""

from motionfmu.analysis.positioning.bidirectional import PositioningTest
from motionfmu.analysis.positioning.step_response import StepFigures, step_figures

__all__ = ["PositioningTest", "StepFigures", "step_figures"]
