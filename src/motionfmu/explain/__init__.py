"""Contour error explained: its causes by simulation and by theory, a ballbar's words."""

from motionfmu.explain.ballbar import Signature, signature
from motionfmu.explain.decompose import Explanation, explain

__all__ = ["Explanation", "Signature", "explain", "signature"]
