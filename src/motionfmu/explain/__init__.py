"""Contour error and tool path explained: causes by simulation and theory, a ballbar in words."""

# ruff: noqa: E402
from motionfmu.extras import needed

needed("report")

from motionfmu.explain.ballbar import Signature, signature
from motionfmu.explain.decompose import Explanation, explain
from motionfmu.explain.path_causes import PathExplanation, explain_path

__all__ = [
    "Explanation",
    "PathExplanation",
    "Signature",
    "explain",
    "explain_path",
    "signature",
]
