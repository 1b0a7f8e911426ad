"""One run laid over another: signals, contour, verdicts, and what was run differently."""

from motionfmu.compare.comparison import Comparison, compare

__all__ = ["Comparison", "compare"]
