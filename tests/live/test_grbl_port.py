"""The port and the pseudo-terminal at which a machine is a Grbl, with the machine's own process."""

import asyncio
import contextlib
import os
import re
import select
import signal
import socket
import subprocess
import sys
from collections.abc import Awaitable, Callable, Coroutine
from typing import Any

import pytest

from motionfmu.base.errors import InputError
from motionfmu.live.serving import GrblPort, MachineLink, MachineStart
from motionfmu.live.serving.grbl_session import GrblSession
from motionfmu.live.serving.hand import Holder

PATIENCE = 300.0  # [s] on the wall for an answer
LOCKED = b"[MSG:'$H'|'$X' to unlock]\r\n"


def at_machine(where: str, work: Callable[[GrblPort, MachineLink], Awaitable[None]]) -> None:
    """Do something at a port of a mill that goes as fast as it can."""

    async def run() -> None:
        link = MachineLink(MachineStart("mill3", None, {}, None, True))
        async with link, GrblPort(link, where) as port:
            await asyncio.wait_for(work(port, link), 4 * PATIENCE)

    asyncio.run(run())


class TcpSender:
    """A sender at a TCP port."""

    def __init__(self, port: GrblPort) -> None:
        self._where = port.address.removeprefix("tcp://").split(":")

    async def __aenter__(self) -> "TcpSender":
        host, port = self._where
        self.reader, self.writer = await asyncio.open_connection(host, int(port))
        return self

    async def __aexit__(self, *error: object) -> None:
        self.writer.close()

    async def until(self, end: bytes, data: bytes = b"") -> str:
        """Send something; what came up to an end."""
        self.writer.write(data)
        return (await asyncio.wait_for(self.reader.readuntil(end), PATIENCE)).decode()

    async def idle(self) -> str:
        """Wait until it rests; its report."""
        while not (report := await self.until(b">\r\n", b"?")).lstrip().startswith("<Idle|"):
            await asyncio.sleep(0.02)
        return report

    async def gone(self) -> bool:
        """Whether the other side has closed."""
        return not await asyncio.wait_for(self.reader.read(), PATIENCE)


def test_senders_one_after_the_other() -> None:
    async def work(port: GrblPort, link: MachineLink) -> None:
        async with TcpSender(port) as one:
            assert await one.until(LOCKED) == f"\r\nGrbl 1.1h ['$' for help]\r\n{LOCKED.decode()}"
            async with TcpSender(port) as other:
                assert await other.gone(), "one at a time"
            assert (await one.until(b"ok\r\n", b"$X\n")).endswith("ok\r\n")
            await one.until(b"ok\r\n", b"G10L2P1X1\nG0X5\n")
            assert "|MPos:6.000,0.000,0.000|" in await one.idle()
            await one.until(b"ok\r\n", b"$J=X200F300\n")
        await asyncio.sleep(0.1)
        async with TcpSender(port) as two:
            assert "for help" in await two.until(b"help]\r\n"), "origins outlive a connection"
            assert "[G54:1.000,0.000,0.000]" in await two.until(b"[G55", b"$#\n")
            report = await two.idle()
            found = re.search(r"MPos:([0-9.]+)", report)
            assert found and float(found[1]) < 201.0, "the jog has ended with its sender"

    at_machine("0", work)


def test_a_web_page_is_sent_away() -> None:
    async def work(port: GrblPort, link: MachineLink) -> None:
        async with TcpSender(port) as page:
            await page.until(LOCKED)
            page.writer.write(b"POST / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n$X\nG0X10\n")
            assert await page.gone()
        async with TcpSender(port) as sender:
            await sender.until(LOCKED)
            assert "<Alarm|MPos:0.000" in await sender.until(b">\r\n", b"?")

    at_machine("0", work)


def test_one_hand_at_the_page_or_at_the_sender() -> None:
    async def work(port: GrblPort, link: MachineLink) -> None:
        hand, ann = link.hand, Holder("Ann")
        async with TcpSender(port) as sender:
            await sender.until(LOCKED)
            await sender.until(b">\r\n", b"?")
            assert hand.holder is None, "it only looks"
            await sender.until(b"ok\r\n", b"$X\n")
            assert hand.holder is not None and hand.holder.name == "a sender of G-code"
            with pytest.raises(InputError, match="a sender of G-code has the machine in hand"):
                hand.needed(ann)
            await sender.until(b"ok\r\n", b"$J=X200F300\n")
            await hand.take(ann)
            await sender.until(b"[MSG:Ann has the machine in hand]\r\n")
            found = re.search(r"MPos:([0-9.]+)", await sender.idle())
            assert found and float(found[1]) < 200.0, "the jog has ended"
            assert "error:9" in await sender.until(b"\r\n", b"G0X0\n")
            await hand.drop(ann)
            await sender.until(b"ok\r\n", b"G0X5\n")
            assert "|MPos:5.000," in await sender.idle()
            assert hand.holder is not None
        while hand.holder is not None:
            await asyncio.sleep(0.01)

    at_machine("0", work)


def test_a_session_ends_whatever_has_come_just_before() -> None:
    async def work(port: GrblPort, link: MachineLink) -> None:
        session = GrblSession(link)
        for turns in range(8):
            task = asyncio.ensure_future(session.run(lambda data: None))
            while session.controller.eager or not session.controller.view.time:
                await asyncio.sleep(0.01)
            await asyncio.sleep(0.01)
            session.receive(b"\n")
            for _ in range(turns):
                await asyncio.sleep(0)
            task.cancel()
            await asyncio.wait([task], timeout=5.0)
            assert task.done()

    at_machine("0", work)


class LiveCommand:
    """``motionfmu live`` in a process of its own, and a sender at it."""

    def __init__(self, where: str) -> None:
        command = [sys.executable, "-m", "motionfmu", "live", "mill3", "--port", "0"]
        command += ["--pace", "inf", "--grbl", where]
        pipe = subprocess.PIPE
        self.process = subprocess.Popen(command, stdout=pipe, stderr=pipe, text=True)
        assert self.process.stdout is not None
        lines = iter(self.process.stdout.readline, "")
        self.address = next(line.split()[1] for line in lines if line.startswith("grbl:"))

    def open(self) -> int:
        """A sender's connection."""
        if not self.address.startswith("tcp://"):
            return os.open(self.address, os.O_RDWR | os.O_NOCTTY)
        host, port = self.address.removeprefix("tcp://").split(":")
        return socket.create_connection((host, int(port))).detach()

    def until(self, there: int, end: bytes, data: bytes = b"") -> str:
        """Send something; what came up to an end."""
        os.write(there, data)
        text = b""
        while not text.endswith(end):
            assert select.select([there], [], [], PATIENCE)[0], text
            byte = os.read(there, 1)
            if not byte:
                raise EOFError(text)
            text += byte
        return text.decode()

    def reopen(self) -> int:
        """A connection behind another one, whose end may not have been seen."""
        while True:
            there = self.open()
            if not self.address.startswith("tcp://"):
                return there
            with contextlib.suppress(EOFError, ConnectionResetError):
                self.until(there, b"help]\r\n")
                return there
            os.close(there)


@pytest.mark.more
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no pseudo-terminals")
@pytest.mark.parametrize("where", ["0", "pty"])
def test_the_command_is_a_grbl_until_it_is_stopped(where: str) -> None:
    command = LiveCommand(where)
    there = command.open()
    greeted = command.until(there, LOCKED, b"\x18" if where == "pty" else b"")
    assert "Grbl 1.1h ['$' for help]" in greeted
    assert "error" not in command.until(there, b"ok\r\n", b"$H\n")
    command.until(there, b"ok\r\nok\r\nok\r\n", b"G90G21\nG0X-3Z-2\nG4P0\n")
    assert "<Idle|MPos:-3.000,0.000,-2.000|" in command.until(there, b">\r\n", b"?")
    os.close(there)
    again = command.reopen()
    assert "|MPos:-3.000,0.000,-2.000|" in command.until(again, b">\r\n", b"?")
    command.process.send_signal(signal.SIGINT)
    said = command.process.communicate(timeout=PATIENCE)
    assert (command.process.returncode, said[1]) == (130, "motionfmu: stopped\n")
    with contextlib.suppress(OSError):  # a terminal whose other end is gone
        assert not os.read(again, 4096)
    os.close(again)


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no pseudo-terminals")
def test_a_pseudo_terminal_is_a_serial_port() -> None:
    async def work(port: GrblPort, link: MachineLink) -> None:
        there = os.open(port.address, os.O_RDWR | os.O_NOCTTY)
        try:
            text = b""
            os.write(there, b"\x18")
            loop, end = asyncio.get_running_loop(), asyncio.Event()
            expected = [(b"unlock]", b"$X\n"), (b"ok\r\n", b"G21G91G0X2.5\n"), (b"ok\r\n", b"")]

            def read() -> None:
                nonlocal text
                text += os.read(there, 4096)
                if expected and expected[0][0] in text:
                    text = b""
                    os.write(there, expected.pop(0)[1])
                if not expected:
                    end.set()

            loop.add_reader(there, read)
            await asyncio.wait_for(end.wait(), PATIENCE)
            loop.remove_reader(there)
        finally:
            os.close(there)

    at_machine("pty", work)


@pytest.mark.parametrize(
    ("machine", "where", "told"),
    [
        ("mill3", "serial", "--grbl serial: a port from 0 to 65535, or pty"),
        ("mill3", "65536", "--grbl 65536: a port from 0 to 65535, or pty"),
        ("robot6", "0", "--grbl: robot6: one controller mcc is wanted, there are 0"),
    ],
)
def test_what_cannot_be_a_grbl_is_told(machine: str, where: str, told: str) -> None:
    def work(port: GrblPort) -> Coroutine[Any, Any, None]:
        raise AssertionError("it has opened")

    async def run() -> None:
        link = MachineLink(MachineStart(machine, None, {}, None, False))
        port = GrblPort(link, where)
        async with link, port:
            await work(port)

    with pytest.raises(InputError) as refused:
        asyncio.run(run())
    assert told in str(refused.value)


def test_a_port_that_is_taken_is_told_at_once() -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = other.getsockname()[1]
        link = MachineLink(MachineStart("mill3", None, {}, None, False))
        with pytest.raises(InputError, match=f"--grbl {port}: 127.0.0.1: "):
            GrblPort(link, str(port))
