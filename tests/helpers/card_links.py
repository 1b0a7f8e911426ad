"""A server of cards with soft cards on loopback, and a proxy between them that delays and cuts."""

import asyncio
import contextlib
import random
import socket
import struct
import tempfile
import zlib
from collections.abc import AsyncIterator, Callable, Coroutine, Iterable
from pathlib import Path
from typing import Any

from soft_card import CardEnd, SoftCard, serve_card

from motionfmu.cards import messages as m
from motionfmu.cards.connection import ConnectionLimits
from motionfmu.cards.server import Cards
from motionfmu.cards.sim import FLASH_BYTES

HOST = "127.0.0.1"
PATIENCE = 120.0  # [s] for what comes at once, however busy the machine is
WAIT = 0.005  # [s] until a soft card connects again


def job_of(pages: int, seed: int = 1) -> bytes:
    """Bytes of a file that the server accepts as a job file."""
    return b"MCJ1" + random.Random(seed).randbytes(256 * pages - 4)


def flash_with(job: bytes) -> bytes:
    """A flash with this job in its first slot."""
    flash = bytearray(b"\xff" * FLASH_BYTES)
    flash[: len(job)] = job
    words = (1, 0, len(job), zlib.crc32(job), struct.unpack_from("<I", job, 8)[0], 0)
    record = b"MCR1" + struct.pack("<6I", *words)
    record += struct.pack("<I", zlib.crc32(record))
    flash[254 * 4096 : 254 * 4096 + len(record)] = record
    return bytes(flash)


def run(main: Coroutine[Any, Any, Any]) -> Any:
    """Run an asynchronous test with a time limit."""

    async def bounded() -> Any:
        return await asyncio.wait_for(main, 2 * PATIENCE)

    return asyncio.run(bounded())


async def until(true: Callable[[], object]) -> None:
    """Wait until a condition is true."""
    async with asyncio.timeout(PATIENCE):
        while not true():
            await asyncio.sleep(0.002)


class Bench:
    """A server, its folder and port, and the soft cards that are connected to it."""

    def __init__(self, cards: Cards, folder: Path, port: int) -> None:
        self.cards, self.folder, self.port = cards, folder, port
        self._tasks: list[asyncio.Task[None]] = []

    def serve(self, *soft: SoftCard, port: int | None = None, wait: float = WAIT) -> None:
        """Keep soft cards connected."""
        for card in soft:
            talk = serve_card(card, HOST, port or self.port, wait)
            self._tasks.append(asyncio.create_task(talk))

    async def online(self, ids: Iterable[int]) -> None:
        """Wait until these cards are connected."""
        wanted = set(ids)
        await until(lambda: wanted <= {v.id for v in self.cards.list() if v.connected})

    def view(self, card: int) -> Any:
        """The server's record of a card."""
        return next(v for v in self.cards.list() if v.id == card)

    def texts(self, card: int, kind: str) -> list[str]:
        """Texts of a card's events of a kind."""
        return [e.text for e in self.view(card).events if e.kind == kind]

    async def unplug(self) -> None:
        """End all soft cards."""
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        self._tasks.clear()


@contextlib.asynccontextmanager
async def bench(
    limits: ConnectionLimits | None = None, folder: Path | None = None
) -> AsyncIterator[Bench]:
    """A server that ends with the block."""
    with tempfile.TemporaryDirectory() as own:
        place = folder or Path(own)
        cards = Cards(place, limits)
        made = Bench(cards, place, await cards.listen(HOST, 0))
        try:
            yield made
        finally:
            await made.unplug()
            await cards.close()


class Puppet:
    """A soft card that answers only what it is told to."""

    def __init__(self, card: SoftCard) -> None:
        self.card = card
        self.answers: list[m.Message] = []
        self._heard: list[m.Message] = []

    async def connect(self, port: int) -> tuple[CardEnd, socket.socket]:
        """Shake hands; returns the end and its socket."""
        loop = asyncio.get_running_loop()
        sock = socket.socket()
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 16384)
        sock.setblocking(False)
        await loop.sock_connect(sock, (HOST, port))
        end = CardEnd(self.card.key, self.card.hello())
        while not end.ready:
            await loop.sock_sendall(sock, end.take())
            self._take(end, await loop.sock_recv(sock, 4096))
        return end, sock

    async def hear(self, end: CardEnd, sock: socket.socket) -> m.Message:
        """The next message that is no ping."""
        loop = asyncio.get_running_loop()
        while not self._heard:
            self._take(end, await loop.sock_recv(sock, 4096))
        return self._heard.pop(0)

    def _take(self, end: CardEnd, data: bytes) -> None:
        for sequence, kind, message in end.feed(data):
            if message and not isinstance(message, m.Ping):
                self.answers = self.card.answer(sequence, kind, message)
                self._heard.append(message)


def numbers(card: SoftCard) -> list[int]:
    """Numbers of the commands that a card has carried out."""
    return [order.number for order in card.orders]


class ChaosLink:
    """A proxy that forwards bytes in pieces and late, and cuts connections within a frame."""

    def __init__(self, port: int, seed: int, mean: int) -> None:
        self._port, self._chance = port, random.Random(seed)
        self._mean = mean  # [byte] between two cuts
        self.cuts = 0
        self.calm = False  # no more cuts
        self._server: asyncio.Server | None = None
        self._tasks: set[asyncio.Task[None]] = set()

    async def listen(self) -> int:
        """Take connections; returns the port."""
        self._server = await asyncio.start_server(self._met, HOST, 0)
        return int(self._server.sockets[0].getsockname()[1])

    async def close(self) -> None:
        """Cut all connections."""
        assert self._server
        self._server.close()
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)

    def _met(self, up: asyncio.StreamReader, to_card: asyncio.StreamWriter) -> None:
        self._tasks.add(task := asyncio.get_running_loop().create_task(self._join(up, to_card)))
        task.add_done_callback(self._tasks.discard)

    async def _join(self, up: asyncio.StreamReader, to_card: asyncio.StreamWriter) -> None:
        try:
            down, to_pc = await asyncio.open_connection(HOST, self._port)
        except OSError:
            to_card.close()
            return
        ends = (to_card, to_pc)
        left = [int(self._chance.expovariate(1 / self._mean))]
        ways = [self._carry(up, to_pc, left), self._carry(down, to_card, left)]
        tasks = [asyncio.create_task(way) for way in ways]
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for task in tasks:
                task.cancel()
            for writer in ends:
                writer.transport.abort()

    async def _carry(
        self, source: asyncio.StreamReader, sink: asyncio.StreamWriter, left: list[int]
    ) -> None:
        with contextlib.suppress(OSError):
            while data := await source.read(self._chance.randint(1, 3000)):
                if self._chance.random() < 0.05:
                    await asyncio.sleep(self._chance.expovariate(1 / 0.002))
                if not self.calm and len(data) >= left[0]:
                    sink.write(data[: left[0]])
                    await asyncio.sleep(0)
                    self.cuts += 1
                    return
                left[0] -= len(data)
                sink.write(data)
                await sink.drain()
