"""One scenario that is made ready once and run many times."""

from collections.abc import Iterable, Mapping
from dataclasses import fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionfmu.base import columns
from motionfmu.base.errors import InputError, suggestion
from motionfmu.run import engines
from motionfmu.run.controller_plan import bounded
from motionfmu.run.engines.engine_job import Engine, EngineResult
from motionfmu.run.execution import HELD_IN_SESSION, Execution, own_settings
from motionfmu.run.result import Result
from motionfmu.run.run_plan import Options, RunPlan
from motionfmu.scenarios.system import End, Setting, System
from motionfmu.scenarios.values import settings, start_values

if TYPE_CHECKING:
    from motionfmu.analysis.contour.pulse_path import PulsePaths


class Session:
    """A scenario loaded once, to be run with many values.

    It is wired and loaded once, as a program or in another engine's way. A run gives the same bits
    as `Scenario.run`. Use it as a context manager, or call `close`.

    Parameters
    ----------
    scenario : Scenario
    varied : iterable of str
        Names of the parameters and inputs that runs may set, ``component.variable`` or
        ``component.variable[i]``.
    signals : iterable of End, optional
        Outputs to record; the scenario's own if none are given.
    **options : engine, fmi, set, stop, step
        For all runs; see `Options`.

    Raises
    ------
    InputError
        A name or an option is wrong.
    """

    def __init__(
        self,
        scenario: RunPlan,
        varied: Iterable[str],
        signals: Iterable[End] | None = None,
        **options: Any,
    ) -> None:
        known = [f.name for f in fields(Options)]
        if unknown := [n for n in options if n not in known]:
            raise InputError(f"no option {unknown[0]!r}{suggestion(unknown[0], known)}")
        asked = Options(**options)
        self.scenario = scenario
        self._options = replace(asked, engine=engines.named(asked.engine))
        self._temporary = columns.temporary(self._options.scratch)
        try:
            self._folder = Path(self._temporary.name)
            self._engine = self._prepare(varied, signals)
        except BaseException:
            self._temporary.cleanup()
            raise

    def _prepare(self, varied: Iterable[str], signals: Iterable[End] | None) -> Engine:
        scenario, resolver = self.scenario, self.scenario.resolver
        varied = [varied] if isinstance(varied, str) else list(varied)
        self._varied = {resolver.split(n)[0] for n in varied}
        self._given = {**self._options.set, **own_settings(scenario, self._folder)}
        ends = [resolver.end(resolver.split(n)[0], "set", n) for n in varied]
        usual = {e.name: start_values(e.port) for e in ends}
        written = scenario.document.body.set
        there = {resolver.split(n)[0] for n in (*written, *self._given)}
        self._unset = {n: v for n, v in usual.items() if n not in there}
        base = bounded(scenario, replace(self._options, set={**self._unset, **self._given}))
        self._known = _known(scenario)
        used = scenario.ends if signals is None else list(signals)
        self._execution = Execution.plan(scenario, base, used, self._folder)
        return engines.opened(
            self._options.engine, self._execution.job(self._options.fmi, HELD_IN_SESSION)
        )

    def _values(self, given: Mapping[str, Any]) -> list[Setting]:
        """All settings of a run; a value for one element leaves the others as they are."""
        return settings(self.scenario.resolver, self._unset, self._given, given)

    def run(self, given: Mapping[str, Any]) -> Result:
        """Run once.

        Parameters
        ----------
        given : mapping
            Value by name; names among those of the constructor.

        Raises
        ------
        InputError
            A value is wrong, or an FMU refused something; one message.
        """
        if unknown := [n for n in given if self.scenario.resolver.split(n)[0] not in self._varied]:
            hint = suggestion(unknown[0], self._varied)
            raise InputError(f"{unknown[0]} is not varied by this session{hint}")
        execution = replace(
            self._execution,
            system=replace(self._execution.system, settings=tuple(self._values(given))),
        )
        options = replace(self._options, set=given)
        self.scenario.check_scopes(execution.system, options)

        def engine(system: System) -> EngineResult:
            return replace(self._engine.run(system, self._options.progress), warnings=[])

        result = execution.run(engine, replace(self._options, set={**self._options.set, **given}))
        result.known = self._known
        return result

    def __repr__(self) -> str:
        return f"<Session {self.scenario.name}: varies {', '.join(sorted(self._varied))}>"

    def close(self) -> None:
        """Free the FMUs and their files."""
        try:
            self._engine.close()
        finally:
            self._temporary.cleanup()

    def __enter__(self) -> "Session":
        return self

    def __exit__(self, *error: object) -> None:
        self.close()


def _known(scenario: RunPlan) -> "PulsePaths | None":
    """A store of what contours of several runs have in common; None without a contour."""
    if scenario.document.body.contour is None:
        return None
    from motionfmu.analysis.contour.pulse_path import PulsePaths

    return PulsePaths()
