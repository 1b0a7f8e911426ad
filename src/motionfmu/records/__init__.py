"""Signals over time, measured or simulated: read from files, resampled, laid over one another."""

from motionfmu.records.layout import Layout
from motionfmu.records.match import Lag, Match, lag_of, match
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
