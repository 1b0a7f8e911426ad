"""The report's part that shows an object, which the object itself cannot import."""

from importlib import import_module
from typing import Any

from motionfmu.base.extras import needed


def report(module: str) -> Any:
    """A module of the report, imported when something is first shown."""
    return import_module(f"motionfmu.report.{module}")


def drawn(module: str) -> Any:
    """A module of the report that draws pictures, which needs an extra."""
    needed("report")
    return report(module)
