"""A test bench for the FMUs of one loop, where signals can be added to the values of wires."""

import math
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.linear import AxisModel
from motionfmu.analysis.linear.axis_values import element
from motionfmu.analysis.linear.law import Law, carried
from motionfmu.analysis.linear.stability import moving
from motionfmu.analysis.linear.wiring import Port
from motionfmu.base.errors import InputError
from motionfmu.run import Options
from motionfmu.run.engines import lean
from motionfmu.run.engines.slave import Slave
from motionfmu.scenarios import fmus
from motionfmu.scenarios.system import System, Wire
from motionfmu.scenarios.values import values_of

Array = NDArray[np.float64]
# Logarithm of how far a start must have died away, and how long that may take [s].
_DIED, _LEAD_MAX = 7.0, 3.0


@dataclass(frozen=True)
class Setup:
    """What is measured.

    Attributes
    ----------
    axis : AxisModel
        Its scenario, axis, values and operating point.
    inputs, outputs : tuple of str
        Inputs to which signals are added, outputs that are recorded; ``component.variable``.
    cut : tuple of str
        Inputs whose wire is cut.
    delays : dict
        Communication steps by which the wire of an input is delayed.
    gains : dict
        Factor by which the wire of an input is multiplied.
    """

    axis: AxisModel
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    cut: tuple[str, ...] = ()
    delays: dict[str, int] = field(default_factory=dict)
    gains: dict[str, float] = field(default_factory=dict)


class Bench:
    """The FMUs between inputs and outputs, with signals added.

    They run as the reference master runs them.

    FMUs that are not on a path from an input to an output do not run; inputs that they would set
    have what their law says. Other axes are switched off.

    Parameters
    ----------
    setup : Setup

    Raises
    ------
    InputError
        A name is unknown, or an input is no port of an FMU.
    """

    def __init__(self, setup: Setup) -> None:
        axis = setup.axis
        self.setup, self.axis = setup, axis
        entries = [axis.port(n, axis.inputs, "input") for n in setup.inputs]
        exits = [axis.port(n, axis.outputs, "output") for n in setup.outputs]
        if axis.others and setup.cut:
            raise InputError(
                f"{', '.join(setup.cut)}: no wire of axes that are coupled is cut here"
            )
        for component, name in entries:
            if name in axis.blocks[component].commands:
                raise InputError(f"{component}.{name} arises inside: nothing can be added to it")
        net = axis.net(setup.cut, setup.delays)
        self.used = net.used(entries, exits) | {c for c, _ in (*entries, *exits)}
        self.entries, self.exits = entries, exits
        system = axis.scenario.resolved(Options(set=axis.set))
        self.step_ns = system.step_ns
        self.system = self._alone(system)
        self.lead = self._lead() if axis.others else 0

    def _lead(self) -> int:
        """Steps until coupled axes stand still, for drives begin without their holding torque."""
        closed = self.axis.system(self.setup.inputs, self.setup.outputs)
        slow = np.abs(moving(closed.poles())).max(initial=0.0)
        seconds = _DIED / max(-math.log(max(float(slow), 1e-9)) / closed.dt, _DIED / _LEAD_MAX)
        # whole periods of all grids, so that a signal begins where one does
        return math.ceil(seconds / closed.dt) * round(closed.dt * 1e9 / self.step_ns)

    def _offset(self, wire: Wire) -> list[float]:
        """The torque that holds a coupled plant, to be added to a wire's value; else zeros."""
        component, port = wire.target.component, wire.target.port
        if not self.axis.others or component not in self.axis.points:
            return []
        values, own = self.axis.points[component].values, self.axis.axis
        names = [port.name if k == own else f"{port.name}[{k}]" for k in range(1, port.count + 1)]
        return [values[n] for n in names]

    # CCN 19: an input is wired, set, given by a law, stated or switched off, and the later way
    # wins.
    def _alone(self, system: System) -> System:
        """The system of the FMUs that are used, with all other axes switched off."""
        removed = set(self.setup.cut)
        wires = [
            w
            for w in system.wires
            if w.target.component in self.used and w.target.name not in removed
        ]
        joined = tuple(w for w in wires if w.source.component in self.used)
        components = {c: f for c, f in system.components.items() if c in self.used}
        given = self._said(system)
        feeds = {w.target.name for w in joined}
        for w in wires:
            if w.target.name not in feeds:
                self._from_law(w, given)
        for name, value in self.axis.at.items():
            if name in self.axis.inputs and name not in feeds:
                whole, component, variable = name.partition("[")[0], *name.split(".", 1)
                given[whole] = self.own(component, variable, value, given=given.get(whole))
        resolver = self.axis.scenario.resolver
        for c in components if not self.axis.others else ():
            if "active" in resolver.ports[c]:
                given[f"{c}.active"] = self.own(c, "active", True, False)
        found = [resolver.end(name, "set", name) for name in given]
        self.given = [(end, given[end.name]) for end in found]
        return replace(system, components=components, wires=joined, stimuli=())

    def _said(self, system: System) -> dict[str, Any]:
        """Values that the scenario and the laws of the FMUs that are used set, by name."""
        given: dict[str, Any] = {}
        given |= {s.end.name: s.values for s in system.settings if s.end.component in self.used}
        given |= {s.end.name: s.values for s in system.stimuli if s.end.component in self.used}
        for c, fmu in system.components.items():
            said = carried(fmu)
            if c in self.used and isinstance(said, Law):
                given |= {f"{c}.{n}": self._all(c, n, v) for n, v in said.still.items()}
        return given

    def _from_law(self, wire: Wire, given: dict[str, Any]) -> None:
        """Set an input to the value that an FMU that does not run would give it, by its law."""
        component, name = wire.target.component, wire.target.port.name
        try:
            value = self.axis.value(f"{component}.{name}")
        except (InputError, ValueError):
            return
        whole = f"{component}.{name.partition('[')[0]}"  # a wire may end at one element
        given[whole] = self.own(component, name, value, given=given.get(whole))

    def _all(self, component: str, name: str, value: Any) -> Any:
        end = self.axis.scenario.resolver.end(f"{component}.{name}", "set", name)
        return values_of(end, value)

    def own(
        self, component: str, name: str, value: Any, others: Any = None, given: Any = None
    ) -> Any:
        """Values of all elements: one for this axis, and the rest.

        Parameters
        ----------
        component, name : str
            The variable, or one element of it.
        value : float, int or bool
            Of this axis, or of the element.
        others : float, int or bool, optional
            Of the other elements; else those given, or their start values.
        given : tuple, optional

        Returns
        -------
        tuple
        """
        ports = self.axis.scenario.resolver.ports[component]
        port, place = element(ports, name, self.axis.axis)
        kind: Any = {"Float64": float, "Int32": round, "Boolean": bool}[port.type]
        read: Any = {"Float64": float, "Int32": int, "Boolean": "true".__eq__}[port.type]
        listed = list(given) if given else [read(x) for x in (port.start or "").split()]
        if others is not None:
            listed = [others] * port.count
        listed[place] = kind(value)
        return tuple(listed)

    @contextmanager
    def _slaves(self) -> Iterator[dict[str, Slave]]:
        with ExitStack() as stack:
            messages: list[str] = []
            slaves = {}
            for name, fmu in self.system.components.items():
                slaves[name] = Slave(name, lean.unpacked(fmu, 3), 3, messages)
                stack.callback(slaves[name].free)
            for end, values in self.given:
                slaves[end.component].assign(end.port.type, end.port.reference, values)
            for slave in slaves.values():
                slave.initialize()
            for slave in slaves.values():
                slave.start()
            yield slaves

    # CCN 17: the steps of the master stand in its order: read, record, get, put, step.
    def run(self, added: Array, stop: Callable[[Array], bool] | None = None) -> tuple[Array, Array]:
        """Run the FMUs with signals added at the inputs.

        Parameters
        ----------
        added : ndarray, shape (steps, n_inputs)
            A row for each communication step. A whole-number input gets the nearest one.
        stop : callable, optional
            Given the outputs at a communication point; True ends the run there.

        Returns
        -------
        ndarray, shape (steps, n_outputs)
            Outputs at each communication point, before its step.
        ndarray, shape (steps, n_inputs)
            What was really added.

        Raises
        ------
        InputError
            An FMU refused something; its message.
        """
        with self._slaves() as slaves:
            taps = [_Tap(slaves, self, k) for k in range(len(self.entries))]
            tapped = {t.port for t in taps}
            wires = [
                _BenchWire(slaves, w, self._offset(w))
                for w in self.system.wires
                if _target(w) not in tapped
            ]
            exits = [_OutputReader(slaves, self, p) for p in self.exits]
            shown = np.zeros((len(added), len(exits)))
            used = np.zeros_like(added)
            step = self.step_ns * 1e-9
            for k in range(-self.lead, len(added)):
                # to where the signal begins without a jump, which would raise an alarm
                begun = 0.5 - 0.5 * math.cos(math.pi * (k + self.lead) / max(self.lead, 1))
                row = added[k] if k >= 0 else begun * added[0]
                if k >= 0:
                    shown[k] = [r.read() for r in exits]
                    if stop is not None and stop(shown[k]):
                        return shown[: k + 1], used[: k + 1]
                for w in wires:
                    w.get()
                for t in taps:
                    t.get()
                for w in wires:
                    w.put()
                told = [t.put(x) for t, x in zip(taps, row, strict=True)]
                used[max(k, 0)] = told
                for slave in slaves.values():
                    slave.step((k + self.lead) * self.step_ns * 1e-9, step)
            return shown, used


def _target(wire: Wire) -> Port:
    return wire.target.component, wire.target.port.name


class _BenchWire:
    """A wire that carries its value, or the value plus a constant."""

    def __init__(self, slaves: dict[str, Slave], wire: Wire, offset: list[float]) -> None:
        source, target = slaves[wire.source.component], slaves[wire.target.component]
        a, b = wire.source.port, wire.target.port
        buffer = source.buffer(a.type, a.count)
        self.get = source.access("Get", a.type, a.reference, buffer)
        put = target.access("Set", b.type, b.reference, buffer)

        def shifted() -> None:
            buffer[:] = [v + x for v, x in zip(buffer, offset, strict=True)]
            put()

        self.put = shifted if offset else put


class _OutputReader:
    """One element of an output."""

    def __init__(self, slaves: dict[str, Slave], bench: Bench, port: Port) -> None:
        component, name = port
        ports = bench.axis.scenario.resolver.ports[component]
        declared, self.place = element(ports, name, bench.axis.axis)
        self.buffer = slaves[component].buffer(declared.type, declared.count)
        self.get = slaves[component].access("Get", declared.type, declared.reference, self.buffer)

    def read(self) -> float:
        """The present value."""
        self.get()
        return float(self.buffer[self.place])


class _Tap:
    """An input with a signal added to its wire's value, which may be delayed and multiplied."""

    def __init__(self, slaves: dict[str, Slave], bench: Bench, number: int) -> None:
        self.port = bench.entries[number]
        name = ".".join(self.port)
        ports = bench.axis.scenario.resolver.ports[self.port[0]]
        declared, self.place = element(ports, self.port[1], bench.axis.axis)
        slave = slaves[self.port[0]]
        self.buffer = slave.buffer(declared.type, declared.count)
        given = {end.name: values for end, values in bench.given}
        start = given.get(name) or bench.own(*self.port, _start(declared, self.place))
        self.buffer[:] = list(start)
        self.base = float(self.buffer[self.place])
        self.whole = declared.type == "Int32"
        self._put = slave.access("Set", declared.type, declared.reference, self.buffer)
        wire = next((w for w in bench.system.wires if _target(w) == self.port), None)
        self.source = (
            None
            if wire is None
            else _OutputReader(slaves, bench, (wire.source.component, wire.source.port.name))
        )
        self.gain = bench.setup.gains.get(name, 1.0)
        self.late = [0.0] * bench.setup.delays.get(name, 0)

    def get(self) -> None:
        """Read the source."""
        if self.source is not None:
            self.late.append(self.gain * self.source.read())
            self.buffer[:] = self.source.buffer[:]  # other axes as their wire brings them

    def put(self, added: float) -> float:
        """Write the sum; returns the signal that was added, after rounding."""
        brought = self.base if self.source is None else self.late.pop(0)
        value = brought + added
        if self.whole:
            value = round(value)
        self.buffer[self.place] = value
        self._put()
        return float(value - brought)


def _start(port: fmus.Port, place: int) -> float:
    listed = (port.start or "0").split()
    return float(listed[min(place, len(listed) - 1)])


def setup(
    axis: AxisModel,
    inputs: str | Iterable[str],
    outputs: str | Iterable[str],
    cut: str | Iterable[str] = (),
) -> Setup:
    """Say what is measured.

    Parameters
    ----------
    axis : AxisModel
    inputs, outputs, cut : str or iterable of str
        See `Setup`.

    Returns
    -------
    Setup
    """
    listed = [(x,) if isinstance(x, str) else tuple(x) for x in (inputs, outputs, cut)]
    return Setup(axis, listed[0], listed[1], listed[2])
