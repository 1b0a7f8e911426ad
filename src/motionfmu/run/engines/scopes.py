"""Scope FMUs that record the signals of a run in an engine without a recorder of its own."""

from dataclasses import replace

from motionfmu.base.columns import Columns
from motionfmu.base.errors import InputError
from motionfmu.run.engines.engine_job import EngineJob
from motionfmu.scenarios import recording
from motionfmu.scenarios.system import System


class ScopeSystem:
    """A job's system with scopes added to it."""

    def __init__(self, job: EngineJob) -> None:
        self.system, self._traces = recording.plan(job.system, job.recorded, job.folder)
        if told := recording.refused(self.system)[1]:
            raise InputError(f"{told} in an engine that records in memory")
        self._own = self.system.settings[len(job.system.settings) :]

    def of(self, system: System) -> System:
        """The system with scopes and with the values of another system."""
        return replace(
            system,
            components=self.system.components,
            wires=self.system.wires,
            settings=(*system.settings, *self._own),
        )

    def signals(self) -> Columns:
        """The recorded signals by name; the scopes' files are moved away."""
        return self._traces.load()
