"""One run laid over another: signals, contour, verdicts, what was run differently; or a record."""

from motionfmu.compare.comparison import Comparison, compare
from motionfmu.compare.record_comparison import RecordComparison, compare_record

__all__ = ["Comparison", "RecordComparison", "compare", "compare_record"]
