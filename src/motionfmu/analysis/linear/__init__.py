"""Linear models of scenarios: the same equations, laws and delays as the running FMUs."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from motionfmu.analysis.linear.axis import AxisModel, model
    from motionfmu.analysis.linear.gains import LoopGain, gain_of
    from motionfmu.analysis.linear.loops import Limit, feedbacks, largest_gain
    from motionfmu.analysis.linear.position_gain import kp_of
    from motionfmu.analysis.linear.stability import Margins, margins

__all__ = [
    "AxisModel",
    "Limit",
    "LoopGain",
    "Margins",
    "feedbacks",
    "gain_of",
    "kp_of",
    "largest_gain",
    "margins",
    "model",
]


def __getattr__(name: str) -> Any:
    """Import what makes models when it is first used: gains are mostly kept from before."""
    if name not in __all__:
        raise AttributeError(f"module 'motionfmu.analysis.linear' has no attribute {name!r}")
    if name in ("LoopGain", "gain_of"):
        from motionfmu.analysis.linear import gains

        return getattr(gains, name)
    from motionfmu.base.extras import needed

    needed("tune")
    from motionfmu.analysis.linear import axis, loops, position_gain, stability

    places = (axis, loops, position_gain, stability)
    return next(getattr(place, name) for place in places if hasattr(place, name))


def __dir__() -> list[str]:
    """Names of `__all__`, though they are not imported yet."""
    return __all__
