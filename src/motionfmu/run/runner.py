"""Load a scenario and run it."""

from collections.abc import Callable, Collection, Iterable, Mapping
from contextlib import closing
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

from motionfmu.base import columns
from motionfmu.base.errors import Faults, InputError, NoNumber, suggestion
from motionfmu.base.toml_lines import shown
from motionfmu.run import engines
from motionfmu.run.controller_plan import bounded
from motionfmu.run.engines.engine_job import EngineResult
from motionfmu.run.execution import HELD, Execution, own_settings
from motionfmu.run.result import Result
from motionfmu.run.run_plan import Options, RunPlan
from motionfmu.scenarios import agreement, grids
from motionfmu.scenarios.document import changed, made, plain
from motionfmu.scenarios.system import System
from motionfmu.scenarios.values import settings


class Scenario(RunPlan):
    """A scenario ready to run.

    Parameters
    ----------
    source : str, Path or Document
        A scenario.toml or the folder that holds it; or tables, see `scenario`.

    Attributes
    ----------
    document : Document
        The file.
    resolver : Resolver
        Its FMUs.
    ends : list of End
        What is recorded.
    only_drawn : set of str
        Names among them that nothing but a figure asks for.
    notes : tuple of str
        What of a drawing that is its program is not drawn; a warning of each run.

    Raises
    ------
    InputError
        Anything wrong in the file; a line for each thing, with file, line and value.
    """

    notes: tuple[str, ...] = ()
    held: object = None  # keeps files that its values name for as long as it is there

    def __repr__(self) -> str:
        body = self.document.body
        stop = body.stop if isinstance(body.stop, str) else f"{body.stop:g} s"
        fmus = ", ".join(dict.fromkeys(body.component.values()))
        n, checks = len(self.ends), sum(len(rows) for _, _, rows in body.asked)
        counts = f"{n} signal{'s' * (n != 1)} recorded, {checks} check{'s' * (checks != 1)}"
        return f"<Scenario {self.name}: {fmus}; until {stop}, {counts}>"

    def run(  # noqa: PLR0913  (each is a keyword)
        self,
        *,
        engine: str | None = None,
        fmi: int | None = None,
        set: Mapping[str, Any] | None = None,
        stop: float | None = None,
        step: float | None = None,
        every: int | None = None,
        undriven: Collection[str] = (),
        source: Mapping[str, str] | None = None,
        scratch: str | Path | None = None,
        progress: Callable[[float], None] | None = None,
        **unknown: Any,
    ) -> Result:
        """Run the scenario.

        Parameters
        ----------
        engine : str, optional
            ``fused``, ``native``, ``python`` or ``fmpy``; all give the same bits. If not given,
            ``$MOTIONFMU_ENGINE``, else fused where there is a C compiler and every FMU is ours, and
            native elsewhere.
        fmi : int, optional
            2 or 3; 3 if not given.
        set : mapping, optional
            Value by ``component.variable`` or, for one element, ``component.variable[i]``, i from
            1; stronger than the scenario's.
        stop : float, optional
            When the run ends instead of the scenario's time or signal [s].
        step : float, optional
            Communication step instead of the scenario's [s].
        every : int, optional
            Of so many steps one is recorded, instead of the scenario's.
        undriven : collection of str, optional
            Inputs whose [[drive]] is left out.
        source : mapping, optional
            Name of the file that a value of `set` is from, for the report.
        scratch : str or Path, optional
            Folder in which what is recorded lies until the result is saved or gone; else the
            system's temporary one, ``$TMPDIR``.
        progress : callable, optional
            Called with the share done, 0 to 1.
        **unknown
            There are no others: an error that suggests one of these.

        Raises
        ------
        InputError
            An option is wrong, or an FMU refused something; a line for each thing that is wrong.
        """
        known = [f.name for f in fields(Options)]
        for name in unknown:
            raise InputError(f"run: no option {name!r}{suggestion(name, known)}")
        faults = Faults()
        chosen = faults.of(lambda: engines.named(engine))
        asked = Options(
            engine=chosen,
            fmi=3 if fmi is None else fmi,
            set=plain(set or {}),
            stop=stop,
            step=step,
            every=every,
            undriven=undriven,
            source=source or {},
            scratch=None if scratch is None else Path(scratch),
            progress=progress or (lambda share: None),
        )
        _check(asked, faults)
        if faults.lines and isinstance(asked.set, Mapping):  # those of a good run are read later
            faults.of(lambda: settings(self.resolver, asked.set))
        faults.tell()
        with columns.temporary(asked.scratch) as name:
            folder = Path(name)
            asked = bounded(self, asked)
            given = replace(asked, set={**asked.set, **own_settings(self, folder)})
            execution = Execution.plan(self, given, self.ends, folder)

            def master(system: System) -> EngineResult:
                with closing(engines.opened(chosen, execution.job(asked.fmi, HELD))) as ready:
                    ran = ready.run(system, asked.progress)
                early = [*agreement.warnings(system), *grids.warnings(system)]
                return replace(ran, warnings=[*early, *ran.warnings])

            result = execution.run(master, asked)
        result.warnings += self.notes + _sparse(result, execution.system)
        if fmi == 3 and execution.system.elementwise:  # asked for
            told = "fmi = 3: wires join elements of arrays, so FMUs that have both run as FMI 2"
            result.warnings += (told,)
        return result

    def changed(  # noqa: PLR0913  (each is a keyword)
        self,
        *,
        set: Mapping[str, Any] | None = None,
        connect: Mapping[str, str | None] | None = None,
        leave: Iterable[str] | None = None,
        record: Mapping[str, Any] | Iterable[str] | None = None,
        stop: float | str | None = None,
        step: float | None = None,
        drive: Iterable[Mapping[str, Any]] | None = None,
        check: Mapping[str, Any] | None = None,
        expect: Mapping[str, Any] | None = None,
        component: Mapping[str, str | None] | None = None,
        name: str | None = None,
        **tables: Any,
    ) -> "Scenario":
        """Make another scenario from this one; nothing is written.

        Tables are merged key by key, and None takes a key away. Names of `leave` and `record` are
        added. `drive` and other arrays of tables take the place of the scenario's. What the
        scenario expects as it is written is not judged in a run of the other one.

        Parameters
        ----------
        set, connect, component, check, expect : mapping, optional
            Entries of these tables; a value of `set` may be of one element,
            ``component.variable[i]``.
        leave : iterable of str, optional
            More inputs that are left at their start values.
        record : iterable of str or mapping, optional
            More outputs to record, or the table: ``{"every": 10, "signals": [...]}``.
        stop : float or str, optional
            When the run ends [s], or the signal that ends it (with ``limit=`` [s]).
        step : float, optional
            Communication step [s].
        drive : iterable of mapping, optional
            Inputs that step, instead of the scenario's: ``{"input", "at", "value"}``.
        name : str, optional
            For messages and reports; the scenario's own if not given.
        **tables
            Any other key or table of a scenario.toml: limit, settle, contour, figure, ...

        Returns
        -------
        Scenario
            Checked against its FMUs.

        Raises
        ------
        InputError
            Something is wrong; a line for each, with ``<name>:[table] key``.
        """
        given: dict[str, Any] = {"set": set, "connect": connect, "component": component}
        given |= {"leave": None if leave is None else _names(leave), "check": check}
        given["expect"] = expect
        given |= {"stop": stop, "step": step, "drive": None if drive is None else list(drive)}
        given["record"] = record
        if record is not None and not isinstance(record, Mapping):
            given["record"] = {"signals": _names(record)}
        given = {k: v for k, v in given.items() if v is not None} | tables
        found = type(self)(changed(self.document, given, name or self.name))
        found.notes, found.held = self.notes, self.held
        return found


def load(path: str | Path) -> Scenario:
    """Read a scenario and check it against its FMUs.

    Parameters
    ----------
    path : str or Path
        A scenario.toml or the folder that holds it, anywhere.

    Raises
    ------
    InputError
        Anything wrong in the file; one message with file, line and value.
    """
    return Scenario(path)


def scenario(
    given: Mapping[str, Any] | str | Path,
    *,
    name: str = "scenario",
    folder: str | Path = ".",
    about: str = "",
) -> Scenario:
    """Make a scenario of tables like those of a scenario.toml.

    Parameters
    ----------
    given : mapping, str or Path
        The tables: ``{"stop": 1.0, "step": 1e-4, "component": {...}, ...}``, with ``extends`` if
        they change another scenario; or the path of a scenario, as of `load`.
    name : str
        For messages and reports.
    folder : str or Path
        What texts of the tables name, a part program, lies here.
    about : str
        What the scenario shows; the title of its report.

    Returns
    -------
    Scenario
        Checked against its FMUs.

    Raises
    ------
    InputError
        Something is wrong; a line for each, with ``<name>:[table] key``.
    """
    if not isinstance(given, Mapping):
        return load(given)
    return Scenario(made(given, name, Path(folder).resolve(), about))


def _sparse(result: Result, system: System) -> tuple[str, ...]:
    """Warnings about a contour that is found from rows of every so many steps only."""
    if system.every == 1 or result.scenario.document.body.contour is None:
        return ()
    from motionfmu.analysis.contour.sparse import sparse

    try:
        return tuple(sparse(result.contour(), system.step_ns * 1e-9))
    except NoNumber:
        return ()


def _names(given: Iterable[str]) -> list[str]:
    """A list of names; a single one is a list of one."""
    return [given] if isinstance(given, str) else list(given)


def _check(asked: Options, faults: Faults) -> None:
    """Add options that no run can have to the faults."""
    if asked.fmi not in (2, 3):
        faults.lines.append(f"FMI {asked.fmi!r}: 2 or 3")
    if not isinstance(asked.set, Mapping):
        faults.lines.append(f"set = {shown(asked.set)}: values by name wanted")
    for key in ("stop", "step"):
        value = getattr(asked, key)
        if value is not None and (isinstance(value, bool) or not isinstance(value, int | float)):
            faults.lines.append(f"{key} = {shown(value)}: seconds wanted")
    every = asked.every
    if every is not None and (isinstance(every, bool) or not isinstance(every, int) or every < 1):
        faults.lines.append(f"every = {shown(every)}: a whole number from 1 wanted")
