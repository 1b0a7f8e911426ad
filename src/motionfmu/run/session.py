"""One scenario that is made ready once and run many times."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionfmu.base import columns
from motionfmu.base.errors import InputError, suggestion
from motionfmu.run import engines
from motionfmu.run.controller_plan import bounded
from motionfmu.run.engines.engine_job import Engine, EngineResult, SideBySide
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

    def _values(self, given: Mapping[str, Any], own: Mapping[str, Any]) -> list[Setting]:
        """All settings of a run; a value for one element leaves the others as they are."""
        return settings(self.scenario.resolver, self._unset, {**self._given, **own}, given)

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
        execution = self._execution_of(given, self._folder)

        def engine(system: System) -> EngineResult:
            return replace(self._engine.run(system, self._options.progress), warnings=[])

        return self._told(execution.run(engine, self._all(given)))

    @property
    def lanes(self) -> int:
        """How many runs `run_together` takes at once."""
        engine = self._engine
        return engine.lanes(self._execution.system) if isinstance(engine, SideBySide) else 1

    def run_together(self, given: Sequence[Mapping[str, Any]]) -> list[Result | InputError]:
        """Run several times, side by side where that is quicker.

        Parameters
        ----------
        given : sequence of mapping
            For each run what `run` takes; `lanes` of them at once.

        Returns
        -------
        list
            For each a result, with the bits of `run`, or the error that `run` would raise.
        """
        found: list[Result | InputError] = []
        lanes = self.lanes
        for first in range(0, len(given), lanes):
            some = given[first : first + lanes]
            found += self._side_by_side(some) if len(some) > 1 else [self._alone(*some)]
        return found

    def _alone(self, given: Mapping[str, Any]) -> Result | InputError:
        try:
            return self.run(given)
        except InputError as error:
            return error

    def _side_by_side(self, given: Sequence[Mapping[str, Any]]) -> list[Result | InputError]:
        found: list[Result | InputError | None] = [None] * len(given)
        planned: list[tuple[int, Execution]] = []
        for i, values in enumerate(given):
            folder = self._folder / str(i)  # of the path that each plans
            folder.mkdir(exist_ok=True)
            try:
                planned.append((i, self._execution_of(values, folder)))
            except InputError as error:
                found[i] = error
        for _, execution in planned:
            execution.clear()
        assert isinstance(self._engine, SideBySide), "else there is one lane"
        several = self._engine.run_together([execution.system for _, execution in planned])
        for (i, execution), ran in zip(planned, several, strict=True):
            options = self._all(given[i])
            if isinstance(ran, InputError):
                found[i] = execution.located(ran, options)
            else:
                found[i] = self._told(execution.result(replace(ran, warnings=[]), options))
        return [one for one in found if one is not None]

    def _execution_of(self, given: Mapping[str, Any], folder: Path) -> Execution:
        """The execution of a run with its files in a folder."""
        if unknown := [n for n in given if self.scenario.resolver.split(n)[0] not in self._varied]:
            hint = suggestion(unknown[0], self._varied)
            raise InputError(f"{unknown[0]} is not varied by this session{hint}")
        values = self._values(given, own_settings(self.scenario, folder))
        system = replace(self._execution.system, settings=tuple(values))
        self.scenario.check_scopes(system, replace(self._options, set=given))
        return replace(self._execution, system=system, folder=folder)

    def _all(self, given: Mapping[str, Any]) -> Options:
        return replace(self._options, set={**self._options.set, **given})

    def _told(self, result: Result) -> Result:
        """The result, with what it has in common with others."""
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
