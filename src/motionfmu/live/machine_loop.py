"""The loop of a live machine: it keeps the pace and does what is asked between two steps."""

import contextlib
import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from queue import Empty, SimpleQueue
from typing import Any

from motionfmu.base.errors import InputError
from motionfmu.live.exchange import Exchange
from motionfmu.live.live_machine import LiveMachine
from motionfmu.live.pace import Pace
from motionfmu.live.panel import panel_of

TURN = 1e-3  # [s] on the wall between two looks at what is asked
LONGEST = 5e-3  # [s] on the wall that steps of a turn may take
KEPT_EVERY = 1.0  # [s] of simulated time between two states that are kept
PRESS = 0.01  # [s] of simulated time that a key is down
DEAD_MAN = 0.1  # [s] of simulated time without a sign of who holds a key, and it is let go
STEPS_MAX = 1 << 40  # more than are ever made at once
ACTIONS = 40  # latest ones of the journal in a frame


@dataclass(frozen=True)
class Asked:
    """A request, and where its answer goes: a value, or the text of an error."""

    name: str
    arguments: Mapping[str, Any]
    answer: Callable[[Any, str | None], None]


@dataclass
class _Held:
    """A key that is held down: what it becomes, and the step by which a sign is due."""

    rest: Any
    until: int


@dataclass
class MachineLoop:
    """Steps a machine at a pace.

    Attributes
    ----------
    machine : LiveMachine
    pace : Pace
    running : bool
    """

    machine: LiveMachine
    pace: Pace = field(default_factory=Pace)
    running: bool = True
    ended: bool = False
    error: str = ""
    exchange: Exchange | None = None  # with another program
    asked: SimpleQueue[Asked] = field(default_factory=SimpleQueue)

    def __post_init__(self) -> None:
        self._ring = self.machine.ring(())
        self._held: dict[str, _Held] = {}
        self._keep_at = 0
        self._turn_steps = max(1, round(TURN / self.machine.step_seconds))
        if self.exchange is not None:
            self._turn_steps = min(self._turn_steps, self.exchange.plan.every)
        self._quick = 1  # steps of a turn as fast as it goes

    def run(self) -> None:
        """Run until it is told to end."""
        while not self.ended:
            self._answer(wait=not self.running)
            if self.running and not self.ended:
                self._turn()

    def _answer(self, wait: bool) -> None:
        """Do what is asked; if the machine stands, wait for it."""
        with contextlib.suppress(Empty):
            asked = self.asked.get(timeout=0.1) if wait else self.asked.get_nowait()
            while True:
                self._do(asked)
                asked = self.asked.get_nowait()

    def _do(self, asked: Asked) -> None:
        act = getattr(self, f"do_{asked.name}", None)
        try:
            if act is None:
                raise InputError(f"{asked.name}: no such request")
            asked.answer(act(**asked.arguments), None)
        except (InputError, ValueError) as error:
            asked.answer(None, str(error))
        except TypeError:
            asked.answer(None, f"{asked.name}: wrong arguments {sorted(asked.arguments)}")

    def _turn(self) -> None:
        """Wait until it is time, and make the steps of a turn."""
        if self.pace.factor == math.inf:
            count, began = self._quick, time.perf_counter()
            self.advance(count)
            took = max(time.perf_counter() - began, 1e-6)
            self._quick = max(1, min(2 * count, int(count * LONGEST / took)))
            return
        self.pace.wait(self.machine.time)
        self.advance(max(1, round(self._turn_steps * self.pace.factor)))

    def advance(self, count: int) -> None:
        """Make steps; let go what is held no longer, keep states."""
        end = self.machine.steps + count
        try:
            while self.machine.steps < end:
                now = self.machine.steps
                self._let_go(now)
                if now >= self._keep_at:
                    self.machine.keep()
                    self._keep_at = now + round(KEPT_EVERY / self.machine.step_seconds)
                dues = (
                    self._keep_at,
                    end,
                    self._exchanged(now),
                    *(h.until for h in self._held.values()),
                )
                self.machine.fill(self._ring, min(dues) - now)
        except InputError as error:
            self.running, self.error = False, str(error)

    def _exchanged(self, now: int) -> int:
        """Exchange if it is time; the step at which it is next, or one far away."""
        if self.exchange is None:
            return now + STEPS_MAX
        every = self.exchange.plan.every
        if now % every == 0:
            self.exchange.step()
        return now - now % every + every

    def _let_go(self, now: int) -> None:
        for name in [n for n, h in self._held.items() if h.until <= now]:
            self.machine.set(name, self._held.pop(name).rest)

    def do_frame(self, names: list[str] | None = None, since: int | None = None) -> dict[str, Any]:
        """The present state, and values of signals; actions since a number of them."""
        machine, late = self.machine, self.pace.lateness
        given = [] if names is None else machine.read(names)
        kept = machine.kept
        return {
            "time": machine.time,
            "steps": machine.steps,
            "running": self.running,
            "pace": None if self.pace.factor == math.inf else self.pace.factor,
            "error": self.error,
            "values": dict(zip(names or (), given, strict=True)),
            "kept": [kept[0], kept[-1], len(kept)] if kept else None,
            "late": [late.woken, late.worst, late.below(0.99), late.given_up],
            "actions": len(machine.journal),
        }

    def do_journal(self, last: int = ACTIONS) -> list[list[Any]]:
        """The latest actions: time [s], name, values."""
        step = self.machine.step_seconds
        return [[a.step * step, a.name, list(a.values)] for a in list(self.machine.journal)[-last:]]

    def do_set(self, name: str, value: Any) -> float:
        """Set a variable; the time from which it acts [s]."""
        self._held.pop(name, None)
        self.machine.set(name, value)
        return self.machine.time

    def do_press(self, name: str, value: Any = True, rest: Any = False) -> float:
        """Press a key and let it go."""
        return self.do_hold(name, value, rest, PRESS)

    def do_hold(self, name: str, value: Any, rest: Any = 0, seconds: float = DEAD_MAN) -> float:
        """Set a variable for so long as this is asked again; then it goes to rest."""
        if name not in self._held or self.machine[name] != value:
            self.machine.set(name, value)
        steps = max(1, round(seconds / self.machine.step_seconds))
        self._held[name] = _Held(rest, self.machine.steps + steps)
        return self.machine.time

    def do_release(self) -> None:
        """Let go whatever is held."""
        for name in list(self._held):
            self.machine.set(name, self._held.pop(name).rest)

    def do_command(self, component: str, name: str) -> float:
        """Give a command that the component's panel has."""
        panel = panel_of(self.machine.scenario.document.body.component.get(component, ""))
        command = panel.command if panel else None
        if command is None or name not in command.codes:
            raise InputError(f"{component}: no command {name!r}")
        self.machine.set(f"{component}.{command.code}", command.codes[name])
        number = f"{component}.{command.number}"
        self.machine.set(number, int(self.machine[number]) + 1)
        return self.machine.time

    def do_pace(self, factor: float | None) -> None:
        """Go at another pace; none: as fast as it goes."""
        self.pace.set(math.inf if factor is None else factor)

    def do_go(self) -> None:
        """Go on after a pause."""
        if self.error:
            raise InputError(f"{self.error}: go back to an earlier state")
        self.pace.halt()
        self.running = True

    def do_pause(self) -> None:
        """Stand."""
        self.running = False

    def do_step(self, count: int = 1) -> float:
        """Make steps while it stands."""
        if self.running:
            raise InputError("it runs: pause it first")
        self.advance(count)
        return self.machine.time

    def do_back(self, time: float) -> float:
        """Go back to a state that was kept, and stand there."""
        self.running = False
        there = self.machine.back(time)
        self._held.clear()
        self._keep_at = self.machine.steps
        self._ring.cut(self.machine.steps)
        self.pace.halt()
        self.error = ""
        return there

    def do_save(self, folder: str, check: Mapping[str, Any] | None = None) -> str:
        """Save what was done as a scenario."""
        return str(self.machine.save(folder, check))

    def do_channels(self, names: list[str]) -> None:
        """Look at other channels from now on."""
        self._ring = self.machine.ring(names)

    def do_samples(self, since: int, most: int = 1 << 16) -> tuple[dict[str, Any], bytes]:
        """Samples of the channels from a step on, the latest ones: doubles, row by row."""
        begin, rows = self._ring.since(since, most)
        about = {"begin": begin, "rows": len(rows), "channels": list(self._ring.channels)}
        return about, rows.tobytes()

    def do_end(self) -> None:
        """End."""
        self.ended = True
