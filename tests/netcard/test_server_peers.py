"""The server of cards among hostile, slow and many peers, and its death."""

import asyncio
import contextlib
import random
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from card_links import (
    HOST,
    PATIENCE,
    Bench,
    Puppet,
    bench,
    job_of,
    numbers,
    run,
    until,
)
from conftest import ROOT
from console import within
from soft_card import CardEnd, SoftCard, serve_card

from motionfmu.base.errors import InputError
from motionfmu.cards import messages as m
from motionfmu.cards.connection import ConnectionLimits
from motionfmu.cards.control import ask
from motionfmu.cards.server import Cards
from motionfmu.cards.wire import OPEN_KEY

CARD = ROOT / "examples/network_card_firmware/card.toml"


async def drip(port: int, address: str) -> None:
    """Send HELLO a byte now and then, and never the last one, until the server closes."""
    _, writer = await asyncio.open_connection(HOST, port, local_addr=(address, 0))
    hello = iter(CardEnd(OPEN_KEY, SoftCard(99).hello()).take()[:-1])
    while not writer.transport.is_closing():
        writer.write(bytes([byte for byte in [next(hello, None)] if byte is not None]))
        await asyncio.sleep(0.02)


async def garbage(port: int, address: str, seed: int) -> None:
    """Send bytes at random until the server has enough."""
    chance = random.Random(seed)
    _, writer = await asyncio.open_connection(HOST, port, local_addr=(address, 0))
    while not writer.transport.is_closing():
        writer.write(chance.randbytes(chance.randint(1, 20000)))
        await asyncio.sleep(0.001)


async def until_closed(*peers: "asyncio.Task[None]") -> None:
    """Wait until the server has closed on all of them."""
    async with asyncio.timeout(PATIENCE):
        await asyncio.gather(*peers, return_exceptions=True)


def test_slow_and_hostile_peers_are_closed_and_the_others_feel_nothing() -> None:
    async def main() -> None:
        async with bench(ConnectionLimits(authenticate=0.3, strangers=30)) as b:
            soft = [SoftCard(i) for i in range(10)]
            b.serve(*soft)
            await b.online(range(10))
            bad = [drip(b.port, "127.0.0.2") for _ in range(5)]
            bad += [garbage(b.port, "127.0.0.3", i) for i in range(10)]
            tasks = [asyncio.create_task(x) for x in bad]
            async with asyncio.timeout(PATIENCE):
                await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
            for _ in range(20):
                results = [b.cards.command(i, "reset") for i in range(10)]
                assert all(r.ok for r in await asyncio.gather(*results))
            await until_closed(*tasks)
            assert all(b.texts(i, "closed") == [] for i in range(10))
            assert [v.id for v in b.cards.list()] == list(range(10))

    run(main())


def test_who_does_not_read_is_closed_before_memory_fills() -> None:
    async def main() -> None:
        async with bench() as b:
            end, sock = await Puppet(SoftCard(3)).connect(b.port)
            await b.online([3])
            loop, sent = asyncio.get_running_loop(), 0
            try:
                while sent < 40 << 20:
                    for token in range(500):
                        end.send(m.Ping(token))
                    data = end.take()
                    sent += len(data)
                    await loop.sock_sendall(sock, data)
            except OSError:
                pass
            await until(lambda: not b.view(3).connected)
            assert "does not read what is sent" in b.texts(3, "closed")
            print(f"closed behind {sent >> 10} kB of pings")
            sock.close()

    run(main())


@pytest.mark.parametrize(
    ("limits", "addresses", "refused"),
    [
        (ConnectionLimits(strangers=3, place=1e3), ["127.0.0.2"] * 6 + ["127.0.0.3"], 3),
        (ConnectionLimits(connections=5), [f"127.0.0.{k}" for k in range(2, 9)], 2),
    ],
    ids=["of an address", "in all"],
)
def test_connections_are_counted(
    limits: ConnectionLimits, addresses: list[str], refused: int
) -> None:
    async def main() -> None:
        async with bench(limits) as b:

            async def silent(address: str) -> None:
                """Say nothing until the server closes."""
                made = asyncio.open_connection(HOST, b.port, local_addr=(address, 0))
                reader, writer = await made
                with contextlib.suppress(OSError):
                    await reader.read()
                writer.close()

            tasks = [asyncio.create_task(silent(address)) for address in addresses]
            await until(lambda: sum(t.done() for t in tasks) == refused)
            await asyncio.sleep(0.05)
            assert sum(t.done() for t in tasks) == refused
            for task in tasks:
                task.cancel()

    run(main())


def test_all_cards_come_back_when_the_server_does(tmp_path: Path) -> None:
    async def main() -> None:
        soft = [SoftCard(i) for i in range(40)]
        cards = Cards(tmp_path)
        port = await cards.listen(HOST, 0)
        b = Bench(cards, tmp_path, port)
        b.serve(*soft)
        await b.online(range(40))
        await cards.close()
        await asyncio.sleep(0.02)
        b.cards = Cards(tmp_path)
        await b.cards.listen(HOST, port)
        await b.online(range(40))
        ends = await asyncio.gather(*(b.cards.command(i, "reset") for i in range(40)))
        assert all(r.ok for r in ends)
        await b.unplug()
        await b.cards.close()

    run(main())


class Thread:
    """Soft cards on a loop of their own."""

    def __init__(self, port: int, *soft: SoftCard) -> None:
        self._loop = asyncio.new_event_loop()
        self._tasks = [self._loop.create_task(serve_card(s, HOST, port, 0.02)) for s in soft]
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def _run(self) -> None:
        asyncio.set_event_loop(self._loop)
        self._loop.run_until_complete(asyncio.wait(self._tasks))
        self._loop.close()

    def end(self) -> None:
        """End them."""
        for task in self._tasks:
            self._loop.call_soon_threadsafe(task.cancel)
        self._thread.join()


def free_port() -> int:
    """A port that was free just now."""
    with socket.socket() as sock:
        sock.bind((HOST, 0))
        return int(sock.getsockname()[1])


def serve(folder: Path, port: int) -> "subprocess.Popen[str]":
    """A server in a process of its own, which has begun to listen."""
    line = [sys.executable, "-m", "motionfmu", "card", "serve", "--page", "0"]
    line += ["--port", str(port), "--folder", str(folder)]
    server = subprocess.Popen(line, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    assert server.stdout and b"cards:" in server.stdout.readline()
    return server


def waiting(true: Callable[[], object]) -> None:
    """Wait until something is so."""
    end = time.monotonic() + PATIENCE
    while not true():
        assert time.monotonic() < end
        time.sleep(0.002)


def test_a_killed_server_goes_on_where_the_card_is(tmp_path: Path) -> None:
    port, file = free_port(), tmp_path / "job.mcj"
    job = job_of(600)
    file.write_bytes(job)
    asked = {"do": "upload", "card": 3, "bytes": len(job)}

    class Slow(SoftCard):
        """Takes its time, so that the server can be killed in the middle."""

        def _take(self, message: m.Message) -> int:
            time.sleep(0 if killed.is_set() else 0.002)
            return super()._take(message)

    killed = threading.Event()
    soft = Slow(3)
    cards = Thread(port, soft)
    try:
        server = serve(tmp_path / "cards", port)
        waiting(lambda: ask(tmp_path / "cards", {"do": "list"})["cards"])
        sender = threading.Thread(
            target=lambda: lost.append(failed(tmp_path / "cards", asked, job))
        )
        lost: list[str] = []
        sender.start()
        waiting(lambda: len(soft.pages) > 100)
        server.send_signal(signal.SIGKILL)
        server.wait()
        killed.set()
        sender.join()
        assert "without an answer" in lost[0] and not soft.job
        had = soft.written
        server = serve(tmp_path / "cards", port)
        waiting(lambda: soft.job)
        print(f"killed at {had} of 600 pages")
        assert soft.job == job and soft.written == 600
        folder = ("--folder", tmp_path / "cards")
        for line, status, told in (
            (("configure", 3, "-c", CARD), 0, "Axis X: Highest speed: 0 pulses -> 200 mm/s: done"),
            (("configure", 3, "-c", CARD), 0, "card 3: done: it has these settings"),
            (("configure", 3, "-c", ROOT / "README.md"), 2, "README.md:3: "),
            (("settings", 3), 0, "Highest speed"),
            (("settings", 4), 1, "card 4: the card is not connected"),
            (("start", 3), 0, "card 3: done (RUNNING)"),
            (("home", 3, "--axes", "XY"), 1, "card 3: not in this state (RUNNING)\nLook at"),
            (("stop", 3), 0, "card 3: done (READY)"),
            (("home", 3, "--axes", "XY"), 0, "card 3: done (READY)"),
            (("home", 3, "--axes", "XV"), 2, "--axes XV: letters of XYZU wanted"),
            (("send", 3, file), 0, "card 3: done"),
            (("send", 3, ROOT / "README.md"), 2, "README.md: no job file"),
            (("pause", 4), 1, "card 4: the card is not connected"),
            (("status", 3), 0, "READY"),
            (("status", 4), 1, "card 4 has never called"),
            (("serve", "--port", 70000), 2, "70000 is no port, 0 to 65535"),
            (("serve", "--page", 0, "-c", CARD), 2, "--page 0 wants none"),
            (("serve", "--page", 0), 2, "another server uses this folder"),
        ):
            end = within("card", *line, *folder)
            assert (end.returncode, told in end.stdout + end.stderr) == (status, True), end
        assert numbers(soft) == sorted(set(numbers(soft)))
        server.terminate()
        assert server.wait() == 0
        assert within("card", "status", *folder).returncode == 2
    finally:
        server.kill()
        cards.end()


def failed(folder: Path, asked: dict[str, object], job: bytes) -> str:
    """The message with which asking a server ends."""
    try:
        return str(ask(folder, asked, job))
    except InputError as error:
        return str(error)
