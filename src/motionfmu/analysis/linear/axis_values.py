"""Values of one axis of a scenario's components."""

from collections.abc import Mapping
from typing import Any

from motionfmu.run import Scenario
from motionfmu.scenarios.fmus import Port
from motionfmu.scenarios.system import System


def element(ports: Mapping[str, Port], name: str, axis: int) -> tuple[Port, int]:
    """The port of a name, and which element of it is meant, from 0; a KeyError if unknown.

    ``torque`` is the element of the axis, which counts from 1, ``torque[3]`` and ``center[3,1]``
    are their own; a scalar has one element.
    """
    whole, bracket, inside = name.partition("[")
    port = ports[whole]
    if not bracket:
        return port, axis - 1 if port.shape else 0
    places = [int(k) for k in inside.rstrip("]").split(",")]
    inner = port.shape[-1] if len(places) > 1 else 1
    return port, (places[0] - 1) * inner + (places[1] - 1 if len(places) > 1 else 0)


class AxisValues(Mapping[str, Any]):
    """Values of one axis of one component, which notes the names that are read."""

    # The axis counts from 1; all axes share a scalar.

    def __init__(self, system: System, scenario: Scenario, component: str, axis: int) -> None:
        self._ports = scenario.resolver.ports[component]
        self._axis, self._component = axis, component
        self.given = {s.end.port.name: s.values for s in system.settings if self._mine(s.end)}
        self.given |= {s.end.port.name: s.values for s in system.stimuli if self._mine(s.end)}
        self.wired: dict[str, Any] = {}  # functions that give the value at the other end
        self.asked: set[str] = set()  # names on which a model made of it depends

    def _mine(self, end: Any) -> bool:
        return bool(end.component == self._component)

    def __getitem__(self, name: str) -> Any:
        port, place = element(self._ports, name, self._axis)
        if port.name in self.wired:
            value = self.wired[port.name]()
            self.asked.add(name)
            return value
        if port.name in self.given:
            found = self.given[port.name]
        elif port.type == "String":
            found = (port.start or "",)
        else:
            kind: Any = {"Float64": float, "Int32": int, "Boolean": "true".__eq__}[port.type]
            found = tuple(kind(x) for x in (port.start or "").split())
        if not found:
            raise KeyError(name)
        self.asked.add(name)
        return found[place]

    def __iter__(self) -> Any:
        return iter(self._ports)

    def __len__(self) -> int:
        return len(self._ports)
