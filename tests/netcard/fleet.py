"""Cards as the page sees them, without a server: their answers are those of the safe policy."""

import asyncio
import hashlib
import time
from collections import deque
from dataclasses import dataclass, field, replace

import numpy as np

from motionfmu.cards import messages
from motionfmu.cards.card_job import FrameEvent as Switch
from motionfmu.cards.card_job import Job, decode, encode
from motionfmu.cards.card_settings import asked
from motionfmu.cards.config import CardConfig
from motionfmu.cards.views import (
    CardView,
    Code,
    CommandResult,
    ConfigurationResult,
    Event,
    SettingResult,
    Upload,
)

# State behind a command by the state before it; what is not here is refused with STATE.
TABLE = {
    ("READY", "start"): "RUNNING",
    ("PAUSED", "start"): "RUNNING",
    ("RUNNING", "pause"): "PAUSED",
    ("RUNNING", "stop"): "READY",
    ("PAUSED", "stop"): "READY",
    ("HOMING", "stop"): "READY",
    ("READY", "home"): "HOMING",
    ("EMPTY", "home"): "HOMING",
    ("FAULT", "reset"): "READY",
}


@dataclass
class Fleet:
    """Cards by id; `done` has all commands that were taken."""

    cards: dict[int, CardView] = field(default_factory=dict)
    done: list[tuple[int, str]] = field(default_factory=list)
    queues: list["asyncio.Queue[Event]"] = field(default_factory=list)
    going: bool = True  # an upload goes on

    def add(self, card: int, state: str = "EMPTY", connected: bool = True) -> CardView:
        view = CardView(card, connected, f"192.168.1.{50 + card}:49152", state, status())
        self.cards[card] = view
        return view

    def list(self) -> list[CardView]:
        return [
            replace(self.cards[k], events=deque(self.cards[k].events)) for k in sorted(self.cards)
        ]

    def tell(self, kind: str, card: int, text: str) -> None:
        event = Event(kind, card, text, time.time())
        if kind not in ("status", "progress"):
            self.cards[card].events.append(event)
        for queue in self.queues:
            queue.put_nowait(event)

    async def command(self, card: int, name: str, /, **values: int) -> CommandResult:
        view = self.cards.get(card, CardView(card))
        if not view.connected:
            return CommandResult.of(Code.OFFLINE)
        if (view.state, name) == ("EMPTY", "start"):
            return CommandResult.of(Code.NO_JOB, view.state)
        if (view.state, name) not in TABLE:
            return CommandResult.of(Code.STATE, view.state)
        self.done.append((card, name))
        self.move(card, TABLE[view.state, name])
        self.tell("result", card, f"{name}: done")
        return CommandResult.of(Code.DONE, view.state)

    def move(self, card: int, state: str) -> None:
        view = self.cards[card]
        view.state = state
        assert view.status
        view.status = replace(view.status, state=messages.State[state].value)
        self.tell("status", card, state)

    async def upload(self, card: int, job: bytes) -> CommandResult:
        view, digest = self.cards[card], hashlib.sha256(job).hexdigest()
        view.upload = Upload(digest, len(job) // 256)
        while view.upload.taken < view.upload.pages:
            view.upload.waits = "" if self.going else "the card is away"
            view.upload.taken += self.going
            self.tell("progress", card, "")
            await asyncio.sleep(0.01)
        view.upload, view.job, view.state = None, digest, "READY"
        self.tell("upload", card, f"job {digest[:8]} is in the card")
        return CommandResult.of(Code.DONE, "READY")

    async def configure(self, card: int, config: CardConfig) -> ConfigurationResult:
        view = self.cards.get(card, CardView(card))
        if not view.connected:
            return ConfigurationResult(CommandResult.of(Code.OFFLINE))
        value = asked(config)["speed_max", 0]
        busy = view.state not in ("EMPTY", "READY", "FAULT")
        end = CommandResult.of(Code.BUSY if busy else Code.DONE, view.state)
        self.done.append((card, f"speed_max {value}"))
        return ConfigurationResult(end, (SettingResult("speed_max", 0, 1000, value, False, end),))

    def subscribe(self) -> "asyncio.Queue[Event]":
        self.queues.append(asyncio.Queue())
        return self.queues[-1]

    def unsubscribe(self, queue: "asyncio.Queue[Event]") -> None:
        self.queues.remove(queue)


def status(**changes: object) -> messages.Status:
    values: dict[str, object] = {
        "state": 0,
        "error": 0,
        "inputs": 0b1001,
        "outputs": 1,
        "stock": 480,
        "job": 0,
        "frame": 0,
        "position": (10_000, 20_500, 0, 0),
        "underflows": 0,
        "switches": 0x30100,
        "load": (12, 41, 0, 0, 0, 103, 18),
        "rate": 1000,
        "wear": 7,
    }
    return messages.Status(**(values | changes))  # type: ignore[arg-type]


def circle(radius: float = 40.0, turns: int = 1) -> bytes:
    """A job of two axes of 1000 pulses/mm: pen down, a circle at up to 100 mm/s, pen up."""
    n = 2600 * turns
    share = np.cumsum(np.sin(np.linspace(0, np.pi, n)) ** 2)
    angle = 2 * np.pi * turns * share / share[-1]
    places = 1000 * radius * np.stack([1.0 - np.cos(angle), np.sin(angle)], axis=1)
    commands = np.zeros((n + 100, 4), np.int32)
    whole = np.round(np.vstack([[0, 0], places]))
    commands[50 : n + 50, :2] = np.diff(whole, axis=0)
    events = np.zeros(n + 100, int)
    events[10], events[n + 60] = 1, 2
    switches = [Switch(1, False, 1), Switch(1, False, 0)]
    scale, most = (1_000_000,) * 4, (200_000,) * 4
    job = Job(1_000_000, 3, commands, events, switches, scale, most, most, most)
    data = encode(job)
    assert len(decode(data).commands) == n + 100
    return data
