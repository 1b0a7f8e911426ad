"""From a measured record of an axis to the parameters of its plant."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from motionfmu.identify.axis_record import AxisRecord
    from motionfmu.identify.confidence_region import ConfidenceRegion, read_region, region_of
    from motionfmu.identify.ground import IdentifyOptions
    from motionfmu.identify.identification import Identified, identify
    from motionfmu.identify.record_run import RecordRun, run_of_record
    from motionfmu.identify.recorded_loop import ColumnUse

__all__ = [
    "AxisRecord",
    "ColumnUse",
    "ConfidenceRegion",
    "Identified",
    "IdentifyOptions",
    "RecordRun",
    "identify",
    "read_region",
    "region_of",
    "run_of_record",
]


def __getattr__(name: str) -> Any:
    """Import what identifies when it is first used, as it needs the extra `tune`."""
    if name not in __all__:
        raise AttributeError(f"module 'motionfmu.identify' has no attribute {name!r}")
    from motionfmu.base.extras import needed

    needed("tune")
    from motionfmu.identify import (
        axis_record,
        confidence_region,
        ground,
        identification,
        record_run,
        recorded_loop,
    )

    places = (axis_record, confidence_region, ground, identification, record_run, recorded_loop)
    return next(getattr(place, name) for place in places if hasattr(place, name))


def __dir__() -> list[str]:
    """Names of `__all__`, though they are not imported yet."""
    return __all__
