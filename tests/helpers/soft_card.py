"""A soft card: the card's end of the protocol with a minimal card behind it, for tests."""

import asyncio
import contextlib
import hashlib
import random
import zlib
from collections import deque

from motionfmu.cards import messages as m
from motionfmu.cards.views import Code
from motionfmu.cards.wire import OPEN_KEY, PROTOCOL, TO_PC, LinkEnd, proof, proved

CREDIT = 16  # [pages]
KEPT = 8  # results of commands
DRAWS = random.Random(16)  # lives and nonces, the same in every run
FIRST_WAIT, LAST_WAIT = 0.5, 30.0  # [s] until it connects again
PING, PINGS = 1.0, 3  # [s] of silence, without an answer


class CardEnd(LinkEnd):
    """The card's end; HELLO is among its bytes from the start."""

    def __init__(self, key: bytes, hello: m.Hello) -> None:
        super().__init__(TO_PC)
        self.interval = 0  # [ms] of status, from WELCOME
        self._key, self._hello = key, hello
        self._proven = False
        self.send(hello)

    def _shake(self, message: m.Message | None) -> None:
        if self._proven:
            if not isinstance(message, m.Welcome):
                raise m.WireError("no WELCOME")
            self.interval, self.ready = message.interval, True
            return
        if not isinstance(message, m.Challenge):
            raise m.WireError("no CHALLENGE")
        if not self._hello.oldest <= message.protocol <= self._hello.newest:
            raise m.WireError(f"protocol {message.protocol}")
        proved(message.proof, proof(self._key, b"S", self._hello, message), "PC")
        self.send(m.Auth(proof(self._key, b"C", self._hello, message)))
        self.secure(self._key, self._hello, message)
        self._proven = True


class SoftCard:
    """The state that a card keeps over its connections, and its answers."""

    def __init__(self, card: int, key: bytes = OPEN_KEY, credit: int = CREDIT) -> None:
        self.id, self.key, self.credit = card, key, credit
        self.job = b""
        self.state = m.State.EMPTY
        self.pages: dict[int, bytes] = {}  # of the transfer under way
        self.begun: m.JobBegin | None = None
        self.done = 0
        self.life = DRAWS.getrandbits(16)
        self.orders: list[m.Message] = []  # every command that was carried out
        self.written = 0  # pages that were taken, those taken again too
        self.settings: dict[tuple[int, int], int] = {}  # by number and index; others are 0
        self._results: deque[m.ResultMessage] = deque(maxlen=KEPT)

    def hello(self) -> m.Hello:
        """Its first message of a connection."""
        job = hashlib.sha256(self.job).digest() if self.job else bytes(32)
        return m.Hello(
            self.id,
            PROTOCOL,
            PROTOCOL,
            DRAWS.randbytes(16),
            1,
            2,
            4,
            self.credit,
            self.done,
            job,
            self.state,
            self.life,
        )

    def status(self) -> m.Status:
        """The card's present status."""
        return m.Status(
            self.state, 0, 0, 0, 0, 0, 0, (0, 0, 0, 0), 0, 0, (0, 0, 0, 0, 0, 0, 0), 1000, 0
        )

    def answer(self, sequence: int, kind: int, message: m.Message | None) -> list[m.Message]:
        """Answers to a message of the PC."""
        if message is None:
            return [m.Nak(sequence, Code.UNKNOWN, kind)]
        if isinstance(message, m.Ping):
            return [m.Pong(message.token)]
        if isinstance(message, m.JobBegin | m.JobData | m.JobEnd):
            code = self._take(message)
            return [m.Nak(sequence, code, 0) if code else self._ack(sequence)]
        if isinstance(message, m.ConfigGet):
            place = message.id, message.index
            return [m.Config(*place, self.settings.get(place, 0))]
        if hasattr(message, "number"):
            return [self._order(message, message.number)]
        return []

    def _ack(self, sequence: int) -> m.Ack:
        return m.Ack(sequence, self.credit, self._missing() if self.begun else m.NO_PAGE)

    def _missing(self) -> int:
        pages = self.begun.length // m.PAGE if self.begun else 0
        return next((i for i in range(pages) if i not in self.pages), m.NO_PAGE)

    def _take(self, message: m.Message) -> int:
        """Take a message of a job; a code if it is refused."""
        if isinstance(message, m.JobBegin):
            if self.state not in (m.State.EMPTY, m.State.READY):
                return Code.BUSY
            if message != self.begun:
                self.begun, self.pages = message, {}
            return Code.DONE
        if self.begun is None:
            return Code.STATE
        if isinstance(message, m.JobData):
            for k in range(len(message.data) // m.PAGE):
                if message.page + k >= self.begun.length // m.PAGE:
                    return Code.PAGE
                self.pages[message.page + k] = message.data[k * m.PAGE : (k + 1) * m.PAGE]
                self.written += 1
            return Code.DONE
        whole = b"".join(self.pages[i] for i in sorted(self.pages))
        good = (len(whole), hashlib.sha256(whole).digest(), zlib.crc32(whole))
        if good != (self.begun.length, self.begun.digest, self.begun.crc):
            return Code.BAD_JOB
        self.job, self.begun, self.pages = whole, None, {}
        self.state = m.State.READY
        return Code.DONE

    def _order(self, message: m.Message, number: int) -> m.ResultMessage:
        """Carry out a command, or answer it again."""
        if number <= self.done:
            known = (r for r in self._results if r.number == number)
            return next(known, m.ResultMessage(number, Code.STATE, self.state))
        self.done = number
        code = self._do(message)
        if code == Code.DONE:
            self.orders.append(message)
        self._results.append(m.ResultMessage(number, code, self.state))
        return self._results[-1]

    def _do(self, message: m.Message) -> int:
        moves = {
            m.Start: ((m.State.READY, m.State.PAUSED), m.State.RUNNING),
            m.Pause: ((m.State.RUNNING,), m.State.PAUSED),
            m.Stop: ((m.State.RUNNING, m.State.PAUSED), m.State.READY),
            m.Home: ((m.State.READY,), m.State.READY),
        }
        if isinstance(message, m.ConfigSet):
            if self.state not in (m.State.EMPTY, m.State.READY, m.State.FAULT):
                return Code.BUSY
            self.settings[message.id, message.index] = message.value
        if type(message) in moves:
            allowed, then = moves[type(message)]
            if self.state not in allowed:
                return Code.NO_JOB if self.state == m.State.EMPTY else Code.STATE
            self.state = then
        return Code.DONE


async def serve_card(card: SoftCard, host: str, port: int, first_wait: float = FIRST_WAIT) -> None:
    """Keep a card connected until this is cancelled; `first_wait` [s] until it connects again."""
    wait, chance = first_wait, random.Random(card.id)
    while True:
        end = CardEnd(card.key, card.hello())
        with contextlib.suppress(OSError, m.WireError):
            await _converse(card, end, *await asyncio.open_connection(host, port))
        if end.ready:
            wait = first_wait
        await asyncio.sleep(wait * chance.uniform(0.5, 1.0))
        wait = min(2 * wait, LAST_WAIT)


async def _converse(
    card: SoftCard, end: CardEnd, reader: asyncio.StreamReader, writer: asyncio.StreamWriter
) -> None:
    """One connection."""
    now = asyncio.get_running_loop().time
    heard = pinged = told = now()
    pings = 0
    try:
        while pings <= PINGS:
            writer.write(end.take())
            await writer.drain()
            try:
                # wait_for is not used, because in Python 3.11 it may swallow a cancellation.
                async with asyncio.timeout(end.interval / 1000 or PING):
                    data = await reader.read(4096)
                if not data:
                    break
                heard, pings = now(), 0
            except TimeoutError:
                data = b""
            for sequence, kind, message in end.feed(data):
                for answer in card.answer(sequence, kind, message):
                    end.send(answer)
            if now() - max(heard, pinged) >= PING:
                pings, pinged = pings + 1, now()
                if end.ready:
                    end.send(m.Ping(pings))
            if end.ready and end.interval and now() - told >= end.interval / 1000:
                told = now()
                end.send(card.status())
    finally:
        writer.close()
