"""The loop of a live machine: it keeps the pace and does what is asked between two steps."""

import contextlib
import math
import sys
import threading
import time
import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import Any

from motionfmu.base.errors import InputError
from motionfmu.live.exchange import Exchange
from motionfmu.live.live_machine import LiveMachine
from motionfmu.live.live_scope import LiveScope
from motionfmu.live.manual_inputs import ManualInputs
from motionfmu.live.pace import Pace
from motionfmu.live.scope_trigger import TriggeredRecording, TriggerSetting

TURN = 1e-3  # [s] on the wall between two looks at what is asked
LONGEST_TURN = 5e-3  # [s] on the wall that steps of a turn may take
KEPT_EVERY = 1.0  # [s] of simulated time between two states that are kept
STEPS_MAX = 1 << 40  # more than are ever made at once
ACTIONS = 40  # latest ones of the journal that are given
_LATER = object()  # instead of a value: the answer comes when something has ended

Tell = Callable[[dict[str, Any], bytes], None]


@dataclass(frozen=True)
class LoopRequest:
    """A request, and where its answer goes: a value, or the text of an error."""

    name: str
    arguments: Mapping[str, Any]
    answer: Callable[[Any, str | None], None]


@dataclass
class MachineLoop:
    """Steps a machine at a pace."""

    machine: LiveMachine
    pace: Pace = field(default_factory=Pace)
    running: bool = True
    ended: bool = False
    error: str = ""
    tell: Tell = lambda message, data: None
    exchange: Exchange | None = None  # with another program
    asked: SimpleQueue[LoopRequest] = field(default_factory=SimpleQueue)

    def __post_init__(self) -> None:
        self._scope = LiveScope(self.machine, self._triggered)
        self._inputs = ManualInputs(self.machine, self.pace.clock)
        self._keep_at = 0
        self._turn_steps = max(1, round(TURN / self.machine.step_seconds))
        if self.exchange is not None:
            self._turn_steps = min(self._turn_steps, self.exchange.plan.every)
        self._quick = 1  # steps of a turn as fast as it goes
        self._goal: int | None = None  # step up to which single steps are to be made
        self._now: LoopRequest | None = None  # what is being done
        self._stepping: LoopRequest | None = None  # what gets an answer when the goal is reached

    def run(self) -> None:
        """Run until it is told to end."""
        while not self.ended:
            self._answer(wait=not self._busy)
            if self._busy and not self.ended:  # not if a pause has just been asked for
                self._turn()
        for record in self._scope.end_records():
            record.passed(10.0)

    @property
    def _busy(self) -> bool:
        return self.running or self._goal is not None

    def _answer(self, wait: bool) -> None:
        """Do what is asked; if the machine stands, wait for it."""
        with contextlib.suppress(Empty):
            asked = self.asked.get(timeout=0.1) if wait else self.asked.get_nowait()
            while True:
                self._do(asked)
                asked = self.asked.get_nowait()

    def _do(self, asked: LoopRequest) -> None:
        act = getattr(self, f"do_{asked.name}", None)
        self._now = asked
        try:
            if act is None:
                raise InputError(f"{asked.name}: no such request")
            value = act(**asked.arguments)
        except (InputError, ValueError) as error:
            asked.answer(None, str(error))
        except Exception as error:  # a mistake here must not end a machine at which one works
            traceback.print_exc(file=sys.stderr)
            asked.answer(None, f"{asked.name}: {type(error).__name__}: {error}")
        else:
            if value is not _LATER:
                asked.answer(value, None)

    def _turn(self) -> None:
        """Wait until it is time, and make the steps of a turn."""
        if self._goal is not None:
            self._quick_turn(self._goal)
            if self.machine.steps >= self._goal or self.error:
                self._end_steps()
        elif self.pace.factor == math.inf:
            self._quick_turn(None)
        else:
            self.pace.wait(self.machine.time)
            self.advance(max(1, round(self._turn_steps * self.pace.factor)))

    def _quick_turn(self, goal: int | None) -> None:
        """Make as many steps as a turn has time for."""
        count, began = self._quick, time.perf_counter()
        self.advance(count if goal is None else min(count, goal - self.machine.steps))
        took = max(time.perf_counter() - began, 1e-6)
        self._quick = max(1, min(2 * count, int(count * LONGEST_TURN / took)))

    def _end_steps(self) -> None:
        """Single steps have been made, or something else is to be done."""
        asked, self._stepping, self._goal = self._stepping, None, None
        if asked is not None:
            asked.answer(self.machine.time, self.error or None)

    def advance(self, count: int) -> None:
        """Make steps; let go what is held no longer, keep states."""
        end = self.machine.steps + count
        try:
            while self.machine.steps < end:
                self._inputs.act()
                now = self.machine.steps
                if now >= self._keep_at:
                    self.machine.keep()
                    self._keep_at = now + round(KEPT_EVERY / self.machine.step_seconds)
                dues = (self._keep_at, end, self._exchanged(now), *self._inputs.dues())
                self._scope.fill(max(1, int(min(dues)) - now))
        except InputError as error:
            self.running, self.error = False, str(error)

    def _triggered(self, found: TriggeredRecording) -> None:
        about = found.about(self.machine.step_seconds)
        self.tell({"told": "triggered", "value": about}, found.rows.tobytes())

    def _exchanged(self, now: int) -> int:
        """Exchange if it is time; the step at which it is next, or one far away."""
        if self.exchange is None:
            return now + STEPS_MAX
        every = self.exchange.plan.every
        if now % every == 0:
            was_lost = self.exchange.lost
            self.exchange.step()
            if self.exchange.lost != was_lost:
                self.tell({"told": "peer", **self.exchange.state()}, b"")
        return now - now % every + every

    # What can be asked. The server's table of requests says what each is for.

    def do_frame(self, names: list[str] | None = None) -> dict[str, Any]:
        """The present state, and values of signals."""
        machine, late = self.machine, self.pace.lateness
        kept = machine.kept
        return {
            "time": machine.time,
            "steps": machine.steps,
            "running": self.running,
            "pace": None if self.pace.factor == math.inf else self.pace.factor,
            "error": self.error,
            "values": self.do_values(names or []),
            "kept": [kept[0], kept[-1], len(kept)] if kept else None,
            "late": [late.woken, late.worst, late.below(0.99), late.given_up],
            "actions": len(machine.journal),
            "lines": self._inputs.waiting,
            "scope": self._scope.state(),
            "exchange": self.exchange and self.exchange.state(),
        }

    def do_values(self, names: list[str]) -> dict[str, Any]:
        """Present values of whole signals, by name."""
        return dict(zip(names, self.machine.read(names), strict=True))

    def do_journal(self, last: int = ACTIONS) -> list[list[Any]]:
        """The latest actions: time [s], name, values."""
        step = self.machine.step_seconds
        latest = self.machine.journal.latest(last)
        return [[a.step * step, a.name, list(a.values)] for a in latest]

    def do_changed(self) -> dict[str, list[list[Any]]]:
        """What has another value than at the beginning: that, and the present one."""
        pairs = self.machine.changed_values.items()
        return {name: [list(first), list(now)] for name, (first, now) in pairs}

    def do_undo(self, name: str) -> float:
        """Give a variable the value that it had at the beginning."""
        whole, values = self.machine.first(name)
        self._inputs.set(whole, values)
        return self.machine.time

    def do_set(self, name: str, value: Any) -> float:
        """Set a variable; the time from which it acts [s]."""
        self._inputs.set(name, value)
        return self.machine.time

    def do_press(self, name: str, value: Any = True, rest: Any = False) -> float:
        """Press a key and let it go."""
        self._inputs.press(name, value, rest)
        return self.machine.time

    def do_hold(self, name: str, value: Any, rest: Any = 0) -> float:
        """Set a variable for so long as this is asked again; then it goes to rest."""
        self._inputs.hold(name, value, rest, self.pace.factor)
        return self.machine.time

    def do_jog(self, component: str, axis: int, direction: float) -> float:
        """Move an axis for so long as this is asked again."""
        self._inputs.jog(component, axis, direction, self.pace.factor)
        return self.machine.time

    def do_mdi(self, line: str, component: str | None = None) -> dict[str, int]:
        """Give a controller a line to run."""
        return {"number": self._inputs.mdi(component, line)}

    def do_release(self) -> None:
        """Let go whatever is held."""
        self._inputs.release()

    def do_stop(self) -> list[str]:
        """Stop the machine; what was set for that."""
        return self._inputs.stop()

    def do_command(self, component: str, name: str) -> float:
        """Give a command that the component's panel has."""
        panel = self._inputs.panels.get(component)
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
        self._end_steps()
        self.pace.halt()
        self.running = True

    def do_pause(self) -> None:
        """Stand."""
        self._end_steps()
        self.running = False

    def do_step(self, count: int = 1) -> Any:
        """Make steps while it stands; answers when they are made, or something ends them."""
        if self.running:
            raise InputError("it runs: pause it first")
        if self.error:
            raise InputError(f"{self.error}: go back to an earlier state")
        self._end_steps()
        self._goal, self._stepping = self.machine.steps + count, self._now
        return _LATER

    def do_back(self, time: float) -> float:
        """Go back to a state that was kept, and stand there."""
        self._end_steps()
        self.running = False
        there = self.machine.back(time)
        self._inputs.forget()
        self._keep_at = self.machine.steps + round(KEPT_EVERY / self.machine.step_seconds)
        self._scope.back()
        self.pace.halt()
        self.error = ""
        return there

    def do_kept(self) -> list[float]:
        """Times [s] of the states that one can go back to."""
        return self.machine.kept

    def do_lateness(self) -> dict[str, Any]:
        """How late the machine was woken, as a histogram."""
        late = self.pace.lateness
        ends = [2.0**k / 64e3 for k in range(len(late.counts))]
        return {"ends": ends, "counts": late.counts, "worst": late.worst}

    def do_save(
        self,
        folder: str,
        check: Mapping[str, Any] | None = None,
        begin: float | None = None,
        ends: Mapping[str, float] | None = None,
    ) -> str:
        """Save what was done as a scenario."""
        return str(self.machine.save(folder, check, begin, ends))

    def do_checks(self, names: list[str] | None = None) -> dict[str, Any]:
        """Figures of which checks are made: present values; least and largest ones in the scope."""
        values = self.do_values(names or [])
        return {"values": values, "seen": self._scope.seen(), "time": self.machine.time}

    def do_channels(self, names: list[str]) -> None:
        """Look at other channels from now on."""
        self._scope.channels(names)

    def do_samples(self, since: int, most: int = 1 << 16) -> tuple[dict[str, Any], bytes]:
        """Samples of the channels from a step on, the latest ones: doubles, row by row."""
        ring = self._scope.ring
        begin, rows = ring.since(since, most)
        about = {"begin": begin, "rows": len(rows), "channels": list(ring.channels)}
        return about, rows.tobytes()

    def do_part(self, begin: int, end: int | None, most: int) -> tuple[dict[str, Any], bytes]:
        """The first samples that there are of those between two steps, and what they are."""
        ring = self._scope.ring
        first = min(max(begin, ring.begin), ring.end)
        last = max(first, min(ring.end if end is None else end, ring.end, first + most))
        rows = ring.between(first, last)
        about = {
            "begin": first,
            "end": ring.end,
            "rows": len(rows),
            "channels": list(ring.channels),
            "units": [self.machine.unit(c) for c in ring.channels],
            "step_ns": self.machine.step_ns,
        }
        return about, rows.tobytes()

    def do_trigger(self, channel: str | None = None, **setting: Any) -> None:
        """Wait for an event in a channel; without one, for none."""
        chosen = None if channel is None else TriggerSetting(channel, **setting)
        self._scope.trigger(chosen)

    def do_recordings(self) -> list[dict[str, Any]]:
        """Triggered recordings that can be had again, the oldest first."""
        return [r.about(self.machine.step_seconds) for r in self._scope.recordings]

    def do_recording(self, number: int = -1) -> tuple[dict[str, Any], bytes]:
        """One of them, by its place in the list."""
        try:
            found = self._scope.recordings[number]
        except IndexError:
            count = len(self._scope.recordings)
            raise InputError(f"recording {number}: there are {count}, from 0") from None
        return found.about(self.machine.step_seconds), found.rows.tobytes()

    def do_record(
        self, file: str | None = None, begin: int | None = None, end: int | None = None
    ) -> Any:
        """Write the channels into a file; without one, end this: answers when files are whole."""
        if file is not None:
            return self._scope.record(Path(file), begin, end)
        ended, asked = self._scope.end_records(), self._now
        assert asked is not None

        def wait() -> None:
            for record in ended:
                record.whole()
            asked.answer([record.name for record in ended], None)

        threading.Thread(target=wait, daemon=True).start()
        return _LATER

    def do_end(self) -> None:
        """End."""
        self.ended = True
