"""Motion controllers as FMI co-simulation FMUs, run under FMPy."""

from typing import TYPE_CHECKING, Any

from motionfmu.errors import InputError

if TYPE_CHECKING:
    from motionfmu.run import Result, Scenario, load, scenario

__all__ = ["InputError", "Result", "Scenario", "load", "scenario"]


def __getattr__(name: str) -> Any:
    """Import the runner when it is first used; the build needs descriptions only."""
    if name in __all__:
        from motionfmu import run

        return getattr(run, name)
    raise AttributeError(f"module 'motionfmu' has no attribute {name!r}")


def __dir__() -> list[str]:
    """Names of `__all__`, though the runner is not imported yet."""
    return __all__
