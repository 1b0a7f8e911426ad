"""What an operator holds down and types: it becomes values of inputs, step by step."""

import math
import time
from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any

from motionfmu.base.errors import InputError, suggestion
from motionfmu.live.live_machine import LiveMachine
from motionfmu.live.panel import Mdi, OperatorPanel, panel_of

PRESS = 0.01  # [s] of simulated time that a key is down, if its panel does not say it
DEAD_MAN = 0.1  # [s] on the wall without a sign of who holds a key, and it is let go
LINES_MAX = 256  # of MDI that wait until a controller has room for them
_NUMBER_MAX = 2**31 - 1


@dataclass
class _Held:
    """A key that is down: its value, what it becomes, by when a sign is due."""

    value: Any
    rest: Any
    until: float  # step
    deadline: float  # [s] on the wall


@dataclass
class _WaitingLines:
    """Lines of MDI that a controller has not got yet."""

    mdi: Mdi
    number: int  # of the latest that it was given
    waiting: deque[str] = field(default_factory=deque)


class ManualInputs:
    """Keys that are held, and lines that are typed."""

    def __init__(
        self, machine: LiveMachine, clock: Callable[[], float] = time.perf_counter
    ) -> None:
        self._machine, self._clock = machine, clock
        self._held: dict[str, _Held] = {}
        self._lines: dict[str, _WaitingLines] = {}
        components = machine.scenario.document.body.component
        panels = {component: panel_of(fmu) for component, fmu in components.items()}
        self.panels: dict[str, OperatorPanel] = {c: p for c, p in panels.items() if p is not None}

    def act(self) -> None:
        """Do what is due before the next step."""
        if not self._held and not self._lines:
            return
        now, wall = self._machine.steps, self._clock()
        for name in [n for n, h in self._held.items() if h.until <= now or h.deadline <= wall]:
            self._machine.set(name, self._held.pop(name).rest)
        for component in list(self._lines):
            self._type(component, self._lines[component])

    def dues(self) -> Iterable[float]:
        """Steps before which there is something to do."""
        if self._lines:
            yield self._machine.steps + 1
        yield from (h.until for h in self._held.values())

    def hold(self, name: str, value: Any, rest: Any, pace: float) -> None:
        """Set a variable for so long as this is called again; then it goes to rest."""
        seconds = DEAD_MAN * pace
        steps = math.inf if math.isinf(pace) else seconds / self._machine.step_seconds
        self._keep(name, value, rest, max(1.0, steps), DEAD_MAN)

    def press(self, name: str, value: Any, rest: Any) -> None:
        """Press a key and let it go."""
        component, _, variable = name.partition(".")
        panel = self.panels.get(component)
        key = panel.key.get(variable.partition("[")[0]) if panel else None
        seconds = PRESS if key is None else key.seconds
        self._keep(name, value, rest, seconds / self._machine.step_seconds, math.inf)
        self._cleared(name, value)

    def _keep(self, name: str, value: Any, rest: Any, steps: float, seconds: float) -> None:
        self._machine.checked(name, rest)
        held = self._held.get(name)
        if held is None or held.value != value:
            self._machine.set(name, value)
        if not math.isinf(steps):
            steps = self._machine.steps + max(1, round(steps))
        self._held[name] = _Held(value, rest, steps, self._clock() + seconds)

    def jog(self, component: str, axis: int, direction: float, pace: float) -> None:
        """Move an axis by hand for so long as this is called again; direction 0 lets go."""
        jog = self._panel(component).jog
        if jog is None:
            raise InputError(f"{component}: it is not moved by hand")
        whole = f"{component}.{jog.direction}"
        port = self._machine.scenario.resolver.end(whole, "", "").port
        if not 1 <= axis <= port.count:
            raise InputError(f"{whole}: axis {axis}: it has 1 to {port.count}")
        name = whole if port.count == 1 else f"{whole}[{axis}]"
        value: Any = direction
        if not port.type.startswith("Float"):
            if direction != int(direction):
                raise InputError(f"{name} = {direction}: -1, 0 or 1 wanted")
            value = int(direction)
        if direction == 0.0:
            self._held.pop(name, None)
            self._machine.set(name, value)
            return
        self.hold(name, value, type(value)(0), pace)

    def set(self, name: str, value: Any) -> None:
        """Set a variable for good."""
        self._held.pop(name, None)
        self._machine.set(name, value)
        self._cleared(name, value)

    def release(self) -> None:
        """Let go whatever is held."""
        for name in list(self._held):
            self._machine.set(name, self._held.pop(name).rest)

    def forget(self) -> None:
        """The machine has gone back: what was held and typed since is none."""
        self._held.clear()
        self._lines.clear()

    def mdi(self, component: str | None, line: str) -> int:
        """Give a controller a line to run, or several at once with LF between them; its number."""
        able = [c for c, p in self.panels.items() if p.mdi is not None]
        if component is None and len(able) == 1:
            component = able[0]
        if component is None:
            raise InputError(f"mdi: a component is wanted; lines are taken by {able or 'none'}")
        mdi = self._panel(component).mdi
        if mdi is None:
            raise InputError(f"{component}: it takes no lines")
        if "\r" in line:
            raise InputError("mdi: lines with LF between them are wanted, without CR")
        self._machine.checked(f"{component}.{mdi.line}", line)
        lines = self._lines.get(component)
        if lines is None:
            number = int(self._machine[f"{component}.{mdi.number}"])
            lines = self._lines[component] = _WaitingLines(mdi, number)
        if len(lines.waiting) >= LINES_MAX:
            raise InputError(f"mdi: {LINES_MAX} lines wait to be taken")
        lines.waiting.append(line)
        return _after(lines.number, len(lines.waiting))

    @property
    def waiting(self) -> int:
        """Lines that no controller has taken yet."""
        return sum(len(lines.waiting) for lines in self._lines.values())

    def _type(self, component: str, lines: _WaitingLines) -> None:
        """Give a controller its next line, if it has the last one and room."""
        mdi, machine = lines.mdi, self._machine
        if int(machine[f"{component}.{mdi.taken}"]) != lines.number:
            return
        if not lines.waiting:
            del self._lines[component]
            return
        need = len(lines.waiting[0].encode()) + 1
        if mdi.room is not None and machine[f"{component}.{mdi.room}"] < need:
            return
        lines.number = _after(lines.number, 1)
        machine.set(f"{component}.{mdi.line}", lines.waiting.popleft())
        machine.set(f"{component}.{mdi.number}", lines.number)

    def stop(self) -> list[str]:
        """Press the emergency stops of all components, or what aborts their motion."""
        self.release()
        self._lines.clear()
        stops = [f"{c}.{p.stop}" for c, p in self.panels.items() if p.stop is not None]
        aborts = [f"{c}.{a}" for c, p in self.panels.items() if (a := _abort(p)) is not None]
        free = self._machine.names[1]
        stops, aborts = ([n for n in names if n in free] for names in (stops, aborts))
        for name in stops:
            self._machine.set(name, True)
        if not stops and not aborts:
            raise InputError("no component has an emergency stop that is free, or an abort")
        if stops:
            return stops
        pressed = [n for n in aborts if self._aborts(n)]
        for name in pressed:
            self.press(name, True, False)
        return pressed

    def _aborts(self, name: str) -> bool:
        """Whether a key ends a motion now: one that does other things at rest, only in motion."""
        component, _, variable = name.partition(".")
        panel = self.panels[component]
        if variable == ABORT or panel.monitor is None or panel.state is None:
            return True
        states, watched = panel.monitor, int(self._machine[f"{component}.{panel.state}"])
        moving = [*states.running, *states.interrupted, *states.aborting]
        return watched in [*moving, *(s for by in states.by_hand.values() for s in by)]

    def _cleared(self, name: str, value: Any) -> None:
        """Lines that wait are gone when their controller is stopped."""
        component, _, variable = name.partition(".")
        panel = self.panels.get(component)
        if panel is not None and variable in (panel.stop, ABORT) and value:
            self._lines.pop(component, None)

    def _panel(self, component: str) -> OperatorPanel:
        if component in self.panels:
            return self.panels[component]
        known = self._machine.scenario.document.body.component
        if component in known:
            raise InputError(f"{component}: it has no panel")
        raise InputError(f"{component}: no such component{suggestion(component, known)}")


# The key that ends a motion, by its variable.
ABORT = "abort"


def _abort(panel: OperatorPanel) -> str | None:
    """The variable that ends a motion: its key, or what its monitor names."""
    if ABORT in panel.key:
        return ABORT
    return None if panel.monitor is None else panel.monitor.abort


def _after(number: int, count: int) -> int:
    """The number so many lines later: 1 follows the largest."""
    return (number + count - 1) % _NUMBER_MAX + 1
