"""Values of one axis of a scenario's components."""

from collections.abc import Mapping
from typing import Any

from motionfmu.run import Scenario
from motionfmu.scenario.system import System


class Values(Mapping[str, Any]):
    """Values of one axis of one component, asked for one by one."""

    # The axis counts from 1; a scalar is the same for all.

    def __init__(self, system: System, scenario: Scenario, component: str, axis: int) -> None:
        self._ports = scenario.resolver.ports[component]
        self._axis, self._component = axis, component
        self.given = {s.end.port.name: s.values for s in system.settings if self._mine(s.end)}
        self.given |= {s.end.port.name: s.values for s in system.stimuli if self._mine(s.end)}
        self.wired: dict[str, Any] = {}  # functions that give the value at the other end

    def _mine(self, end: Any) -> bool:
        return bool(end.component == self._component)

    def __getitem__(self, name: str) -> Any:
        port = self._ports[name]
        if name in self.wired:
            return self.wired[name]()
        if name in self.given:
            found = self.given[name]
        elif port.type == "String":
            found = (port.start or "",)
        else:
            kind: Any = {"Float64": float, "Int32": int, "Boolean": "true".__eq__}[port.type]
            found = tuple(kind(x) for x in (port.start or "").split())
        if not found:
            raise KeyError(name)
        return found[0] if not port.shape else found[self._axis - 1]

    def __iter__(self) -> Any:
        return iter(self._ports)

    def __len__(self) -> int:
        return len(self._ports)
