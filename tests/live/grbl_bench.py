"""A Grbl session at a real machine, in simulated time: the same at any speed of the computer."""

from collections import deque
from collections.abc import Callable, Mapping
from typing import Any

from motionfmu.live import LiveMachine
from motionfmu.live.grbl.grbl_binding import GrblBinding
from motionfmu.live.machine_about import about
from motionfmu.run.machine_program import machine

TURN = 10  # communication steps between two looks
PRESS = 100  # communication steps that a key is down


class DirectOrders:
    """Orders that are carried out before the next step."""

    def __init__(self, live: LiveMachine, binding: GrblBinding) -> None:
        self._live, self._name = live, binding.component
        self._variables = binding.variables
        self.count = 0
        self.texts: deque[str] = deque()
        self.given: list[str] = []
        self._number = 0
        self._down: dict[str, int] = {}

    def mdi(self, text: str) -> None:
        self.count += 1
        self.texts.append(text)
        self.given += text.split("\n")

    def set(self, name: str, value: Any) -> None:
        self.count += 1
        if name in self._variables:
            self._live.set(f"{self._name}.{name}", value)

    def press(self, name: str) -> None:
        self.count += 1
        if name == "abort":
            self.texts.clear()
        self._live.set(f"{self._name}.{name}", True)
        self._down[name] = self._live.steps + PRESS

    def act(self) -> None:
        """What is due before a step."""
        for name in [n for n, until in self._down.items() if until <= self._live.steps]:
            self._live.set(f"{self._name}.{name}", False)
            del self._down[name]
        taken = self._live[f"{self._name}.mdi_taken"]
        if self.texts and taken == self._number:
            self._number += 1
            self._live.set(f"{self._name}.mdi", self.texts.popleft())
            self._live.set(f"{self._name}.mdi_seq", self._number)


class GrblBench:
    """A session with a machine of the library."""

    def __init__(self, name: str = "mill3", set: Mapping[str, Any] | None = None) -> None:
        self.live = LiveMachine(machine(name).plan(), set)
        self.binding = GrblBinding(about(self.live))
        self.orders = DirectOrders(self.live, self.binding)
        self.controller = self.binding.controller(self.orders)
        self.controller.connect()
        self.text = ""

    @property
    def name(self) -> str:
        """The session's state."""
        return self.controller.name

    def turn(self, look: Callable[[], None] = lambda: None) -> str:
        """Go on for a turn, with a look behind each step; what was sent."""
        for _ in range(TURN):
            self.orders.act()
            self.live.step()
            look()
        names = self.binding.names
        values = dict(zip(names, self.live.read(names), strict=True))
        self.controller.observe(self.binding.view(self.live.time, self.orders.count, values))
        sent = self.controller.sent().decode()
        self.text += sent
        return sent

    def go(self, seconds: float) -> list[str]:
        """Go on so long; the lines that came."""
        text = "".join(self.turn() for _ in range(round(seconds * 1e4 / TURN)))
        return text.split("\r\n")[:-1]

    def say(self, data: str, seconds: float = 0.2) -> list[str]:
        """Send something; the lines that came."""
        self.controller.receive(data.encode("latin-1"))
        return self.go(seconds)

    def until(self, beginning: str, data: str = "", seconds: float = 60.0) -> list[str]:
        """Send something and go on until a line comes that begins so."""
        self.controller.receive(data.encode("latin-1"))
        text, end = "", self.live.time + seconds
        while not any(line.startswith(beginning) for line in text.split("\r\n")):
            assert self.live.time < end, text
            text += self.turn()
        return text.split("\r\n")[:-1]

    def idle(self, seconds: float = 60.0) -> str:
        """Go on until it rests; the report."""
        end = self.live.time + seconds
        while not (report := self.until("<", "?")[-1]).startswith("<Idle|"):
            assert self.live.time < end, report
        return report

    def __enter__(self) -> "GrblBench":
        return self

    def __exit__(self, *error: object) -> None:
        self.live.close()
