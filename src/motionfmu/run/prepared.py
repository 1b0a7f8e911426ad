"""A scenario read and checked against its FMUs."""

import re
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from motionfmu.errors import InputError
from motionfmu.run import contrary, figures, waveforms
from motionfmu.run.checks import misplaced
from motionfmu.run.iso9283_of import written_path
from motionfmu.scenarios import (
    contour_signals,
    iso9283_signals,
    rates,
    recording,
    system,
    values,
    view_signals,
)
from motionfmu.scenarios import document as files


@dataclass(frozen=True)
class Options:
    """How to run.

    Attributes
    ----------
    engine : str
        A name of `motionfmu.run.engines.ENGINES`.
    fmi : int
        2 or 3.
    set : mapping
        Value by ``component.variable``, stronger than the scenario's.
    stop, step : float or None
        Instead of the scenario's [s].
    every : int or None
        Instead of the scenario's: of so many steps one is recorded.
    undriven : collection of str
        Inputs whose [[drive]] is left out.
    source : mapping
        Name of the file that a value of `set` is from, by ``component.variable``.
    progress : callable
        Called with the share done, 0 to 1.
    """

    engine: str = "native"
    fmi: int = 3
    set: Mapping[str, Any] = field(default_factory=dict)
    stop: float | None = None
    step: float | None = None
    every: int | None = None
    undriven: Collection[str] = ()
    source: Mapping[str, str] = field(default_factory=dict)
    progress: Callable[[float], None] = lambda share: None

    def given(self) -> dict[str, Any]:
        """What a result keeps of it: how to run so again."""
        names = ("engine", "fmi", "set", "stop", "step", "every")
        return {name: getattr(self, name) for name in names} | {"set": dict(self.set)}


class Prepared:
    """A scenario with its FMUs, and what is recorded of it; checked."""

    def __init__(self, path: str | Path) -> None:
        self.document = files.read(path)
        self.resolver = system.Resolver(self.document)
        listed = recording.chosen(self.resolver, self._recorded())
        drawn = [*figures.wanted(self.resolver), *waveforms.wanted(self.resolver)]
        self.ends = list({e.name: e for e in (*listed, *drawn)}.values())
        self.only_drawn = {e.name for e in drawn} - {e.name for e in listed}
        wired, _ = recording.plan(self.resolved(Options()), self.ends, Path())
        self.check_recording(wired, Options())
        self._check_checks()
        contrary.check(self.resolver)

    @property
    def name(self) -> str:
        """Name of the scenario's folder."""
        return self.document.file.parent.name

    @property
    def stop_limit(self) -> float:
        """When a run ends at the latest [s]."""
        return self.document.body.stop_limit

    def _recorded(self) -> list[str]:
        asked = [*contour_signals.wanted(self.resolver), *iso9283_signals.wanted(self.resolver)]
        written_path(self.document)
        shown = view_signals.wanted(self.resolver)
        return [*self.document.body.record.signals, *asked, *shown]

    def _check_checks(self) -> None:
        recorded = {e.name: e.port.shape for e in self.ends}
        for name in self.document.body.check:
            if told := misplaced(name, self.document.body, recorded):
                raise self.document.error(told, "check", name)

    def resolved(self, options: Options) -> system.System:
        """All that an engine needs, with the options' values."""
        document, body = self.document, self.document.body
        step_ns = self._time("step", options.step, body.step)
        stop_ns = self._time("stop", options.stop, body.stop_limit)
        given = options.stop is not None or options.step is not None
        if step_ns % system.CLOCK_NS:
            text = f"step = {step_ns * 1e-9:.9g} s is no whole number of {system.CLOCK_NS} ns"
            raise InputError(text) if given else document.error(text, "", "step")
        if stop_ns % step_ns:
            text = f"stop = {stop_ns * 1e-9:.9g} s is no whole number of steps"
            raise InputError(text) if given else document.error(text, "", "stop")
        if stop_ns // step_ns > system.STEPS_MAX:
            text = f"{stop_ns // step_ns} steps; {system.STEPS_MAX} are the most"
            raise InputError(text) if given else document.error(text, "", "step")
        resolved = system.System(
            components=dict(body.component),
            wires=tuple(system.wires(self.resolver)),
            settings=tuple(values.settings(self.resolver, options.set)),
            stimuli=tuple(
                s
                for s in values.stimuli(self.resolver, step_ns)
                if s.end.name not in options.undriven
            ),
            step_ns=step_ns,
            steps=stop_ns // step_ns,
            every=body.record.every if options.every is None else options.every,
        )
        system.check_inputs(self.resolver, resolved)
        figures.check(document, resolved.sample_ns)
        for name, checks in body.check.items():
            for rate in (c.rate for c in checks if c.rate is not None):
                if text := rates.wrong(rate, resolved.sample_ns, body.stop_limit):
                    raise document.error(f"{name}: {text}", "check", name)
        return resolved

    def check_recording(self, wired: system.System, options: Options) -> None:
        """Refuse a recording that no memory holds, or two of one file; names setting or option."""
        name, told = recording.refused(wired)
        if not told:
            return
        body = self.document.body
        if name in body.set and name not in options.set:
            raise self.document.error(told, "set", name)
        if name.partition(".")[0] in body.component or options.stop or options.step:
            raise InputError(told if name not in options.set else f"set {name}: {told}")
        raise self.document.error(told, "", "step")

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

    def library(self) -> str | None:
        """The component that plans the path; None if the scenario does not look at the contour."""
        if self.document.body.contour is None:
            return None
        return contour_signals.library_of(self.resolver)

    def located(
        self, error: InputError, plain: system.System, given: Mapping[str, Any]
    ) -> InputError:
        """An FMU's error with the place of its value: the scenario's, or `given`, the stronger."""
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
        return InputError(*(f"{self.document.file}: {line}" for line in error.args))
