"""Contour error and tool path explained: causes by simulation and theory, a ballbar in words."""

# ruff: noqa: E402
from motionfmu.base.extras import needed

needed("report")

from motionfmu.analysis.explain.ballbar import Signature, signature
from motionfmu.analysis.explain.ballbar_record import BallbarRecord, ballbar_of, ballbar_test
from motionfmu.analysis.explain.decompose import Explanation, explain
from motionfmu.analysis.explain.path_causes import PathExplanation, explain_path

__all__ = [
    "BallbarRecord",
    "Explanation",
    "PathExplanation",
    "Signature",
    "ballbar_of",
    "ballbar_test",
    "explain",
    "explain_path",
    "signature",
]
