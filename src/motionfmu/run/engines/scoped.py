"""Scopes that record what runs in an engine without a recorder of its own."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from numpy.typing import NDArray

from motionfmu.run.engines.job import Job
from motionfmu.scenarios import recording
from motionfmu.scenarios.system import System


class Scoped:
    """A job's system with scopes."""

    def __init__(self, job: Job) -> None:
        self.system, self._traces = recording.plan(job.system, job.recorded, job.folder)
        self._own = self.system.settings[len(job.system.settings) :]

    def of(self, system: System) -> System:
        """The same with the values of another system."""
        return replace(
            system,
            components=self.system.components,
            wires=self.system.wires,
            settings=(*system.settings, *self._own),
        )

    def signals(self) -> Mapping[str, NDArray[Any]]:
        """What they have recorded, by name."""
        return self._traces.load()
