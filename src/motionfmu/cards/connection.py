"""A connection of a card to the server: its bounds in bytes and in time."""

import asyncio
import socket
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, cast

from motionfmu.cards.messages import Message, Ping, Pong, WireError
from motionfmu.cards.wire import PcEnd

READ_MAX = 16384  # [byte] taken from a connection before the others have their turn


@dataclass(frozen=True)
class ConnectionLimits:
    """Limits of a server on its connections, in number, bytes and time."""

    connections: int = 256
    strangers: int = 8  # connections of one address that have not finished their handshake
    cards: int = 1024  # cards that the server remembers
    authenticate: float = 5.0  # [s] for the handshake
    gap: float = 15.0  # [s] between two bytes of a frame
    idle: float = 30.0  # [s] between two frames
    ping: float = 1.0  # [s] of silence
    pings: int = 3  # without an answer
    write: int = 65536  # [byte] that wait to be sent
    answer: float = 5.0  # [s] for a command, reconnection included
    retry: float = 2.0  # [s] until a busy card is asked again for a job that waits
    stall: float = 60.0  # [s] without progress of an upload
    lines: int = 100  # of the log [1/s]
    place: float = 0.2  # [s] for which a handshake has its place among the strangers to itself


class Card(Protocol):
    """The receiver of a connection's messages."""

    def heard(self, line: "CardConnection", sequence: int, message: Message) -> None:
        """A message behind the handshake."""

    def room(self) -> None:
        """There is room for more to send."""


class Host(Protocol):
    """The owner of all connections."""

    limits: ConnectionLimits
    buffer: bytearray

    def met(self, line: "CardConnection") -> str:
        """Take a new connection; returns why it is refused, or an empty text."""

    def joined(self, line: "CardConnection") -> Card:
        """The handshake of a line is over."""

    def lost(self, line: "CardConnection", why: str) -> None:
        """A connection is over."""


class CardConnection(asyncio.BufferedProtocol):
    """One connection: frames in, frames out."""

    def __init__(
        self, host: Host, key_of: Callable[[int], bytes], now: Callable[[], float]
    ) -> None:
        self._host, self._now = host, now
        self.end = PcEnd(key_of)
        self.address, self.port = "", 0
        self.card: Card | None = None
        self.open = False
        self.room = True  # to send more
        self._born = self._byte = self._frame = self._pinged = now()
        self._pings = 0
        self._why = "closed by the card"
        self._transport: asyncio.Transport | None = None

    @property
    def age(self) -> float:
        """Time since the connection came [s]."""
        return self._now() - self._born

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """A peer has connected."""
        self._transport = cast(asyncio.Transport, transport)
        sock = transport.get_extra_info("socket")
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, self._host.limits.write)
        self.address, self.port = (transport.get_extra_info("peername") or ("", 0))[:2]
        self.open = True
        self._transport.set_write_buffer_limits(self._host.limits.write // 2)
        if why := self._host.met(self):
            self.drop(why)

    def get_buffer(self, sizehint: int) -> bytearray:
        """The buffer for received bytes, one for all connections: bytes are used up at once."""
        return self._host.buffer

    def buffer_updated(self, nbytes: int) -> None:
        """Bytes have come."""
        if not self.open:
            return
        self._byte = self._now()
        try:
            for sequence, _, message in self.end.feed(memoryview(self._host.buffer)[:nbytes]):
                self._frame, self._pings = self._byte, 0
                if isinstance(message, Ping):
                    self.send(Pong(message.token))
                elif message and self.card:
                    self.card.heard(self, sequence, message)
                if not self.open:
                    return
            if self.end.ready and self.card is None:
                self._flush()
                self._frame = self._byte
                self.card = self._host.joined(self)
        except WireError as error:
            self.drop(str(error))
            return
        self._flush()

    def send(self, message: Message) -> int:
        """Send a message; returns the number of its frame."""
        number = self.end.send(message)
        self._flush()
        return number

    def _flush(self) -> None:
        if not self.open or self._transport is None:
            return
        if data := self.end.take():
            self._transport.write(data)
        if self._transport.get_write_buffer_size() > self._host.limits.write:
            self.drop("does not read what is sent")

    def pause_writing(self) -> None:
        """Stop sending until the bytes that wait are sent."""
        self.room = False

    def resume_writing(self) -> None:
        """Go on sending."""
        self.room = True
        if self.card:
            self.card.room()

    def drop(self, why: str) -> None:
        """Close at once; bytes that are not sent yet are lost."""
        if self.open:
            self._why, self.open = why, False
            if self._transport:
                self._transport.abort()

    def connection_lost(self, exc: Exception | None) -> None:
        """The connection is over."""
        hello = self.end.hello
        if self.open and hello and not self.end.ready:
            self._why += f": card {hello.card} does not know this server's key, or left"
        self.open = False
        self._host.lost(self, self._why)

    def watch(self) -> None:
        """Close the connection if it is too slow; send a ping if it is silent."""
        now, limits = self._now(), self._host.limits
        if not self.end.ready:
            if now - self._born > limits.authenticate:
                self.drop(f"no handshake in {limits.authenticate:g} s")
        elif self.end.stream.begun and now - self._byte > limits.gap:
            self.drop(f"{limits.gap:g} s inside a frame")
        elif now - self._frame > limits.idle:
            self.drop(f"no frame in {limits.idle:g} s")
        elif now - max(self._frame, self._pinged) >= limits.ping:
            if self._pings >= limits.pings:
                self.drop(f"{self._pings} pings without an answer")
                return
            self._pings += 1
            self._pinged = now
            self.send(Ping(self._pings))
