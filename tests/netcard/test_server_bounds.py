"""What the server bears of a peer, bound by bound, on a clock of the test's own."""

import logging
from collections.abc import Callable
from dataclasses import astuple
from pathlib import Path
from typing import Any

import pytest
from soft_card import CardEnd, SoftCard

from motionfmu.cards import messages as m
from motionfmu.cards.connection import READ_MAX, CardConnection, ConnectionLimits
from motionfmu.cards.server import Cards
from motionfmu.cards.views import Event
from motionfmu.cards.wire import HEADER, MAGIC, OPEN_KEY, PAYLOAD_MAX, VERSION

LIMITS = ConnectionLimits()


class Pipe:
    """A transport that keeps what is written until it is read."""

    def __init__(self) -> None:
        self.waits = b""
        self.gone = False

    def get_extra_info(self, name: str) -> Any:
        return self if name == "socket" else ("192.0.2.1", 4000)

    def setsockopt(self, *_: int) -> None: ...

    def set_write_buffer_limits(self, _: int) -> None: ...

    def write(self, data: bytes) -> None:
        self.waits += data

    def get_write_buffer_size(self) -> int:
        return len(self.waits)

    def abort(self) -> None:
        self.gone = True


class Room:
    """Who owns the line: it takes all that comes."""

    def __init__(self, limits: ConnectionLimits) -> None:
        self.limits, self.buffer = limits, bytearray(READ_MAX)

    def met(self, line: CardConnection) -> str:
        return ""

    def joined(self, line: CardConnection) -> "Room":
        return self

    def lost(self, line: CardConnection, why: str) -> None: ...

    def heard(self, line: CardConnection, sequence: int, message: m.Message) -> None: ...

    def room(self) -> None: ...


class Peer:
    """A card on a line of a server, its clock, and what it says when."""

    def __init__(self, limits: ConnectionLimits = LIMITS) -> None:
        self.now = 0.0
        self.room = Room(limits)
        self.line = CardConnection(self.room, lambda _: OPEN_KEY, lambda: self.now)
        self.pipe = Pipe()
        self.line.connection_made(self.pipe)  # type: ignore[arg-type]
        self.end = CardEnd(OPEN_KEY, SoftCard(3).hello())

    def say(self, data: bytes) -> None:
        """Bytes to the server."""
        self.room.buffer[: len(data)] = data
        if data:
            self.line.buffer_updated(len(data))

    def hear(self) -> None:
        """Take what the server has to say; pings are answered later."""
        for _, _, message in self.end.feed(self.pipe.waits):
            if isinstance(message, m.Ping):
                self.end.send(m.Pong(message.token))
        self.pipe.waits = b""

    def shake(self) -> None:
        """The handshake."""
        while not self.line.end.ready:
            self.say(self.end.take())
            self.hear()
        self.say(self.end.take())

    def closed_at(self, turn: Callable[[], None], most: float = 100.0) -> float:
        """When the server closes, if this happens each 0.1 s [s]."""
        while not self.pipe.gone and self.now < most:
            self.now = round(self.now + 0.1, 1)
            turn()
            if not self.pipe.gone:
                self.line.watch()
        return self.now


def frame(length: int) -> bytes:
    """A header that announces so many bytes of payload."""
    return HEADER.pack(MAGIC, VERSION, 20, 0, 3, length)


def test_the_bounds_are_those_of_the_readme() -> None:
    assert astuple(LIMITS)[:6] == (256, 8, 1024, 5.0, 15.0, 30.0)
    assert LIMITS.place == 0.2
    assert (LIMITS.ping, LIMITS.pings, LIMITS.write, LIMITS.lines) == (1.0, 3, 65536, 100)


def test_a_handshake_has_5_s() -> None:
    peer = Peer()
    hello = iter(peer.end.take()[:-1])
    assert peer.closed_at(lambda: peer.say(bytes([next(hello)]))) == 5.1


def test_a_place_of_a_handshake_is_its_own_for_so_long(tmp_path: Path) -> None:
    """One neighbour that always connects anew keeps nobody out: the oldest makes room."""
    cards, now = Cards(tmp_path), 0.0
    lines: list[CardConnection] = []

    def comes() -> bool:
        """Whether one more is let in."""
        lines.append(CardConnection(cards, lambda _: OPEN_KEY, lambda: now))
        lines[-1].connection_made(Pipe())  # type: ignore[arg-type]
        return lines[-1].open

    for k in range(8):
        now = 0.01 * k
        assert comes()
    now = 0.19
    assert not comes() and lines[0].open
    for k in range(40):  # eight neighbours' places are given on, oldest first
        now = 0.21 + 0.2 * k
        assert comes()
        assert not lines[0].open and sum(line.open for line in lines) == 8
        lines = [line for line in lines if line.open]
    assert "place went to a newer" in _why(lines, comes)


def _why(lines: list[CardConnection], comes: Callable[[], bool]) -> str:
    """Why the oldest was closed when one more came."""
    oldest = lines[0]
    comes()
    return oldest._why


@pytest.mark.parametrize(("pause", "end"), [(1000, 15.1), (14, 30.1)], ids=["no byte", "slow"])
def test_a_frame_that_is_begun_is_waited_for(pause: int, end: float) -> None:
    peer = Peer(ConnectionLimits(ping=1000.0))  # as if each ping were answered
    peer.shake()
    peer.say(frame(100))
    assert peer.closed_at(lambda: peer.say(b"" if peer.now % pause else b"\0")) == end


def test_silence_is_asked_three_times() -> None:
    peer = Peer()
    peer.shake()
    assert peer.closed_at(peer.hear) == 4.0


def test_who_answers_pings_stays() -> None:
    peer = Peer()
    peer.shake()

    def turn() -> None:
        peer.hear()
        peer.say(peer.end.take())

    assert peer.closed_at(turn) == 100.0 and not peer.pipe.gone


@pytest.mark.parametrize("more", [0, 1])
def test_a_frame_has_1048_bytes_at_most(more: int) -> None:
    assert HEADER.size + PAYLOAD_MAX + 8 == 1048
    peer = Peer()
    peer.shake()
    peer.say(frame(PAYLOAD_MAX + more))
    assert peer.pipe.gone == bool(more)


def test_64_kb_wait_to_be_sent_and_no_more() -> None:
    peer = Peer()
    peer.shake()
    peer.hear()
    most = 0
    while not peer.pipe.gone:
        most = len(peer.pipe.waits)
        peer.end.send(m.Ping(7))
        peer.say(peer.end.take())
    assert LIMITS.write - 20 < most <= LIMITS.write


def test_a_second_has_100_lines_of_the_log(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    cards, clock = Cards(tmp_path), [10.0]
    monkeypatch.setattr("motionfmu.cards.server.time.monotonic", lambda: clock[0])
    caplog.set_level(logging.INFO, "motionfmu.cards")
    for _ in range(1000):
        cards._tell(Event("closed", 3, "again", 0.0))
    assert len(caplog.records) == 100 and cards.dropped == 900
    clock[0] = 11.0
    cards._tell(Event("closed", 3, "again", 0.0))
    assert len(caplog.records) == 102 and "900 lines dropped" in caplog.text
