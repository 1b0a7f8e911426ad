"""One scenario run many times: its container is built once."""

import tempfile
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from motionfmu import recording
from motionfmu.engines.native import Container
from motionfmu.errors import InputError
from motionfmu.result import Result, planned
from motionfmu.run import Options, Scenario
from motionfmu.system import End, Setting
from motionfmu.values import settings, start_values

FMI = 3


def split(name: str) -> tuple[str, int | None]:
    """Part a name into a variable and an element of it.

    Parameters
    ----------
    name : str
        ``component.variable`` or ``component.variable[i]``, i from 1.

    Returns
    -------
    str, int or None
        The variable; the element, from 0.
    """
    whole, bracket, rest = name.partition("[")
    index = rest.removesuffix("]")
    if bracket and rest.endswith("]") and index.isdecimal():
        return whole, int(index) - 1
    return name, None


class Session:
    """A scenario loaded once, to be run with many values.

    FMUs are unpacked, wired and loaded once. A run gives the same bits as `Scenario.run`.
    Use it as a context manager, or call `close`.

    Parameters
    ----------
    scenario : Scenario
    varied : iterable of str
        Names of the parameters and inputs that runs may set, ``component.variable`` or
        ``component.variable[i]``.
    signals : iterable of End, optional
        Outputs to record; the scenario's own if none are given.
    **options : set, stop, step
        For all runs; see `Options`.

    Raises
    ------
    InputError
        A name or an option is wrong.
    """

    def __init__(
        self,
        scenario: Scenario,
        varied: Iterable[str],
        signals: Iterable[End] | None = None,
        **options: Any,
    ) -> None:
        self.scenario, self._options = scenario, Options(**options)
        self._temporary = tempfile.TemporaryDirectory(prefix="motionfmu-")
        try:
            self._folder = Path(self._temporary.name)
            (self._folder / "container").mkdir()
            self._container = self._prepare(varied, signals)
        except BaseException:
            self._temporary.cleanup()
            raise

    def _prepare(self, varied: Iterable[str], signals: Iterable[End] | None) -> Container:
        scenario = self.scenario
        self._path = self._folder / "path.csv"
        library = scenario.library()
        own = {f"{library}.path_file": str(self._path)} if library else {}
        self._given = {**self._options.set, **own}
        ends = [scenario.resolver.end(split(n)[0], "set", n) for n in varied]
        usual = {e.name: start_values(e.port) for e in ends}
        written = scenario.document.body.set
        usual = {n: v for n, v in usual.items() if n not in {**written, **self._given}}
        base = replace(self._options, set={**usual, **self._given})
        self._plain = scenario.resolved(base)
        self._usual = {s.end.name: s.values for s in self._plain.settings}
        used = scenario.ends if signals is None else list(signals)
        self._wired, self._traces = recording.plan(self._plain, used, self._folder)
        self._scopes = self._wired.settings[len(self._plain.settings) :]
        return Container(self._wired, FMI, self._folder / "container")

    def _values(self, given: Mapping[str, Any]) -> list[Setting]:
        """All settings of a run; a value for one element leaves the others as they are."""
        merged: dict[str, Any] = {}
        for name, value in sorted(given.items(), key=lambda pair: split(pair[0])[1] is not None):
            whole, element = split(name)
            if element is None:
                merged[name] = value
                continue
            before = merged.get(whole, self._usual[whole])
            every = (
                [*before]
                if isinstance(before, tuple | list)
                else [before] * len(self._usual[whole])
            )
            every[element] = value
            merged[whole] = every
        usual = {n: v for n, v in self._usual.items() if n not in self.scenario.document.body.set}
        return settings(self.scenario.resolver, {**usual, **self._given, **merged})

    def run(self, given: Mapping[str, Any]) -> Result:
        """Run once.

        Parameters
        ----------
        given : mapping
            Value by name; names among those of the constructor.

        Returns
        -------
        Result

        Raises
        ------
        InputError
            A value is wrong, or an FMU refused something; one message.
        """
        plain = replace(self._plain, settings=tuple(self._values(given)))
        wired = replace(self._wired, settings=(*plain.settings, *self._scopes))
        self.scenario.check_recording(wired, replace(self._options, set=given))
        self._path.unlink(missing_ok=True)
        try:
            self._container.run(wired, self._options.progress)
        except InputError as error:
            names = {split(n)[0] for n in given} | set(self._options.set)
            raise self.scenario.located(error, plain, dict.fromkeys(names)) from None
        library = self.scenario.library()
        time = np.arange(wired.steps, dtype=np.float64) * (wired.step_ns * 1e-9)
        parameters = {s.end.name: s.values for s in plain.settings}
        geometry = planned(self._path) if library else None
        return Result(self.scenario, time, self._traces.load(), parameters, geometry)

    def close(self) -> None:
        """Free the FMUs and their files."""
        try:
            self._container.free()
        finally:
            self._temporary.cleanup()

    def __enter__(self) -> "Session":
        return self

    def __exit__(self, *error: object) -> None:
        self.close()
