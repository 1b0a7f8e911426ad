"""A machine for sessions of Grbl that does what it is told in so many looks, without an FMU."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

from motionfmu.live.grbl.grbl_controller import GrblController
from motionfmu.live.grbl.grbl_machine import MachineView
from motionfmu.live.grbl.grbl_settings import GrblSettings

LOOK = 0.005  # [s] of simulated time between two looks

PARAMETERS: dict[str, list[Any]] = {
    "active": [True] * 3 + [False] * 3,
    "lead": [10.0] * 6,
    "gear_ratio": [1.0] * 6,
    "ppr": [10000] * 6,
    "max_rpm": [3000.0] * 6,
    "acc_time": [0.1],
    "axis_acc": [0.0] * 6,
    "low_limit": [-250.0, -200.0, -400.0, 0.0, 0.0, 0.0],
    "high_limit": [250.0, 200.0, 0.0, 0.0, 0.0, 0.0],
    "lot_offset": [0.0] * 6,
    "hot_offset": [0.0] * 6,
    "check_over_travel": [True] * 3 + [False] * 3,
    "limit_mode": [-1],
    "pos2encoder_dir": [0] * 6,
    "home_order": [0] * 6,
    "home_dir": [1] * 6,
    "home_low_speed": [2.0] * 6,
    "home_high_speed": [20.0] * 6,
    "home_settle": [0.1],
    "home_offset": [0.0] * 6,
}
HOMES = PARAMETERS | {"home_order": [1, 1, 1, 0, 0, 0]}


class FakeMachine:
    """Takes orders, and shows itself.

    Attributes
    ----------
    lines : list of str
        All that it was given.
    looks : int
        So many are a line's motion; a line that moves nothing takes one.
    refusals : dict
        Fault by text of a line.
    """

    def __init__(self, looks: int = 3) -> None:
        self.count = 0
        self.lines: list[str] = []
        self.values: dict[str, Any] = {}
        self.pressed: list[str] = []
        self.refusals: dict[str, int] = {}
        self.looks, self._left, self._stops, self._slows = looks, 0, False, 0
        self.ahead = 256
        self.view = MachineView()
        self.homing: Callable[[MachineView], MachineView] | None = None

    def mdi(self, text: str) -> None:
        self.count += 1
        self.lines += text.split("\n")

    def set(self, name: str, value: Any) -> None:
        self.count += 1
        self.values[name] = value

    def press(self, name: str) -> None:
        self.count += 1
        self.pressed.append(name)
        view = self.view
        if name == "abort":
            self._left, self._stops = 0, False
            self.view = replace(view, lines=len(self.lines), done=len(self.lines), feed=0.0)
        elif name == "cycle_start" and self._stops:
            self._stops = False
            self.view = replace(view, done=view.done + 1)
        elif name == "clear_error":
            self.view = replace(view, error=0)
        elif name == "go_home" and self.homing:
            self.view = self.homing(replace(view, homed=False))

    def look(self) -> MachineView:
        """The machine a little later: it reads a line, and goes on with its motion."""
        view = self.view
        if view.lines < len(self.lines) and view.lines - view.done < self.ahead:
            number = view.lines + 1
            fault = self.refusals.get(self.lines[number - 1], 0)
            view = replace(view, lines=number)
            if fault:
                view = replace(view, fault=fault, refused=number)
        held = bool(self.values.get("hold")) or self._stops
        if view.done < view.lines and not held:
            moves = set("XYZ") & set(self.lines[view.done])
            self._left = (self._left or (self.looks if moves else 1)) - 1
            self._stops = not self._left and self.lines[view.done].endswith("M0")
            if not self._left and not self._stops:
                view = replace(view, done=view.done + 1)
        held = held or self._stops
        self._slows = self._slows + 1 if held and view.done < view.lines else 0
        status = 2 if self._slows > 1 else 0
        busy = view.done < view.lines and not held
        self.view = replace(
            view,
            time=view.time + LOOK,
            orders=self.count,
            status=status,
            feed=600.0 if busy else 0.0,
        )
        return self.view


class GrblDialogue:
    """A session with a machine that does nothing by itself."""

    def __init__(
        self, parameters: dict[str, list[Any]] | None = None, looks: int = 3, other: str = ""
    ) -> None:
        self.machine = FakeMachine(looks)
        self.controller = GrblController(GrblSettings(parameters or PARAMETERS), self.machine)
        self.controller.bar(other)
        self.controller.connect()

    def look(self, count: int = 1) -> str:
        """Look so often; what was sent."""
        text = ""
        for _ in range(count):
            self.controller.observe(self.machine.look())
            text += self.controller.sent().decode()
        return text

    def say(self, data: str | bytes, looks: int = 40) -> list[str]:
        """Send something; the lines that came."""
        self.controller.receive(data.encode("latin-1") if isinstance(data, str) else data)
        return self.look(looks).split("\r\n")[:-1]

    def begun(self) -> "GrblDialogue":
        """The same, behind its greeting."""
        self.look(40)
        return self


def words(texts: list[str], *beginnings: str) -> Iterator[str]:
    """Those lines that begin so."""
    return (t for t in texts if t.startswith(beginnings))
