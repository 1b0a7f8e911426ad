"""Signals over time, measured or simulated: read from files, resampled, laid over one another."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from motionfmu.records.layout import Layout
    from motionfmu.records.matching import Lag, Match, lag_of, match
    from motionfmu.records.readers import SUFFIXES, is_record_file, record
    from motionfmu.records.resampling import ResamplingError
    from motionfmu.records.signal_record import Record

__all__ = [
    "SUFFIXES",
    "Lag",
    "Layout",
    "Match",
    "Record",
    "ResamplingError",
    "is_record_file",
    "lag_of",
    "match",
    "record",
]


def __getattr__(name: str) -> Any:
    """Import what has a name when it is first used: most runs have no record."""
    if name not in __all__:
        raise AttributeError(f"module 'motionfmu.records' has no attribute {name!r}")
    from motionfmu.records import layout, matching, readers, resampling, signal_record

    places = (signal_record, readers, matching, layout, resampling)
    return next(getattr(place, name) for place in places if hasattr(place, name))


def __dir__() -> list[str]:
    """Names of `__all__`, though some are not imported yet, and what is there."""
    return sorted({*globals(), *__all__})
