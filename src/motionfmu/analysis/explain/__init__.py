"""Contour error and tool path explained: causes by simulation and theory, a ballbar in words."""

# ruff: noqa: E402
from motionfmu.base.extras import needed

needed("report")

from motionfmu.analysis.explain.ballbar import Signature, signature
from motionfmu.analysis.explain.decompose import Explanation, explain
from motionfmu.analysis.explain.path_causes import PathExplanation, explain_path

__all__ = [
    "Explanation",
    "PathExplanation",
    "Signature",
    "explain",
    "explain_path",
    "signature",
]
