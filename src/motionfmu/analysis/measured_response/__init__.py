"""Frequency responses of a measured axis, and the two masses that they show."""

from types import ModuleType
from typing import TYPE_CHECKING

from motionfmu.base.extras import at_first_use

if TYPE_CHECKING:
    from motionfmu.analysis.measured_response.plant_response import FoundResponse, found_response
    from motionfmu.analysis.measured_response.record_response import (
        ResponseOptions,
        identify_response,
    )
    from motionfmu.analysis.measured_response.response_estimate import (
        EstimateOptions,
        LoopSignals,
        MeasuredResponse,
        estimate,
        together,
    )
    from motionfmu.analysis.measured_response.two_masses import MassFit, MassModel, fit_masses

__all__ = [
    "EstimateOptions",
    "FoundResponse",
    "LoopSignals",
    "MassFit",
    "MassModel",
    "MeasuredResponse",
    "ResponseOptions",
    "estimate",
    "fit_masses",
    "found_response",
    "identify_response",
    "together",
]


def _modules() -> tuple[ModuleType, ...]:
    """Where the names are."""
    from motionfmu.analysis.measured_response import (
        plant_response,
        record_response,
        response_estimate,
        two_masses,
    )

    return response_estimate, two_masses, plant_response, record_response


__getattr__ = at_first_use(__name__, __all__, _modules)


def __dir__() -> list[str]:
    """Names of `__all__`, though they are not imported yet."""
    return __all__
