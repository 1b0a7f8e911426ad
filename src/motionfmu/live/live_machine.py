"""The fused program of a scenario, stepped, changed, looked at and taken back by hand."""

import json
import math
from collections import deque
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from ctypes import byref, c_int, c_size_t, c_void_p, create_string_buffer, sizeof
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu import fused
from motionfmu.base.errors import InputError, suggestion
from motionfmu.base.new_folder import new_folder
from motionfmu.fmu.describe import STRICT
from motionfmu.fused.resource_files import carrying, placed
from motionfmu.live.journal import Action, Journal
from motionfmu.live.loaded_files import LoadedFiles
from motionfmu.live.sample_ring import CHANNELS, SampleRing
from motionfmu.run import begin_state
from motionfmu.run.engines import fmu_messages
from motionfmu.run.engines.fmu_library import FmuRefusal, Library, ValuePlace
from motionfmu.run.run_plan import Options
from motionfmu.run.runner import Scenario, load
from motionfmu.run.saved_scenario import copied_files
from motionfmu.scenarios import package_files
from motionfmu.scenarios.system import End, Stimulus
from motionfmu.scenarios.toml_text import document_lines, value_text
from motionfmu.scenarios.values import start_values, value_of, values_of

# Steps whose samples are gathered before they are sorted into rings: 16 of a turn at 0.1 ms.
_BATCH = 64
# Sets of channels whose calls are kept.
_SAMPLERS = 16
NAME = "system"
BEGIN_FILE = "begin.zip"  # of a saved scenario that begins in a state
# Bytes of all states that are kept to go back to.
STATES_MAX = 512 << 20
# What a scenario says of its own run, at times that this one need not reach.
_CLAIMS = "limit", "settle", "contrary", "figure", "waveform", "iso9283"
_NUMBERS = {
    "Float64",
    "Float32",
    "Boolean",
    *(f"{u}Int{n}" for u in ("", "U") for n in (8, 16, 32, 64)),
}


@dataclass
class _Sampler:
    """Reads channels into a batch: the calls of each of its steps, and where the samples are."""

    calls: list[list[Callable[[], None]]]  # by step of the batch
    # of each type: the batch, shape (steps, elements), the elements wanted, where they go
    parts: list[tuple[NDArray[Any], NDArray[Any], slice]]
    columns: dict[str, int]  # of the rows, by channel
    orders: dict[tuple[str, ...], NDArray[Any]] = field(default_factory=dict)  # columns of rings

    def rows(self, count: int) -> NDArray[Any]:
        """Samples of the first steps of the batch, shape (count, channels), sorted by type."""
        rows = np.empty((count, len(self.columns)))
        for batch, elements, columns in self.parts:
            rows[:, columns] = batch[:count].take(elements, axis=1)
        return rows

    def of(self, rows: NDArray[Any], channels: tuple[str, ...]) -> NDArray[Any]:
        """Such rows with some of the channels."""
        order = self.orders.get(channels)
        if order is None:
            self.orders[channels] = order = np.array([self.columns[c] for c in channels], int)
        return rows.take(order, axis=1)


@dataclass
class _SavedState:
    """A state of the program, and what had been set by then."""

    step: int
    state: c_void_p
    values: dict[str, tuple[Any, ...]]


class LiveMachine:
    """A scenario's program that goes on for as long as it is stepped.

    What is set acts when the next communication step begins and is written down with it, so what
    was done by hand is a scenario, whose run has the same bits.

    Parameters
    ----------
    scenario : Scenario, str or Path
        Its [[drive]]s act too; a signal that ends it does not end the machine.
    set : mapping, optional
        Values by ``component.variable``, stronger than the scenario's.

    Attributes
    ----------
    scenario : Scenario
    journal : Journal
    steps : int
        Communication steps made.

    Raises
    ------
    InputError
        A name or value is wrong, or an FMU refuses one.
    """

    def __init__(
        self, scenario: Scenario | str | Path, set: Mapping[str, Any] | None = None
    ) -> None:
        self.scenario = scenario if isinstance(scenario, Scenario) else load(scenario)
        given = Options(set=dict(set or {}))
        self._loaded = LoadedFiles(self.scenario.resolved(given).settings)
        self._options = Options(set={**given.set, **self._loaded.values})
        self._system = self.scenario.resolved(self._options)
        self._outputs = {e.name: e for e in self._ends("output")}
        self._made = fused.program(self._system, list(self._outputs.values()), 3)
        about = json.loads((self._made.folder / "program.json").read_bytes())
        self._token: str = about["token"]
        self._places = {name: ValuePlace(*row) for name, row in about["variables"].items()}
        self._inputs = {e.name: e for e in self._changeable()}
        self._errors: list[str] = []
        self.warnings: list[str] = []
        self._library = Library(self._made.folder / about["library"], 3)
        self._kept: deque[_SavedState] = deque()
        self._samplers: dict[tuple[str, ...], _Sampler] = {}
        self._readers: dict[tuple[str, ...], Callable[[], list[Any]]] = {}
        self.journal = Journal(self._system.step_ns)
        self.steps, self._closed = self._system.begin, False
        try:
            self._begin()
        except BaseException:
            self._library.close()
            raise

    def _ends(self, causality: str, types: Collection[str] = _NUMBERS) -> list[End]:
        resolver = self.scenario.resolver
        return [
            resolver.end(f"{component}.{port.name}", "", "")
            for component, ports in resolver.ports.items()
            for port in ports.values()
            if port.causality == causality and port.type in types
        ]

    def _changeable(self) -> list[End]:
        """Inputs that no wire feeds and no stimulus drives, and tunable parameters."""
        taken = {w.target.name for w in self._system.wires}
        taken |= {s.end.name for s in self._system.stimuli}
        types = {*_NUMBERS, "String"}
        tunable = [e for e in self._ends("parameter", types) if e.port.tunable]
        both = [*self._ends("input", types), *tunable]
        return [e for e in both if e.name not in taken and e.name in self._places]

    def _begin(self) -> None:
        library, system = self._library, self._system
        settings = placed(system, carrying(system)).settings
        values = {s.end.name: s.values for s in settings if s.end.port.name != STRICT}
        given: dict[str, tuple[Any, ...]] = {n: v for n, v in values.items() if n in self._places}
        given |= {"system.step": (system.step_ns * 1e-9,), "recorder.folder": ("",)}
        if "until.settle" in self._places:
            given["until.settle"] = (-1,)
        self._values = {
            e.name: values.get(e.name, tuple(start_values(e.port))) for e in self._inputs.values()
        }
        self._first = dict(self._values)
        due = system.due()
        self._due: dict[int, Sequence[Stimulus]] = dict(due)

        def begin() -> None:
            library.instantiate(NAME, self._token, self._made.folder / "resources", self._tell)
            library.warn()
            library.set((self._places[n], v) for n, v in given.items())
            library.enter(system.begin_time)
            library.leave()

        self._refusable(begin)
        if system.begin:  # what is in force there is in the state
            found = zip(self._inputs, self.read(self._inputs), strict=True)
            self._values = {name: tuple(values) for name, values in found}
            self._first = dict(self._values)
        self._advance_one = library.stepper(system.step_ns * 1e-9)

    def _tell(self, status: int, text: str) -> None:
        told = text.strip().removeprefix(f"{NAME}: ")
        fmu_messages.keep(status, told, self._errors, self.warnings)

    def _open(self) -> None:
        if self._closed:
            raise InputError(f"{self.scenario.name}: the machine is closed")

    def _refusable(self, call: Callable[[], None]) -> None:
        self._open()
        self._errors.clear()
        try:
            call()
        except FmuRefusal as refused:
            raise fmu_messages.failure(NAME, str(refused), self._errors) from None

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self.steps * self._system.step_ns / 1e9

    @property
    def step_seconds(self) -> float:
        """Communication step [s]."""
        return self._system.step_ns / 1e9

    @property
    def step_ns(self) -> int:
        """Communication step [ns]."""
        return self._system.step_ns

    def unit(self, channel: str) -> str:
        """The unit of a signal or of an element of it.

        Parameters
        ----------
        channel : str
            As of `ring`.

        Returns
        -------
        str
            Empty without one.
        """
        whole, _ = self._element(channel)
        known = self._outputs.get(whole) or self._inputs[whole]
        return known.port.unit or ""

    @property
    def names(self) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """What can be looked at, and what can be set."""
        return tuple(self._outputs), tuple(self._inputs)

    def text(self, name: str) -> str | None:
        """What the scenario sets a text variable to.

        Parameters
        ----------
        name : str
            ``component.variable``.

        Returns
        -------
        str or None
            None if it sets nothing.
        """
        texts = (s.values[0] for s in self._system.settings if s.end.name == name)
        return next(map(str, texts), None)

    def parameter(self, name: str) -> tuple[Any, ...]:
        """A parameter as the machine began.

        Parameters
        ----------
        name : str
            ``component.variable``.

        Returns
        -------
        tuple
            Its elements, set or of the FMU's description.

        Raises
        ------
        InputError
            There is no such variable.
        """
        given = {s.end.name: s.values for s in self._system.settings}
        return value_of(self.scenario.resolver, given, name)

    def set(self, name: str, value: Any) -> Action:
        """Give an input or a parameter a value from now on.

        Parameters
        ----------
        name : str
            ``component.variable``, or ``component.variable[i]``.
        value : number, bool or list
            One for all elements, or a list.

        Returns
        -------
        Action

        Raises
        ------
        InputError
            There is no such name, something else sets it, or the value is out of its range.
        """
        whole, values = self.checked(name, value)
        self._refusable(lambda: self._library.set([(self._places[whole], values)]))
        self._values[whole] = values
        action = Action(self.steps, whole, values)
        self.journal.add(action)
        return action

    def checked(self, name: str, value: Any) -> tuple[str, tuple[Any, ...]]:
        """What `set` would set, without setting it.

        Parameters
        ----------
        name : str
            As of `set`.
        value : number, bool, str or list
            As of `set`, which raises the same errors.

        Returns
        -------
        name : str
            The whole variable.
        values : tuple
            Of all its elements.
        """
        whole, element = self._split(name)
        end = self._inputs[whole]
        had = self._values[whole]
        had = had * end.port.count if len(had) == 1 else had
        try:
            if element is None:
                values = values_of(end, value)
                values = values * end.port.count if len(values) == 1 else values
            else:
                values = values_of(end, [*had[:element], value, *had[element + 1 :]])
        except ValueError as error:
            raise InputError(str(error)) from None
        return whole, values

    @property
    def changed_values(self) -> dict[str, tuple[tuple[Any, ...], tuple[Any, ...]]]:
        """By name, values at the beginning and now that differ."""
        pairs = {n: (_all(self._first[n], v), v) for n, v in self._values.items()}
        return {n: (first, now) for n, (first, now) in pairs.items() if first != _all(now, first)}

    def first(self, name: str) -> tuple[str, Any]:
        """The value that a variable had when the machine began.

        Parameters
        ----------
        name : str
            ``component.variable``, or an element of it, which means all of them.

        Returns
        -------
        name : str
        value : number, bool or list

        Raises
        ------
        InputError
            It is nothing that can be set.
        """
        whole, _ = self._split(name)
        first = self._first[whole]
        return whole, first[0] if len(first) == 1 else list(first)

    def _split(self, name: str) -> tuple[str, int | None]:
        try:
            whole, element = self.scenario.resolver.split(name)
        except InputError:
            whole, element = name, None
        if whole in self._inputs:
            count = self._inputs[whole].port.count
            if element is not None and not 0 <= element < count:
                raise InputError(f"{name}: {whole} has the elements 1 to {count}")
            return whole, element
        for stimulus in self._system.stimuli:
            if stimulus.end.name == whole:
                raise InputError(f"{whole} is driven by the scenario")
        for wire in self._system.wires:
            if wire.target.name == whole:
                raise InputError(f"{whole} is wired to {wire.source.name}")
        if whole in self._outputs:
            raise InputError(f"{whole} is an output")
        raise InputError(f"{name} cannot be set{suggestion(name, self._inputs)}")

    def __getitem__(self, name: str) -> Any:
        """The present value of an output or of what can be set: a number, or an array."""
        whole, bracket, _ = name.partition("[")
        if whole not in self._outputs and whole not in self._inputs:
            raise InputError(f"{name}: no such signal{suggestion(name, self._outputs)}")
        found = self.read([whole])[0]
        if not bracket:
            return found[0] if len(found) == 1 else np.array(found)
        _, element = self.scenario.resolver.split(name)
        return found[element or 0]

    def read(self, names: Iterable[str]) -> list[list[Any]]:
        """Present values of whole signals.

        Parameters
        ----------
        names : iterable of str

        Returns
        -------
        list of list
            The elements of each, in the order of the names.

        Raises
        ------
        InputError
            There is no such signal.
        """
        self._open()
        key = tuple(names)
        if key not in self._readers:
            self._known(key)
            self._readers[key] = self._reader(key)
        return self._readers[key]()

    def _known(self, names: Iterable[str]) -> None:
        for name in names:
            if name not in self._outputs and name not in self._inputs:
                told = suggestion(name, [*self._outputs, *self._inputs])
                raise InputError(f"{name}: no such signal{told}")

    def _reader(self, names: tuple[str, ...]) -> Callable[[], list[list[Any]]]:
        """A function that reads these signals, by one call of the FMU for each type."""
        by_type: dict[str, list[str]] = {}
        for name in names:
            by_type.setdefault(self._places[name].type, []).append(name)
        calls, where = [], {}
        for kind, several in by_type.items():
            places = [self._places[n] for n in several]
            buffer = self._library.buffer(kind, sum(p.count for p in places))
            calls.append(self._library.access("Get", places, buffer))
            first = 0
            for name, place in zip(several, places, strict=True):
                where[name] = buffer, slice(first, first + place.count)
                first += place.count

        def read() -> list[list[Any]]:
            for call in calls:
                call()
            found = [list(where[n][0][where[n][1]]) for n in names]
            for place in texts:
                found[place] = [value.decode(errors="replace") for value in found[place]]
            return found

        texts = [k for k, n in enumerate(names) if self._places[n].type == "String"]
        return read

    def step(self, count: int = 1) -> None:
        """Make communication steps.

        Parameters
        ----------
        count : int
            0 or more.

        Raises
        ------
        InputError
            It is no such number, or an FMU refuses to go on.
        """
        _whole_number(count)
        self._open()
        end = self.steps + count
        while self.steps < end:
            if self.steps in self._due:
                self._refusable(self._drive)
            later = [k for k in self._due if self.steps < k < end] if self._due else []
            following = min(later, default=end)
            self._advance(following - self.steps)

    def _drive(self) -> None:
        """Set what the scenario drives at this step."""
        now = self._due[self.steps]
        self._library.set((self._places[s.end.name], s.values) for s in now)

    def _advance(self, count: int) -> None:
        step = self._system.step_ns * 1e-9
        self._refusable(lambda: self._library.step(self.steps * step, count * step))
        self.steps += count

    def trace(self, names: Iterable[str], count: int) -> dict[str, NDArray[Any]]:
        """Make communication steps; record signals before each.

        Parameters
        ----------
        names : iterable of str
            Whole outputs.
        count : int

        Returns
        -------
        dict
            By name, of shape (count,) or (count, elements).

        Raises
        ------
        InputError
            There is no such signal, `count` is no number of steps, or an FMU refuses to go on.
        """
        _whole_number(count)
        wanted = (names,) if isinstance(names, str) else tuple(names)
        self._known(wanted)
        rows = []
        for _ in range(count):
            rows.append(self.read(wanted))
            self.step()
        return {
            n: np.array([r[k] for r in rows]).squeeze(axis=1)
            if self._places[n].count == 1
            else np.array([r[k] for r in rows])
            for k, n in enumerate(wanted)
        }

    def ring(self, channels: Sequence[str]) -> SampleRing:
        """An empty ring for these channels, from this step on.

        Parameters
        ----------
        channels : sequence of str
            ``component.variable`` of a scalar, or ``component.variable[i]``.

        Returns
        -------
        SampleRing

        Raises
        ------
        InputError
            There is no such signal, one is an array, or they are too many.
        """
        if len(channels) > CHANNELS:
            raise InputError(f"{len(channels)} channels: {CHANNELS} are the most")
        for name in channels:
            self._element(name)
        return SampleRing(channels, self.steps)

    def _element(self, name: str) -> tuple[str, int]:
        """A channel's whole signal and its element, from 0."""
        whole, element = self.scenario.resolver.split(name)
        self._known([whole])
        count = self._places[whole].count
        if self._places[whole].type == "String":
            raise InputError(f"{name} is a text")
        if element is None and count > 1:
            raise InputError(f"{name}: it has the elements {whole}[1] to [{count}]")
        if element is not None and not 0 <= element < count:
            raise InputError(f"{name}: {whole} has the elements 1 to {count}")
        return whole, element or 0

    def fill(self, rings: Sequence[SampleRing], count: int) -> None:
        """Make communication steps, with a sample before each.

        Parameters
        ----------
        rings : sequence of SampleRing
            All of which end at this step.
        count : int

        Raises
        ------
        InputError
            An FMU refuses to go on.
        """
        _whole_number(count)
        end = self.steps + count
        channels = tuple(dict.fromkeys(c for ring in rings for c in ring.channels))
        try:
            while channels and self.steps < end:
                self._sample(rings, channels, min(end - self.steps, _BATCH))
            self.step(end - self.steps)
        finally:
            for ring in rings:
                if not ring.channels:
                    ring.cut(self.steps)

    def reading(self, channels: Sequence[str]) -> Callable[[], NDArray[np.float64]]:
        """A quick function that reads elements of signals.

        Parameters
        ----------
        channels : sequence of str
            As of `ring`, as many as wanted.

        Returns
        -------
        callable
            Without arguments; their present values, of shape (channels,), in an array of its own.

        Raises
        ------
        InputError
            There is no such signal, or one is an array.
        """
        order = tuple(channels)
        sampler = self._sampler(order)

        def read() -> NDArray[np.float64]:
            for call in sampler.calls[0]:
                call()
            return sampler.of(sampler.rows(1), order)[0]

        return read

    def _sample(self, rings: Sequence[SampleRing], channels: tuple[str, ...], count: int) -> None:
        """Make the steps of a batch, and sort its samples into the rings."""
        self._open()
        sampler = self._sampler(channels)
        began = self.steps
        try:
            self._refusable(lambda: self._step_and_read(sampler.calls[:count]))
        finally:
            rows = sampler.rows(self.steps - began)
            for ring in rings:
                ring.write(sampler.of(rows, ring.channels))

    def _step_and_read(self, calls: Iterable[Iterable[Callable[[], None]]]) -> None:
        step, advance, due = self._system.step_ns * 1e-9, self._advance_one, self._due
        for reads in calls:
            for read in reads:
                read()
            if self.steps in due:
                self._drive()
            advance(self.steps * step)
            self.steps += 1

    def _sampler(self, channels: tuple[str, ...]) -> _Sampler:
        if channels in self._samplers:
            return self._samplers[channels]
        by_type: dict[str, list[tuple[str, str, int]]] = {}
        for name in dict.fromkeys(channels):
            whole, element = self._element(name)
            by_type.setdefault(self._places[whole].type, []).append((name, whole, element))
        calls: list[list[Callable[[], None]]] = [[] for _ in range(_BATCH)]
        parts: list[tuple[NDArray[Any], NDArray[Any], slice]] = []
        columns: dict[str, int] = {}
        for kind, several in by_type.items():
            names = list(dict.fromkeys(whole for _, whole, _ in several))
            places = [self._places[n] for n in names]
            firsts = dict(zip(names, np.cumsum([0, *(p.count for p in places)]), strict=False))
            count = sum(p.count for p in places)
            batch = self._library.buffer(kind, _BATCH * count)
            single = type(self._library.buffer(kind, count))
            for k, reads in enumerate(calls):
                row = single.from_buffer(batch, k * sizeof(single))
                reads.append(self._library.access("Get", places, row))
            view = np.frombuffer(batch, np.dtype(batch._type_)).reshape(_BATCH, count)
            where = np.array([firsts[whole] + element for _, whole, element in several])
            first = len(columns)
            columns |= {name: first + k for k, (name, _, _) in enumerate(several)}
            parts.append((view, where, slice(first, len(columns))))
        if len(self._samplers) >= _SAMPLERS:
            self._samplers.clear()
        self._samplers[channels] = _Sampler(calls, parts, columns)
        return self._samplers[channels]

    def keep(self) -> None:
        """Keep the state, to go back to; the oldest go beyond 512 MB."""
        state = c_void_p()
        self._refusable(lambda: self._library.call("GetFMUState", byref(state)))
        self._kept.append(_SavedState(self.steps, state, dict(self._values)))
        while len(self._kept) > 1 and len(self._kept) * self.state_bytes > STATES_MAX:
            self._drop(self._kept.popleft())

    @property
    def state_bytes(self) -> int:
        """Size of one state [bytes]."""
        if not self._kept:
            return 0
        size = c_size_t()
        state = self._kept[-1].state
        self._refusable(lambda: self._library.call("SerializedFMUStateSize", state, byref(size)))
        return size.value

    @property
    def kept(self) -> list[float]:
        """Times of the states that are kept [s]."""
        return [k.step * self._system.step_ns / 1e9 for k in self._kept]

    def back(self, time: float) -> float:
        """Go back to a state; what was done since is forgotten.

        Parameters
        ----------
        time : float
            [s].

        Returns
        -------
        float
            Time of that state [s].

        Raises
        ------
        InputError
            No state is kept from then.
        """
        there = self._kept_at(time, "back to")
        while self._kept[-1] is not there:
            self._drop(self._kept.pop())
        self._refusable(lambda: self._library.call("SetFMUState", there.state))
        self.steps, self._values = there.step, dict(there.values)
        self.journal.forget(self.steps)
        return self.time

    def _kept_at(self, time: float, asked: str) -> _SavedState:
        """The latest state that is kept at or before a time [s]."""
        if not math.isfinite(time):
            raise InputError(f"{asked} {time} s: a finite time wanted")
        step = round(time * 1e9 / self._system.step_ns)
        found = [k for k in self._kept if k.step <= step]
        if not found:
            raise InputError(f"no state is kept at or before {time:g} s")
        return found[-1]

    def _drop(self, kept: _SavedState) -> None:
        self._refusable(lambda: self._library.call("FreeFMUState", byref(kept.state)))

    def _end_checks(self, rooms: Mapping[str, float]) -> dict[str, dict[str, Any]]:
        """The table [check] by which signals must end with their present values."""
        found: dict[str, dict[str, Any]] = {}
        for name, room in rooms.items():
            value = self[name]
            if isinstance(value, np.ndarray):
                raise InputError(f"{name}: it is an array; name an element of it")
            real = self._places[name.partition("[")[0]].type.startswith("Float")
            found[name] = {"final": [value - room, value + room] if real else value}
        return found

    def as_scenario(self, name: str | None = None) -> Scenario:
        """The scenario that does what was done since it began.

        Parameters
        ----------
        name : str, optional

        Returns
        -------
        Scenario
            Without what the one it began with claims of its own run.

        Raises
        ------
        InputError
            The machine has not been stepped.
        """
        return self._as_scenario(name, self._system.begin, {})

    def _as_scenario(self, name: str | None, begin: int, more: Mapping[str, Any]) -> Scenario:
        """The scenario that does what was done from a step on."""
        if self.steps <= begin:
            raise InputError(f"{self.scenario.name}: no step was made")
        tables = self.scenario.document.tables
        drives = [*tables.get("drive", []), *self.journal.drives(begin)]
        cut: dict[str, Any] = {k: None for k in _CLAIMS if k in tables}
        cut |= {t: dict.fromkeys(tables[t]) for t in ("check", "expect") if tables.get(t)}
        found = self.scenario.changed(
            set=self._options.set,
            drive=drives,
            stop=self.time,
            name=name,
            **cut,
            **more,
        )
        found.held = self._loaded
        return found

    def save(
        self,
        folder: str | Path,
        check: Mapping[str, Any] | None = None,
        begin: float | None = None,
        ends: Mapping[str, float] | None = None,
    ) -> Path:
        """Write what was done as a scenario, with the files it reads.

        Parameters
        ----------
        folder : str or Path
            Not there yet.
        check : mapping, optional
            The [check] of the scenario.
        begin : float, optional
            It begins in the latest state that is kept from this time [s] or before; what was set
            until then is in the state. Else it begins where the machine did.
        ends : mapping, optional
            Signals or elements that must end as they are now: by how much a real number may differ;
            others do not. The scenario is one step longer, at whose begin they are seen.

        Returns
        -------
        Path
            The scenario.toml.

        Raises
        ------
        InputError
            The folder is there, no step was made, no state is kept from then, or a check names what
            there is not.
        """
        place = Path(folder)
        there = None if begin is None else self._kept_at(begin, "begin at")
        with new_folder(place) as part:
            plan = self._saved_plan(place.name, there, part)
            if check or ends:
                plan = plan.changed(check={**(check or {}), **self._end_checks(ends or {})})
            if ends:
                plan = plan.changed(stop=(self.steps + 1) * self._system.step_ns / 1e9)
            given = plan.document.tables.items()
            tables = {
                k: v for k, v in given if k not in ("machine", "extends") and v not in ({}, [])
            }
            tables = copied_files(plan, tables, part, place)
            about = [f"# {self.scenario.document.about.rstrip('.')}, as it was worked at."]
            about += [] if there is None else self._told(there)
            text = "\n".join([*about, *document_lines(tables)]) + "\n"
            (part / package_files.SCENARIO).write_text(text, encoding="utf-8")
        return place / package_files.SCENARIO

    def _saved_plan(self, name: str, there: _SavedState | None, part: Path) -> Scenario:
        """What was done, all of it or from a state on, which is written into a folder."""
        if there is None or there.step == self._system.begin:
            return self.as_scenario(name)
        file = part / BEGIN_FILE
        states = self._component_states(there)
        ns = there.step * self._system.step_ns
        begin_state.write(file, self._system, ns, states, self._in_force(there))
        return self._as_scenario(name, there.step, {"begin": str(file)})

    def _in_force(self, there: _SavedState) -> dict[str, tuple[Any, ...]]:
        """What had another value at a state than at the beginning."""
        pairs = ((n, _all(v, self._first[n])) for n, v in there.values.items())
        return {n: v for n, v in pairs if v != _all(self._first[n], v)}

    def _told(self, there: _SavedState) -> list[str]:
        """Lines of comment: the state in which a scenario begins, and what is in force there."""
        time = there.step * self._system.step_ns / 1e9
        lines = [f"# It begins at {time:.9g} s, in the state {BEGIN_FILE}. In force there:"]
        for name, values in self._in_force(there).items():
            alike = len(set(values)) == 1
            lines.append(f"# {name} = {value_text(values[0] if alike else values)}")
        return lines if len(lines) > 1 else [lines[0].replace(" In force there:", "")]

    def _component_states(self, there: _SavedState) -> dict[str, bytes]:
        """A state as the FMU of each component serializes it; the machine stays where it is."""
        now, library = c_void_p(), self._library
        save = library.own("motionfmu_part_state")
        save.restype = c_size_t
        self._refusable(lambda: library.call("GetFMUState", byref(now)))
        try:
            self._refusable(lambda: library.call("SetFMUState", there.state))
            found = {}
            for k, component in enumerate(self._system.components):
                room = save(library.instance, c_int(k), None, c_size_t(0))
                data = create_string_buffer(room)
                save(library.instance, c_int(k), data, c_size_t(room))
                found[component] = data.raw
        finally:
            self._refusable(lambda: library.call("SetFMUState", now))
            self._refusable(lambda: library.call("FreeFMUState", byref(now)))
        return found

    def close(self) -> None:
        """Free the program and the states that are kept."""
        while self._kept:
            self._drop(self._kept.pop())
        if not self._closed:
            self._library.close()
        self._closed = True

    def __enter__(self) -> "LiveMachine":
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<LiveMachine {self.scenario.name}: {self.time:.9g} s, {len(self.journal)} actions>"


def _all(values: tuple[Any, ...], like: tuple[Any, ...]) -> tuple[Any, ...]:
    """One value for as many elements as another has."""
    return values * len(like) if len(values) == 1 else values


def _whole_number(count: Any) -> None:
    """Refuse what is no number of steps."""
    if isinstance(count, bool) or not isinstance(count, int | np.integer) or count < 0:
        raise InputError(f"{count!r} steps: a whole number from 0 wanted")
