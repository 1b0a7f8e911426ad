"""Scopes that record what runs in an engine without a recorder of its own."""

from dataclasses import replace

from motionfmu.base.columns import Columns
from motionfmu.base.errors import InputError
from motionfmu.run.engines.engine_job import EngineJob
from motionfmu.scenarios import recording
from motionfmu.scenarios.system import System


class ScopeSystem:
    """A job's system with scopes."""

    def __init__(self, job: EngineJob) -> None:
        self.system, self._traces = recording.plan(job.system, job.recorded, job.folder)
        if told := recording.refused(self.system)[1]:
            raise InputError(f"{told} in an engine that records in memory")
        self._own = self.system.settings[len(job.system.settings) :]

    def of(self, system: System) -> System:
        """The same with the values of another system."""
        return replace(
            system,
            components=self.system.components,
            wires=self.system.wires,
            settings=(*system.settings, *self._own),
        )

    def signals(self) -> Columns:
        """What they have recorded, by name; their files are moved away."""
        return self._traces.load()
