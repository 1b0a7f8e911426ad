"""A scenario made ready to run: read, resolved and checked against its FMUs."""

import re
from collections.abc import Callable, Collection, Hashable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from motionfmu.base.errors import Faults, InputError
from motionfmu.base.memo import Memo
from motionfmu.run import begin_state, contrary, figures, waveforms
from motionfmu.run.checks import is_figure, misplaced, table_of
from motionfmu.scenarios import (
    agreement,
    contour_signals,
    iso9283_signals,
    limited_signals,
    machine_limits,
    rates,
    record_signals,
    recording,
    system,
    tool_signals,
    values,
    view_signals,
)
from motionfmu.scenarios import document as files
from motionfmu.scenarios.body import JUDGED, Bounds
from motionfmu.scenarios.table_sources import of_file

# The options of which a system is made, and how many systems are kept.
_MADE_OF, _KEPT = ("set", "stop", "step", "limit", "every", "undriven"), 4


@dataclass(frozen=True)
class Options:
    """How to run.

    Attributes
    ----------
    engine : str or None
        A name of `motionfmu.run.engines.ENGINES`; None for the quickest that can run it.
    fmi : int
        2 or 3.
    set : mapping
        Value by ``component.variable``, stronger than the scenario's.
    stop, step : float or None
        Instead of the scenario's [s].
    limit : float or None
        The longest run [s], instead of the scenario's.
    every : int or None
        Instead of the scenario's: of so many steps one is recorded.
    undriven : collection of str
        Inputs whose [[drive]] is left out.
    source : mapping
        Name of the file that a value of `set` is from, by ``component.variable``.
    scratch : Path or None
        Folder for what is recorded until it is saved or let go; else the system's temporary one.
    progress : callable
        Called with the share done, 0 to 1.
    """

    engine: str | None = None
    fmi: int = 3
    set: Mapping[str, Any] = field(default_factory=dict)
    stop: float | None = None
    step: float | None = None
    limit: float | None = None
    every: int | None = None
    undriven: Collection[str] = ()
    source: Mapping[str, str] = field(default_factory=dict)
    scratch: Path | None = None
    progress: Callable[[float], None] = lambda share: None

    def given(self) -> dict[str, Any]:
        """The options that a result keeps, to run so again."""
        names = ("engine", "fmi", "set", "stop", "step", "every")
        return {name: getattr(self, name) for name in names} | {"set": dict(self.set)}


class RunPlan:
    """A scenario that is resolved against its FMUs and checked, and the outputs it records."""

    def __init__(self, source: str | Path | files.Document) -> None:
        self.document: files.Document = (
            source if isinstance(source, files.Document) else files.parsed(of_file(source))
        )
        self.ends: list[system.End] = []
        self.only_drawn: set[str] = set()
        self._kept: Memo[system.System] = Memo(_KEPT)
        self._wires: list[system.Wire] | None = None  # they depend on no option
        self._closed: set[Hashable] = set()  # what was given and driven where no input was open
        faults = Faults(self.document.wrong)
        self.resolver = system.Resolver(self.document, faults)
        self.begin = faults.of(lambda: begin_state.read(self.resolver))
        self._check_names(faults)
        self._check_whole(faults)
        self.document.refuse(faults.lines)
        self.check_scopes(self.resolved(Options()), Options())

    def _check_names(self, faults: Faults) -> None:
        """Look up what is recorded, drawn and checked."""
        resolver, body = self.resolver, self.document.body
        listed = faults.of(lambda: recording.chosen(resolver, body.record.signals)) or []
        more = (contour_signals, iso9283_signals, view_signals, tool_signals, record_signals)
        for wanted in (*more, machine_limits, limited_signals):
            with faults.each():
                listed += recording.chosen(resolver, wanted.wanted(resolver))
        if body.iso9283 is not None:
            from motionfmu.run.iso9283_of import written_path

            faults.of(lambda: written_path(self.document))
        drawn = faults.of(lambda: figures.wanted(resolver)) or []
        if not self._damaged("stop", "limit", "step"):
            drawn += faults.of(lambda: waveforms.wanted(resolver)) or []
        checks = Faults()
        for table, name, bounds in body.asked:
            with checks.each():
                drawn += self._checked(table, name, bounds)
        faults.lines += checks.lines
        named = not checks.lines and not self._damaged(*JUDGED)
        faults.of(lambda: contrary.check(resolver, named))
        self.ends = list({e.name: e for e in (*listed, *drawn)}.values())
        self.only_drawn = {e.name for e in drawn} - {e.name for e in listed}

    def _damaged(self, *tables: str) -> bool:
        """Whether something is wrong with the form of one of these tables."""
        return not self.document.damaged.isdisjoint(tables)

    def _checked(self, table: str, name: str, bounds: Sequence[Bounds]) -> list[system.End]:
        """The output that a line of bounds is about; none if that is a figure of an analysis."""
        if is_figure(name) and self._damaged(table_of(name)):
            return []
        found = []
        if not is_figure(name):
            found = [recording.elements(self.resolver, name, table, name)[0]]
        if told := misplaced(name, bounds, self.resolver):
            raise self.document.error(told, table, name)
        return found

    def _check_whole(self, faults: Faults) -> None:
        """Check times, wires, values and unconnected inputs, as far as the file can be resolved."""
        parts = Faults()
        made = self._made(Options(), parts)
        if made is None or self._damaged("component", "connect", "set", "drive", "leave"):
            faults.lines += parts.lines
            return
        if not self.resolver.lost and not parts.lines:
            parts.of(lambda: system.check_inputs(self.resolver, made))
        self._check_times(made, parts)
        faults.lines += parts.lines

    @property
    def name(self) -> str:
        """Name of the scenario: that of its folder, or as a program says."""
        return self.document.name

    @property
    def stop_limit(self) -> float:
        """When a run ends at the latest [s]."""
        return self.document.body.stop_limit

    def resolved(self, options: Options) -> system.System:
        """The system that an engine runs, with the options' values; the latest ones are kept."""
        asked = {name: getattr(options, name) for name in _MADE_OF}
        asked = files.plain(asked | {"undriven": sorted(options.undriven)})
        return self._kept(repr(asked), lambda: self._resolved(options))

    def _resolved(self, options: Options) -> system.System:
        faults = Faults()
        made = self._made(options, faults)
        faults.tell()
        assert made is not None
        given = tuple(frozenset(s.end.name for s in of) for of in (made.settings, made.stimuli))
        if given not in self._closed:
            system.check_inputs(self.resolver, made)
            self._closed.add(given)
        self._check_times(made, faults)
        faults.tell()
        return made

    def _made(self, options: Options, faults: Faults) -> system.System | None:
        """The system of these options without what is wrong; None if the times are wrong."""
        body, resolver = self.document.body, self.resolver
        timing = Faults() if self._damaged("stop", "limit", "step") else faults
        times = timing.of(lambda: self._times(options))
        if self._wires is None:
            self._wires = faults.of(lambda: system.wires(resolver))
        given = faults.of(lambda: values.settings(resolver, options.set)) or []
        if times is None:
            return None
        step_ns, steps = times
        driven = faults.of(lambda: values.stimuli(resolver, step_ns)) or []
        driven += faults.of(lambda: record_signals.stimuli(resolver, times, given)) or []
        driven.sort(key=lambda s: s.step)
        until = None
        if options.stop is None:
            until = faults.of(lambda: system.until(resolver, step_ns))
        made = system.System(
            components=dict(body.component),
            wires=tuple(self._wires or ()),
            settings=tuple(given),
            stimuli=tuple(s for s in driven if s.end.name not in options.undriven),
            step_ns=step_ns,
            steps=steps,
            every=body.record.every if options.every is None else options.every,
            until=until,
        )
        begin = self.begin
        if begin is None or faults.lines:
            return made
        return faults.of(lambda: begin.begun(resolver, made))

    def _times(self, options: Options) -> tuple[int, int]:
        """Communication step [ns] and how many there are at most."""
        document, body = self.document, self.document.body
        key = "stop" if isinstance(body.stop, float) or options.stop is not None else "limit"
        step_ns = self._time("step", options.step, body.step)
        longest = options.limit if options.stop is None else options.stop
        stop_ns = self._time(key, longest, body.stop_limit)
        given = options.stop is not None or options.step is not None
        if step_ns % system.CLOCK_NS:
            text = f"step = {step_ns * 1e-9:.9g} s is no whole number of {system.CLOCK_NS} ns"
            raise InputError(text) if given else document.error(text, "", "step")
        if stop_ns % step_ns:
            text = f"{key} = {stop_ns * 1e-9:.9g} s is no whole number of steps"
            raise InputError(text) if given else document.error(text, "", key)
        if stop_ns // step_ns > system.STEPS_MAX:
            text = f"{stop_ns // step_ns} steps; {system.STEPS_MAX} are the most"
            raise InputError(text) if given else document.error(text, "", "step")
        return step_ns, stop_ns // step_ns

    def _check_times(self, made: system.System, faults: Faults) -> None:
        """Refuse windows and rates that do not fit the run."""
        document, body = self.document, self.document.body
        if self._damaged("stop", "limit", "step", "record"):
            return
        faults.of(lambda: figures.check(document, made.sample_ns))
        for table, name, checks in body.asked:
            for rate in (c.rate for c in checks if c.rate is not None):
                with faults.each():
                    if text := rates.wrong(rate, made.sample_ns, body.stop_limit):
                        raise document.error(f"{name}: {text}", table, name)

    def check_scopes(self, plain: system.System, options: Options) -> None:
        """Refuse scopes that are too large or share a file; the message names the setting."""
        name, told = recording.refused(plain)
        if not told:
            return
        body = self.document.body
        if name in body.set and name not in options.set:
            raise self.document.error(told, "set", name)
        raise InputError(told if name not in options.set else f"set {name}: {told}")

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

    def axis_limits(self, given: Mapping[str, Any] | None = None) -> list[machine_limits.AxisLimit]:
        """Each figure of the machine's axes, with what limits it in a run with these values."""
        made = self.resolved(Options(set=given or {}))
        return machine_limits.axis_limits(self.resolver, made.settings)

    def disagreements(self, given: Mapping[str, Any]) -> list[str]:
        """What two FMUs state differently of one thing in a run with the values of `given`."""
        return agreement.warnings(self.resolved(Options(set=given)))

    def located(
        self, error: InputError, plain: system.System, given: Mapping[str, Any]
    ) -> InputError:
        """An FMU's error with the place of the value it refuses: `given`, else the scenario."""
        text = str(error)
        component, _, rest = text.partition(": ")
        for s in plain.settings:
            end = s.end
            if end.component != component or not re.search(
                rf"\b{re.escape(end.port.name)}(?!\w)", rest
            ):
                continue
            value = s.values[0] if len(set(s.values)) == 1 else list(s.values)
            if end.name in given:
                return InputError(f"set {end.name} = {value!r}: {text}")
            if end.name in self.document.body.set:
                return self.document.error(f"{end.name} = {value!r}: {text}", "set", end.name)
        return InputError(*(f"{self.document.file}: {line}" for line in error.args))
