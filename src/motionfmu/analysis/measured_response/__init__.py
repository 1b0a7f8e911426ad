"""Frequency responses of a measured axis, and the two masses that they show."""

from typing import TYPE_CHECKING, Any

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


def __getattr__(name: str) -> Any:
    """Import what finds them when it is first used, as it needs the extra `tune`."""
    if name not in __all__:
        raise AttributeError(f"module 'motionfmu.analysis.measured_response' has no {name!r}")
    from motionfmu.base.extras import needed

    needed("tune")
    from motionfmu.analysis.measured_response import (
        plant_response,
        record_response,
        response_estimate,
        two_masses,
    )

    places = (response_estimate, two_masses, plant_response, record_response)
    return next(getattr(place, name) for place in places if hasattr(place, name))


def __dir__() -> list[str]:
    """Names of `__all__`, though they are not imported yet."""
    return __all__
