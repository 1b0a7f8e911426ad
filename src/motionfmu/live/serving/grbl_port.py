"""Where a sender opens a Grbl: a TCP port of this machine, or a pseudo-terminal."""

import asyncio
import contextlib
import os
import socket
import sys
from types import TracebackType

from motionfmu.base.errors import InputError
from motionfmu.base.page_server import HOST, PORT_MAX, listener
from motionfmu.live.serving.grbl_session import GrblSession
from motionfmu.live.serving.machine_link import MachineLink

TERMINAL = "pty"
CHUNK = 4096  # [byte]
# How a request of a web page begins, which any page could send here: no sender of G-code does.
HTTP = tuple(f"{verb} ".encode() for verb in "GET POST PUT HEAD OPTIONS DELETE PATCH".split())
BACKLOG = 1 << 20  # [byte] that a sender may leave unread before it is dropped


class GrblPort:
    """A machine's Grbl port, in ``async with``; one sender at a time.

    Parameters
    ----------
    link : MachineLink
        It is open when the port is entered.
    where : str
        A TCP port, 0 any; or ``pty``.

    Attributes
    ----------
    address : str
        What a sender is told.

    Raises
    ------
    InputError
        The port is none or taken; on entering it, the machine has no controller for it.
    """

    def __init__(self, link: MachineLink, where: str) -> None:
        self._link = link
        self._served: tuple[asyncio.StreamWriter, asyncio.Event] | None = None  # a sender; its end
        self._tasks: set[asyncio.Task[None]] = set()
        self._socket: socket.socket | None = None
        self._terminal: tuple[int, int] | None = None  # our end, and the sender's
        if where == TERMINAL:
            self._open_terminal()
        elif where.isdecimal() and int(where) <= PORT_MAX:
            self._open_socket(int(where))
        else:
            raise InputError(f"--grbl {where}: a port from 0 to {PORT_MAX}, or {TERMINAL}")

    def _open_socket(self, port: int) -> None:
        self._socket = listener(port, f"--grbl {port}: {HOST}")
        self.address = f"tcp://{HOST}:{self._socket.getsockname()[1]}"

    def _open_terminal(self) -> None:
        if sys.platform == "win32":
            raise InputError(f"--grbl {TERMINAL}: Windows has none; give a port")
        import tty

        ours, theirs = os.openpty()
        tty.setraw(theirs)
        os.set_blocking(ours, False)
        self._terminal = ours, theirs
        self.address = os.ttyname(theirs)

    async def __aenter__(self) -> "GrblPort":
        try:
            self._session = GrblSession(self._link)
        except InputError:
            self.close()
            raise
        if self._terminal is not None:
            self._tasks.add(asyncio.ensure_future(self._serve_terminal(self._terminal[0])))
        else:
            self._server = await asyncio.start_server(self._serve, sock=self._socket)
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._socket is not None:
            self._server.close()
        if self._served is not None:  # cancelled, its task would be reported as a failure
            writer, ended = self._served
            writer.transport.abort()
            await ended.wait()
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        self.close()

    def close(self) -> None:
        """Free the port."""
        if self._socket is not None:
            self._socket.close()
        for end in self._terminal or ():
            os.close(end)
        self._terminal = None

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Serve a sender until it goes; a second one is sent away."""
        if self._served is not None:
            writer.close()
            return
        ended = asyncio.Event()
        self._served = writer, ended

        def write(data: bytes) -> None:
            if writer.transport.get_write_buffer_size() < BACKLOG:
                writer.write(data)
            else:
                writer.transport.abort()

        task = asyncio.ensure_future(self._session.run(write))
        self._tasks.add(task)
        try:
            first = True
            while data := await reader.read(CHUNK):
                if first and data.startswith(HTTP):
                    break
                first = False
                self._session.receive(data)
        except ConnectionError:
            pass
        finally:
            task.cancel()
            await asyncio.gather(task, return_exceptions=True)
            self._tasks.discard(task)
            await self._session.end()
            self._served = None
            writer.close()
            ended.set()

    async def _serve_terminal(self, ours: int) -> None:
        """As a serial port is: it is there whether somebody has it open or not."""

        def write(data: bytes) -> None:
            with contextlib.suppress(BlockingIOError):
                os.write(ours, data)

        def read() -> None:
            with contextlib.suppress(BlockingIOError):
                self._session.receive(os.read(ours, CHUNK))

        loop = asyncio.get_running_loop()
        loop.add_reader(ours, read)
        try:
            await self._session.run(write)
        finally:
            loop.remove_reader(ours)
