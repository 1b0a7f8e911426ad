"""From a measured record of an axis to the parameters of its plant."""

from types import ModuleType
from typing import TYPE_CHECKING

from motionfmu.base.extras import at_first_use

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


def _modules() -> tuple[ModuleType, ...]:
    """Where the names are."""
    from motionfmu.identify import (
        axis_record,
        confidence_region,
        ground,
        identification,
        record_run,
        recorded_loop,
    )

    return axis_record, confidence_region, ground, identification, record_run, recorded_loop


__getattr__ = at_first_use(__name__, __all__, _modules)


def __dir__() -> list[str]:
    """Names of `__all__`, though they are not imported yet."""
    return __all__
