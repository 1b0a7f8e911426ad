"""Motion controllers as FMI co-simulation FMUs, run under FMPy.

>>> import motionfmu
>>> result = motionfmu.load("scenarios/circle").run()  # doctest: +SKIP
>>> result.plot("mcc.path_feed")  # doctest: +SKIP
>>> result = motionfmu.machine("mill3").run("part.ngc")  # doctest: +SKIP
>>> trace = motionfmu.record("trace.csv")  # doctest: +SKIP

The library and the card without FMUs are in `motionfmu.virtual.mcc`, the robot in
`motionfmu.virtual.robot`, part programs in `motionfmu.analysis.gcode`, linear models in
`motionfmu.analysis.linear`.
"""

# Nothing is imported here: the console command stands behind this file, and what takes time before
# it would end Ctrl-C in a traceback.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from motionfmu.base.errors import InputError
    from motionfmu.live import connect
    from motionfmu.records import Record, record
    from motionfmu.run import Machine, Result, Scenario, load, machine, scenario

    __version__: str

__all__ = [
    "InputError",
    "Machine",
    "Record",
    "Result",
    "Scenario",
    "connect",
    "load",
    "machine",
    "record",
    "scenario",
]


def __getattr__(name: str) -> "Any":
    """Import the runner, or a folder, when it is first used; the build needs descriptions only."""
    if name == "__version__":
        from motionfmu.base.project_version import version

        return version()
    if name == "InputError":
        from motionfmu.base.errors import InputError

        return InputError
    if name in ("Record", "record"):
        from motionfmu import records

        return getattr(records, name)
    if name == "connect":
        from motionfmu.live.live_client import connect

        return connect
    if name in __all__:
        from motionfmu import run

        return getattr(run, name)
    if name in _folders():
        import importlib

        return importlib.import_module(f"motionfmu.{name}")
    raise AttributeError(f"module 'motionfmu' has no attribute {name!r}")


def _folders() -> list[str]:
    import pkgutil

    return [module.name for module in pkgutil.iter_modules(__path__) if module.ispkg]


def __dir__() -> list[str]:
    """Names of `__all__` and of the folders, though they are not imported yet."""
    return [*__all__, *_folders()]
