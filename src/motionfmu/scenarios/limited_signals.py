"""Outputs of a controller that tell, while it moves, what keeps its program from being faster."""

from motionfmu.scenarios.system import Resolver

BY, AXIS, FEED, SPEED, LINE, PLACE = (
    "limited_by",
    "limited_axis",
    "programmed_feed",
    "path_feed",
    "line",
    "tool_position",
)


def controller(resolver: Resolver) -> str | None:
    """The first component that has these outputs."""
    names = {BY, AXIS, FEED, SPEED, LINE, PLACE}
    return next((name for name, ports in resolver.ports.items() if names <= ports.keys()), None)


def wanted(resolver: Resolver) -> list[str]:
    """Outputs that are recorded unasked if the machine says its axes."""
    name = controller(resolver) if resolver.document.body.axis else None
    return [f"{name}.{v}" for v in (BY, AXIS, FEED, SPEED, LINE, PLACE)] if name else []
