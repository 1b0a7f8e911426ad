"""The server of network cards: many cards on one event loop."""

import asyncio
import ipaddress
import logging
import os
import socket
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from motionfmu.base.errors import InputError
from motionfmu.base.toml_lines import shown
from motionfmu.cards import messages as m
from motionfmu.cards.card_settings import Key, asked, numbers
from motionfmu.cards.connection import READ_MAX, CardConnection, ConnectionLimits
from motionfmu.cards.keys import CARD_MAX, Keys
from motionfmu.cards.outbox import Outbox
from motionfmu.cards.remote import RemoteCard
from motionfmu.cards.views import (
    FLEETING,
    CardView,
    Code,
    CommandResult,
    ConfigurationResult,
    Event,
)

if TYPE_CHECKING:
    import ssl

    from motionfmu.cards.config import CardConfig

LOG = logging.getLogger("motionfmu.cards")
PORT = 8765
WATCH = 0.1  # [s] between two looks at the clock
QUEUE_MAX = 1000  # events
JOB_MAX = 8192  # pages of the largest flash
JOB_MAGIC = b"MCJ1"

# Fields of each command behind its number: name and highest value.
_COMMANDS: dict[str, tuple[Callable[..., m.Message], dict[str, int]]] = {
    "start": (m.Start, {}),
    "pause": (m.Pause, {}),
    "stop": (m.Stop, {}),
    "home": (m.Home, {"axes": 15}),
    "reset": (m.Reset, {}),
    "output": (m.Output, {"pins": 0xFFFF, "mode": 1, "level": 1, "width": 1_000_000}),
}


def is_local(host: str) -> bool:
    """Whether an address can be reached from this machine only."""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


def check_card(card: int) -> None:
    """InputError if this is no id of a card."""
    if type(card) is not int or not 0 <= card <= CARD_MAX:
        raise InputError(f"{shown(card)} is no id of a card, 0 to {CARD_MAX}")


def check_port(port: int) -> None:
    """InputError if this is no port; 0: the system chooses."""
    if not 0 <= port <= 65535:
        raise InputError(f"{port} is no port, 0 to 65535")


def check_job(job: bytes) -> None:
    """InputError if these bytes cannot be a job file."""
    if len(job) % m.PAGE or not 2 <= len(job) // m.PAGE <= JOB_MAX:
        raise InputError(f"no job file: {len(job)} bytes, not 2 to {JOB_MAX} pages of {m.PAGE}")
    if not job.startswith(JOB_MAGIC):
        raise InputError(f"no job file: it begins with {job[:4]!r}, not {JOB_MAGIC!r}")


class Cards:
    """All cards of one server; everything runs on the event loop that called `listen`."""

    def __init__(
        self, folder: Path, limits: ConnectionLimits | None = None, keys: Path | None = None
    ) -> None:
        self.limits = limits or ConnectionLimits()
        self.buffer = bytearray(READ_MAX)
        self.dropped = 0  # lines of the log
        self._folder, self._key_file = folder, keys or folder / "keys.toml"
        self._keys: Keys | None = None
        self._cards: dict[int, RemoteCard] = {}
        self._lines: set[CardConnection] = set()
        self._queues: list[asyncio.Queue[Event]] = []
        self._second, self._logged = 0, 0
        self._server: asyncio.Server | None = None
        self._watching: asyncio.Task[None] | None = None

    async def listen(
        self, host: str = "127.0.0.1", port: int = PORT, tls: "ssl.SSLContext | None" = None
    ) -> int:
        """Take connections of cards; returns the port, chosen by the system if 0 was given."""
        keys = self._keys = Keys(self._key_file, demanded=not is_local(host))
        if not is_local(host) and not len(keys):
            raise InputError(f"{host}: cards from outside need keys, {self._key_file} has none")
        check_port(port)
        loop = asyncio.get_running_loop()
        self._folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        for place in sorted(self._folder.iterdir()):
            if place.name.isdecimal() and int(place.name) <= CARD_MAX:
                self._card(int(place.name))
        try:
            self._server = await loop.create_server(
                lambda: CardConnection(self, keys.of, loop.time),
                host,
                port,
                ssl=tls,
                ssl_handshake_timeout=self.limits.authenticate if tls else None,
            )
        except OSError as error:
            known = not isinstance(error, socket.gaierror) and error.errno
            told = os.strerror(error.errno or 0) if known else error.strerror
            raise InputError(f"{host}:{port}: {told}") from None
        self._watching = loop.create_task(self._watch())
        return int(self._server.sockets[0].getsockname()[1])

    async def close(self) -> None:
        """Close all connections; what waits in the folder stays there."""
        if self._watching:
            self._watching.cancel()
        if self._server:
            self._server.close()
        for line in list(self._lines):
            line.drop("the server ends")
        await asyncio.sleep(0)  # the lines say that they are closed

    def list(self) -> list[CardView]:
        """All cards that were heard or have a job waiting, by id."""
        return [self._cards[i].view() for i in sorted(self._cards)]

    async def command(self, card: int, name: str, /, **values: int) -> CommandResult:
        """Do start, pause, stop, home (axes), reset or output (pins, mode, level, width).

        Faults of the card or the link raise nothing; the CommandResult tells them. InputError for a
        name or a value that no card knows.
        """
        if name not in _COMMANDS:
            raise InputError(f"no command {shown(name)} (there are: {', '.join(_COMMANDS)})")
        kind, most = _COMMANDS[name]
        if name == "home":
            values = {"axes": 15} | values
        for field, value in values.items():
            if field not in most:
                raise InputError(f"{name} has no {shown(field)}")
            if type(value) is not int or not 0 <= value <= most[field]:
                raise InputError(f"{name}: {field} = {shown(value)}: 0 to {most[field]} wanted")
        if missing := most.keys() - values.keys():
            raise InputError(f"{name}: {', '.join(sorted(missing))} wanted")
        check_card(card)
        if card not in self._cards:
            return CommandResult.of(Code.OFFLINE)
        return await self._cards[card].command(lambda n: kind(n, *(values[f] for f in most)), name)

    async def settings(self, card: int) -> tuple[CommandResult, dict[Key, int]]:
        """All settings of a card, by name and element, as it tells them."""
        check_card(card)
        if card not in self._cards:
            return CommandResult.of(Code.OFFLINE), {}
        known = numbers().items()
        return await self._cards[card].settings((n, i) for n, (_, k) in known for i in range(k))

    async def configure(self, card: int, config: "CardConfig") -> ConfigurationResult:
        """Send the settings of a configuration that differ from the card's, one by one.

        The first setting that the card refuses ends it; a card that moves takes none. Its id stays.
        """
        check_card(card)
        if card not in self._cards:
            return ConfigurationResult(CommandResult.of(Code.OFFLINE))
        return await self._cards[card].configure(asked(config))

    async def upload(self, card: int, job: bytes) -> CommandResult:
        """Bring a job file into a card's flash; returns when it is there, or refused.

        A caller that cancels leaves the job in the folder, and the card gets it when it connects. A
        newer job for the card takes its place. InputError if it is no job file.
        """
        check_job(job)
        check_card(card)
        return await self._card(card).upload(job)

    def subscribe(self) -> "asyncio.Queue[Event]":
        """Events from now on; the oldest are dropped if nobody takes them."""
        queue: asyncio.Queue[Event] = asyncio.Queue(QUEUE_MAX)
        self._queues.append(queue)
        return queue

    def unsubscribe(self, queue: "asyncio.Queue[Event]") -> None:
        """No more events into this queue."""
        if queue in self._queues:
            self._queues.remove(queue)

    # What lines call.

    def met(self, line: CardConnection) -> str:
        """Take a new connection; returns why it is refused, or an empty text."""
        if len(self._lines) >= self.limits.connections:
            return f"more than {self.limits.connections} connections"
        pending = (x for x in self._lines if x.open and not x.end.ready)
        same = [x for x in pending if x.address == line.address]
        if len(same) >= self.limits.strangers:
            oldest = max(same, key=lambda x: x.age)
            if oldest.age < self.limits.place:
                return f"more than {self.limits.strangers} connections in their handshake"
            oldest.drop("its place went to a newer handshake")
        self._lines.add(line)
        return ""

    def joined(self, line: CardConnection) -> RemoteCard:
        """The handshake of a line is over."""
        assert line.end.hello
        card = self._card(line.end.hello.card)
        card.join(line, line.end.hello)
        return card

    def lost(self, line: CardConnection, why: str) -> None:
        """A connection is over."""
        self._lines.discard(line)
        if isinstance(line.card, RemoteCard):
            line.card.left(line, why)
        else:
            self._log(f"{line.address}:{line.port} closed: {why}")

    def _card(self, card: int) -> RemoteCard:
        if card not in self._cards:
            if len(self._cards) >= self.limits.cards:
                for old in [i for i, c in self._cards.items() if c.idle][:1]:
                    del self._cards[old]
            outbox = Outbox(self._folder / str(card))
            self._cards[card] = RemoteCard(card, outbox, self.limits, self._tell)
        return self._cards[card]

    async def _watch(self) -> None:
        while True:
            await asyncio.sleep(WATCH)
            for line in list(self._lines):
                line.watch()
            for card in self._cards.values():
                card.watch()

    def _tell(self, event: Event) -> None:
        for queue in self._queues:
            if queue.full():
                queue.get_nowait()
            queue.put_nowait(event)
        if event.kind not in FLEETING:
            self._log(f"card {event.card} {event.kind}: {event.text}")

    def _log(self, text: str) -> None:
        """Write a line of the log unless this second has had its share."""
        if (second := int(time.monotonic())) != self._second:
            if self._logged > self.limits.lines:
                LOG.info("%d lines dropped", self._logged - self.limits.lines)
            self._second, self._logged = second, 0
        self._logged += 1
        if self._logged <= self.limits.lines:
            LOG.info("%s", text)
        else:
            self.dropped += 1
