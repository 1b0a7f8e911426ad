"""Load a scenario, run it, keep what it gave."""

import re
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from motionfmu import figures, recording, scenario, system, values
from motionfmu.checks import Verdict, judge
from motionfmu.engines import ENGINES
from motionfmu.errors import InputError
from motionfmu.scenario import Check

if TYPE_CHECKING:
    from motionfmu.contour import ContourResult
    from motionfmu.figures import Chart

CONTOUR = "contour."


@dataclass(frozen=True)
class Options:
    """How to run.

    Attributes
    ----------
    engine : str
        A name of `motionfmu.engines.ENGINES`.
    fmi : int
        2 or 3.
    set : mapping
        Value by ``component.variable``, stronger than the scenario's.
    stop, step : float or None
        Instead of the scenario's [s].
    progress : callable
        Called with the share done, 0 to 1.
    """

    engine: str = "native"
    fmi: int = 3
    set: Mapping[str, Any] = field(default_factory=dict)
    stop: float | None = None
    step: float | None = None
    progress: Callable[[float], None] = lambda share: None


@dataclass
class Result:
    """What a run gave.

    Attributes
    ----------
    scenario : Scenario
    time : ndarray
        Times of the samples [s], shape (N,).
    signals : dict
        By name: (N, 6) for an array of axes, (N,) for a scalar.
    parameters : dict
        Value of every parameter that was set, by name.
    geometry : str or None
        The planned path as the library wrote it (CSV), if the scenario has a contour.
    """

    scenario: "Scenario"
    time: NDArray[np.float64]
    signals: dict[str, NDArray[Any]]
    parameters: dict[str, Any]
    geometry: str | None = None
    _contour: "ContourResult | None" = None

    def __getitem__(self, name: str) -> NDArray[Any]:
        """A signal, or with ``name[i]`` one axis of it, i from 1."""
        if name in self.signals:
            return self.signals[name]
        whole, bracket, rest = name.partition("[")
        index = rest.removesuffix("]")
        if bracket and whole in self.signals and index.isdigit():
            data = self.signals[whole]
            if data.ndim == 2 and 1 <= int(index) <= data.shape[1]:
                return data[:, int(index) - 1]
        raise KeyError(f"{name} is not recorded (recorded: {', '.join(sorted(self.signals))})")

    def parameter(self, name: str) -> Any:
        """Value of a parameter in this run, set or from its description.

        Parameters
        ----------
        name : str
            ``component.variable``.

        Returns
        -------
        tuple
            One value per element.
        """
        if name in self.parameters:
            return self.parameters[name]
        return values.start_values(self.scenario.resolver.end(name, "set", name).port)

    def contour(self) -> "ContourResult":
        """The contour error of this run against the planned geometry.

        Returns
        -------
        ContourResult

        Raises
        ------
        InputError
            The scenario has no [contour] table.
        """
        if self._contour is None:
            from motionfmu.contour_of import contour_of

            self._contour = contour_of(self)
        return self._contour

    def figures(self) -> "list[Chart]":
        """The figures the scenario asks for, with their curves.

        Returns
        -------
        list of Chart
            Empty if the scenario has no [[figure]].
        """
        return figures.charts(self)

    def overview(self) -> "list[Chart]":
        """One figure for each recorded signal.

        Returns
        -------
        list of Chart
            Not more than `motionfmu.figures.OVERVIEW`.
        """
        return figures.overview(self)

    def _figure(self, name: str) -> float:
        try:
            return self.contour().number(name.removeprefix(CONTOUR))
        except KeyError as error:
            raise self.scenario.document.error(str(error.args[0]), "check", name) from None

    @property
    def name(self) -> str:
        """Name of the scenario."""
        return self.scenario.name

    @property
    def about(self) -> str:
        """What the scenario shows: its first line."""
        return self.scenario.document.about

    @property
    def checks(self) -> list[Verdict]:
        """The verdict of every bound in the scenario's [check] table."""
        found = []
        for name, check in self.scenario.document.body.check.items():
            if name.startswith(CONTOUR):
                found += judge(name, check, np.zeros(1), np.array([self._figure(name)]))
            else:
                found += judge(name, check, self.time, self[name])
        return found

    @property
    def ok(self) -> bool:
        """Whether every check holds."""
        return all(v.ok for v in self.checks)


def _is_axis(name: str, recorded: Mapping[str, system.End]) -> bool:
    """Whether ``signal`` or ``signal[i]`` is there; i from 1."""
    whole, bracket, rest = name.partition("[")
    if not bracket:
        return True
    index, shape = rest.removesuffix("]"), recorded[whole].port.shape
    return bool(shape) and index.isdigit() and 1 <= int(index) <= shape[0]


def _misplaced(check: Check, stop: float) -> str:
    """What is wrong with the times of a check; empty if nothing is."""
    if check.at is not None and check.windows is not None:
        return "at and windows exclude each other"
    if check.at is not None and check.at > stop:
        return f"at = {check.at!r} s is after the stop"
    for low, high in check.windows or ():
        if not 0.0 <= low <= high <= stop:
            return f"windows: [{low!r}, {high!r}] s is not within 0 .. {stop!r} s"
    return ""


class Scenario:
    """A scenario ready to run.

    Parameters
    ----------
    path : str or Path
        A scenario.toml or the folder that holds it.

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

    Raises
    ------
    InputError
        Anything wrong in the file; one message with file, line and value.
    """

    def __init__(self, path: str | Path) -> None:
        self.document = scenario.read(path)
        self.resolver = system.Resolver(self.document)
        listed = recording.chosen(self.resolver, self._recorded())
        drawn = figures.wanted(self.resolver)
        self.ends = list({e.name: e for e in (*listed, *drawn)}.values())
        self.only_drawn = {e.name for e in drawn} - {e.name for e in listed}
        self.resolved(Options())
        self._check_checks()

    @property
    def name(self) -> str:
        """Name of the scenario's folder."""
        return self.document.file.parent.name

    def _recorded(self) -> list[str]:
        from motionfmu.contour_of import wanted

        return [*self.document.body.record.signals, *wanted(self)]

    def _check_checks(self) -> None:
        recorded = {e.name: e for e in self.ends}
        stop = self.document.body.stop
        for name, check in self.document.body.check.items():
            if name.startswith(CONTOUR):
                if self.document.body.contour is None:
                    raise self.document.error(f"{name}: there is no [contour] table", "check", name)
                if check.windows is not None:
                    raise self.document.error(f"{name}: a figure has no windows", "check", name)
            elif name.partition("[")[0] not in recorded or not _is_axis(name, recorded):
                raise self.document.error(f"{name} is not recorded", "check", name)
            elif told := _misplaced(check, stop):
                raise self.document.error(f"{name}: {told}", "check", name)

    def resolved(self, options: Options) -> system.System:
        """All that an engine needs, with the options' values.

        Parameters
        ----------
        options : Options

        Returns
        -------
        System

        Raises
        ------
        InputError
            A value is wrong.
        """
        document, body = self.document, self.document.body
        step_ns = self._time("step", options.step, body.step)
        stop_ns = self._time("stop", options.stop, body.stop)
        if stop_ns % step_ns:
            text = f"stop = {stop_ns * 1e-9:.9g} s is no whole number of steps"
            given = options.stop is not None or options.step is not None
            raise InputError(text) if given else document.error(text, "", "stop")
        resolved = system.System(
            components=dict(body.component),
            wires=tuple(system.wires(self.resolver)),
            settings=tuple(values.settings(self.resolver, options.set)),
            stimuli=tuple(values.stimuli(self.resolver, step_ns)),
            step_ns=step_ns,
            steps=stop_ns // step_ns,
        )
        system.check_inputs(self.resolver, resolved)
        figures.check(document, step_ns)
        return resolved

    def _time(self, key: str, given: float | None, written: float) -> int:
        """Whole nanoseconds of an option, or of the scenario's own key."""
        try:
            return system.nanoseconds(key, written if given is None else given)
        except ValueError as error:
            raise (
                self.document.error(str(error), "", key)
                if given is None
                else InputError(str(error))
            ) from None

    def run(self, **options: Any) -> Result:
        """Run the scenario.

        Parameters
        ----------
        **options : engine, fmi, set, stop, step, progress
            See `Options`.

        Returns
        -------
        Result

        Raises
        ------
        InputError
            An option is wrong, or an FMU refused something; one message.
        """
        asked = Options(**options)
        if asked.engine not in ENGINES:
            raise InputError(f"no engine {asked.engine!r} (there are: {', '.join(ENGINES)})")
        if asked.fmi not in (2, 3):
            raise InputError(f"FMI {asked.fmi!r}: 2 or 3")
        with tempfile.TemporaryDirectory(prefix="motionfmu-") as name:
            folder = Path(name)
            library = self.library()
            extra = {f"{library}.path_file": str(folder / "path.csv")} if library else {}
            given = Options(**{**options, "set": {**asked.set, **extra}})
            plain = self.resolved(given)
            wired, traces = recording.plan(plain, self.ends, folder)
            try:
                ENGINES[asked.engine](wired, asked.fmi, asked.progress)
            except InputError as error:
                raise self.located(error, plain, asked.set) from None
            signals = traces.load()
            geometry = (folder / "path.csv").read_text() if library else None
        time = np.arange(wired.steps, dtype=np.float64) * (wired.step_ns * 1e-9)
        parameters = {s.end.name: s.values for s in plain.settings}
        return Result(self, time, signals, parameters, geometry)

    def library(self) -> str | None:
        """The component that plans the path.

        Returns
        -------
        str or None
            None if the scenario does not look at the contour.
        """
        if self.document.body.contour is None:
            return None
        from motionfmu.contour_of import library_of

        return library_of(self)

    def located(
        self, error: InputError, plain: system.System, given: Mapping[str, Any]
    ) -> InputError:
        """Say where the value stands that an FMU's message names.

        Parameters
        ----------
        error : InputError
            The FMU's own.
        plain : System
            What was run.
        given : mapping
            Values by name that are stronger than the scenario's.

        Returns
        -------
        InputError
        """
        text = str(error)
        component, _, rest = text.partition(": ")
        for s in plain.settings:
            end = s.end
            if end.component != component or not re.search(rf"\b{end.port.name}\b", rest):
                continue
            value = s.values[0] if len(set(s.values)) == 1 else list(s.values)
            if end.name in given:
                return InputError(f"set {end.name} = {value!r}: {text}")
            if end.name in self.document.body.set:
                return self.document.error(f"{end.name} = {value!r}: {text}", "set", end.name)
        return InputError(f"{self.document.file}: {text}")


def load(path: str | Path) -> Scenario:
    """Read a scenario and check it against its FMUs.

    Parameters
    ----------
    path : str or Path
        A scenario.toml or the folder that holds it, anywhere.

    Returns
    -------
    Scenario

    Raises
    ------
    InputError
        Anything wrong in the file; one message with file, line and value.
    """
    return Scenario(path)
