"""A test bench for the FMUs of one loop, where signals can be added to the values of wires."""

import math
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.freq.bench_loop import BenchLoop, Element, Ends
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

    def run(self, added: Array, stop: Ends | None = None) -> tuple[Array, Array]:
        """Run the FMUs with signals added at the inputs.

        Parameters
        ----------
        added : ndarray, shape (steps, n_inputs)
            A row for each communication step. A whole-number input gets the nearest one.
        stop : callable, optional
            Given the outputs so far, a row for each communication point; the number of rows with
            which the run ends, or None if it goes on.

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
        lead = self.lead
        # to where the signal begins without a jump, which would raise an alarm
        begun = [0.5 - 0.5 * math.cos(math.pi * k / lead) for k in range(lead)]
        rows = np.concatenate([np.outer(begun, added[0]), added]) if lead else added
        late: Ends | None = None
        if stop is not None:

            def late(shown: Array) -> int | None:
                found = stop(shown[lead:]) if len(shown) > lead else None
                return None if found is None else lead + found

        with self._slaves() as slaves:
            loop = BenchLoop(slaves, self.step_ns)
            for w in self.system.wires:
                if _target(w) not in self.entries:
                    loop.wire(w, self._offset(w))
            for port in self.exits:
                loop.output(self._element(port))
            for port in self.entries:
                self._tap(loop, port)
            shown, used = loop.run(rows, late)
        return shown[lead:], used[lead:]

    def _element(self, port: Port) -> Element:
        component, name = port
        ports = self.axis.scenario.resolver.ports[component]
        return Element(component, *element(ports, name, self.axis.axis))

    def _tap(self, loop: BenchLoop, port: Port) -> None:
        name, own = ".".join(port), self._element(port)
        given = next((values for end, values in self.given if end.name == name), None)
        start = given or self.own(*port, _start(own.port, own.place))
        wire = next((w for w in self.system.wires if _target(w) == port), None)
        source = None
        if wire is not None:
            source = self._element((wire.source.component, wire.source.port.name))
        gain, delay = self.setup.gains.get(name, 1.0), self.setup.delays.get(name, 0)
        loop.tap(own, start, source, gain, delay)


def _target(wire: Wire) -> Port:
    return wire.target.component, wire.target.port.name


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
