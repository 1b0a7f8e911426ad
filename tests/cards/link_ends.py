"""Both ends of an ethernet_link: plain streams, and a card by the protocol in Python."""

import struct
from typing import Any

from fmi_tools import OK, Instance
from soft_card import CardEnd

from motionfmu.cards import messages as m

STEP = 1e-3  # [s] bus period of these tests
WORDS = struct.Struct("<128i")


class Stream:
    """An end of plain bytes: what it sends of `data`, and what it got, connection by connection."""

    def __init__(self, data: bytes = b"", greed: int = 512) -> None:
        self.data, self.greed = data, greed
        self.connection = self.count = self.taken = 0
        self.ring = bytearray(512)
        self.got: list[bytearray] = []
        self.times: list[float] = []  # of each byte that came
        self.sent: list[int] = []

    def open(self) -> None:
        """Another connection: all anew."""
        self.count = self.taken = 0
        if self.connection:
            self.got.append(bytearray())
            self.sent.append(0)

    def heard(self, data: bytes) -> None:
        """Bytes have come."""
        self.got[-1] += data

    def more(self, room: int) -> bytes:
        """Bytes to be sent."""
        return self.data[self.count : self.count + room]

    def see(self, time: float, connection: int, words: list[int], count: int, taken: int) -> None:
        """Read what the link shows, at an instant."""
        if connection != self.connection:
            self.connection = connection
            self.open()
        if not connection:
            return
        n = min(count - self.taken, self.greed)
        shown = WORDS.pack(*words)
        self.heard(bytes(shown[(self.taken + i) % 512] for i in range(n)))
        self.times += [time] * n
        self.taken += n
        for byte in self.more(512 - (self.count - taken)):
            self.ring[self.count % 512] = byte
            self.count += 1
            self.sent[-1] += 1

    def show(self) -> tuple[list[int], int, int]:
        """Words, count, and what was taken."""
        return list(WORDS.unpack(self.ring)), self.count, self.taken


class Card(Stream):
    """A card whose store takes four pages a step; it is cut off and connects again."""

    def __init__(self, key: bytes, pages: int) -> None:
        super().__init__()
        self.key, self.pages = key, pages
        self.job = bytearray()
        self.stored = b""
        self.done: dict[int, int] = {}  # times a command was done, by its number
        self.order: list[int] = []
        self.twice = 0  # pages that were there already
        self.out = b""

    def open(self) -> None:
        super().open()
        self.out = b""
        if self.connection:
            last = max(self.done, default=0)
            hello = m.Hello(
                7, 1, 1, bytes([self.connection] * 16), 1, 2, 4, 16, last, bytes(32), 1, 9
            )
            self.end = CardEnd(self.key, hello)

    def missing(self) -> int:
        """The first missing page."""
        page = len(self.job) // m.PAGE
        return page if page < self.pages else m.NO_PAGE

    def heard(self, data: bytes) -> None:
        for number, kind, message in self.end.feed(data):
            if isinstance(message, m.JobData):
                new = message.page * m.PAGE == len(self.job)
                self.twice += not new
                self.job += message.data if new else b""
            elif isinstance(message, m.JobEnd):
                self.stored = bytes(self.job)
            elif isinstance(message, m.Ping):
                self.end.send(m.Pong(message.token))
            elif message is not None and kind >= m.Start.TYPE:
                given = int(message.number)  # type: ignore[attr-defined]
                if given not in self.done:
                    self.order.append(kind)
                self.done[given] = self.done.get(given, 0) + 1
                self.end.send(m.ResultMessage(given, 0, 1))
            if isinstance(message, m.JobBegin | m.JobData | m.JobEnd):
                self.end.send(m.Ack(number, 16, self.missing()))
        self.out += self.end.take()

    def more(self, room: int) -> bytes:
        self.out += self.end.take()
        now, self.out = self.out[:room], self.out[room:]
        return now


class Link:
    """An ethernet_link between two ends in Python, or a card_host as its host."""

    def __init__(self, card: Stream, host: Stream | Instance, fmi: int = 3, **values: Any) -> None:
        self.card, self.host = card, host
        self.link = Instance("ethernet_link", fmi).initialize({"bus_period": STEP, **values})
        self.wants = True

    def _see(self, end: Stream, name: str) -> None:
        link = self.link
        time = round(link.time / STEP) * STEP
        shown = [link.get(f"{name}_{x}") for x in ("rx_words", "rx_count", "tx_taken")]
        end.see(time, link.get("connection")[0], shown[0], shown[1][0], shown[2][0])

    def _carry(self, name: str, shown: tuple[list[int], int, int]) -> None:
        for variable, value in zip(("tx_words", "tx_count", "rx_taken"), shown, strict=True):
            assert self.link.set(f"{name}_{variable}", value) == OK

    def step(self, parts: int = 1) -> None:
        """One bus period, in parts."""
        link, host = self.link, self.host
        self._see(self.card, "card")
        if isinstance(host, Stream):
            self._see(host, "host")
        else:
            assert host.set("connection", link.get("connection")) == OK
            for name in ("rx_words", "rx_count", "tx_taken"):
                assert host.set(name, link.get(f"host_{name}")) == OK
            assert link.set("host_accept", host.get("accept")) == OK
        assert link.set("card_connect", self.wants) == OK
        self._carry("card", self.card.show())
        if isinstance(host, Stream):
            self._carry("host", host.show())
        else:
            shown = [host.get(x) for x in ("tx_words", "tx_count", "rx_taken")]
            self._carry("host", (shown[0], shown[1][0], shown[2][0]))
            for _ in range(parts):
                assert host.step(STEP / parts) == OK, host.said
        for _ in range(parts):
            assert link.step(STEP / parts) == OK, link.said

    def run(self, seconds: float, parts: int = 1) -> None:
        """Many."""
        for _ in range(round(seconds / STEP)):
            self.step(parts)
